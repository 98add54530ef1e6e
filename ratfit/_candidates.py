"""Candidates: what a route finds, verified; and in smaller forms, where all of it has a common factor."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from ratfit._fit import Candidate
from ratfit._form import Rational
from ratfit._problem import Problem
from ratfit._solver import solve
from ratfit._system import System, equations
from ratfit._verify import verify


def candidates(system: System, route: str, seed: int = 0) -> Iterator[Candidate]:
    """Every candidate of a route, accepted or rejected, as it is found.

    Incomplete derivative data may leave derivatives open, and the member that they have in common may be a fraction
    with a common factor: what keeps the conditions is then in the form with both degrees one less. Where nothing is
    accepted, that form is tried, and so on.
    """
    accepted = False
    for solution in solve(system, route, seed):
        candidate = verify(system, solution)
        accepted |= not candidate.reason
        yield candidate
    smaller = None if accepted or route != "polynomial" else _smaller(system)
    if smaller is not None:
        yield from candidates(smaller, "linear" if not smaller.completion.symbols else route, seed)


def _smaller(system: System) -> System | None:
    """The system with both degrees of its form one less, where derivatives are open in it."""
    problem: Problem = system.problem
    form = problem.form
    if not isinstance(form, Rational) or form.parity or not system.completion.symbols or system.integrals:
        return None
    if min(form.numerator, form.denominator) < 1:
        return None
    less = replace(form, numerator=form.numerator - 1, denominator=form.denominator - 1)
    return equations(replace(problem, form=less))
