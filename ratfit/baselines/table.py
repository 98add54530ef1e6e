"""Table look-up with linear interpolation: the alternative that the 1994 paper names in its section 4."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ratfit._fit import Fit
from ratfit._lower import Entries, Lookup, lower
from ratfit._parse import RatfitError
from ratfit._setting import setting
from ratfit.baselines.original import Original, original_of
from ratfit.baselines.peer import Peer, Unavailable, peer

ENTRIES = 256
"""1 KiB of float32, an eighth of the first-level data cache of a processor of 1994; an index is one byte."""

MOST = 2**14
"""64 KiB of float32: beyond it a table of equal error competes with the program for the cache."""


def table(fit: Fit, original: Original, entries: int = ENTRIES) -> Peer:
    """Linear interpolation between equidistant exact values, clamped at the ends of the domain.

    **Fails** with `RatfitError` where the exact function has no finite value at an entry. At an end where it is
    infinite, the entry is its value a quarter of the spacing inside.
    """
    values = _values(original, entries)
    low, high = original.ends
    position = (original.variable - low) * ((entries - 1) / (high - low))
    return peer("table", fit, original, Lookup(position, Entries(values.tolist())), f"{entries} entries, linear")


def table_of_equal_error(
    fit: Fit, parameters: Mapping[str, float] | None = None, reference: str | None = None
) -> Peer | Unavailable:
    """The table with the smallest power of two of entries whose largest error is not above the fit's.

    Both errors are looked at in float64, at up to 2048 places of the domain.

    **Fails** with `RatfitError` as `setting` does, and for a random parameter.
    """
    place = setting(fit, parameters, reference)
    original = original_of(place)
    function = lower(place.formula, (place.variable, *place.values))
    try:
        target = original.peak_error(function(original.places, *place.values.values()))
        for entries in (2**k for k in range(1, MOST.bit_length())):
            nodes = np.linspace(original.low, original.high, entries)
            error = original.peak_error(np.interp(original.places, nodes, _values(original, entries)))
            if error <= target:
                return table(fit, original, entries)
    except RatfitError as reason:
        return Unavailable("table", str(reason))
    return Unavailable(
        "table", f"{MOST} entries, linear, are still off by {error:.2g} of the peak, the fit {target:.2g}"
    )


def _values(original: Original, entries: int) -> np.ndarray:
    nodes = np.linspace(original.low, original.high, entries)
    inside = (nodes[1] - nodes[0]) / 4
    first, last = (_end(original, place, step) for place, step in ((nodes[0], inside), (nodes[-1], -inside)))
    return np.array([first, *original.values(nodes[1:-1]), last])


def _end(original: Original, place: float, step: float) -> float:
    try:
        return original.values(np.array([place]))[0]
    except RatfitError:  # infinite there: the samples lie inside
        return original.values(np.array([place + step]))[0]
