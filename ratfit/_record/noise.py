"""How much an eps may differ between two rows without meaning anything."""

from __future__ import annotations

import math
from collections.abc import Mapping

from ratfit._record.row import Row

PRECISION = 1e-9
"""Relative change of an eps of one sample on one kind of machine that is none: sums may be added up differently."""

ELSEWHERE = 1e-3
"""The same on another kind of machine, besides rounding of the type under test."""

QUANTILE = 0.02
"""The same for quantiles: the histogram that they come from steps by so much, and rounding may make them step."""

TELLING = 0.5
"""A limit above this share of eps says nothing, and is none."""

ROUNDINGS = 8
"""Roundings of the type under test by which errors may differ where compilers fuse and order operations differently."""

SIGMAS = 5.0
"""Standard deviations of chance beyond which a change is one."""

_UNITS: Mapping[str, float] = {"float16": 2.0**-10, "float32": 2.0**-23, "float64": 2.0**-52}
_DIVISORS = ("peak", "range", "mean")
"""First words of definitions that divide an absolute error by a property of the exact function's sampled values."""


def elsewhere(name: str, old: Row, new: Row) -> tuple[float, str]:
    """The limit for the same sample on another kind of machine: `ELSEWHERE` of eps and some roundings."""
    largest = max(abs(old["epsilon"][name]), abs(new["epsilon"][name]))
    share = QUANTILE if "_q" in name else ELSEWHERE
    why = f"another processor, JAX or NumPy: compared beyond {share:.1%} and {ROUNDINGS} roundings"
    return share * largest + ROUNDINGS * _unit(name, new), why


def _unit(name: str, row: Row) -> float:
    """One rounding of the type under test, in the unit of the definition."""
    if name.startswith("ulp"):
        return 1.0
    unit = _UNITS.get(row["dtype"], 0.0)
    return unit * (_divisor("peak", row) or 1.0) if name.startswith("absolute") else unit


def sampling(name: str, old: Row, new: Row) -> tuple[float | None, str]:
    """The limit for another sample: `SIGMAS` standard deviations of a mean, for means alone.

    A maximum, a quantile or a bias of another sample has no such limit, so None. Errors between 0 and max scatter by no
    more than sqrt(mean*(max - mean)), so two means of n and m errors differ by no more than chance, relative to the
    mean, of sqrt((max/mean - 1)*(1/n + 1/m)); for two rms that is sqrt(((max/rms)^2 - 1)*(1/n + 1/m))/2, by the same
    for the squares. Maximum and mean are the larger ones of the two rows: a sample may have missed what is rare. Where
    the definition divides by what was sampled too, the change of that divisor is let pass on top.
    """
    family, _, kind = name.rpartition("_")
    if kind not in ("mean", "rms"):
        return None, "another sample: only means and rms are compared"
    values, most = _both(name, old, new), _both(f"{family}_max", old, new)
    drift = _drift(family, old, new)
    if values is None or most is None or drift is None:
        return None, "another sample: the rows do not hold what bounds its noise"
    ratio = max(most) / max(values)
    uneven = ratio - 1 if kind == "mean" else (ratio**2 - 1) / 4
    share = SIGMAS * math.sqrt(max(uneven, 1.0) * (1 / max(old["samples"], 1) + 1 / max(new["samples"], 1))) + drift
    if share > TELLING:
        return None, "another sample: too few samples, or errors too uneven, to tell"
    return share * max(values), f"another sample: compared beyond {share:.2g} of eps"


def _both(name: str, old: Row, new: Row) -> tuple[float, float] | None:
    """The values of a definition in both rows; None if one has none."""
    before, after = old["epsilon"].get(name), new["epsilon"].get(name)
    return None if before is None or after is None else (before, after)


def _drift(family: str, old: Row, new: Row) -> float | None:
    """The relative change of what a family of definitions divides by; 0 where that is no property of the sample."""
    if family not in _DIVISORS:
        return 0.0
    before, after = _divisor(family, old), _divisor(family, new)
    return None if before is None or after is None else abs(after - before) / max(before, after)


def _divisor(family: str, row: Row) -> float | None:
    """What this row's definitions of the family were divided by, as the ratio of two of them; None if unknown."""
    absolute, divided = row["epsilon"].get("absolute_max"), row["epsilon"].get(f"{family}_max")
    return absolute / divided if absolute and divided else None
