"""sin, cos, tan and their inverses in double-double.

sin: x = n pi/2 + c + s, c the nearest multiple of 1/256, and sin(x) = A cos(s) + B sin(s) with A = sin(n pi/2 + c),
B = cos(n pi/2 + c) from a table (hida2001, with a finer table). The inverses take float64's angle and turn
back by it: what is left is so small that it is its own tangent.
"""

from __future__ import annotations

from functools import cache

import mpmath
import numpy as np

from ratfit._double_double.arithmetic import Array, DoubleDouble, settled, square_root, whole
from ratfit._double_double.reduction import quarter_turns
from ratfit._double_double.tables import DIGITS, finished, pairs, series

_STEPS = 256
_LAST = 202  # steps each side of 0: beyond pi/4
_WIDTH = 2 * _LAST + 1


@cache
def _constants() -> tuple[DoubleDouble, list[DoubleDouble], list[DoubleDouble]]:
    """The sines of c, c + pi/2, c + pi, c + 3 pi/2; the coefficients of sin(s)/s and (cos(s) - 1)/s**2 in s**2."""
    with mpmath.workdps(DIGITS):
        places = [mpmath.mpf(step) / _STEPS for step in range(-_LAST, _LAST + 1)]
        sines, cosines = [mpmath.sin(c) for c in places], [mpmath.cos(c) for c in places]
        table = pairs([*sines, *cosines, *(-s for s in sines), *(-c for c in cosines)])
        odd = pairs((-1) ** n / mpmath.factorial(2 * n + 1) for n in range(7))
        even = pairs((-1) ** (n + 1) / mpmath.factorial(2 * n + 2) for n in range(6))
        return table, [odd[n] for n in range(7)], [even[n] for n in range(6)]


def _turned(x: DoubleDouble, quarters: int) -> DoubleDouble:
    return _sines(x, quarters)[0]


def _sines(x: DoubleDouble, *quarters: int) -> list[DoubleDouble]:
    """The sine of x plus each of these multiples of pi/2."""
    table, odd, even = _constants()
    n, r = quarter_turns(x)
    step = np.rint(np.fmin(np.fmax(r.high * _STEPS, -_LAST), _LAST))
    s = r - step / _STEPS
    square = s * s
    sine, cosine_less_one = s * series(square, odd, 3), square * series(square, even, 2)
    place = step.astype(np.int64) + _LAST
    return [_combined(table, place, n + quarter, sine, cosine_less_one) for quarter in quarters]


def _combined(
    table: DoubleDouble, place: Array, n: Array, sine: DoubleDouble, cosine_less_one: DoubleDouble
) -> DoubleDouble:
    a, b = table.take((n & 3) * _WIDTH + place), table.take((n + 1 & 3) * _WIDTH + place)
    return a + (a * cosine_less_one + b * sine)


def sin(x: DoubleDouble) -> DoubleDouble:
    """sin(x): relative error 8 u**2, near the multiples of pi and for large arguments too."""
    return finished(_turned(x, 0), np.sin, x)


def cos(x: DoubleDouble) -> DoubleDouble:
    """cos(x): relative error 8 u**2, near its zeros and for large arguments too."""
    return finished(_turned(x, 1), np.cos, x)


def tan(x: DoubleDouble) -> DoubleDouble:
    """tan(x): relative error 8 u**2."""
    sine, cosine = _sines(x, 0, 1)
    return finished(sine / cosine, np.tan, x)


def atan2(y: DoubleDouble, x: DoubleDouble) -> DoubleDouble:
    """The angle of the point (x, y): relative error 8 u**2.

    Turned back by float64's angle, the point has the small angle (y c - x s)/(x c + y s).
    """
    y, x = _of_one_size(y, x)
    angle = np.arctan2(y.high, x.high)
    s, c = _sines(whole(angle), 0, 1)
    left = (y * c - x * s).high / (x.high * c.high + y.high * s.high)
    return finished(settled(angle, left, angle), np.arctan2, y, x)


def _of_one_size(y: DoubleDouble, x: DoubleDouble) -> tuple[DoubleDouble, DoubleDouble]:
    """Both times the power of two that makes the larger about 1, so that no product under- or overflows."""
    exponent = np.frexp(np.maximum(np.abs(y.high), np.abs(x.high)))[1]
    half = -exponent // 2
    first, second = np.ldexp(1.0, half), np.ldexp(1.0, -exponent - half)
    return y.scaled(first).scaled(second), x.scaled(first).scaled(second)


def atan(x: DoubleDouble) -> DoubleDouble:
    """atan(x): relative error 8 u**2."""
    return finished(atan2(x, whole(np.ones_like(x.high))), np.arctan, x, undefined=np.isnan(x.high))


def asin(x: DoubleDouble) -> DoubleDouble:
    """atan2(x, sqrt(1 - x**2)): relative error 8 u**2; nan beyond 1."""
    return finished(atan2(x, _cofactor(x)), np.arcsin, x)


def acos(x: DoubleDouble) -> DoubleDouble:
    """atan2(sqrt(1 - x**2), x): relative error 8 u**2, near 1 too; nan beyond 1."""
    return finished(atan2(_cofactor(x), x), np.arccos, x)


def _cofactor(x: DoubleDouble) -> DoubleDouble:
    """sqrt(1 - x**2), by factors so that nothing cancels."""
    return square_root((-x + 1.0) * (x + 1.0))
