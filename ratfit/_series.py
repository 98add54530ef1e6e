"""Taylor series of the parts of a form at a node, Laurent series at a place of a limit."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import lcm

import sympy as sp

from ratfit._field import is_zero
from ratfit._parse import RatfitError

MAX_POLE = 10
"""Highest order of a pole of the form's factor at a node that is multiplied away."""


def factor_series(factor: sp.Expr, x: sp.Symbol, at: sp.Expr, order: int) -> tuple[int, list[sp.Expr]]:
    """The order of the factor's pole at a node, and the Taylor coefficients of what is left when it is cleared."""
    if factor == 1:
        return 0, [sp.S.One]
    for pole in range(MAX_POLE + 1):
        try:
            return pole, taylor(sp.cancel(factor * (x - at) ** pole), x, at, order + pole)
        except RatfitError:
            continue
    raise RatfitError(f"form: the factor {factor} has no power series at {x} = {at}; state no condition there")


def taylor(expression: sp.Expr, x: sp.Symbol, at: sp.Expr, order: int) -> list[sp.Expr]:
    """Taylor coefficients 0 to `order`; RatfitError where one is not finite."""
    if expression.is_polynomial(x):
        return [*_shifted(expression, x, at), *[sp.S.Zero] * (order + 1)][: order + 1]
    found = []
    for k in range(order + 1):
        value = expression.subs(x, at) / sp.factorial(k)
        if value.has(sp.nan, sp.zoo, sp.oo, -sp.oo, sp.AccumBounds):
            raise RatfitError(f"{expression} has no power series at {x} = {at}")
        found.append(value)
        expression = sp.diff(expression, x)
    return found


@lru_cache(maxsize=1000)
def _shifted(polynomial: sp.Expr, x: sp.Symbol, at: sp.Expr) -> tuple[sp.Expr, ...]:
    """All Taylor coefficients of a polynomial, kept because every order of derivative at a node asks for them."""
    if not polynomial.has(x):
        return (polynomial,)
    step = sp.Dummy("step")
    return tuple(sp.Poly(polynomial.subs(x, at + step), step).all_coeffs()[::-1])


@dataclass(frozen=True)
class Laurent:
    """A series in the local coordinate: `coefficients[k]` goes with the power `lowest + k`."""

    lowest: int
    coefficients: tuple[sp.Expr, ...]

    def at(self, order: int) -> sp.Expr:
        """The coefficient of a power; zero below the lowest."""
        return self.coefficients[order - self.lowest] if order >= self.lowest else sp.S.Zero


LOCAL = sp.Dummy("local", positive=True)
"""The local coordinate of a Laurent series: it vanishes at the place, from inside the domain."""


def local_coordinate(expressions: list[sp.Expr], x: sp.Symbol, at: sp.Expr, side: int) -> list[sp.Expr]:
    """Expressions of x in the local coordinate s: x = at + side*s**r, at infinity x = s**(-r) or its negative.

    r makes the fractional powers of the distance whole ones.
    """
    distance = sp.Dummy("distance", positive=True)
    place = (1 if at is sp.oo else -1) / distance if at.is_infinite else at + side * distance
    moved = [_simplified(e.xreplace({x: place}), distance) for e in expressions]
    powers = {p.exp.q for e in moved for p in e.atoms(sp.Pow) if p.base == distance and p.exp.is_Rational}
    return [e.xreplace({distance: LOCAL ** lcm(*map(int, powers), 1)}) for e in moved]


def _simplified(expression: sp.Expr, distance: sp.Symbol) -> sp.Expr:
    """The expression with the powers of the distance taken out of roots: sqrt(2*d - d**2) is sqrt(d)*sqrt(2 - d)."""
    if expression.is_rational_function(distance):
        return sp.cancel(expression)
    roots = {p: _cleared_root(p, distance) for p in expression.atoms(sp.Pow) if p.exp.is_Rational and p.has(distance)}
    return sp.powsimp(sp.expand_power_base(expression.xreplace(roots)))


def _cleared_root(power: sp.Pow, distance: sp.Symbol) -> sp.Expr:
    if power.exp.is_Integer or not power.base.is_rational_function(distance):
        return power
    above, below = (sp.Poly(part, distance) for part in sp.fraction(sp.together(power.base)))
    lowest = min(above.monoms())[0] - min(below.monoms())[0]
    rest = sp.cancel(power.base / distance**lowest)
    return distance ** (lowest * power.exp) * rest**power.exp


def laurent(expression: sp.Expr, order: int) -> Laurent:
    """The Laurent series of an expression of LOCAL, up to the power `order`; RatfitError where it has none.

    Rational expressions are divided out; others must have a Taylor series once a power of LOCAL is cleared.
    """
    if expression == 0:
        return Laurent(order, (sp.S.Zero,))
    if expression.is_rational_function(LOCAL):
        above, below = (_ascending(part) for part in sp.fraction(sp.together(expression)))
        lowest = above[0] - below[0]
        return Laurent(lowest, _divided(above[1], below[1], max(order - lowest, 0) + 1))
    for pole in range(MAX_POLE + 1):
        try:
            found = taylor(sp.expand(sp.powsimp(expression * LOCAL**pole)), LOCAL, sp.S.Zero, max(order + pole, 0))
            return Laurent(-pole, tuple(found))
        except RatfitError:
            continue
    raise RatfitError(f"no power series there: {expression.xreplace({LOCAL: sp.Symbol('distance')})}")


def _ascending(polynomial: sp.Expr) -> tuple[int, list[sp.Expr]]:
    """The lowest power of LOCAL in a polynomial, and the coefficients from there on."""
    coefficients = sp.Poly(polynomial, LOCAL).all_coeffs()[::-1]
    lowest = next(k for k, c in enumerate(coefficients) if is_zero(c) is not True)
    return lowest, coefficients[lowest:]


def _divided(above: list[sp.Expr], below: list[sp.Expr], length: int) -> tuple[sp.Expr, ...]:
    quotient: list[sp.Expr] = []
    for k in range(length):
        rest = above[k] if k < len(above) else sp.S.Zero
        rest -= sum((quotient[j] * below[k - j] for j in range(k) if k - j < len(below)), sp.S.Zero)
        quotient.append(sp.cancel(rest / below[0]))
    return tuple(quotient)
