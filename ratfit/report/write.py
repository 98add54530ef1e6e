"""A document as files in a folder: a Markdown page, its figures beside it, and an HTML page that holds all."""

from __future__ import annotations

from pathlib import Path

from ratfit._record import write_text
from ratfit.report.document import Document
from ratfit.report.html import to_html
from ratfit.report.markdown import figure_file, to_markdown
from ratfit.report.svg import standalone


def write_document(document: Document, folder: Path, name: str) -> tuple[Path, ...]:
    """Writes `name.html`, and `name.md` with its figures as `name-FIGURE.svg`, each file whole or not at all.

    Returns the paths, pages first. **Fails** with `RatfitError` for a folder that is missing or may not be written to.
    """
    texts = {f"{name}.html": to_html(document), f"{name}.md": to_markdown(document, name)}
    texts |= {figure_file(name, figure): standalone(figure.svg) for figure in document.figures}
    for file, text in texts.items():
        write_text(folder / file, text)
    return tuple(folder / file for file in texts)
