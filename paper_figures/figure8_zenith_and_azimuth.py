"""Figure 8: the directional factors Z and A of Eq. 28 in logarithmic polar coordinates; beneath, Beckmann's function,
the A that keeps Eq. 27, and how far the printed ones are from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import ratfit as rf
from paper_figures import style
from paper_figures.curves import Curve, curve
from paper_figures.polar import draw_disc, draw_lobes, draw_sector
from paper_figures.strip import draw_strip
from paper_figures.style import percent
from ratfit._lower import lower
from ratfit.gallery import card
from ratfit.plot.style import SERIES
from ratfit.plot.text import significant

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

VALUES = (0.01, 0.05, 0.2, 0.5, 1.0)
"""The values of r and of p."""

CENTRE = 1e-3
"""What stands in the centre of the logarithmic polar coordinates."""

RINGS = {1.0: "0.01", 2.0: "", 3.0: "1", 4.0: "", 5.0: "100"}
"""Decades above the centre, with what they are called."""

RIM = 5.1

WIDE = [["zenith", "printed", "right"], ["beckmann", "printed", "right"], ["errors"] * 3, ["means"] * 3]
TALL = [["zenith", "printed"], ["beckmann", "right"], ["errors"] * 2, ["means"] * 2]


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
    angle = np.linspace(0, np.pi / 2, 541)
    t = np.cos(angle)
    curves = (curve(fit, t, f"r = {r:g}", {"r": r}, "beckmann", peak=fit(1.0, r=r)) for r in VALUES)
    return Zenith(angle, tuple(curves))


def _azimuth() -> Azimuth:
    import numpy as np

    fit, published = rf.derive("eq28a"), card("azimuth-as-printed")
    w, (p,) = published.problem.variable, published.problem.parameters
    printed = lower(published.published, [w, p])
    angle = np.linspace(0, np.pi / 2, 541)
    isotropy = np.unique([*np.geomspace(0.01, 1, 61), *VALUES])
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
    rows, heights, height = (WIDE, (5, 5, 5, 4), 165) if width > style.NARROW else (TALL, (8, 8, 6, 5), 165)
    with style.sheet(width, height) as figure:
        panels = figure.subplot_mosaic(rows, height_ratios=heights)
        _draw_zenith(panels["zenith"], "$Z(t)$: Eq. 28", zenith, [c.fit for c in zenith.curves])
        _draw_zenith(panels["beckmann"], "Beckmann's $D(t)$, $m^2 = r$", zenith, [c.exact for c in zenith.curves])
        _draw_azimuth(panels["printed"], "$A(w)$ as printed: Eq. 28", azimuth, azimuth.printed)
        _draw_azimuth(panels["right"], "$A(w)$ that keeps Eq. 27", azimuth, azimuth.right)
        _draw_zenith_errors(panels["errors"], zenith)
        _draw_means(panels["means"], azimuth)
        style.share_legend(figure, panels["zenith"])
    return figure


def _draw_zenith(axes: Axes, title: str, zenith: Zenith, heights: Sequence[NDArray]) -> None:
    draw_lobes(axes, style.family("r, p", VALUES), [zenith.angle] * len(VALUES), [radius(height) for height in heights])
    draw_sector(axes, title, RIM, 90, RINGS, 30)


def _draw_azimuth(axes: Axes, title: str, azimuth: Azimuth, heights: Sequence[NDArray]) -> None:
    """The first quadrant and its mirror images; phi runs from the right, so the lobes stand upright."""
    import numpy as np

    angle = np.pi / 2 - azimuth.angle[::-1]
    whole = np.concatenate([angle, np.pi - angle[::-1]])
    radii = [radius(np.concatenate([height[::-1], height])) for height in heights]
    draw_lobes(axes, [f"$p = {p:g}$" for p in VALUES], [whole] * len(VALUES), radii)
    draw_disc(axes, title, RIM, RINGS, 45)


def radius(height: NDArray) -> NDArray:
    """Decades above the centre."""
    import numpy as np

    return np.log10(np.maximum(height, CENTRE) / CENTRE)


def _draw_zenith_errors(axes: Axes, zenith: Zenith) -> None:
    import numpy as np

    draw_strip(axes, zenith.curves, "$(Z - D)\\,/\\,(1/r)$, at worst:", [np.degrees(zenith.angle)] * len(VALUES))
    axes.set(xlim=(0, 90), xlabel=r"$\alpha$")
    axes.set_xticks(range(0, 91, 15), [f"{tick}°" for tick in range(0, 91, 15)])


def _draw_means(axes: Axes, azimuth: Azimuth) -> None:
    axes.plot(azimuth.isotropy, azimuth.printed_mean, color=style.INK, label="as printed")
    axes.plot(azimuth.isotropy, azimuth.right_mean, color=style.INK, linestyle="--", label="that keeps Eq. 27")
    axes.set_title("Mean of $A$ over the azimuth; Eq. 27 wants 1", loc="left")
    for p, (colour, _) in zip(VALUES, SERIES, strict=False):
        mean = azimuth.printed_mean[abs(azimuth.isotropy - p).argmin()]
        axes.plot([p], [mean], "o", color=colour, clip_on=False, zorder=4)
        side = {VALUES[0]: "left", VALUES[-1]: "right"}.get(p, "center")
        shift = {"left": 3, "right": 0, "center": 0}[side]
        axes.annotate(significant(mean, 2), (p, mean), (shift, -5), textcoords="offset points", ha=side, va="top")
    axes.set(xscale="log", xlim=(0.01, 1), ylim=(0, 1.1), xlabel="$p$")
    axes.set_xticks([0.01, 0.1, 1], ["0.01", "0.1", "1"])
    axes.set_yticks([0, 0.5, 1], ["0", "0.5", "1"])
    axes.legend(loc="lower right")


def caption(found: tuple[Zenith, Azimuth]) -> str:
    zenith, azimuth = found
    mean = significant(azimuth.printed_mean[0], 2)
    low, *_, high = zenith.curves
    return (
        "The directional factors in logarithmic polar coordinates, with 0.001 in the centre and 100 at the rim. Above, "
        "as the paper drew it: Z over the angle to the normal, and A over the azimuth. Beside them what the paper did "
        "not show. Z, which is pi times the GGX distribution with alpha^2 = r, takes the place of Beckmann's function: "
        "both are 1/r at the normal, where Z falls faster at first and has the longer tail. Their difference, in parts "
        f"of 1/r, is at worst {percent(low.worst[1])} for r = 0.01 and {percent(high.worst[1])} for r = 1, where Z is "
        "the constant 1. A as printed has the mean over the azimuth that Eq. 27 asks for, 1, at p = 1 alone, and "
        f"{mean} at p = 0.01; its square keeps Eq. 27 for every p."
    )
