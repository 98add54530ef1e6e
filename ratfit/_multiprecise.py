"""Expressions as numbers and functions of mpmath, at its working precision of the moment."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

import mpmath
import sympy as sp

from ratfit._parse import RatfitError

ROOT_DIGITS = 400
"""Digits of an algebraic number without radicals: enough for numerical derivatives at 50 digits up to order 6."""


def endpoint(end: sp.Expr) -> mpmath.mpf:
    """An end of a range, infinite ones too, at mpmath's working precision."""
    return mpmath.mpf("inf" if end > 0 else "-inf") if end.is_infinite else multiprecise(end)


def function_of(
    expression: sp.Expr, x: sp.Symbol, values: Mapping[sp.Symbol, sp.Expr]
) -> Callable[[mpmath.mpf], mpmath.mpf]:
    """The expression at these values of its other symbols, as a function of x at mpmath's working precision."""
    symbols = sorted(expression.free_symbols - {x}, key=lambda s: s.name)
    function = compiled(expression, (x, *symbols))
    return lambda place: function(place, *(multiprecise(values[s]) for s in symbols))


@lru_cache(maxsize=100)
def compiled(expression: sp.Expr, symbols: tuple[sp.Symbol, ...]) -> Callable[..., mpmath.mpf]:
    """The expression as a function of its symbols, kept; algebraic numbers are taken to ROOT_DIGITS digits."""
    numbers = {root: root.evalf(ROOT_DIGITS) for root in expression.atoms(sp.CRootOf)}
    return sp.lambdify(symbols, expression.xreplace(numbers), "mpmath", cse=False)


def multiprecise(number: sp.Expr) -> mpmath.mpf:
    """A constant at the working precision of mpmath; RatfitError for one that is not real."""
    if number.is_Rational:
        return mpmath.mpf(int(number.p)) / int(number.q)
    value = sp.N(number, mpmath.mp.dps + 10, maxn=2 * mpmath.mp.dps + 20)
    if value.is_real is not True:
        raise RatfitError(f"{number} is not a real number")
    return mpmath.mpf(sp.Float(value, mpmath.mp.dps + 10)._mpf_)


def midpoint(ball: Any) -> mpmath.mpf:
    """The midpoint of a `flint.arb`, rounded to the working precision."""
    mantissa, exponent = ball.mid().man_exp()
    return mpmath.ldexp(mpmath.mpf(int(mantissa)), int(exponent))
