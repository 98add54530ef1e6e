"""Normalisation: the projected areas of all facets add up to that of the surface."""

from __future__ import annotations

import math

import numpy as np

from ratfit._lower import lower
from ratfit.models._half_sphere import azimuth_panels, polar_panels, unit_gauss
from ratfit.models._model import Model
from ratfit.models.directions import LETTERS, SQUARES
from ratfit.models.laws.law import NOT_APPLICABLE, UNDECIDED, Law, verdict
from ratfit.models.laws.settings import Setting, settings

SETTINGS = 40
ORDER, FINEST = 6, 96
"""Nodes along the azimuth of a panel, at first and at most; four times as many along theta."""

BOUND = 1e-4


def normalisation(model: Model, fixed: Setting, seed: int) -> Law:
    """How far the integral of D(H) N.H over the hemisphere is from 1, at the worst setting."""
    measure = "greatest distance from 1 of the integral of D(H) N.H over the hemisphere"
    if model.facets is None:
        return Law("normalisation of D", NOT_APPLICABLE, measure, remark="the model states no distribution of facets")
    mine = {symbol.name for symbol in model.facets.free_symbols}
    worst, slack, place = 0.0, 0.0, {}
    tried = settings(model, fixed, SETTINGS, seed)
    for setting in {tuple(s[name] for name in sorted(mine & s.keys())): s for s in tried}.values():
        value, error = _settled(model, setting)
        distance = abs(value - 1) if math.isfinite(value) else math.inf
        if distance > worst:
            worst, slack = distance, error
            place = {name: each for name, each in setting.items() if name in mine}
    told = verdict(worst <= BOUND) if abs(worst - BOUND) > slack or math.isinf(worst) else UNDECIDED
    return Law("normalisation of D", told, measure, worst, BOUND, place, f"quadrature, to {slack:.1g}")


def _settled(model: Model, setting: Setting) -> tuple[float, float]:
    """The integral with as many nodes as it takes, and what the last doubling changed."""
    value, order = _integral(model, setting, ORDER), ORDER
    error = math.inf
    while order < FINEST and not error <= BOUND / 10 and math.isfinite(value):
        order *= 2
        finer = _integral(model, setting, order)
        value, error = finer, abs(finer - value)
    return value, error


def _integral(model: Model, setting: Setting, order: int) -> float:
    function = lower(model.facets, [*LETTERS, *SQUARES, *model.parameters])
    values = [setting[p.name] for p in model.parameters]
    y_phi, w_phi = unit_gauss(order)
    total = 0.0
    for around in azimuth_panels(0.0, whole=False):
        w = np.abs(np.cos(around.place(y_phi)))[:, None]
        across = 2 * (w_phi * around.slope(y_phi))[:, None]
        for panel in polar_panels(math.pi / 2):
            y, weight = unit_gauss(4 * order)
            theta = panel.place(y)
            t, sine = np.cos(theta), np.sin(theta)
            found = function(t, 1.0, 1.0, 1.0, w, t**2, sine**2, w**2, *values)
            total += float(np.sum(found * t * sine * weight * panel.slope(y) * across))
    return total
