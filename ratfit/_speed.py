"""How much faster a fit is than the exact function: gamma, with the copy floor, in one run.

Exact, fit and floor (`x + 1`: read a sample, write a sample, next to no work) run on the same array, compiled, in
rounds, so that the three share whatever else the machine does meanwhile. In a round each is called twice and timed the
second time: none pays for what the run before it left in the caches and in the processor's clock.
"""

from __future__ import annotations

import itertools
import os
import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ratfit._kernel import Program, kernel, precision
from ratfit._parse import RatfitError, nearest
from ratfit._sampling import check_protocol, draw
from ratfit._setting import setting

BACKENDS: Mapping[str, str] = {"jax-cpu": "cpu", "jax-gpu": "gpu"}
"""Name of a backend -> JAX's name of the platform."""

SECONDS = 1.5  # what the timed rounds of one measurement take together, as far as the least number of rounds allows
ROUNDS = (12, 600)  # the least and the most: two of every order; more than the most no longer narrow the interval
RESAMPLES = 1000
AT_FLOOR = 1.1  # a fit within 10 % of the floor is as fast as memory, however little it computes
NOISY = 1.25  # an interval wider than that from end to end says little


@dataclass(frozen=True)
class SpeedMeasurement:
    """The times of exact, fit and copy floor, and what follows from them.

    `gamma` is the exact function's median time over the fit's, the floor not subtracted; `gamma_low` and `gamma_high`
    are the ends of its 95 % interval. `exact_s`, `fit_s` and `floor_s` are the medians, in seconds for one call on all
    samples, of the raw `exact_times`, `fit_times` and `floor_times`, one a round. `note` says how to read gamma.
    """

    exact_s: float
    fit_s: float
    floor_s: float
    gamma: float
    gamma_low: float
    gamma_high: float
    note: str
    exact_times: tuple[float, ...]
    fit_times: tuple[float, ...]
    floor_times: tuple[float, ...]
    backend: str
    flags: str  # XLA_FLAGS as they stood
    samples: int
    seed: int
    dtype: str
    parameters: dict[str, float]
    reference: str | None


def measure_speed(
    fit: Any,
    *,
    backend: str = "jax-cpu",
    samples: int = 1_000_000,
    seed: int = 0,
    dtype: str = "float32",
    parameters: Mapping[str, float] | None = None,
    reference: str | None = None,
    repeats: int | None = None,
) -> SpeedMeasurement:
    """Time the exact function, the fit and the copy floor against one another.

    **Arguments:**

    - `fit`, `parameters`, `reference`: as for `measure_error`.
    - `backend`: a name of `BACKENDS`.
    - `samples`, `seed`: the size and seed of the uniform sample that all three run on; `dtype`: their arithmetic.
    - `repeats`: the number of rounds; left out, as many as fit into 1.5 s.

    **Fails** with `RatfitError` for a backend without a device here, and as `measure_error` does.
    See also: `measure_error`.
    """
    import jax

    check_protocol("uniform", samples, seed, dtype)
    if repeats is not None and repeats < 1:
        raise RatfitError(f"repeats = {repeats}: a whole number from 1 upwards is needed, or None")
    place, device = setting(fit, parameters, reference), _device(backend)
    points = jax.device_put(draw("uniform", place.low, place.high, seed, 0, samples, dtype), device)
    programs = (Program(place.exact), place.program, Program(place.variable + 1))
    runs = [kernel(each, place.varying).at(place.values, dtype, device) for each in programs]
    exact, fitted, floor = _times(runs, points, dtype, repeats)
    exact_s, fit_s, floor_s = map(statistics.median, (exact, fitted, floor))
    low, high = ratio_interval(exact, fitted)
    return SpeedMeasurement(
        exact_s, fit_s, floor_s, exact_s / fit_s, low, high, _note(fit_s, floor_s, low, high), exact, fitted, floor,
        backend, os.environ.get("XLA_FLAGS", ""), samples, seed, dtype, place.parameters, reference,
    )  # fmt: skip


def _device(backend: str) -> Any:
    if backend not in BACKENDS:
        raise RatfitError(f"no backend {backend!r}, there is: {', '.join(BACKENDS)}{nearest(backend, BACKENDS)}")
    found = {name: _devices(platform) for name, platform in BACKENDS.items()}
    if not found[backend]:
        others = ", ".join(name for name, devices in found.items() if devices)
        raise RatfitError(f"no device for {backend} on this machine; there is one for: {others}")
    return found[backend][0]


def _devices(platform: str) -> list[Any]:
    import jax

    try:
        return jax.devices(platform)
    except RuntimeError:  # JAX's way to say that it has none
        return []


def _times(
    runs: Sequence[Callable[[Any], Any]], points: Any, dtype: str, repeats: int | None
) -> tuple[tuple[float, ...], ...]:
    """The seconds of every run, one after the other, in each round, in every order in turn."""
    orders = itertools.cycle(itertools.permutations(range(len(runs))))
    with precision(dtype):
        first = sum(_seconds(run, points) for run in runs)
        rounds = repeats or round(min(max(SECONDS / (2 * first), ROUNDS[0]), ROUNDS[1]))
        times = []
        for order in itertools.islice(orders, rounds):
            seconds = {place: _seconds(runs[place], points) for place in order}
            times.append([seconds[place] for place in range(len(runs))])
    return tuple(zip(*times, strict=True))


def _seconds(run: Callable[[Any], Any], points: Any) -> float:
    run(points).block_until_ready()  # the first of all compiles
    start = time.perf_counter()
    run(points).block_until_ready()
    return time.perf_counter() - start


def ratio_interval(above: Sequence[float], below: Sequence[float]) -> tuple[float, float]:
    """The 95 % bootstrap interval of the ratio of the medians of two runs timed in the same rounds.

    The rounds are drawn, not the times: what disturbs a round disturbs both, and in pairs that cancels.
    """
    import numpy as np

    rounds = np.random.default_rng(0).integers(0, len(above), (RESAMPLES, len(above)))
    ratios = np.median(np.asarray(above)[rounds], axis=1) / np.median(np.asarray(below)[rounds], axis=1)
    low, high = np.quantile(ratios, (0.025, 0.975))
    return float(low), float(high)


def _note(fit_s: float, floor_s: float, low: float, high: float) -> str:
    notes = []
    if fit_s <= AT_FLOOR * floor_s:
        notes.append("fit at the copy floor: gamma is a lower bound")
    if high > NOISY * low:
        notes.append("noisy: the interval of gamma is wide, time it again on a quiet machine")
    return "; ".join(notes)
