"""The error of a fit over its domain: exact function and fit above, their difference below."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ratfit.report.document import Figure, printable
from ratfit.report.drawing import drawing, label, legend
from ratfit.report.measured import number
from ratfit.report.svg import INK, SERIES, svg_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Bins = Sequence[float | None]

MOST = 5
"""Curves that a figure can hold and stay legible."""

MARGIN = 0.5
"""How far beyond the exact function's range, in parts of it, the fit is still drawn: near a pole it has no end."""

LARGEST = 1e150
"""Beyond that a picture's own arithmetic overflows."""


@dataclass(frozen=True)
class ErrorCurve:
    """The error of a fit over its domain, in bins, as a row of a record holds it; None in a bin without a number."""

    label: str
    variable: str
    edges: Sequence[float]
    exact: Bins
    fit: Bins
    bias: Bins
    absolute_max: Bins

    @property
    def peak(self) -> float:
        """The largest size of the exact function in the bins."""
        return max(map(abs, _known(self.exact)), default=0.0)


def error_figure(name: str, curves: Sequence[ErrorCurve], against: str) -> Figure:
    """Exact function and fit above, the signed mean error of each bin below.

    Arguments: `name` of the figure in its document; `curves` of one problem at several settings of its parameters, of
    which at most MOST are drawn, spread evenly; `against`, the exact function's name. Where the peaks of the settings
    differ much, everything is drawn in parts of each one's peak; what leaves the exact function's range by far is cut,
    and the caption says where it goes.
    """
    shown = _spread(curves)
    is_scaled = _differ([curve.peak for curve in shown])
    unit = " / peak" if is_scaled else ""
    with drawing(4.4) as figure:
        above, below = figure.subplots(2, sharex=True, height_ratios=(3, 2))
        for place, curve in enumerate(shown):
            _draw(above, below, curve, SERIES[place], 1 / curve.peak if is_scaled else 1.0, len(shown) == 1)
        _cut(above, below, shown, is_scaled)
        below.axhline(0, color=INK, linewidth=0.8)
        above.set_ylabel(f"value{unit}")
        below.set_ylabel(f"error{unit}")
        below.set_xlabel(label(shown[0].variable))
        if len(shown) > 1:
            legend(figure, [(SERIES[n], "", curve.label) for n, curve in enumerate(shown)])
        alt = printable(f"{against} and its fit, and the fit's error, over {shown[0].variable}")
        svg = svg_of(figure, name, alt, {})
    return Figure(name, svg, " ".join(_caption(shown, len(curves), against, is_scaled)), alt)


def _caption(shown: Sequence[ErrorCurve], count: int, against: str, is_scaled: bool) -> Iterable[str]:
    is_single = len(shown) == 1
    at = f", at {shown[0].label}" if is_single and shown[0].label else ""
    yield f"Above: {against} as the wide pale line, the fit as the thin one{at}."
    pale = "; pale, to both sides, the largest error of each" if is_single else ""
    yield f"Below: fit − exact, the mean of each of {len(shown[0].bias)} bins{pale}."
    if is_scaled:
        yield "Values and errors are parts of each setting's peak."
    if len(shown) < count:
        yield f"{len(shown)} of {count} settings are drawn."
    for curve in shown:
        low, high = _range(curve.exact)
        far = max(_known(curve.fit), key=lambda value: max(low - value, value - high), default=low)
        if max(low - far, far - high) > MARGIN * (high - low or 1):
            at = f" at {curve.label}" if curve.label else ""
            yield f"The fit leaves the picture{at}: a bin of it is {number(far)}."


def _draw(above: Axes, below: Axes, curve: ErrorCurve, colour: str, scale: float, is_single: bool) -> None:
    middles = [low + (high - low) / 2 for low, high in zip(curve.edges, curve.edges[1:], strict=False)]
    above.plot(middles, _scaled(curve.exact, scale), color=colour, linewidth=6, alpha=0.3, solid_capstyle="butt")
    above.plot(middles, _scaled(curve.fit, scale), color=colour, linewidth=1.5)
    if is_single:
        worst = _scaled(curve.absolute_max, scale)
        below.stairs(worst, curve.edges, baseline=[-w for w in worst], fill=True, color=colour, alpha=0.2, linewidth=0)
    below.stairs(_scaled(curve.bias, scale), curve.edges, baseline=None, color=colour, linewidth=1.5)


def _cut(above: Axes, below: Axes, curves: Sequence[ErrorCurve], is_scaled: bool) -> None:
    """Bounds what is seen by the exact functions' range, with a margin, where a fit goes beyond."""
    ranges = [_range([v / c.peak if is_scaled else v for v in _known(c.exact)]) for c in curves]
    low, high = min(low for low, _ in ranges), max(high for _, high in ranges)
    margin = MARGIN * (high - low or 1)
    bottom, top = above.get_ylim()
    above.set_ylim(max(bottom, low - margin), min(top, high + margin))
    bottom, top = below.get_ylim()
    below.set_ylim(max(bottom, -2 * margin), min(top, 2 * margin))


def _known(values: Bins) -> list[float]:
    return [value for value in values if value is not None and abs(value) < LARGEST]


def _range(values: Bins) -> tuple[float, float]:
    known = _known(values)
    return (min(known), max(known)) if known else (0.0, 0.0)


def _scaled(values: Bins, scale: float) -> list[float]:
    return [value * scale if value is not None and abs(value) < LARGEST else math.nan for value in values]


def _spread(curves: Sequence[ErrorCurve]) -> list[ErrorCurve]:
    if len(curves) <= MOST:
        return list(curves)
    return [curves[round(k * (len(curves) - 1) / (MOST - 1))] for k in range(MOST)]


def _differ(peaks: Sequence[float]) -> bool:
    return min(peaks) > 0 and max(peaks) > 4 * min(peaks)
