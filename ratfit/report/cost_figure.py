"""Accuracy against cost: eps over gamma, a mark a measured row."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ratfit.report.document import Figure, printable
from ratfit.report.drawing import drawing, label, legend
from ratfit.report.svg import SERIES, svg_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MARKERS = ("o", "s", "^", "D", "v", "P")

_SMALLEST, _LARGEST = 1e-150, 1e150  # beyond these a picture's own arithmetic overflows


@dataclass(frozen=True)
class Point:
    """One measured row in the plane of gamma and eps; `series` says which method it is of, `label` all about it."""

    series: str
    label: str
    gamma: float
    low: float | None
    high: float | None
    epsilon: float

    @property
    def can_be_drawn(self) -> bool:
        """Whether gamma has a place on a logarithmic axis, and eps one on it or, being 0, on its lower edge."""
        return _SMALLEST < self.gamma < _LARGEST and (self.epsilon == 0 or _SMALLEST < self.epsilon < _LARGEST)


def cost_figure(name: str, points: Sequence[Point], definition: str, where: str) -> Figure | None:
    """gamma against eps, a shape and colour a method; None where there is nothing to draw.

    Arguments: `name` of the figure in its document; `points`; `definition` of their eps; `where` gamma was measured.
    Both axes are logarithmic. What has an eps of 0 stands, hollow, on the lower edge.
    """
    shown = [point for point in points if point.can_be_drawn]
    if not shown:
        return None
    floor = min((point.epsilon for point in shown if point.epsilon), default=1e-16) / 10
    series = list(dict.fromkeys(point.series for point in shown))
    with drawing(3.7) as figure:
        axes = figure.subplots()
        for place, point in enumerate(shown):
            _draw(axes, point, floor, series.index(point.series) % len(SERIES), f"point-{place}")
        _make_logarithmic(axes, shown, floor)
        axes.set_xlabel(f"gamma on {label(where)}")
        axes.set_ylabel(f"eps, {label(definition)}")
        legend(figure, [(SERIES[n % len(SERIES)], MARKERS[n % len(SERIES)], one) for n, one in enumerate(series)])
        alt = printable(f"{definition} against gamma on {where}: {', '.join(series)}")
        titles = {f"point-{place}": printable(point.label) for place, point in enumerate(shown)}
        svg = svg_of(figure, name, alt, titles)
    return Figure(name, svg, " ".join(_caption(points, shown)), alt)


def _caption(points: Sequence[Point], shown: Sequence[Point]) -> list[str]:
    words = ["Better is right (faster) and down (closer)."]
    if any(point.low and point.high for point in shown):
        words.append("A line through a mark is gamma's 95 % interval.")
    if any(point.epsilon == 0 for point in shown):
        words.append("Hollow marks have an eps of 0.")
    if len(shown) < len(points):
        words.append(f"{len(points) - len(shown)} of {len(points)} rows have no place on these axes.")
    return words


def _draw(axes: Axes, point: Point, floor: float, style: int, gid: str) -> None:
    colour, height = SERIES[style], point.epsilon or floor
    if point.low and point.high:
        axes.plot((point.low, point.high), (height, height), color=colour, linewidth=1.5, alpha=0.7)
    (mark,) = axes.plot([point.gamma], [height], MARKERS[style], color=colour, markersize=8, clip_on=False)
    mark.set_markerfacecolor(colour if point.epsilon else "none")
    mark.set_gid(gid)


def _make_logarithmic(axes: Axes, points: Sequence[Point], floor: float) -> None:
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    axes.autoscale(False)  # to the points alone, of which there may be one, an axis would have no width
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(*_room([gamma for p in points for gamma in (p.gamma, p.low, p.high) if gamma], 1.5))
    axes.set_ylim(*_room([point.epsilon or floor for point in points], 2.0))
    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        axis.set_major_locator(LogLocator(subs=_steps(math.log10(high / low)), numticks=9))
        axis.set_minor_locator(NullLocator())
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.3g}"))


def _steps(decades: float) -> tuple[float, ...]:
    """Where within a decade ticks stand, so that a short axis has some and a long one not too many."""
    if decades < 1:
        return (1.0, 2.0, 3.0, 5.0, 7.0)
    return (1.0, 2.0, 5.0) if decades < 3 else (1.0,)


def _room(values: Sequence[float], least: float) -> tuple[float, float]:
    """The values' range on a logarithmic axis, with a margin, and never so narrow that no tick falls into it."""
    low, high = min(values), max(values)
    margin = max(least, (high / low) ** 0.08)
    return low / margin, high * margin
