"""Limits: a finite number, not below 0, at every pair of directions, and 0 below the horizon."""

from __future__ import annotations

from typing import Any

import numpy as np

from ratfit.models._model import Model
from ratfit.models.laws.law import Law, pair_place, verdict
from ratfit.models.laws.pairs import limit_pairs, random_pairs
from ratfit.models.laws.settings import Setting, settings

PAIRS, SETTINGS = 2000, 64


def limits(model: Model, fixed: Setting, seed: int) -> Law:
    """How many values are nan, infinite, negative, or not 0 below the horizon, in float32 and float64."""
    view, light = (np.concatenate(both) for both in zip(limit_pairs(), random_pairs(PAIRS, seed, 1e-12), strict=True))
    count, kinds = 0, set()
    place: dict[str, float] = {}
    for setting in settings(model, fixed, SETTINGS, seed):
        for dtype in (np.float32, np.float64):
            typed: list[Any] = [view.astype(dtype), light.astype(dtype)]
            value = model(*typed, **setting)
            hidden = (typed[0][:, 2] <= 0) | (typed[1][:, 2] <= 0)
            wrong = {
                "nan": np.isnan(value),
                "infinite": np.isinf(value),
                "negative": value < 0,
                "not 0 below the horizon": hidden & (value != 0),
            }
            for kind, where in wrong.items():
                if where.any() and not place:
                    at = int(np.argmax(where))
                    place = {**pair_place(view[at], light[at]), **setting}
                if where.any():
                    kinds.add(f"{kind} in {np.dtype(dtype).name}")
                count += int(where.sum())
    remark = ", ".join(sorted(kinds))
    measure = "values that are nan, infinite, negative, or not 0 below the horizon"
    return Law("limits", verdict(count == 0), measure, float(count), 0.0, place, remark)
