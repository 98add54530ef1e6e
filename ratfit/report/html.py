"""A document as one HTML page that needs nothing else: styles, script and figures are in it, and it asks no network.

The page's own policy forbids whatever is not in it: no request leaves it, and no script runs but the one in
`page/script.js`, whatever the names of problems may hold. Without that script the page reads the same; it only sorts
tables, switches between light and dark, and unfolds all for print.
"""

from __future__ import annotations

import base64
import hashlib
from functools import cache
from pathlib import Path
from typing import Any

from ratfit.report.document import Document, Section, pieces, printable

PAGE = Path(__file__).parent / "page"


def to_html(document: Document) -> str:
    """The whole page as text; equal documents give equal bytes."""
    titles = [section.title for section in document.sections]
    return printable(
        _template().render(
            document=document,
            script=_script(),
            policy=_policy(),
            pieces=pieces,
            anchor=lambda title: f"section-{titles.index(title) + 1}" if title in titles else "",
            is_section=lambda block: isinstance(block, Section),
        )
    )


def _script() -> str:
    return (PAGE / "script.js").read_text(encoding="utf-8")


def _policy() -> str:
    """What the page may do, as a Content-Security-Policy: its one script, by its hash, and its own styles."""
    digest = base64.b64encode(hashlib.sha256(_script().encode()).digest()).decode()
    rest = "style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"
    return f"default-src 'none'; script-src 'sha256-{digest}'; {rest}"


@cache
def _template() -> Any:
    import jinja2

    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(PAGE),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    return environment.get_template("page.html.j2")
