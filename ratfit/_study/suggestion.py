"""A problem made of the facts, and tried out: what is suggested works."""

from __future__ import annotations

import time
from collections.abc import Iterator

import sympy as sp

from ratfit._condition import AbstractCondition, AbstractPointCondition, Integral, Limit
from ratfit._derive import derive
from ratfit._form import Rational
from ratfit._parse import RatfitError
from ratfit._problem import Problem
from ratfit._study.fact import SYMBOLIC, Fact, Study

MOST = 4
"""Conditions of a suggestion: more belong to a person who knows which matter."""

TRIAL_SECONDS = 2.0
ALL_TRIALS_SECONDS = 6.0

# Kinds of facts in the order in which their conditions are worth keeping; slopes after the values that they stand on.
_WORTH = ("value", "pole", "asymptote", "limit", "maximum", "minimum", "slope", "zero", "curvature", "inflection")


def suggested(study: Study, seconds: float) -> Problem | None:
    """The problem with the most of the best conditions that fractions of the right size keep; None without one."""
    end = time.monotonic() + min(seconds, ALL_TRIALS_SECONDS)
    best = chosen(study)
    for count in range(len(best), 0, -1):
        for form in _forms(best[:count], study.target.variable):
            left = end - time.monotonic()
            if left <= 0.05:
                return None
            problem = _problem(study, best[:count], form)
            if problem is not None and _works(problem, min(TRIAL_SECONDS, left)):
                return problem
    return None


def chosen(study: Study) -> tuple[AbstractCondition, ...]:
    """At most four conditions that are exact, the most telling first."""
    exact = [f for f in study.facts if f.condition is not None and f.found == SYMBOLIC and _fits(f, study)]
    exact.sort(key=lambda f: _WORTH.index(f.kind))
    found: dict[tuple, AbstractCondition] = {}
    for fact in exact:
        assert fact.condition is not None
        found.setdefault(_key(fact.condition), fact.condition)
    ordered = list(found.values())
    return tuple(_complete(ordered)[:MOST])


def _fits(fact: Fact, study: Study) -> bool:
    """Whether a fact is one that fractions of low degree are asked to keep: no far-off limit, no high order."""
    if fact.kind not in _WORTH or fact.place is None:
        return False
    if fact.place.is_infinite:
        # A fraction has one limit at both infinities: that at oo speaks for both.
        return fact.place in study.target.domain and (fact.place is sp.oo or sp.oo not in study.target.domain)
    return fact.kind != "curvature" or not any(f.place in study.target.domain for f in study.of("limit", "asymptote"))


def _key(condition: AbstractCondition) -> tuple:
    if isinstance(condition, AbstractPointCondition):
        return ("point", condition.at, condition.order)
    return (condition.kind, condition.place)


def _complete(conditions: list[AbstractCondition]) -> list[AbstractCondition]:
    """Only derivatives that stand on all lower ones at their place: these make the equations linear."""
    orders: dict[sp.Expr, int] = {}
    kept: list[AbstractCondition] = []
    for condition in conditions:
        if isinstance(condition, AbstractPointCondition):
            if condition.order != orders.get(condition.at, 0):
                continue
            orders[condition.at] = condition.order + 1
        kept.append(condition)
    return kept


def _forms(conditions: tuple[AbstractCondition, ...], x: sp.Symbol) -> Iterator[Rational]:
    """Fractions with as many coefficients as conditions, or one more, evenly split first; all that can do at all."""
    far = next((c for c in conditions if isinstance(c, Limit) and c.at.is_infinite), None)
    poles = sum(_weight(c, x) - 1 for c in conditions if isinstance(c, Limit) and not c.at.is_infinite)
    needed = sum(_weight(c, x) for c in conditions)
    for count in (needed, needed + 1):  # what clashes in the smallest fractions a family may keep
        for above in sorted(range(count), key=lambda n: (abs(2 * n - count + 1), -n)):
            below = count - 1 - above
            if below >= poles and (far is None or _reaches(above - below, far)):
                yield Rational(above, below)


def _weight(condition: AbstractCondition, x: sp.Symbol) -> int:
    """How many coefficients a condition takes, in a fraction whose degrees were chosen for it."""
    if not isinstance(condition, Limit):
        return 1
    if condition.at.is_infinite:
        return 2 if condition.minus != 0 else 0 if condition.equals == 0 else 1
    return 1 + int(sp.degree(condition.scale, x))  # a pole of that order, and its coefficient


def _reaches(excess: int, far: Limit) -> bool:
    """Whether a fraction with that excess of degrees can have a limit, a nonzero one, or an oblique asymptote."""
    return excess == 1 if far.minus != 0 else excess == 0 if far.equals != 0 else excess < 0


def _problem(study: Study, conditions: tuple[AbstractCondition, ...], form: Rational) -> Problem | None:
    try:
        return Problem(target=study.target, conditions=conditions, form=form, name="study")
    except RatfitError:
        return None


def _works(problem: Problem, seconds: float) -> bool:
    try:
        return bool(derive(problem, timeout=seconds).candidates)
    except RatfitError:
        return False


def offered(study: Study) -> tuple[AbstractCondition, ...]:
    """Every condition of the study once, in the order of the facts; integrals and the others too."""
    found: dict[tuple, AbstractCondition] = {}
    for fact in study.facts:
        condition = fact.condition
        if condition is not None:
            found.setdefault((*_key(condition), *_more_of(condition)), condition)
    return tuple(found.values())


def _more_of(condition: AbstractCondition) -> tuple[sp.Expr, ...]:
    """What tells conditions apart that differ in more than their place: moments, and the terms of a pole."""
    if isinstance(condition, Integral):
        return (condition.weight,)
    return (condition.minus,) if isinstance(condition, Limit) and not condition.at.is_infinite else ()
