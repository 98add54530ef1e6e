"""Reciprocity: the reflectance is the same when view and light change places."""

from __future__ import annotations

import numpy as np

from ratfit.models._model import Model
from ratfit.models.laws.law import Law, pair_place, verdict
from ratfit.models.laws.pairs import random_pairs
from ratfit.models.laws.settings import Setting, settings

PAIRS, SETTINGS = 4000, 24
ROUNDING = 1e-9
"""What rounding may make of two equal reflectances, relative to them."""

LEAST = 1e-290
"""Nearly the smallest number that float64 has in full: what is below it has lost digits already."""


def reciprocity(model: Model, fixed: Setting, seed: int) -> Law:
    """The greatest relative difference between f(V, L) and f(L, V) over random pairs and settings."""
    view, light = random_pairs(PAIRS, seed)
    worst, place = 0.0, {}
    for setting in settings(model, fixed, SETTINGS, seed):
        there, back = model(view, light, **setting), model(light, view, **setting)
        greater = np.maximum(np.abs(there), np.abs(back))
        with np.errstate(invalid="ignore"):
            difference = np.abs(there - back) / np.maximum(greater, LEAST)
        difference = np.where(np.isnan(difference), 0.0, difference)  # infinite both ways; the law of limits says so
        at = int(np.argmax(difference))
        if difference[at] > worst:
            worst, place = float(difference[at]), {**pair_place(view[at], light[at]), **setting}
    measure = "greatest |f(V, L) - f(L, V)| relative to the greater"
    return Law("reciprocity", verdict(worst <= ROUNDING), measure, worst, ROUNDING, place)
