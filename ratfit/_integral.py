"""Integrals in closed form: of anything that sympy can do over a constant denominator, and of u'/u**p."""

from __future__ import annotations

from contextlib import suppress

import sympy as sp
from sympy.polys.polyerrors import BasePolynomialError

from ratfit._condition import Integral
from ratfit._deadline import TimeLimit
from ratfit._parse import RatfitError
from ratfit._problem import Problem
from ratfit._rational_integral import rational_integral
from ratfit._target import INTEGRAL_SECONDS, is_confirmed_integral, is_written, sample_values

UNFINISHED = (BasePolynomialError, NotImplementedError, ValueError, TypeError, AttributeError, RecursionError)
"""What sympy raises from inside an integral that it cannot do."""


class Divergent(RatfitError):
    """An integral that every member of a form has, and that is infinite."""


def integral_parts(problem: Problem, condition: Integral) -> tuple[tuple[sp.Expr, sp.Expr], sp.Expr]:
    """The range of an integral condition that lies on the fit's support, and what the value outside it adds."""
    low, high = condition.range(problem.domain)
    if problem.form.support is None:
        return (low, high), sp.S.Zero
    left, right = problem.form.support
    inside = (_ordered(low, left)[1], _ordered(high, right)[0])
    outside = condition.weight * problem.form.outside
    x = problem.variable
    return inside, integrated(outside, x, (low, inside[0])) + integrated(outside, x, (inside[1], high))


def _ordered(a: sp.Expr, b: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Two ends of ranges, the smaller first, for all values of the parameters tried."""
    differences = [(a - b).xreplace(values) for values in sample_values((a - b).free_symbols)]
    if all(d <= 0 for d in differences):
        return a, b
    if all(d >= 0 for d in differences):
        return b, a
    raise RatfitError(f"{a} and {b} change places within the ranges of the parameters; narrow them")


def integrated(integrand: sp.Expr, x: sp.Symbol, over: tuple[sp.Expr, sp.Expr]) -> sp.Expr:
    if integrand == 0:
        return sp.S.Zero
    value = sp.nan
    with TimeLimit(INTEGRAL_SECONDS), suppress(*UNFINISHED):
        value = sp.integrate(sp.expand(integrand), (x, *over))
        if value.is_finite is not False and not is_confirmed_integral(integrand, x, over, value):
            value = sp.nan
    if value.is_infinite:
        raise Divergent(
            f"the integral of {integrand} over [{over[0]}, {over[1]}] diverges: choose another weight, range or form"
        )
    if value.has(sp.Integral, sp.Piecewise, sp.nan, sp.oo, sp.zoo) or not is_written(value):
        raise RatfitError(
            f"the integral of {integrand} over [{over[0]}, {over[1]}] has no closed form; choose another weight"
        )
    return value


def integral_of(numerator: sp.Expr, denominator: sp.Expr, x: sp.Symbol, over: tuple[sp.Expr, sp.Expr]) -> sp.Expr:
    """The integral of a fraction: of any numerator that sympy can do over a constant, or of u'/u**p with p >= 2.

    Raises RatfitError for what is of neither kind, or diverges.
    """
    if not denominator.has(x):
        return integrated(numerator, x, over) / denominator
    primitive = _primitive(numerator, denominator, x)
    ends = [sp.limit(primitive, x, end) if end.is_infinite else primitive.subs(x, end) for end in over]
    return ends[1] - ends[0]


def closed_integral(above: sp.Expr, below: sp.Expr, x: sp.Symbol, over: tuple[sp.Expr, sp.Expr]) -> sp.Expr:
    """The integral of a fraction without unknowns: as `integral_of`, or else in partial fractions, or as sympy can."""
    try:
        return integral_of(above, below, x, over)
    except RatfitError:
        pass
    integrand, x, over = _rationalised(above / below, x, over)
    if not integrand.is_rational_function(x):
        return integrated(integrand, x, over)
    with TimeLimit(INTEGRAL_SECONDS), suppress(BasePolynomialError, NotImplementedError):
        return rational_integral(integrand, x, over)
    raise RatfitError(f"the integral of {integrand} over [{over[0]}, {over[1]}] is not found in closed form")


def _rationalised(
    integrand: sp.Expr, x: sp.Symbol, over: tuple[sp.Expr, sp.Expr]
) -> tuple[sp.Expr, sp.Symbol, tuple[sp.Expr, sp.Expr]]:
    """The integral of a function of x and sqrt(1 - x**2) on [0, 1], or of sin**2 and cos**2 on a quarter turn, in the
    tangent t: x = 1/sqrt(1 + t**2), or tan(x) = t; what does not become rational stays as it is.
    """
    t = sp.Dummy("t", positive=True)
    if over == (0, 1) and integrand.has(sp.Pow(1 - x**2, sp.S.Half), sp.Pow(1 - x**2, -sp.S.Half)):
        inner = {x: 1 / sp.sqrt(1 + t**2), sp.sqrt(1 - x**2): t / sp.sqrt(1 + t**2)}
        moved = (
            integrand.subs({sp.sqrt(1 - x**2): inner[sp.sqrt(1 - x**2)]}).subs(x, inner[x])
            * (1 + t**2) ** sp.Rational(-3, 2)
            * t
        )
    elif over == (0, sp.pi / 2) and integrand.has(sp.sin(x), sp.cos(x)):
        moved = integrand.subs({sp.sin(x): t / sp.sqrt(1 + t**2), sp.cos(x): 1 / sp.sqrt(1 + t**2)}) / (1 + t**2)
    else:
        return integrand, x, over
    moved = sp.cancel(sp.powsimp(sp.together(moved)))
    return (moved, t, (sp.S.Zero, sp.oo)) if moved.is_rational_function(t) else (integrand, x, over)


def _primitive(numerator: sp.Expr, denominator: sp.Expr, x: sp.Symbol) -> sp.Expr:
    """A primitive of u'/u**p."""
    constant, dependent = denominator.as_independent(x, as_Add=False)
    base, exponent = dependent.as_base_exp()
    if exponent.is_Integer and exponent >= 2:
        ratio = sp.cancel(numerator / sp.diff(base, x))
        if not ratio.has(x):
            return ratio * base ** (1 - exponent) / (constant * (1 - exponent))
    raise RatfitError(
        f"the integral of weight times form, {numerator}/({denominator}), is not a multiple of u'/u**p (p >= 2): "
        "choose another weight, or a form as in a*t/(b*t**2 + c)**2 with weight 1, a/(b*t**2 + c)**2 with weight t"
    )
