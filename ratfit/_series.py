"""Taylor series of the parts of a form, at a node."""

from __future__ import annotations

from functools import lru_cache

import sympy as sp

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
        if value.has(sp.nan, sp.zoo, sp.oo):
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
