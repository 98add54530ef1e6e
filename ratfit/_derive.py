"""derive(): from a problem to a fit. The program on one screen."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

import sympy as sp

from ratfit._candidates import candidates
from ratfit._condition import Limit
from ratfit._deadline import TimeLimit
from ratfit._diagnosis import advice, contradiction, explained, remarks
from ratfit._field import Related, is_zero
from ratfit._fit import Candidate, Fit
from ratfit._generators import DIGITS
from ratfit._parse import RatfitError, nearest, shortened
from ratfit._problem import Problem
from ratfit._solver import Solution, Undecided, pick, plain
from ratfit._system import System, equations, polynomial_equations
from ratfit._target import sample_values
from ratfit._verify import verify

TIDYING_SECONDS = 1.0
"""How long candidates may be compared after the time has run out."""

AGREEMENT = sp.Float("1e-35")
"""Candidates that are nearer to each other than this wherever one looks may be one function."""

INTERPOLATED = sp.Float("1e-6")
"""The same for candidates that are interpolated."""

POLYNOMIAL_SECONDS = 3.0
"""How long the polynomial route may take before many starts are tried, in seconds of the processor: which route an
answer comes by must not depend on what else the machine does. At most half of the time that a person allows."""


@dataclass
class _Known:
    """What is known so far: it is kept when the time runs out."""

    words: dict[str, str] = field(default_factory=dict)
    route: str = ""
    candidates: list[Candidate] = field(default_factory=list)


def derive(problem: Problem | str | Path, *, route: str = "auto", timeout: float | None = 60.0, seed: int = 0) -> Fit:
    """Derives the fit of a problem: every fraction (or other expression) of its form that keeps its kernel conditions.

    Arguments: `problem`, or the name of a gallery card ("eq12"), or a problem file; `route`, "auto" or the name of
    the one to force; `timeout` in seconds, None for no limit; `seed` of the nonlinear route's starts. Returns a Fit;
    when there is none, its status and reasons say why. Raises RatfitError for a problem that makes no sense.
    """
    if not isinstance(problem, Problem):
        from ratfit.gallery import find_problem

        problem = find_problem(str(problem))
    known = _Known(route=route)
    with TimeLimit(timeout, wall=True) as limit:
        fit = _derived(problem, route, known, timeout, seed)
    if limit.passed:
        return _out_of_time(problem, known, timeout)
    return fit


def _out_of_time(problem: Problem, known: _Known, timeout: float | None) -> Fit:
    so_far = ", ".join(f"{k} {v}" for k, v in known.words.items()) or "the target's own data were not found"
    kept = known.candidates
    with TimeLimit(TIDYING_SECONDS):
        kept = _distinct(known.candidates)
    found = [c for c in kept if not c.reason]
    shown = [shortened(str(c.expression)) for c in found[:3]] + ["..."] * (len(found) > 3)
    names = f"; found so far: {', '.join(shown)}" if found else ""
    reason = f"gave up after {timeout:g} s ({so_far}){names}; allow more with --timeout, or state equals"
    rejected = tuple(c for c in kept if c.reason)
    return Fit(problem, "timeout", known.route, tuple(found), rejected, (reason,))


def _derived(problem: Problem, route: str, known: _Known, timeout: float | None, seed: int) -> Fit:
    system = equations(problem)
    system = replace(system, demands=tuple(map(plain, system.demands)))
    known.route = taken = pick(system, route)
    known.words |= {"route": taken, "conditions": str(len(problem.conditions))}
    known.words["unknowns"] = str(len(system.shape.unknowns))
    if clash := contradiction(system):
        return Fit(problem, "inconsistent", taken, reasons=(clash,))
    alternative = (taken, route) == ("polynomial", "auto")
    seconds = min(POLYNOMIAL_SECONDS, timeout / 2 if timeout else POLYNOMIAL_SECONDS) if alternative else None
    try:
        _collect(system, taken, known, seconds, seed)
    except (Undecided, RatfitError) as error:  # Related is a RatfitError too
        why_not = _tried_by_starts(system, known, seed) if alternative else "there is no other route"
        if why_not and isinstance(error, RatfitError) and not isinstance(error, Related):
            raise
        if why_not:
            return Fit(problem, "rejected", taken, reasons=(str(error), *([why_not] if alternative else [])))
        taken = known.route
    fit = _assembled(problem, taken, _distinct(known.candidates), _shown_equations(system, taken))
    if not fit.candidates:
        return explained(fit, route if taken != "nonlinear" else taken)
    _check_choice(fit, system)
    linear = advice(system, fit) if taken == "linear" else ()
    return replace(fit, advice=(*linear, *remarks(system, fit)))


def _tried_by_starts(system: System, known: _Known, seed: int) -> str:
    """Nothing where the nonlinear route finds what the polynomial one could not, else why it does not."""
    known.route = known.words["route"] = "nonlinear"
    try:
        _collect(system, "nonlinear", known, None, seed)
    except (Undecided, RatfitError) as error:
        return f"nonlinear route: {error}"
    found = any(not candidate.reason for candidate in known.candidates)
    return "" if found else "nonlinear route: many starts found nothing either, which proves nothing"


def _collect(system: System, route: str, known: _Known, seconds: float | None, seed: int) -> None:
    """Verifies solutions as they come; Undecided where a route that has an alternative takes longer than `seconds`."""
    known.candidates = []
    with TimeLimit(seconds) as limit:
        for candidate in candidates(system, route, seed):
            known.candidates.append(candidate)
    if limit.passed:
        raise Undecided(f"the {route} route took longer than {seconds:g} s of processor time")


def _distinct(everything: list[Candidate]) -> list[Candidate]:
    """Candidates that are different functions, in the order found; two signs of one square root often are not."""
    found: list[Candidate] = []
    for candidate in everything:
        if not any(_same_function(candidate, other) for other in found):
            found.append(candidate)
    return found


def _same_function(a: Candidate, b: Candidate) -> bool:
    if a.expression == b.expression:
        return True
    if a.reason and not (a.conditions and b.conditions):
        return False  # never verified, complex ones mostly: to compare these takes longer than it is worth
    nearness = INTERPOLATED if a.table and b.table else AGREEMENT
    if bool(a.reason) != bool(b.reason) or a.free or b.free or not _agree(a.expression, b.expression, nearness):
        return False
    if a.certificate or b.certificate:
        return True  # to the last digit: algebra has no use for numbers that long
    try:
        return is_zero((a.expression - b.expression).together()) is True
    except RatfitError:
        return False


def _agree(a: sp.Expr, b: sp.Expr, nearness: sp.Float) -> bool:
    """Whether two expressions are that near to each other, relative to their size, at a few places of all symbols."""
    for values in sample_values(a.free_symbols | b.free_symbols, ("1/7", "4/7", "9/11")):
        first, second = (sp.N(e.xreplace(values), DIGITS) for e in (a, b))
        if not abs(first - second) <= nearness * (1 + abs(first)):
            return False
    return True


def _assembled(problem: Problem, route: str, found: list[Candidate], shown: tuple[str, ...]) -> Fit:
    accepted = tuple(c for c in found if not c.reason)
    rejected = tuple(c for c in found if c.reason)
    if len(accepted) > 1:
        status = "several"
    elif accepted:
        status = "family" if accepted[0].free else "unique"
    else:
        status = "rejected" if rejected or route == "nonlinear" else "inconsistent"  # starts prove no clash
    return Fit(problem, status, route, accepted, rejected, equations=shown)


def _shown_equations(system: System, route: str) -> tuple[str, ...]:
    """The polynomial system as a paper prints it: with a free scale, the leading numerator coefficient is 1."""
    if route != "polynomial" or any(isinstance(c, Limit) for c in system.conditions):
        return ()
    lead = dict.fromkeys(_leading(system), 1)
    return tuple(f"{e.subs(lead)} = 0" for e in polynomial_equations(system))


def _leading(system: System) -> tuple[sp.Symbol, ...]:
    unknowns = [u for u in system.shape.unknowns if system.shape.numerator.has(u)]
    return (unknowns[-1],) if system.shape.homogeneous else ()


def _check_choice(fit: Fit, system: System) -> None:
    """A recorded choice must name a free coefficient, lie inside its range, and leave a fit that is one."""
    ranges = {s.name: r for s, r in fit.free.items()}
    for name, value in fit.problem.choice.items():
        if name not in ranges:
            raise RatfitError(f"choice {name}: {_not_free(name, list(ranges), fit.problem)}")
        low, high = ranges[name]
        if value.is_number and not low < value < high:
            raise RatfitError(f"choice {name} = {value}: the conditions need {low} < {name} < {high}")
    if fit.choice and len(fit.choice) == len(ranges):
        chosen = verify(system, Solution(*sp.fraction(sp.together(fit.chosen / system.shape.factor))))
        if chosen.reason:
            choice = ", ".join(f"{s} = {v}" for s, v in fit.choice.items())
            raise RatfitError(f"choice {choice}: {chosen.reason}; choose another value")


def _not_free(name: str, free: list[str], problem: Problem) -> str:
    parameters = [p.name for p in problem.parameters]
    if name in parameters:
        return f"it is a parameter, not free (free: {', '.join(free) or 'nothing'}); leave it out"
    there = f"free: {', '.join(free) or 'nothing'}; parameters: {', '.join(parameters) or 'none'}"
    return f"it is not free here, and no parameter ({there}){nearest(name, [*free, *parameters]) or '; leave it out'}"
