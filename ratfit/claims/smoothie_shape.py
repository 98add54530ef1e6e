"""The smoothie article's distribution: its masking by Smith, what it is akin to, and its listings against its text."""

from __future__ import annotations

import sympy as sp

from ratfit.brdf import distribution, masking, roughness
from ratfit.claims._agreement import ZERO, same
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import ends, over_pairs
from ratfit.claims._models import T, U
from ratfit.claims.masking import ALPHA, off_from_area
from ratfit.claims.smoothie import APPROXIMATE, ratio


def normalised(t: sp.Expr, alpha: sp.Expr) -> sp.Expr:
    """The article's D with the factor that makes it a distribution."""
    return distribution.smoothie_as_printed(t, alpha) * (4 + alpha**2) / sp.pi


def smith(v: sp.Expr, alpha: sp.Expr) -> sp.Expr:
    """Smith's masking for it: GGX's, of the alpha that makes the two one."""
    return masking.ggx(v, roughness.ggx_from_wide(alpha))


def of_blinn(t: sp.Expr, c: sp.Expr) -> sp.Expr:
    """Trowbridge and Reitz's distribution as Blinn gives it, of peak 1 (blinn1977)."""
    return (c**2 / (t**2 * (c**2 - 1) + 1)) ** 2


def off_projection() -> float:
    """How far |h - N (N.h)|^2, with h = L + V, is from (2 u)^2 (1 - t^2) at most, over pairs of directions."""
    view, light = ends()
    half = view + light
    level = half[:, 0] ** 2 + half[:, 1] ** 2
    return float(abs(level - over_pairs(4 * U**2 * (1 - T**2))).max())


def listed() -> sp.Expr:
    """The approximate listing over the text's: d d and D, with p.p = 4 u^2 (1 - t^2), for roughness 3/5."""
    alpha = sp.Rational(9, 25)
    d = alpha + 4 * U**2 * (1 - T**2) / alpha
    microfacet = (alpha + 4 * (1 - T**2) / alpha) ** -2 / (4 * U**2)
    return 1 / (d * d) / microfacet


CLAIMS = (
    Claim(
        "SM-smith",
        "Microfacet Smoothie",
        "Smith's masking can be derived for Smoothie in closed form",
        ZERO,
        lambda: max(off_from_area(smith, normalised, alpha) for alpha in (0.5, 1.0)),
        how="GGX's G1 with alpha/sqrt(4 + alpha^2) against the share that makes the visible facets add up to v",
    ),
    Claim(
        "SM-ggx",
        "Previous work",
        "GGX is the model of Trowbridge and Reitz that Blinn gives",
        True,
        lambda: same(of_blinn(T, ALPHA), distribution.ggx(T, ALPHA)),
        how="at 50 digits",
        readings=(
            Reading(
                "but for the constant pi alpha^2: Blinn's has the peak 1, GGX the integral 1",
                lambda: same(of_blinn(T, ALPHA), distribution.ggx(T, ALPHA) * sp.pi * ALPHA**2),
            ),
        ),
    ),
    Claim(
        "SM-approximate",
        "Approximate Smoothie",
        "h - N (N.h), in the place of 2 sin(theta_m), has the length |h| sin(theta_m)",
        ZERO,
        off_projection,
        how="its square against h.h sin^2(theta_m), from the vectors, over pairs of directions",
    ),
    Claim(
        "SM-approximate-listing",
        "Approximate Smoothie",
        "the listing of the approximate version computes its text, F/(d d)",
        ZERO,
        lambda: abs(over_pairs(listed() / ratio(APPROXIMATE)) - 1).max(),
        how="greatest relative difference over pairs of directions",
    ),
)
