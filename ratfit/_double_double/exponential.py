"""exp and the hyperbolic functions in double-double, and expm1, on which the latter stand near 0.

exp: x = n ln2/256 + s with |s| <= ln2/512, so that exp(x) = 2**k T_j exp(s), n = 256 k + j, T_j = 2**(j/256) from a
table and exp(s) from its series (the reduction of tang1989 and of hida2001, with a finer table).
"""

from __future__ import annotations

from functools import cache

import mpmath
import numpy as np

from ratfit._double_double.arithmetic import Array, DoubleDouble, absolute, reciprocal, two_sum
from ratfit._double_double.tables import DIGITS, branched, finished, limbs, pairs, series

_STEPS = 256
_END = 800.0  # beyond, exp is infinite or 0 even of a half
_NEAR = 400  # steps each side of 0 that the table of exp - 1 covers: |x| <= 1.08


@cache
def _constants() -> tuple[list[float], DoubleDouble, DoubleDouble, list[DoubleDouble]]:
    """ln2/256 in limbs, T_j, exp - 1 at the places n ln2/256 about 0, and the coefficients of (exp(s) - 1)/s."""
    with mpmath.workdps(DIGITS):
        step = mpmath.log(2) / _STEPS
        powers = pairs(mpmath.exp(j * step) for j in range(_STEPS))
        less_one = pairs(mpmath.expm1(n * step) for n in range(-_NEAR, _NEAR + 1))
        factorials = pairs(1 / mpmath.factorial(n + 1) for n in range(9))
        return limbs(step, 33, 3), powers, less_one, [factorials[n] for n in range(9)]


def exp(x: DoubleDouble, halvings: int = 0) -> DoubleDouble:
    """exp(x) / 2**halvings: relative error 8 u**2, whatever the size of x."""
    high = np.clip(x.high, -_END, _END)
    held = DoubleDouble(high, np.where(high == x.high, x.low, 0.0))
    n, s = _reduced(held)
    power = _constants()[1].take(n & (_STEPS - 1))
    value = power + power * _less_one(s, 4)
    # The power of two is applied in two halves: a whole one may leave float64's range before the value does.
    k = (n >> 8) - halvings
    value = value.scaled(_power_of_two(k >> 1)).scaled(_power_of_two(k - (k >> 1)))
    return finished(value, lambda a: np.exp(a) * 0.5**halvings, x)


def expm1(x: DoubleDouble) -> DoubleDouble:
    """exp(x) - 1 with its relative accuracy about 0: relative error 8 u**2."""
    return finished(branched(np.abs(x.high) <= 1, _expm1_near, lambda a: exp(a) - 1.0, x), np.expm1, x)


def _expm1_near(x: DoubleDouble) -> DoubleDouble:
    n, s = _reduced(x)
    start = _constants()[2].take(n + _NEAR)
    rest = _less_one(s, 5)
    return start + (start * rest + rest)


def _reduced(x: DoubleDouble) -> tuple[Array, DoubleDouble]:
    """The integer n nearest to 256 x/ln2, and s = x - n ln2/256."""
    first, second, third = _constants()[0]
    n = np.rint(np.fmin(np.fmax(x.high * (1 / first), -1e6), 1e6))  # fmin and fmax make a number of nan
    s = DoubleDouble(*two_sum(x.high - n * first, -n * second))
    return n.astype(np.int64), s + x.low - n * third


def _less_one(s: DoubleDouble, exact: int) -> DoubleDouble:
    return s * series(s, _constants()[3], exact)


def _power_of_two(k: Array) -> Array:
    return ((k + 1023) << 52).view(np.float64)


def cosh(x: DoubleDouble) -> DoubleDouble:
    """(exp(x) + exp(-x))/2: relative error 8 u**2."""
    grown = exp(absolute(x), 1)
    return finished(grown + reciprocal(grown, 0.25), np.cosh, x)


def sinh(x: DoubleDouble) -> DoubleDouble:
    """(exp(x) - exp(-x))/2, by expm1 for |x| < 1/2: relative error 8 u**2."""
    size = absolute(x)
    value = branched(size.high < 0.5, _sinh_near, _sinh_far, size)
    return finished(value.scaled(np.copysign(1.0, x.high)), np.sinh, x)


def _sinh_near(x: DoubleDouble) -> DoubleDouble:
    grown = expm1(x)
    return (grown + grown / (grown + 1.0)).scaled(0.5)


def _sinh_far(x: DoubleDouble) -> DoubleDouble:
    grown = exp(x, 1)
    return grown - reciprocal(grown, 0.25)


def tanh(x: DoubleDouble) -> DoubleDouble:
    """1 - 2/(exp(2 x) + 1), by expm1 for |x| < 1/2: relative error 8 u**2."""
    size = absolute(x)
    value = branched(size.high < 0.5, _tanh_near, lambda a: -reciprocal(exp(a.scaled(2.0)) + 1.0, 2.0) + 1.0, size)
    return finished(value.scaled(np.copysign(1.0, x.high)), np.tanh, x)


def _tanh_near(x: DoubleDouble) -> DoubleDouble:
    grown = expm1(x.scaled(2.0))
    return grown / (grown + 2.0)
