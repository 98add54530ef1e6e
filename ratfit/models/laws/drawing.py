"""Sampling: directions come as often as the density says, and their weights add up to the albedo."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ratfit.models._half_sphere import azimuth_panels, coordinates, lights, panel_of, polar_panels, unit_gauss, views
from ratfit.models._half_sphere import horizon as horizon_of
from ratfit.models._model import Model
from ratfit.models.albedo import Albedo
from ratfit.models.directions import W
from ratfit.models.laws.law import Law, degrees, verdict
from ratfit.models.laws.settings import Setting
from ratfit.models.samplers import Blend, Sampler, sampler_for

SAMPLES = 40_000
ACROSS, NEAR, FAR = 2, 8, 3
"""Cells of a panel along the azimuth, and along theta in the panels toward the normal and toward the horizon."""

ORDER = 8
FEWEST = 5.0
"""Cells that expect fewer samples are taken together."""

CHANCE = 1e-3
"""A law that holds is said to fail as often as this."""

DEVIATIONS = 5.0
COSINES = (0.95, 0.6, 0.2)


@dataclass(frozen=True)
class ChiSquare:
    """Pearson's statistic, its degrees of freedom, and the chance of one as great where samples follow the density."""

    statistic: float
    freedom: int
    chance: float


def chi_square(
    sampler: Sampler | Blend,
    cosine: float,
    azimuth: float = 0.0,
    *,
    samples: int = SAMPLES,
    seed: int = 0,
    **values: Any,
) -> ChiSquare:
    """Samples of the light for one view, counted in cells of the hemisphere, against the integral of the density there.

    **Arguments:** the cosine of the view and its azimuth in radians; the sampler's parameters. The cells are graded
    toward the normal of the half vectors, so lobes of every width fill many of them; one more holds the light below the
    horizon.
    """
    from scipy.special import chdtrc

    view = views([cosine], azimuth)[0]
    random = np.random.default_rng(seed)
    counted = _counted(view, sampler.sample(view, random.random((samples, 2)), **values), azimuth)
    expected = samples * _expected(sampler, view, azimuth, values)
    enough = expected >= FEWEST
    observed = np.append(counted[enough], samples - counted[enough].sum())
    wanted = np.append(expected[enough], samples - expected[enough].sum())
    if wanted[-1] < FEWEST:  # the rest goes to the last cell, as a few samples say nothing by themselves
        observed, wanted = (np.append(each[:-2], each[-2:].sum()) for each in (observed, wanted))
    statistic = float(np.sum((observed - wanted) ** 2 / wanted))
    freedom = len(wanted) - 1
    return ChiSquare(statistic, freedom, float(chdtrc(freedom, statistic)))


def sampling(model: Model, setting: Setting, seed: int) -> Law:
    """The smallest chance among views, times their number, that the model's samples follow their density."""
    azimuths = (0.0, 0.6) if model.reflectance.has(W) else (0.0,)
    tries = [(cosine, azimuth) for cosine in COSINES for azimuth in azimuths]
    sampler = sampler_for(model)
    found = [
        chi_square(sampler, cosine, azimuth, seed=seed + number, **setting)
        for number, (cosine, azimuth) in enumerate(tries)
    ]
    at = int(np.argmin([each.chance for each in found]))
    chance = min(1.0, found[at].chance * len(tries))
    place = {"view": degrees(tries[at][0]), "view's azimuth": math.degrees(tries[at][1]), **setting}
    whose = f"sampler {model.sampler} and the cosine's" if model.sampler else "the sampler for any model"
    remark = f"{whose}; chi-square {found[at].statistic:.0f} with {found[at].freedom} degrees of freedom"
    measure = "chance that samples as far from their density come from it"
    return Law("sampling", verdict(chance >= CHANCE), measure, chance, CHANCE, place, remark)


def agreement(exact: Albedo, drawn: Albedo, setting: Setting) -> Law:
    """How many standard deviations the albedo by samples is from that by quadrature, at the worst angle."""
    with np.errstate(invalid="ignore", divide="ignore"):
        apart = np.maximum(np.abs(drawn.values - exact.values) - exact.errors, 0)
        deviations = np.where(apart <= 1e-12, 0, apart / drawn.errors)
    deviations = np.where(np.isnan(deviations), np.inf, deviations)
    at = int(np.argmax(deviations))
    place = {"view": degrees(exact.cosines[at]), **setting}
    remark = f"{drawn.values[at]:.4g} by samples, {exact.values[at]:.4g} by quadrature"
    measure = "standard deviations between the albedo by samples and by quadrature"
    found = float(deviations[at])
    return Law("Monte Carlo", verdict(found <= DEVIATIONS), measure, found, DEVIATIONS, place, remark)


def _counted(view: Any, light: Any, azimuth: float) -> Any:
    """How many lights above the horizon lie in each cell."""
    above = light[light[:, 2] > 0]
    theta, phi, edge = coordinates(view, above, azimuth)
    around = azimuth_panels(azimuth, whole=True)
    number = panel_of(around, phi)
    feet, reaches = (np.array([getattr(each, part) for each in around])[number] for part in ("foot", "reach"))
    across = _cell(type(around[0])(feet, reaches, around[0].folds).inverse(phi), ACROSS)
    near, far = polar_panels(edge)
    along = np.where(theta < edge / 2, _cell(near.inverse(theta), NEAR), NEAR + _cell(far.inverse(theta), FAR))
    cells = (number * ACROSS + across) * (NEAR + FAR) + along
    return np.bincount(cells, minlength=len(around) * ACROSS * (NEAR + FAR))


def _cell(y: Any, count: int) -> Any:
    return np.clip((np.nan_to_num(y) * count).astype(int), 0, count - 1)


def _expected(sampler: Sampler | Blend, view: Any, azimuth: float, values: dict[str, Any]) -> Any:
    """The integral of the density over each cell."""
    found = []
    y_phi, w_phi = _cell_nodes(ACROSS)
    for around in azimuth_panels(azimuth, whole=True):
        phi = around.place(y_phi)[:, None]
        across = (w_phi * around.slope(y_phi))[:, None]
        parts = []
        for panel, count in zip(polar_panels(horizon_of(view[2], phi)), (NEAR, FAR), strict=True):
            y, w = _cell_nodes(count)
            light, stretch = lights(view, panel.place(y), phi, azimuth)
            share = sampler.density(view, light, **values) * stretch * across * w * panel.slope(y)
            parts.append(share.reshape(ACROSS, ORDER, count, ORDER).sum(axis=(1, 3)))
        found.append(np.concatenate(parts, axis=1).ravel())
    return np.concatenate(found)


def _cell_nodes(count: int) -> tuple[Any, Any]:
    """Gauss's nodes and weights in each of `count` equal parts of [0, 1]."""
    y, w = unit_gauss(ORDER)
    return ((np.arange(count)[:, None] + y) / count).ravel(), np.tile(w / count, count)
