"""How far a fit is from the exact function: every definition of eps, at the same points, in one pass.

The fit is computed in the dtype under test, by the very kernel that the speed measurement times; the exact function in
float64, at the very points, after they were rounded to that dtype. The points stream through in chunks, whose sums are
float64: memory is the same for a thousand samples and for a thousand million.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ratfit._kernel import Program, kernel, precision
from ratfit._sampling import check_protocol, draw
from ratfit._setting import Setting, setting

if TYPE_CHECKING:
    from jaxtyping import Array, Float, Float64

    Values = Float[Array, " size"]
    Exact = Float64[Array, " size"]

CHUNK = 2**18  # 2 MiB of float64, so that a chunk and what is made of it stay in the cache


@dataclass(frozen=True)
class Totals:
    """What one pass over the samples adds up. Errors count only where both the exact value and the fit are finite."""

    finite: int
    nonfinite: int
    nonzero: int  # the finite samples with exact != 0: relative errors run over these
    peak: float  # max |exact|, over every finite value of it
    absolute: float  # sum |fit - exact|
    square: float  # sum (fit - exact)^2
    relative: float  # sum |fit - exact| / |exact|
    absolute_max: float
    absolute_at: float
    relative_max: float
    relative_at: float

    def __add__(self, other: Totals) -> Totals:
        """The totals of both sets of samples; of two equal maxima the first keeps its place."""
        absolute = max(self, other, key=lambda totals: totals.absolute_max)
        relative = max(self, other, key=lambda totals: totals.relative_max)
        return Totals(
            finite=self.finite + other.finite,
            nonfinite=self.nonfinite + other.nonfinite,
            nonzero=self.nonzero + other.nonzero,
            peak=max(self.peak, other.peak),
            absolute=self.absolute + other.absolute,
            square=self.square + other.square,
            relative=self.relative + other.relative,
            absolute_max=absolute.absolute_max,
            absolute_at=absolute.absolute_at,
            relative_max=relative.relative_max,
            relative_at=relative.relative_at,
        )


@dataclass(frozen=True)
class Definition:
    """One way to say how far a fit is off."""

    formula: str
    value: Callable[[Totals], float]
    divisor: Callable[[Totals], float]  # what the definition divides by: where it is 0, eps is None


_TABLE: Mapping[str, Definition] = {
    "peak_mean": Definition(
        "mean(|fit - exact|) / max(|exact|)",
        lambda totals: totals.absolute / totals.finite / totals.peak,
        lambda totals: totals.finite * totals.peak,
    ),
    "peak_rms": Definition(
        "sqrt(mean((fit - exact)^2)) / max(|exact|)",
        lambda totals: math.sqrt(totals.square / totals.finite) / totals.peak,
        lambda totals: totals.finite * totals.peak,
    ),
    "peak_max": Definition(
        "max(|fit - exact|) / max(|exact|)",
        lambda totals: totals.absolute_max / totals.peak,
        lambda totals: totals.finite * totals.peak,
    ),
    "absolute_max": Definition(
        "max(|fit - exact|)",
        lambda totals: totals.absolute_max,
        lambda totals: totals.finite,
    ),
    "absolute_mean": Definition(
        "mean(|fit - exact|)",
        lambda totals: totals.absolute / totals.finite,
        lambda totals: totals.finite,
    ),
    "relative_mean": Definition(
        "mean(|fit - exact| / |exact|) over exact != 0",
        lambda totals: totals.relative / totals.nonzero,
        lambda totals: totals.nonzero,
    ),
    "relative_max": Definition(
        "max(|fit - exact| / |exact|) over exact != 0",
        lambda totals: totals.relative_max,
        lambda totals: totals.nonzero,
    ),
}

DEFINITIONS: Mapping[str, str] = {name: definition.formula for name, definition in _TABLE.items()}
"""Every definition of eps, name -> formula. Mean and max run over the finite samples; eps is 0.01, not 1 %."""


@dataclass(frozen=True)
class ErrorMeasurement:
    """The errors of a fit under every definition, with all that it takes to measure them again.

    `epsilon` is None where a definition divides by 0, and everywhere when no sample is finite. `nonfinite` counts the
    samples left out because the exact value or the fit is inf or nan. `worst` says `at` which value of the variable the
    error of its `definition` is reached: `relative_max`, or `absolute_max` where the exact function is 0 throughout.
    """

    epsilon: dict[str, float | None]
    worst: dict[str, Any]
    nonfinite: int
    samples: int
    sampling: str
    seed: int
    dtype: str
    parameters: dict[str, float]
    reference: str | None


def measure_error(
    fit: Any,
    *,
    samples: int = 1_000_000,
    sampling: str = "uniform",
    seed: int = 0,
    dtype: str = "float32",
    parameters: Mapping[str, float] | None = None,
    reference: str | None = None,
) -> ErrorMeasurement:
    """Measure how far a fit is from the exact function, under every definition of eps.

    **Arguments:**

    - `fit`: a `Fit` without free coefficients.
    - `samples`, `sampling`, `seed`: how many points, by which protocol, from which seed.
    - `dtype`: what the fit is computed in, `"float32"` or `"float64"`; the exact function always in float64.
    - `parameters`: the values of the problem's parameters by name.
    - `reference`: the name of the problem's reference to compare with, in place of the target.

    **Fails** with `RatfitError` as `setting` and `check_protocol` do. See also: `DEFINITIONS`, `measure_speed`.
    """
    check_protocol(sampling, samples, seed, dtype)
    place = setting(fit, parameters, reference)
    totals = functools.reduce(Totals.__add__, _chunks(place, samples, sampling, seed, dtype))
    epsilon = {name: each.value(totals) if each.divisor(totals) else None for name, each in _TABLE.items()}
    return ErrorMeasurement(
        epsilon, _worst(totals), totals.nonfinite, samples, sampling, seed, dtype, place.parameters, reference
    )


def _worst(totals: Totals) -> dict[str, Any]:
    if totals.nonzero:
        return {"definition": "relative_max", "at": totals.relative_at}
    return {"definition": "absolute_max", "at": totals.absolute_at if totals.finite else None}


def _chunks(place: Setting, samples: int, sampling: str, seed: int, dtype: str) -> Iterator[Totals]:
    fit = kernel(place.program, place.varying).at(place.values, dtype)
    exact = kernel(Program(place.exact), place.varying).at(place.values, "float64")
    size = min(CHUNK, samples)
    for start in range(0, samples, size):
        # Three kernels, not one: inside one, XLA may skip the rounding to float32 (xla_allow_excess_precision).
        points = draw(sampling, place.low, place.high, seed, start, size, dtype)
        with precision(dtype):
            fitted = fit(points)
        with precision("float64"):
            yield _totals(points, fitted, exact(points.astype("float64")), min(size, samples - start))


def _totals(points: Values, fit: Values, exact: Exact, count: int) -> Totals:
    """The totals of the first `count` points; a last chunk is drawn whole, so that no second kernel is compiled."""
    import jax

    counted = jax.device_get(_reduction()(points, fit, exact, count))
    return Totals(**{name: value.item() for name, value in counted.items()})


@functools.cache
def _reduction() -> Callable[..., dict[str, Any]]:
    import jax
    import jax.numpy as jnp

    def reduce(points: Any, fit: Any, exact: Any, count: Any) -> dict[str, Any]:
        known = (jnp.arange(points.size) < count) & jnp.isfinite(exact)
        finite = known & jnp.isfinite(fit)
        nonzero = finite & (exact != 0)
        size = jnp.abs(exact)
        error = jnp.where(finite, jnp.abs(fit.astype(exact.dtype) - exact), 0)
        relative = jnp.where(nonzero, error / jnp.where(nonzero, size, 1), 0)
        # -1 where nothing counts: a point left out is never the worst one, not even when every error is 0.
        worst = jnp.argmax(jnp.where(finite, error, -1))
        relative_worst = jnp.argmax(jnp.where(nonzero, relative, -1))
        return {
            "finite": jnp.sum(finite),
            "nonfinite": count - jnp.sum(finite),
            "nonzero": jnp.sum(nonzero),
            "peak": jnp.max(jnp.where(known, size, 0)),
            "absolute": jnp.sum(error),
            "square": jnp.sum(error**2),
            "relative": jnp.sum(relative),
            "absolute_max": error[worst],
            "absolute_at": points[worst],
            "relative_max": relative[relative_worst],
            "relative_at": points[relative_worst],
        }

    return jax.jit(reduce)
