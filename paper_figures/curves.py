"""What the figures draw: a fit and the exact function it stands for, as arrays, straight from the library."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import ratfit as rf
from paper_figures.style import share
from ratfit._lower import lower
from ratfit._setting import setting
from ratfit.gallery import card

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True)
class Curve:
    """An exact function and its fit at the same places, and their difference in parts of `peak`."""

    label: str
    places: NDArray
    exact: NDArray
    fit: NDArray
    peak: float = 1.0

    @property
    def errors(self) -> NDArray:
        return (self.fit - self.exact) / self.peak

    @property
    def worst_index(self) -> int:
        """Where in the arrays the error is largest."""
        return int(abs(self.errors).argmax())

    @property
    def worst(self) -> tuple[float, float]:
        """The place of the largest error, and that error with its sign."""
        return float(self.places[self.worst_index]), float(self.errors[self.worst_index])

    @property
    def mean(self) -> float:
        """The mean size of the error, every part of the range of places having equal weight."""
        import numpy as np

        return float(np.trapezoid(abs(self.errors), self.places) / (self.places[-1] - self.places[0]))


def curve(
    fit: rf.Fit,
    places: NDArray,
    label: str = "",
    values: Mapping[str, float] | None = None,
    reference: str | None = None,
    peak: float = 1.0,
) -> Curve:
    """A fit beside its target, or beside one of the problem's references, at values of the parameters.

    **Fails** with `RatfitError` for a parameter without a value, which the reference may give, and for an unknown one.
    """
    known = setting(fit, dict(values or {}), reference)
    exact = lower(known.exact, [known.variable, *known.values])(places, *known.values.values())
    of_fit = {s.name: v for s, v in known.values.items() if s in fit.problem.parameters}
    return Curve(label, places, exact, fit(places, **of_fit), peak)


def printed_error(name: str) -> str:
    """The paper's own figure for the error of one of its equations, "1.4 %", as the gallery's card records it."""
    return share(card(name).epsilon or math.nan)
