"""Recognise a coefficient as a function of a parameter; a guess, to be verified by whoever asks."""

from __future__ import annotations

from collections.abc import Sequence

import mpmath
import sympy as sp

from ratfit._multiprecise import multiprecise
from ratfit._solver.nonlinear.recognise import recognised

DEGREE = 4
"""Largest degree of numerator and denominator that is tried."""

DIGITS = 60
AGREES = mpmath.mpf(10) ** -40


def recognised_function(
    parameter: sp.Symbol,
    places: Sequence[sp.Rational],
    values: Sequence[sp.Rational],
    constants: Sequence[sp.Expr] = (),
) -> sp.Expr | None:
    """A rational function of a parameter, or of its square root, that takes the values at the places to 40 digits.

    It is found from as many places as it has coefficients and believed for agreeing at all others; None where there
    are too few others, or no function of low degree.
    """
    positive = all(place > 0 for place in places)
    with mpmath.workdps(DIGITS + 20):
        known, at = ([multiprecise(number) for number in numbers] for numbers in (values, places))
        for argument, points in ((parameter, at), *([(sp.sqrt(parameter), list(map(mpmath.sqrt, at)))] * positive)):
            for total in range(2 * DEGREE + 1):
                for below in range(total + 1):
                    degrees = (total - below, below)
                    if max(degrees) > DEGREE or total + 4 > len(places):
                        continue
                    found = _rational_function(points, known, *degrees)
                    formula = None if found is None else _written(argument, *found, constants)
                    if formula is not None:
                        return formula
    return None


def _rational_function(
    points: list[mpmath.mpf], values: list[mpmath.mpf], above: int, below: int
) -> tuple[list[mpmath.mpf], list[mpmath.mpf]] | None:
    """Coefficients of numerator and denominator, one of the latter 1, that agree at all points."""
    n = above + below + 1
    for fixed in range(below + 1):
        free = [j for j in range(below + 1) if j != fixed]
        rows = [
            [p**i for i in range(above + 1)] + [-v * p**j for j in free] for p, v in zip(points, values, strict=True)
        ]
        right = [v * p**fixed for p, v in zip(points, values, strict=True)]
        step = max(1, len(points) // n)
        chosen = list(range(0, len(points), step))[:n]
        try:
            solution = mpmath.lu_solve(
                mpmath.matrix([rows[k] for k in chosen]), mpmath.matrix([right[k] for k in chosen])
            )
        except (ZeroDivisionError, ValueError):
            continue
        misfits = (
            mpmath.fsum(c * e for c, e in zip(solution, row, strict=True)) - r
            for row, r in zip(rows, right, strict=True)
        )
        if all(abs(misfit) < AGREES * (1 + abs(r)) for misfit, r in zip(misfits, right, strict=True)):
            bottom = list(solution[above + 1 :])
            bottom.insert(fixed, mpmath.mpf(1))
            return list(solution[: above + 1]), bottom
    return None


def _written(
    argument: sp.Expr, above: list[mpmath.mpf], below: list[mpmath.mpf], constants: Sequence[sp.Expr]
) -> sp.Expr | None:
    numbers = [mpmath.mpf(0) if abs(c) < AGREES else c for c in (*above, *below)]
    found = recognised(numbers, constants, digits=45)
    if found is None:
        return None
    top, bottom = found[: len(above)], found[len(above) :]
    return sp.cancel(_polynomial(argument, top) / _polynomial(argument, bottom))


def _polynomial(argument: sp.Expr, coefficients: Sequence[sp.Expr]) -> sp.Expr:
    return sp.Add(*(c * argument**k for k, c in enumerate(coefficients)))
