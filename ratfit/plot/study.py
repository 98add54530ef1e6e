"""The picture of a study: the function over its domain, with what is known of it marked."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import mpmath
import sympy as sp

from ratfit._condition import Limit
from ratfit._parse import shortened
from ratfit._study import Fact, Study
from ratfit._study.curve import Curve
from ratfit.plot.entries import entry
from ratfit.plot.facts import fact_text, title_text
from ratfit.plot.marks import Marker, Window, draw_asymptote, draw_point, draw_pole, draw_tangent, room_between
from ratfit.plot.style import BLACK, BLUE, PURPLE, RED, axes_width, dress, legend_below, settings
from ratfit.plot.text import on_a_line, plain, text_depth
from ratfit.plot.view import broken, cut, span

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PLACES = 900
"""Points of the drawn curve."""

_MARKERS = {
    "value": Marker("o", BLUE),
    "zero": Marker("o", BLACK, is_filled=False, size=11.0),
    "maximum": Marker("^", RED, size=9.0),
    "minimum": Marker("v", RED, size=9.0),
    "inflection": Marker("D", PURPLE),
}

_NAMES = {
    **{"value": "value", "zero": "zero", "maximum": "maximum", "minimum": "minimum", "inflection": "inflection"},
    **{"slope": "slope", "limit": "limit", "asymptote": "asymptote", "pole": "pole", "singularity": "singularity"},
}


def plot_study(study: Study, axes: Axes | None = None) -> Axes:
    """Draws the function of a study over its domain, with what is known of it marked.

    Arguments: `study`; `axes`, matplotlib's, on a figure of their own where left out. Returns the axes; nothing is
    shown, `axes.figure.savefig(...)` writes it. Values are dots, slopes short tangents, limits and asymptotes dashed
    lines, poles dotted vertical ones; the numbers stand below the picture, clear of the curve. Parameters have the
    middle of their ranges, and an infinite domain is cut: both are said on the axis.
    """
    is_ours = axes is None
    with settings(is_ours):
        axes = axes if axes is not None else _new_axes()
        _draw(axes, study, _view(study), is_ours)
    return axes


def _draw(axes: Axes, study: Study, view: _View, is_ours: bool) -> None:
    window = view.window
    _draw_curve(axes, view)
    handles = [*_draw_lines(axes, study, view), *_draw_tangents(axes, study, view), *_draw_points(axes, study, view)]
    axes.set_xlim(window.left, window.right)
    axes.set_ylim(window.bottom, window.top)
    axes.set_xlabel(plain(_x_label(study, view)))
    axes.set_ylabel(f"$f({on_a_line(study.target.variable)})$")
    title = title_text(study, 0.95 * axes_width(axes)) or plain(shortened(str(study.target.expression), 80))
    axes.set_title(title, fontsize=10, pad=6 + text_depth(title, 10))
    dress(axes)
    legend_below(axes, handles, is_ours)


def _new_axes() -> Axes:
    from matplotlib.figure import Figure

    return Figure(figsize=(6.6, 4.2), layout="constrained").subplots()


@dataclass(frozen=True)
class _View:
    """What part of the plane is seen, and the curve in it."""

    curve: Curve
    window: Window
    places: Sequence[float]
    heights: Sequence[float]

    def height(self, place: float) -> float:
        """The function at a place, from inside the view where it is not defined on the edge."""
        nudge = 1e-9 * (self.window.right - self.window.left)
        for nearby in (place, place + nudge, place - nudge):
            found = _height(self.curve, nearby)
            if math.isfinite(found):
                return found
        return math.nan


def _height(curve: Curve, place: float) -> float:
    with mpmath.workdps(25):
        value = curve.number(0)(mpmath.mpf(place))
        return math.nan if value is None or abs(value) > 1e300 else float(value)


def _view(study: Study) -> _View:
    curve = Curve(study.target)
    left, right = _range(study, curve)
    inset = (right - left) * 1e-6  # an end may be no place of the function
    step = (right - left - 2 * inset) / (PLACES - 1)
    places = [left + inset + step * k for k in range(PLACES)]
    heights = broken(places, [_height(curve, p) for p in places], _pole_places(study, curve))
    marked = [_number(f.value, curve) for f in study.of("value", "maximum", "minimum") if f.value is not None]
    bottom, top = span(heights, marked, bool(study.of("pole", "singularity")))
    margin = 0.06 * (right - left)
    return _View(curve, Window(left - margin, right + margin, bottom, top), places, heights)


def _range(study: Study, curve: Curve) -> tuple[float, float]:
    """The domain, cut where it is infinite: beyond all marked places, and where the curve has come near its limit."""
    low, high = curve.ends
    marked = [_number(f.place, curve) for f in study.facts if f.place is not None and not f.place.is_infinite]
    if mpmath.isinf(low) and mpmath.isinf(high):
        far = max(_cut(study, curve, sp.oo, 0.0, marked), _cut(study, curve, -sp.oo, 0.0, marked))
        return -far, far
    if mpmath.isinf(high):
        return float(low), float(low) + _cut(study, curve, sp.oo, float(low), marked)
    if mpmath.isinf(low):
        return float(high) - _cut(study, curve, -sp.oo, float(high), marked), float(high)
    return float(low), float(high)


def _cut(study: Study, curve: Curve, place: sp.Expr, start: float, marked: Iterable[float]) -> float:
    reach = 1.3 * max((abs(p - start) for p in marked if math.isfinite(p)), default=0.0)
    limits = [f.value for f in study.of("limit") if f.place == place]
    limit = _number(limits[0], curve) if limits else None
    return cut(lambda there: _height(curve, there), start, 1 if place is sp.oo else -1, limit, reach)


def _number(expression: sp.Expr | None, curve: Curve) -> float:
    """An expression of the parameters as a float at their middle; nan where it is no number."""
    if expression is None or expression.has(curve.x):
        return math.nan
    value = expression.xreplace(curve.middle)
    if value.is_infinite:
        return math.nan
    found = sp.N(value, 17)
    return float(found) if found.is_Float or found.is_Integer else math.nan


def _pole_places(study: Study, curve: Curve) -> list[float]:
    places = [_number(f.place, curve) for f in study.of("pole", "singularity")]
    return [place for place in places if math.isfinite(place)]


def _draw_curve(axes: Axes, view: _View) -> None:
    axes.plot(view.places, view.heights, color=BLACK, linewidth=1.6, zorder=2)


def _draw_lines(axes: Axes, study: Study, view: _View) -> list[Any]:
    """Limits and asymptotes dashed, poles dotted."""
    handles = []
    ends = (view.window.left, view.window.right)
    for fact in study.of("limit", "asymptote"):
        condition = fact.condition
        if not isinstance(condition, Limit) or fact.value is None or ("beyond" in fact.text and _far_off(fact, view)):
            continue
        heights = [
            _number((condition.minus + fact.value).xreplace({view.curve.x: sp.Float(p)}), view.curve) for p in ends
        ]
        handles.append((draw_asymptote(axes, ends, heights), fact))
    for fact in study.of("pole", "singularity"):
        place = _number(fact.place, view.curve)
        if math.isfinite(place):
            handles.append((draw_pole(axes, place), fact))
    return _entries(handles, study)


def _far_off(fact: Fact, view: _View) -> bool:
    """Whether a limit beyond the domain lies outside the picture."""
    height = _number(fact.value, view.curve)
    return not view.window.bottom <= height <= view.window.top


def _draw_tangents(axes: Axes, study: Study, view: _View) -> list[Any]:
    """A short tangent, of the same length on paper everywhere, wherever the slope is known."""
    handles = []
    width = view.window.right - view.window.left
    room = room_between([_number(f.place, view.curve) for f in study.of("slope", "maximum", "minimum")], width)
    for fact in study.of("slope", "maximum", "minimum", "inflection"):
        if not _is_slope(fact):
            continue
        place, slope = _number(fact.place, view.curve), _number(fact.value, view.curve)
        middle = view.height(place)
        if not all(map(math.isfinite, (place, slope, middle))):
            continue
        line = draw_tangent(axes, view.window, (place, middle), slope, room)
        if fact.kind == "slope":
            handles.append((line, fact))
    return _entries(handles, study)


def _is_slope(fact: Fact) -> bool:
    return fact.kind == "slope" or (fact.text.startswith("f'(") and fact.value is not None)


def _draw_points(axes: Axes, study: Study, view: _View) -> list[Any]:
    handles = []
    for fact in study.of(*_MARKERS):
        place = _number(fact.place, view.curve)
        if fact.text.startswith("f'") or fact.value is None or not math.isfinite(place):
            continue
        point = draw_point(axes, place, _number(fact.value, view.curve), _MARKERS[fact.kind])
        handles.append((point, fact))
    return _entries(handles, study)


def _entries(handles: Sequence[tuple[Any, Fact]], study: Study) -> list[Any]:
    """One entry for each kind, with the facts that fit on a line."""
    found: dict[str, tuple[Any, list[str]]] = {}
    for handle, fact in handles:
        found.setdefault(fact.kind, (handle, []))[1].append(fact_text(fact, study))
    for kind, (handle, texts) in found.items():
        handle.set_label(entry(f"{_NAMES[kind]}:", list(dict.fromkeys(texts))))
    return [handle for handle, _ in found.values()]


def _x_label(study: Study, view: _View) -> str:
    x = study.target.variable
    low, high = study.target.domain
    label = str(x)
    if low.is_infinite or high.is_infinite:
        ends = f"[{low}, {high}]".replace("oo", "∞").replace("-", "−")
        label += f"   (cut: the domain is {ends})"
    if view.curve.middle:
        label += "   at " + ", ".join(f"{p} = {v}" for p, v in view.curve.middle.items())
    return label
