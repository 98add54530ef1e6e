"""System: kernel conditions become equations in the unknown coefficients; what is linear is recognised."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache, partial

import sympy as sp

from ratfit._condition import JET, AbstractCondition, AbstractPointCondition, Equation, Integral, Limit
from ratfit._form import Rational, Shape
from ratfit._integral import integral_of, integral_parts
from ratfit._jets import Completion, completion
from ratfit._parse import RatfitError
from ratfit._problem import Problem

Demanded = tuple[AbstractCondition, sp.Expr]


@dataclass(frozen=True)
class System:
    """The equations that a problem's conditions put on the unknowns of its form.

    `demands` holds the number that each of the `conditions` asks for: those of the problem, and in a completed system
    the derivatives that were missing below them. `fraction` says that the form is a quotient of sums of unknowns times
    functions.
    """

    problem: Problem
    shape: Shape
    conditions: tuple[AbstractCondition, ...]
    demands: tuple[sp.Expr, ...]

    @property
    def pairs(self) -> list[Demanded]:
        """The conditions with their demands."""
        return list(zip(self.conditions, self.demands, strict=True))

    @cached_property
    def fraction(self) -> bool:
        shape = self.shape
        if shape.power is not None:
            return False
        parts = [part for pair in columns(shape)[0] for part in pair]
        return not any(part.has(*shape.unknowns) or part.has(sp.nan, sp.zoo) for part in parts)

    @cached_property
    def plain(self) -> bool:
        """Whether the denominator is constant in the variable: then every condition is linear as it stands."""
        return not any(below.has(self.problem.variable) for _, below in columns(self.shape)[0])

    @cached_property
    def fixed_denominator(self) -> bool:
        """Whether no unknown stands in a denominator that holds the variable: then integrals are linear."""
        pairs, has_fixed = columns(self.shape)
        return self.plain or (has_fixed and all(below == 0 for _, below in pairs[:-1]))

    @property
    def integrals(self) -> bool:
        """Whether a condition is an integral that is not linear in the unknowns."""
        return not self.fixed_denominator and any(isinstance(c, Integral) for c in self.conditions)

    @cached_property
    def completion(self) -> Completion:
        """The derivatives that the rows need beside those stated: given by equations, or left open as symbols."""
        problem = self.problem
        points = [(c, d) for c, d in self.pairs if isinstance(c, AbstractPointCondition)]
        odes = [c for c in self.conditions if isinstance(c, Equation) and not is_plain_equation(self, c)]
        taken = {s.name for s in (problem.variable, *problem.parameters, *self.shape.unknowns)}
        needless = partial(_is_plain_at, self)
        return completion(problem.variable, points, odes, taken, needless, partial(vanishes_by_parity, problem))


def equations(problem: Problem) -> System:
    """The system of a problem. Raises RatfitError where the target does not have what a condition asks of it."""
    taken = [s.name for s in (problem.variable, *problem.parameters)]
    shape = problem.form.shape(problem.variable, taken)
    demands = tuple(condition.demanded(problem.target) for condition in problem.conditions)
    return System(problem, shape, problem.conditions, demands)


def completed(system: System) -> System:
    """The system with derivatives in place of differential equations, and a symbol for each missing derivative."""
    kept = [(c, d) for c, d in system.pairs if not isinstance(c, Equation) or is_plain_equation(system, c)]
    return of_pairs(system, [*kept, *system.completion.facts])


def of_pairs(system: System, pairs: list[Demanded]) -> System:
    """The system with other conditions."""
    return replace(system, conditions=tuple(c for c, _ in pairs), demands=tuple(d for _, d in pairs))


@lru_cache(maxsize=100)
def columns(shape: Shape) -> tuple[list[tuple[sp.Expr, sp.Expr]], bool]:
    """Numerator and denominator of each unknown, when both are sums of unknowns times functions of the variable.

    A part without unknowns is a last column, the fixed 1: then the second result is True.
    """
    nothing = dict.fromkeys(shape.unknowns, 0)
    pairs = [(sp.diff(shape.numerator, u), sp.diff(shape.denominator, u)) for u in shape.unknowns]
    fixed = (shape.numerator.subs(nothing), shape.denominator.subs(nothing))
    has_fixed = any(part != 0 for part in fixed)
    return pairs + ([fixed] if has_fixed else []), has_fixed


def _is_plain_at(system: System, at: sp.Expr) -> bool:
    return system.plain and is_finite_at(system, at)


def is_finite_at(system: System, at: sp.Expr) -> bool:
    """Whether the form's factor is finite at a place: only there is a condition on a polynomial linear as it stands."""
    return not system.shape.factor.xreplace({system.problem.variable: at}).has(sp.zoo, sp.nan, sp.oo)


def is_plain_equation(system: System, equation: Equation) -> bool:
    """Whether a differential equation is linear in the unknowns as it stands: itself linear, of a polynomial."""
    slopes = [sp.diff(equation.residual, y) for y in JET[: equation.height + 1]]
    linear = system.fraction and not any(slope.has(*JET) for slope in slopes)
    return linear and system.plain and is_finite_at(system, equation.at)


def vanishes_by_parity(problem: Problem, at: sp.Expr, order: int) -> bool:
    """Whether the form's parity makes a derivative zero."""
    form = problem.form
    if not isinstance(form, Rational) or form.parity is None or form.of is not None or form.factor != 1 or at != 0:
        return False
    return order % 2 == (form.parity == "even") and 0 in form.exponents()[1]


def polynomial_equations(system: System) -> list[sp.Expr]:
    """The cleared equations of the polynomial route, one for each condition, as a paper would print them.

    Clearing the denominators adds roots at which numerator and denominator vanish together: verifying removes them.
    """
    return [
        sp.fraction(sp.cancel(residual))[0] for c, demand in system.pairs for residual in residuals(system, c, demand)
    ]


def residuals(system: System, condition: AbstractCondition, demand: sp.Expr) -> list[sp.Expr]:
    """What a condition wants to vanish, as expressions of the unknowns: one, or one for each order of an equation.

    Raises RatfitError for a limit, and for an integral that has no closed form here.
    """
    x = system.problem.variable
    if isinstance(condition, Integral):
        inside, rest = integral_parts(system.problem, condition)
        numerator = condition.weight * system.shape.factor * system.shape.numerator
        return [integral_of(numerator, system.shape.denominator, x, inside) + rest - demand]
    if isinstance(condition, Limit):
        raise RatfitError(f"the limit at {condition.place} is not polynomial in the unknowns of this form")
    if isinstance(condition, Equation):
        jet = [_derivative(system, condition.at, k) for k in range(condition.height + condition.order + 1)]
        put_in = dict(zip(JET, jet, strict=False))
        return [residual.xreplace(put_in) for residual in condition.residuals_there(x)]
    assert isinstance(condition, AbstractPointCondition)
    return [_derivative(system, condition.at, condition.order) - demand]


def _derivative(system: System, at: sp.Expr, order: int) -> sp.Expr:
    x = system.problem.variable
    value = sp.diff(system.shape.expression, x, order).subs(x, at)
    # A free power of zero is zero where its exponent is positive: whether it is, verifying tells.
    value = value.xreplace({p: sp.S.Zero for p in value.atoms(sp.Pow) if p.base == 0 and not p.exp.is_number})
    if value.has(sp.nan, sp.zoo):
        raise RatfitError(f"the form has no value at {x} = {at}; move the condition or change the factor")
    return value
