"""Figure 7: Beckmann's slope distribution and Eq. 21 in polar coordinates; beneath, the error in parts of the peak."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import ratfit as rf
from paper_figures import style
from paper_figures.curves import Curve, curve
from paper_figures.strip import draw_strip
from paper_figures.style import percent
from ratfit.gallery import card

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

SLOPES = 5.0
"""How far the curves go, in slopes m: Beckmann's function has fallen below 1e-9 of its peak there."""

OPEN = 60
"""Degrees that are shown to each side: at m = 0.5, the widest, Eq. 21 ends there, at t = 1 - m."""


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
    with style.sheet(width, 35 + 0.5 * width) as figure:
        grid = figure.add_gridspec(2, 2, height_ratios=(3, 2))
        for column, title, name in (
            (0, "True function: Eq. 20", "exact"),
            (1, "Rational approximation: Eq. 21", "fit"),
        ):
            axes = figure.add_subplot(grid[0, column], projection="polar")
            _draw_lobes(axes, found, [getattr(lobe.curve, name) / lobe.curve.peak for lobe in found])
            axes.set_title(title)
        style.share_legend(figure, figure.axes[0])
        strip = figure.add_subplot(grid[1, :])
        draw_strip(strip, [lobe.curve for lobe in found], "Eq. 21 − Eq. 20, at worst:", [lobe.slope for lobe in found])
        strip.set(xlim=(0, SLOPES), xlabel=r"$\tan\alpha\,/\,m$", ylabel=r"parts of $1/m^2$")
    return figure


def _draw_lobes(axes: Axes, found: Sequence[Lobe], radii: Sequence[NDArray]) -> None:
    labels = [f"${lobe.curve.label}$" for lobe in found]
    angles = [style.mirrored(lobe.angle, -1) for lobe in found]
    style.draw_family(axes, labels, angles, [style.mirrored(radius) for radius in radii])
    style.sector(axes, OPEN)
    axes.set_rlim(0, 1)
    axes.set_rticks([0.25, 0.5, 0.75, 1], ["", "0.5", "", "1"])


def caption(found: tuple[Lobe, ...]) -> str:
    each = ", ".join(f"{percent(lobe.curve.worst[1])} at {lobe.curve.label}" for lobe in found)
    return (
        "Beckmann's distribution of slopes in polar coordinates: alpha, the angle to the normal, against D(t), "
        "t = cos(alpha), here in parts of its peak 1/m^2, which grows from 4 to 10 000 as m falls from 0.5 to 0.01. "
        "Above, as the paper drew it: the true function and Eq. 21. Beneath: the error, in percent of the peak, over "
        f"the slope in units of m, with the worst points: {each}. Where the true lobe has a flank, at slopes of about "
        "0.7 m, the fit is too narrow, and from 1.5 m on too wide, until it ends at t = 1 - m. The paper prints 2.7 %."
    )
