"""Figure 5: the Fresnel factor of diamond, glass, copper and gold, and Eq. 15; beneath, the error of each."""

from __future__ import annotations

from typing import TYPE_CHECKING

import ratfit as rf
from paper_figures import style
from paper_figures.curves import Curve, curve, printed_error
from paper_figures.strip import draw_strip
from paper_figures.style import percent, share
from ratfit.plot.text import significant

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MATERIALS = ("diamond", "glass", "copper", "gold")


def data() -> tuple[Curve, ...]:
    import numpy as np

    fit = rf.derive("eq15")  # the conditions leave the exponent open; the card records the paper's choice, 5
    u = np.linspace(0, 1, 801)
    return tuple(curve(fit, u, material, reference=material) for material in MATERIALS)


def draw(found: tuple[Curve, ...], width: float = style.PAGE) -> Figure:
    with style.sheet(width, 45 + 0.45 * width) as figure:
        panels = figure.subplot_mosaic([["true", "fit"], ["error", "error"]], height_ratios=(3, 2))
        labels, places = [curve.label for curve in found], [curve.places for curve in found]
        style.draw_family(panels["true"], labels, places, [curve.exact for curve in found])
        style.draw_family(panels["fit"], labels, places, [curve.fit for curve in found])
        panels["true"].set_title("True function: Eq. 13")
        panels["fit"].set_title("Rational approximation: Eq. 15")
        draw_strip(panels["error"], found, "Eq. 15 − Eq. 13, at worst:")
        for name, axes in panels.items():
            axes.set_xlim(0, 1)
            style.unit_ticks(axes.xaxis, 0.25)
            axes.set_xlabel("$u$")
            if name != "error":
                axes.set_ylim(0, 1.02)
                style.unit_ticks(axes.yaxis, 0.25)
        panels["true"].set_ylabel(r"$F_\lambda(u)$")
        style.share_legend(figure, panels["true"])
    return figure


def caption(found: tuple[Curve, ...]) -> str:
    each = ", ".join(
        f"{c.label} {percent(c.worst[1])} at u = {significant(c.worst[0], 2)} ({share(c.mean)} on average)"
        for c in found
    )
    return (
        "The Fresnel factor over u, the cosine of the angle of incidence. Above, as the paper drew it: the true "
        "function, and Eq. 15, which knows of a material its reflectance at u = 1 alone. Beneath: the error, in "
        f"percent of full reflection, with the worst point of each material: {each}. The paper prints "
        f"{printed_error('eq15')} and no optical constants: the metals are the rows of Johnson and Christy's "
        "table nearest to 589 nm."
    )
