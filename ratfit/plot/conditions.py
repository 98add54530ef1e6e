"""The kernel conditions of a fit, marked on its curves and said below them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy as sp

from ratfit._condition import AbstractPointCondition, Equation, Integral, Limit, describe
from ratfit._fit import Checked, Fit
from ratfit._problem import Problem
from ratfit.plot.curves import FitCurves
from ratfit.plot.marks import Marker, Window, draw_asymptote, draw_point, draw_pole, draw_tangent, room_between
from ratfit.plot.style import BLACK, BLUE, GREEN, GREY, LETTERS, ORANGE
from ratfit.plot.text import on_a_line, plain, shortened, text_width

if TYPE_CHECKING:
    from matplotlib.axes import Axes

KINDS = ("value", "slope", "derivative", "limit", "pole", "integral", "equation")
"""The entries below a picture, in order."""

WIDEST = 340
"""Points that an entry may take: no more than the axes above it."""

ARROW = r"\to"


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


def letter(problem: Problem) -> str:
    """What the function is called in a picture: f, but where a parameter has that name."""
    taken = {symbol.name for symbol in (problem.variable, *problem.parameters)}
    return next(name for name in "fFgGhyY" if name not in taken)


def draw_conditions(page: Page, fit: Fit) -> list[Any]:
    """Marks every condition and returns one entry of the legend for each kind, with what it says.

    Values are dots, slopes short tangents, limits at infinity dashed asymptotes, poles dotted lines. Higher
    derivatives, integrals and equations cannot be drawn: they are said.
    """
    found: dict[str, tuple[Any, list[str]]] = {}
    for checked in fit.conditions:
        kind, text = _kind(checked, fit.problem.variable), _text(checked, fit)
        if text_width(text, 9) > WIDEST - 50:
            text = plain(f"{describe(checked.condition)} = {checked.demand}")
        handle = _draw(page, fit, checked, kind) or said("")
        found.setdefault(kind, (handle, []))[1].append(text)
    for kind, (handle, texts) in found.items():
        handle.set_label(_entry(kind, texts))
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


def said(text: str) -> Any:
    """An entry of the legend that stands for nothing drawn."""
    from matplotlib.lines import Line2D

    return Line2D([], [], linestyle="none", label=text)


def _text(checked: Checked, fit: Fit) -> str:
    """A condition as mathematics between dollars, or as plain text where that cannot be set."""
    condition, x, f = checked.condition, fit.problem.variable, letter(fit.problem)
    if isinstance(condition, AbstractPointCondition):
        primes = "'" * condition.order if condition.order < 4 else f"^{{({condition.order})}}"
        return _equation(f"{f}{primes}({_math(condition.at)})", checked.demand)
    if isinstance(condition, Limit):
        return _limit_text(condition, checked.demand, x, f)
    if isinstance(condition, Integral):
        low, high = (_math(end) for end in condition.range(fit.problem.domain))
        return _equation(rf"\int_{{{low}}}^{{{high}}} {_weighted(condition.weight, f)}\,d{_math(x)}", checked.demand)
    assert isinstance(condition, Equation)
    more = f", with {condition.order} derivatives" if condition.order else ""
    return f"{_dollars(_math(condition.residual), '= 0')} at {_dollars(_math(x), '=', _math(condition.at))}{more}"


def _weighted(weight: sp.Expr, f: str) -> str:
    above, below = sp.fraction(weight)
    written = f if above == 1 else rf"{_product(above)}\,{f}"
    divisor = rf"\left({_math(below)}\right)" if below.is_Add or below.is_Mul else _math(below)
    return written if below == 1 else f"{written}/{divisor}"


def _limit_text(condition: Limit, demand: sp.Expr, x: sp.Symbol, f: str) -> str:
    to = f"{_math(x)} {ARROW} {_math(condition.at)}"
    difference = f if condition.minus == 0 else rf"\left({f} - {_product(condition.minus)}\right)"
    if condition.scale == 1 and condition.minus != 0:
        difference = f"{f} - {_product(condition.minus)}"
    scale = "" if condition.scale == 1 else _product(condition.scale)
    return f"{_dollars(difference, scale, ARROW, _math(demand))} as {_dollars(to)}"


def _equation(left: str, demand: sp.Expr) -> str:
    return _dollars(left, "=", _math(demand))


def _dollars(*parts: str) -> str:
    return f"${' '.join(parts)}$"


def _product(expression: sp.Expr) -> str:
    written = _math(expression)
    return rf"\left({written}\right)" if expression.is_Add else written


def _math(expression: sp.Expr) -> str:
    written = on_a_line(expression)
    return written if written is not None else rf"\mathrm{{{plain(str(expression))}}}"


def _entry(kind: str, texts: Sequence[str]) -> str:
    """As many of the texts as fit on a line."""
    text = f"{kind}: {texts[0] if '$' in texts[0] else shortened(texts[0], LETTERS - 10)}"
    for more in dict.fromkeys(texts[1:]):
        longer = f"{text}, {more}"
        if text_width(longer, 9) > WIDEST:
            return f"{text}, …"
        text = longer
    return text
