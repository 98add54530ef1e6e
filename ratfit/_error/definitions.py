"""Every definition of eps: its name, its formula, and its value from the totals of a pass."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from ratfit._error.chunk import BINS, BINS_AN_OCTAVE, LEAST_EXPONENT
from ratfit._error.totals import BINNED, Totals

QUANTILES: Mapping[str, float] = {"q50": 0.5, "q90": 0.9, "q99": 0.99, "q999": 0.999}


@dataclass(frozen=True)
class Definition:
    """One way to say how far a fit is off; None where it divides by 0 or a sum or square is beyond float64."""

    formula: str
    value: Callable[[Totals], float | None]


# What an error is divided by: the text that the formula shows, and its value.
_NORMS: Mapping[str, tuple[str, Callable[[Totals], float | None]]] = {
    "absolute": ("", lambda totals: 1.0),
    "peak": (" / max(|exact|)", lambda totals: totals.extremes["peak"]),
    "range": (" / (max(exact) - min(exact))", lambda totals: totals.extremes["highest"] - totals.extremes["lowest"]),
    "mean": (" / mean(|exact|)", lambda totals: totals.mean("size", totals.counts["known"])),
}


LEAST_SQUARE = 2.0**-900
"""Below this mean square, what squares that are too small for float64 add to it may show."""


def _rms(totals: Totals, square: str, error: str, over: str) -> float | None:
    value, size = (totals.mean(name, totals.counts[over]) for name in (square, error))
    return None if value is None or (value < LEAST_SQUARE and size != 0) else math.sqrt(value)


# What is made of the errors of all samples.
_STATISTICS: Mapping[str, tuple[str, Callable[[Totals], float | None]]] = {
    "mean": ("mean(|fit - exact|)", lambda totals: totals.mean("absolute", totals.counts["finite"])),
    "rms": ("sqrt(mean((fit - exact)^2))", lambda totals: _rms(totals, "square", "absolute", "finite")),
    "max": ("max(|fit - exact|)", lambda totals: _worst(totals, "absolute")),
    "bias": ("mean(fit - exact)", lambda totals: totals.mean("error", totals.counts["finite"])),
}


def _worst(totals: Totals, name: str) -> float | None:
    value = totals.worst[name][0]
    return value if 0 <= value < math.inf else None


def _normalised(norm: str, statistic: str) -> Definition:
    below, divisor = _NORMS[norm]
    above, value = _STATISTICS[statistic]

    def eps(totals: Totals) -> float | None:
        error, size = value(totals), divisor(totals)
        if error is None or not size or not math.isfinite(size):
            return None
        return error / size if math.isfinite(error / size) else None

    return Definition(above + below, eps)


def _quantile(name: str, share: float) -> Definition:
    text = "|fit - exact|" + (" / |exact| over exact != 0" if name == "relative" else "")

    def eps(totals: Totals) -> float | None:
        value = quantile(totals.bins[name], share)
        # The middle of the greatest error's bin may be beyond that error.
        return value if value is None else min(value, totals.worst[name][0])

    return Definition(f"the {share:g} quantile of {text}", eps)


def quantile(bins: Mapping[int, int], share: float) -> float | None:
    """A quantile from a histogram: the middle of its bin, which is within 0.8 % of every number in that bin.

    The least bin holds all below 2**-192 and is 0; the highest all that is about 2**64 or more, and is None.
    """
    left = share * sum(bins.values())
    for place in sorted(bins):
        left -= bins[place]
        if left <= 0:
            return _middle(place)
    return None


def _middle(place: int) -> float | None:
    octave, part = divmod(place, BINS_AN_OCTAVE)
    inside = math.ldexp(1 + (part + 0.5) / BINS_AN_OCTAVE, octave + LEAST_EXPONENT)
    return {0: 0.0, BINS - 1: None}.get(place, inside)


def _table() -> Iterator[tuple[str, Definition]]:
    for norm in _NORMS:
        for statistic in _STATISTICS:
            yield f"{norm}_{statistic}", _normalised(norm, statistic)
    over = "over exact != 0"
    nonzero = lambda totals: totals.counts["nonzero"]  # noqa: E731  # a name for it, used three times below
    yield (
        "relative_mean",
        Definition(f"mean(|fit - exact| / |exact|) {over}", lambda totals: totals.mean("relative", nonzero(totals))),
    )
    yield (
        "relative_rms",
        Definition(
            f"sqrt(mean((fit - exact)^2 / exact^2)) {over}",
            lambda totals: _rms(totals, "relative_square", "relative", "nonzero"),
        ),
    )
    yield "relative_max", Definition(f"max(|fit - exact| / |exact|) {over}", lambda totals: _worst(totals, "relative"))
    yield (
        "relative_bias",
        Definition(
            f"mean((fit - exact) / exact) {over}", lambda totals: totals.mean("relative_signed", nonzero(totals))
        ),
    )
    yield (
        "ulp_mean",
        Definition(
            "mean(|fit - exact| / ulp(exact)), ulp the unit in the last place of the type under test",
            lambda totals: totals.mean("ulp", totals.counts["finite"]),
        ),
    )
    yield "ulp_max", Definition("max(|fit - exact| / ulp(exact))", lambda totals: _worst(totals, "ulp"))
    for name in BINNED:
        for suffix, share in QUANTILES.items():
            yield f"{name}_{suffix}", _quantile(name, share)


TABLE: Mapping[str, Definition] = dict(_table())

DEFINITIONS: Mapping[str, str] = {name: definition.formula for name, definition in TABLE.items()}
"""Every definition of eps, name -> formula. Mean and max run over the finite samples; eps is 0.01, not 1 %."""
