"""A document as files in a folder: a Markdown page, its figures beside it, and an HTML page that holds all."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ratfit._parse import RatfitError
from ratfit._record import write_text
from ratfit.report.document import Document
from ratfit.report.html import to_html
from ratfit.report.markdown import figure_file, to_markdown
from ratfit.report.svg import standalone


@contextmanager
def folder_for(out: str | Path) -> Iterator[Path]:
    """The folder of a command's pages: made before the work, and taken away again if nothing came of it.

    **Fails** with `RatfitError` for a folder that cannot be made.
    """
    folder = Path(out)
    try:
        is_new = not folder.exists()
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise RatfitError(f"--out {out}: no folder can be made there ({error.strerror}); name another") from None
    try:
        yield folder
    finally:
        if is_new and not any(folder.iterdir()):
            folder.rmdir()


def write_document(document: Document, folder: Path, name: str) -> tuple[Path, ...]:
    """Writes `name.html`, and `name.md` with its figures as `name-FIGURE.svg`, each file whole or not at all.

    Returns the paths, pages first. **Fails** with `RatfitError` for a folder that is missing or may not be written to.
    """
    texts = {f"{name}.html": to_html(document), f"{name}.md": to_markdown(document, name)}
    texts |= {figure_file(name, figure): standalone(figure.svg) for figure in document.figures}
    for file, text in texts.items():
        write_text(folder / file, text)
    return tuple(folder / file for file in texts)
