"""Figure 8: the directional factors Z and A of Eq. 28 in logarithmic polar coordinates; beneath, Beckmann's function,
the A that keeps Eq. 27, and how far the printed ones are from them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import ratfit as rf
from paper_figures import style
from paper_figures.curves import Curve, curve
from paper_figures.strip import draw_strip
from ratfit._lower import lower
from ratfit.gallery import card
from ratfit.plot.error import draw_error_curve

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

VALUES = (0.01, 0.05, 0.2, 0.5, 1.0)
"""The values of r and of p."""

POWERS = (-3, 2)
"""Powers of ten in the centre of the polar axes and at their rim."""


@dataclass(frozen=True)
class Zenith:
    """Z over the zenith angle in radians, one curve for each r; its exact function is Beckmann's at m^2 = r."""

    angle: NDArray
    curves: tuple[Curve, ...]


@dataclass(frozen=True)
class Azimuth:
    """A over the first quadrant of the azimuth, in radians, one array for each p; and its mean there over p.

    Eq. 27 asks for a mean of 1.
    """

    angle: NDArray
    printed: tuple[NDArray, ...]
    right: tuple[NDArray, ...]
    isotropy: NDArray
    printed_mean: NDArray
    right_mean: NDArray


def data() -> tuple[Zenith, Azimuth]:
    return _zenith(), _azimuth()


def _zenith() -> Zenith:
    import numpy as np

    fit = rf.derive("eq28z")
    angle = np.linspace(0, np.pi / 2, 721)
    t = np.cos(angle)
    curves = (curve(fit, t, f"r = {r:g}", {"r": r}, "beckmann", peak=fit(1.0, r=r)) for r in VALUES)
    return Zenith(angle, tuple(curves))


def _azimuth() -> Azimuth:
    import numpy as np

    fit, published = rf.derive("eq28a"), card("azimuth-as-printed")
    w, (p,) = published.problem.variable, published.problem.parameters
    printed = lower(published.published, [w, p])
    angle = np.linspace(0, np.pi / 2, 721)
    isotropy = np.geomspace(0.01, 1, 61)
    # The trapezoidal rule converges geometrically here: A is periodic in the azimuth, and even at both ends.
    fine = np.cos(np.linspace(0, np.pi / 2, 4001))
    return Azimuth(
        angle,
        printed=tuple(printed(np.cos(angle), each) for each in VALUES),
        right=tuple(fit(np.cos(angle), p=each) for each in VALUES),
        isotropy=isotropy,
        printed_mean=np.array([_mean(printed(fine, each)) for each in isotropy]),
        right_mean=np.array([_mean(fit(fine, p=each)) for each in isotropy]),
    )


def _mean(values: NDArray) -> float:
    import numpy as np

    return float(np.trapezoid(values) / (len(values) - 1))


def draw(found: tuple[Zenith, Azimuth], width: float = style.PAGE) -> Figure:
    zenith, azimuth = found
    with style.sheet(width, 55 + 0.85 * width) as figure:
        grid = figure.add_gridspec(3, 2, height_ratios=(5, 5, 3))
        halves = grid[0, 0].subgridspec(2, 1)
        axes = figure.add_subplot(halves[0], projection="polar")
        _draw_zenith(axes, zenith, [c.fit for c in zenith.curves])
        axes.set_title("$Z(t)$, Eq. 28")
        style.share_legend(figure, axes)
        below = figure.add_subplot(halves[1], projection="polar")
        _draw_zenith(below, zenith, [c.exact for c in zenith.curves])
        below.set_title("Beckmann's $D(t)$ at $m^2 = r$")
        for cell, heights, title in (
            (grid[0, 1], azimuth.printed, "$A(w)$ as printed, Eq. 28"),
            (grid[1, 1], azimuth.right, "$A(w)$ as Eq. 27 needs it"),
        ):
            disc = figure.add_subplot(cell, projection="polar")
            _draw_azimuth(disc, azimuth, heights)
            disc.set_title(title)
        _draw_zenith_errors(figure.add_subplot(grid[1, 0]), zenith)
        _draw_means(figure.add_subplot(grid[2, :]), azimuth)
    return figure


def _draw_zenith(axes: Axes, zenith: Zenith, heights: Sequence[NDArray]) -> None:
    labels = [f"$r, p = {value:g}$" for value in VALUES]
    radii = [style.mirrored(_logarithm(height)) for height in heights]
    style.draw_family(axes, labels, [style.mirrored(zenith.angle, -1)] * len(VALUES), radii)
    style.sector(axes, 90)
    style.decades(axes, *POWERS)


def _draw_azimuth(axes: Axes, azimuth: Azimuth, heights: Sequence[NDArray]) -> None:
    import numpy as np

    half = style.mirrored(azimuth.angle, -1)
    angle = np.concatenate([half, half + np.pi])
    radii = [np.tile(style.mirrored(_logarithm(height)), 2) for height in heights]
    style.draw_family(axes, [f"$p = {p:g}$" for p in VALUES], [angle] * len(VALUES), radii)
    ticks = range(0, 360, 45)
    axes.set_xticks([math.radians(tick) for tick in ticks], [f"{tick}°" for tick in ticks])
    axes.tick_params(axis="x", pad=-2)
    style.decades(axes, *POWERS)


def _logarithm(height: NDArray) -> NDArray:
    """The radius: the decimal logarithm, cut at the centre."""
    import numpy as np

    return np.log10(np.maximum(height, 10.0 ** POWERS[0]))


def _draw_zenith_errors(axes: Axes, zenith: Zenith) -> None:
    import numpy as np

    draw_strip(axes, zenith.curves, "", [np.degrees(zenith.angle)] * len(VALUES))
    axes.set(xlim=(0, 90), xlabel=r"$\alpha$", ylabel=r"$Z - D$, parts of $1/r$")
    axes.set_xticks(range(0, 91, 30), [f"{tick}°" for tick in range(0, 91, 30)])


def _draw_means(axes: Axes, azimuth: Azimuth) -> None:
    draw_error_curve(axes, azimuth.isotropy, azimuth.printed_mean - 1, label="as printed")
    draw_error_curve(axes, azimuth.isotropy, azimuth.right_mean - 1, label="as Eq. 27 needs it")
    axes.set(xscale="log", xlim=(0.01, 1), xlabel="$p$")
