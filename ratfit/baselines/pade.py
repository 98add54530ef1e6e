"""Pade: the fraction that has as much of the exact function's Taylor series at one place as its degrees can hold."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import mpmath
import sympy as sp

from ratfit._fit import Fit
from ratfit._multiprecise import multiprecise
from ratfit._parse import RatfitError
from ratfit.baselines.original import Original
from ratfit.baselines.peer import Peer, degrees, peer
from ratfit.baselines.written import composed, fraction, rational

BITS = (160, 240)
"""Working precisions at which a series is taken, by steps of 2**-170 and 2**-250: a true one is the same in both."""

SAME = mpmath.mpf("1e-35")
"""How near the two must lie, in units of the series' largest term at half the domain's length."""

ZERO = mpmath.mpf("1e-25")
"""What counts as zero among numbers that are known to SAME: a singular value, a coefficient."""


def pade(fit: Fit, original: Original) -> Peer:
    """The Pade approximant with the fit's degrees, at the best of 0, the ends and the middle of the domain.

    The best is where the error over the domain, in float32, is smallest; of equal ones the first in the order 0,
    middle, low end, high end. At an end the series is that from inside.

    **Fails** with `RatfitError` where the exact function has a Taylor series at none of them.
    """
    found = [(at, formula, size) for at in _centres(original) for formula, size in _approximants(fit, original, at)]
    if not found:
        places = ", ".join(str(at) for at in _centres(original))
        raise RatfitError(f"the exact function has no Taylor series, or one of zeros, at {places}")
    at, formula, (above, below) = min(found, key=lambda entry: original.float32_error(entry[1]))
    about = f"[{above}/{below}] from the Taylor series at {float(at):.6g}"
    return peer("pade", fit, original, formula, about)


def _centres(original: Original) -> list[sp.Expr]:
    low, high = original.ends
    inside = [sp.S.Zero] if low <= 0 <= high else []
    return list(dict.fromkeys([*inside, original.middle, low, high]))


def _approximants(fit: Fit, original: Original, at: sp.Expr) -> list[tuple[sp.Expr, tuple[int, int]]]:
    """The approximant at a place in the distance from there and multiplied out, with its degrees; none, no series."""
    above, below = degrees(fit)
    series = taylor(original, at, above + below)
    found = approximant(series, above, below) if series else None
    if found is None:
        return []
    scale = 2 / (rational(original.ends[1]) - rational(original.ends[0]))
    parts = [[_rational(c) * scale**k for k, c in enumerate(part)] for part in found]
    back = [-rational(at), Fraction(1)]
    size = (len(parts[0]) - 1, len(parts[1]) - 1)
    x = original.variable
    near, far = fraction(*parts, x - at), fraction(*(composed(part, back) for part in parts), x)
    return [(near, size)] if at == 0 else [(far, size), (near, size)]


def _rational(number: Any) -> Fraction:
    return Fraction(int(number.man) * (-1 if number < 0 else 1)) * Fraction(2) ** int(number.exp)


def taylor(original: Original, at: sp.Expr, order: int) -> list[Any] | None:
    """Taylor coefficients 0 to `order` of the exact function, the variable in halves of the domain's length.

    They are differences over tiny steps, at two precisions and, inside the domain, on two sides: None where the two
    do not agree (a root, a kink), where the function is no number, and where all coefficients are 0.
    """
    low, high = original.ends
    sides = {low: (1, 1), high: (-1, -1)}.get(at, (1, -1))
    tried = [_differences(original, at, order, side, bits) for side, bits in zip(sides, BITS, strict=True)]
    if any(series is None for series in tried):
        return None
    first, second = tried
    size = max(map(abs, second))
    if size == 0 or any(abs(a - b) > SAME * size for a, b in zip(first, second, strict=True)):
        return None
    return second


def _differences(original: Original, at: sp.Expr, order: int, side: int, bits: int) -> list[Any] | None:
    """By n + 1 values at steps of h, so much finer than the working precision that h itself is the error."""
    with mpmath.workprec((bits + 20) * (order + 1)):
        place, half = multiprecise(at), multiprecise(original.ends[1] - original.ends[0]) / 2
        step = side * mpmath.ldexp(1, -bits - 10)
        # Half a step away: at the place itself the formula may be 0/0.
        values = [original.number(place + half * step * (k + mpmath.mpf(0.5))) for k in range(order + 1)]
        if any(value is None for value in values):
            return None
        coefficients = []
        for k in range(order + 1):
            coefficients.append(values[0] / (mpmath.factorial(k) * step**k))
            values = [after - before for before, after in itertools.pairwise(values)]
    with mpmath.workprec(bits):
        return [+coefficient for coefficient in coefficients]


def approximant(series: Sequence[Any], above: int, below: int) -> tuple[list[Any], list[Any]] | None:
    """Numerator and denominator of the [above/below] Pade approximant; None where it is zero.

    Where the table has a block, the approximant is the block's smallest: degrees fall until the equations have one
    solution (gonnet2013).
    """
    with mpmath.workprec(BITS[0]):
        unit = max(map(abs, series))
        c = [number / unit for number in series]
        while below:
            rows = [
                [c[i - j] if i >= j else mpmath.mpf(0) for j in range(below + 1)]
                for i in range(above + 1, above + below + 1)
            ]
            _, sizes, right = mpmath.svd_r(mpmath.matrix(rows), full_matrices=True)
            rank = sum(size > ZERO for size in sizes)
            if rank == below:
                break
            above, below = above - below + rank, rank
        bottom = [right[below, j] for j in range(below + 1)] if below else [mpmath.mpf(1)]
        top = [
            sum((bottom[j] * c[i - j] for j in range(min(i, below) + 1)), mpmath.mpf(0)) * unit
            for i in range(above + 1)
        ]
        return _cancelled(top, bottom)


def _cancelled(top: list[Any], bottom: list[Any]) -> tuple[list[Any], list[Any]] | None:
    """Without the powers of the variable that both have, and without leading zeros."""
    size = max(map(abs, top), default=mpmath.mpf(0))
    top = [number if abs(number) > ZERO * size else mpmath.mpf(0) for number in top]
    bottom = [number if abs(number) > ZERO else mpmath.mpf(0) for number in bottom]
    if not any(top):
        return None
    while top[0] == bottom[0] == 0:
        top, bottom = top[1:], bottom[1:]
    for part in (top, bottom):
        while part[-1] == 0:
            part.pop()
    return top, bottom
