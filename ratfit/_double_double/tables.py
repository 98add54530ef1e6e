"""Tables and series: numbers of mpmath as double-doubles, polynomials in them, and functions made of branches."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

import mpmath
import numpy as np

from ratfit._double_double.arithmetic import Array, DoubleDouble, split, two_product

DIGITS = 80
"""Working digits of every table, which is rounded once to its double-doubles."""


def pairs(values: Iterable[mpmath.mpf]) -> DoubleDouble:
    """Numbers of mpmath as one array of double-doubles; its working precision must hold them."""
    kept = list(values)
    high = [float(value) for value in kept]
    return DoubleDouble(np.array(high), np.array([float(value - h) for value, h in zip(kept, high, strict=True)]))


def limbs(value: mpmath.mpf, bits: int, count: int) -> list[float]:
    """A number as a sum of floats of so many bits each: a short integer times each is exact, but for the full last."""
    parts = []
    for _ in range(count - 1):
        unit = mpmath.ldexp(1, int(mpmath.floor(mpmath.log(abs(value), 2))) + 1 - bits)
        parts.append(float(mpmath.floor(value / unit) * unit))
        value -= parts[-1]
    return [*parts, float(value)]


def series(x: DoubleDouble, coefficients: Sequence[DoubleDouble], exact: int) -> DoubleDouble:
    """The polynomial with these coefficients, constant first, by Horner's rule.

    From place `exact` on it is taken in float64: for terms below 2**-53 of the sum. Each coefficient must exceed what
    is added to it, so that the cheapest sum of double-doubles is accurate (dekker1971's add2).
    """
    tail: Array = 0.0
    for coefficient in reversed(coefficients[exact:]):
        tail = (tail + coefficient.high) * x.high
    total = coefficients[exact - 1] + tail
    factor = split(x.high)
    for c in reversed(coefficients[: exact - 1]):
        p, e = two_product(total.high, x.high, factor)
        e += total.high * x.low + total.low * x.high
        s = c.high + p
        r = (p - (s - c.high)) + (e + c.low)
        high = s + r
        total = DoubleDouble(high, r - (high - s))
    return total


Function = Callable[[DoubleDouble], DoubleDouble]


def branched(condition: Array, first: Function, second: Function, x: DoubleDouble) -> DoubleDouble:
    """`first(x)` where the condition holds and `second(x)` elsewhere, each computed at its own points alone."""
    if condition.all():
        return first(x)
    if not condition.any():
        return second(x)
    high, low = np.empty_like(x.high), np.empty_like(x.high)
    for places, function in ((condition, first), (~condition, second)):
        value = function(x[places])
        high[places], low[places] = value.high, value.low
    return DoubleDouble(high, low)


def finished(
    value: DoubleDouble, plain: Callable[..., Array], *x: DoubleDouble, undefined: Array = False
) -> DoubleDouble:
    """The value, but float64's own where the value is 0 or not finite, or where a method is `undefined`.

    So infinite values, poles, nan and the signs of zeros are NumPy's.
    """
    doubtful = ~np.isfinite(value.high) | (value.high == 0) | undefined
    if not doubtful.any():
        return value
    doubtful, *operands = np.broadcast_arrays(doubtful, *(operand.high for operand in x))
    high, low = (np.array(np.broadcast_to(part, doubtful.shape)) for part in (value.high, value.low))
    high[doubtful] = plain(*(operand[doubtful] for operand in operands))
    low[doubtful] = 0.0
    return DoubleDouble(high, low)
