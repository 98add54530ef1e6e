"""Energy: no surface reflects more than it receives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ratfit.models._model import Model
from ratfit.models.albedo import TOLERANCE, Albedo, albedo, angles
from ratfit.models.directions import W
from ratfit.models.laws.law import FAILS, HOLDS, UNDECIDED, Law, degrees
from ratfit.models.laws.settings import Setting, between, settings

SETTINGS = 40
COSINES = np.cos(np.radians([0, 30, 55, 70, 80, 86, 89, 89.97]))
ROUGHLY = 0.03
"""The tolerance of the search; what it finds is measured again."""

ROUNDING = 1e-9
SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)


@dataclass(frozen=True)
class Brightest:
    """The setting and the azimuth of the view (radians) with the greatest albedo that was found, over all angles."""

    setting: Setting
    azimuth: float
    albedo: Albedo
    tried: int


def brightest(model: Model, fixed: Setting, seed: int) -> Brightest:
    """Tries settings, then each parameter by itself from the best on; that one is measured at every angle."""
    tried = settings(model, fixed, SETTINGS, seed)
    best = max(tried, key=lambda setting: _peak(model, setting))
    for parameter in (p for p in model.parameters if p.name not in fixed):
        nearby = [{**best, parameter.name: between(parameter, share)} for share in SHARES]
        best = max([best, *nearby], key=lambda setting: _peak(model, setting))
        tried += nearby
    azimuths = (0.0, math.pi / 4, math.pi / 2) if model.reflectance.has(W) else (0.0,)
    azimuth = max(azimuths, key=lambda each: _peak(model, best, each))
    cosines = np.union1d(angles(), COSINES)[::-1]
    return Brightest(best, azimuth, albedo(model, cosines, azimuth=azimuth, **best), len(tried))


def energy(model: Model, found: Brightest) -> Law:
    """The greatest directional albedo over all angles, and a search among the settings."""
    at = int(np.argmax(np.nan_to_num(found.albedo.values, nan=math.inf, posinf=math.inf)))
    value, error = float(found.albedo.values[at]), float(found.albedo.errors[at])
    if not math.isfinite(value) or value - error > 1 + ROUNDING:
        told = FAILS
    elif value <= 1 + min(error, TOLERANCE) + ROUNDING:
        told = HOLDS
    else:
        told = UNDECIDED
    place = {"view": degrees(found.albedo.cosines[at]), **found.setting}
    if model.reflectance.has(W):
        place = {"view's azimuth": math.degrees(found.azimuth), **place}
    how = f"quadrature, to {error:.1g}" if math.isfinite(error) else "no number"
    remark = f"{how}; {found.tried} settings"
    return Law("energy", told, "greatest directional albedo", value, 1.0, place, remark)


def _peak(model: Model, setting: Setting, *azimuths: float) -> float:
    """The greatest albedo at a few angles, of the views along the tangent and across it where no azimuth is given."""
    azimuths = azimuths or ((0.0, math.pi / 2) if model.reflectance.has(W) else (0.0,))
    return max(_greatest(albedo(model, COSINES, azimuth=a, tolerance=ROUGHLY, **setting).values) for a in azimuths)


def _greatest(values: Any) -> float:
    """The greatest, and infinity before all where there is a nan."""
    return float(np.max(np.nan_to_num(values, nan=math.inf, posinf=math.inf)))
