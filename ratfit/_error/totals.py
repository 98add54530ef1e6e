"""Totals: what a pass over the samples adds up, exactly, so that no order of adding can show in the result."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ratfit._error.chunk import BINS, COUNTS, EXTREMES, SUMS, WORST

UNIT = 1074
"""Sums are whole numbers of 2**-1074, which every float64 is a multiple of."""

BINNED = ("absolute", "relative")


@dataclass(frozen=True)
class Totals:
    """What is known of some samples: counts, exact sums, extremes, the worst of each kind, and histograms.

    Errors count only where both the exact value and the fit are finite, relative ones where the exact value is not 0.
    A sum is None where a term is beyond float64. The worst is a value and the counter of the first sample that has it;
    the value is -1 where no sample counts. `bins` is bin -> number of samples.
    """

    counts: Mapping[str, int]
    sums: Mapping[str, int | None]
    extremes: Mapping[str, float]
    worst: Mapping[str, tuple[float, int]]
    bins: Mapping[str, Mapping[int, int]]

    def __add__(self, other: Totals) -> Totals:
        """The totals of both sets of samples; of two equal errors the one with the lesser counter is the worst."""
        least = {"lowest"}
        return Totals(
            {name: self.counts[name] + other.counts[name] for name in COUNTS},
            {name: _sum(self.sums[name], other.sums[name]) for name in SUMS},
            {name: (min if name in least else max)(self.extremes[name], other.extremes[name]) for name in EXTREMES},
            {name: max(self.worst[name], other.worst[name], key=lambda one: (one[0], -one[1])) for name in WORST},
            {name: _merged(self.bins[name], other.bins[name]) for name in BINNED},
        )

    def mean(self, name: str, over: int) -> float | None:
        """A sum over a number of samples, rounded once; None where it is beyond float64 or there are no samples."""
        value = self.sums[name]
        return None if value is None or not over else value / (over << UNIT)

    def to_state(self) -> dict[str, Any]:
        """The totals as a JSON object that `from_state` reads back without loss."""
        return {
            "counts": dict(self.counts),
            "sums": {name: None if value is None else str(value) for name, value in self.sums.items()},
            "extremes": {name: repr(value) for name, value in self.extremes.items()},
            "worst": {name: list(found) for name, found in self.worst.items()},
            "bins": {name: sorted(found.items()) for name, found in self.bins.items()},
        }

    @classmethod
    def from_state(cls, state: Mapping[str, Any]) -> Totals:
        """The totals that `to_state` wrote down."""
        return cls(
            dict(state["counts"]),
            {name: None if value is None else int(value) for name, value in state["sums"].items()},
            {name: float(value) for name, value in state["extremes"].items()},
            {name: (float(value), int(counter)) for name, (value, counter) in state["worst"].items()},
            {name: dict(found) for name, found in state["bins"].items()},
        )


NOTHING = Totals(
    dict.fromkeys(COUNTS, 0),
    dict.fromkeys(SUMS, 0),
    {"peak": 0.0, "highest": -math.inf, "lowest": math.inf},
    dict.fromkeys(WORST, (-1.0, 0)),
    {name: {} for name in BINNED},
)
"""The totals of no samples."""


def of_chunks(found: Mapping[str, Any]) -> Totals:
    """The totals of the chunks whose arrays come from a device, the first axis of each going over the chunks.

    The histograms are summed over the chunks already; there may be none.
    """
    sums = {name: _units(found["sums"][:, place].ravel().tolist()) for place, name in enumerate(SUMS)}
    peaks, highest, lowest = found["extremes"].T
    extremes = {"peak": float(peaks.max()), "highest": float(highest.max()), "lowest": float(lowest.min())}
    counts = {name: int(found[name].sum()) for name in COUNTS}
    bins = {name: _sparse(found[f"{name}_bins"]) if f"{name}_bins" in found else {} for name in BINNED}
    return Totals(counts, sums, extremes, {name: _worst(found, name) for name in WORST}, bins)


def _worst(found: Mapping[str, Any], name: str) -> tuple[float, int]:
    first = int(found[f"worst_{name}"].argmax())  # chunks are in the order of their counters
    return float(found[f"worst_{name}"][first]), int(found[f"counter_{name}"][first])


def _units(values: list[float]) -> int | None:
    """The sum of some floats; None where one is not finite."""
    if not all(map(math.isfinite, values)):
        return None
    ratios = map(float.as_integer_ratio, values)
    return sum(numerator << (UNIT + 1 - denominator.bit_length()) for numerator, denominator in ratios)


def _sum(one: int | None, other: int | None) -> int | None:
    return None if one is None or other is None else one + other


def _merged(one: Mapping[int, int], other: Mapping[int, int]) -> Mapping[int, int]:
    if not one or not other:
        return one or other
    return {place: one.get(place, 0) + other.get(place, 0) for place in {*one, *other}}


def _sparse(counts: Any) -> dict[int, int]:
    totals = counts.reshape(-1, BINS).sum(axis=0)
    (places,) = totals.nonzero()
    return dict(zip(places.tolist(), totals[places].tolist(), strict=True))
