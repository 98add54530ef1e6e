"""The kernel conditions of a fit, marked on its curves and said below them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy as sp

from ratfit._condition import AbstractPointCondition, Limit
from ratfit._fit import Checked, Fit
from ratfit.plot.curves import FitCurves
from ratfit.plot.entries import condition_text, entry, said
from ratfit.plot.marks import Marker, Window, draw_asymptote, draw_point, draw_pole, draw_tangent, room_between
from ratfit.plot.style import BLACK, BLUE, GREEN, GREY, ORANGE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

KINDS = ("value", "slope", "derivative", "limit", "pole", "integral", "equation")
"""The entries below a picture, in order."""


@dataclass(frozen=True)
class Page:
    """Where conditions are marked: the axes, what part of the plane they show, and how much heights are scaled."""

    axes: Axes
    window: Window
    curves: Sequence[FitCurves]
    scales: Sequence[float]

    @property
    def colours(self) -> tuple[str, str, str]:
        """Of dots, tangents and asymptotes: in a family colours tell the curves apart, and marks have none."""
        return (BLACK, GREY, BLACK) if len(self.curves) > 1 else (BLUE, ORANGE, GREEN)

    def each(self) -> Iterator[tuple[FitCurves, float]]:
        """Every curve, with what its heights are multiplied by."""
        return zip(self.curves, self.scales, strict=True)


def draw_conditions(page: Page, fit: Fit) -> list[Any]:
    """Marks every condition and returns one entry of the legend for each kind, with what it says.

    Values are dots, slopes short tangents, limits at infinity dashed asymptotes, poles dotted lines. Higher
    derivatives, integrals and equations cannot be drawn: they are said.
    """
    found: dict[str, tuple[Any, list[str]]] = {}
    for checked in fit.conditions:
        kind = _kind(checked, fit.problem.variable)
        handle = _draw(page, fit, checked, kind) or said("")
        found.setdefault(kind, (handle, []))[1].append(condition_text(checked, fit.problem))
    for kind, (handle, texts) in found.items():
        handle.set_label(entry(f"{kind}:", texts))
    return [found[kind][0] for kind in KINDS if kind in found]


def _kind(checked: Checked, x: sp.Symbol) -> str:
    condition = checked.condition
    if isinstance(condition, AbstractPointCondition):
        return ("value", "slope")[condition.order] if condition.order < 2 else "derivative"
    if isinstance(condition, Limit) and not condition.at.is_infinite:
        return "pole" if condition.scale.xreplace({x: condition.at}) == 0 else "limit"
    return condition.kind


def _draw(page: Page, fit: Fit, checked: Checked, kind: str) -> Any:
    if kind == "value":
        return _draw_values(page, checked)
    if kind == "slope":
        return _draw_slopes(page, fit, checked)
    if kind == "pole":
        places = sorted({curve.number(checked.condition.at) for curve in page.curves})  # type: ignore[attr-defined]
        return [draw_pole(page.axes, place) for place in places].pop()
    return _draw_limits(page, fit, checked) if kind == "limit" else None


def _draw_values(page: Page, checked: Checked) -> Any:
    points = {
        (curve.number(checked.condition.at), scale * curve.number(checked.demand))  # type: ignore[attr-defined]
        for curve, scale in page.each()
    }
    dot = Marker(colour=page.colours[0])
    return [draw_point(page.axes, place, height, dot) for place, height in sorted(points)].pop()


def _draw_slopes(page: Page, fit: Fit, checked: Checked) -> Any:
    handle = None
    width = page.window.right - page.window.left
    slopes = [c.condition for c in fit.conditions if _kind(c, fit.problem.variable) == "slope"]
    for curve, scale in page.each():
        place, slope = curve.number(checked.condition.at), scale * curve.number(checked.demand)  # type: ignore[attr-defined]
        height = scale * _height(curve, place)
        if math.isfinite(slope) and math.isfinite(height):
            room = room_between([curve.number(c.at) for c in slopes], width)  # type: ignore[attr-defined]
            handle = draw_tangent(page.axes, page.window, (place, height), slope, room, page.colours[1])
    return handle


def _height(curve: FitCurves, place: float) -> float:
    """The fit at a place, from beside it where its formula is 0/0."""
    import numpy as np

    finite = np.flatnonzero(np.isfinite(curve.fit))
    return float(curve.fit[finite[np.argmin(abs(curve.places[finite] - place))]]) if len(finite) else math.nan


def _draw_limits(page: Page, fit: Fit, checked: Checked) -> Any:
    """The asymptote minus + limit/scale, or the point where a limit at a finite place lies."""
    import numpy as np

    condition, x = checked.condition, fit.problem.variable
    assert isinstance(condition, Limit)
    line = condition.minus + checked.demand / condition.scale
    handle = None
    for curve, scale in page.each():
        if not condition.at.is_infinite:
            there = curve.number(line.xreplace({x: condition.at}))
            handle = draw_point(page.axes, curve.number(condition.at), scale * there, Marker(colour=page.colours[0]))
            continue
        places = np.linspace(page.window.left, page.window.right, 400)
        drawn = scale * curve.drawn(line, places)
        inside = (drawn >= page.window.bottom) & (drawn <= page.window.top)
        if inside.any():
            handle = draw_asymptote(page.axes, places[inside], drawn[inside], page.colours[2])
    return handle
