"""Rows to measure: a fit and its peers at each setting of the parameters, against the target and each reference."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import sympy as sp

from ratfit._error import ErrorMeasurement, Watch, measure_error
from ratfit._error.measure import named
from ratfit._fit import Fit
from ratfit._parse import RatfitError
from ratfit._record import Record
from ratfit._sampling import count, protocol_at
from ratfit._setting import RANDOM, Setting, Value, setting
from ratfit._speed import measure_speed
from ratfit.baselines import Peer, Unavailable, peers

if TYPE_CHECKING:
    from ratfit.models.stand_ins import StandIn

TIMED = 1_000_000
"""Samples that are timed, however many the errors are measured at: gamma of fewer says little, of more no more."""


@dataclass(frozen=True)
class Job:
    """What to measure: a fit, or a peer of it, against the target (reference None) or a reference, somewhere.

    Or a model that stands for another, on pairs of directions.
    """

    fit: Fit | StandIn
    parameters: Mapping[str, Value]
    reference: str | None
    within: tuple[float, float] | None = None
    peer: Peer | None = None

    @property
    def name(self) -> str:
        """The name of its rows: the problem's, after a colon the reference's, after a tilde the peer's."""
        against = f":{self.reference}" if self.reference else ""
        return self.fit.problem.name + against + (f"~{self.peer.name}" if self.peer else "")

    @property
    def measured(self) -> Any:
        """What is measured: the peer, or else the fit."""
        return self.peer or self.fit

    @property
    def place(self) -> Setting:
        """Formula, exact function, values and domain."""
        return setting(self.measured, self.parameters, self.reference, self.within)

    @cached_property
    def formula(self) -> str:
        """What is measured of, in short: a row of another formula is not the same measurement."""
        text = f"{self.measured.formula} | {self.place.exact}"
        return hashlib.sha256(text.encode()).hexdigest()[:10]


@dataclass(frozen=True)
class Measuring:
    """How to measure: the same for every row of a run. `samples` is None where every number of the dtype is taken."""

    samples: int | None
    seed: int
    sampling: str
    dtype: str


def jobs(
    fit: Fit, settings: Sequence[Mapping[str, sp.Expr | Value]] = (), within: tuple[float, float] | None = None
) -> list[Job]:
    """Every job of a fit: its target, when it has one, and its references, at each of the settings.

    Without settings the parameters take the low end, the middle and the high end of their ranges; values that a
    reference gives are left to it. **Fails** with `RatfitError` where there is nothing exact to measure against.
    """
    problem = fit.problem
    against = ([None] if problem.target is not None else []) + [r.name for r in problem.references]
    if not against:
        raise RatfitError(f"{problem.name} has nothing exact to measure against: add a target, or a [[reference]]")
    given = {r.name: {s.name for s in r.parameters} for r in problem.references}
    for name in dict.fromkeys(name for values in settings for name in values):
        if all(name in given.get(reference or "", ()) for reference in against):
            raise RatfitError(f"{problem.name}: every reference says {name} itself: leave {name} out")
    found = []
    for reference in against:
        for values in settings or _ends_and_middle(fit):
            kept = {n: _value(v) for n, v in values.items() if n not in given.get(reference or "", set())}
            job = Job(fit, kept, reference, within)
            if job not in found:
                found.append(job)
    return found


def model_jobs(name: str, asked: Mapping[str, Value]) -> list[Job]:
    """The jobs of a whole model: everything that stands for it, or itself where it stands for another.

    Parameters that are left out have the model's defaults. **Fails** with `RatfitError` for a model that is neither,
    and for a name that is no parameter.
    """
    from ratfit.models.stand_ins import stand_ins

    return [Job(each, each.settings(asked), None) for each in stand_ins(name)]


def _value(value: sp.Expr | Value) -> Value:
    return value if isinstance(value, str) else float(value)


def _ends_and_middle(fit: Fit) -> list[dict[str, float]]:
    parameters = fit.problem.parameters
    if not parameters:
        return [{}]
    shares = (sp.S.Zero, sp.S.Half, sp.S.One)
    return [{p.name: float(low + s * (high - low)) for p, (low, high) in parameters.items()} for s in shares]


def peer_jobs(found: Sequence[Job]) -> tuple[list[Job], list[tuple[str, str]]]:
    """The jobs of the peers of every timed job, and the peers that there are not, by name, with the reason."""
    made: list[Job] = []
    missing: dict[str, str] = {}
    for job in filter(is_timed, found):
        if not isinstance(job.fit, Fit):
            continue  # a peer is made for a function of one variable
        if RANDOM in job.parameters.values():
            missing["peers"] = "one is made for values of the parameters, not for random ones"
            continue
        for peer in peers(job.fit, job.parameters, job.reference, job.within):
            if isinstance(peer, Unavailable):
                missing.setdefault(f"{job.name}~{peer.name}", peer.reason)
            else:
                made.append(replace(job, peer=peer))
    return made, list(missing.items())


def is_timed(job: Job) -> bool:
    """Whether a gamma is wanted: against the function that the fit replaces, not against corrected ones."""
    return job.reference is None or job.fit.problem.target is None


def asked(job: Job, how: Measuring, backend: str) -> dict[str, Any]:
    """The measurement that one row is the result of, in the keys that rows have for it."""
    place = job.place
    sampling = protocol_at(place, how.sampling, how.dtype)
    samples = count(place.low, place.high, how.dtype) if how.samples is None else how.samples
    said = {"samples": samples, "sampling": named(sampling, job.within), "seed": how.seed, "dtype": how.dtype}
    return {
        **said, "name": job.name, "parameters": place.parameters, "backend": backend, "formula": job.formula,
    }  # fmt: skip


def measure(
    job: Job,
    how: Measuring,
    backends: Sequence[str],
    *,
    about: Mapping[str, Any] | None = None,
    watch: Watch | None = None,
    say: Callable[[str], None] = lambda text: None,
) -> Iterator[Record]:
    """Measures the errors once, then the speed on each backend; a record for each, as soon as it is known.

    **Arguments:** the `job` and how to measure it; `backends`, or none for the errors alone, whose record then has no
    backend; `about` gives further fields of the records (command, fit, published); `watch` is for the errors, and
    `say` is told what goes on.
    """
    given: dict[str, Any] = {
        "parameters": job.parameters, "reference": job.reference, "within": job.within, "seed": how.seed,
    }  # fmt: skip
    error = measure_error(
        job.measured, samples=how.samples, sampling=how.sampling, dtype=how.dtype, watch=watch, **given
    )
    for backend in backends or ("",):
        say(f"timing on {backend}" if backend else "")
        yield _record(job, error, backend, given, about or {})


def _record(
    job: Job, error: ErrorMeasurement, backend: str, given: Mapping[str, Any], about: Mapping[str, Any]
) -> Record:
    speed: dict[str, Any] = dict.fromkeys(("exact_s", "fit_s", "floor_s", "gamma", "gamma_low", "gamma_high"), None)
    notes = [job.peer.about.replace("; ", ", ") if job.peer else "", error.note]
    if backend:
        timed = measure_speed(job.measured, backend=backend, samples=TIMED, dtype=error.dtype, **given)
        speed = {key: getattr(timed, key) for key in speed}
        few = f"gamma is of {TIMED:,} samples" if timed.exact_s and error.samples != TIMED else ""
        notes += [timed.note, few]
    return Record(
        name=job.name,
        parameters=error.parameters,
        samples=error.samples,
        seed=error.seed,
        sampling=error.sampling,
        dtype=error.dtype,
        backend=backend,
        regime=timed.regime if backend else "errors alone",
        flags=timed.flags if backend else "",
        epsilon=error.epsilon,
        nonfinite=error.nonfinite,
        worst=error.worst,
        **speed,
        note="; ".join(filter(None, notes)),
        formula=job.formula,
        counts=error.counts,
        curve=error.curve,
        **about,
    )
