"""log, log1p, the inverse hyperbolic functions, and powers with any exponent, in double-double.

log: x = 2**k m with m between sqrt(1/2) and sqrt(2); a table gives c near 1/m with log(c), and m c = 1 + r with
|r| <= 2**-7 leaves log(1 + r) = 2 atanh(r/(2 + r)), an odd series (tang1990). Where m is near 1, c is 1 and k is 0:
the relative accuracy stays, down to the zero at 1.
"""

from __future__ import annotations

from functools import cache

import mpmath
import numpy as np

from ratfit._double_double.arithmetic import Array, DoubleDouble, absolute, square_root, two_product, two_sum
from ratfit._double_double.exponential import exp
from ratfit._double_double.tables import DIGITS, branched, finished, pairs, series

_CELLS = 128
_FIRST, _LAST = 90, 182  # the cells of m between sqrt(1/2) and sqrt(2)
_LARGE = 2.0**60  # squared, it leaves 1 below the last bit


@cache
def _constants() -> tuple[DoubleDouble, Array, DoubleDouble, list[DoubleDouble]]:
    """ln2, the c of every cell with log(c), and the coefficients of 2 atanh(z)/z in z**2."""
    with mpmath.workdps(DIGITS):
        inverses = np.array([_CELLS / cell for cell in range(_FIRST, _LAST + 1)])
        logarithms = pairs(mpmath.log(mpmath.mpf(float(c))) for c in inverses)
        odd = pairs(mpmath.mpf(2) / (2 * n + 1) for n in range(7))
        return pairs([mpmath.log(2)])[0], inverses, logarithms, [odd[n] for n in range(7)]


def log(x: DoubleDouble) -> DoubleDouble:
    """log(x): relative error 8 u**2, near 1 too; nan below 0."""
    ln2, inverses, logarithms, _ = _constants()
    m, k = np.frexp(x.high)
    lower = m < np.sqrt(0.5)
    k = k.astype(np.int64) - lower
    # x.low is scaled by two halves of 2**-k, of which a whole one may leave float64's range.
    half = k >> 1
    low = x.low * np.ldexp(1.0, -half) * np.ldexp(1.0, half - k)
    mantissa = DoubleDouble(m * (1.0 + lower), low)
    cell = np.rint(np.fmin(mantissa.high, 2.0) * _CELLS).astype(np.int64) - _FIRST
    r = _product_less_one(mantissa, inverses.take(cell, mode="clip"))
    value = ln2 * k.astype(float) - logarithms.take(cell) + _log_near(r)
    return finished(value, np.log, x, undefined=~(x.high > 0) | np.isinf(x.high))


def _product_less_one(m: DoubleDouble, c: Array) -> DoubleDouble:
    """m c - 1 for a product near 1: the four parts are exact, so that no error of the product is magnified."""
    p, e = two_product(m.high, c)
    return DoubleDouble(*two_sum(p - 1.0, e)) + DoubleDouble(*two_product(m.low, c))


def _log_near(r: DoubleDouble) -> DoubleDouble:
    """log(1 + r) by its odd series."""
    z = r / (r + 2.0)
    return z * series(z * z, _constants()[3], 3)


def log1p(x: DoubleDouble) -> DoubleDouble:
    """log(1 + x) with its relative accuracy about 0: relative error 8 u**2."""
    total = x + 1.0
    lost = x - (total - 1.0)
    return finished(log(total) + lost.high / total.high, np.log1p, x)


def asinh(x: DoubleDouble) -> DoubleDouble:
    """sign(x) log(|x| + sqrt(x**2 + 1)), by log1p: relative error 8 u**2."""
    size = absolute(x)
    value = branched(size.high < _LARGE, _asinh_of_size, _log_of_twice, size)
    return finished(value.scaled(np.copysign(1.0, x.high)), np.arcsinh, x)


def _asinh_of_size(x: DoubleDouble) -> DoubleDouble:
    square = x * x
    return log1p(x + square / (square_root(square + 1.0) + 1.0))


def _log_of_twice(x: DoubleDouble) -> DoubleDouble:
    return log(x) + _constants()[0]


def acosh(x: DoubleDouble) -> DoubleDouble:
    """log(x + sqrt(x**2 - 1)), by log1p: relative error 8 u**2, near 1 too; nan below 1."""
    value = branched(x.high < _LARGE, _acosh_below, _log_of_twice, x)
    return finished(value, np.arccosh, x)


def _acosh_below(x: DoubleDouble) -> DoubleDouble:
    beyond = x - 1.0
    return log1p(beyond + square_root(beyond * (x + 1.0)))


def atanh(x: DoubleDouble) -> DoubleDouble:
    """log1p(2 x/(1 - x))/2, odd: relative error 8 u**2, near 0 and near 1 too; nan beyond 1."""
    size = absolute(x)
    value = log1p(size.scaled(2.0) / (-size + 1.0)).scaled(0.5)
    return finished(value.scaled(np.copysign(1.0, x.high)), np.arctanh, x)


def power(x: DoubleDouble, y: DoubleDouble) -> DoubleDouble:
    """x**y as exp(y log|x|): relative error (8 + 4 |y log(x)|) u**2; nan for x < 0 unless y is an integer."""
    size = exp(y * log(absolute(x)))
    whole = (np.rint(y.high) == y.high) & (y.low == 0)
    odd = whole & (np.fmod(y.high, 2.0) != 0)
    sign = np.where(x.high > 0, 1.0, np.where(whole, np.where(odd, -1.0, 1.0), np.nan))
    unusual = (x.high == 0) | ~np.isfinite(x.high) | (y.high == 0) | ~np.isfinite(y.high)
    return finished(size.scaled(sign), np.power, x, y, undefined=unusual)
