"""The one look of all figures: sizes on paper, type, lines; colours and dashes are those of the library's pictures."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ratfit.plot.style import SERIES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

PAGE, COLUMN = 170.0, 85.0
"""Widths in mm: of a page's text, and of one of its two columns."""

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
        "legend.handlelength": 3.0,
        "legend.columnspacing": 1.6,
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
        figure.draw_without_rendering()  # what is made on first drawing, ticks of polar axes say, has this look too


def draw_family(axes: Axes, labels: Sequence[str], places: Sequence[Any], heights: Sequence[Any]) -> None:
    """Curves of one family on the same axes, each with a colour and dashes of its own."""
    for label, x, y, (colour, dashes) in zip(labels, places, heights, SERIES, strict=False):
        axes.plot(x, y, color=colour, linestyle=dashes, label=label)


def share_legend(figure: Figure, axes: Axes) -> None:
    """One legend above all panels for the family that these axes hold, where it covers no data."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))


def percent(fraction: float, digits: int = 2) -> str:
    """A fraction as percent with its sign: "+7.5 %"; digits beyond those are no reader's."""
    from ratfit.plot.style import significant

    return f"{'+' if fraction > 0 else ''}{significant(100 * fraction, digits)} %"


def mirrored(values: NDArray, sign: int = 1) -> NDArray:
    """An array that begins at an axis of symmetry, with its mirror image before it; -1 for odd ones, as angles."""
    import numpy as np

    return np.concatenate([sign * values[:0:-1], values])


def sector(axes: Axes, degrees: int) -> None:
    """Polar axes around the vertical, open to both sides by so many degrees."""
    axes.set_theta_zero_location("N")
    axes.set_theta_direction(-1)
    axes.set_thetalim(-math.radians(degrees), math.radians(degrees))
    ticks = range(-degrees, degrees + 1, 30)
    axes.set_xticks([math.radians(tick) for tick in ticks], [f"{abs(tick)}°" for tick in ticks])
    axes.tick_params(axis="x", pad=0)


def decades(axes: Axes, low: int, high: int) -> None:
    """Polar axes whose radius is a decimal logarithm, from a centre at 10**low to 10**high."""
    axes.set_rlim(low, high + 0.1)
    axes.set_rticks(range(low + 1, high + 1), [f"{10.0**power:g}" for power in range(low + 1, high + 1)])
