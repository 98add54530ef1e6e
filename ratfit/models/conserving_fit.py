"""The coefficients of `_hidden`, by two linear programmes: `python -m ratfit.models.conserving_fit` prints them.

The albedo of facets is computed on a grid of roughness, isotropy, azimuth and cosine. What is hidden is bounded from
below, what a layer without a colour of its own reflects from above, so that nothing is reflected twice; under that the
greatest loss of light, weighted as the model weights it, is made as small as it can be, and with a small weight the
mean loss too. The margins are for the rounding of the coefficients and for what lies between the points of the grid.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ratfit._parse import RatfitError
from ratfit.models._half_sphere import horizon, unit_gauss
from ratfit.models._hidden import ENDS, STEEPNESS, Powers

ALPHA = (0.01, 0.03, 0.06, 0.1, 0.15, 0.22, 0.3, 0.4, 0.47, 0.52, 0.57, 0.65, 0.75, 0.85, 0.95, 1.0)
ISOTROPY = (0.001, 0.03, 0.07, 0.13, 0.22, 0.35, 0.48, 0.6, 0.75, 0.88, 1.0)
AZIMUTHS = tuple(math.radians(15 * k) for k in range(7))
COSINES = (*(math.cos(math.pi / 2 * 0.97 * k / 13) for k in range(14)), 0.02, 0.005, 0.001, 1e-6)

MARGIN, SHARE = 4e-4, 0.02
"""How far the bounds are kept from: `MARGIN`, or that share of what is hidden, where it is less than that."""

DECIMALS = 5
MEAN_WEIGHT = 1e-2
"""The weight of the mean loss, that of the greatest being 1."""

ACROSS_POWERS: tuple[Powers, ...] = tuple(itertools.product(range(3), range(3), range(2)))
ALONG_POWERS: tuple[Powers, ...] = tuple(itertools.product(range(3), range(3), [0]))
SHEEN_POWERS: tuple[Powers, ...] = tuple(itertools.product([0, 3], range(2), [0]))

POLAR, POLAR_GRADING, AROUND, MOST_AROUND = 40, 2.5, 96, 400
"""Nodes of the quadrature: along a power of the polar angle, and around, more of them where the scratches are fine."""


@dataclass(frozen=True)
class Grid:
    """Points in one row: v, azimuth, alpha, p; and there the albedo of white facets, and of those with (1 - u)^5."""

    v: Any
    azimuth: Any
    alpha: Any
    p: Any
    white: Any
    grazing: Any

    @property
    def weights(self) -> tuple[Any, Any]:
        """a and b of schlick1994, Eq. 33."""
        r = self.alpha**2
        return np.where(r >= 0.5, (1 - 2 * r) ** 2, 0), 4 * r * (1 - r)

    @property
    def hidden(self) -> Any:
        return 1 - self.white


def lobes(v: Any, azimuth: Any, alpha: float, p: float) -> tuple[Any, Any]:
    """The albedo of the facets of `conserving`, without their weight b, white ones and those with S(u) = (1 - u)^5.

    Half vectors are drawn as their distribution has it, tan(theta) = alpha tan(chi), up to the horizon of the light.
    **Arguments:** cosines and azimuths of views, arrays of one axis.
    """
    around = int(min(MOST_AROUND, max(AROUND, 14 / math.sqrt(p)))) // 4 * 4
    b, step = (np.arange(around) + 0.5) / around * 2 * np.pi, math.sqrt(p)
    part = step / (np.cos(b) ** 2 + p * np.sin(b) ** 2) / around
    delta = np.arctan2(np.sin(b), step * np.cos(b))[None, :, None] - azimuth[:, None, None]
    v = v[:, None, None]
    y, weight = unit_gauss(POLAR)
    edge = horizon(v, delta)
    edge = np.arctan2(np.sin(edge), alpha * np.cos(edge))
    chi, stretch = edge * y**POLAR_GRADING, edge * POLAR_GRADING * y ** (POLAR_GRADING - 1) * weight
    tangent = alpha * np.tan(chi)
    t = 1 / np.sqrt(1 + tangent**2)
    u = v * t + np.sqrt(1 - v * v) * tangent * t * np.cos(delta)
    lit = np.maximum(2 * u * t - v, 0)
    k = alpha / (1 + p)
    masked = lit / ((v + k * (1 - v)) * (lit + k * (1 - lit)))
    value = np.sin(2 * chi) * stretch * u / t * masked * part[None, :, None]
    return np.sum(value, axis=(1, 2)), np.sum(value * (1 - u) ** 5, axis=(1, 2))


def grid(alphas: Sequence[float] = ALPHA, isotropies: Sequence[float] = ISOTROPY) -> Grid:
    """The albedos at every point of a grid: some ten seconds for the one that the programmes take."""
    v, azimuth = (each.ravel() for each in np.meshgrid(COSINES, AZIMUTHS))
    made = [(alpha, p, *lobes(v, azimuth, alpha, p)) for alpha in alphas for p in isotropies]
    rows = [np.stack([v, azimuth, 0 * v + alpha, 0 * v + p, *both]) for alpha, p, *both in made]
    return Grid(*np.concatenate(rows, axis=1))


def fit_hidden(points: Grid) -> tuple[Mapping[Powers, float], Mapping[Powers, float], float]:
    """The coefficients of `across` and `along`, and the greatest loss.

    Where p = 1, as most materials have it, it counts four times as much as where p = 0.
    """
    v, p, r = points.v, points.p, points.alpha**2
    over = r / (r + float(ENDS)) / (v + r)
    across, shape = (over * _terms(each, v, points.alpha, p) for each in (ACROSS_POWERS, ALONG_POWERS))
    along = (1 - p) * shape
    terms = np.concatenate([across, along * (1 - v * v) * np.cos(points.azimuth) ** 2])
    weight = (1 + 3 * p) * points.weights[1]
    no_across, no_along = np.zeros_like(across), np.zeros_like(along)
    positive = [
        np.concatenate(each)
        for each in ((-across, along / 2), (-across, no_along), (no_across, -shape))  # half: the most `share` can be
    ]
    bound = points.hidden - np.minimum(MARGIN, SHARE * points.hidden)
    found, loss = _least_loss(terms, bound, weight, np.concatenate(positive, axis=1), 0.0)
    count = len(ACROSS_POWERS)
    return _named(ACROSS_POWERS, found[:count]), _named(ALONG_POWERS, found[count:]), loss


def fit_sheen(points: Grid) -> tuple[Mapping[Powers, float], float]:
    """The coefficients of `sheen`, which is at most 1, and its greatest excess."""
    a, b = points.weights
    again = (1 / 21) ** 2 * points.hidden
    bound = (b * (points.grazing + again) + a * diffuse_grazing(points.v)) / (a + b)
    terms = _terms(SHEEN_POWERS, 1 - points.v, points.alpha, points.p) / (1 + STEEPNESS * points.alpha)
    found, loss = _least_loss(-terms, -bound - MARGIN, a + b, terms, 1.0)
    return _named(SHEEN_POWERS, found), loss


def diffuse_grazing(v: Any) -> Any:
    """The albedo of the reflectance (1 - u)^5/pi."""
    x, weight = unit_gauss(40)
    delta = (np.arange(64) + 0.5) / 64 * np.pi
    v = v[:, None, None]
    product = v * x + np.sqrt(1 - v * v) * np.sqrt(1 - x * x) * np.cos(delta)[:, None]
    return np.sum((1 - np.sqrt(np.maximum((1 + product) / 2, 0))) ** 5 * 2 * x * weight, axis=(1, 2)) / 64


def _least_loss(terms: Any, bound: Any, weight: Any, held: Any, limit: float) -> tuple[Any, float]:
    """The coefficients whose sum of terms is nowhere above a bound and least far below, and the greatest distance.

    **Arguments:** terms, of shape (coefficients, points); their bound, and what the distance from it is multiplied by;
    `held`, other sums of terms, no greater than `limit`. **Fails** with `RatfitError` where there are none.
    """
    from scipy.optimize import linprog  # half a second, which no model needs

    none, one = np.zeros(held.shape[1]), np.ones(terms.shape[1])
    rows = [np.vstack([terms, 0 * one]), np.vstack([-weight * terms, -one]), np.vstack([held, none])]
    limits = np.concatenate([bound, -weight * bound, none + limit])
    cost = np.append(-MEAN_WEIGHT * np.mean(weight * terms, axis=1), 1.0)
    free = [(None, None)] * len(terms) + [(0, None)]
    answer = linprog(cost, np.concatenate(rows, axis=1).T, limits, bounds=free, method="highs")
    if answer.x is None:
        raise RatfitError(f"no coefficients keep the bound: {answer.message}; give fewer margins or more terms")
    return answer.x[:-1], float(answer.x[-1])


def _terms(powers: Sequence[Powers], v: Any, alpha: Any, p: Any) -> Any:
    return np.stack([v**i * alpha**j * p**k for i, j, k in powers])


def _named(powers: Sequence[Powers], values: Any) -> dict[Powers, float]:
    return {each: round(float(value), DECIMALS) for each, value in zip(powers, values, strict=True)}


def _lines(table: Mapping[Powers, float]) -> list[list[str]]:
    entries = [f'{powers}: "{value:.{DECIMALS}f}"' for powers, value in table.items()]
    return [entries[k : k + 4] for k in range(0, len(entries), 4)]


def main() -> None:
    """Prints the tables of `_hidden` and how much light is lost, weighted."""
    points = grid()
    across, along, loss = fit_hidden(points)
    sheen, excess = fit_sheen(points)
    for name, table in (("ACROSS", across), ("ALONG", along), ("SHEEN", sheen)):
        print(f"{name} = _exact({{")
        for line in _lines(table):
            print(f"    {', '.join(line)},")
        print("})")
    print(f"# lost of white light, over 1 + 3 p: {loss:.4f}; sheen, at most too great by {excess:.4f}")


if __name__ == "__main__":
    main()
