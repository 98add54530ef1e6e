"""How facts are marked on a curve, the same in all pictures: dots, short tangents, dashed asymptotes, dotted poles."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from ratfit.plot.style import BLUE, GREEN, ORANGE, RED

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True)
class Window:
    """The part of the plane that is seen."""

    left: float
    right: float
    bottom: float
    top: float


@dataclass(frozen=True)
class Marker:
    """How a point is marked."""

    shape: str = "o"
    colour: str = BLUE
    is_filled: bool = True
    size: float = 7.0


def draw_point(axes: Axes, place: float, height: float, marker: Marker) -> Any:
    """A marker at a point; at the edge of the axes it stands over them."""
    (dot,) = axes.plot(
        [place],
        [height],
        marker.shape,
        linestyle="none",
        markersize=marker.size,
        color=marker.colour,
        markerfacecolor=marker.colour if marker.is_filled else "none",
        markeredgewidth=1.4,
        clip_on=False,
        zorder=5,
    )
    return dot


def draw_tangent(
    axes: Axes, window: Window, point: tuple[float, float], slope: float, room: float, colour: str = ORANGE
) -> Any:
    """A short tangent, of the same length on paper everywhere, that reaches at most `room` to each side."""
    place, height = point
    across, up = window.right - window.left, window.top - window.bottom
    half = min(0.058 / math.hypot(1 / across, slope / up), room)
    (line,) = axes.plot(
        (place - half, place + half),
        (height - slope * half, height + slope * half),
        color=colour,
        linewidth=3.2,
        solid_capstyle="round",
        zorder=1.5,
    )
    return line


def room_between(places: Iterable[float], width: float) -> float:
    """How far a tangent may reach and meet no other: a third of the smallest distance between different places."""
    ordered = sorted({p for p in places if math.isfinite(p)})
    return 0.35 * min((b - a for a, b in pairwise(ordered)), default=width)


def draw_asymptote(axes: Axes, places: Sequence[float], heights: Sequence[float], colour: str = GREEN) -> Any:
    (line,) = axes.plot(places, heights, "--", color=colour, linewidth=1.2, zorder=1)
    return line


def draw_pole(axes: Axes, place: float) -> Any:
    return axes.axvline(place, linestyle=":", color=RED, linewidth=1.6, zorder=1)
