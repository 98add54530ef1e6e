"""Directional albedo: the share of light from one direction that a model reflects into all, by two ways.

Because a reflectance without the cosine is integrated with the cosine of the other direction, it is also the share of
white surroundings that comes back toward a viewer; models that are not reciprocal have it for the view they are given.
"""

from __future__ import annotations

import math
import numbers
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ratfit._lower import lower
from ratfit._parse import RatfitError
from ratfit.models import named
from ratfit.models._half_sphere import Nodes, facet_nodes, light_nodes, views
from ratfit.models._model import Model
from ratfit.models.directions import LETTERS, W, as_floats
from ratfit.models.samplers import Blend, Sampler, as_blend, sampler_for

ANGLES = 64
TOLERANCE = 1e-4
ORDER, FINEST = 6, 24
"""Nodes along the azimuth of a panel: at first, and at most; those along theta go with them."""

DISTRUST = 0.1
"""The share of the difference between two ways that the better one is held to be off by, at least."""

AT_ONCE = 60_000
"""Pairs of directions in one call: what stays in a processor's cache."""

_Rule = Callable[[Any, float, int, bool], Nodes]


@dataclass(frozen=True)
class Albedo:
    """Albedos at the cosines of views, and how far each may be off: estimated, or one standard deviation."""

    cosines: Any
    values: Any
    errors: Any


def angles(count: int = ANGLES) -> Any:
    """Cosines of that many zenith angles from 0 to nearly 90 degrees (89.97 for 64), closer together at the horizon."""
    count = _whole(count, "count", 1)
    return np.cos(math.pi / 2 * np.sin(math.pi / 2 * np.arange(count) / count))


def albedo(
    model: str | Model, cosines: Any = None, *, azimuth: float = 0.0, tolerance: float = TOLERANCE, **values: Any
) -> Albedo:
    """The directional albedo by quadrature, with the coherent share.

    **Arguments:** `model`, or its name; `cosines` of the view to the normal, in (0, 1], those of `angles()` where left
    out; `azimuth` of the view against the tangent, in radians; `tolerance`, the error at which an angle is done;
    `values`, one number for each parameter, those left out at their defaults.

    **Returns** the albedos. Each error is the change that came with the last doubling of the nodes, along half vectors
    or along the light's own angles, whichever changes less; it stays above the tolerance where a model jumps (a
    threshold), has no integral, or has a lobe narrower than a ten-thousandth of a radian. An estimate, not a bound:
    where a model jumps the error may be several times as great.
    **Fails** with `RatfitError` for a name of no model, for cosines outside (0, 1] and for parameters that are not one
    number.
    """
    model = named(model)
    cosines, known = _checked(model, cosines, azimuth, values)
    if not tolerance > 0:
        raise RatfitError(f"tolerance = {tolerance}: give a number above 0")
    whole = model.reflectance.has(W) and abs(math.sin(2 * azimuth)) > 1e-9
    ask = _Question(model, azimuth, whole, known)
    found, errors = _doubled(ask, facet_nodes, cosines)
    unfinished = errors > tolerance * np.maximum(1, found)
    other, other_errors = _doubled(ask, light_nodes, cosines[unfinished])
    is_better = np.zeros(found.shape, bool)
    apart = np.abs(other - found[unfinished])
    agree = apart <= errors[unfinished] + tolerance  # nodes may miss a lobe twice
    other_errors = np.maximum(other_errors, DISTRUST * apart)  # or change little by chance, where a model jumps
    is_better[unfinished] = agree & (other_errors < errors[unfinished])
    found[is_better], errors[is_better] = other[is_better[unfinished]], other_errors[is_better[unfinished]]
    for nodes, mine in ((facet_nodes, ~is_better), (light_nodes, is_better)):
        left = mine & (errors > tolerance * np.maximum(1, found))
        finest = ask.integral(nodes, cosines[left], FINEST)
        found[left], errors[left] = finest, np.abs(finest - found[left])
    return Albedo(cosines, found + _coherent(model, cosines, known), errors)


def monte_carlo_albedo(
    model: str | Model,
    cosines: Any = None,
    *,
    samples: int = 20_000,
    seed: int = 0,
    azimuth: float = 0.0,
    sampler: str | Sampler | Blend | None = None,
    **values: Any,
) -> Albedo:
    """The same by importance sampling, with one standard deviation for each angle.

    **Arguments:** as in `albedo`; `samples` for each angle, two at least, for a deviation needs two; `seed`; `sampler`,
    or its name, that of `sampler_for` where left out.
    """
    model = named(model)
    cosines, known = _checked(model, cosines, azimuth, values)
    samples, seed = _whole(samples, "samples", 2), _whole(seed, "seed", 0)
    sampler = sampler_for(model) if sampler is None else as_blend(sampler)
    random = np.random.default_rng(seed)
    means, deviations = [], []
    for view in views(cosines, azimuth)[:, None, :]:
        weights = sampler.weight(model, view, sampler.sample(view, random.random((samples, 2)), **known), **known)
        with np.errstate(over="ignore", invalid="ignore"):  # of a model that is infinite somewhere
            means.append(weights.mean())
            deviations.append(weights.std(ddof=1) / math.sqrt(samples))
    return Albedo(cosines, np.array(means) + _coherent(model, cosines, known), np.array(deviations))


def _whole(number: Any, name: str, least: int) -> int:
    """A whole number, which may be written as 1e4. **Fails** with `RatfitError` for others and for too small ones."""
    is_whole = isinstance(number, numbers.Integral) or (isinstance(number, numbers.Real) and float(number).is_integer())
    if not is_whole or int(number) < least:
        raise RatfitError(f"{name} = {number!r}: give a whole number from {least} on")
    return int(number)


def _checked(model: Model, cosines: Any, azimuth: float, values: dict[str, Any]) -> tuple[Any, dict[str, float]]:
    cosines = np.atleast_1d(np.asarray(as_floats(angles() if cosines is None else cosines, "cosines"), float))
    if not (isinstance(azimuth, numbers.Real) and math.isfinite(azimuth)):
        raise RatfitError(f"azimuth = {azimuth!r}: give one number, in radians")
    if cosines.ndim != 1 or not np.all((cosines > 0) & (cosines <= 1)):
        raise RatfitError("the cosines of the views are numbers above 0, up to 1")
    known = model.settings(values)
    for name, value in known.items():
        if np.ndim(value) != 0:
            raise RatfitError(f"{model.name}: {name} is one number here; ask for each colour by itself")
    return cosines, {name: float(value) for name, value in known.items()}


@dataclass(frozen=True)
class _Question:
    model: Model
    azimuth: float
    whole: bool
    known: dict[str, Any]

    def integral(self, nodes: _Rule, cosines: Any, order: int) -> Any:
        """The albedos at some cosines, as many at once as a cache holds."""
        chunk = max(1, AT_ONCE // ((64 if self.whole else 16) * order * order))
        starts = range(0, len(cosines), chunk)
        return np.concatenate([self._chunk(nodes, cosines[k : k + chunk], order) for k in starts] or [np.zeros(0)])

    def _chunk(self, nodes: _Rule, cosines: Any, order: int) -> Any:
        made = nodes(cosines, self.azimuth, order, self.whole)
        value = self.model(views(cosines, self.azimuth)[:, None, :], made.light, **self.known)
        with np.errstate(over="ignore", invalid="ignore"):  # of a model that is infinite somewhere
            return np.sum(value * np.maximum(made.light[..., 2], 0) * made.weight, axis=1)


def _doubled(ask: _Question, nodes: _Rule, cosines: Any) -> tuple[Any, Any]:
    """The integrals with twice the nodes of the first attempt, and what that has changed; nan for what is infinite."""
    coarse, fine = (ask.integral(nodes, cosines, order) for order in (ORDER, 2 * ORDER))
    with np.errstate(invalid="ignore"):
        return fine, np.abs(fine - coarse)


def _coherent(model: Model, cosines: Any, known: dict[str, Any]) -> Any:
    """The mirror's share, its half vector the normal."""
    one = np.ones_like(cosines)
    settings = [known[p.name] for p in model.parameters]
    return lower(model.coherent, [*LETTERS, *model.parameters])(one, cosines, cosines, cosines, one, *settings)
