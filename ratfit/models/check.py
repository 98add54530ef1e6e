"""Does a model keep the laws of reflection? Measured, law by law, with the worst place of each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ratfit.models import named
from ratfit.models._model import Model
from ratfit.models.albedo import Albedo, albedo, angles, monte_carlo_albedo
from ratfit.models.laws import FAILS, UNDECIDED, Law
from ratfit.models.laws.drawing import agreement, sampling
from ratfit.models.laws.energy import Brightest, brightest, energy
from ratfit.models.laws.limits import limits
from ratfit.models.laws.normalisation import normalisation
from ratfit.models.laws.reciprocity import reciprocity
from ratfit.models.laws.single import single

EVERY = 4
"""Samples are drawn at one angle in so many."""


@dataclass(frozen=True)
class Check:
    """A model's laws, and its albedo: over all angles at the setting shown, by samples at some, at the brightest."""

    model: Model
    fixed: Mapping[str, float]
    laws: tuple[Law, ...]
    setting: Mapping[str, float]
    albedo: Albedo
    samples: Albedo
    brightest: Brightest

    @property
    def holds(self) -> bool:
        """Whether no law fails or is left undecided."""
        return all(law.verdict not in (FAILS, UNDECIDED) for law in self.laws)


def check(model: str | Model, fixed: Mapping[str, float] | None = None, *, seed: int = 0) -> Check:
    """Measures the laws of a model.

    **Arguments:** `model`, or its name; `fixed`, parameters by name that keep their value while the others range over
    theirs; `seed` of all that is random. The albedo and the samples are those of the fixed parameters and the defaults
    of the others.

    **Returns** the record. A search is no proof: a law that holds was not seen to fail.
    **Fails** with `RatfitError` for a name of no model, and for a parameter that is unknown or outside its range.
    """
    model, fixed = named(model), dict(fixed or {})
    setting: dict[str, Any] = {name: float(value) for name, value in model.settings(fixed).items()}
    shown = albedo(model, **setting)
    drawn = monte_carlo_albedo(model, angles()[::EVERY], seed=seed, **setting)
    at_samples = Albedo(*(each[::EVERY] for each in (shown.cosines, shown.values, shown.errors)))
    found = brightest(model, fixed, seed)
    laws = (
        reciprocity(model, fixed, seed),
        energy(model, found),
        normalisation(model, fixed, seed),
        sampling(model, setting, seed),
        agreement(at_samples, drawn, setting),
        limits(model, fixed, seed),
        single(model, fixed, seed),
    )
    return Check(model, fixed, laws, setting, shown, drawn, found)
