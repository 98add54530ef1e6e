"""Figure 6: Smith's shadowing factor as printed, Eq. 18, and Eq. 19; beneath, the right functions and all errors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import ratfit as rf
from paper_figures import style
from paper_figures.curves import Curve, curve, printed_error
from paper_figures.strip import draw_strip
from paper_figures.style import percent
from ratfit.gallery import card

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LEAST = 0.001
"""Where the logarithmic axis begins."""


@dataclass(frozen=True)
class Smith:
    """Eq. 19 against three functions, one curve for each m: Eq. 18, Smith's own, and the one used today."""

    values: tuple[float, ...]
    printed: tuple[Curve, ...]
    smith: tuple[Curve, ...]
    walter: tuple[Curve, ...]


def data() -> Smith:
    import numpy as np

    fit = rf.derive("eq19")
    # Close to both ends: the steepest curves rise within m of 0, and Eq. 18 falls short of 1 until just before v = 1.
    v = np.concatenate([[0.0], np.geomspace(1e-4, 0.5, 300), 1 - np.geomspace(0.5, 1e-7, 201)[1:]])
    values = tuple(float(setting["m"]) for setting in card("eq19").settings)
    return Smith(
        values,
        *(
            tuple(curve(fit, v, f"m = {m:g}", {"m": m}, reference) for m in values)
            for reference in (None, "smith-1967", "walter-2007")
        ),
    )


def draw(found: Smith, width: float = style.PAGE) -> Figure:
    strips = ("to printed", "to smith", "to walter")
    rows = [["printed", "fit"], ["smith", "walter"], *([name, name] for name in strips)]
    with style.sheet(width, 70 + 0.75 * width) as figure:
        panels = figure.subplot_mosaic(rows, height_ratios=(5, 5, 3, 3, 3))
        _draw_functions(panels, found)
        _draw_errors([panels[name] for name in strips], found)
        style.share_legend(figure, panels["printed"])
    return figure


def _draw_functions(panels: Mapping[str, Axes], found: Smith) -> None:
    labels, places = style.family("m", found.values), [c.places for c in found.printed]
    for name, title, heights in (
        ("printed", "True function as printed: Eq. 18", [c.exact for c in found.printed]),
        ("fit", "Rational approximation: Eq. 19", [c.fit for c in found.printed]),
        ("smith", "Smith's own: Smith 1967", [c.exact for c in found.smith]),
        ("walter", "Used today: Walter 2007", [c.exact for c in found.walter]),
    ):
        axes = panels[name]
        style.draw_family(axes, labels, places, heights)
        axes.set_title(title)
        axes.set(xlim=(0, 1), ylim=(0, 1.02), xlabel="$v$")
        style.unit_ticks(axes.xaxis, 0.25)
        style.unit_ticks(axes.yaxis, 0.5)
    for name in ("printed", "smith"):
        panels[name].set_ylabel("$G(v)$")


def _draw_errors(strips: Sequence[Axes], found: Smith) -> None:
    """Over a logarithmic v, where five curves that rise within m of 0 stand apart."""
    for axes, curves, name in zip(
        strips, (found.printed, found.smith, found.walter), ("Eq. 18", "Smith 1967", "Walter 2007"), strict=True
    ):
        draw_strip(axes, curves, f"Eq. 19 − {name}, at worst:")
        axes.set_xscale("log")
        axes.set_xlim(LEAST, 1)
        ticks = [0.001, 0.01, 0.1, 1]
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks] if axes is strips[-1] else [])
    strips[-1].set_xlabel("$v$, logarithmic")


def caption(found: Smith) -> str:
    def worst(curves: Sequence[Curve]) -> str:
        return " to ".join(f"{percent(c.worst[1])} at {c.label}" for c in (curves[0], curves[-1]))

    return (
        "Smith's factor over v, the cosine of the angle, for five slopes m. First row, as the paper drew it: Eq. 18 "
        "and Eq. 19. Second row, what the paper did not show: Eq. 18 lacks an exponential, Smith's own function has "
        "it, and the function used today rises twice as steeply at v = 0. Beneath: the errors of Eq. 19 against each "
        "of the three, in percent of 1, their largest value, over a logarithmic v, with the worst point of each curve "
        f"marked, from {worst(found.printed)} against Eq. 18, from "
        f"{worst(found.smith)} against Smith's, and from {worst(found.walter)} against today's. The paper prints "
        f"{printed_error('eq19')}."
    )
