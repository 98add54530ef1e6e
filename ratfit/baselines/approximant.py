"""The Pade approximant of a series, its block included."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import mpmath

from ratfit.baselines.written import Polynomial

DIGITS = 60

ZERO = mpmath.mpf("1e-20")
"""What counts as zero of numbers scaled to 1: the series is known to 30 digits."""


def approximant(series: Sequence[Fraction], above: int, below: int) -> tuple[Polynomial, Polynomial] | None:
    """Numerator and denominator of the [above/below] Pade approximant; None where it is zero.

    In a block of the Pade table the approximants are one and the same, and beyond 20 digits they cannot be told apart:
    the degrees fall until the equations have one solution (gonnet2013).

    **Arguments:** the Taylor coefficients 0 to `above + below`, not all of them zero.
    """
    with mpmath.workdps(DIGITS):
        c, size, unit = _balanced(series)
        above, below, bottom = _denominator(c, above, below)
        top = [sum((bottom[j] * c[i - j] for j in range(min(i, below) + 1)), mpmath.mpf(0)) for i in range(above + 1)]
        scaled = [[_rational(number) * unit**k for k, number in enumerate(part)] for part in (top, bottom)]
    return _cancelled([number * size for number in scaled[0]], scaled[1]) if any(scaled[0]) else None


def _balanced(series: Sequence[Fraction]) -> tuple[list[Any], Fraction, Fraction]:
    """The series in units of its size and of the variable in which no coefficient is larger than 1; both units."""
    first = next(k for k, number in enumerate(series) if number)
    ratios = [(abs(number / series[first]), k - first) for k, number in enumerate(series) if k > first and number]
    growth = max((mpmath.root(_real(ratio), power) for ratio, power in ratios), default=mpmath.mpf(1))
    unit = Fraction(2) ** int(mpmath.ceil(mpmath.log(growth, 2)))
    size = abs(series[first]) / unit**first
    return [_real(number / unit**k / size) for k, number in enumerate(series)], size, unit


def _denominator(c: Sequence[Any], above: int, below: int) -> tuple[int, int, list[Any]]:
    """The degrees, lowered in a block, and the denominator's coefficients: what the equations leave."""
    while below:
        rows = [
            [c[i - j] if i >= j else mpmath.mpf(0) for j in range(below + 1)]
            for i in range(above + 1, above + below + 1)
        ]
        _, sizes, right = mpmath.svd_r(mpmath.matrix(rows), full_matrices=True)
        rank = sum(size > ZERO for size in sizes)
        if rank == below:
            return above, below, [right[below, j] for j in range(below + 1)]
        above, below = above - below + rank, rank
    return above, 0, [mpmath.mpf(1)]


def _real(number: Fraction) -> Any:
    return mpmath.mpf(number.numerator) / number.denominator


def _rational(number: Any) -> Fraction:
    """A number scaled to 1 as a fraction; zero where it is so but for rounding."""
    return Fraction(0) if abs(number) <= ZERO else Fraction(mpmath.nstr(number, DIGITS - 10))


def _cancelled(top: list[Fraction], bottom: list[Fraction]) -> tuple[Polynomial, Polynomial]:
    """Without the powers of the variable that both have, and without leading zeros."""
    while top[0] == bottom[0] == 0:
        top, bottom = top[1:], bottom[1:]
    for part in (top, bottom):
        while part[-1] == 0:
            part.pop()
    return top, bottom
