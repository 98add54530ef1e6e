"""The nouns of a page: what is said, in what order, and nothing of how it looks.

A document is made once and rendered twice, by `markdown.py` and by `html.py`. All text in it is plain text, a user's
names included: the renderers escape it, and nothing here is markup but a figure's SVG and a formula's MathML, which are
made by `figures.py` and `formula.py` alone.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

_UNPRINTABLE = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff\ufffe\uffff\ud800-\udfff]"
)
"""Control characters, marks that turn the direction of reading, and what UTF-8 or XML cannot hold."""


def printable(text: str) -> str:
    """The text with each character that cannot be shown, or that would disorder what stands beside it, as "�"."""
    return _UNPRINTABLE.sub("\ufffd", text)


@dataclass(frozen=True)
class Code:
    """A piece of text to be read letter by letter: a formula, a name of a program, a command."""

    text: str


@dataclass(frozen=True)
class Link:
    """A reference to the section with that title within the same document."""

    text: str
    section: str


Inline = str | Code | Link
Text = Inline | tuple[Inline, ...]


def pieces(text: Text) -> tuple[Inline, ...]:
    """A text as the sequence of its pieces."""
    return text if isinstance(text, tuple) else (text,)


@dataclass(frozen=True)
class Paragraph:
    """One paragraph of running text."""

    kind: ClassVar[str] = "paragraph"
    text: Text


@dataclass(frozen=True)
class Items:
    """A list of points."""

    kind: ClassVar[str] = "items"
    items: tuple[Text, ...]


@dataclass(frozen=True)
class Facts:
    """Pairs of a word and what it stands for here: "domain", "v in [0, 1]"."""

    kind: ClassVar[str] = "facts"
    pairs: tuple[tuple[str, Text], ...]


@dataclass(frozen=True)
class Verbatim:
    """Lines to be copied as they are, commands say."""

    kind: ClassVar[str] = "verbatim"
    text: str


@dataclass(frozen=True)
class Formula:
    """A formula as text that ratfit and sympy read, and as MathML where it could be drawn."""

    kind: ClassVar[str] = "formula"
    text: str
    mathml: str | None = None


@dataclass(frozen=True)
class Headline:
    """A number that the reader came for: the number, its name, and the remarks that change its meaning."""

    value: str
    label: Text
    remark: Text = ""


@dataclass(frozen=True)
class Headlines:
    """The few numbers at the top of a section."""

    kind: ClassVar[str] = "headlines"
    items: tuple[Headline, ...]


@dataclass(frozen=True)
class Column:
    """The head of a column; a numeric one is set flush right and sorted by the keys of its cells."""

    label: str
    numeric: bool = False


@dataclass(frozen=True)
class Cell:
    """One cell: its text and the number to sort by (None: no number, sorted last).

    `remarks` change what the text means, warnings say; an `aside` explains it.
    """

    text: Text
    key: float | None = None
    remarks: tuple[str, ...] = ()
    aside: str = ""


@dataclass(frozen=True)
class Table:
    """A table; **fails** with `ValueError` when a row is not as long as the head."""

    kind: ClassVar[str] = "table"
    head: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    caption: Text = ""

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.head):
                raise ValueError(f"a row of {len(row)} cells under a head of {len(self.head)}")

    @property
    def notes(self) -> dict[str, str]:
        """Every remark on a cell, in the order of the table, with the letter that stands for it beside the number."""
        remarks = dict.fromkeys(remark for row in self.rows for cell in row for remark in cell.remarks)
        return {remark: _letter(number) for number, remark in enumerate(remarks)}


def _letter(number: int) -> str:
    """a to z, then aa, ab ..."""
    more, place = divmod(number, 26)
    return (_letter(more - 1) if more else "") + "abcdefghijklmnopqrstuvwxyz"[place]


@dataclass(frozen=True)
class Figure:
    """A picture: an `<svg>` element without namespaces, as `figures.py` makes it.

    `name` is unique in the document and a part of a file's name; `alt` says in a sentence what is to be seen.
    """

    kind: ClassVar[str] = "figure"
    name: str
    svg: str
    caption: Text
    alt: str


@dataclass(frozen=True)
class Details:
    """What is folded away until the reader asks for it."""

    kind: ClassVar[str] = "details"
    summary: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Section:
    """A headed part of a document; its blocks may be sections of their own."""

    kind: ClassVar[str] = "section"
    title: str
    blocks: tuple[Block, ...]


Block = Paragraph | Items | Facts | Verbatim | Formula | Headlines | Table | Figure | Details | Section


@dataclass(frozen=True)
class Document:
    """A whole page: title, opening, sections, and at its end what the numbers mean and how they were made."""

    title: str
    lead: tuple[Block, ...]
    sections: tuple[Section, ...]
    about: tuple[Block, ...] = ()

    @property
    def figures(self) -> tuple[Figure, ...]:
        """Every figure, in the order of the page."""
        return tuple(_figures((*self.lead, *self.sections, *self.about)))


def _figures(blocks: tuple[Block, ...]) -> Iterator[Figure]:
    for block in blocks:
        if isinstance(block, Figure):
            yield block
        elif isinstance(block, (Details, Section)):
            yield from _figures(block.blocks)
