"""study(): the program on one screen."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path

from ratfit._deadline import TimeLimit
from ratfit._parse import RatfitError
from ratfit._problem import Problem
from ratfit._problem_file import condition_of
from ratfit._problem_text import condition_table
from ratfit._study.clock import FAILURES, Clock
from ratfit._study.crossings import Scans
from ratfit._study.curve import Curve
from ratfit._study.ends import by_end, end_facts
from ratfit._study.equations import equation_facts
from ratfit._study.fact import Fact, Study
from ratfit._study.far import far_facts
from ratfit._study.moments import moment_facts
from ratfit._study.points import extremum_facts, inflection_facts, zero_facts
from ratfit._study.poles import pole_facts
from ratfit._study.shape import shape_facts
from ratfit._study.suggestion import suggested
from ratfit._study.symmetry import symmetry_facts
from ratfit._target import Target

FIRST_SHARE = 0.8
"""The share of the time that the facts may take together; the rest is for the suggested problem, tried out."""


def study(target: Target | str | Path, *, timeout: float = 30.0) -> Study:
    """Says what is exact about a function: facts that numbers confirm, each as a kernel condition where it can be one.

    Arguments: `target`, or the name of a gallery card or problem file that has one; `timeout` in seconds, after which
    what is known is returned. Raises RatfitError for a time that is not positive, and for a card or file without a
    target. Places inside the domain are found by a scan of some 800 points: what lies closer together than those may
    be missed, and the notes say so.
    """
    if not 0 < timeout < float("inf"):
        raise RatfitError(f"timeout must be a positive number of seconds, not {timeout}")
    target = target if isinstance(target, Target) else target_of(_named(target))
    clock = Clock(FIRST_SHARE * timeout)
    curve = Curve(target)
    facts: list[Fact] = []
    for what, part in _parts(curve, clock):
        _collect(facts, what, part, curve, clock)
    notes = [*_first_notes(curve), *dict.fromkeys(clock.notes)]
    known = Study(target, tuple(by_end(facts, target.domain[0])), tuple(notes))
    return Study(target, known.facts, known.notes, suggested(known, (1 - FIRST_SHARE) * timeout + clock.left()))


def target_of(problem: Problem) -> Target:
    """The target of a problem; RatfitError where it has none."""
    if problem.target is None:
        raise RatfitError(
            f"{problem.name} has no target, only conditions: nothing is left to study. "
            'Write the function out, as in `ratfit study "sin(x)" --on 0 pi/2`'
        )
    return problem.target


def _named(name: str | Path) -> Problem:
    from ratfit.gallery import find_problem

    return find_problem(str(name))


Part = Callable[[], Iterable[Fact]]


def _parts(curve: Curve, clock: Clock) -> list[tuple[str, Part]]:
    scans = Scans(curve, clock)
    return [
        ("ends", lambda: end_facts(curve, clock)),
        ("infinity", lambda: far_facts(curve, clock)),
        ("zeros", lambda: zero_facts(scans)),
        ("poles", lambda: pole_facts(scans)),
        ("extrema", lambda: extremum_facts(scans)),
        ("inflections", lambda: inflection_facts(scans)),
        ("symmetry", lambda: symmetry_facts(curve, clock)),
        ("shape", lambda: shape_facts(scans)),
        ("integrals", lambda: moment_facts(scans)),
        ("differential equations", lambda: equation_facts(curve, clock)),
    ]


def _collect(facts: list[Fact], what: str, part: Part, curve: Curve, clock: Clock) -> None:
    """Adds the facts of a part as they come: what was found before its time ran out is kept."""
    with TimeLimit(clock.left() / 2, wall=True) as limit:
        try:
            for fact in part():
                facts.append(_readable(fact, curve))
        except FAILURES as error:
            clock.notes.append(f"{what}: cut short by what sympy could not do ({type(error).__name__})")
    if limit.passed:
        clock.notes.append(f"{what}: cut short, the time was up")


def _readable(fact: Fact, curve: Curve) -> Fact:
    """The fact without its condition where that cannot be written in ratfit's grammar, as LambertW cannot."""
    if fact.condition is None:
        return fact
    names = {symbol.name: symbol for symbol in (curve.x, *curve.parameters)}
    try:
        condition_of(condition_table(fact.condition), names, fact.kind)
    except RatfitError:
        return replace(fact, condition=None)
    return fact


def _first_notes(curve: Curve) -> list[str]:
    notes = []
    if curve.middle:
        notes.append(f"numbers that could not be had with symbols were taken{curve.label}")
    notes.append(
        f"places inside the domain were sought by changes of sign at {len(curve.nodes)} points; "
        f"closer ones may be missed"
    )
    return notes
