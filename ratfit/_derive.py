"""derive(): from a problem to a fit. The program on one screen."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import sympy as sp

from ratfit._condition import AbstractCondition, describe
from ratfit._deadline import TimeLimit
from ratfit._field import Related, is_zero
from ratfit._fit import Candidate, Fit
from ratfit._parse import RatfitError
from ratfit._problem import Problem
from ratfit._solver import Solution, Undecided, pick, solve
from ratfit._system import System, equations, polynomial_equations
from ratfit._verify import verify

CLASH_SECONDS = 10.0
"""How long the search for a smallest set of clashing conditions may take before it names all of them."""


def derive(problem: Problem | str | Path, *, route: str = "auto", timeout: float | None = 60.0) -> Fit:
    """Derives the fit of a problem: every fraction (or power) of its form that keeps all its kernel conditions.

    Arguments: `problem`, or the name of a gallery card ("eq12"), or a problem file; `route`, "auto" or the name of
    the one to force; `timeout` in seconds, None for no limit. Returns a Fit; when there is none, its status and
    reasons say why. Raises RatfitError for a problem that makes no sense.
    """
    if not isinstance(problem, Problem):
        from ratfit.gallery import find_problem

        problem = find_problem(str(problem))
    known: dict[str, str] = {}
    with TimeLimit(timeout) as limit:
        fit = _derived(problem, route, known)
    if limit.passed:
        so_far = ", ".join(f"{k} {v}" for k, v in known.items()) or "the target's own data were not found"
        reason = f"gave up after {timeout:g} s ({so_far}); allow more with --timeout, or state equals"
        return Fit(problem, "timeout", known.get("route", route), reasons=(reason,))
    return fit


def _derived(problem: Problem, route: str, known: dict[str, str]) -> Fit:
    system = equations(problem)
    route = pick(system, route)
    known |= {"route": route, "conditions": str(len(problem.conditions)), "unknowns": str(len(system.shape.unknowns))}
    if contradiction := _contradiction(system):
        return Fit(problem, "inconsistent", route, reasons=(contradiction,))
    try:
        solutions = solve(system, route)
    except (Undecided, Related) as error:
        return Fit(problem, "rejected", route, reasons=(str(error),))
    known["solutions to verify"] = str(len(solutions))
    candidates = _distinct([verify(system, solution) for solution in solutions])
    fit = _assembled(problem, route, candidates, _shown_equations(system, route))
    if not fit.candidates:
        return _with_clash(fit, route)
    _check_choice(fit, system)
    return fit


def _contradiction(system: System) -> str:
    """Two conditions that ask for different numbers at the same place, in words."""
    pairs = list(zip(system.conditions, system.demands, strict=True))
    for (a, demand), (b, other) in combinations(pairs, 2):
        if describe(a) == describe(b) and is_zero(demand - other) is False:
            return f"{describe(a)} is asked to be {demand} and to be {other}; drop one of them"
    return ""


def _distinct(candidates: list[Candidate]) -> list[Candidate]:
    """Candidates that are different functions, in the order found; two signs of one square root often are not."""
    found: list[Candidate] = []
    for candidate in candidates:
        if not any(_same_function(candidate, other) for other in found):
            found.append(candidate)
    return found


def _same_function(a: Candidate, b: Candidate) -> bool:
    if a.expression == b.expression:
        return True
    if bool(a.reason) != bool(b.reason) or a.free or b.free:
        return False
    try:
        return is_zero((a.expression - b.expression).together()) is True
    except RatfitError:
        return False


def _assembled(problem: Problem, route: str, candidates: list[Candidate], shown: tuple[str, ...]) -> Fit:
    accepted = tuple(c for c in candidates if not c.reason)
    rejected = tuple(c for c in candidates if c.reason)
    if len(accepted) > 1:
        status = "several"
    elif accepted:
        status = "family" if accepted[0].free else "unique"
    else:
        status = "rejected" if rejected else "inconsistent"
    return Fit(problem, status, route, accepted, rejected, equations=shown)


def _shown_equations(system: System, route: str) -> tuple[str, ...]:
    """The polynomial system as a paper prints it: with a free scale, the leading numerator coefficient is 1."""
    if route != "polynomial":
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
            free = ", ".join(ranges) or "nothing"
            what = (
                "is a parameter, not free" if name in {p.name for p in fit.problem.parameters} else "is not free here"
            )
            raise RatfitError(f"choice {name}: it {what} (free: {free}); leave it out")
        low, high = ranges[name]
        if value.is_number and not low < value < high:
            raise RatfitError(f"choice {name} = {value}: the conditions need {low} < {name} < {high}")
    if fit.choice and len(fit.choice) == len(ranges):
        chosen = verify(system, Solution(*sp.fraction(sp.together(fit.chosen / system.shape.factor))))
        if chosen.reason:
            choice = ", ".join(f"{s} = {v}" for s, v in fit.choice.items())
            raise RatfitError(f"choice {choice}: {chosen.reason}; choose another value")


def _with_clash(fit: Fit, route: str) -> Fit:
    """The honest no, with a smallest set of conditions that no fraction of the form can keep together."""
    problem = fit.problem
    reasons = [f"{c.expression}: {c.reason}" for c in fit.rejected]
    if fit.rejected and any(c.conditions and all(k.holds for k in c.conditions) for c in fit.rejected):
        reasons.append(
            "the conditions hold, but the fit has a pole: narrow the parameters' ranges or the domain, "
            "raise a degree, or add a condition"
        )
        return Fit(problem, fit.status, fit.route, (), fit.rejected, tuple(reasons), fit.equations)
    clash, proved = _smallest_clash(problem, route)
    names = "; ".join(describe(c) for c in clash)
    what = "these conditions clash" if len(clash) < len(problem.conditions) else "all conditions together clash"
    search = "" if proved else " (the search for fewer was cut short)"
    reasons.append(f"{what} in this form: {names}{search}. Drop one of them or raise a degree")
    return Fit(problem, fit.status, fit.route, (), fit.rejected, tuple(reasons), fit.equations)


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
        solutions = solve(system, pick(system, "auto" if route == "linear" else route))
        return any(not verify(system, s).reason for s in solutions)
    except (RatfitError, Undecided):  # Related is a RatfitError too
        return True
