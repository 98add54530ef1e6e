"""The Fresnel term of the smoothie article: an exponential of L.h, fitted in the middle of its range."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy as sp

from ratfit.brdf import fresnel
from ratfit.claims._agreement import Above, AtLeast, AtMost, Near
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import over_pairs
from ratfit.claims._models import V_PRIME, V
from ratfit.claims._numbers import midpoints, values
from ratfit.claims.fresnel import COMMON, F, Material, U, shape, spread_of_shapes

MIDDLE: Material = COMMON[1]
"""The index 1.4."""

EXPONENTIAL = fresnel.smoothie(U, sp.S.Zero)
POWER = fresnel.schlick(U, sp.S.Zero)
GAUSSIAN = fresnel.spherical_gaussian(U, sp.S.Zero)
"""The three curves from 0 to 1."""


def weighted_error(curve: sp.Expr, material: Material, place: Callable[[Any], Any]) -> float:
    """The RMS error of a curve from 0 to 1 against a material's shape, weighted by N(0.55, 0.12) at place(L.H)."""
    import numpy as np

    u = midpoints()
    weight = np.exp(-(((place(u) - 0.55) / 0.12) ** 2) / 2)
    error = values(curve, {U: u}) - shape(material)
    return float(np.sqrt((weight * error**2).sum() / weight.sum()))


def fitted_exponential(place: Callable[[Any], Any]) -> tuple[float, float]:
    """a and b of 2**(a + b L.h) by weighted least squares, for the index 1.4 and nodes even in L.H.

    place(L.H) is what the weight N(0.55, 0.12) is taken at.
    """
    import numpy as np
    from scipy.optimize import least_squares

    u = midpoints()
    weight = np.exp(-(((place(u) - 0.55) / 0.12) ** 2) / 4)  # its square is the weight
    wanted = shape(MIDDLE)
    found = least_squares(lambda ab: weight * (2 ** (ab[0] + ab[1] * 2 * u**2) - wanted), (-1.7, -5.4), xtol=1e-14)
    return float(found.x[0]), float(found.x[1])


def error_below(limit: float, low: bool) -> float:
    """The greatest error of the exponential for the index 1.4 on one side of L.H = limit."""
    import numpy as np

    u = midpoints()
    error = np.abs(values(EXPONENTIAL, {U: u}) - shape(MIDDLE))
    return float(error[u < limit].max() if low else error[u >= limit].max())


def greatest_mean_height(highest: float) -> float:
    """The greatest (v + v')/2 of all pairs of directions with L.H up to a bound."""
    u, height = over_pairs(U), over_pairs((V + V_PRIME) / 2)
    return float(height[u <= highest].max())


def share_nearer_to_zero() -> float:
    """The share of pairs of directions for which N.V is nearer to 0 than L.H."""
    return float((over_pairs(V) < over_pairs(U)).mean())


def difference(a: sp.Expr, b: sp.Expr, low: float) -> float:
    """How far two curves are apart at most, from L.H = low to 1."""
    import numpy as np

    at = {U: np.linspace(low, 1, 4001)}
    return float(np.max(np.abs(values(a, at) - values(b, at))))


def half(u: Any) -> Any:
    """L.H itself."""
    return u


def unnormalised(u: Any) -> Any:
    """L.h of the half vector that is not normalised: 2 (L.H)^2."""
    return 2 * u**2


def is_better(rival: sp.Expr, place: Callable[[Any], Any], materials: tuple[Material, ...] = COMMON) -> bool:
    """Whether the exponential's weighted error is below a rival's for every index."""
    return all(weighted_error(EXPONENTIAL, m, place) < weighted_error(rival, m, place) for m in materials)


PUBLISHED = (Near(float(fresnel.SMOOTHIE_A), 0.006), Near(float(fresnel.SMOOTHIE_B), 0.006))

CLAIMS = (
    Claim(
        "SM-F-schlick",
        "Fresnel term",
        "Schlick's approximation is 1 + (1 - s)(1 - L.H)^5, s the specular colour",
        fresnel.schlick(U, F),
        lambda: fresnel.schlick_as_printed(U, F),
        how="symbolic",
        instead=Reading(
            "s + (1 - s)(1 - L.H)^5: as printed it is 1 at normal incidence and 2 - s at grazing incidence",
            lambda: fresnel.schlick_as_printed(sp.S.Zero, F) == 2 - F and fresnel.schlick(sp.S.One, F) == F,
        ),
    ),
    Claim(
        "SM-F-gaussian",
        "Fresnel term",
        "exp(-6x) and (1 - x)^5 are similar for large x",
        "similar",
        None,
        readings=(
            Reading(
                "on [1/2, 1] they are apart by at most 0.02", lambda: difference(GAUSSIAN, POWER, 0.5), AtMost(0.02)
            ),
        ),
        open="similar means no number",
    ),
    Claim(
        "SM-F-gaussian-tail",
        "Fresnel term",
        "exp(-6x) does not fall to 0 at x = 1, where the power does",
        Above(0.0, 0.001),
        lambda: GAUSSIAN.subs(U, 1) - POWER.subs(U, 1),
        how="exp(-6)",
    ),
    Claim(
        "SM-F-grazing",
        "Fresnel term",
        "L.H is small only at extremely grazing angles",
        AtMost(0.2),
        lambda: greatest_mean_height(0.2),
        how="the greatest mean of the cosines N.L and N.V where L.H is at most 0.2, over pairs of directions",
        word="extremely grazing",
    ),
    Claim(
        "SM-F-environment",
        "Fresnel term",
        "for environment maps N.V stands in the place of L.H, and is much closer to 0",
        AtLeast(0.75),
        share_nearer_to_zero,
        how="the share of pairs of directions for which it is",
        word="much closer",
    ),
    Claim(
        "SM-F-shapes",
        "Fresnel term",
        "the curves of common dielectrics are roughly one curve, shifted and scaled",
        "roughly one",
        None,
        readings=(
            Reading(
                "scaled to [0, 1], those of the indices 1.33, 1.4 and 1.5 are apart by at most 0.03",
                lambda: spread_of_shapes(COMMON),
                AtMost(0.03),
            ),
        ),
        open="roughly means no number",
    ),
    Claim(
        "SM-F-fit",
        "Fresnel term",
        "least squares for the index 1.4 with the weight N(0.55, 0.12) give a = -1.71983, b = -5.43926",
        PUBLISHED,
        lambda: fitted_exponential(half),
        readings=(
            Reading(
                "to 0.6 percent, when the weight is taken at L.h = 2 (L.H)^2 and L.H itself is spread evenly",
                lambda: fitted_exponential(unnormalised),
            ),
        ),
    ),
    Claim(
        "SM-F-better-than-power",
        "Fresnel term",
        "the exponential fits the indices 1.33, 1.4 and 1.5 better than the power with exponent 5",
        (True, True),
        lambda: (is_better(POWER, half), is_better(POWER, unnormalised)),
        how="weighted RMS errors, the weight taken at L.H and at L.h",
    ),
    Claim(
        "SM-F-more-precise",
        "Conclusion",
        "the exponential is more precise than the formulas in common use, exp(-6 L.H) among them",
        (True, True),
        lambda: (is_better(GAUSSIAN, half), is_better(GAUSSIAN, unnormalised)),
        how="weighted RMS errors for 1.33, 1.4 and 1.5, the weight taken at L.H and at L.h",
        instead=Reading(
            "for the index 1.5 exp(-6 L.H) has the smaller error, wherever the weight is taken",
            lambda: not is_better(GAUSSIAN, half, COMMON[2:]) and not is_better(GAUSSIAN, unnormalised, COMMON[2:]),
        ),
    ),
    Claim(
        "SM-F-diverges",
        "Fresnel term",
        "the exponential is far from the Fresnel curve where L.H < 0.2",
        AtLeast(5.0),
        lambda: error_below(0.2, True) / error_below(0.2, False),
        how="its greatest error there over its greatest error elsewhere",
        word="far",
    ),
)
