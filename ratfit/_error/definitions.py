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


Value = Callable[[Totals], float | None]


def _mean(name: str, over: str) -> Value:
    return lambda totals: totals.mean(name, totals.counts[over])


# What an error is divided by: the text that the formula shows, and its value.
_NORMS: Mapping[str, tuple[str, Value]] = {
    "absolute": ("", lambda totals: 1.0),
    "peak": (" / max(|exact|)", lambda totals: totals.extremes["peak"]),
    "range": (" / (max(exact) - min(exact))", lambda totals: totals.extremes["highest"] - totals.extremes["lowest"]),
    "mean": (" / mean(|exact|)", _mean("size", "known")),
}


LEAST_SQUARE = 2.0**-900
"""Below this mean square, what squares that are too small for float64 add to it may show."""


def _rms(square: str, error: str, over: str) -> Value:
    def value(totals: Totals) -> float | None:
        mean, size = (_mean(name, over)(totals) for name in (square, error))
        return None if mean is None or (mean < LEAST_SQUARE and size != 0) else math.sqrt(mean)

    return value


def _worst(name: str) -> Value:
    def value(totals: Totals) -> float | None:
        found = totals.worst[name][0]
        return found if 0 <= found < math.inf else None

    return value


# What is made of the errors of all samples.
_STATISTICS: Mapping[str, tuple[str, Value]] = {
    "mean": ("mean(|fit - exact|)", _mean("absolute", "finite")),
    "rms": ("sqrt(mean((fit - exact)^2))", _rms("square", "absolute", "finite")),
    "max": ("max(|fit - exact|)", _worst("absolute")),
    "bias": ("mean(fit - exact)", _mean("error", "finite")),
}

# Those that are not divided by one number.
_OWN: Mapping[str, Definition] = {
    "relative_mean": Definition("mean(|fit - exact| / |exact|) over exact != 0", _mean("relative", "nonzero")),
    "relative_rms": Definition(
        "sqrt(mean((fit - exact)^2 / exact^2)) over exact != 0", _rms("relative_square", "relative", "nonzero")
    ),
    "relative_max": Definition("max(|fit - exact| / |exact|) over exact != 0", _worst("relative")),
    "relative_bias": Definition("mean((fit - exact) / exact) over exact != 0", _mean("relative_signed", "nonzero")),
    "ulp_mean": Definition(
        "mean(|fit - exact| / ulp(exact)), ulp the unit in the last place of the type under test",
        _mean("ulp", "finite"),
    ),
    "ulp_max": Definition("max(|fit - exact| / ulp(exact))", _worst("ulp")),
}


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
    yield from _OWN.items()
    for name in BINNED:
        for suffix, share in QUANTILES.items():
            yield f"{name}_{suffix}", _quantile(name, share)


TABLE: Mapping[str, Definition] = dict(_table())

DEFINITIONS: Mapping[str, str] = {name: definition.formula for name, definition in TABLE.items()}
"""Every definition of eps, name -> formula. Mean and max run over the finite samples; eps is 0.01, not 1 %."""
