"""Pade: the fraction that has as much of the exact function's Taylor series at one place as its degrees can hold."""

from __future__ import annotations

import sympy as sp

from ratfit._fit import Fit
from ratfit._parse import RatfitError
from ratfit.baselines.approximant import approximant
from ratfit.baselines.original import Original
from ratfit.baselines.peer import Peer, degrees, peer, stablest
from ratfit.baselines.taylor import taylor
from ratfit.baselines.written import about, fraction


def pade(fit: Fit, original: Original) -> Peer:
    """The Pade approximant with the fit's degrees, at the best of 0, the middle and the ends of the domain.

    The best is where the error over the domain, in float32, is smallest; of equal ones the first in that order. At an
    end the series is that from inside.

    **Fails** with `RatfitError` where the exact function has a Taylor series at none of them.
    """
    told: dict[sp.Expr, str] = {}
    for at in original.centres:
        for formula, above, below in _approximants(original, at, *degrees(fit)):
            told.setdefault(formula, f"[{above}/{below}] from the Taylor series at {float(at):.6g}")
    if not told:
        places = ", ".join(f"{float(at):.6g}" for at in original.centres)
        raise RatfitError(f"the exact function has no Taylor series, or one of zeros alone, at {places}")
    formula = stablest(list(told), original)
    return peer("pade", fit, original, formula, told[formula])


def _approximants(original: Original, at: sp.Expr, above: int, below: int) -> list[tuple[sp.Expr, int, int]]:
    """The approximant at a place, with its degrees: multiplied out, and in the distance from there."""
    series = taylor(original, at, above + below)
    found = approximant(series, above, below) if series else None
    if found is None:
        return []
    top, bottom = (about(-at, part) for part in found)
    return [
        (fraction(top, bottom, original.variable, centre), len(top) - 1, len(bottom) - 1)
        for centre in dict.fromkeys([sp.S.Zero, at])
    ]
