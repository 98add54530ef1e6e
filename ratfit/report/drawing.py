"""What the figures of a page share: their size, and a legend that stays clear of the data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ratfit._parse import shortened
from ratfit.report.document import printable
from ratfit.report.svg import SETTINGS

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

WIDTH = 4.8
"""Inches; on a phone the figure is shown near this size, on a desk at half as much again."""

LETTERS = 40
"""Letters of a text in a figure."""

_LINE = 54
"""Letters that fit side by side below a figure."""


@contextmanager
def drawing(height: float) -> Iterator[Drawing]:
    """A figure of WIDTH and this height in inches, under the settings of all figures of a page."""
    import matplotlib
    from matplotlib.figure import Figure as Drawing

    with matplotlib.rc_context(SETTINGS):  # type: ignore[arg-type]
        yield Drawing(figsize=(WIDTH, height), layout="constrained")


def legend(figure: Drawing, entries: Sequence[tuple[str, str, str]]) -> None:
    """Entries (colour, marker or none, text) below the axes, clear of the data."""
    from matplotlib.lines import Line2D

    handles: list[Any] = [
        Line2D([], [], color=colour, marker=marker, linestyle="none" if marker else "-", markersize=8)
        for colour, marker, _ in entries
    ]
    texts = [label(text) for _, _, text in entries]
    columns = max(1, min(len(texts), _LINE // (6 + max(map(len, texts)))))
    # A text that begins with an underscore would hide its entry: places are kept by letters, and filled afterwards.
    below = figure.legend(handles, ["n" * len(t) for t in texts], loc="outside lower center", ncols=columns)
    for shown, text in zip(below.get_texts(), texts, strict=True):
        shown.set_text(text)


def label(text: str) -> str:
    """The text as a label: on one line, and of a long one its beginning."""
    return shortened(printable(" ".join(text.split())), LETTERS)
