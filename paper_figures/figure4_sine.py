"""Figure 4: the sine on a quarter turn and its fraction, Eq. 12; beneath, the error, and that of a cubic."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import ratfit as rf
from paper_figures import style
from paper_figures.curves import Curve, curve, printed_error
from paper_figures.style import percent, share
from ratfit.plot.error import draw_error
from ratfit.plot.style import SERIES
from ratfit.plot.text import significant

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Sine:
    """The fraction of Eq. 12, and the cubic that keeps the same four conditions."""

    fraction: Curve
    cubic: Curve


def data() -> Sine:
    import numpy as np

    fraction = rf.derive("eq12")
    problem = fraction.problem
    cubic = rf.derive(rf.Problem(target=problem.target, conditions=problem.conditions, form=rf.Rational(3, 0)))
    x = np.linspace(0, np.pi / 2, 801)
    return Sine(curve(fraction, x, "fraction, Eq. 12"), curve(cubic, x, "cubic, the same conditions"))


def draw(found: Sine, width: float = style.PAGE) -> Figure:
    fraction = found.fraction
    with style.sheet(width, 54 + 0.36 * width) as figure:
        panels = figure.subplot_mosaic([["true", "fraction"], ["error", "error"]], height_ratios=(5, 4))
        for name, title, heights in (
            ("true", r"True function: $\sin x$", fraction.exact),
            ("fraction", "Rational approximation: Eq. 12", fraction.fit),
        ):
            panels[name].plot(fraction.places, heights, color=style.INK)
            panels[name].set_title(title)
            panels[name].set_xlabel("$x$")
            _quarter_turn(panels[name])
            style.unit_ticks(panels[name].yaxis, 0.25)
        _draw_errors(panels["error"], found)
        _quarter_turn(panels["error"])
        panels["error"].set_xlabel("$x$")
        panels["true"].set_ylabel("$f(x)$")
    return figure


def _draw_errors(axes: Axes, found: Sine) -> None:
    width, mark = style.line_and_mark()
    for each, (colour, dashes) in zip((found.fraction, found.cubic), SERIES, strict=False):
        draw_error(
            axes, each.places, each.errors, colour=colour, dashes=dashes, width=width, mark=mark,
            label=each.label, variable="$x$",
        )  # fmt: skip
    for text in axes.texts:
        text.set_fontsize(axes.yaxis.get_ticklabels()[0].get_fontsize())
    style.head(axes, "Error, approximation − true:")


def _quarter_turn(axes: Axes) -> None:
    axes.set_xlim(0, math.pi / 2)
    axes.set_xticks([0, math.pi / 8, math.pi / 4, 3 * math.pi / 8, math.pi / 2])
    axes.set_xticklabels(["0", "π/8", "π/4", "3π/8", "π/2"])


def caption(found: Sine) -> str:
    fraction, cubic = found.fraction, found.cubic
    return (
        "The sine on a quarter turn. Above, as the paper drew it: the true function and the fraction of Eq. 12. "
        f"Beneath: the error of the fraction, in percent of the peak, at worst {percent(fraction.worst[1])} at "
        f"x = {significant(fraction.worst[0], 2)} and {share(fraction.mean)} on average, where the paper prints "
        f"{printed_error('eq12')}. A cubic that keeps the same four conditions needs no division and is closer: at "
        f"worst {percent(cubic.worst[1])}, on average {share(cubic.mean)}."
    )
