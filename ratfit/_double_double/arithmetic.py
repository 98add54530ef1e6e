"""Double-double numbers on NumPy arrays: each value is an unevaluated sum of two float64, some 106 bits.

NumPy and not XLA: a compiler that contracts `a*b + c` into one fused operation breaks the error-free transformations
that all of this stands on, while every NumPy operation rounds once and is left alone.

Letters and names follow joldes2017 (Tight and rigorous error bounds for basic building blocks of double-word
arithmetic), u = 2**-53. The bounds hold where neither a result nor its rounding error under- or overflows: between
about 1e-290 and 1e308. Outside, values are as good as float64's, and so are infinities, nan and the signs of zeros.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

Array = Any  # a NumPy array of float64, or a scalar that broadcasts with one

# Half of a significand's 53 bits: added and masked away, they leave 26 bits, rounded to nearest.
_HALF_OF_LOWER = np.int64(1 << 26)
_UPPER_BITS = np.int64(-(1 << 27))

# A product of this size has an error that float64 still holds; smaller numbers are raised before they are divided.
_SMALL, _RAISE = 2.0**-960, 2.0**200


@dataclass(frozen=True, slots=True, eq=False)
class DoubleDouble:
    """The number `high + low`, where `high` is the float64 nearest to it; `low` is 0 where `high` is not finite.

    The operators take another `DoubleDouble` or an exact float64. Relative errors, after joldes2017: sum and
    difference 3 u**2, product 7 u**2, quotient 15 u**2; an integer power n, by repeated products, 7 n u**2.
    """

    high: Array
    low: Array

    def __add__(self, other: DoubleDouble | Array) -> DoubleDouble:
        if isinstance(other, DoubleDouble):
            return _sum(self, other.high, other.low)
        s_h, s_l = two_sum(self.high, other)
        return settled(s_h, s_l + self.low, s_h)

    def __sub__(self, other: DoubleDouble | Array) -> DoubleDouble:
        return _sum(self, -other.high, -other.low) if isinstance(other, DoubleDouble) else self + -other

    def __mul__(self, other: DoubleDouble | Array) -> DoubleDouble:
        if isinstance(other, DoubleDouble):
            c_h, c_l = two_product(self.high, other.high)
            return settled(c_h, c_l + (self.high * other.low + self.low * other.high), c_h)
        c_h, c_l = two_product(self.high, other)
        return settled(c_h, c_l + self.low * other, c_h)

    def __truediv__(self, other: DoubleDouble | Array) -> DoubleDouble:
        size = np.abs(self.high)
        if size.min() >= _SMALL:
            return _quotient(self, other)
        raised = np.where(size < _SMALL, _RAISE, 1.0)
        return _quotient(self.scaled(raised), other).scaled(1 / raised)

    def __neg__(self) -> DoubleDouble:
        return DoubleDouble(-self.high, -self.low)

    def __getitem__(self, place: Any) -> DoubleDouble:
        return DoubleDouble(self.high[place], self.low[place])

    def scaled(self, power_of_two: Array) -> DoubleDouble:
        """The product with a power of two, which is exact."""
        return DoubleDouble(self.high * power_of_two, self.low * power_of_two)

    def take(self, index: Array) -> DoubleDouble:
        """The entries of a table at these places, held inside it: where the place is meaningless, so is the entry."""
        return DoubleDouble(self.high.take(index, mode="clip"), self.low.take(index, mode="clip"))


def whole(value: Array) -> DoubleDouble:
    """A float64 as a double-double."""
    return DoubleDouble(value, np.zeros_like(value))


def reciprocal(x: DoubleDouble, numerator: float = 1.0) -> DoubleDouble:
    """An exact float64 over x."""
    return whole(np.full_like(x.high, numerator)) / x


def two_sum(a: Array, b: Array) -> tuple[Array, Array]:
    """The rounded sum and its rounding error, exact (knuth1998, Sec. 4.2.2)."""
    s = a + b
    b_ = s - a
    return s, (a - (s - b_)) + (b - b_)


def two_product(a: Array, b: Array, parts_of_b: tuple[Array, Array] | None = None) -> tuple[Array, Array]:
    """The rounded product and its rounding error, exact (dekker1971); `parts_of_b` is `split(b)` where it is known."""
    p = a * b
    (a_h, a_l), (b_h, b_l) = split(a), parts_of_b or split(b)
    return p, ((a_h * b_h - p) + a_h * b_l + a_l * b_h) + a_l * b_l


def split(a: Array) -> tuple[Array, Array]:
    """A float64 as a sum of two, whose products with another's parts are exact.

    26 bits and 26 bits with a sign, by rounding the significand as an integer: fewer operations than Veltkamp's, and
    no overflow.
    """
    bits = np.float64(a).view(np.int64) if isinstance(a, float) else a.view(np.int64)
    upper = ((bits + _HALF_OF_LOWER) & _UPPER_BITS).view(np.float64)
    return upper, a - upper


def settled(high: Array, low: Array, plain: Array) -> DoubleDouble:
    """`high + low` as a double-double where |low| <= |high| (dekker1971's Fast2Sum); `plain` where that fails.

    `plain` is what float64 gives: it stands where the sum is not finite, as errors of infinite values are nan, and it
    keeps the sign of a zero.
    """
    total = high + low
    rest = low - (total - high)
    finite = np.isfinite(total)
    if finite.all() and total.all():
        return DoubleDouble(total, rest)
    known = finite & ((total != 0) | (plain != 0))
    return DoubleDouble(np.where(known, total, plain), np.where(finite, rest, 0.0))


def _sum(x: DoubleDouble, y_h: Array, y_l: Array) -> DoubleDouble:
    """joldes2017, Algorithm 6, AccurateDWPlusDW: it stays accurate where the two cancel."""
    s_h, s_l = two_sum(x.high, y_h)
    t_h, t_l = two_sum(x.low, y_l)
    c = s_l + t_h
    v_h = s_h + c
    v_l = c - (v_h - s_h)
    return settled(v_h, t_l + v_l, s_h)


def _quotient(x: DoubleDouble, y: DoubleDouble | Array) -> DoubleDouble:
    """After joldes2017, Algorithm 17, DWDivDW2, for an x whose rounding errors float64 holds."""
    divisor, rest = (y.high, y.low) if isinstance(y, DoubleDouble) else (y, 0.0)
    quotient = x.high / divisor
    c_h, c_l = two_product(quotient, divisor)
    # The first difference is exact: the quotient is within one rounding of the true one.
    return settled(quotient, ((x.high - c_h) - c_l + (x.low - quotient * rest)) / divisor, quotient)


def square_root(x: DoubleDouble) -> DoubleDouble:
    """One step of Newton from float64's root (hida2001): relative error 4 u**2; nan below 0."""
    raised = np.where(x.high < _SMALL, _RAISE, 1.0)
    x = x.scaled(raised)
    s = np.sqrt(x.high)
    p, e = two_product(s, s)
    return settled(s, ((x.high - p) - e + x.low) / (2 * s), s).scaled(1 / np.sqrt(raised))


def cube_root(x: DoubleDouble) -> DoubleDouble:
    """One step of Newton from float64's root: relative error 8 u**2; nan below 0, as `x**(1/3)` is complex there."""
    small = x.high < _SMALL
    x = x.scaled(np.where(small, 2.0**240, 1.0))
    r = np.where(x.high >= 0, np.cbrt(x.high), np.nan)
    defect = x - whole(r) * r * r
    return settled(r, defect.high / (3 * r * r), r).scaled(np.where(small, 2.0**-80, 1.0))


def select(condition: Array, chosen: DoubleDouble, other: DoubleDouble) -> DoubleDouble:
    """`chosen` where the condition holds, elsewhere `other`."""
    return DoubleDouble(np.where(condition, chosen.high, other.high), np.where(condition, chosen.low, other.low))


def less(x: DoubleDouble, y: DoubleDouble) -> Array:
    """Whether x < y."""
    return (x.high < y.high) | ((x.high == y.high) & (x.low < y.low))


def equal(x: DoubleDouble, y: DoubleDouble) -> Array:
    """Whether x == y."""
    return (x.high == y.high) & (x.low == y.low)


def absolute(x: DoubleDouble) -> DoubleDouble:
    """|x|."""
    return x.scaled(np.copysign(1.0, x.high))


def floor(x: DoubleDouble) -> DoubleDouble:
    """The greatest integer not above x: of a whole `high`, `low` decides."""
    high = np.floor(x.high)
    return settled(high, np.where(high == x.high, np.floor(x.low), 0.0), high)
