"""Curves in polar coordinates about a vertical normal, drawn on plain axes: a lobe may then fill its panel."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from paper_figures.style import GRID, INK
from ratfit.plot.style import SERIES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray


def draw_lobes(axes: Axes, labels: Sequence[str], angles: Sequence[NDArray], radii: Sequence[NDArray]) -> None:
    """Lobes that are symmetric about the normal; angles in radians, from 0 at the normal, radii from the centre."""
    import numpy as np

    for label, angle, radius, (colour, dashes) in zip(labels, angles, radii, SERIES, strict=False):
        both, far = np.append(-angle[:0:-1], angle), np.append(radius[:0:-1], radius)
        axes.plot(far * np.sin(both), far * np.cos(both), color=colour, linestyle=dashes, label=label, zorder=3)


def draw_sector(axes: Axes, title: str, rim: float, degrees: int, rings: Mapping[float, str], step: int) -> None:
    """The grid of a sector about the vertical: spokes every `step` degrees, and a ring at each radius with its text.

    Arguments: `rim`, the radius where the spokes end; `degrees`, how far it opens to each side, at most 90; `rings`.
    """
    for radius in rings:
        _arc(axes, radius, degrees, GRID)
    _arc(axes, rim, degrees, INK)
    for tick in range(-degrees, degrees + 1, step):
        _spoke(axes, rim, tick, INK if abs(tick) == degrees else GRID, f"{abs(tick)}°")
    size, down = axes.xaxis.get_ticklabels()[0].get_fontsize(), math.radians(degrees)
    for radius, text in rings.items():
        for side in (-1, 1) if degrees == 90 else (-1,):
            axes.annotate(
                text,
                (side * radius * math.sin(down), radius * math.cos(down)),
                xytext=(0, -5) if degrees == 90 else (-3, -2),  # clear of the angles at the rim
                textcoords="offset points",
                ha="center" if degrees == 90 else "right",
                va="top",
                fontsize=size,
            )
    _frame(axes, title, (-rim * math.sin(down), rim * math.sin(down)), (0, rim))


def draw_disc(axes: Axes, title: str, rim: float, rings: Mapping[float, str], step: int) -> None:
    """The grid of a whole disc, its angles counted from the right, with the scale of the radius beneath it."""
    for radius in (*rings, rim):
        _arc(axes, radius, 180, INK if radius == rim else GRID)
    for tick in range(0, 360, step):
        _spoke(axes, rim, 90 - tick, GRID, f"{tick}°")
    size, low = axes.xaxis.get_ticklabels()[0].get_fontsize(), -1.22 * rim
    axes.plot([0, rim], [low, low], color=INK, linewidth=axes.spines["left"].get_linewidth())
    for radius, text in rings.items():
        axes.plot([radius, radius], [low, low + 0.04 * rim], color=INK, linewidth=axes.spines["left"].get_linewidth())
        axes.annotate(text, (radius, low), (0, -2), textcoords="offset points", ha="center", va="top", fontsize=size)
    _frame(axes, title, (-rim, rim), (low, rim))


def _arc(axes: Axes, radius: float, degrees: int, colour: str) -> None:
    import numpy as np

    angle = np.radians(np.linspace(-degrees, degrees, 181))
    axes.plot(radius * np.sin(angle), radius * np.cos(angle), color=colour, linewidth=_thin(axes, colour), zorder=1)


def _spoke(axes: Axes, rim: float, degrees: float, colour: str, text: str) -> None:
    x, y = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    axes.plot([0, rim * x], [0, rim * y], color=colour, linewidth=_thin(axes, colour), zorder=1)
    ha = "center" if abs(x) < 0.3 else "left" if x > 0 else "right"
    va = "center" if abs(y) < 0.3 else "bottom" if y > 0 else "top"
    size = axes.xaxis.get_ticklabels()[0].get_fontsize()
    axes.annotate(text, (rim * x, rim * y), (2.5 * x, 2.5 * y), textcoords="offset points", ha=ha, va=va, fontsize=size)


def _thin(axes: Axes, colour: str) -> float:
    return axes.spines["left"].get_linewidth() * (1.0 if colour == INK else 0.7)


def _frame(axes: Axes, title: str, across: tuple[float, float], up: tuple[float, float]) -> None:
    """What is written at the rim stands outside of the frame; the layout makes room for it, and so does the title."""
    axes.set(xlim=across, ylim=up, aspect="equal")
    axes.set_axis_off()
    for artist in (*axes.lines, *axes.texts):
        artist.set_clip_on(False)
    axes.set_title(title, pad=1.7 * axes.title.get_fontsize())
