"""System: kernel conditions become equations in the unknown coefficients; what is linear is recognised."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import sympy as sp

from ratfit._condition import AbstractCondition, AbstractPointCondition, Derivative, Integral
from ratfit._field import is_zero
from ratfit._form import Rational, Shape
from ratfit._generators import sampled
from ratfit._integral import integral_of, integral_parts, integrated
from ratfit._parse import RatfitError
from ratfit._problem import Problem
from ratfit._series import factor_series, taylor

TINY = 1e-40
"""Places closer than this at 50 digits are compared exactly."""


@dataclass(frozen=True)
class System:
    """The equations that a problem's conditions put on the unknowns of its form.

    `demands` holds the number that each of the `conditions` asks for: those of the problem, and in a completed system
    the derivatives that were missing below them. `fraction` says that the form is a quotient of sums of unknowns times
    functions; `linear` that moreover the null space of `rows(system)` is all there is to find.
    """

    problem: Problem
    shape: Shape
    conditions: tuple[AbstractCondition, ...]
    demands: tuple[sp.Expr, ...]

    @cached_property
    def fraction(self) -> bool:
        shape = self.shape
        if shape.power is not None:
            return False
        parts = [part for pair in columns(shape)[0] for part in pair]
        return not any(part.has(*shape.unknowns) or part.has(sp.nan, sp.zoo) for part in parts)

    @cached_property
    def linear(self) -> bool:
        if not self.fraction:
            return False
        if not _constant_denominator(self):
            return not self.integrals and not missing(self)
        return all(_is_finite_at(self, lacking.at) for lacking in missing(self))

    @property
    def integrals(self) -> bool:
        """Whether a condition is an integral."""
        return any(isinstance(condition, Integral) for condition in self.conditions)


def equations(problem: Problem) -> System:
    """The system of a problem. Raises RatfitError where the target does not have what a condition asks of it."""
    taken = [s.name for s in (problem.variable, *problem.parameters)]
    shape = problem.form.shape(problem.variable, taken)
    demands = tuple(condition.demanded(problem.target) for condition in problem.conditions)
    return System(problem, shape, problem.conditions, demands)


def missing(system: System) -> list[Derivative]:
    """The derivatives below those asked for at a node, which nothing states: with them the equations are linear."""
    points = [c for c in system.conditions if isinstance(c, AbstractPointCondition)]
    found: list[Derivative] = []
    for condition in points:
        known = {c.order for c in (*points, *found) if same(c.at, condition.at)}
        for order in range(condition.order):
            if order not in known and not _vanishes_by_parity(system.problem, condition.at, order):
                found.append(Derivative(condition.at, order))
    return found


def completed(system: System) -> tuple[System, list[sp.Symbol]]:
    """The system with a symbol in place of each missing derivative, and these symbols."""
    lacking = missing(system)
    names = {s.name for s in (system.problem.variable, *system.problem.parameters, *system.shape.unknowns)}
    letter = next(letter for letter in ("s", "ss", "sss", "slope") if not any(n.startswith(letter) for n in names))
    symbols = [sp.Symbol(f"{letter}{i}", real=True) for i in range(len(lacking))]
    conditions, demands = (*system.conditions, *lacking), (*system.demands, *symbols)
    return System(system.problem, system.shape, conditions, demands), symbols


def columns(shape: Shape) -> tuple[list[tuple[sp.Expr, sp.Expr]], bool]:
    """Numerator and denominator of each unknown, when both are sums of unknowns times functions of the variable.

    A part without unknowns is a last column, the fixed 1: then the second result is True.
    """
    nothing = dict.fromkeys(shape.unknowns, 0)
    pairs = [(sp.diff(shape.numerator, u), sp.diff(shape.denominator, u)) for u in shape.unknowns]
    fixed = (shape.numerator.subs(nothing), shape.denominator.subs(nothing))
    has_fixed = any(part != 0 for part in fixed)
    return pairs + ([fixed] if has_fixed else []), has_fixed


def _is_finite_at(system: System, at: sp.Expr) -> bool:
    """Whether the form's factor is finite at a place: only there is a condition on a polynomial linear as it stands."""
    return not system.shape.factor.xreplace({system.problem.variable: at}).has(sp.zoo, sp.nan, sp.oo)


def _constant_denominator(system: System) -> bool:
    return not any(below.has(system.problem.variable) for _, below in columns(system.shape)[0])


def _vanishes_by_parity(problem: Problem, at: sp.Expr, order: int) -> bool:
    form = problem.form
    if not isinstance(form, Rational) or form.parity is None or form.of is not None or form.factor != 1 or at != 0:
        return False
    return order % 2 == (form.parity == "even") and 0 in form.exponents()[1]


@lru_cache(maxsize=1000)
def same(a: sp.Expr, b: sp.Expr) -> bool:
    """Whether two places are the same, however they are written."""
    if a == b:
        return True
    if not (a.is_Rational and b.is_Rational) and all(abs(v) < TINY for v in sampled(a - b)):
        return is_zero(a - b) is True
    return False


def rows(system: System) -> list[list[sp.Expr]]:
    """The linear route's equations: the coefficients of the columns, each row to vanish.

    At a node the rows are the Taylor coefficients of factor*P - f*Q: linear, where the quotient's are not. With a
    denominator that is constant in the variable every condition is linear as it stands.
    """
    pairs, _ = columns(system.shape)
    plain = _constant_denominator(system)
    found: list[list[sp.Expr]] = []
    for condition, demand in zip(system.conditions, system.demands, strict=True):
        if isinstance(condition, Integral):
            found.append(_integral_row(system, condition, demand, pairs))
        elif isinstance(condition, AbstractPointCondition) and plain and _is_finite_at(system, condition.at):
            found.append(_plain_row(system, condition, demand, pairs))
        elif isinstance(condition, AbstractPointCondition):
            found += _hermite_rows(system, condition, demand, pairs)
    return found


def _plain_row(
    system: System, condition: AbstractPointCondition, demand: sp.Expr, pairs: list[tuple[sp.Expr, sp.Expr]]
) -> list[sp.Expr]:
    x, factor = system.problem.variable, system.shape.factor
    weight = sp.factorial(condition.order)
    return [
        weight * taylor(factor * above, x, condition.at, condition.order)[-1] - demand * below for above, below in pairs
    ]


def _integral_row(
    system: System, condition: Integral, demand: sp.Expr, pairs: list[tuple[sp.Expr, sp.Expr]]
) -> list[sp.Expr]:
    problem = system.problem
    inside, rest = integral_parts(problem, condition)
    return [
        integrated(condition.weight * system.shape.factor * above, problem.variable, inside) - (demand - rest) * below
        for above, below in pairs
    ]


def _hermite_rows(
    system: System, condition: AbstractPointCondition, demand: sp.Expr, pairs: list[tuple[sp.Expr, sp.Expr]]
) -> list[list[sp.Expr]]:
    x, at, order = system.problem.variable, condition.at, condition.order
    data = [_known_derivative(system, condition, k) / sp.factorial(k) for k in range(order)]
    data.append(demand / sp.factorial(order))
    pole, factor = factor_series(system.shape.factor, x, at, order)
    found = []
    # A pole of the factor must be met by zeros of P: the value brings the rows below the pole's order along.
    for k in range(order + pole + 1) if order == 0 else [order + pole]:
        row = []
        for above, below in pairs:
            p, q = taylor(above, x, at, k), taylor(below, x, at, k)
            numerator = sum((factor[j] * p[k - j] for j in range(min(k, len(factor) - 1) + 1)), sp.S.Zero)
            denominator = sum((data[j] * q[k - pole - j] for j in range(min(k - pole, order) + 1)), sp.S.Zero)
            row.append(sp.expand(numerator - denominator))
        found.append(row)
    return found


def _known_derivative(system: System, condition: AbstractPointCondition, order: int) -> sp.Expr:
    """The derivative of a lower order that another condition at the same node asks for, or parity's zero."""
    for other, demand in zip(system.conditions, system.demands, strict=True):
        if isinstance(other, AbstractPointCondition) and other.order == order and same(other.at, condition.at):
            return demand
    return sp.S.Zero


def polynomial_equations(system: System) -> list[sp.Expr]:
    """The cleared equations of the polynomial route, one for each condition, as a paper would print them.

    Clearing the denominators adds roots at which numerator and denominator vanish together: verifying removes them.
    """
    return [
        sp.fraction(sp.cancel(_residual(system, condition, demand)))[0]
        for condition, demand in zip(system.conditions, system.demands, strict=True)
    ]


def _residual(system: System, condition: AbstractCondition, demand: sp.Expr) -> sp.Expr:
    x = system.problem.variable
    if isinstance(condition, Integral):
        inside, rest = integral_parts(system.problem, condition)
        numerator = condition.weight * system.shape.factor * system.shape.numerator
        return integral_of(numerator, system.shape.denominator, x, inside) + rest - demand
    assert isinstance(condition, AbstractPointCondition)
    value = sp.diff(system.shape.expression, x, condition.order).subs(x, condition.at)
    if value.has(sp.nan, sp.zoo):
        raise RatfitError(f"the form has no value at {x} = {condition.place}; move the condition or change the factor")
    return value - demand
