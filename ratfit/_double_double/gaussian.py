"""erf and erfc in double-double.

erfc(x) = exp(-x**2) erfcx(x) for x >= 1/2, erfcx by Taylor's series about the multiples of 1/16; erf by its series at
0 for |x| < 1/2 (abramowitz1964, 7.1.5). Nothing cancels, so the relative accuracy reaches out to the underflow.
"""

from __future__ import annotations

from functools import cache

import mpmath
import numpy as np

from ratfit._double_double.arithmetic import DoubleDouble, absolute, two_product, whole
from ratfit._double_double.exponential import exp
from ratfit._double_double.tables import branched, finished, pairs, series

_STEPS = 16
_FIRST, _END = 0.5, 28.0  # erfc underflows at 27.23
_TERMS, _EXACT = 20, 11
_ERF_TERMS, _ERF_EXACT = 24, 14
# The recurrence for Taylor's coefficients cancels: of 100 digits it leaves 50 at the largest x and order.
_DIGITS = 100


@cache
def _coefficients_about_zero() -> list[DoubleDouble]:
    """Of erf(x)/x in x**2."""
    with mpmath.workdps(_DIGITS):
        scale = 2 / mpmath.sqrt(mpmath.pi)
        found = pairs((-1) ** n * scale / (mpmath.factorial(n) * (2 * n + 1)) for n in range(_ERF_TERMS))
        return [found[n] for n in range(_ERF_TERMS)]


@cache
def _scaled_coefficients() -> list[DoubleDouble]:
    """Of erfcx about each multiple of 1/16: entry n holds the n-th coefficient at all centres."""
    with mpmath.workdps(_DIGITS):
        places = range(int(_FIRST * _STEPS), int(_END * _STEPS) + 1)
        rows = [_taylor(mpmath.mpf(place) / _STEPS) for place in places]
        return [pairs(row[n] for row in rows) for n in range(_TERMS)]


def _taylor(x: mpmath.mpf) -> list[mpmath.mpf]:
    """w' = 2 x w - 2/sqrt(pi) gives (n + 1) a_(n+1) = 2 x a_n + 2 a_(n-1) for n >= 1."""
    w = mpmath.exp(x * x) * mpmath.erfc(x)
    a = [w, 2 * x * w - 2 / mpmath.sqrt(mpmath.pi)]
    for n in range(1, _TERMS - 1):
        a.append((2 * x * a[n] + 2 * a[n - 1]) / (n + 1))
    return a


def erf(x: DoubleDouble) -> DoubleDouble:
    """erf(x): relative error 8 u**2."""
    size = absolute(x)
    value = branched(size.high < _FIRST, _erf_near, lambda a: -_erfc_far(a) + 1.0, size)
    return finished(value.scaled(np.copysign(1.0, x.high)), _plain_erf, x)


def erfc(x: DoubleDouble) -> DoubleDouble:
    """1 - erf(x): relative error 8 u**2, out to the underflow at 26.5."""
    value = branched(x.high < _FIRST, _erfc_below, _erfc_far, x)
    return finished(value, _plain_erfc, x)


def _erf_near(x: DoubleDouble) -> DoubleDouble:
    return x * series(x * x, _coefficients_about_zero(), _ERF_EXACT)


def _erfc_below(x: DoubleDouble) -> DoubleDouble:
    return branched(x.high > -_FIRST, lambda a: -_erf_near(a) + 1.0, lambda a: -_erfc_far(-a) + 2.0, x)


def _erfc_far(x: DoubleDouble) -> DoubleDouble:
    """For x >= 1/2."""
    high = np.minimum(x.high, _END)
    held = DoubleDouble(high, np.where(high == x.high, x.low, 0.0))
    step = np.rint(np.fmin(np.fmax(high, _FIRST), _END) * _STEPS)
    place = step.astype(np.int64) - int(_FIRST * _STEPS)
    coefficients = [coefficient.take(place) for coefficient in _scaled_coefficients()]
    return _exp_of_minus_square(held) * series(held - step / _STEPS, coefficients, _EXACT)


def _exp_of_minus_square(x: DoubleDouble) -> DoubleDouble:
    """exp(-x**2), x**2 = p + q taken beyond double-double: its absolute error is the relative one of the result."""
    p, e = two_product(x.high, x.high)
    q = whole(x.low) * (2 * x.high) + e + x.low * x.low
    grown = exp(whole(-p))
    return grown - grown * (q - 0.5 * q.high * q.high)


def _plain_erf(x: np.ndarray) -> np.ndarray:
    import scipy.special

    return scipy.special.erf(x)


def _plain_erfc(x: np.ndarray) -> np.ndarray:
    import scipy.special

    return scipy.special.erfc(x)
