"""Coefficients that are numbers: how they are shown."""

from __future__ import annotations

from decimal import Decimal, localcontext

import sympy as sp

from ratfit._verify.candidate import Reduced

SHOWN = 45
"""Digits of a coefficient that is shown; more are known."""

NOTHING = sp.Rational(1, 10**SHOWN)
"""A coefficient smaller than this, relative to the largest, is zero."""


def shown(candidate: Reduced, x: sp.Symbol) -> sp.Expr:
    """factor*numerator/denominator with decimal coefficients, the denominator's lowest put to 1."""
    above, below = candidate.numerator, candidate.denominator
    if not (above.is_polynomial(x) and below.is_polynomial(x)):
        return candidate.factor * decimal(above / below)
    top, bottom = (_numbers(sp.Poly(part, x)) for part in (above, below))
    size = max(map(abs, bottom))
    scale = next(c for c in bottom if abs(c) > NOTHING * size)
    return candidate.factor * _polynomial(top, scale, x) / _polynomial(bottom, scale, x)


def _numbers(polynomial: sp.Poly) -> list[sp.Expr]:
    """The coefficients as decimals with a few digits to spare, the lowest first."""
    return [sp.N(c, SHOWN + 15) for c in polynomial.all_coeffs()[::-1]]


def _polynomial(coefficients: list[sp.Expr], scale: sp.Expr, x: sp.Symbol) -> sp.Expr:
    size = max(map(abs, coefficients))
    terms = [(_short(c / scale), k) for k, c in enumerate(coefficients) if abs(c) > NOTHING * size]
    return sp.Add(*(c * x**k for c, k in terms))


def _short(number: sp.Expr) -> sp.Expr:
    """A decimal; a whole number that it equals to the last digit shown."""
    whole = sp.Integer(round(number))
    return whole if abs(number - whole) < NOTHING * (1 + abs(whole)) else sp.Float(number, SHOWN)


def shortest_decimal(number: sp.Rational) -> sp.Expr:
    """A rational with a power of 10 below as the decimal that it is; others, and short ones, as they are."""
    if number.q < 10**5 or 10 ** len(str(number.q)) % number.q:
        return number
    with localcontext(prec=200):
        digits = len((Decimal(int(number.p)) / Decimal(int(number.q))).as_tuple().digits)
    return sp.Float(number, digits)


def decimal(expression: sp.Expr) -> sp.Expr:
    """The expression with its long rationals as decimals, zero where they all but vanish; short ones stay."""
    long = [r for r in expression.atoms(sp.Rational) if len(str(r.p)) > 15 or len(str(r.q)) > 15]
    return expression.xreplace({r: _short(sp.N(r, SHOWN + 15)) for r in long})
