"""Integrals over directions: what a reflectance sends back in all, and pairs of directions to compare formulas on."""

from __future__ import annotations

import functools
from typing import Any

import sympy as sp

from ratfit._lower import lower
from ratfit.claims._models import LETTERS, cosines

HEIGHTS, AZIMUTHS = 300, 240

PAIRS = 40_000


def albedo(reflectance: sp.Expr, view: float, **parameters: float) -> float:
    """The share of light that is reflected: the integral of reflectance times the light's cosine over the light.

    Arguments: the reflectance in the letters of `ratfit.models.directions` and in parameters; the cosine of the angle
    of view, in (0, 1], the view in the plane of the tangent; the parameters' values by name. Gauss-Legendre in the
    light's height and midpoints in its azimuth: right to 1e-4 for lobes that are not narrower than 0.2.
    """
    import numpy as np

    directions, weights = hemisphere()
    letters = _letters(reflectance, view, directions)
    symbols = sorted(reflectance.free_symbols - set(LETTERS), key=lambda symbol: symbol.name)
    function = lower(reflectance, [*LETTERS, *symbols], "numpy")
    known = (np.float64(parameters[symbol.name]) for symbol in symbols)
    return float((function(*letters, *known) * letters[3] * weights).sum())


def _letters(reflectance: sp.Expr, view: float, directions: Any) -> tuple[Any, ...]:
    import numpy as np

    towards = np.broadcast_to([np.sqrt(1 - view**2), 0.0, view], directions.shape)
    return cosines(towards, directions)


@functools.cache
def hemisphere() -> tuple[Any, Any]:
    """Directions over the hemisphere and the solid angle of each; heights crowd at the horizon."""
    import numpy as np

    own, weight = np.polynomial.legendre.leggauss(HEIGHTS)
    x, share = (own + 1) / 2, weight / 2
    height = x**2 * (3 - 2 * x)
    share = share * 6 * x * (1 - x)
    azimuth = 2 * np.pi * (np.arange(AZIMUTHS) + 0.5) / AZIMUTHS
    z, phi = height[:, None], azimuth[None, :]
    sine = np.sqrt((1 - z) * (1 + z))
    directions = np.stack([sine * np.cos(phi), sine * np.sin(phi), np.broadcast_to(z, (HEIGHTS, AZIMUTHS))], -1)
    weights = np.broadcast_to(share[:, None] * 2 * np.pi / AZIMUTHS, (HEIGHTS, AZIMUTHS))
    return directions.reshape(-1, 3), weights.ravel()


@functools.cache
def ends() -> tuple[Any, Any]:
    """Views and lights, both uniform over the hemisphere; a fixed draw."""
    import numpy as np

    draw = np.random.default_rng(1994)
    ends = []
    for _ in range(2):
        height, phi = draw.random(PAIRS), 2 * np.pi * draw.random(PAIRS)
        sine = np.sqrt(1 - height**2)
        ends.append(np.stack([sine * np.cos(phi), sine * np.sin(phi), height], -1))
    return ends[0], ends[1]


@functools.cache
def pairs() -> tuple[Any, ...]:
    """t, u, v, v' and w of pairs of directions."""
    return cosines(*ends())


def turned(degrees: float, both: bool) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """The letters of all pairs before and after the view, or view and light, are turned about the normal."""
    import numpy as np

    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    view, light = ends()
    return pairs(), cosines(view @ turn.T, light @ turn.T if both else light)


def over_pairs(expression: sp.Expr, **parameters: Any) -> Any:
    """A formula in the letters at all pairs of directions; parameters by name, numbers or an array over the pairs."""
    import numpy as np

    symbols = sorted(expression.free_symbols - set(LETTERS), key=lambda symbol: symbol.name)
    function = lower(expression, [*LETTERS, *symbols], "numpy")
    return function(*pairs(), *(np.asarray(parameters[symbol.name], float) for symbol in symbols))
