"""Float32: the same reflectance in half the digits."""

from __future__ import annotations

import math

import numpy as np

from ratfit.models._model import Model
from ratfit.models.laws.law import Law, pair_place, verdict
from ratfit.models.laws.pairs import random_pairs
from ratfit.models.laws.settings import Setting, settings

PAIRS, SETTINGS = 4000, 24
BOUND = 1e-2
LEAST = 1e-3 / math.pi
"""Reflectances below a thousandth of white paper's are compared with that thousandth."""


def single(model: Model, fixed: Setting, seed: int) -> Law:
    """The greatest error of float32 against float64, at the same directions and parameters, which float32 can hold."""
    view, light = (each.astype(np.float32) for each in random_pairs(PAIRS, seed))
    worst, place, beyond, count = 0.0, {}, 0, 0
    for setting in settings(model, fixed, SETTINGS, seed):
        held: Setting = {
            name: float(np.clip(float(np.float32(value)), *_ends(model, name))) for name, value in setting.items()
        }
        exact = model(view.astype(float), light.astype(float), **held)
        found = model(view, light, **held).astype(float)
        with np.errstate(invalid="ignore"):
            error = np.abs(found - exact) / np.maximum(np.abs(exact), LEAST)
        error = np.where(np.isfinite(exact), np.where(np.isnan(error), np.inf, error), 0)
        beyond, count = beyond + int(np.sum(error > BOUND)), count + error.size
        at = int(np.argmax(error))
        if error[at] > worst:
            worst, place = float(error[at]), {**pair_place(view[at], light[at]), **setting}
    remark = f"{beyond} of {count} pairs are beyond the bound" if beyond else ""
    measure = "greatest error in float32, relative to the value or a thousandth of white paper's"
    return Law("float32", verdict(worst <= BOUND), measure, worst, BOUND, place, remark)


def _ends(model: Model, name: str) -> tuple[float, float]:
    parameter = next(p for p in model.parameters if p.name == name)
    return float(parameter.low), float(parameter.high)
