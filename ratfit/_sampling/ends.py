"""The ends of what is drawn, and the numbers of a dtype between them."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import mpmath

from ratfit._parse import RatfitError
from ratfit._sampling.exhaustive import nearest_number, next_number, place_of
from ratfit._setting import Setting


class Ends(NamedTuple):
    """What a kernel knows about one of the ranges that it draws from: eight float64 numbers, an array outside."""

    low: Any
    high: Any
    first: Any  # the least and the greatest number of the dtype strictly inside, subnormal numbers left out
    last: Any
    least: Any  # the places of the least and the greatest number of the dtype in the closed range
    greatest: Any
    low_turn: Any  # asin(low) and asin(high) in quarter turns; nan where the end is no cosine
    high_turn: Any


def bounds(place: Setting, dtype: str) -> list[Any]:
    """The ends of all that is drawn, the variable first: for `drawing`, each as eight float64 numbers (`Ends`).

    **Fails** with `RatfitError` where the dtype has no number to draw between them.
    """
    return [ends(low, high, dtype) for low, high in ((place.low, place.high), *place.ranges.values())]


def ends(low: float, high: float, dtype: str) -> Any:
    """The `Ends` of one range as an array. **Fails** with `RatfitError` where nothing can be drawn from it."""
    import numpy as np

    if not math.isfinite(high - low):
        raise RatfitError(f"[{low}, {high}] is wider than the greatest number: measure on a smaller domain")
    first, last = _inside(low, high, dtype)
    if not first <= last:
        raise RatfitError(
            f"no {dtype} number lies between {low} and {high} (subnormal numbers are not drawn): "
            f"{'' if dtype == 'float64' else 'measure in float64 or '}widen the domain"
        )
    least, greatest = _places(low, high, dtype)
    return np.array(Ends(low, high, first, last, least, greatest, _turn(low), _turn(high)), np.float64)


def _inside(low: float, high: float, dtype: str) -> tuple[float, float]:
    """The numbers next to the ends, inside; no subnormal ones, which XLA takes for 0 and so perhaps for an end."""
    import numpy as np

    tiny = float(np.finfo(dtype).smallest_normal)
    first, last = (nearest_number(end, dtype) for end in (low, high))
    # Compared as float64: NumPy would round a Python float to the narrower dtype first.
    first = float(next_number(first, True) if float(first) <= low else first)
    last = float(next_number(last, False) if float(last) >= high else last)
    if 0 < abs(first) < tiny:
        first = tiny if first > 0 else 0.0
    if 0 < abs(last) < tiny:
        last = -tiny if last < 0 else 0.0
    return first + 0.0, last + 0.0  # -0.0 becomes 0.0


def _places(low: float, high: float, dtype: str) -> tuple[float, float]:
    """The places of the ends of a closed range; of float64 there are none, which no float64 number could hold."""
    if dtype == "float64":
        return math.nan, math.nan
    return place_of(low, dtype, upwards=True), place_of(high, dtype, upwards=False)


def _turn(cosine: float) -> float:
    """By mpmath, since the points rest on it and libraries differ in the last digit of an arcsine."""
    if not -1 <= cosine <= 1:
        return math.nan
    with mpmath.workprec(160):
        return float(2 * mpmath.asin(cosine) / mpmath.pi)
