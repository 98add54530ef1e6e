"""Poles of a fit on the domain where the exact function has none: near them no mean or maximum means anything."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping

import sympy as sp

from ratfit._lower import lower
from ratfit._poles import poles
from ratfit._setting import Setting

STEPS = (1e-3, 1e-6, 1e-9)
"""Distances from a suspected pole, as shares of the domain's length, at which the fit is looked at."""

GROWTH = 9.0
"""From each distance to the next a pole of any order from 1/3 on grows by more than that."""

SLACK = 4
"""How many units in the last place an end of the domain may lie beside its true place, pi/2 for one."""

_POLES_OF: Mapping[type[sp.Function], Callable[[sp.Expr], sp.Expr]] = {
    sp.tan: sp.cos, sp.sec: sp.cos, sp.cot: sp.sin, sp.csc: sp.sin, sp.coth: sp.sinh, sp.csch: sp.sinh,
}  # fmt: skip
"""Functions that are infinite where another is 0."""


def poles_of(place: Setting) -> tuple[float, ...]:
    """Where on the closed domain the fit is infinite and the exact function is not, in increasing order.

    Of parameters that are drawn at random, some values of the range are looked at; what lies between them is not seen.
    """
    return _places(place, place.formula, place.exact)


def poles_of_exact(place: Setting) -> tuple[float, ...]:
    """Where on the closed domain the exact function is infinite, in increasing order, as far as polynomials tell."""
    return _places(place, place.exact, sp.S.One, polynomials=True)


def _places(place: Setting, formula: sp.Expr, other: sp.Expr, polynomials: bool = False) -> tuple[float, ...]:
    """Where one expression is infinite and the other is not; on wish only zeros of polynomials are looked at.

    Of a whole model nothing is said: its cosines belong together, and none is on its own an axis with poles.
    """
    if place.whole:
        return ()
    x = place.variable
    fixed = {symbol: sp.Rational(value) for symbol, value in place.values.items()}
    middle = {symbol: (low + high) / 2 for symbol, (low, high) in place.ranges.items()}
    found = set()
    zeros = {zero.xreplace(fixed) for zero in _denominators(formula) if zero.has(x)}
    zeros = {zero for zero in zeros if zero.is_polynomial(x)} if polynomials else zeros
    for zero, support in itertools.product(zeros, _supports(place)):
        for root, values in poles(zero, x, support):
            at = min(max(float(root), place.low), place.high)
            drawn = middle | {symbol: float(value) for symbol, value in values.items()}
            if any(_grows(place, (formula, other), at, side, drawn) for side in (-1, 1)):
                found.add(at)
    return tuple(sorted(found))


def _supports(place: Setting) -> Iterator[tuple[sp.Expr, sp.Expr]]:
    """The domain as it is, whose ends may be zeros that do not change their sign, and a little more."""
    yield sp.Rational(place.low), sp.Rational(place.high)
    yield (
        sp.Rational(place.low - SLACK * math.ulp(place.low)),
        sp.Rational(place.high + SLACK * math.ulp(place.high)),
    )


def _denominators(formula: sp.Expr) -> Iterator[sp.Expr]:
    """Expressions that are 0 wherever the formula may be infinite."""
    for node in formula.atoms(sp.Pow):
        if node.exp.could_extract_minus_sign():
            yield sp.fraction(sp.together(node.base.replace(sp.Abs, lambda inside: inside)))[0]
    for node in formula.atoms(*_POLES_OF):
        yield _POLES_OF[node.func](*node.args)


def _grows(place: Setting, pair: tuple[sp.Expr, sp.Expr], at: float, side: int, drawn: dict[sp.Symbol, float]) -> bool:
    """Whether, on one side, the first expression grows without bound and the other does not grow with it."""
    known = {**place.values, **drawn}
    symbols = (place.variable, *known)
    points = [at + side * step * (place.high - place.low) for step in STEPS]
    if not all(place.low <= point <= place.high for point in points):
        return False
    sizes = [
        [abs(lower(expression, symbols, "numpy")(point, *known.values())) for point in points] for expression in pair
    ]
    first, other = (all(map(_more, each, each[1:])) for each in sizes)
    return first and not other


def _more(far: float, near: float) -> bool:
    """Whether a size grows like a pole's; what is beyond the numbers has grown as much as can be seen."""
    return near == math.inf or far * GROWTH < near
