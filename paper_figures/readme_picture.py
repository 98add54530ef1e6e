"""What ratfit does, at one glance: conditions and the formula they give, exact function and fit, and the error."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import ratfit as rf
from paper_figures import style
from paper_figures.curves import Curve, curve
from paper_figures.strip import draw_strip
from paper_figures.style import percent
from ratfit.gallery import card
from ratfit.plot.style import SERIES
from ratfit.plot.text import mathematics

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LARGER = 1.3
"""The words, beside the type of the curves."""


@dataclass(frozen=True)
class Glance:
    """A fit, and its curves beside the exact function for some values of m."""

    fit: rf.Fit
    values: tuple[float, ...]
    curves: tuple[Curve, ...]


def data() -> Glance:
    import numpy as np

    fit = rf.derive("eq19")
    v = np.concatenate([[0.0], np.geomspace(1e-4, 0.5, 300), 1 - np.geomspace(0.5, 1e-7, 201)[1:]])
    values = tuple(float(setting["m"]) for setting in card("eq19").settings)
    return Glance(fit, values, tuple(curve(fit, v, f"m = {m:g}", {"m": m}) for m in values))


def draw(found: Glance, width: float = style.PAGE) -> Figure:
    if width > style.NARROW:
        rows, shares, height = [["words", "curves"], ["words", "error"]], {"width_ratios": (2, 3)}, 100
    else:
        rows, shares, height = [["words"], ["curves"], ["error"]], {}, 150
    with style.sheet(width, height) as figure:
        panels = figure.subplot_mosaic(rows, height_ratios=(3, 2) if len(rows) == 2 else (2, 3, 2), **shares)
        _write(panels["words"], found.fit)
        _draw_curves(panels["curves"], found)
        draw_strip(panels["error"], found.curves, "Fit − exact, at worst:")
        for name in ("curves", "error"):
            panels[name].set_xlim(0, 1)
            style.unit_ticks(panels[name].xaxis, 0.25)
        panels["error"].set_xlabel("$v$")
    return figure


def _draw_curves(axes: Axes, found: Glance) -> None:
    """The exact functions wide and pale, the fits thin on top of them."""
    for each, label, (colour, dashes) in zip(found.curves, style.family("m", found.values), SERIES, strict=False):
        axes.plot(each.places, each.exact, color=colour, alpha=0.25, linewidth=4, solid_capstyle="butt")
        axes.plot(each.places, each.fit, color=colour, linestyle=dashes, label=label)
    axes.set_ylim(0, 1.02)
    style.unit_ticks(axes.yaxis, 0.5)
    axes.set_ylabel("$G(v)$")
    style.head(axes, "Exact (wide), fit (thin):")


def _write(axes: Axes, fit: rf.Fit) -> None:
    """What must stay exact, the formula found, and what it costs: from the fit itself."""
    cost = ", ".join(f"{count} {operation}" for operation, count in fit.cost.as_dict().items() if count)
    size = LARGER * axes.title.get_fontsize()
    down = 0.0
    for text, weight, lines in (
        ("Say what must stay exact:", "bold", 2.0),
        *((f"✓  ${kept}$", "normal", 2.0 + 1.5 * ("frac" in kept)) for kept in _kept(fit)),
        ("get the cheapest formula\nthat keeps it:", "bold", 4.0),
        (f"${mathematics(fit.expression)}$", "normal", 4.5),
        (f"for {cost} a sample", "normal", 2.0),
    ):
        down += lines * size / 2
        axes.annotate(text, (0, 1), (0, -down), "axes fraction", "offset points", va="center", weight=weight, size=size)
        down += lines * size / 2
    axes.set_axis_off()


def _kept(fit: rf.Fit) -> list[str]:
    return [
        f"G{'′' * (checked.condition.kind == 'derivative')}({checked.condition.place}) = {mathematics(checked.demand)}"
        for checked in fit.conditions
    ]


def caption(found: Glance) -> str:
    first, *_, last = found.curves
    return (
        "Smith's shadowing factor for five slopes m: three conditions, the formula that they give, the exact function "
        "of the 1994 paper beside it, and the error, at worst "
        f"{percent(first.worst[1])} at {first.label} and {percent(last.worst[1])} at {last.label}."
    )
