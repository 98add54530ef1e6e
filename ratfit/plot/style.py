"""What pictures share: colours, settings for figures of our own, and a legend that covers no data."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ratfit.plot.text import text_width

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Okabe and Ito's colours, which the colour-blind tell apart; shapes and dashes differ too, so that grey print serves.
BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, RED, PURPLE, GREY = "#0072B2", "#D55E00", "#CC79A7", "#666666"

SERIES: Sequence[tuple[str, Any]] = (
    (BLUE, "-"),
    (RED, (0, (6, 1.6))),
    (GREEN, (0, (6, 1.6, 1.2, 1.6))),
    (PURPLE, (0, (2.4, 1.2))),
    (ORANGE, (0, (9, 1.6, 1.2, 1.6, 1.2, 1.6))),
    (SKY, (0, (1.2, 1.2))),
)
"""Colour and dashes of the curves of a family, in order."""

SETTINGS = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 10,
    "axes.titlesize": 11,
    "axes.labelsize": 10,
    "xtick.labelsize": 9,
    "ytick.labelsize": 9,
    "legend.fontsize": 9,
    "mathtext.fontset": "dejavusans",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "svg.fonttype": "path",  # the same picture wherever it is opened, whatever fonts there are
    "svg.hashsalt": "ratfit",
    "pdf.fonttype": 42,
}
"""matplotlib's settings for figures of our own; on axes that are given, their owner's hold."""

LETTERS = 62
"""Letters of an entry below a picture."""


_BESIDE = 350
"""Points that the texts of two columns may take together."""

_ROW = 0.2
"""Inches that a line of a legend takes."""

_LINE = 13
"""Points that a further line of an axis's label takes."""


@contextmanager
def settings(are_ours: bool = True) -> Iterator[None]:
    """SETTINGS while a figure of our own is drawn or written; afterwards all is as it was."""
    import matplotlib

    with matplotlib.rc_context(SETTINGS if are_ours else {}):  # type: ignore[arg-type]
        yield


def dress(axes: Axes) -> None:
    """What all our axes wear: a light grid, and no box."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(alpha=0.25, linewidth=0.6)


def axes_width(axes: Axes) -> float:
    """The width of axes in points, before any layout changes it."""
    return float(72 * axes.get_window_extent().width / axes.figure.dpi)


def legend_below(axes: Axes, handles: Sequence[Any], is_ours: bool) -> None:
    """A legend below the axes and their label, of however many lines, where no data are.

    A constrained layout makes room for it, and a figure of our own grows by it.
    """
    from matplotlib.transforms import ScaledTranslation

    if not handles:
        return
    texts = [str(handle.get_label()).split("\n") for handle in handles]
    widths = [max(text_width(line, 9) for line in lines) for lines in texts]
    half = (len(handles) + 1) // 2
    columns = 2 if max(widths[:half]) + max(widths[half:], default=0) < min(_BESIDE, axes_width(axes)) else 1
    more_lines = axes.get_xlabel().count("\n")
    if is_ours:
        side_by_side = (texts[:half], texts[half:]) if columns == 2 else (texts,)
        rows = max(sum(map(len, column)) for column in side_by_side)
        height = axes.figure.get_figheight() + _ROW * rows + more_lines * _LINE / 72  # type: ignore[union-attr]
        axes.figure.set_figheight(height)  # type: ignore[union-attr]  # a Figure of its own
    axes.legend(
        handles=list(handles),
        loc="upper center",
        bbox_to_anchor=(0.5, 0),
        bbox_transform=axes.transAxes
        + ScaledTranslation(0, -(38 + more_lines * _LINE) / 72, axes.figure.dpi_scale_trans),
        ncols=columns,
        frameon=False,
        borderaxespad=0,
    )
