"""Rows to measure: a fit at each setting of its parameters, against its target and each reference."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from ratfit._error import ErrorMeasurement, measure_error
from ratfit._fit import Fit
from ratfit._record import Record
from ratfit._setting import setting
from ratfit._speed import measure_speed


@dataclass(frozen=True)
class Job:
    """One row to measure: the fit against its target (reference None) or a reference, at values of the parameters."""

    fit: Fit
    parameters: Mapping[str, float]
    reference: str | None

    @property
    def name(self) -> str:
        """The name of the row: the problem's, and after a colon the reference's."""
        return self.fit.problem.name + (f":{self.reference}" if self.reference else "")


@dataclass(frozen=True)
class Measuring:
    """How to measure: the same for every row of a run."""

    samples: int
    seed: int
    sampling: str
    dtype: str
    backend: str


def jobs(fit: Fit, settings: Sequence[Mapping[str, sp.Expr | float]] = ()) -> list[Job]:
    """Every row of a fit: its target, when it has one, and its references, at each of the settings.

    Without settings the parameters take the low end, the middle and the high end of their ranges; values that a
    reference gives are left to it.
    """
    problem = fit.problem
    against = ([None] if problem.target is not None else []) + [r.name for r in problem.references]
    given = {r.name: {s.name for s in r.parameters} for r in problem.references}
    found = []
    for reference in against:
        for values in settings or _ends_and_middle(fit):
            kept = {n: float(v) for n, v in values.items() if n not in given.get(reference or "", set())}
            job = Job(fit, kept, reference)
            if job not in found:
                found.append(job)
    return found


def _ends_and_middle(fit: Fit) -> list[dict[str, float]]:
    parameters = fit.problem.parameters
    if not parameters:
        return [{}]
    shares = (sp.S.Zero, sp.S.Half, sp.S.One)
    return [{p.name: float(low + s * (high - low)) for p, (low, high) in parameters.items()} for s in shares]


def measure(job: Job, how: Measuring, *, speed: bool = True) -> Record:
    """Measures one row; without `speed` its times and gamma are None."""
    given: dict[str, Any] = {"parameters": job.parameters, "reference": job.reference}
    error = measure_error(job.fit, samples=how.samples, sampling=how.sampling, seed=how.seed, dtype=how.dtype, **given)
    timed = None
    if speed:
        timed = measure_speed(
            job.fit, backend=how.backend, samples=how.samples, seed=how.seed, dtype=how.dtype, **given
        )
    return Record(
        name=job.name,
        parameters=error.parameters,
        samples=how.samples,
        seed=how.seed,
        sampling=how.sampling,
        dtype=how.dtype,
        backend=how.backend,
        regime="jitted arrays",
        flags=timed.flags if timed else "",
        epsilon=error.epsilon,
        nonfinite=error.nonfinite,
        worst=error.worst,
        exact_s=timed.exact_s if timed else None,
        fit_s=timed.fit_s if timed else None,
        floor_s=timed.floor_s if timed else None,
        gamma=timed.gamma if timed else None,
        gamma_low=timed.gamma_low if timed else None,
        gamma_high=timed.gamma_high if timed else None,
        note="; ".join(n for n in (formula_tag(job), _warning(error), timed.note if timed else "eps only") if n),
    )


def formula_tag(job: Job) -> str:
    """What the row was measured of, in short: a row of another formula is not the same measurement."""
    text = f"{job.fit.formula} | {setting(job.fit, job.parameters, job.reference).exact}"
    return f"formula {hashlib.sha256(text.encode()).hexdigest()[:10]}"


def _warning(error: ErrorMeasurement) -> str:
    if error.nonfinite == error.samples:
        return f"no sample is finite in {error.dtype}: its constants or values leave that type's range"
    return ""


def parameters_of(job: Job) -> dict[str, float]:
    """All values that a row will state, those of its reference too; what --resume compares."""
    return setting(job.fit, job.parameters, job.reference).parameters
