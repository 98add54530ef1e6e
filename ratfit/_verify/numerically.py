"""What a candidate gives for a condition, by numerical differentiation, quadrature and limits at 50 digits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import mpmath
import sympy as sp

from ratfit._condition import JET, AbstractCondition, AbstractPointCondition, Equation, Integral, Limit
from ratfit._generators import DIGITS
from ratfit._integral import integral_parts
from ratfit._multiprecise import endpoint, function_of, midpoint, multiprecise
from ratfit._parse import RatfitError
from ratfit._pieces import smooth_pieces
from ratfit._rows import sides_of
from ratfit._solver.nonlinear.residuals import Moment
from ratfit._system import System
from ratfit._target import sample_values

BALL_DIGITS = 20
"""Digits beyond those of a check that an integral's ball is computed with."""

DISTANCE, LIMIT_DIGITS = mpmath.mpf(10) ** -100, 1200
"""How far from its place a limit is looked at, and with how many digits: a root of the distance is still tiny, and
terms that cancel may be ten orders larger than what is left.
"""


Values = Mapping[sp.Symbol, sp.Expr]


def numerical_residual(
    system: System,
    condition: AbstractCondition,
    demand: sp.Expr,
    expression: sp.Expr,
    places: Sequence[Values] | None = None,
) -> mpmath.mpf:
    """The largest |found - demanded| over sampled parameters, or given `places` of them.

    By numerical differentiation, quadrature and limits.
    """
    symbols = set[sp.Symbol]().union(
        expression.free_symbols, demand.free_symbols, *(e.free_symbols for e in condition.expressions())
    )
    worst = mpmath.mpf(0)
    sampled = sample_values(symbols - {system.problem.variable}, ("1/7", "4/7", "9/11"))
    for values in sampled if places is None else places:
        with mpmath.workdps(DIGITS):
            for found in _numerical(system, condition, expression, values):
                if not mpmath.isfinite(found):
                    raise RatfitError("the condition has no finite value")
                worst = max(worst, abs(found - multiprecise(demand.xreplace(values))))
    return worst


def _numerical(
    system: System, condition: AbstractCondition, expression: sp.Expr, values: Mapping[sp.Symbol, sp.Expr]
) -> list[mpmath.mpf]:
    x = system.problem.variable
    if isinstance(condition, Integral):
        (low, high), rest = integral_parts(system.problem, condition)
        integrand = (condition.weight * expression).xreplace(values)
        ends = low.xreplace(values), high.xreplace(values)
        pieces = smooth_pieces(integrand, x, ends)
        return [mpmath.fsum(_integral(f, x, over) for f, over in pieces) + multiprecise(rest.xreplace(values))]
    if isinstance(condition, Limit):
        function = (expression - condition.minus) * condition.scale
        return [_limit(system, condition, function, values, side) for side in sides_of(system, condition)]
    if isinstance(condition, Equation):
        return _equation_residuals(system, condition, expression, values)
    assert isinstance(condition, AbstractPointCondition)
    return [_derivative(system, condition.at, condition.order, expression, values)]


def _integral(integrand: sp.Expr, x: sp.Symbol, over: tuple[sp.Expr, sp.Expr]) -> mpmath.mpf:
    """By ball arithmetic, which knows its error, or where it has no ball narrow enough by tanh-sinh quadrature."""
    import flint  # for integrals alone

    from ratfit._ball import ball_integral

    try:
        with flint.ctx.workdps(DIGITS + BALL_DIGITS):
            ball = ball_integral(Moment(integrand, *over), x, ())([])
            if ball.is_finite() and ball.rad() < flint.arb(10) ** -DIGITS * (1 + abs(ball.mid())):
                return midpoint(ball)
    except RatfitError:
        pass
    return mpmath.quad(function_of(integrand, x, {}), [endpoint(end) for end in over])


def _limit(system: System, limit: Limit, function: sp.Expr, values: Values, side: int) -> mpmath.mpf:
    """The function a tiny distance from the place of the limit."""
    with mpmath.workdps(LIMIT_DIGITS):
        at = limit.at.xreplace(values)
        place = (1 if at is sp.oo else -1) / DISTANCE if at.is_infinite else multiprecise(at) + side * DISTANCE
        try:
            return function_of(function, system.problem.variable, values)(place)
        except ZeroDivisionError:
            raise RatfitError(f"the limit at {limit.place} is infinite") from None


def _equation_residuals(
    system: System, equation: Equation, expression: sp.Expr, values: Mapping[sp.Symbol, sp.Expr]
) -> list[mpmath.mpf]:
    orders = range(equation.height + equation.order + 1)
    jet = [_derivative(system, equation.at, k, expression, values) for k in orders]
    at = multiprecise(equation.at.xreplace(values))
    x = system.problem.variable
    symbols = sorted(values, key=lambda s: s.name)
    given = [multiprecise(values[s]) for s in symbols]
    return [
        sp.lambdify([x, *symbols, *JET[: len(jet)]], residual, "mpmath", cse=False)(at, *given, *jet)
        for residual in equation.residuals(x)
    ]


def _derivative(
    system: System, place: sp.Expr, order: int, expression: sp.Expr, values: Mapping[sp.Symbol, sp.Expr]
) -> mpmath.mpf:
    x = system.problem.variable
    at = place.xreplace(values)
    low, high = (end.xreplace(values) for end in system.problem.support())
    side = 1 if at == low else -1 if at == high else 0
    function = function_of(expression, x, values)
    # A free power's derivative falls off like a small power of the step: the step must be far smaller than elsewhere.
    digits = mpmath.mp.dps * (10 if system.shape.power is not None else 1)
    try:
        with mpmath.workdps(digits):
            return mpmath.diff(lambda distance: function(multiprecise(at) + distance), 0, order, direction=side)
    except ZeroDivisionError:
        raise RatfitError(f"the candidate has a pole at {x} = {place}") from None
