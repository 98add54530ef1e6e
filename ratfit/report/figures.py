"""The two figures of a problem: its error over the domain, and what accuracy costs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ratfit.report.document import Figure, printable
from ratfit.report.svg import INK, SERIES, SETTINGS, svg_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

WIDTH = 5.6
"""Inches; on a phone the figure is shown near this size, on a desk at half as much again."""

MOST = 5
"""Curves that a figure can hold and stay legible."""

LETTERS = 40
"""Letters of an entry of a legend."""

MARKERS = ("o", "s", "^", "D", "v", "P")


@dataclass(frozen=True)
class ErrorCurve:
    """The error of a fit over its domain, in bins, as a row of a record holds it."""

    label: str
    variable: str
    edges: Sequence[float]
    exact: Sequence[float | None]
    fit: Sequence[float | None]
    bias: Sequence[float | None]
    absolute_max: Sequence[float | None]

    @property
    def peak(self) -> float:
        """The largest size of the exact function in the bins."""
        return max((abs(v) for v in self.exact if v is not None), default=0.0)


@dataclass(frozen=True)
class Point:
    """One measured row in the plane of gamma and eps; `series` says which method it is of."""

    series: str
    label: str
    gamma: float
    low: float | None
    high: float | None
    epsilon: float


def error_figure(name: str, curves: Sequence[ErrorCurve], against: str) -> Figure:
    """Exact function and fit above, the signed mean error of each bin below.

    Arguments: `name` of the figure in its document; `curves` of one problem at several settings of its parameters, of
    which at most MOST are drawn, spread evenly; `against`, the exact function's name. Where the peaks of the settings
    differ much, everything is drawn in parts of each one's peak.
    """
    shown = _spread(curves)
    scaled = _differ([curve.peak for curve in shown])
    unit = " / peak" if scaled else ""
    with _drawing(4.6) as drawing:
        above, below = drawing.subplots(2, sharex=True, height_ratios=(3, 2))
        for number, curve in enumerate(shown):
            _draw_curve(above, below, curve, SERIES[number], 1 / curve.peak if scaled else 1.0, len(shown) == 1)
        below.axhline(0, color=INK, linewidth=0.8)
        above.set_ylabel(f"value{unit}")
        below.set_ylabel(f"error{unit}")
        below.set_xlabel(_short(shown[0].variable))
        if len(shown) > 1:
            _legend(drawing, [(SERIES[n], "", curve.label) for n, curve in enumerate(shown)])
        alt = f"{against} and its fit, and the fit's error, over {shown[0].variable}"
        svg = svg_of(drawing, name, printable(alt), {})
    return Figure(name, svg, _error_caption(shown, len(curves), against, scaled), alt)


def _error_caption(shown: Sequence[ErrorCurve], count: int, against: str, scaled: bool) -> str:
    single = len(shown) == 1
    words = [
        f"Above: {against} as the wide pale line, the fit as the thin one"
        + (f", at {shown[0].label}." if single and shown[0].label else "."),
        f"Below: fit − exact, the mean of each of {len(shown[0].bias)} bins"
        + ("; pale, the largest error of each." if single else "."),
    ]
    if scaled:
        words.append("Values and errors are parts of each setting's peak.")
    if len(shown) < count:
        words.append(f"{len(shown)} of {count} settings are drawn.")
    return " ".join(words)


def _draw_curve(above: Axes, below: Axes, curve: ErrorCurve, colour: str, scale: float, single: bool) -> None:
    middles = [(low + high) / 2 for low, high in zip(curve.edges, curve.edges[1:], strict=False)]
    above.plot(middles, _scaled(curve.exact, scale), color=colour, linewidth=6, alpha=0.3, solid_capstyle="butt")
    above.plot(middles, _scaled(curve.fit, scale), color=colour, linewidth=1.5)
    if single:
        worst = _scaled(curve.absolute_max, scale)
        below.stairs(worst, curve.edges, baseline=[-w for w in worst], fill=True, color=colour, alpha=0.2, linewidth=0)
    below.stairs(_scaled(curve.bias, scale), curve.edges, baseline=None, color=colour, linewidth=1.5)


def _scaled(values: Sequence[float | None], scale: float) -> list[float]:
    return [math.nan if value is None else value * scale for value in values]


def cost_figure(name: str, points: Sequence[Point], definition: str, backend: str) -> Figure | None:
    """gamma against eps, a mark a row, a shape and colour a method; None where there is nothing to draw.

    Both axes are logarithmic. What has an eps of 0 stands, hollow, on the lower edge.
    """
    positive = [point.epsilon for point in points if point.epsilon > 0]
    if not points:
        return None
    floor = min(positive, default=1e-16) / 10
    series = list(dict.fromkeys(point.series for point in points))
    with _drawing(3.7) as drawing:
        axes = drawing.subplots()
        titles = {}
        for number, point in enumerate(points):
            style = series.index(point.series) % len(SERIES)
            _draw_point(axes, point, floor, style, f"point-{number}")
            titles[f"point-{number}"] = printable(point.label)
        _logarithmic(axes, points, floor)
        axes.set_xlabel(f"gamma on {_short(backend)}")
        axes.set_ylabel(f"eps, {_short(definition)}")
        styles = [(SERIES[n % len(SERIES)], MARKERS[n % len(SERIES)], one) for n, one in enumerate(series)]
        _legend(drawing, styles)
        alt = f"{definition} against gamma on {backend}: {', '.join(series)}"
        svg = svg_of(drawing, name, printable(alt), titles)
    hollow = " Hollow marks have an eps of 0." if len(positive) < len(points) else ""
    caption = f"Better is right (faster) and down (closer). A line through a mark is gamma's 95 % interval.{hollow}"
    return Figure(name, svg, caption, alt)


def _draw_point(axes: Axes, point: Point, floor: float, style: int, gid: str) -> None:
    colour, height = SERIES[style], point.epsilon if point.epsilon > 0 else floor
    if point.low and point.high:
        axes.plot((point.low, point.high), (height, height), color=colour, linewidth=1.5, alpha=0.7)
    (mark,) = axes.plot(
        [point.gamma], [height], MARKERS[style], color=colour, markersize=8, linestyle="none", clip_on=False,
        markerfacecolor=colour if point.epsilon > 0 else "none",
    )  # fmt: skip
    mark.set_gid(gid)


def _logarithmic(axes: Axes, points: Sequence[Point], floor: float) -> None:
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    gammas = [g for p in points for g in (p.gamma, p.low, p.high) if g]
    heights = [p.epsilon if p.epsilon > 0 else floor for p in points]
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(*_room(gammas, 1.5))
    axes.set_ylim(*_room(heights, 2.0))
    for axis, (low, high) in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
        decades = math.log10(high / low)
        steps = (1.0, 2.0, 5.0) if decades < 3 else (1.0,)
        axis.set_major_locator(LogLocator(subs=steps, numticks=8))
        axis.set_minor_locator(NullLocator())
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.3g}"))


def _room(values: Sequence[float], least: float) -> tuple[float, float]:
    """The values' range on a logarithmic axis, with a margin, and never so narrow that no tick falls into it."""
    low, high = min(values), max(values)
    margin = max(least, (high / low) ** 0.08)
    return low / margin, high * margin


@contextmanager
def _drawing(height: float) -> Iterator[Drawing]:
    import matplotlib
    from matplotlib.figure import Figure as Drawing

    with matplotlib.rc_context(SETTINGS):  # type: ignore[arg-type]
        yield Drawing(figsize=(WIDTH, height), layout="constrained")


def _legend(drawing: Drawing, entries: Sequence[tuple[str, str, str]]) -> None:
    """Entries (colour, marker or none, text) below the axes, clear of the data."""
    from matplotlib.lines import Line2D

    handles: list[Any] = []
    for colour, marker, _ in entries:
        handles.append(Line2D([], [], color=colour, marker=marker, linestyle="none" if marker else "-", markersize=8))
    texts = [_short(text) for _, _, text in entries]
    columns = max(1, min(len(texts), 64 // (6 + max(map(len, texts)))))
    # A text that begins with an underscore would hide its entry: places are kept by letters, and filled afterwards.
    legend = drawing.legend(handles, ["n" * len(t) for t in texts], loc="outside lower center", ncols=columns)
    for shown, text in zip(legend.get_texts(), texts, strict=True):
        shown.set_text(text)


def _short(text: str) -> str:
    text = printable(" ".join(text.split()))
    return text if len(text) <= LETTERS else text[: LETTERS - 2] + " …"


def _spread(curves: Sequence[ErrorCurve]) -> list[ErrorCurve]:
    if len(curves) <= MOST:
        return list(curves)
    return [curves[round(k * (len(curves) - 1) / (MOST - 1))] for k in range(MOST)]


def _differ(peaks: Sequence[float]) -> bool:
    return min(peaks) > 0 and max(peaks) > 4 * min(peaks)
