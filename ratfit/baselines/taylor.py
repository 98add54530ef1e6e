"""The Taylor series of an exact function by numbers, told from what only looks like one."""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import Any

import mpmath
import sympy as sp

from ratfit._multiprecise import multiprecise
from ratfit.baselines.original import Original

BITS = (160, 240)
"""The series is taken by steps of 2**-160 and of 2**-240 of the domain: a true one is the same in both."""

SAME = mpmath.ldexp(1, -100)
"""The relative difference that the steps may make of a coefficient."""

VANISHING = mpmath.ldexp(1, -30)
"""The share that is left of a coefficient which is zero in truth when the step becomes 2**-80 of what it was."""


def taylor(original: Original, at: sp.Expr, order: int) -> list[Fraction] | None:
    """Taylor coefficients 0 to `order` of the exact function in the distance from a place.

    They are differences over tiny steps, of two sizes and, inside the domain, on two sides. None where the two do not
    agree (at a root, a kink, a pole), where the function is no number, and where all coefficients are zero.
    """
    low, high = original.ends
    sides = {low: (1, 1), high: (-1, -1)}.get(at, (1, -1))
    coarse, fine = (_differences(original, at, order, side, bits) for side, bits in zip(sides, BITS, strict=True))
    if coarse is None or fine is None:
        return None
    found = []
    for first, second in zip(coarse, fine, strict=True):
        if abs(second) <= VANISHING * abs(first):
            found.append(Fraction(0))
        elif abs(first - second) <= SAME * abs(second):
            found.append(_fraction(second))
        else:
            return None
    return found if any(found) else None


def _differences(original: Original, at: sp.Expr, order: int, side: int, bits: int) -> list[Any] | None:
    """By order + 1 values; they have so many digits that the step's size is what is left of the error."""
    with mpmath.workprec((bits + 20) * (order + 1) + 100):
        place = multiprecise(at)
        step = side * mpmath.ldexp(multiprecise(original.ends[1] - original.ends[0]), -bits)
        # Half a step away: at the place itself the formula may be 0/0.
        values: list[Any] = [original.number(place + step * (k + mpmath.mpf(0.5))) for k in range(order + 1)]
        if any(value is None for value in values):
            return None
        found = []
        for k in range(order + 1):
            found.append(values[0] / (mpmath.factorial(k) * step**k))
            values = [after - before for before, after in itertools.pairwise(values)]
        return found


def _fraction(number: Any) -> Fraction:
    """An mpf as the number that it is."""
    sign, mantissa, exponent, _ = number._mpf_
    return Fraction(-int(mantissa) if sign else int(mantissa)) * Fraction(2) ** int(exponent)
