"""Masking and shadowing in the slides and in the smoothie article."""

from __future__ import annotations

import sympy as sp

from ratfit.brdf import distribution, masking
from ratfit.claims._agreement import ZERO, AtLeast, AtMost, same
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import over_pairs
from ratfit.claims._models import LETTERS, V_PRIME, T, U, V, made
from ratfit.claims._numbers import midpoints, values
from ratfit.claims.masking import ALPHA, N, OneSided, apart, off_from_area, torrance

ROUGHNESSES = (0.1, 0.25, 0.5, 1.0)


def fraction(a: sp.Expr) -> sp.Expr:
    """The slides' fraction for Beckmann's G1, below a = 1.6; 40 digits."""
    above, below = sp.Rational("3.535") * a + sp.Rational("2.181") * a**2, sp.Rational("2.276") * a
    return sp.N(above / (1 + below + sp.Rational("2.577") * a**2), 40)


def shortcut_error(shortcut: sp.Expr, one_sided: OneSided, alpha: float) -> float:
    """The mean error of a shortcut for G over pairs of directions, against the separable product."""
    import numpy as np

    exact = made(masking.separable, one_sided, V, V_PRIME, ALPHA)
    return float(np.mean(np.abs(over_pairs(shortcut) - over_pairs(exact, alpha=alpha))))


def is_better_shortcut() -> bool:
    """Whether 1/(L.H)^2 has a smaller mean error than 1, for GGX and Beckmann at every roughness."""
    implicit, kelemen = masking.implicit(V, V_PRIME), masking.kelemen(U, V, V_PRIME)
    return all(
        shortcut_error(kelemen, each, alpha) < shortcut_error(implicit, each, alpha)
        for each in (masking.ggx, masking.beckmann)
        for alpha in ROUGHNESSES
    )


def share_seen(alpha: float) -> float:
    """The share of pairs of directions for which GGX's G is above 0.9."""
    return float((over_pairs(made(masking.separable, masking.ggx, V, V_PRIME, ALPHA), alpha=alpha) > 0.9).mean())


def excess_of_implicit() -> float:
    """The most by which G = v v' is above the separable G of GGX and of Beckmann."""
    found = [
        over_pairs(masking.implicit(V, V_PRIME) - made(masking.separable, each, V, V_PRIME, ALPHA), alpha=alpha).max()
        for each in (masking.ggx, masking.beckmann)
        for alpha in ROUGHNESSES
    ]
    return float(max(found))


def below_surface() -> float:
    """What the printed G1 of GGX gives for a vector below the surface, v = -1/2, at alpha = 1/2."""
    return float(values(masking.ggx_as_printed(V, ALPHA), {V: -0.5, ALPHA: 0.5}))


CLAIMS = (
    Claim(
        "DP-G-extremes",
        "D, F and G",
        "the geometry term falls towards 0 at extreme angles",
        (0, 0),
        lambda: tuple(values(each(V, ALPHA), {V: 0.0, ALPHA: 0.5}) for each in (masking.ggx, masking.beckmann)),
        how="GGX and Beckmann at the horizon",
    ),
    Claim(
        "DP-G1-beckmann",
        "G term",
        "the rational fraction is a very accurate approximation of Beckmann's G1",
        AtMost(0.005),
        lambda: apart(masking.beckmann_rational_as_printed(V, ALPHA), masking.beckmann(V, ALPHA), ALPHA, ROUGHNESSES),
        how="greatest difference, at four roughnesses",
        word="very accurate",
    ),
    Claim(
        "DP-G1-share",
        "G term",
        "(implied) G1 is a share: at most 1",
        AtMost(0.0),
        lambda: (
            max(
                float(values(masking.beckmann_rational_as_printed(V, ALPHA), {V: midpoints(), ALPHA: each}).max())
                for each in ROUGHNESSES
            )
            - 1
        ),
        how="the most by which it is above 1, at four roughnesses",
        instead=Reading(
            "the fraction goes above 1 a little before a = 1.6, where it jumps down to 1; held at 1 from where it "
            "comes there, at a = (1259 - sqrt(1081))/792, it stays below",
            lambda: (
                abs(fraction((1259 - sp.sqrt(1081)) / 792) - 1) < 1e-30
                and fraction(sp.Rational(8, 5)) > 1
                and all(
                    values(masking.beckmann_rational(V, ALPHA), {V: midpoints(), ALPHA: each}).max() <= 1
                    for each in ROUGHNESSES
                )
            ),
        ),
    ),
    Claim(
        "DP-G1-phong",
        "G term",
        "Beckmann's G1 with a = sqrt(n/2 + 1)/tan serves for Phong's distribution",
        AtMost(0.02),
        lambda: off_from_area(masking.phong_as_printed, distribution.phong, 1.0),
        readings=(
            Reading(
                "to within 0.02 for exponents from 20 on; the found number is for 20 and 50",
                lambda: max(off_from_area(masking.phong_as_printed, distribution.phong, n) for n in (20.0, 50.0)),
            ),
        ),
        word="serves",
    ),
    Claim(
        "DP-G1-ggx",
        "G term",
        "above the surface, 2/(1 + sqrt(1 + alpha^2 tan^2)) is the G1 of GGX",
        ZERO,
        lambda: max(off_from_area(masking.ggx, distribution.ggx, alpha) for alpha in (0.5, 1.0)),
        how="difference to the share that makes the visible facets add up to v, by quadrature",
    ),
    Claim(
        "DP-G1-normal",
        "G term",
        "where tan is 0, at the normal, G1 is to be 1",
        (1, 1),
        lambda: (
            sp.limit(masking.ggx_as_printed(V, ALPHA), V, 1, "-"),
            values(masking.beckmann_rational_as_printed(V, ALPHA), {V: 1.0, ALPHA: 0.5}),
        ),
        how="the limit for GGX, and the branch a >= 1.6 for Beckmann",
    ),
    Claim(
        "DP-G1-below",
        "G term",
        "the formulas of G1 are for an arbitrary vector, so for one below the surface too, which sees no facet",
        0,
        below_surface,
        how="GGX at v.N = -1/2, alpha = 1/2",
        instead=Reading(
            "the printed formulas hold above the surface and need a 0 below it",
            lambda: float(values(masking.ggx(V, ALPHA), {V: -0.5, ALPHA: 0.5})) == 0,
        ),
    ),
    Claim(
        "DP-G-mostly",
        "D, F and G",
        "the geometry term is mostly 1",
        "mostly",
        None,
        readings=(
            Reading(
                "for smooth surfaces: that of GGX with alpha = 1/10 is above 0.9 for most pairs, with alpha = 1 "
                "for less than a tenth of them; the found number is the share of the former",
                lambda: share_seen(0.1) if share_seen(1.0) < 0.1 else None,
                AtLeast(0.5),
            ),
        ),
        open="mostly means no number",
    ),
    Claim(
        "DP-G1-phong-a",
        "G term",
        "a = sqrt(n/2 + 1)/tan for Phong is Beckmann's 1/(alpha tan) by the conversion of the same slides",
        lambda: sp.sqrt(N / 2 + 1),
        lambda: 1 / sp.sqrt(2 / (N + 2)),
        how="at 50 digits, without the tangent",
    ),
    Claim(
        "DP-V-roughness",
        "Visibility",
        "V = 1 does not depend on roughness",
        0,
        lambda: len(masking.implicit(V, V_PRIME).free_symbols - set(LETTERS)),
        how="the number of its parameters",
    ),
    Claim(
        "DP-V-1",
        "Visibility",
        "V = 1 darkens too fast",
        AtMost(0.0),
        excess_of_implicit,
        how="the most by which G = v v' exceeds that of GGX or Beckmann at four roughnesses; below 0 it never does",
    ),
    Claim(
        "DP-V-better",
        "Visibility",
        "V = 1/(L.H)^2 is a better approximation than V = 1",
        True,
        is_better_shortcut,
        how="mean error of G over pairs of directions, against GGX and Beckmann at four roughnesses",
    ),
    Claim(
        "PM-G",
        "Cook-Torrance, geometric term",
        "the geometric term of the slides is that of Cook and Torrance: min(1, 2 t v/u, 2 t v'/u)",
        ZERO,
        lambda: over_pairs(abs(masking.torrance_sparrow_as_printed(T, U, V, V_PRIME) - torrance())).max(),
        how="greatest difference over pairs of directions; u is the same cosine for view and light",
    ),
    Claim(
        "PM-G-parameters",
        "Cook-Torrance, geometric term",
        "the geometric term has no parameter",
        0,
        lambda: len(torrance().free_symbols - set(LETTERS)),
        how="the number of its parameters",
    ),
    Claim(
        "PM-G-ggx",
        "Cook-Torrance, geometric term",
        "GGX's helper function in (1 - c^2)/c^2 is GGX's G1",
        True,
        lambda: same(masking.ggx(V, ALPHA), masking.ggx_as_printed(V, ALPHA)) and below_surface() == 0,
        readings=(
            Reading(
                "above the surface, where the two are equal at 50 digits; below it G1 is 0 and the function is not",
                lambda: same(masking.ggx(V, ALPHA), masking.ggx_as_printed(V, ALPHA)) and below_surface() > 0,
            ),
        ),
    ),
    Claim(
        "SM-G",
        "Microfacet Smoothie",
        "4 (N.L)(N.V)/(h.h) cancels the denominator of the microfacet formula: what is left is 1/(h.h)",
        ZERO,
        lambda: abs(over_pairs(masking.kelemen(U, V, V_PRIME) / (V * V_PRIME) * U**2) - 1).max(),
        how="greatest relative difference over pairs of directions; h.h = 4 u^2",
    ),
)
