"""Rounds: every run called twice in each, in every order in turn; and the interval of a ratio of their times.

The runs share whatever else the machine does meanwhile, and the second of two calls is the one that is timed: none pays
for what the run before it left in the caches and in the processor's clock.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ratfit._speed.contest import Runs

SECONDS = 1.5  # what the timed rounds of one measurement take together, as far as the least number of rounds allows
ROUNDS = (12, 600)  # the least and the most: two of every order; more than the most no longer narrow the interval
RESAMPLES = 1000


@dataclass(frozen=True)
class Race:
    """The seconds of every run in each round, and what the last timed call of each gave."""

    times: tuple[tuple[float, ...], ...]
    outputs: tuple[Any, ...]


def race(runs: Runs, repeats: int | None) -> Race:
    """Time the runs in `repeats` rounds; left out, in as many as fit into `SECONDS`."""
    orders = itertools.cycle(itertools.permutations(range(len(runs.calls))))
    outputs: list[Any] = [None] * len(runs.calls)
    times = []
    with runs.scope():
        first = sum(_timed(call)[0] for call in runs.calls)
        rounds = repeats or round(min(max(SECONDS / (2 * first), ROUNDS[0]), ROUNDS[1]))
        for order in itertools.islice(orders, rounds):
            seconds = [0.0] * len(runs.calls)
            for place in order:
                seconds[place], outputs[place] = _timed(runs.calls[place])
            times.append(seconds)
    return Race(tuple(zip(*times, strict=True)), tuple(outputs))


def _timed(call: Callable[[], Any]) -> tuple[float, Any]:
    call()  # the first of all compiles
    start = time.perf_counter()
    output = call()
    return time.perf_counter() - start, output


def ratio_interval(above: Sequence[float], below: Sequence[float]) -> tuple[float, float]:
    """The 95 % bootstrap interval of the ratio of the medians of two runs timed in the same rounds.

    The rounds are drawn, not the times: what disturbs a round disturbs both, and in pairs that cancels.
    """
    import numpy as np

    rounds = np.random.default_rng(0).integers(0, len(above), (RESAMPLES, len(above)))
    ratios = np.median(np.asarray(above)[rounds], axis=1) / np.median(np.asarray(below)[rounds], axis=1)
    low, high = np.quantile(ratios, (0.025, 0.975))
    return float(low), float(high)
