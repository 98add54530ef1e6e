"""A document as Markdown in GitHub's manner; figures are referenced as files beside the page."""

from __future__ import annotations

import html
import re
from collections.abc import Mapping
from functools import singledispatch

from ratfit.report.document import (
    Block,
    Cell,
    Code,
    Details,
    Document,
    Facts,
    Figure,
    Formula,
    Headlines,
    Items,
    Link,
    Paragraph,
    Section,
    Table,
    Text,
    Verbatim,
    pieces,
    printable,
)

_SIGNS = re.compile(r"([\\`*_\[\]|~$])")
_OPENING = re.compile(r"^(\s*\d*)([-+=#.)])")
"""What at the start of a line would make a list or a heading of it."""


def to_markdown(document: Document, name: str) -> str:
    """The page as Markdown.

    Arguments: `document`; `name`, which begins the names of its figures' files (see `figure_file`). Returns the text;
    no letter of the document's own text acts as markup.
    """
    blocks = [*document.lead, *document.sections, *document.about]
    parts = [f"# {_line(document.title)}", *(_rendered(block, 2, name) for block in blocks)]
    return printable("\n\n".join(part for part in parts if part)) + "\n"


def figure_file(name: str, figure: Figure) -> str:
    """The name of the file that holds a figure, in the folder of the page."""
    return f"{name}-{figure.name}.svg"


@singledispatch
def _rendered(block: Block, level: int, name: str) -> str:
    raise TypeError(f"no block of a document: {block!r}")


@_rendered.register
def _(block: Paragraph, level: int, name: str) -> str:
    return _line(block.text)


@_rendered.register
def _(block: Items, level: int, name: str) -> str:
    return "\n".join(f"- {_line(item)}" for item in block.items)


@_rendered.register
def _(block: Facts, level: int, name: str) -> str:
    return "\n".join(f"- {_line(word)}: {_text(meaning)}" for word, meaning in block.pairs)


@_rendered.register
def _(block: Verbatim, level: int, name: str) -> str:
    fence = "`" * max(3, _longest_run(block.text) + 1)
    return f"{fence}\n{block.text}\n{fence}"


@_rendered.register
def _(block: Formula, level: int, name: str) -> str:
    return _rendered(Verbatim(block.text), level, name)


@_rendered.register
def _(block: Headlines, level: int, name: str) -> str:
    lines = []
    for item in block.items:
        remark = f" ({_text(item.remark)})" if item.remark else ""
        lines.append(f"- **{_text(item.value)}** {_text(item.label)}{remark}")
    return "\n".join(lines)


@_rendered.register
def _(block: Table, level: int, name: str) -> str:
    lines = [_line(block.caption), ""] if block.caption else []
    lines += [_row([_text(column.label) for column in block.head])]
    lines += [_row(["---:" if column.numeric else "---" for column in block.head])]
    notes = block.notes
    lines += [_row([_cell(cell, notes) for cell in row]) for row in block.rows]
    if notes:
        lines += ["", "  \n".join(f"({letter}) {_text(remark)}" for remark, letter in notes.items())]
    return "\n".join(lines)


@_rendered.register
def _(block: Figure, level: int, name: str) -> str:
    return f"![{_text(block.alt)}]({figure_file(name, block)})\n\n{_line(block.caption)}"


@_rendered.register
def _(block: Details, level: int, name: str) -> str:
    inner = "\n\n".join(_rendered(part, level, name) for part in block.blocks)
    return f"<details><summary>{html.escape(_flat(block.summary))}</summary>\n\n{inner}\n\n</details>"


@_rendered.register
def _(block: Section, level: int, name: str) -> str:
    inner = [_rendered(part, level + 1, name) for part in block.blocks]
    return "\n\n".join([f"{'#' * min(level, 6)} {_line(block.title)}", *inner])


def _row(cells: list[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _cell(cell: Cell, notes: Mapping[str, str]) -> str:
    letters = ", ".join(notes[remark] for remark in cell.remarks)
    aside = f"({_text(cell.aside)})" if cell.aside else ""
    return " ".join(filter(None, (_text(cell.text, in_table=True), f"({letters})" if letters else "", aside)))


def _line(text: Text) -> str:
    """A text at the start of a line."""
    return _OPENING.sub(r"\1\\\2", _text(text))


def _text(text: Text, in_table: bool = False) -> str:
    found = []
    for piece in pieces(text):
        if isinstance(piece, Code):
            found.append(_code(_flat(piece.text), in_table))
        else:
            found.append(_escaped(piece.text if isinstance(piece, Link) else piece))
    return "".join(found)


def _escaped(text: str) -> str:
    return _SIGNS.sub(r"\\\1", html.escape(_flat(text), quote=False))


def _code(text: str, in_table: bool) -> str:
    if not text:
        return ""
    fence = "`" * (_longest_run(text) + 1)
    pad = " " if text.startswith("`") or text.endswith("`") else ""
    shown = text.replace("|", "\\|") if in_table else text  # GitHub splits the cells of a table before all else
    return f"{fence}{pad}{shown}{pad}{fence}"


def _flat(text: str) -> str:
    return " ".join(text.split("\n"))


def _longest_run(text: str) -> int:
    return max((len(run) for run in re.findall("`+", text)), default=0)
