"""Original: the exact function at the values of the parameters that are measured, which every peer is made from."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import mpmath
import numpy as np
import sympy as sp

from ratfit._lower import Named, lower
from ratfit._parse import RatfitError
from ratfit._setting import Setting
from ratfit._study.curve import Number, numbers_of
from ratfit._target import exact

NODES = 1024
"""Chebyshev nodes that polynomial and AAA see: the outermost lie 6e-7 of the domain from its ends."""


@dataclass(frozen=True)
class Original:
    """An exact function of one variable on [low, high], as an expression and in numbers."""

    expression: sp.Expr  # in the variable alone
    variable: sp.Symbol
    low: float
    high: float

    @property
    def ends(self) -> tuple[sp.Expr, sp.Expr]:
        """The ends as exact numbers: what the doubles' shortest text says."""
        return exact(self.low), exact(self.high)

    @property
    def middle(self) -> sp.Expr:
        return sp.Add(*self.ends) / 2

    def values(self, places: np.ndarray) -> np.ndarray:
        """The values in float64, the limit from inside the domain where the formula gives no number, as for 0/0.

        **Fails** with `RatfitError` where there is no finite limit.
        """
        found = np.array(lower(self.expression, [self.variable])(places), float)
        for k in np.flatnonzero(~np.isfinite(found)):
            found[k] = self.limit(float(places[k]))
        return found

    @cached_property
    def number(self) -> Number:
        """The function at mpmath's working precision; None where it is no finite real number."""
        return numbers_of(self.expression, self.variable)

    def limit(self, place: float) -> float:
        """The limit from inside the domain. **Fails** with `RatfitError` where two steps do not see the same one."""
        span = (self.high - self.low) * self.side(place)
        with mpmath.workdps(200):
            first, second = (self.number(place + span * mpmath.mpf(10) ** -k) for k in (30, 40))
            settled = first is not None and second is not None and abs(first - second) <= abs(second) * 1e-9 + 1e-18
            value = float(second) if settled and second is not None else np.nan
        if not np.isfinite(value):
            raise RatfitError(f"the exact function has no finite value at {self.variable} = {place:.6g}")
        return value

    def side(self, place: float) -> int:
        """The direction in which the domain's farther end lies."""
        return 1 if place - self.low <= self.high - place else -1

    @cached_property
    def angles(self) -> np.ndarray:
        return (np.arange(NODES) + 0.5) * (np.pi / NODES)

    @cached_property
    def nodes(self) -> np.ndarray:
        """Chebyshev's nodes on the domain, none of them an end, from the high one downwards as the angles grow."""
        return self.low + (self.high - self.low) * (1 + np.cos(self.angles)) / 2

    @cached_property
    def at_nodes(self) -> np.ndarray:
        return self.values(self.nodes)

    @cached_property
    def places(self) -> np.ndarray:
        """Where errors are looked at: the nodes, and as many places at even distances, rounded to float32.

        **Fails** with `RatfitError` where the domain holds no float32 number.
        """
        even = self.low + (self.high - self.low) * (np.arange(NODES) + 0.5) / NODES
        rounded = np.concatenate([self.nodes, even]).astype(np.float32).astype(float)
        inside = rounded[(self.low < rounded) & (rounded < self.high)]
        if not inside.size:
            raise RatfitError(f"no float32 number lies between {self.low} and {self.high}: widen the domain")
        return inside

    @cached_property
    def at_places(self) -> np.ndarray:
        return self.values(self.places)

    def peak_error(self, values: np.ndarray) -> float:
        """The largest error of these values at the `places`, in units of the peak; infinite where one is no number."""
        peak = np.max(np.abs(self.at_places)) or 1.0
        error = np.max(np.abs(values.astype(float) - self.at_places)) / peak
        return float(error) if np.isfinite(error) else np.inf

    def float32_error(self, formula: sp.Expr, steps: Named = ()) -> float:
        """The same of a formula in the variable and its steps, computed in float32: rounding takes part."""
        return self.peak_error(lower(formula, [self.variable], steps=steps)(self.places.astype(np.float32)))

    @cached_property
    def centres(self) -> list[sp.Expr]:
        """Where a polynomial may be centred: 0 if it is on the domain, the middle, the ends."""
        low, high = self.ends
        return list(dict.fromkeys([*([sp.S.Zero] if low <= 0 <= high else []), self.middle, low, high]))


def original_of(place: Setting) -> Original:
    """The exact function of a setting. **Fails** with `RatfitError` where a parameter is random."""
    if place.ranges:
        moving = ", ".join(symbol.name for symbol in place.ranges)
        raise RatfitError(f"a peer is made at one value of each parameter: give {moving} a number")
    known = {symbol: exact(value) for symbol, value in place.values.items()}
    return Original(place.exact.xreplace(known), place.variable, place.low, place.high)
