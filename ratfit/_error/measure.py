"""The verb: every definition of eps of a fit, at the same points, in one pass.

The fit is computed in the dtype under test, the exact function in float64, at the very points, after they were rounded
to that dtype. Memory is the same for a thousand samples and for a million million.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from ratfit._error.bits import KeptValue, kept_values
from ratfit._error.chunk import LEFT_OUT
from ratfit._error.curve import error_curve
from ratfit._error.definitions import TABLE
from ratfit._error.poles import poles_of, poles_of_exact
from ratfit._error.reference import FLOAT64, Reference, reference_for
from ratfit._error.stream import Watch, pass_of, stream
from ratfit._error.subnormal import flushed_samples
from ratfit._error.totals import Totals
from ratfit._sampling import bounds, check_protocol, count, drawn, protocol_at
from ratfit._setting import Setting, Value, in_words, setting

VANISHING = 1000.0
"""A relative error that says more of how small the exact function is than of the fit."""


LEADING = ("peak_mean", "peak_max", "relative_mean", "relative_max", "ulp_max")
"""The definitions that are shown where there is no room for all."""


@dataclass(frozen=True, repr=False)
class ErrorMeasurement:
    """The errors of a fit under every definition, with all that it takes to measure them again.

    `epsilon` is None where a definition divides by 0 or has no finite value, and everywhere when no sample is finite;
    with `poles` on the domain only the quantiles are left. `nonfinite` counts the samples left out because the exact
    value or the fit is inf or nan, `counts` tells these apart. `worst` says `at` which value of the variable the error
    of its `definition` is reached: `relative_max`, or `absolute_max` where the exact function is 0 throughout; `places`
    says the same of each maximum, with the values of parameters that were drawn at random. `kept` says, of an
    exhaustive measurement, which value conditions hold bit for bit; `curve` is the error over the domain, for pictures.
    """

    epsilon: dict[str, float | None]
    worst: dict[str, Any]
    nonfinite: int
    samples: int
    sampling: str
    seed: int
    dtype: str
    parameters: dict[str, Any]
    reference: str | None
    counts: dict[str, int] = field(default_factory=dict)
    places: dict[str, dict[str, Any]] = field(default_factory=dict)
    poles: tuple[float, ...] = ()
    kept: tuple[KeptValue, ...] = ()
    curve: dict[str, Any] | None = None
    note: str = ""

    def __repr__(self) -> str:
        """What a notebook shows: a few definitions, how they were measured, and the note; `epsilon` has them all."""
        known = [f"{name} {value:.3g}" for name in LEADING if (value := self.epsilon.get(name)) is not None]
        eps = ", ".join(known) or "none of the leading definitions"
        return f"<eps {eps}; {self.sampling}, {in_words(self)}{f'; {self.note}' if self.note else ''}>"


def measure_error(
    fit: Any,
    *,
    samples: int | None = 1_000_000,
    sampling: str = "uniform",
    seed: int = 0,
    dtype: str = "float32",
    parameters: Mapping[str, Value] | None = None,
    reference: str | None = None,
    within: tuple[float, float] | None = None,
    quantiles: bool = True,
    watch: Watch | None = None,
) -> ErrorMeasurement:
    """Measure how far a fit is from the exact function, under every definition of eps.

    **Arguments:**

    - `fit`: a `Fit` without free coefficients, or anything with a `problem` and a `formula`.
    - `samples`, `sampling`, `seed`: how many points, by which protocol, from which seed; `exhaustive` takes every
      number of the dtype in the closed domain, and `samples=None`.
    - `dtype`: what the fit is computed in, `"float16"`, `"float32"` or `"float64"`; the exact function in float64, for
      `exhaustive` in double-double where float64 would not do.
    - `parameters`: the values of the problem's parameters by name, or `"random"`: drawn anew for every sample.
    - `reference`: the name of the problem's reference to compare with, in place of the target.
    - `within`: the part of the domain to measure on, `(low, high)`; left out, all of it.
    - `quantiles`: whether the histograms are kept that quantiles come from.
    - `watch`: who is told of progress, and where the state of a long pass is kept.

    **Returns:** the same numbers to the last bit for the same arguments on the same kind of device, on however many
    devices and in however many processes.

    **Fails** with `RatfitError` as `setting` and `check_protocol` do. See also: `DEFINITIONS`, `measure_speed`.
    """
    check_protocol(sampling, samples, seed, dtype)
    place = setting(fit, parameters, reference, within)
    sampling = protocol_at(place, sampling, dtype)
    if samples is None:
        samples = count(place.low, place.high, dtype)
    exhaustive = sampling == "exhaustive"
    better = reference_for(place, sampling, seed, samples, dtype) if exhaustive else FLOAT64
    what = pass_of(place, sampling, dtype, quantiles, better.double_double)
    totals = stream(what, place, samples, seed, watch or Watch())
    infinite = poles_of(place)
    epsilon = {name: each.value(totals) for name, each in TABLE.items() if quantiles or "_q" not in name}
    if infinite:
        epsilon = {name: value if "_q" in name else None for name, value in epsilon.items()}
    places = _places(totals, place, sampling, seed, dtype)
    kept = kept_values(fit, place, dtype) if exhaustive else ()
    return ErrorMeasurement(
        epsilon=epsilon,
        worst=_worst(places),
        nonfinite=samples - totals.counts["finite"],
        samples=samples,
        sampling=named(sampling, within),
        seed=seed,
        dtype=dtype,
        parameters=place.parameters,
        reference=reference,
        counts={name: totals.counts[name] for name in LEFT_OUT},
        places=places,
        poles=infinite,
        kept=kept,
        curve=error_curve(place, dtype),
        note="; ".join([*_notes(totals, infinite, place, dtype, better, exhaustive), *map(str, kept)]),
    )


def named(sampling: str, within: tuple[float, float] | None) -> str:
    """The protocol as a record has it: with the part of the domain, where it is not measured on all of it."""
    return sampling if within is None else f"{sampling} on [{within[0]:.17g}, {within[1]:.17g}]"


def _places(totals: Totals, place: Setting, sampling: str, seed: int, dtype: str) -> dict[str, dict[str, Any]]:
    """Where each maximum is: the sample is drawn again by its counter."""
    import numpy as np

    counters = {name: counter for name, (value, counter) in totals.worst.items() if value >= 0}
    if not counters:
        return {}
    points = drawn(sampling, seed, np.array(list(counters.values()), np.uint64), bounds(place, dtype), dtype)
    symbols = ("at", *(symbol.name for symbol in place.ranges))
    rows = zip(*(np.asarray(each, float).tolist() for each in points), strict=True)
    return {f"{name}_max": dict(zip(symbols, row, strict=True)) for name, row in zip(counters, rows, strict=True)}


def _worst(places: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    definition = "relative_max" if "relative_max" in places else "absolute_max"
    return {"definition": definition, **places.get(definition, {"at": None})}


def _notes(
    totals: Totals, infinite: tuple[float, ...], place: Setting, dtype: str, better: Reference, exhaustive: bool
) -> Iterator[str]:
    if infinite:
        where = ", ".join(f"{at:.6g}" for at in infinite[:3])
        yield f"pole of the fit at {place.variable} = {where}: no mean or maximum has a meaning"
    if shared := poles_of_exact(place):
        where = ", ".join(f"{at:.6g}" for at in shared[:3])
        near = "its peak, mean and range say how near a sample came"
        yield f"the exact function is infinite at {place.variable} = {where}: {near}"
    if not totals.counts["finite"]:
        yield f"no sample is finite in {dtype}: its constants or values leave that type's range"
    if totals.worst["relative"][0] > VANISHING and totals.worst["absolute"][0] < totals.extremes["peak"]:
        yield "relative errors are huge where the exact function all but vanishes: read those over the peak"
    counted = ", ".join(f"{totals.counts[n]} {n.replace('_', ' of the ')}" for n in LEFT_OUT if totals.counts[n])
    if counted:
        yield f"left out: {counted}"
    if better.double_double:
        yield "reference in double-double"
    if better.note:
        yield better.note
    if exhaustive and (flushed := flushed_samples(place, dtype)):
        yield f"{flushed} samples are subnormal, which JAX takes for 0 here"
