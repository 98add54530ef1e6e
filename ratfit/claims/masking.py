"""Masking and shadowing: section 4.3 of schlick1994."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import sympy as sp

from ratfit._target import parameter
from ratfit.brdf import masking
from ratfit.claims._agreement import AtLeast, AtMost
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import hemisphere, turned
from ratfit.claims._models import LETTERS, V_PRIME, T, U, V
from ratfit.claims._numbers import largest, midpoints, values
from ratfit.claims.method import derived
from ratfit.gallery import card

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


def worst_place(m: float) -> float:
    """The cosine v at which Eq. 19 is farthest from Eq. 18."""
    import numpy as np

    v = midpoints()
    error = values(masking.schlick(V, M) - masking.smith_as_printed(V, M), {V: v, M: m})
    return float(v[np.argmax(np.abs(error))])


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


def slope_at_grazing(formula: sp.Expr) -> float:
    """m times a function's slope at v = 0, at m = 1/4."""
    tiny = 1e-7
    return float(values(formula, {V: tiny, M: 0.25}) / tiny) / 4


def worst_away_from_normal() -> float:
    """The greatest difference of Eqs. 19 and 18 for v up to 0.9, at the m of Figure 6."""
    v = midpoints(0, 0.9)
    return max(largest(masking.schlick(V, M) - masking.smith_as_printed(V, M), {V: v, M: m}) for m in SLOPES)


def height_ratio() -> sp.Expr:
    """Beckmann's alpha for which Walter's a is the root of h of Eq. 18, over m."""
    alpha, tangent = sp.Symbol("alpha", positive=True), sp.Symbol("tan", positive=True)
    (found,) = sp.solve(1 / (alpha * tangent) - 1 / sp.sqrt(2 * M**2 * tangent**2), alpha)
    return sp.simplify(found / M)


def roughest_of_product(one_sided: OneSided) -> float:
    """The greatest jump of the slope of G(v) G(v') and its greatest change when the view is turned, at m = 1/4."""
    product = masking.separable(one_sided, V, V_PRIME, sp.Rational(1, 4))
    return max(slope_jump(product), turned_by(product, both=False))


@functools.cache
def torrance() -> sp.Expr:
    """Eq. 16."""
    return masking.torrance_sparrow(T, U, V, V_PRIME)


def _target() -> Any:
    return card("smith").problem.target


CLAIMS = (
    Claim(
        "S-16-kink",
        "Section 4.3",
        "the slope of Eq. 16 jumps",
        AtLeast(0.1),
        lambda: slope_jump(torrance()),
        how="the greatest jump as the light moves in the plane of a view at 60 degrees",
    ),
    Claim(
        "S-16-rotation",
        "Section 4.3",
        "Eq. 16 is not invariant under rotation about the normal",
        AtLeast(0.1),
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
        "S-17-smooth",
        "Section 4.3",
        "Smith's product depends on v and v' alone and is not subject to the restrictions of Eq. 16",
        AtMost(0.01),
        lambda: roughest_of_product(masking.smith_as_printed),
        how="the greatest jump of its slope, and its change when the view is turned, at m = 1/4",
        readings=(
            Reading(
                "with Smith's own function in place of Eq. 18, whose slope jumps where the light passes the normal",
                lambda: roughest_of_product(masking.smith),
            ),
        ),
    ),
    Claim(
        "S-18-smith",
        "Eq. 18",
        "Eq. 18 is Smith's function, written more compactly",
        0,
        lambda: apart(masking.smith_as_printed(V, M), masking.smith(V, M), M, SLOPES),
        instead=Reading(
            "Smith's function is g/(g + exp(-h)), Eq. 18 has 1 in place of the exponential; the two have one value and "
            "slope at v = 0, and the found number is how far they are apart at most",
            lambda: (
                abs(slope_at_grazing(masking.smith(V, M)) - slope_at_grazing(masking.smith_as_printed(V, M))) < 1e-6
            ),
        ),
    ),
    Claim(
        "S-18-m",
        "Sections 4.3, 4.4",
        "the m of Eq. 18 and the m of Eq. 20 are the same RMS slope",
        1,
        height_ratio,
        instead=Reading(
            "m is the slope along one axis in Eq. 18 and the slope in two dimensions in Eq. 20, sqrt(2) times that",
            lambda: bool(height_ratio() == sp.sqrt(2)),
        ),
    ),
    Claim(
        "S-4.3-half",
        "Section 4.3",
        "the slope m is almost never above 0.5 for real surfaces",
        AtMost(0.5),
        None,
        open="a statement on surfaces, for which the source gives no measurement",
    ),
    Claim(
        "S-4.3-G0",
        "Section 4.3",
        "first condition: G(0) = 0",
        0,
        lambda: float(values(masking.smith_as_printed(V, M), {V: 0.0, M: 0.25})),
        how="Eq. 18 at m = 1/4",
    ),
    Claim(
        "S-4.3-G1",
        "Section 4.3",
        "second condition: G(1) = 1",
        1,
        lambda: _target().limit(sp.S.One, sp.S.One, sp.S.Zero),
        how="the limit of Eq. 18, for any m",
    ),
    Claim(
        "S-4.3-dG0",
        "Section 4.3",
        "third condition: G'(0) = sqrt(pi/(2 m^2))",
        sp.sqrt(sp.pi / 2) / M,
        lambda: _target().derivative(sp.S.Zero, 1),
        how="the limit of Eq. 18's derivative, for any m",
    ),
    Claim(
        "S-19",
        "Eq. 19",
        "the three conditions lead to v/(v - k v + k) with k = sqrt(2 m^2/pi)",
        lambda: card("eq19").published,
        lambda: derived("eq19").chosen,
        how="derived anew from the conditions",
    ),
    Claim(
        "S-19-similar",
        "Section 4.3, Figure 6",
        "but for a small neighbourhood of v = 1, Eq. 19 and Eq. 18 are very similar",
        AtMost(0.05),
        worst_away_from_normal,
        how="greatest difference for v up to 0.9",
        instead=Reading(
            "for small m the greatest difference is near v = 0: for m up to 1/4 it lies below v = 0.25, and at v = 0.9 "
            "and above for m = 1/2 it is less than half as great; very similar is taken as within 0.05",
            lambda: (
                all(worst_place(m) < 0.25 for m in SLOPES[:-1])
                and 2 * apart(masking.schlick(V, M), masking.smith_as_printed(V, M), M, SLOPES[-1:])
                < worst_away_from_normal()
            ),
        ),
    ),
    Claim(
        "S-31",
        "Eq. 31",
        "Eq. 31 is the approximated Smith factor of Eq. 19",
        lambda: masking.schlick(V, M),
        lambda: masking.schlick_roughness(V, parameter("r", 0, 1)),
        readings=(
            Reading(
                "with r in the place of k, so that r = sqrt(2/pi) m",
                lambda: masking.schlick_roughness(V, sp.sqrt(2 / sp.pi) * M),
            ),
        ),
    ),
)
