"""Poles of a fit on the domain where the exact function has none: near them no mean or maximum means anything."""

from __future__ import annotations

import itertools

import sympy as sp

from ratfit._kernel import Program
from ratfit._lower import lower
from ratfit._poles import poles
from ratfit._setting import Setting

STEPS = (1e-3, 1e-6, 1e-9)
"""Distances from a suspected pole, as shares of the domain's length, at which the fit is looked at."""

GROWTH = 10.0
"""From each distance to the next a pole of any order from 1/3 on grows by more than that."""


def poles_of(place: Setting) -> tuple[float, ...]:
    """Where on the closed domain the fit is infinite and the exact function is not, in increasing order.

    Of parameters that are drawn at random, some values of the range are looked at; what lies between them is not seen.
    """
    x = place.variable
    fixed = {symbol: sp.Rational(value) for symbol, value in place.values.items()}
    powers = [node for node in place.formula.atoms(sp.Pow) if node.has(x) and node.exp.could_extract_minus_sign()]
    found = set()
    for base in {node.base.xreplace(fixed) for node in powers}:
        for root, values in poles(base, x, (sp.Rational(place.low), sp.Rational(place.high))):
            at = min(max(float(root), place.low), place.high)
            if _is_pole(place, at, {symbol: float(value) for symbol, value in values.items()}):
                found.add(at)
    return tuple(sorted(found))


def _is_pole(place: Setting, at: float, drawn: dict[sp.Symbol, float]) -> bool:
    return any(_grows(place, at, side, drawn) for side in (-1, 1))


def _grows(place: Setting, at: float, side: int, drawn: dict[sp.Symbol, float]) -> bool:
    """Whether, on one side, the fit grows without bound and the exact function does not grow with it."""
    known = {**place.values, **drawn}
    symbols = (place.variable, *known)
    points = [at + side * step * (place.high - place.low) for step in STEPS]
    if not all(place.low <= point <= place.high for point in points):
        return False
    sizes = [
        [abs(lower(program.result, symbols, "numpy", program.steps)(point, *known.values())) for point in points]
        for program in (Program(place.formula), Program(place.exact))
    ]
    fit, exact = (all(far * GROWTH < near for far, near in itertools.pairwise(each)) for each in sizes)
    return fit and not exact
