"""Arguments of the circular functions less multiples of pi/2, without loss near those multiples.

A float64 may lie 2**-60 of its size from a multiple: pi/2 is therefore taken in five limbs of 185 bits together (the
reduction of cody1980), and for large arguments, where the limbs end, in integers (payne1983), which takes microseconds.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import mpmath
import numpy as np

from ratfit._double_double.arithmetic import Array, DoubleDouble, settled, two_sum
from ratfit._double_double.tables import limbs, pairs

_MEDIUM = 2.0**20
_LIMB = 33  # bits: a multiple of a limb by less than 2**20 is exact
_SCALE = 1074  # every float64 is an integer over 2**1074
_BITS = 1400  # of 2/pi: what the largest float64 needs and 300 more


@cache
def _constants() -> tuple[list[float], int, DoubleDouble]:
    """pi/2 in limbs, 2/pi as an integer over 2**_BITS, pi/2."""
    with mpmath.workprec(_BITS + 100):
        inverse = int(mpmath.floor(mpmath.ldexp(2 / mpmath.pi, _BITS)))
        return limbs(mpmath.pi / 2, _LIMB, 5), inverse, pairs([mpmath.pi / 2])[0]


def quarter_turns(x: DoubleDouble) -> tuple[Array, DoubleDouble]:
    """The integer n nearest to x/(pi/2), modulo 4, and r = x - n pi/2, relative error 4 u**2; r is nan of inf."""
    size = np.abs(x.high)
    if np.all(size < 0.785):  # not of nan
        return np.zeros(x.high.shape, np.int64), x
    n = np.where(size < _MEDIUM, np.rint(x.high * (2 / np.pi)), 0.0)
    r = _less_multiples(x, n)
    quadrant = n.astype(np.int64) & 3
    large = np.flatnonzero((size >= _MEDIUM) & np.isfinite(size))
    if large.size:
        turns = [_in_integers(*pair) for pair in zip(x.high[large].tolist(), x.low[large].tolist(), strict=True)]
        quadrant[large] = [turn[0] for turn in turns]
        fraction = DoubleDouble(np.array([turn[1] for turn in turns]), np.array([turn[2] for turn in turns]))
        fraction = fraction * _constants()[2]
        r.high[large], r.low[large] = fraction.high, fraction.low
    return quadrant, DoubleDouble(np.where(np.isinf(size), np.nan, r.high), r.low)


def _less_multiples(x: DoubleDouble, n: Array) -> DoubleDouble:
    first, *others = _constants()[0]
    # The first difference is exact: the two are within a factor of 2, or n is 0 or 1.
    return _distilled([x.high - n * first, *(-n * limb for limb in others), x.low])


def _distilled(terms: Sequence[Array]) -> DoubleDouble:
    """A sum as if in three times the precision, whatever cancels (ogita2005, Algorithm 4.8, SumK)."""
    parts = list(terms)
    for _ in range(2):
        for place in range(1, len(parts)):
            parts[place], parts[place - 1] = two_sum(parts[place], parts[place - 1])
    rest = parts[0]
    for part in parts[1:-1]:
        rest = rest + part
    return settled(parts[-1], rest, parts[-1])


def _in_integers(high: float, low: float) -> tuple[int, float, float]:
    """n modulo 4, and x/(pi/2) - n as two floats."""
    product = (_integer(high) + _integer(low)) * _constants()[1]
    shift = _SCALE + _BITS
    n = (product + (1 << (shift - 1))) >> shift
    rest = product - (n << shift)
    fraction = rest / (1 << shift) if rest.bit_length() > 1100 else 0.0
    numerator, denominator = fraction.as_integer_ratio()
    return n & 3, fraction, (rest - numerator * ((1 << shift) // denominator)) / (1 << shift)


def _integer(value: float) -> int:
    numerator, denominator = value.as_integer_ratio()
    return numerator * ((1 << _SCALE) // denominator)
