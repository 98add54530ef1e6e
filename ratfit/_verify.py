"""Tests the conditions as they were stated, never a cleared form of them; rejects what fails or has a pole."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import mpmath
import sympy as sp

from ratfit._condition import AbstractCondition, AbstractPointCondition, Integral, describe
from ratfit._field import Field, Related, is_zero
from ratfit._fit import Candidate, Checked
from ratfit._fraction import presentable, reduced
from ratfit._generators import DIGITS
from ratfit._parse import RatfitError
from ratfit._poles import compiled, multiprecise, poles
from ratfit._solver import Solution
from ratfit._system import System, factor_series, integral_parts, primitive_of, taylor
from ratfit._target import Parameter, at_values, sample_values

TOLERANCE = mpmath.mpf("1e-30")
"""A residual at 50 digits below this, relative to the size of the demand, counts as zero."""


def verify(system: System, solution: Solution) -> Candidate:
    """The candidate that a solution stands for, accepted (no reason) or rejected with its reason.

    A candidate is rejected when it is complex, when its denominator vanishes identically, when a condition fails as
    it was stated (a common factor that vanishes at a node makes such), or when it has a pole on the support that
    neither the form's factor nor the target has.
    """
    shape, x = system.shape, system.problem.variable
    if solution.nature:
        return Candidate(shape.factor * solution.numerator / solution.denominator, reason=solution.nature)
    numerator, denominator, common = reduced(solution.numerator, solution.denominator, x)
    if denominator == 0:
        return Candidate(sp.nan, reason="the denominator vanishes identically")
    expression = presentable(shape.factor, numerator, denominator, x, _middle(system))
    free = {s: r for s, r in solution.free.items() if s in expression.free_symbols}
    checked = tuple(
        _check(system, condition, demand, numerator, denominator, expression)
        for condition, demand in zip(system.problem.conditions, system.demands, strict=True)
    )
    reason = _failure(checked, common) or ("" if free else _pole(system, denominator))
    return Candidate(expression, free, checked, reason)


def _middle(system: System) -> sp.Expr:
    """A place inside the support: near its middle, or near its finite end."""
    low, high = system.problem.support()
    if low.is_infinite or high.is_infinite:
        return sp.S.One if low.is_infinite and high.is_infinite else low + 1 if high.is_infinite else high - 1
    return low + sp.Rational(4, 7) * (high - low)


def _check(
    system: System,
    condition: AbstractCondition,
    demand: sp.Expr,
    numerator: sp.Expr,
    denominator: sp.Expr,
    expression: sp.Expr,
) -> Checked:
    """One condition, exactly and at 50 digits."""
    try:
        exact = is_zero(_found_exactly(system, condition, numerator, denominator) - demand)
        residual = _numerical_residual(system, condition, demand, expression)
    except Related:
        return Checked(condition, demand, None, None)
    except RatfitError:
        return Checked(condition, demand, False, None)
    numerically = residual < TOLERANCE * (1 + _size(demand))
    holds = exact if exact == numerically else None
    return Checked(condition, demand, holds, float(residual))


def _size(demand: sp.Expr) -> mpmath.mpf:
    values = sample_values(demand.free_symbols, ("1/7",))[0]
    return abs(multiprecise(demand.subs(values)))


def _found_exactly(system: System, condition: AbstractCondition, numerator: sp.Expr, denominator: sp.Expr) -> sp.Expr:
    """The number that the candidate gives, in closed form; RatfitError where it is infinite."""
    if isinstance(condition, Integral):
        (low, high), rest = integral_parts(system.problem, condition)
        x = system.problem.variable
        primitive = primitive_of(condition.weight * system.shape.factor * numerator, denominator, x)
        return primitive.subs(x, high) - primitive.subs(x, low) + rest
    assert isinstance(condition, AbstractPointCondition)
    if system.shape.power is not None:
        return _power_derivative(numerator, system.problem.variable, condition)
    return _quotient_derivative(system, condition, numerator, denominator)


def _power_derivative(expression: sp.Expr, x: sp.Symbol, condition: AbstractPointCondition) -> sp.Expr:
    """A free exponent n > 2 is written as 2 plus something positive: then sympy knows that 0**(n - 2) is 0."""
    exponents = [s for s in expression.free_symbols if isinstance(s, Parameter) and s.high == sp.oo]
    excess = {s: sp.Dummy(positive=True) for s in exponents}
    raised = expression.subs({s: s.low + e for s, e in excess.items()})
    derivative = sp.powsimp(sp.expand(sp.diff(raised, x, condition.order)), combine="exp")
    return derivative.subs(x, condition.at).subs({e: s - s.low for s, e in excess.items()})


def _quotient_derivative(
    system: System, condition: AbstractPointCondition, numerator: sp.Expr, denominator: sp.Expr
) -> sp.Expr:
    """From the Taylor series of factor, numerator and denominator, divided in the exact field.

    Differentiating the quotient itself would double its size with every order.
    """
    x, at, order = system.problem.variable, condition.at, condition.order
    pole, cleared = factor_series(system.shape.factor, x, at, order)
    series = [cleared, *(taylor(p, x, at, order + pole) for p in (numerator, denominator))]
    field = Field([c for s in series for c in s])
    factor, above, below = ([field.encode(c) for c in s] for s in series)
    quotient = _divided(field, above, below)
    if any(quotient[:pole]):
        raise RatfitError(f"the candidate has a pole at {x} = {at}")
    shifted = quotient[pole:]
    total = field.zero
    for j in range(min(order, len(factor) - 1) + 1):
        total = total + field.multiply(shifted[order - j], factor[j])
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


def _numerical_residual(
    system: System, condition: AbstractCondition, demand: sp.Expr, expression: sp.Expr
) -> mpmath.mpf:
    """The largest |found - demanded| over sampled parameters, by numerical differentiation or quadrature."""
    symbols = set().union(
        expression.free_symbols, demand.free_symbols, *(e.free_symbols for e in condition.expressions())
    )
    worst = mpmath.mpf(0)
    for values in sample_values(symbols - {system.problem.variable}, ("1/7", "4/7", "9/11")):
        with mpmath.workdps(DIGITS):
            found = _numerical(system, condition, expression, values)
            if not mpmath.isfinite(found):
                raise RatfitError("the condition has no finite value")
            worst = max(worst, abs(found - multiprecise(demand.subs(values))))
    return worst


def _numerical(
    system: System, condition: AbstractCondition, expression: sp.Expr, values: Mapping[sp.Symbol, sp.Expr]
) -> mpmath.mpf:
    x = system.problem.variable
    if isinstance(condition, Integral):
        (low, high), rest = integral_parts(system.problem, condition)
        function = compiled((condition.weight * expression).subs(values), x)
        ends = [multiprecise(end.subs(values)) for end in (low, high)]
        return mpmath.quad(function, ends) + multiprecise(rest.subs(values))
    assert isinstance(condition, AbstractPointCondition)
    at = condition.at.subs(values)
    low, high = (end.subs(values) for end in system.problem.support())
    side = 1 if at == low else -1 if at == high else 0
    function = compiled(expression.subs(values), x)
    try:
        return mpmath.diff(lambda distance: function(multiprecise(at) + distance), 0, condition.order, direction=side)
    except ZeroDivisionError:
        raise RatfitError(f"the candidate has a pole at {x} = {condition.at}") from None


def _failure(checked: tuple[Checked, ...], common: sp.Expr) -> str:
    """The conditions that do not hold, in words."""
    failed = []
    for c in checked:
        if c.holds:
            continue
        what = describe(c.condition)
        if c.holds is None:
            return f"{what}: exact and numerical results disagree; it is not accepted undecided"
        found = f"off by {c.residual:.3g}" if c.residual is not None else "no finite value there"
        failed.append(f"{what} should be {c.demand} ({found})")
    if not failed:
        return ""
    cancelled = f"the factor {common} cancels, then " if common != 1 else ""
    return f"{cancelled}{'; '.join(failed)}"


def _pole(system: System, denominator: sp.Expr) -> str:
    """The first pole on the closed support that the target does not have, in words."""
    x = system.problem.variable
    for root, values in poles(denominator, x, system.problem.support()):
        if not _target_infinite(system, values, root):
            return f"it has a pole at {x} = {mpmath.nstr(root, 8)}{at_values(values)}"
    return ""


def _target_infinite(system: System, values: Mapping[sp.Symbol, sp.Expr], at: mpmath.mpf) -> bool:
    target = system.problem.target
    if target is None:
        return False
    place = sp.nsimplify(at, rational=True, tolerance=1e-30)
    value = target.expression.subs(values).subs(target.variable, place)
    return bool(value.has(sp.zoo, sp.oo))
