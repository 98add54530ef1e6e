"""Whether the values that a fit must keep are kept bit for bit by its arithmetic."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import sympy as sp

from ratfit._kernel import kernel, precision
from ratfit._lower import rounded
from ratfit._setting import Setting


@dataclass(frozen=True)
class KeptValue:
    """A value condition in the arithmetic of a dtype: what the fit gives at a place, and what it should."""

    at: float
    value: float
    expected: float

    @property
    def holds(self) -> bool:
        """Whether the two are equal; -0.0 counts as 0."""
        return self.value == self.expected

    def __str__(self) -> str:
        if self.holds:
            return f"f({self.at:g}) == {self.expected:g} bit for bit"
        return f"f({self.at:g}) is {self.value!r}, not {self.expected!r}"


def kept_values(fit: Any, place: Setting, dtype: str) -> tuple[KeptValue, ...]:
    """Every value condition of a `Fit` whose place is a number of the dtype, as the compiled kernel keeps it.

    A place such as pi/2 is no number of any dtype: there is nothing to compare at, and it is left out. So are all where
    parameters are drawn at random.
    """
    import numpy as np

    if place.ranges:
        return ()
    kind = np.dtype(dtype).type
    run = kernel(place.program, place.varying).at(place.values, dtype)
    found = []
    for at, expected in _stated(fit, place):
        if sp.Rational(float(kind(at))) == at and place.low <= at <= place.high:
            with precision(dtype), np.errstate(over="ignore"):
                found.append(
                    KeptValue(float(at), float(run(np.array([float(at)], dtype))[0]), float(kind(rounded(expected))))
                )
    return tuple(found)


def _stated(fit: Any, place: Setting) -> Iterator[tuple[sp.Expr, sp.Expr]]:
    values = {symbol: sp.Rational(value) for symbol, value in place.values.items()}
    for checked in getattr(fit, "conditions", ()):
        if checked.condition.kind == "value":
            at, expected = checked.condition.at.xreplace(values), checked.demand.xreplace(values)
            if at.is_Rational and not expected.free_symbols:
                yield at, expected
