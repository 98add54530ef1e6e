"""Integrals of fractions in closed form: Horowitz's and Ostrogradsky's rational part, then logarithms and arctangents.

sympy's own logarithmic part loses terms where a symbol is real (1.13, 1.14: the integral of (m + 2)*(x + 3)/(x**2 + 1)
is 0 there), so that part is ours: real formulas for linear and quadratic factors, nothing for higher ones.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp
from sympy.integrals.rationaltools import ratint_ratpart

from ratfit._parse import RatfitError
from ratfit._target import INSIDE, sample_values


@dataclass(frozen=True)
class _Logarithm:
    """factor*log|polynomial|."""

    factor: sp.Expr
    polynomial: sp.Poly

    def at(self, place: sp.Expr) -> sp.Expr:
        value = self.polynomial(place)
        return self.factor * sp.log(_sign(value) * value)


@dataclass(frozen=True)
class _Arctangent:
    """factor*atan(linear)."""

    factor: sp.Expr
    linear: sp.Poly

    def at(self, place: sp.Expr) -> sp.Expr:
        if place.is_infinite:
            return self.factor * sp.pi / 2 * _sign(self.linear.LC()) * (1 if place is sp.oo else -1)
        return self.factor * sp.atan(self.linear(place))


def rational_integral(integrand: sp.Expr, x: sp.Symbol, over: tuple[sp.Expr, sp.Expr]) -> sp.Expr:
    """The integral of a rational function of x over a range, in logarithms and arctangents of real arguments.

    Raises RatfitError where a factor of the denominator is of higher degree than 2, where there is a pole on the range
    at a sampled value of the parameters, where the integral diverges at infinity, and where a sign changes with the
    parameters.
    """
    above, below = (sp.Poly(part, x) for part in sp.fraction(sp.cancel(sp.together(integrand))))
    _refuse_poles(below, over)
    whole, rest = above.div(below)
    rational, remainder = ratint_ratpart(rest, below, x) if not rest.is_zero else (sp.S.Zero, sp.S.Zero)
    algebraic = whole.integrate().as_expr() + rational
    logarithms, arctangents = _transcendental(remainder, x)
    ends = [_algebraic_at(algebraic, x, end) + _logarithms_at(logarithms, end) for end in over]
    turns = [sp.Add(*(part.at(end) for part in arctangents)) for end in over]
    return ends[1] + turns[1] - ends[0] - turns[0]


def _refuse_poles(below: sp.Poly, over: tuple[sp.Expr, sp.Expr]) -> None:
    simple = below.sqf_part().as_expr()  # multiple roots would not converge
    symbols = (below.free_symbols | over[0].free_symbols | over[1].free_symbols) - set(below.gens)
    for values in sample_values(symbols, ("0", "3/7", "1")):
        low, high = (end.xreplace(values) for end in over)
        polynomial = sp.Poly(simple.xreplace(values), *below.gens)
        if any(low <= root <= high for root in polynomial.nroots(n=20, maxsteps=200) if root.is_real):
            raise RatfitError(f"the integrand has a pole on [{over[0]}, {over[1]}]")


def _transcendental(remainder: sp.Expr, x: sp.Symbol) -> tuple[list[_Logarithm], list[_Arctangent]]:
    """The parts of a fraction whose denominator has no multiple factors."""
    logarithms: list[_Logarithm] = []
    arctangents: list[_Arctangent] = []
    above, below = (sp.Poly(part, x).to_field() for part in sp.fraction(sp.together(remainder)))
    if above.is_zero:
        return logarithms, arctangents
    above, below = above.unify(below)
    _, factors = below.factor_list()
    for factor, _ in factors:
        # Partial fractions one factor at a time: the numerator over it is above/(others) modulo the factor.
        others = below.quo(factor)
        inverse = others.invert(factor) if others.degree() > 0 else sp.Poly(1 / others.LC(), x)
        top = (above * inverse).rem(factor)
        if factor.degree() == 1:
            logarithms.append(_Logarithm(sp.cancel(top.as_expr() / factor.LC()), factor))
        elif factor.degree() == 2:
            _quadratic(top, factor, x, logarithms, arctangents)
        else:
            raise RatfitError(f"the integral over {factor.as_expr()} is no formula of logarithms and arctangents")
    return logarithms, arctangents


def _quadratic(
    top: sp.Poly, factor: sp.Poly, x: sp.Symbol, logarithms: list[_Logarithm], arctangents: list[_Arctangent]
) -> None:
    """(p*x + q)/(a*x**2 + b*x + c), its denominator without or with real roots."""
    p, q = top.nth(1), top.nth(0)
    c, b, a = (factor.nth(k) for k in range(3))
    square = sp.factor(sp.expand(4 * a * c - b**2))
    rest = sp.cancel(q - p * b / (2 * a))
    if p != 0:
        logarithms.append(_Logarithm(sp.cancel(p / (2 * a)), factor))
    if rest == 0:
        return
    root = sp.sqrt(_sign(square) * square)
    if _sign(square) > 0:
        arctangents.append(_Arctangent(2 * rest / root, sp.Poly((2 * a * x + b) / root, x)))
        return
    logarithms.append(_Logarithm(rest / root, sp.Poly(2 * a * x + b - root, x)))
    logarithms.append(_Logarithm(-rest / root, sp.Poly(2 * a * x + b + root, x)))


def _algebraic_at(expression: sp.Expr, x: sp.Symbol, end: sp.Expr) -> sp.Expr:
    if not end.is_infinite:
        return expression.subs(x, end)
    above, below = (sp.Poly(part, x) for part in sp.fraction(sp.together(expression)))
    if above.degree() > below.degree():
        raise RatfitError("the integral diverges at infinity")
    return above.LC() / below.LC() if above.degree() == below.degree() else sp.S.Zero


def _logarithms_at(parts: list[_Logarithm], end: sp.Expr) -> sp.Expr:
    """Their sum; at infinity the logarithms of x itself must cancel."""
    if not end.is_infinite:
        return sp.Add(*(part.at(end) for part in parts))
    growth = sp.cancel(sp.together(sp.Add(*(part.factor * part.polynomial.degree() for part in parts))))
    if sp.simplify(growth) != 0:
        raise RatfitError("the integral diverges at infinity")
    leading = ((part.factor, part.polynomial.LC()) for part in parts)
    return sp.Add(*(factor * sp.log(_sign(lead) * lead) for factor, lead in leading))


def _sign(value: sp.Expr) -> int:
    """The sign of an expression of the parameters, the same all over their ranges."""
    signs = {sp.sign(sp.N(value.xreplace(values), 30)) for values in sample_values(value.free_symbols, INSIDE)}
    if len(signs) != 1 or not signs <= {1, -1}:
        raise RatfitError(f"the sign of {value} changes with the parameters; narrow their ranges")
    return int(signs.pop())
