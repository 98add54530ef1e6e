"""The error strip: what the paper did not show."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from paper_figures import style
from paper_figures.style import percent
from ratfit.plot.error import draw_error_curve
from ratfit.plot.style import SERIES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from paper_figures.curves import Curve


def draw_strip(axes: Axes, curves: Sequence[Curve], title: str, over: Sequence[NDArray] | None = None) -> None:
    """The errors of several curves, the worst point of each marked; its value stands above the axes, clear of them all.

    Arguments: `curves`, at most as many as there are SERIES, which gives them their looks; `title`, what differs from
    what; `over`, the places along the axis, where they are not the curves' own.
    """
    width, mark = style.line_and_mark()
    along = over or [curve.places for curve in curves]
    for curve, places, (colour, dashes) in zip(curves, along, SERIES, strict=False):
        worst = draw_error_curve(axes, places, curve.errors, colour=colour, dashes=dashes, width=width, mark=mark)
        axes.lines[-2].set_label(percent(worst.error))  # the last line is the mark of the worst point
    style.head(axes, title)
