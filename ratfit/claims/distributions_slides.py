"""Distributions of facets in the slides and in the smoothie article."""

from __future__ import annotations

import sympy as sp

from ratfit._schedule import schedule
from ratfit.brdf import distribution, roughness
from ratfit.claims._agreement import AtLeast, AtMost, Between, same, unguarded
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._models import V_PRIME, T, V, made
from ratfit.claims._numbers import midpoints, values
from ratfit.claims.distributions import ALPHA, M, N, farthest_total, is_gaussian, mean_slope, total

TANGENT = sp.sqrt(1 - T**2) / T


def off_beckmann(alpha: float) -> float:
    """How far Phong's distribution of the same peak is from Beckmann's, over the peak."""
    at = {T: midpoints(0.5, 1), ALPHA: alpha}
    phong = distribution.phong(T, roughness.exponent_by_peak(ALPHA))
    return float(abs(values(phong - made(distribution.beckmann, T, ALPHA), at)).max() * sp.pi * alpha**2)


def weight_of_ggx() -> float:
    """The weight of GGX's operations over those of Blinn's power."""
    costs = [schedule(unguarded(each(T, ALPHA)), T).cost for each in (distribution.ggx, distribution.blinn)]
    return costs[0].weight / costs[1].weight


SETTINGS = (0.1, 0.5, 1.0)
"""Roughnesses at which normalisations are tried."""


def printed_beckmann(alpha: sp.Expr) -> sp.Expr:
    """Beckmann's D as the slides on micro-facets print it."""
    return sp.exp(-(TANGENT**2) / alpha**2) / (sp.pi * alpha**2 * T**4)


def steeper_share(density: sp.Expr, setting: dict[sp.Symbol, float]) -> float:
    """The share of facets, by projected area, that are steeper than 20 degrees."""
    return total(T * density, setting, 0.0, float(sp.cos(sp.pi / 9)))


def tail() -> float:
    """How many times GGX is above Beckmann at slopes four times alpha, alpha = 0.1."""
    at = {T: 1 / (1 + 0.4**2) ** 0.5, ALPHA: 0.1}
    return float(values(distribution.ggx(T, ALPHA), at) / values(made(distribution.beckmann, T, ALPHA), at))


def totals(weight: sp.Expr) -> tuple[float, ...]:
    """The integrals of Phong's, Beckmann's and GGX's distributions with a weight, those farthest from 1."""
    phong = distribution.phong(T, roughness.exponent_by_peak(ALPHA))
    lobes = (phong, made(distribution.beckmann, T, ALPHA), distribution.ggx(T, ALPHA))
    return tuple(farthest_total(weight * each, ALPHA, SETTINGS) for each in lobes)


CLAIMS = (
    Claim(
        "DP-model",
        "Micro-facet BRDF lighting",
        "D F G/(4 (N.L)(N.V)) is Cook and Torrance's term, s/(4 pi v v') F G D of schlick1994",
        lambda: sp.exp((T**2 - 1) / (M**2 * T**2)) / (M**2 * T**4) / (4 * sp.pi * V * V_PRIME),
        lambda: printed_beckmann(M) / (4 * V * V_PRIME),
        how="both in print with Beckmann's D, F = G = s = 1: the D of schlick1994 is pi times the other",
    ),
    Claim(
        "DP-D-smooth",
        "D term",
        "a greater exponent of Phong's D is a smoother surface, a greater alpha a rougher one",
        (True, True),
        lambda: (
            steeper_share(distribution.phong(T, N), {N: 10.0}) > steeper_share(distribution.phong(T, N), {N: 50.0}),
            steeper_share(distribution.ggx(T, ALPHA), {ALPHA: 0.5})
            > steeper_share(distribution.ggx(T, ALPHA), {ALPHA: 0.2}),
        ),
        how="the share of facets steeper than 20 degrees",
    ),
    Claim(
        "DP-D-one",
        "D term",
        "a distribution must integrate to 1: Phong's, Beckmann's and GGX's do",
        (1, 1, 1),
        lambda: totals(weight=sp.S.One),
        readings=(Reading("with the cosine N.H as a weight, by projected area", lambda: totals(weight=T)),),
    ),
    Claim(
        "DP-D-beckmann",
        "D term",
        "Beckmann's D is exp(-tan^2/alpha^2)/(pi alpha^2 (N.H)^4)",
        True,
        lambda: (
            is_gaussian(printed_beckmann(ALPHA))
            and abs(farthest_total(T * printed_beckmann(ALPHA), ALPHA, SETTINGS) - 1) < 1e-9
            and same(printed_beckmann(ALPHA), unguarded(distribution.beckmann(T, ALPHA)))
        ),
        how="it is normalised, its slopes are Gaussian, and it is Eq. 20 of schlick1994 over pi",
    ),
    Claim(
        "DP-D-ggx",
        "D term",
        "the two forms of GGX, with and without the tangent, are equivalent",
        ALPHA**2 / (sp.pi * T**4 * (ALPHA**2 + TANGENT**2) ** 2),
        lambda: ALPHA**2 / (sp.pi * (T**2 * (ALPHA**2 - 1) + 1) ** 2),
        how="at 50 digits",
    ),
    Claim(
        "DP-D-similar",
        "D term",
        "Beckmann is similar to Phong with n = 2/alpha^2 - 2 for smooth surfaces",
        "similar",
        None,
        readings=(Reading("within 1 percent of the peak at alpha = 0.1", lambda: off_beckmann(0.1), AtMost(0.01)),),
        open="similar means no number",
    ),
    Claim(
        "DP-roughness-inverse",
        "Conversions",
        "alpha = sqrt(2/(n + 2)) and n = -2 + 2/alpha^2 are inverse to each other",
        ALPHA,
        lambda: sp.sqrt(2 / (-2 + 2 / ALPHA**2 + 2)),
        how="at 50 digits",
    ),
    Claim(
        "DP-roughness-both",
        "Conversions",
        "the conversion from Phong's exponent serves Beckmann's and GGX's alpha alike",
        (1 / (sp.pi * ALPHA**2), 1 / (sp.pi * ALPHA**2), 1 / (sp.pi * ALPHA**2)),
        lambda: (
            distribution.phong(T, roughness.exponent_by_peak(ALPHA)).subs(T, 1),
            made(distribution.beckmann, T, ALPHA).subs(T, 1),
            distribution.ggx(T, ALPHA).subs(T, 1),
        ),
        how="all three have one peak then",
    ),
    Claim(
        "DP-roughness-range",
        "D term",
        "Phong's exponent ranges from 1, Beckmann's and GGX's alpha from 0 to 1",
        1,
        lambda: roughness.exponent_by_peak(sp.S.One),
        instead=Reading(
            "from 0, as the same slides say where they convert: alpha = 1 is the exponent 0",
            lambda: roughness.alpha_by_peak(sp.S.Zero) == 1,
        ),
    ),
    Claim(
        "PM-D-blinn",
        "Cook-Torrance, distribution",
        "Blinn's version has a normalisation term",
        1,
        lambda: farthest_total(T * distribution.blinn(T, ALPHA), ALPHA, SETTINGS),
        how="quadrature with the cosine at three roughnesses",
    ),
    Claim(
        "PM-D-beckmann",
        "Cook-Torrance, distribution",
        "the two forms of Beckmann's D, with angle and with dot products, are equal",
        lambda: sp.exp(-((sp.tan(sp.acos(T)) / ALPHA) ** 2)) / (sp.pi * ALPHA**2 * sp.cos(sp.acos(T)) ** 4),
        lambda: sp.exp((T**2 - 1) / (T**2 * ALPHA**2)) / (sp.pi * ALPHA**2 * T**4),
        how="at 50 digits",
    ),
    Claim(
        "PM-D-slope",
        "Cook-Torrance, distribution",
        "rho is the average slope of Beckmann's surface",
        1,
        lambda: mean_slope(1, 0.5),
        instead=Reading(
            "rho is the RMS slope; the average slope is sqrt(pi)/2 times that",
            lambda: abs(mean_slope(2, 0.5) - 1) < 1e-9 and abs(mean_slope(1, 0.5) - float(sp.sqrt(sp.pi)) / 2) < 1e-9,
        ),
    ),
    Claim(
        "PM-D-ggx",
        "Cook-Torrance, distribution",
        "the GGX version is a distribution",
        1,
        lambda: farthest_total(T * distribution.ggx(T, ALPHA), ALPHA, SETTINGS),
        how="quadrature with the cosine at three roughnesses",
    ),
    Claim(
        "PM-D-ggx-cost",
        "Cook-Torrance, distribution",
        "the GGX version is about as complex as Blinn's",
        Between(0.8, 1.25),
        weight_of_ggx,
        how="weight of its operations over that of Blinn's, a power counted as a function",
        instead=Reading(
            "it is simpler: its operations weigh less than a half of Blinn's, whose power counts as a function",
            lambda: weight_of_ggx() < 0.5,
        ),
        word="about as complex",
    ),
    Claim(
        "SM-D",
        "Introduction",
        "Smoothie looks like the distribution of Trowbridge and Reitz",
        lambda: distribution.ggx(T, roughness.ggx_from_wide(ALPHA)),
        lambda: distribution.smoothie_as_printed(T, ALPHA),
        readings=(
            Reading(
                "but for the constant pi/(4 + alpha^2): it is GGX with alpha_g^2 = alpha^2/(4 + alpha^2) times that",
                lambda: distribution.smoothie_as_printed(T, ALPHA) * (4 + ALPHA**2) / sp.pi,
            ),
        ),
    ),
    Claim(
        "SM-gaussian",
        "Previous work",
        "Beckmann's and Phong's distributions come from Gaussian heights",
        (True, True),
        lambda: (is_gaussian(made(distribution.beckmann, T, ALPHA)), is_gaussian(distribution.phong(T, N))),
        instead=Reading(
            "Beckmann's slopes are Gaussian, Phong's only in the limit of large exponents",
            lambda: is_gaussian(made(distribution.beckmann, T, ALPHA)) and off_beckmann(0.02) < off_beckmann(0.1) / 10,
        ),
    ),
    Claim(
        "SM-tail",
        "Previous work",
        "Trowbridge-Reitz has a long tail where a Gaussian has none",
        AtLeast(100.0),
        tail,
        how="GGX over Beckmann at slopes four times alpha, alpha = 0.1",
        word="long tail",
    ),
)
