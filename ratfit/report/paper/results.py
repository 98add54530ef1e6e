"""What a run has come to, and its record as JSON holds it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ratfit._record import Row, contract, machine
from ratfit.report.paper.closest import Common, Finding, closest, common
from ratfit.report.paper.closest_part import searched
from ratfit.report.paper.footnote import EPSILON, PLACE
from ratfit.report.paper.measurements import OF_COSINES, Derived, Task
from ratfit.report.text import equals_published


@dataclass(frozen=True)
class Results:
    """What a run has come to: the fits, and every measurement with its row."""

    derived: tuple[Derived, ...]
    measured: tuple[tuple[Task, Row], ...] = ()

    @property
    def findings(self) -> list[Finding]:
        """The errors, without those that were measured again beside a time."""
        return [finding(task, row) for task, row in self.measured if not task.backends]

    @property
    def timed(self) -> list[tuple[Task, Row]]:
        """The rows of the backends."""
        return [(task, row) for task, row in self.measured if task.backends]

    @property
    def epsilons(self) -> dict[str, float]:
        """The eps that the paper prints, by place."""
        return {d.card.place: d.card.epsilon for d in self.derived if d.card.epsilon is not None} | {PLACE: EPSILON}

    @property
    def gammas(self) -> dict[str, float]:
        """The gamma that the paper prints, by place."""
        return {d.card.place: d.card.gamma for d in self.derived if d.card.gamma is not None}

    def of(self, place: str) -> list[Finding]:
        """The findings of one place."""
        return [each for each in self.findings if each.place == place]

    @property
    def ways(self) -> tuple[list[Common], list[Common]]:
        """The ways to measure all that has a printed eps alike, and all but the footnote, best first."""
        printed = self.epsilons
        equations = {place: figure for place, figure in printed.items() if place != PLACE}
        return common(self.findings, printed, OF_COSINES), common(self.findings, equations, OF_COSINES)

    @property
    def is_as_printed(self) -> bool:
        """Whether every derivation gives the printed formula."""
        return all(equals_published(each.fit, each.card) for each in self.derived)


def to_json_object(results: Results, samples: int, seed: int) -> dict[str, Any]:
    """The record of a run: machine, every fit with what was printed and what comes closest to it, every row."""
    return {
        "machine": machine(),
        "samples": samples,
        "seed": seed,
        "equations": [_equation_object(each, results) for each in results.derived],
        "footnote": {"place": PLACE, "paper": {"epsilon": EPSILON}, "closest": _closest_object(results, PLACE)},
        "rows": [
            {"place": task.place, "protocol": task.protocol, "setting": task.setting, **contract(row)}
            for task, row in results.measured
        ],
    }


def _equation_object(each: Derived, results: Results) -> dict[str, Any]:
    shown = each.card
    return {
        "place": shown.place,
        "fit": each.fit.to_json_object(),
        "published": shown.printed,
        "equal": equals_published(each.fit, shown),
        "paper": {"epsilon": shown.epsilon, "gamma": shown.gamma, "operations": shown.operations},
        "closest": _closest_object(results, shown.place),
    }


def _closest_object(results: Results, place: str) -> dict[str, Any] | None:
    found = closest(searched(results.of(place)), results.epsilons[place]) if place in results.epsilons else None
    if found is None:
        return None
    best, of = found.match, found.match.finding
    return {
        "definition": best.definition, "protocol": of.protocol, "setting": of.setting, "epsilon": best.value,
        "factor": best.distance, "tried": found.tried, "rounding": len(found.rounding),
    }  # fmt: skip


def finding(task: Task, row: Row) -> Finding:
    """A measured row as the search for the closest sees it."""
    return Finding(task.place, task.protocol, task.setting, task.is_random, task.against, row["epsilon"])
