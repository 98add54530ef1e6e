"""What a candidate gives for a condition, in closed form."""

from __future__ import annotations

from typing import Any

import sympy as sp

from ratfit._condition import JET, AbstractCondition, AbstractPointCondition, Derivative, Equation, Integral, Limit
from ratfit._field import Field, is_zero
from ratfit._generators import sampled
from ratfit._integral import closed_integral, integral_parts
from ratfit._parse import RatfitError
from ratfit._pieces import smooth_pieces
from ratfit._rows import sides_of
from ratfit._series import LOCAL, factor_series, local_coordinate, taylor
from ratfit._system import System
from ratfit._verify.candidate import Reduced


def found_exactly(system: System, condition: AbstractCondition, candidate: Reduced) -> list[sp.Expr]:
    """The numbers that the candidate gives: one, or the residuals of an equation.

    Raises RatfitError where one is infinite or has no closed form.
    """
    x = system.problem.variable
    if isinstance(condition, Integral):
        over, rest = integral_parts(system.problem, condition)
        pieces = smooth_pieces(condition.weight * candidate.factor, x, over)
        parts = (closed_integral(w * candidate.numerator, candidate.denominator, x, range_) for w, range_ in pieces)
        return [sp.Add(*parts) + rest]
    if isinstance(condition, Limit):
        return [_limit(system, condition, candidate, side) for side in sides_of(system, condition)]
    if isinstance(condition, Equation):
        return _equation_residuals(system, condition, candidate)
    assert isinstance(condition, AbstractPointCondition)
    return [_derivative(system, condition, candidate)]


def _derivative(system: System, condition: AbstractPointCondition, candidate: Reduced) -> sp.Expr:
    x = system.problem.variable
    if system.shape.power is not None:
        return _power_derivative(candidate.expression, system.shape.power[0], x, condition)
    if not (candidate.numerator.is_polynomial(x) and candidate.denominator.is_polynomial(x)):
        value = sp.diff(candidate.expression, x, condition.order).subs(x, condition.at)
        if not value.has(sp.nan, sp.zoo, sp.oo):
            return value
    return _quotient_derivative(candidate, x, condition)


def _equation_residuals(system: System, equation: Equation, candidate: Reduced) -> list[sp.Expr]:
    orders = range(equation.height + equation.order + 1)
    jet = {JET[k]: _derivative(system, Derivative(equation.at, k), candidate) for k in orders}
    x = system.problem.variable
    return [residual.xreplace(jet) for residual in equation.residuals_there(x)]


def _limit(system: System, limit: Limit, candidate: Reduced, side: int) -> sp.Expr:
    """The limit from one side, from the lowest powers of numerator and denominator in the local coordinate."""
    x = system.problem.variable
    scale, minus = limit.scale, limit.minus
    above = scale * (candidate.factor * candidate.numerator - minus * candidate.denominator)
    parts = local_coordinate([above, candidate.denominator], x, limit.at, side)
    if not all(part.is_rational_function(LOCAL) for part in parts):
        return _searched_limit(parts[0] / parts[1], limit)
    (n1, d1), (n2, d2) = (sp.fraction(sp.together(part)) for part in parts)
    if is_zero(n1) is True:
        return sp.S.Zero
    ends = [_lowest(p) for p in (n1, d1, n2, d2)]
    order = ends[0][0] - ends[1][0] - ends[2][0] + ends[3][0]
    if order < 0:
        raise RatfitError(f"the limit at {limit.place} is infinite")
    return ends[0][1] * ends[3][1] / (ends[1][1] * ends[2][1]) if order == 0 else sp.S.Zero


def _lowest(polynomial: sp.Expr) -> tuple[int, sp.Expr]:
    """The lowest power of the local coordinate and its coefficient."""
    coefficients = sp.Poly(polynomial, LOCAL).all_coeffs()[::-1]
    return next((k, c) for k, c in enumerate(coefficients) if is_zero(c) is not True)


def _searched_limit(function: sp.Expr, limit: Limit) -> sp.Expr:
    try:
        value = sp.limit(function, LOCAL, 0, "+")
    except (NotImplementedError, ValueError, RecursionError):
        raise RatfitError(f"the limit at {limit.place} is not found") from None
    if value.has(sp.oo, sp.zoo, sp.nan, sp.Limit, sp.AccumBounds):
        raise RatfitError(f"the limit at {limit.place} is not finite")
    return value


def _power_derivative(expression: sp.Expr, base: sp.Expr, x: sp.Symbol, condition: AbstractPointCondition) -> sp.Expr:
    """The derivative of A + B*base**n; at the base's zero the exponent decides whether it is zero or infinite."""
    order = condition.order
    power = next((p for p in expression.atoms(sp.Pow) if p.base == base and not p.exp.is_Integer), None)
    place = base.subs(x, condition.at)
    if power is None or is_zero(place) is not True:
        return sp.diff(expression, x, order).subs(x, condition.at)
    amplitude = expression.xreplace({power: sp.S.Zero})
    if any(excess <= 0 for excess in sampled(power.exp - order)):
        raise RatfitError(f"{power} has no finite derivative of order {order} at {x} = {condition.at}")
    return sp.diff(amplitude, x, order).subs(x, condition.at)


def _quotient_derivative(candidate: Reduced, x: sp.Symbol, condition: AbstractPointCondition) -> sp.Expr:
    """From the Taylor series of factor, numerator and denominator, divided in the exact field.

    Differentiating the quotient itself would double its size with every order.
    """
    at, order = condition.at, condition.order
    pole, cleared = factor_series(candidate.factor, x, at, order)
    series = [cleared, *(taylor(p, x, at, order + pole) for p in (candidate.numerator, candidate.denominator))]
    field = Field([c for s in series for c in s])
    factor, above, below = ([field.encode(c) for c in s] for s in series)
    quotient = _divided(field, above, below)
    if any(quotient[:pole]):
        raise RatfitError(f"the candidate has a pole at {x} = {at}")
    # The cleared factor is factor*(x - at)**pole, so its coefficients start where the quotient's are due.
    total = field.zero
    for j in range(min(order + pole, len(factor) - 1) + 1):
        total = total + field.multiply(quotient[order + pole - j], factor[j])
    return field.decode(total) * sp.factorial(order)


def _divided(field: Field, above: list[Any], below: list[Any]) -> list[Any]:
    """The quotient of two power series; RatfitError where the denominator vanishes."""
    inverse = field.inverse(below[0])
    quotient: list[Any] = []
    for k, coefficient in enumerate(above):
        for j in range(k):
            coefficient = coefficient - field.multiply(quotient[j], below[k - j])
        quotient.append(field.multiply(coefficient, inverse))
    return quotient
