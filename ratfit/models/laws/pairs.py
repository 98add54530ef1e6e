"""Pairs of directions to measure at: everywhere, near the mirror's direction, near the horizon, and the very limits."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np

from ratfit.models.samplers import ANY

COSINES = (1.0, 1 - 1e-8, 0.7, 0.1, 1e-3, 1e-8, 1e-20, 0.0, -0.5)
AZIMUTHS = (0.0, 1.0, math.pi / 2, math.pi)


def random_pairs(count: int, seed: int, least: float = 1e-3) -> tuple[Any, Any]:
    """Unit views and lights above the horizon, a half of the lights as lobes send them, a quarter of each near it.

    `least` is the smallest cosine to the normal that a direction near the horizon has.
    """
    random = np.random.default_rng(seed)
    view = _directions(random, count, least)
    light = _directions(random, count, least)
    sent = ANY.sample(view, random.random((count, 2)))
    light = np.where((np.arange(count) % 2 == 0)[:, None] & (sent[:, 2:] >= least), sent, light)
    return view, light


def limit_pairs() -> tuple[Any, Any]:
    """Every pair of directions at the limits: the normal, nearly the normal, near, at and below the horizon."""
    made = [_direction(cosine, azimuth) for cosine in COSINES for azimuth in AZIMUTHS]
    pairs = list(itertools.product(made, made))
    return np.array([view for view, _ in pairs]), np.array([light for _, light in pairs])


def _directions(random: Any, count: int, least: float) -> Any:
    share = random.random(count)
    cosines = np.where(np.arange(count) % 4 == 1, least ** (1 - share), np.maximum(share, least))
    sines, azimuths = np.sqrt((1 - cosines) * (1 + cosines)), 2 * math.pi * random.random(count)
    return np.stack([sines * np.cos(azimuths), sines * np.sin(azimuths), cosines], axis=-1)


def _direction(cosine: float, azimuth: float) -> tuple[float, float, float]:
    sine = math.sqrt((1 - cosine) * (1 + cosine))
    return sine * math.cos(azimuth), sine * math.sin(azimuth), cosine
