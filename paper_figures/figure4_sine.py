"""Figure 4: the sine on a quarter turn and its fraction, Eq. 12; beneath, the error, and that of a cubic."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import ratfit as rf
from paper_figures import style
from paper_figures.curves import Curve, curve
from paper_figures.style import percent
from ratfit.plot.error import draw_error
from ratfit.plot.style import SERIES, significant

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
    curve = found.fraction
    with style.sheet(width, 40 + 0.42 * width) as figure:
        panels = figure.subplot_mosaic([["true", "fraction"], ["error", "error"]], height_ratios=(3, 2))
        for name, title, heights in (
            ("true", r"True function: $\sin x$", curve.exact),
            ("fraction", "Rational approximation: Eq. 12", curve.fit),
        ):
            panels[name].plot(curve.places, heights, color=style.INK)
            panels[name].set_title(title)
            panels[name].set_xlabel("$x$")
            _quarter_turn(panels[name])
        _draw_errors(panels["error"], found)
        _quarter_turn(panels["error"])
        panels["true"].set_ylabel("$f(x)$")
    return figure


def _draw_errors(axes: Axes, found: Sine) -> None:
    for curve, (colour, dashes) in zip((found.fraction, found.cubic), SERIES, strict=False):
        draw_error(axes, curve.places, curve.errors, colour=colour, dashes=dashes, label=curve.label, variable="x")
    axes.set_title("Error, approximation − true", loc="left")
    axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, borderaxespad=0, borderpad=0.2)


def _quarter_turn(axes: Axes) -> None:
    axes.set_xlim(0, math.pi / 2)
    axes.set_xticks([0, math.pi / 8, math.pi / 4, 3 * math.pi / 8, math.pi / 2])
    axes.set_xticklabels(["0", "π/8", "π/4", "3π/8", "π/2"])


def caption(found: Sine) -> str:
    fraction, cubic = found.fraction, found.cubic
    return (
        "The sine on a quarter turn. Above, as the paper drew it: the true function and the fraction of Eq. 12. "
        f"Beneath: the error of the fraction, in percent of the peak, at worst {percent(fraction.worst[1])} at "
        f"x = {significant(fraction.worst[0], 2)} and {percent(fraction.mean)} on average, where the paper prints "
        "1.4 %. A cubic that keeps the same four conditions needs no division and is closer: at worst "
        f"{percent(cubic.worst[1])}, on average {percent(cubic.mean)}."
    )
