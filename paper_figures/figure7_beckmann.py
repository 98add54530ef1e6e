"""Figure 7: Beckmann's slope distribution and Eq. 21 in polar coordinates; beneath, the error in parts of the peak."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import ratfit as rf
from paper_figures import style
from paper_figures.curves import Curve, curve, printed_error
from paper_figures.polar import draw_lobes, draw_sector
from paper_figures.strip import draw_strip
from paper_figures.style import percent
from ratfit.gallery import card

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

SLOPES = 5.0
"""How far the curves go, in slopes m: Beckmann's function has fallen below 1e-9 of its peak there."""

OPEN = 45
"""Degrees that are shown to each side: at m = 0.5, the widest, a tenth of the peak is left there."""

TITLE = "(Eq. 21 − Eq. 20)/peak, at worst:"


@dataclass(frozen=True)
class Lobe:
    """One m: the slope tan(alpha)/m, the angle alpha itself in radians, and the curve over t = cos(alpha)."""

    m: float
    slope: NDArray
    angle: NDArray
    curve: Curve


def data() -> tuple[Lobe, ...]:
    fit = rf.derive("eq21")
    return tuple(_lobe(fit, float(setting["m"])) for setting in card("eq21").settings)


def _lobe(fit: rf.Fit, m: float) -> Lobe:
    import numpy as np

    slope = np.linspace(0, SLOPES, 1001)
    angle = np.arctan(m * slope)
    # The peak is at t = 1, the first condition: both have it.
    return Lobe(m, slope, angle, curve(fit, np.cos(angle), f"m = {m:g}", {"m": m}, peak=fit(1.0, m=m)))


def draw(found: tuple[Lobe, ...], width: float = style.PAGE) -> Figure:
    with style.sheet(width, 27 + 0.58 * width) as figure:
        panels = figure.subplot_mosaic([["true", "fit"], ["error", "error"]], height_ratios=(3, 2))
        _draw_lobes(panels["true"], "True function: Eq. 20", found, [lobe.curve.exact for lobe in found])
        _draw_lobes(panels["fit"], "Rational approximation: Eq. 21", found, [lobe.curve.fit for lobe in found])
        style.share_legend(figure, panels["true"])
        draw_strip(panels["error"], [lobe.curve for lobe in found], TITLE, [lobe.slope for lobe in found])
        panels["error"].set(xlim=(0, SLOPES), xlabel=r"$\tan\alpha\,/\,m$")
    return figure


def _draw_lobes(axes: Axes, title: str, found: Sequence[Lobe], heights: Sequence[NDArray]) -> None:
    radii = [height / lobe.curve.peak for lobe, height in zip(found, heights, strict=True)]
    draw_lobes(axes, style.family("m", [lobe.m for lobe in found]), [lobe.angle for lobe in found], radii)
    draw_sector(axes, title, 1, OPEN, {0.25: "", 0.5: "½", 0.75: "", 1: "peak"}, 15)


def caption(found: tuple[Lobe, ...]) -> str:
    each = ", ".join(f"{percent(lobe.curve.worst[1])} at {lobe.curve.label}" for lobe in found)
    return (
        "Beckmann's distribution of slopes in polar coordinates: alpha, the angle to the normal, against D(t), "
        "t = cos(alpha), here in parts of its peak 1/m^2, which grows from 4 to 10 000 as m falls from 0.5 to 0.01. "
        "Above, as the paper drew it: the true function and Eq. 21. Beneath: the error, in percent of the peak, over "
        f"the slope in units of m, with the worst points: {each}. Eq. 21 falls faster at first, is too high "
        f"from slopes of about 1.5 m on, and ends at t = 1 − m. The paper prints {printed_error('eq21')}."
    )
