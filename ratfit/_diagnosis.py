"""Diagnosis: which conditions clash, which came for free, what would single out a member of a family."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import combinations

import sympy as sp
from sympy.polys.matrices import DomainMatrix

from ratfit._candidates import candidates
from ratfit._condition import AbstractCondition, AbstractPointCondition, Derivative, Value, describe
from ratfit._deadline import TimeLimit
from ratfit._field import is_zero, numerical_rank
from ratfit._fit import Candidate, Fit
from ratfit._jets import same
from ratfit._parse import RatfitError, shortened
from ratfit._problem import Problem
from ratfit._rows import Row, rows, rows_of
from ratfit._solver import Undecided, pick
from ratfit._system import System, completed, equations, of_pairs
from ratfit._target import sample_values
from ratfit._verify import numerical_residual

CLASH_SECONDS = 10.0
"""How long the search for a smallest set of clashing conditions may take before it names all of them."""

CONTRARY = 1e-6
"""A stated number is another than the target's where they differ by more, relative to its size."""

ADVICE_SECONDS = 3.0
"""How long the search for advice on an answer may take."""


def contradiction(system: System) -> str:
    """Two conditions that ask for different numbers at the same place, in words."""
    for (a, demand), (b, other) in combinations(system.pairs, 2):
        if describe(a) == describe(b) and is_zero(demand - other) is False:
            return f"{describe(a)} is asked to be {demand} and to be {other}; drop one of them"
    return ""


def explained(fit: Fit, route: str) -> Fit:
    """The honest no with its reasons: poles, or a smallest set of conditions that no fraction keeps together."""
    reasons = [f"{shortened(str(c.expression))}: {_unattainable(c)}{c.reason}" for c in fit.rejected]
    if any(c.conditions and all(k.holds for k in c.conditions) for c in fit.rejected):
        reasons.append(
            "the conditions hold, but the fit is no finite real function on all of the domain: narrow that, or the "
            "parameters' ranges, raise a degree, or add a condition"
        )
    elif any(map(_is_undecided, fit.rejected)):
        reasons.append(
            "an answer that nobody could prove or refute is no clash: state what the conditions equal, as simple "
            "numbers, or place them elsewhere"
        )
    elif fit.route == "nonlinear":
        reasons.append(
            "many starts found no numbers that keep all conditions, which does not prove that there are none; "
            + (_without_one(fit.problem) or "try another --seed, drop a condition or raise a degree")
        )
    else:
        reasons.append(_clash_in_words(fit.problem, route))
    return replace(fit, reasons=tuple(reasons))


def _is_undecided(candidate: Candidate) -> bool:
    """Whether algebra and numbers disagree on a condition, and none fails."""
    held = [checked.holds for checked in candidate.conditions]
    return None in held and False not in held


def _clash_in_words(problem: Problem, route: str) -> str:
    clash, proved = _smallest_clash(problem, route)
    names = "; ".join(describe(c) for c in clash)
    what = "these conditions clash" if len(clash) < len(problem.conditions) else "all conditions together clash"
    search = "" if proved else " (the search for fewer was cut short)"
    return f"{what} in this form: {names}{search}. Drop one of them or raise a degree"


def _without_one(problem: Problem) -> str:
    """Which condition could be left out so that the others are kept, in words; nothing where none was found in time."""
    with TimeLimit(CLASH_SECONDS):
        for condition in reversed(problem.conditions if len(problem.conditions) > 1 else ()):
            others = problem.with_conditions(tuple(c for c in problem.conditions if c != condition))
            candidate = _any_candidate(others)
            if candidate is not None:
                return f"without the {describe(condition)} there is an answer, so drop that or raise a degree"
    return ""


def _any_candidate(problem: Problem) -> Candidate | None:
    try:
        system = equations(problem)
        return next((candidate for candidate in candidates(system, pick(system)) if not candidate.reason), None)
    except (RatfitError, Undecided):
        return None


def _smallest_clash(problem: Problem, route: str) -> tuple[tuple[AbstractCondition, ...], bool]:
    """The smallest subset of the conditions that has no fit, and whether the search was finished."""
    with TimeLimit(CLASH_SECONDS) as limit:
        for size in range(1, len(problem.conditions)):
            for subset in combinations(problem.conditions, size):
                if not _consistent(problem.with_conditions(subset), route):
                    return subset, True
    return problem.conditions, not limit.passed


def _consistent(problem: Problem, route: str) -> bool:
    """Whether a subset has a fit; one that a route cannot decide counts as consistent, so that no clash is invented."""
    try:
        system = equations(problem)
        found = candidates(system, pick(system, "auto" if route == "linear" else route))
        return any(not candidate.reason or _is_undecided(candidate) for candidate in found)
    except (RatfitError, Undecided):  # Related is a RatfitError too
        return True


def _unattainable(candidate: Candidate) -> str:
    """The nodes at which numerator and denominator vanish together, so that a condition there is not kept, in words."""
    failed = [c.condition for c in candidate.conditions if c.holds is False]
    nodes = sorted({str(c.at) for c in failed if isinstance(c, AbstractPointCondition)})
    return f"unattainable node {', '.join(nodes)}: " if nodes and "cancels" in candidate.reason else ""


def advice(system: System, fit: Fit) -> tuple[str, ...]:
    """What a person may like to know of an answer of the linear route: conditions for free, conditions to add."""
    found: list[str] = []
    with TimeLimit(ADVICE_SECONDS):
        if free := _for_free(system):
            found.append(f"came for free, the other conditions imply it: {'; '.join(map(describe, free))}")
        if fit.status == "family" and not fit.choice:
            found += _completing(system, [symbol.name for symbol in fit.free])
    return tuple(found)


def remarks(system: System, fit: Fit) -> tuple[str, ...]:
    """What a person should know of any answer: conditions that the target does not keep, poles not looked for."""
    found: list[str] = []
    with TimeLimit(ADVICE_SECONDS):
        contrary = [f"{describe(c)} = {shortened(str(d), 60)}" for c, d in system.pairs if _is_contrary(system, c, d)]
        if contrary:
            found.append(f"stated otherwise than the target has it, and kept as stated: {'; '.join(contrary)}")
    opened = {s.name: describe(c) for c, s in system.completion.facts if s in fit.free}
    if opened:
        found.append(
            f"{'; '.join(f'{name} is the {what}' for name, what in opened.items())}, which no condition states"
        )
    left = [symbol.name for symbol in fit.free if symbol not in fit.choice]
    if left and fit.route != "power":
        have = "has a value" if len(left) == 1 else "have values"
        values = " ".join(f"--set {name}=..." for name in left)
        found.append(f"poles are looked for once {', '.join(left)} {have}: {values}")
    return tuple(found)


def _is_contrary(system: System, condition: AbstractCondition, demand: sp.Expr) -> bool:
    """Whether a condition that states its number at a place states another than the target's, by numbers."""
    target = system.problem.target
    if target is None or condition.equals is None or not isinstance(condition, AbstractPointCondition):
        return False
    places = sample_values(set(system.problem.parameters), ("1/7", "4/7"))
    try:
        found = [numerical_residual(system, condition, demand, target.expression, [place]) for place in places]
    except (RatfitError, ValueError, TypeError):
        return False  # no number to hold against it
    sizes = [abs(float(demand.xreplace(place))) for place in places]
    return all(residual >= CONTRARY * (1 + size) for residual, size in zip(found, sizes, strict=True))


def _for_free(system: System) -> list[AbstractCondition]:
    """Conditions that follow from the others, the last stated first to go."""
    whole = completed(system)
    kept = {c: rows_of(whole, c, d) for c, d in whole.pairs}
    rank = _rank(kept.values())
    found: list[AbstractCondition] = []
    for condition in reversed(system.conditions):
        rest = {c: r for c, r in kept.items() if c != condition}
        if rank == sum(map(len, kept.values())):
            break
        if len(rest) < len(kept) and _rank(rest.values()) == rank:
            kept = rest
            found.append(condition)
    return found[::-1]


def _rank(groups: Iterable[list[Row]]) -> int:
    everything = [row for group in groups for row in group]
    if all(e.is_Rational for row in everything for e in row):
        return DomainMatrix.from_list_sympy(len(everything), len(everything[0]), everything).to_field().rank()
    return numerical_rank(everything)


def _completing(system: System, names: Sequence[str]) -> list[str]:
    """Conditions that would leave nothing free, each a fact of the target that adds to the rank."""
    whole = completed(system)
    rank = numerical_rank(rows(whole))
    chosen: list[str] = []
    for condition in _further(system):
        if len(chosen) == len(names):
            break
        try:
            pair = (condition, condition.demanded(system.problem.target))
            more = of_pairs(whole, [*whole.pairs, pair])
            found = numerical_rank(rows(more))
        except RatfitError:
            continue
        if found == rank + 1:
            whole, rank = more, found
            chosen.append(option(condition))
    if not chosen:
        return []
    leave = "a further condition leaves" if len(names) == 1 else f"{len(names)} further conditions leave"
    values = " ".join(f"--set {name}=..." for name in names)
    return [f"{', '.join(names)} free: {leave} one fit, such as {' '.join(chosen)}; or choose: {values}"]


def _further(system: System) -> Iterator[AbstractCondition]:
    """Facts of the target that are not asked for yet, the plainest first."""
    if system.problem.target is None:
        return
    points = [c for c in completed(system).conditions if isinstance(c, AbstractPointCondition)]
    ends = [end for end in system.problem.support() if not end.is_infinite]
    for order in range(4):
        for end in ends:
            if not any(same(c.at, end) and c.order == order for c in points):
                yield Derivative(end, order) if order else Value(end)
    if len(ends) == 2:
        yield Value(sum(ends, sp.S.Zero) / 2)


def option(condition: AbstractCondition) -> str:
    """A value or derivative of the target as an option of the command line."""
    assert isinstance(condition, AbstractPointCondition)
    if condition.order > 1:
        return f'--derivative "{condition.at};order={condition.order}"'
    return f"--{'derivative' if condition.order else 'value'} {str(condition.at).replace(' ', '')}"
