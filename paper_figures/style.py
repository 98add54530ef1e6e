"""The one look of all figures: sizes on paper, type, lines; colours and dashes are those of the library's pictures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ratfit.plot.style import SERIES
from ratfit.plot.text import significant

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

PAGE, COLUMN = 170.0, 85.0
"""Widths in mm: of a page's text, and of one of its two columns."""

LEAST, MOST = 80, 300
"""Widths in mm that a figure may have: its words have no room on less."""

NARROW = 120.0
"""Below this width in mm a figure is laid out for a column."""

INK, GRID = "#000000", "#D8D8D8"


def type_size(width: float) -> float:
    """Points of the type: 9 on a page, 7 in a column, in between in between."""
    return min(9.0, max(6.5, 5.0 + 2.0 * width / COLUMN))


def settings(width: float) -> dict[str, Any]:
    """matplotlib's settings for a figure of this width in mm."""
    size = type_size(width)
    thin = size / 9
    return {
        "font.family": "STIXGeneral",  # comes with matplotlib, so a figure is the same everywhere
        "mathtext.fontset": "stix",
        "font.size": size,
        "axes.titlesize": size,
        "axes.labelsize": size,
        "legend.fontsize": size,
        "xtick.labelsize": size - 0.5,
        "ytick.labelsize": size - 0.5,
        "axes.titlepad": 5.0 * thin,
        "axes.labelpad": 2.0 * thin,
        "axes.linewidth": 0.7 * thin,
        "xtick.major.width": 0.7 * thin,
        "ytick.major.width": 0.7 * thin,
        "xtick.minor.width": 0.5 * thin,
        "xtick.major.size": 3.0 * thin,
        "ytick.major.size": 3.0 * thin,
        "xtick.minor.size": 1.8 * thin,
        "lines.linewidth": 1.3 * thin,
        "lines.markersize": 4.0 * thin,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "axes.axisbelow": True,
        "grid.color": GRID,
        "grid.linewidth": 0.5 * thin,
        "legend.frameon": False,
        "legend.handlelength": 3.0 if width > NARROW else 2.4,
        "legend.handletextpad": 0.6,
        "legend.columnspacing": 1.6 if width > NARROW else 1.0,
        "figure.facecolor": "white",  # on a dark page too, where black ink would not be seen
        "svg.hashsalt": "ratfit",  # equal figures give equal files
        "svg.fonttype": "path",
        "pdf.fonttype": 42,
    }


@contextmanager
def sheet(width: float, height: float) -> Iterator[Figure]:
    """A new figure of this size in mm; what is drawn on it inside the `with` has the one look."""
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context(settings(width)):
        figure = Figure(figsize=(width / 25.4, height / 25.4), layout="constrained")
        figure.get_layout_engine().set(w_pad=0.03, h_pad=0.03)
        yield figure
        figure.draw_without_rendering()  # what is made on first drawing, further ticks say, has this look too


def line_and_mark() -> tuple[float, float]:
    """Width of lines and size of marks on the sheet at hand, in points."""
    import matplotlib

    return matplotlib.rcParams["lines.linewidth"], matplotlib.rcParams["lines.markersize"]


def is_narrow(axes: Axes) -> bool:
    """Whether a title and a legend have no room on one line above these axes.

    Told by their share of the figure, for this is asked before the layout has made room for what stands around them.
    """
    figure = axes.figure
    return 25.4 * figure.get_figwidth() * axes.get_subplotspec().get_position(figure).width < 0.95 * NARROW


def family(name: str, values: Sequence[float]) -> list[str]:
    """The entries of a legend: the name stands at the first value alone."""
    return [f"${name} = {value:g}$" if n == 0 else f"${value:g}$" for n, value in enumerate(values)]


def draw_family(axes: Axes, labels: Sequence[str], places: Sequence[Any], heights: Sequence[Any]) -> None:
    """Curves of one family on the same axes, each with a colour and dashes of its own."""
    for label, x, y, (colour, dashes) in zip(labels, places, heights, SERIES, strict=False):
        axes.plot(x, y, color=colour, linestyle=dashes, label=label)


def share_legend(figure: Figure, axes: Axes) -> None:
    """One legend above all panels for the family that these axes hold, where it covers no data."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))


def head(axes: Axes, title: str) -> None:
    """The title of an error strip at its left, and the legend of its lines at its right: above the data, in a narrow
    figure beneath each other."""
    import matplotlib

    size, is_tight = matplotlib.rcParams["axes.titlesize"], is_narrow(axes)
    axes.set_title(title, loc="left", pad=1.8 * size if is_tight else matplotlib.rcParams["axes.titlepad"])
    axes.legend(
        loc="lower right",
        bbox_to_anchor=(1, 1),
        ncols=len(axes.get_legend_handles_labels()[1]),
        borderaxespad=0,
        borderpad=0.2,
        handlelength=2.0 if is_tight else 2.3,
        handletextpad=0.4,
        columnspacing=0.6 if is_tight else 0.9,
    )


def unit_ticks(axis: Axis, step: float) -> None:
    """Ticks from 0 to 1, none with more digits than it needs."""
    ticks = [step * n for n in range(round(1 / step) + 1)]
    axis.set_ticks(ticks, [f"{tick:g}" for tick in ticks])


def percent(fraction: float) -> str:
    """A signed fraction as percent, "+7.5 %"; two digits, for it is known at the points drawn alone."""
    return f"{'+' if fraction > 0 else ''}{share(fraction)}"


def share(fraction: float) -> str:
    """The same without the sign of what is positive."""
    return f"{significant(100 * fraction, 2)} %"
