"""What is measured for the paper's figures: which formula, against what, drawn how, at which parameters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ratfit._bench import Job, Measuring
from ratfit._fit import Fit
from ratfit._setting import RANDOM, Value
from ratfit.gallery import Card, card
from ratfit.report.paper.footnote import PLACE, Stated, in_plane, on_hemisphere

EQUATIONS = ("eq12", "eq15", "eq19", "eq21")
DTYPE = "float32"

PLAIN = "uniform"
CHECK = "sobol"
"""Draws as `uniform` does, evenly where that is at random: what both agree in is not chance."""

OF_COSINES = ("uniform", "angle", "cosine", "in-plane", "hemisphere")
"""The protocols for a variable that is a cosine."""

PROTOCOLS: Mapping[str, Sequence[str]] = {"eq12": (PLAIN, CHECK), "eq19": ("uniform", "angle", "cosine")}
"""Those of an equation that has not all of them.

No direction stands behind the sine. The cosine v of Eq. 19 is uniform over the hemisphere, and its angle is in a plane:
pairs of directions would draw it a second time.
"""

TIMED: Mapping[str, tuple[str | None, Mapping[str, float]]] = {
    "eq12": (None, {}),
    "eq15": ("copper", {}),
    "eq19": (None, {"m": 0.25}),
    "eq21": (None, {"m": 0.25}),
}
"""Against which reference, and at which parameters, each equation is timed."""


@dataclass(frozen=True)
class Derived:
    """An equation of the paper: its card, and the fit that was derived."""

    card: Card
    fit: Fit


@dataclass(frozen=True)
class Task:
    """One measurement: what, how, and on which backends, none of them for the errors alone.

    `place` is the equation's number in the paper; `protocol` says to a reader how the samples are drawn, which for a
    pair of directions that a formula is written in is not what the sampling is called.
    """

    place: str
    job: Job
    protocol: str
    how: Measuring
    backends: tuple[str, ...] = ()

    @property
    def against(self) -> str:
        """The exact function, where it is not the problem's own: a corrected one."""
        return self.job.reference or "" if self.job.fit.problem.target is not None else ""

    @property
    def setting(self) -> str:
        """The material, or the value of m."""
        m = self.job.parameters.get("m")
        if m is None:
            return self.job.reference or ""
        return "m random" if self.is_random else f"m = {m:g}"

    @property
    def words(self) -> str:
        """Protocol, exact function and setting, for who waits for it."""
        return " ".join(filter(None, (self.protocol, self.against, self.setting)))

    @property
    def is_random(self) -> bool:
        """Whether every sample draws its own m."""
        return self.job.parameters.get("m") == RANDOM


def error_tasks(derived: Derived, samples: int, seed: int) -> list[Task]:
    """The errors of an equation, under every protocol that its variable has, at the figures' settings and at random."""
    if not derived.fit.candidates:
        return []
    shown, found = derived.card, []
    for protocol in PROTOCOLS.get(shown.aliases[0], OF_COSINES):
        how = Measuring(samples, seed, protocol, DTYPE)
        for reference in _references(shown, protocol):
            is_corrected = shown.problem.target is not None and reference is not None
            settings = [each for each in _settings(shown) if not (is_corrected and RANDOM in each.values())]
            found += [Task(shown.place, Job(derived.fit, values, reference), protocol, how) for values in settings]
    return found


def _references(shown: Card, protocol: str) -> list[str | None]:
    """The exact functions: materials, or the target, and beside it the corrected functions under one protocol."""
    names: list[str | None] = [reference.name for reference in shown.problem.references]
    if shown.problem.target is None:
        return names
    return [None, *names] if protocol == PLAIN else [None]


def _settings(shown: Card) -> Iterator[Mapping[str, Value]]:
    """The figures' values of the parameters, then random ones; a material brings its own."""
    if not shown.settings:
        yield {}
        return
    yield from ({name: float(value) for name, value in setting.items()} for setting in shown.settings)
    yield dict.fromkeys(shown.settings[0], RANDOM)


def footnote_tasks(samples: int, seed: int) -> list[Task]:
    """Eq. 16 in place of Smith's function as printed; against the corrected ones with m at random alone."""
    how = Measuring(samples, seed, PLAIN, DTYPE)
    found = []
    for protocol, stated in (("in-plane", in_plane()), ("hemisphere", on_hemisphere())):
        pair: dict[str, Value] = dict.fromkeys(stated.drawn, RANDOM)
        for values in _settings(card("smith")):
            found.append(Task(PLACE, _stated(stated, {**pair, **values}, None), protocol, how))
        for reference in stated.problem.references:
            found.append(Task(PLACE, _stated(stated, pair | {"m": RANDOM}, reference.name), protocol, how))
    return found


def _stated(stated: Stated, values: Mapping[str, Value], reference: str | None) -> Job:
    measured: Any = stated  # has what measuring asks of a Fit: a problem and a formula
    return Job(measured, values, reference)


def speed_task(derived: Derived, backends: Sequence[str], samples: int, seed: int) -> list[Task]:
    """The times of an equation at one setting, on each backend; none of what was not derived."""
    if not derived.fit.candidates or not backends:
        return []
    reference, values = TIMED[derived.card.aliases[0]]
    how = Measuring(samples, seed, PLAIN, DTYPE)
    return [Task(derived.card.place, Job(derived.fit, values, reference), PLAIN, how, tuple(backends))]
