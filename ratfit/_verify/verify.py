"""Tests the conditions as they were stated, never a cleared form of them; rejects what fails or has a pole."""

from __future__ import annotations

import mpmath
import sympy as sp

from ratfit._condition import AbstractCondition, describe
from ratfit._deadline import TimeLimit
from ratfit._field import Related, is_zero
from ratfit._fit import Candidate, Checked
from ratfit._fraction import presentable
from ratfit._generators import DIGITS, sampled
from ratfit._inverse import inverse_of
from ratfit._multiprecise import multiprecise
from ratfit._parse import RatfitError
from ratfit._poles import polynomial_roots
from ratfit._solver import Meaning, Numbers, Solution, Table, named
from ratfit._system import System
from ratfit._target import sample_values
from ratfit._verify.between import measured_between, nodes_of
from ratfit._verify.candidate import Reduced, without_common_factors
from ratfit._verify.exactly import found_exactly
from ratfit._verify.numbers import SHOWN, shortest_decimal, shown
from ratfit._verify.numerically import numerical_residual
from ratfit._verify.whole import broken

TOLERANCE = mpmath.mpf("1e-30")
"""A residual at 50 digits below this, relative to the size of the demand, counts as zero."""

CLEAR = mpmath.mpf("1e-8")
"""A residual above this, relative to the size of the demand, is no matter of lost digits."""

COMMON = mpmath.mpf("1e-25")
"""Zeros of numerator and denominator nearer than this are one, where coefficients are numbers of 60 digits."""

GUESS_SECONDS = 2.0
"""How long the proof of a guessed closed form may take."""

NUMERICAL = mpmath.mpf("1e-40")
"""The same for conditions that are kept by numbers to their last digits, and not by algebra."""


def verify(system: System, solution: Solution) -> Candidate:
    """The candidate that a solution stands for, accepted (no reason) or rejected with its reason.

    A candidate is rejected when it is complex, when its denominator vanishes identically, when a condition fails as
    it was stated (a common factor that vanishes at a node makes such), or when it has a pole on the support that
    neither the form's factor nor the target has.
    """
    shape, x = system.shape, system.problem.variable
    if solution.nature:
        return Candidate(shape.factor * solution.numerator / solution.denominator, reason=solution.nature)
    candidate = without_common_factors(shape.factor, solution, x)
    if candidate.denominator == 0:
        return Candidate(sp.nan, reason="the denominator vanishes identically")
    if solution.numbers is not None:
        return _verified_numbers(system, candidate, solution.numbers)
    expression = _presented(system, candidate).xreplace(solution.meaning)
    free = {s: r for s, r in solution.free.items() if _depends(expression, s)}
    idle = {s: sp.S.One for s in solution.free if s in expression.free_symbols and s not in free}
    if idle:
        parts = solution.numerator.subs(idle), solution.denominator.subs(idle)
        return verify(system, Solution(*parts, free, meaning=solution.meaning))
    checked = tuple(_check(system, c, d, candidate, expression, solution.meaning) for c, d in system.pairs)
    reason = _failure(checked, candidate.common) or ("" if free else broken(system, candidate.put_in(solution.meaning)))
    if roots := expression.atoms(sp.CRootOf):
        words = f"exact: {len(roots)} algebraic number(s) without radicals, shown to {SHOWN} digits"
        return Candidate(expression.xreplace({r: r.evalf(SHOWN) for r in roots}), free, checked, reason, words)
    return Candidate(expression, free, checked, reason)


def _verified_numbers(system: System, candidate: Reduced, numbers: Numbers) -> Candidate:
    """A candidate with numbers for coefficients: a guess of their closed form first, if that keeps all conditions.

    Conditions that algebra keeps whatever the numbers are checked as ever, the others to NUMERICAL.
    """
    looks = ""
    if numbers.guess is not None:
        looked = without_common_factors(system.shape.factor, numbers.guess, system.problem.variable)
        looks = f"; looks like {_presented(system, looked)} (numerical, not proved)"
        with TimeLimit(GUESS_SECONDS):
            guessed = verify(system, numbers.guess)
            if not guessed.reason:
                return guessed
    if numbers.table is not None:
        return _verified_table(system, candidate, numbers, numbers.table)
    if common := _common_root(candidate, system.problem.variable):
        reason = f"numerator and denominator vanish together at {common}: a spurious root"
        return Candidate(shown(candidate, system.problem.variable), reason=reason)
    checked = tuple(
        _check_number(system, condition, demand, candidate)
        if condition in numbers.conditions
        else _check(system, condition, demand, candidate, candidate.expression, {})
        for condition, demand in system.pairs
    )
    expression = shown(candidate, system.problem.variable)
    reason = _failure(checked, candidate.common) or broken(system, candidate)
    return Candidate(expression, {}, checked, reason, numbers.certificate + looks)


def _verified_table(system: System, candidate: Reduced, numbers: Numbers, table: Table) -> Candidate:
    """A candidate whose coefficients are interpolated: conditions must hold at nodes, and are measured between."""
    for place, there in nodes_of(table, candidate):
        at_node = tuple(_check_number(system, c, d, there, [place]) for c, d in system.pairs)
        if reason := _failure(at_node, sp.S.One):
            return Candidate(sp.nan, {}, at_node, reason)
    checked = tuple(measured_between(system, c, d, candidate, table) for c, d in system.pairs)
    worst = max(c.residual or 0.0 for c in checked)
    words = f"{numbers.certificate}, where the conditions hold to {worst:.2g}"
    whole = candidate.numerator / candidate.denominator
    expression = candidate.factor * whole.xreplace({r: shortest_decimal(r) for r in whole.atoms(sp.Rational)})
    if not all(c.holds for c in checked):
        reason = f"{words}: too little; narrow the ranges of the parameters, or take the table"
        return Candidate(expression, {}, checked, reason, words, table)
    return Candidate(expression, {}, checked, broken(system, candidate), words, table)


def _common_root(candidate: Reduced, x: sp.Symbol) -> str:
    """Where numerator and denominator all but share a zero, as roots of the cleared equations do, in words."""
    if not (candidate.numerator.is_polynomial(x) and candidate.denominator.is_polynomial(x)):
        return ""
    with mpmath.workdps(DIGITS):
        above, below = (polynomial_roots(part, x) for part in (candidate.numerator, candidate.denominator))
        near = [b for a in above for b in below if abs(a - b) < COMMON * (1 + abs(a))]
    return f"{x} = {mpmath.nstr(near[0].real if abs(near[0].imag) < COMMON else near[0], 8)}" if near else ""


def _presented(system: System, candidate: Reduced) -> sp.Expr:
    parts = candidate.factor, candidate.numerator, candidate.denominator
    return presentable(*parts, system.problem.variable, _middle(system))


def _check_number(
    system: System,
    condition: AbstractCondition,
    demand: sp.Expr,
    candidate: Reduced,
    places: list[dict[sp.Symbol, sp.Expr]] | None = None,
) -> Checked:
    try:
        residual = numerical_residual(system, condition, demand, candidate.expression, places)
    except RatfitError:
        return Checked(condition, demand, False, None)
    return Checked(condition, demand, bool(residual < NUMERICAL * (1 + _size(demand))), float(residual))


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
    system: System,
    condition: AbstractCondition,
    demand: sp.Expr,
    candidate: Reduced,
    expression: sp.Expr,
    meaning: Meaning,
) -> Checked:
    """One condition, exactly in the candidate's names and at 50 digits in the expression, where they are put in."""
    try:
        residual = numerical_residual(system, condition, demand, expression)
        size = 1 + _size(demand)
        if residual > CLEAR * size:
            return Checked(condition, demand, False, float(residual))  # no algebra makes that zero
        exact = _all_equal(found_exactly(system, condition, candidate), *named([demand], meaning))
    except Related:
        return Checked(condition, demand, None, None)
    except RatfitError:
        return Checked(condition, demand, False, None)
    numerically = residual < TOLERANCE * size
    return Checked(condition, demand, exact if exact == numerically else None, float(residual))


def _all_equal(values: list[sp.Expr], demand: sp.Expr) -> bool | None:
    found = [_equal(value, demand) for value in values]
    return False if False in found else None if None in found else True


def _equal(value: sp.Expr, demand: sp.Expr) -> bool | None:
    """Whether two numbers are the same; exp(a) = 2 by a = log(2), where the exponentials themselves are too much."""
    equal = is_zero(value - demand)
    if equal is True or not value.has(sp.exp, sp.log, sp.tanh, sp.Pow):
        return equal
    ways = [inverse_of(value, demand)]
    if min(sampled(value)) > 0 and min(sampled(demand)) > 0:
        ways.append(sp.expand_log(sp.log(value), force=True) - sp.log(demand))
    return True if any(is_zero(way) for way in ways if way is not None) else equal


def _size(demand: sp.Expr) -> mpmath.mpf:
    values = sample_values(demand.free_symbols, ("1/7",))[0]
    return abs(multiprecise(demand.xreplace(values)))


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
