"""Pictures: functions that draw on axes, return them and never show anything."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import mpmath
import sympy as sp

from ratfit._condition import Limit
from ratfit._study import Fact, Study
from ratfit._study.curve import Curve

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Okabe and Ito's colours, which the colour-blind tell apart; shapes differ too, so that grey print serves.
BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, RED, PURPLE, GREY = "#0072B2", "#D55E00", "#CC79A7", "#666666"

PLACES = 900
"""Points of the drawn curve."""

CUTS = (1, 2, 3, 5, 10, 20, 50, 100, 1000)
"""Where an infinite domain may be cut: the first at which the curve has come near its limit."""

# kind of fact -> marker, colour, filled, size
_MARKERS: dict[str, tuple[str, str, bool, float]] = {
    "value": ("o", BLUE, True, 7.0),
    "zero": ("o", BLACK, False, 11.0),
    "maximum": ("^", RED, True, 9.0),
    "minimum": ("v", RED, True, 9.0),
    "inflection": ("D", PURPLE, True, 7.0),
}

_NAMES = {
    **{"value": "value", "zero": "zero", "maximum": "maximum", "minimum": "minimum", "inflection": "inflection"},
    **{"slope": "slope", "limit": "limit", "asymptote": "asymptote", "pole": "pole", "singularity": "singularity"},
}

_DECIMALS = re.compile(r"\d+\.\d{5,}(?![\de])")
"""Decimals that a picture has no room for."""

LABEL = 62
"""Letters of an entry below the picture."""


def plot_study(study: Study, axes: Axes | None = None) -> Axes:
    """Draws the function of a study over its domain, with what is known of it marked.

    Arguments: `study`; `axes`, matplotlib's, on a figure of their own where left out. Returns the axes; nothing is
    shown, `axes.figure.savefig(...)` writes it. Values are dots, slopes short tangents, limits and asymptotes dashed
    lines, poles dotted vertical ones; the numbers stand below the picture, clear of the curve. Parameters have the
    middle of their ranges, and an infinite domain is cut: both are said on the axis.
    """
    axes = axes if axes is not None else _new_axes()
    view = _view(study)
    _draw_curve(axes, view)
    handles = [*_draw_lines(axes, study, view), *_draw_tangents(axes, study, view), *_draw_points(axes, study, view)]
    axes.set_xlim(view.left, view.right)
    axes.set_ylim(view.bottom, view.top)
    axes.set_xlabel(_x_label(study, view))
    axes.set_ylabel(f"f({study.target.variable})")
    axes.set_title(_shortened(str(study.target.expression), 80), fontsize=10)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(alpha=0.25, linewidth=0.6)
    if handles:
        axes.figure.legend(
            handles=handles,
            loc="outside lower center",
            ncols=1 if any(len(h.get_label()) > LABEL // 2 for h in handles) else 2,
            frameon=False,
            fontsize=9,
        )
    return axes


def _new_axes() -> Axes:
    from matplotlib.figure import Figure

    return Figure(figsize=(6.6, 5.0), layout="constrained").subplots()


@dataclass(frozen=True)
class _View:
    """What part of the plane is seen, and the curve in it."""

    curve: Curve
    left: float
    right: float
    bottom: float
    top: float
    places: Sequence[float]
    heights: Sequence[float]

    def height(self, place: float) -> float:
        """The function at a place, from inside the view where it is not defined on the edge."""
        nudge = 1e-9 * (self.right - self.left)
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
    heights = _broken(places, [_height(curve, p) for p in places], _pole_places(study, curve))
    marked = [_number(f.value, curve) for f in study.of("value", "maximum", "minimum") if f.value is not None]
    bottom, top = _heights(heights, marked, bool(study.of("pole", "singularity")))
    margin = 0.06 * (right - left)
    return _View(curve, left - margin, right + margin, bottom, top, places, heights)


def _range(study: Study, curve: Curve) -> tuple[float, float]:
    """The domain, cut where it is infinite: beyond all marked places, and where the curve has come near its limit."""
    low, high = curve.ends
    marked = [_number(f.place, curve) for f in study.facts if f.place is not None and not f.place.is_infinite]
    if mpmath.isinf(low) and mpmath.isinf(high):
        cut = max(_cut(study, curve, sp.oo, 0.0, marked), _cut(study, curve, -sp.oo, 0.0, marked))
        return -cut, cut
    if mpmath.isinf(high):
        return float(low), float(low) + _cut(study, curve, sp.oo, float(low), marked)
    if mpmath.isinf(low):
        return float(high) - _cut(study, curve, -sp.oo, float(high), marked), float(high)
    return float(low), float(high)


def _cut(study: Study, curve: Curve, place: sp.Expr, start: float, marked: Iterable[float]) -> float:
    reach = 1.3 * max((abs(p - start) for p in marked if math.isfinite(p)), default=0.0)
    limits = [f.value for f in study.of("limit") if f.place == place]
    side = 1 if place is sp.oo else -1
    for cut in CUTS:
        if cut < reach:
            continue
        if not limits:
            return max(10.0, cut)
        heights = [_height(curve, start + side * cut * k / 20) for k in range(1, 21)]
        finite = [h for h in heights if math.isfinite(h)] or [0.0]
        limit = _number(limits[0], curve)
        if abs(finite[-1] - limit) <= 0.03 * max(max(finite) - min(finite), abs(limit), 1e-300):
            return float(cut)
    return max(10.0, reach)


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


def _broken(places: Sequence[float], heights: list[float], poles: Sequence[float]) -> list[float]:
    """The heights with a gap at every pole and jump, so that no line joins the branches."""
    step = places[1] - places[0]
    found = [
        math.nan if any(abs(p - pole) < step for pole in poles) else h for p, h in zip(places, heights, strict=True)
    ]
    finite = [h for h in found if math.isfinite(h)]
    span = (max(finite) - min(finite)) if finite else 0.0
    for k in range(2, len(found) - 1):
        leap, before, after = (abs(found[j] - found[j - 1]) for j in (k, k - 1, k + 1))
        if span and leap > 0.02 * span and leap > 20 * max(before, after):
            found[k] = math.nan
    return found


def _heights(heights: Iterable[float], marked: Iterable[float], with_poles: bool) -> tuple[float, float]:
    """The range of heights to show; near poles the outermost tenths are cut away."""
    ordered = sorted(h for h in heights if math.isfinite(h))
    if not ordered:
        return -1.0, 1.0
    keep = 0.08 if with_poles else 0.0
    shown = ordered[int(keep * (len(ordered) - 1)) : int((1 - keep) * (len(ordered) - 1)) + 1]
    shown = shown + [h for h in marked if math.isfinite(h)]
    low, high = min(shown), max(shown)
    margin = 0.08 * (high - low) or 0.5 * (abs(high) or 1.0)
    return low - margin, high + margin


def _draw_curve(axes: Axes, view: _View) -> None:
    axes.plot(view.places, view.heights, color=BLACK, linewidth=1.6, zorder=2)


def _draw_lines(axes: Axes, study: Study, view: _View) -> list[Any]:
    """Limits and asymptotes dashed, poles dotted."""
    handles = []
    for fact in study.of("limit", "asymptote"):
        condition = fact.condition
        if not isinstance(condition, Limit) or fact.value is None or ("beyond" in fact.text and _far_off(fact, view)):
            continue
        heights = [
            _number((condition.minus + fact.value).xreplace({view.curve.x: sp.Float(p)}), view.curve)
            for p in (view.left, view.right)
        ]
        (line,) = axes.plot((view.left, view.right), heights, "--", color=GREEN, linewidth=1.2, zorder=1)
        handles.append((line, fact))
    for fact in study.of("pole", "singularity"):
        place = _number(fact.place, view.curve)
        if math.isfinite(place):
            handles.append((axes.axvline(place, linestyle=":", color=RED, linewidth=1.6, zorder=1), fact))
    return _entries(handles)


def _far_off(fact: Fact, view: _View) -> bool:
    """Whether a limit beyond the domain lies outside the picture."""
    height = _number(fact.value, view.curve)
    return not view.bottom <= height <= view.top


def _draw_tangents(axes: Axes, study: Study, view: _View) -> list[Any]:
    """A short tangent, of the same length on paper everywhere, wherever the slope is known."""
    handles = []
    width, height = view.right - view.left, view.top - view.bottom
    room = 0.35 * _closest([_number(f.place, view.curve) for f in study.of("slope", "maximum", "minimum")], width)
    for fact in study.of("slope", "maximum", "minimum", "inflection"):
        if not _is_slope(fact):
            continue
        place, slope = _number(fact.place, view.curve), _number(fact.value, view.curve)
        middle = view.height(place)
        if not all(map(math.isfinite, (place, slope, middle))):
            continue
        half = min(0.058 / math.hypot(1 / width, slope / height), room)
        (line,) = axes.plot(
            (place - half, place + half),
            (middle - slope * half, middle + slope * half),
            color=ORANGE,
            linewidth=3.2,
            solid_capstyle="round",
            zorder=1.5,
        )
        if fact.kind == "slope":
            handles.append((line, fact))
    return _entries(handles)


def _closest(places: Iterable[float], width: float) -> float:
    """The smallest distance between different places."""
    ordered = sorted({p for p in places if math.isfinite(p)})
    return min((b - a for a, b in pairwise(ordered)), default=width)


def _is_slope(fact: Fact) -> bool:
    return fact.kind == "slope" or (fact.text.startswith("f'(") and fact.value is not None)


def _draw_points(axes: Axes, study: Study, view: _View) -> list[Any]:
    handles = []
    for fact in study.of(*_MARKERS):
        place = _number(fact.place, view.curve)
        if fact.text.startswith("f'") or fact.value is None or not math.isfinite(place):
            continue
        marker, colour, filled, size = _MARKERS[fact.kind]
        (point,) = axes.plot(
            [place],
            [_number(fact.value, view.curve)],
            marker,
            linestyle="none",
            markersize=size,
            color=colour,
            markerfacecolor=colour if filled else "none",
            markeredgewidth=1.4,
            clip_on=False,
            zorder=5,
        )
        handles.append((point, fact))
    return _entries(handles)


def _entries(handles: Sequence[tuple[Any, Fact]]) -> list[Any]:
    """One entry for each kind, with the facts that fit on a line."""
    found: dict[str, tuple[Any, list[str]]] = {}
    for handle, fact in handles:
        text = fact.text.removeprefix(f"{fact.kind} ").split(" in a ")[0].split(", beyond")[0].split(", of order")[0]
        text = _DECIMALS.sub(lambda number: f"{float(number[0]):.5g}", text.split(": the asymptote is ")[-1])
        found.setdefault(fact.kind, (handle, []))[1].append(text)
    for kind, (handle, texts) in found.items():
        handle.set_label(_shortened(f"{_NAMES[kind]}: {', '.join(dict.fromkeys(texts))}", LABEL))
    return [handle for handle, _ in found.values()]


def _shortened(text: str, letters: int) -> str:
    return text if len(text) <= letters else text[: letters - 2].rstrip(" ,") + " …"


def _x_label(study: Study, view: _View) -> str:
    x = study.target.variable
    low, high = study.target.domain
    label = str(x)
    if low.is_infinite or high.is_infinite:
        label += f"   (cut: the domain is [{low}, {high}])"
    if view.curve.middle:
        label += "   at " + ", ".join(f"{p} = {v}" for p, v in view.curve.middle.items())
    return label
