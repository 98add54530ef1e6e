"""Which arithmetic the exact function needs for its errors not to count: float64, or double-double.

An exhaustive measurement states units in the last place, and so its reference must be known to far less than one. At
some places of the domain balls say what the exact function is; the cheapest arithmetic that keeps to it is taken.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import Any

import sympy as sp

from ratfit._ball import ball_function
from ratfit._double_double import double_double
from ratfit._error.chunk import number_format
from ratfit._lower import lower
from ratfit._parse import RatfitError
from ratfit._sampling import bounds, drawn
from ratfit._setting import Setting

PLACES = 2049
"""Samples at which the reference is judged, evenly among all."""

GOOD = 0.01
"""Units in the last place of the dtype under test that a reference may be off."""

BITS = 400
"""Precision of the balls: enough for the cancellation of what is 1 to within 1e-100."""


@dataclass(frozen=True)
class Reference:
    """The arithmetic of the exact function, and what is known against it: `note` is empty where nothing is."""

    double_double: bool
    note: str = ""


FLOAT64 = Reference(False)


def reference_for(place: Setting, sampling: str, seed: int, samples: int, dtype: str) -> Reference:
    """The cheapest reference that is right to a hundredth of an ulp of the dtype at some thousand of the samples."""
    import numpy as np

    counters = np.unique(np.linspace(0, samples - 1, PLACES).astype(np.uint64))
    (found,) = drawn(sampling, seed, counters, bounds(place, dtype), dtype)
    points = np.asarray(found).astype(np.float64)
    expression = place.exact.xreplace({symbol: sp.Rational(value) for symbol, value in place.values.items()})
    try:
        truth = _truth(expression, place.variable, tuple(points.tolist()))
    except RatfitError as reason:
        return Reference(False, f"the float64 reference is not checked ({reason})")
    plain = lower(expression, (place.variable,))(points)
    worst, at = _worst(truth, plain, np.zeros_like(plain), points, dtype)
    if worst <= GOOD:
        return FLOAT64
    try:
        worst, at = _worst(truth, *double_double(expression, (place.variable,))(points), points, dtype)
    except RatfitError as reason:
        return Reference(False, f"{_off('float64', worst, at, place)} ({reason})")
    return Reference(True, "" if worst <= GOOD else _off("double-double", worst, at, place))


def _off(arithmetic: str, worst: float, at: float, place: Setting) -> str:
    where = f"{place.variable} = {at:.6g}"
    return f"the {arithmetic} reference is itself off by {worst:.2g} ulp at {where}: trust no ulp there"


@functools.lru_cache(maxsize=8)
def _truth(expression: sp.Expr, variable: sp.Symbol, points: tuple[float, ...]) -> tuple[Any, ...]:
    """The values of the exact function as balls, None where they are not known to be finite."""
    import flint

    run, found = ball_function(expression, [variable]), []
    with flint.ctx.workprec(BITS):
        for point in points:
            value = run([flint.arb(point)])
            found.append(value if isinstance(value, flint.arb) and value.is_finite() else None)
    return tuple(found)


def _worst(truth: tuple[Any, ...], high: Any, low: Any, points: Any, dtype: str) -> tuple[float, float]:
    """The greatest distance from the truth, in ulps of the dtype, and where."""
    import flint

    worst, at = 0.0, math.nan
    with flint.ctx.workprec(BITS):
        for value, h, l, point in zip(truth, high.tolist(), low.tolist(), points.tolist(), strict=True):  # noqa: E741
            if value is None:
                continue
            off = float(abs(value - h - l).mid()) / _ulp(float(value.mid()), dtype) if math.isfinite(h) else math.inf
            if off > worst:
                worst, at = off, point
    return worst, at


def _ulp(value: float, dtype: str) -> float:
    fraction, least = number_format(dtype)
    return math.ldexp(1.0, max(math.frexp(value)[1] - 1, least) - fraction if value else least - fraction)
