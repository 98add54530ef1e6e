"""Masking and shadowing: section 4.3 of schlick1994."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import sympy as sp

from ratfit._target import parameter
from ratfit.brdf import masking
from ratfit.claims._agreement import ZERO, Above
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import hemisphere, over_pairs, turned
from ratfit.claims._models import LETTERS, V_PRIME, T, U, V
from ratfit.claims._numbers import largest, midpoints, values

M, ALPHA, N = parameter("m", "1/100", "1/2"), parameter("alpha", "1/100", 1), parameter("n", 0, 1000)

SLOPES = (0.01, 0.05, 0.1, 0.25, 0.5)
"""The m of Figures 6 and 7."""

OneSided = Callable[[sp.Expr, sp.Expr], sp.Expr]


def slope_jump(formula: sp.Expr) -> float:
    """How far the slope of a G jumps as the light moves in the plane of N and a view at 60 degrees."""
    import numpy as np

    view, light = np.pi / 3, np.linspace(-1.5, 1.5, 200_001)
    t, u = np.cos((view + light) / 2), np.cos((view - light) / 2)
    at = dict(zip(LETTERS, (t, u, np.cos(view), np.cos(light), np.ones_like(t)), strict=True))
    return float(np.abs(np.diff(np.diff(values(formula, at)) / (light[1] - light[0]))).max())


def turned_by(formula: sp.Expr, both: bool) -> float:
    """How far a G changes at most when the view, or view and light, are turned about the normal by 40 degrees."""
    import numpy as np

    before, after = (values(formula, dict(zip(LETTERS, letters, strict=True))) for letters in turned(40, both))
    return float(np.abs(after - before).max())


def apart(a: sp.Expr, b: sp.Expr, roughness: sp.Symbol, settings: tuple[float, ...]) -> float:
    """How far two functions of v are apart at most, at any of the roughnesses."""
    return max(largest(a - b, {V: midpoints(), roughness: setting}) for setting in settings)


def from_area(density: sp.Expr, v: Any) -> Any:
    """The true G1 of a distribution in t: the visible part v of the area of all facets that face the viewer."""
    import numpy as np

    normals, weights = hemisphere()
    spread = values(density, {T: normals[:, 2]}) * weights
    views = np.stack([np.sqrt(1 - v**2), np.zeros_like(v), v], -1)
    return np.array([each[2] / (np.maximum(normals @ each, 0) * spread).sum() for each in views])


def off_from_area(one_sided: OneSided, density: OneSided, roughness: float) -> float:
    """How far a G1 is from the true one of its distribution at most, over eight angles."""
    import numpy as np

    v, rough = midpoints(count=8), sp.Float(roughness, 17)
    return float(np.abs(values(one_sided(V, rough), {V: v}) - from_area(density(T, rough), v)).max())


def towards_the_horizon(faster: bool) -> float:
    """What Eq. 16 comes to as view and light sink to opposite sides, in one plane: together, or the light faster."""
    low = sp.Rational(1, 10**9)
    view, light = sp.acos(low), sp.acos(low**2 if faster else low)
    at = {T: sp.cos((view - light) / 2), U: sp.cos((view + light) / 2), V: sp.cos(view), V_PRIME: sp.cos(light)}
    return float(sp.N(masking.torrance_sparrow_as_printed(*at).subs(at), 40))


def outside_of_shares() -> float:
    """How far Eqs. 16 to 19, as printed, are outside [0, 1] at most, over pairs of directions."""
    import numpy as np

    products = [masking.separable(each, V, V_PRIME, M) for each in (masking.smith_as_printed, masking.schlick)]
    found = np.stack([over_pairs(each, m=m) for each in products for m in SLOPES])
    grooves = over_pairs(masking.torrance_sparrow_as_printed(T, U, V, V_PRIME))
    found = np.concatenate([found.ravel(), grooves])
    return float(max(found.max() - 1, -found.min(), 0))


@functools.cache
def torrance() -> sp.Expr:
    """Eq. 16."""
    return masking.torrance_sparrow(T, U, V, V_PRIME)


CLAIMS = (
    Claim(
        "S-16-kink",
        "Section 4.3",
        "the slope of Eq. 16 jumps",
        Above(0.0, 0.1),
        lambda: slope_jump(torrance()),
        how="the greatest jump as the light moves in the plane of a view at 60 degrees",
    ),
    Claim(
        "S-16-rotation",
        "Section 4.3",
        "Eq. 16 is not invariant under rotation about the normal",
        Above(0.0, 0.1),
        lambda: turned_by(torrance(), both=True),
        readings=(
            Reading(
                "the view alone is turned: Eq. 16 depends on the difference of the azimuths, as Eq. 17 does not; "
                "turned together, view and light leave it as it is",
                lambda: turned_by(torrance(), both=False),
            ),
        ),
    ),
    Claim(
        "S-16-roughness",
        "Section 4.3",
        "Eq. 16 does not depend on roughness",
        0,
        lambda: len(torrance().free_symbols - set(LETTERS)),
        how="the number of its parameters",
    ),
    Claim(
        "S-16-horizon",
        "Eq. 16",
        "(implied) Eq. 16 has a value for every pair of directions, u = 0 included",
        ZERO,
        lambda: abs(towards_the_horizon(faster=False) - towards_the_horizon(faster=True)),
        instead=Reading(
            "at u = 0 it is 0/0 without a limit: on the way there it is 1 where view and light are mirror directions, "
            "and comes to 0 where one sinks faster than the other",
            lambda: abs(towards_the_horizon(faster=False) - 1) < 1e-6 and towards_the_horizon(faster=True) < 1e-6,
        ),
    ),
    Claim(
        "S-4-G-range",
        "Eqs. 4, 16 to 19",
        "the geometrical attenuation is a share, in [0, 1]",
        ZERO,
        outside_of_shares,
        how="how far Eqs. 16, 18 and 19 are outside at most, over pairs of directions and the m of Figure 6",
    ),
)
