"""A section of a document as text for the terminal: what the page shows unfolded."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator

from ratfit.report.bench import letter
from ratfit.report.document import Block, Cell, Details, Facts, Items, Paragraph, Section, Table, Text, pieces
from ratfit.report.text import WIDTH, aligned


def section_text(section: Section) -> str:
    """Title and blocks as lines of a terminal, without what is folded on the page or what only a page can show."""
    blocks = ["\n".join(_lines(block)) for block in section.blocks]
    return "\n\n".join([section.title, *filter(None, blocks)])


def _lines(block: Block) -> Iterator[str]:
    if isinstance(block, Paragraph):
        yield from _wrapped(_plain(block.text), "  ", "  ")
    elif isinstance(block, Items):
        for item in block.items:
            yield from _wrapped(_plain(item), "  - ", "    ")
    elif isinstance(block, Facts):
        width = max((len(word) for word, _ in block.pairs), default=0)
        yield from (f"  {word.ljust(width)}  {_plain(meaning)}" for word, meaning in block.pairs)
    elif isinstance(block, Table):
        yield from (f"  {line}" for line in _table(block))
    elif isinstance(block, Details):
        return


def _wrapped(text: str, first: str, rest: str) -> list[str]:
    return textwrap.wrap(text, WIDTH, initial_indent=first, subsequent_indent=rest, break_long_words=False)


def _table(table: Table) -> Iterator[str]:
    """The cells below each other, with letters for the remarks on them, which follow."""
    letters: dict[str, str] = {}
    rows = [[_cell(cell, letters) for cell in row] for row in table.rows]
    yield from aligned([[column.label for column in table.head], *rows])
    yield from (f"({mark}) {remark}" for remark, mark in letters.items())


def _cell(cell: Cell, letters: dict[str, str]) -> str:
    marks = [letters.setdefault(remark, letter(len(letters))) for remark in cell.remarks]
    return _plain(cell.text) + (f" ({','.join(marks)})" if marks else "")


def _plain(text: Text) -> str:
    return "".join(piece if isinstance(piece, str) else piece.text for piece in pieces(text))
