"""Tests the conditions as they were stated, never a cleared form of them; rejects what fails or has a pole."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import mpmath
import sympy as sp

from ratfit._condition import AbstractCondition, AbstractPointCondition, Integral, describe
from ratfit._field import Field, Related, is_zero
from ratfit._fit import Candidate, Checked
from ratfit._fraction import presentable, reduced
from ratfit._generators import DIGITS, sampled
from ratfit._integral import integral_of, integral_parts
from ratfit._parse import RatfitError
from ratfit._poles import endpoint, function_of, multiprecise, poles, polynomial_roots
from ratfit._series import factor_series, taylor
from ratfit._solver import Solution
from ratfit._system import System
from ratfit._target import at_values, sample_values

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
    candidate = _without_common_factors(shape.factor, solution, x)
    if candidate.denominator == 0:
        return Candidate(sp.nan, reason="the denominator vanishes identically")
    expression = presentable(candidate.factor, candidate.numerator, candidate.denominator, x, _middle(system))
    free = {s: r for s, r in solution.free.items() if _depends(expression, s)}
    idle = {s: sp.S.One for s in solution.free if s in expression.free_symbols and s not in free}
    if idle:
        return verify(system, Solution(solution.numerator.subs(idle), solution.denominator.subs(idle), free))
    checked = tuple(
        _check(system, condition, demand, candidate, expression)
        for condition, demand in zip(system.conditions, system.demands, strict=True)
    )
    reason = _failure(checked, candidate.common) or ("" if free else _pole(system, candidate.denominator))
    return Candidate(expression, free, checked, reason)


@dataclass(frozen=True)
class _Reduced:
    """factor*numerator/denominator without common factors, and what was cancelled."""

    factor: sp.Expr
    numerator: sp.Expr
    denominator: sp.Expr
    common: sp.Expr


def _without_common_factors(factor: sp.Expr, solution: Solution, x: sp.Symbol) -> _Reduced:
    """The form's factor goes into the fraction where it shares a zero with it, and stays in front where it does not."""
    above, below = sp.fraction(sp.together(factor))
    merged = reduced(solution.numerator * above, solution.denominator * below, x) if factor.has(x) else None
    if merged is not None and merged[2] != 1:
        return _Reduced(sp.S.One, *merged)
    return _Reduced(factor, *reduced(solution.numerator, solution.denominator, x))


def _depends(expression: sp.Expr, symbol: sp.Symbol) -> bool:
    """Whether an expression changes with a symbol that occurs in it; a free name may cancel unseen."""
    if symbol not in expression.free_symbols:
        return False
    others = expression.free_symbols - {symbol}
    values = sample_values({symbol}, ("1/7", "4/7"))
    for place in sample_values(others, ("2/7", "5/7")):
        found = [sp.N(expression.xreplace(place).xreplace(v), 20) for v in values]
        if not abs(found[0] - found[1]) <= sp.Float("1e-12") * (1 + abs(found[0])):
            return True
    return False


def _middle(system: System) -> sp.Expr:
    """A place inside the support: near its middle, or near its finite end."""
    low, high = system.problem.support()
    if low.is_infinite or high.is_infinite:
        return sp.S.One if low.is_infinite and high.is_infinite else low + 1 if high.is_infinite else high - 1
    return low + sp.Rational(4, 7) * (high - low)


def _check(
    system: System, condition: AbstractCondition, demand: sp.Expr, candidate: _Reduced, expression: sp.Expr
) -> Checked:
    """One condition, exactly and at 50 digits."""
    try:
        exact = is_zero(_found_exactly(system, condition, candidate) - demand)
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
    return abs(multiprecise(demand.xreplace(values)))


def _found_exactly(system: System, condition: AbstractCondition, candidate: _Reduced) -> sp.Expr:
    """The number that the candidate gives, in closed form; RatfitError where it is infinite."""
    x = system.problem.variable
    if isinstance(condition, Integral):
        over, rest = integral_parts(system.problem, condition)
        return (
            integral_of(condition.weight * candidate.factor * candidate.numerator, candidate.denominator, x, over)
            + rest
        )
    assert isinstance(condition, AbstractPointCondition)
    if system.shape.power is not None:
        return _power_derivative(candidate.numerator, system.shape.power[0], x, condition)
    return _quotient_derivative(candidate, x, condition)


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


def _quotient_derivative(candidate: _Reduced, x: sp.Symbol, condition: AbstractPointCondition) -> sp.Expr:
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
            worst = max(worst, abs(found - multiprecise(demand.xreplace(values))))
    return worst


def _numerical(
    system: System, condition: AbstractCondition, expression: sp.Expr, values: Mapping[sp.Symbol, sp.Expr]
) -> mpmath.mpf:
    x = system.problem.variable
    if isinstance(condition, Integral):
        (low, high), rest = integral_parts(system.problem, condition)
        function = function_of(condition.weight * expression, x, values)
        places = _smooth_pieces(
            condition.weight.xreplace(values), x, endpoint(low.xreplace(values)), endpoint(high.xreplace(values))
        )
        return mpmath.quad(function, places) + multiprecise(rest.xreplace(values))
    assert isinstance(condition, AbstractPointCondition)
    at = condition.at.xreplace(values)
    low, high = (end.xreplace(values) for end in system.problem.support())
    side = 1 if at == low else -1 if at == high else 0
    function = function_of(expression, x, values)
    # A free power's derivative falls off like a small power of the step: the step must be far smaller than elsewhere.
    digits = mpmath.mp.dps * (10 if system.shape.power is not None else 1)
    try:
        with mpmath.workdps(digits):
            return mpmath.diff(
                lambda distance: function(multiprecise(at) + distance), 0, condition.order, direction=side
            )
    except ZeroDivisionError:
        raise RatfitError(f"the candidate has a pole at {x} = {condition.at}") from None


def _smooth_pieces(weight: sp.Expr, x: sp.Symbol, low: mpmath.mpf, high: mpmath.mpf) -> list[mpmath.mpf]:
    """The ends of a range and the kinks of the weight between them: quadrature needs smooth pieces."""
    kinks = [r.real for a in weight.atoms(sp.Abs) if a.args[0].is_polynomial(x) for r in polynomial_roots(a.args[0], x)]
    return [low, *sorted(k for k in kinks if low < k < high), high]


def _failure(checked: tuple[Checked, ...], common: sp.Expr) -> str:
    """The conditions that do not hold, in words."""
    failed = []
    for c in checked:
        if c.holds:
            continue
        what = describe(c.condition)
        if c.holds is None:
            return f"{what}: exact and numerical results disagree, so it is undecided"
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
    """Whether the target grows beyond bounds on the way to a place inside the support, as its own poles do."""
    target = system.problem.target
    if target is None:
        return False
    low, high = (end.xreplace(values) for end in system.problem.support())
    side = 1 if at < (endpoint(low) + endpoint(high)) / 2 else -1
    function = function_of(target.expression, target.variable, values)
    try:
        near, far = (abs(function(at + side * mpmath.mpf(step))) for step in ("1e-12", "1e-6"))
    except ZeroDivisionError:
        return True
    return bool(near > 1000 * far)
