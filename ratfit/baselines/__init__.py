"""What a fit must beat: other ways to compute the exact function, one a file, measured like the fit itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ratfit._fit import Fit
from ratfit._parse import RatfitError
from ratfit._setting import setting
from ratfit.baselines.aaa import aaa
from ratfit.baselines.original import Original, original_of
from ratfit.baselines.pade import pade
from ratfit.baselines.peer import Peer as Peer
from ratfit.baselines.peer import Unavailable as Unavailable
from ratfit.baselines.polynomial import polynomial
from ratfit.baselines.table import table
from ratfit.baselines.table import table_of_equal_error as table_of_equal_error

PEERS: Mapping[str, Callable[[Fit, Original], Peer]] = {
    "table": table, "aaa": aaa, "polynomial": polynomial, "pade": pade,
}  # fmt: skip
"""Every peer by its name, in the order in which they are shown."""


def peers(
    fit: Fit,
    parameters: Mapping[str, Any] | None = None,
    reference: str | None = None,
    within: tuple[float, float] | None = None,
) -> list[Peer | Unavailable]:
    """Every peer of a fit at these values of the parameters, or the reason why there is none.

    **Arguments:**

    - `fit`: a `Fit` without free coefficients.
    - `parameters`: a number for each parameter by name. One that is random leaves no one function to make a peer of.
    - `reference`: the name of the problem's reference that the peers are made of, in place of the target.
    - `within`: the part of the domain that they are made for, `(low, high)`; left out, all of it.

    **Returns:** one record for each of `PEERS`. `measure_error` and `measure_speed` take a `Peer` as they take a fit,
    with the same parameters and reference.

    **Fails** with `RatfitError` as `setting` does, for what the fit could not be measured with either.
    """
    if within is None and any(end.is_infinite for end in fit.problem.domain):
        return [Unavailable(name, "the domain is infinite, and a peer is made on finite ends") for name in PEERS]
    place = setting(fit, parameters, reference, within)
    try:
        original = original_of(place)
    except RatfitError as reason:
        return [Unavailable(name, str(reason)) for name in PEERS]
    return [_made(name, fit, original) for name in PEERS]


def _made(name: str, fit: Fit, original: Original) -> Peer | Unavailable:
    try:
        return PEERS[name](fit, original)
    except RatfitError as reason:
        return Unavailable(name, str(reason))
