"""Where the infinite ends of a fit's domain are cut: what is marked and where the error is worst is seen."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import sympy as sp

from ratfit._condition import AbstractPointCondition, Equation, Limit
from ratfit._fit import Fit
from ratfit._lower import lower
from ratfit._problem import Problem
from ratfit._setting import Setting
from ratfit.plot.error import ROUNDING
from ratfit.plot.view import CUTS, cut

PLACED = (AbstractPointCondition, Equation, Limit)
"""Conditions that hold at a place."""

FAR = 1e8
"""Where a function with a limit has come near it."""


def within(problem: Problem, values: Mapping[str, Any]) -> tuple[float, float] | None:
    """A finite piece of an infinite domain, for what needs one before it is known where to cut."""
    low, high = problem.domain
    if not (low.is_infinite or high.is_infinite):
        return None
    if low.is_infinite and high.is_infinite:
        return 0.0, 1.0
    known = {p: sp.Float(values[p.name]) for p in problem.parameters if p.name in values}
    end = float((high if low.is_infinite else low).xreplace(known))
    return (end - 1, end) if low.is_infinite else (end, end + 1)


def seen(fit: Fit, places: Sequence[Setting]) -> tuple[float | None, float | None]:
    """Where infinite ends are cut, the same for all settings; None for an end that is finite."""
    low, high = fit.problem.domain
    if low.is_infinite and high.is_infinite:
        far = max(_cut(fit, place, side, 0.0) for place in places for side in (1, -1))
        return -far, far
    if high.is_infinite:
        return None, max(place.low + _cut(fit, place, 1, place.low) for place in places)
    if low.is_infinite:
        return min(place.high - _cut(fit, place, -1, place.high) for place in places), None
    return None, None


def _cut(fit: Fit, place: Setting, side: int, start: float) -> float:
    values = tuple(place.values.values())
    exact = lower(place.exact, (place.variable, *place.values))
    marked = [c.condition.at for c in fit.conditions if isinstance(c.condition, PLACED)]
    known = [lower(at, tuple(place.values))(*values) for at in marked if not at.is_infinite]
    reach = 1.3 * max((abs(p - start) for p in (*known, _worst(place, side, start)) if math.isfinite(p)), default=0.0)
    height: Callable[[float], float] = lambda there: float(exact(there, *values))  # noqa: E731
    limit = height(start + side * FAR)
    size = max((abs(h) for k in range(11) if math.isfinite(h := height(start + side * k))), default=0.0)
    settles = abs(height(start + side * FAR / 100) - limit) < 1e-3 * size  # not so where either is nan
    return cut(height, start, side, limit if settles else None, reach)


def _worst(place: Setting, side: int, start: float) -> float:
    """The place of the largest error on the way to infinity, so that it is seen; `start` where the error only grows."""
    import numpy as np

    there = start + side * np.geomspace(1e-2, CUTS[-1], 2000)
    values = tuple(place.values.values())
    exact, fit = (lower(e, (place.variable, *place.values))(there, *values) for e in (place.exact, place.formula))
    off = np.nan_to_num(abs(fit - exact), nan=0.0, posinf=0.0)
    worst = off.argmax()
    is_inside = worst < len(off) - 1 and off[worst] > ROUNDING * abs(exact[worst])
    return float(there[worst]) if is_inside else start
