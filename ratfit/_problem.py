"""Problem: target, kernel conditions, form and parameters together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field, replace
from itertools import combinations

import sympy as sp

from ratfit._condition import AbstractCondition, AbstractPointCondition, Equation, Integral, Limit
from ratfit._form import AbstractForm
from ratfit._parse import RatfitError, check_name, nearest
from ratfit._target import INSIDE, Exact, Parameter, Target, at_values, check_domain, exact, sample_values

MAX_CONDITIONS = 200


@dataclass(frozen=True)
class Reference:
    """A function to measure against where the target does not say it all: a material, a corrected formula.

    `parameters` gives values to parameters of the problem, and to symbols that occur in this reference alone.
    """

    name: str
    expression: sp.Expr
    source: str = ""
    parameters: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)


@dataclass(frozen=True)
class Problem:
    """What must be found: a fit of this form that keeps these conditions.

    Arguments: `conditions`; `form`; `target`, or in its place `variable` and `domain` when every condition states
    `equals`; `parameters`, symbol -> range (those of the expressions are found by themselves); `choice`, recorded
    values for free coefficients, by name; `references`; `name`. Raises RatfitError for what does not fit together: a
    symbol that nobody declared, a condition outside the domain, a missing `equals`.
    """

    _: KW_ONLY
    conditions: tuple[AbstractCondition, ...]
    form: AbstractForm
    target: Target | None = None
    variable: sp.Symbol = None  # set from the target
    domain: tuple[sp.Expr, sp.Expr] = None  # type: ignore[assignment]  # set from the target
    parameters: Mapping[Parameter, tuple[sp.Expr, sp.Expr]] = field(default_factory=dict)
    choice: Mapping[str, sp.Expr] = field(default_factory=dict)
    references: tuple[Reference, ...] = ()
    name: str = "problem"

    def __post_init__(self) -> None:
        if self.target is not None:
            object.__setattr__(self, "variable", self.target.variable)
            object.__setattr__(self, "domain", self.target.domain)
        if self.variable is None or self.domain is None:
            raise RatfitError("a problem without a target needs a variable and a domain")
        object.__setattr__(self, "domain", check_domain(self.domain))
        if isinstance(self.conditions, AbstractCondition) or not all(
            isinstance(c, AbstractCondition) for c in self.conditions
        ):
            raise RatfitError("conditions: give a list of Value, Derivative, Limit, Integral and Equation")
        if not isinstance(self.form, AbstractForm):
            raise RatfitError(f"form: give a Rational, Form or Power, not {self.form!r}; as in Rational(2, 1)")
        object.__setattr__(self, "conditions", tuple(self.conditions))
        object.__setattr__(self, "choice", {n: exact(v, f"choice {n}") for n, v in self.choice.items()})
        object.__setattr__(self, "references", tuple(self.references))
        object.__setattr__(self, "parameters", _parameters(self))
        _check(self)

    def with_choice(self, choice: Mapping[str, Exact]) -> Problem:
        """The same problem with these choices added to, or put in place of, the recorded ones."""
        return replace(self, choice={**self.choice, **choice})

    def with_conditions(self, conditions: tuple[AbstractCondition, ...]) -> Problem:
        """The same problem with other conditions."""
        return replace(self, conditions=conditions)

    def support(self) -> tuple[sp.Expr, sp.Expr]:
        """Where the fit lives: the form's support, or else the domain."""
        return self.form.support or self.domain


def _expressions(problem: Problem) -> list[tuple[str, sp.Expr]]:
    """Every expression of the problem with the words for where it stands."""
    found = [("domain", end) for end in problem.domain]
    if problem.target is not None:
        found.append(("target", problem.target.expression))
    for number, condition in enumerate(problem.conditions, 1):
        found += [(f"condition {number} ({condition.kind})", e) for e in condition.expressions()]
    return found + [("form", e) for e in problem.form.expressions()]


def _parameters(problem: Problem) -> dict[Parameter, tuple[sp.Expr, sp.Expr]]:
    for symbol in problem.parameters:
        if not isinstance(symbol, Parameter):
            raise RatfitError(
                f"parameters: make {symbol} by rf.parameter({str(symbol)!r}, low, high), here and in formulas"
            )
    found = dict.fromkeys(problem.parameters)
    for _, expression in _expressions(problem):
        ordered = sorted((s for s in expression.free_symbols if isinstance(s, Parameter)), key=lambda s: s.name)
        found.update(dict.fromkeys(ordered))
    return {p: (p.low, p.high) for p in found}


def _check(problem: Problem) -> None:
    if not 1 <= len(problem.conditions) <= MAX_CONDITIONS:
        raise RatfitError(f"{problem.name}: 1 to {MAX_CONDITIONS} conditions are needed, not {len(problem.conditions)}")
    _check_names(problem)
    unknowns = set(problem.form.named)
    known = set(problem.parameters) | {problem.variable}
    for where, expression in _expressions(problem):
        allowed = known | unknowns if where == "form" else known
        for symbol in sorted(expression.free_symbols - allowed, key=str):
            if symbol.name in {s.name for s in known}:
                raise RatfitError(f"{where}: {symbol} is another symbol than the declared one; use the same object")
            hint = nearest(symbol.name, [s.name for s in known])
            raise RatfitError(f"{where}: nobody declared {symbol}{hint}; make it a parameter with its range")
    _check_support(problem)
    _check_nodes(problem)
    for condition in problem.conditions:
        condition.check(problem.domain)
        if problem.target is None and condition.needs_target:
            raise RatfitError(f"{condition.kind} at {condition.place}: there is no target, so it must state equals")
    for reference in problem.references:
        for symbol in sorted(reference.expression.free_symbols - known - set(reference.parameters), key=str):
            raise RatfitError(
                f"reference {reference.name}: nobody declared {symbol}; give it a value in its parameters"
            )
    problem.form.shape(problem.variable, [s.name for s in known])


def _check_support(problem: Problem) -> None:
    """A support is a range inside the domain, and conditions at a place ask for it there."""
    if problem.form.support is None:
        return
    (low, high), (left, right) = problem.domain, problem.form.support
    for values in sample_values(set().union(*(e.free_symbols for e in (low, high, left, right)))):
        a, b, c, d = (e.xreplace(values) for e in (low, left, right, high))
        if not (a <= b and b < c and c <= d):
            raise RatfitError(
                f"form: the support [{left}, {right}] is empty or not inside the domain{at_values(values)}"
            )
    for condition in problem.conditions:
        if not isinstance(condition, Integral):
            condition.check((left, right), "support")


def _check_nodes(problem: Problem) -> None:
    """Places must not hold the variable, and must not meet inside the ranges of the parameters."""
    points = [c for c in problem.conditions if isinstance(c, (AbstractPointCondition, Equation, Limit))]
    for condition in problem.conditions:
        fixed = [getattr(condition, "at", None), condition.equals, *(getattr(condition, "over", None) or ())]
        if any(e is not None and e.has(problem.variable) for e in fixed):
            raise RatfitError(f"{condition.kind}: place and equals must not hold the variable {problem.variable}")
    for a, b in combinations(points, 2):
        if a.at.is_infinite or b.at.is_infinite:
            continue
        distance = a.at - b.at
        signs = [sp.sign(distance.xreplace(values)) for values in sample_values(distance.free_symbols, INSIDE)]
        if distance.free_symbols and len(set(signs)) > 1:
            raise RatfitError(f"the places {a.at} and {b.at} meet inside the ranges of the parameters; narrow them")


def _check_names(problem: Problem) -> None:
    names = [problem.variable.name, *(p.name for p in problem.parameters), *problem.form.names]
    for name in names:
        check_name(name, "name")
    for name in names:
        if names.count(name) > 1:
            raise RatfitError(
                f"the name {name} stands for two of variable, parameter, unknown and exponent; rename one"
            )
