"""Distributions of facets: section 4.4 and Eq. 10 of schlick1994, and the D of the other three documents."""

from __future__ import annotations

import functools
from collections.abc import Iterable

import sympy as sp

from ratfit._schedule import schedule
from ratfit._target import parameter
from ratfit.brdf import distribution, roughness
from ratfit.claims._agreement import AtLeast, AtMost, same, unguarded
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._models import V_PRIME, T, V, W
from ratfit.claims._numbers import integral, midpoints, values
from ratfit.claims.masking import SLOPES
from ratfit.claims.method import derived
from ratfit.gallery import card

M, ALPHA, N = parameter("m", "1/100", "1/2"), parameter("alpha", "1/10", 1), parameter("n", 0, 100)
TANGENT = sp.sqrt(1 - T**2) / T
STEEP = sp.sqrt((1 - T) * (1 + T)) / T


def total(weighted: sp.Expr, setting: dict[sp.Symbol, float], low: float = 0.0, high: float = 1.0) -> float:
    """2 pi times the integral over t: over the hemisphere, or the part of it between two cosines."""
    return 2 * float(sp.pi) * integral(weighted, T, low, high, setting)


def farthest_total(weighted: sp.Expr, symbol: sp.Symbol, settings: Iterable[float]) -> float:
    """The total that is farthest from 1, over values of a roughness."""
    return max((total(weighted, {symbol: each}) for each in settings), key=lambda found: abs(found - 1))


def is_normalised(weighted: sp.Expr, symbol: sp.Symbol, settings: Iterable[float]) -> bool:
    return abs(farthest_total(weighted, symbol, settings) - 1) < 1e-9


def of_peak_one(density: sp.Expr) -> sp.Expr:
    """A distribution in the normalisation of schlick1994, with the value 1 at t = 1 that its source gives it."""
    return density / density.subs(T, 1) / sp.pi


def share_below(m: float) -> float:
    """Beckmann's share of facets, by projected area, below t = 1 - m."""
    return total(T * distribution.beckmann(T, M), {M: m}, 0.0, 1 - m)


def mean_slope(power: int, alpha: float) -> float:
    """The mean of a power of the slope, over alpha to that power, by projected area of Beckmann's facets."""
    return total(STEEP**power * T * distribution.beckmann(T, ALPHA), {ALPHA: alpha}) / alpha**power


def is_gaussian(density: sp.Expr) -> bool:
    """Whether the slopes of a distribution are Gaussian: the logarithm of D t^4 is linear in tan^2."""
    q = sp.Symbol("q", positive=True)
    logarithm = sp.log(unguarded(density) * T**4).subs(T, 1 / sp.sqrt(1 + q))
    bend = sp.diff(logarithm, q, 2)
    at = {symbol: sp.Rational(1, 3) for symbol in bend.free_symbols - {q}}
    return all(abs(sp.N(bend.subs(at).subs(q, place), 30)) < 1e-20 for place in (sp.Rational(1, 2), sp.Integer(2)))


def is_single_fraction(formula: sp.Expr) -> bool:
    """Whether t D is a multiple of u'/u^2, u the root of the denominator without the t."""
    x = T + M - 1
    u = M * x**2 - x**2 + M**2
    return bool(sp.simplify(sp.diff(T * formula * u**2 / sp.diff(u, T), T)) == 0)


def off_beckmann(alpha: float) -> float:
    """How far Phong's distribution of the same peak is from Beckmann's, over the peak."""
    at = {T: midpoints(0.5, 1), ALPHA: alpha}
    phong = distribution.phong(T, roughness.exponent_by_peak(ALPHA))
    return float(abs(values(phong - distribution.beckmann(T, ALPHA), at)).max() * sp.pi * alpha**2)


def weight_of_ggx() -> float:
    """The weight of GGX's operations over those of Blinn's power."""
    costs = [schedule(unguarded(each(T, ALPHA)), T).cost for each in (distribution.ggx, distribution.blinn)]
    return costs[0].weight / costs[1].weight


def steeper_share(density: sp.Expr, setting: dict[sp.Symbol, float]) -> float:
    """The share of facets, by projected area, that are steeper than 20 degrees."""
    return total(T * density, setting, 0.0, float(sp.cos(sp.pi / 9)))


def tail() -> float:
    """How many times GGX is above Beckmann at slopes four times alpha, alpha = 0.1."""
    at = {T: 1 / (1 + 0.4**2) ** 0.5, ALPHA: 0.1}
    return float(values(distribution.ggx(T, ALPHA), at) / values(distribution.beckmann(T, ALPHA), at))


@functools.cache
def eq_20() -> sp.Expr:
    return sp.pi * distribution.beckmann(T, M)


@functools.cache
def eq_21() -> sp.Expr:
    return sp.pi * distribution.beckmann_rational(T, M)


CLAIMS = (
    Claim(
        "S-10-normalised",
        "Eqs. 7, 10",
        "Ward's D, put in the place of D, keeps the normalisation of Eq. 7 (m = n)",
        1,
        lambda: farthest_total(T * distribution.ward_as_printed(T, W, M, M).subs(W, 1) / sp.pi, M, SLOPES),
        instead=Reading(
            "it does so with 1/t^4 as a factor, which makes it Beckmann's D for m = n; the found integral is the one "
            "farthest from 1 at the m of Figure 7",
            lambda: is_normalised(T * distribution.ward(T, sp.S.One, M, M), M, SLOPES),
        ),
    ),
    Claim(
        "S-10-isotropic",
        "Eq. 10",
        "for m = n Ward's model is isotropic",
        True,
        lambda: same(distribution.ward_as_printed(T, W, M, M), distribution.ward_as_printed(T, W / 2, M, M)),
        how="at two azimuths",
    ),
    Claim(
        "S-4.4-only-beckmann",
        "Section 4.4",
        "of the distributions in its sources only Beckmann's keeps Eq. 7",
        "Beckmann",
        lambda: ", ".join(
            name
            for name, density, symbol in (
                ("Beckmann", distribution.beckmann(T, ALPHA), ALPHA),
                ("Phong", of_peak_one(distribution.phong(T, N)), N),
                ("Trowbridge-Reitz", of_peak_one(distribution.ggx(T, ALPHA)), ALPHA),
            )
            if is_normalised(T * density, symbol, (0.25, 0.5))
        ),
        how="Blinn's power and his Trowbridge-Reitz have peak 1 in their source",
    ),
    Claim(
        "S-20-normalised",
        "Eq. 20",
        "Beckmann's D keeps the normalisation of Eq. 7",
        1,
        lambda: farthest_total(T * eq_20() / sp.pi, M, SLOPES),
        how="quadrature at the m of Figure 7",
    ),
    Claim(
        "S-20-slope",
        "Eq. 20",
        "m is the RMS slope of the facets",
        1,
        lambda: mean_slope(2, 0.5) ** 0.5,
        how="RMS of the slope in two dimensions over m, by projected area",
    ),
    Claim(
        "S-20-smooth",
        "Section 4.4",
        "for m = 0 D becomes a Dirac function",
        0,
        lambda: total(T * eq_20() / sp.pi, {M: 0.002}, 0.0, float(sp.cos(sp.pi / 180))),
        how="the share of facets steeper than one degree at m = 0.002",
    ),
    Claim(
        "S-20-peak",
        "Section 4.4",
        "first condition: D(1) = 1/m^2",
        1 / M**2,
        lambda: eq_20().subs(T, 1),
        how="symbolic",
    ),
    Claim(
        "S-20-null",
        "Section 4.4",
        "D is almost null for t below 1 - m",
        AtMost(0.001),
        lambda: max(share_below(each) for each in midpoints(count=50).tolist()),
        how="greatest share of facets there, for m from 0 to 1; almost null is taken as a thousandth",
    ),
    Claim(
        "S-21",
        "Eq. 21",
        "the conditions lead to m^3 x/(t (m x^2 - x^2 + m^2)^2) with x = t + m - 1",
        lambda: card("eq21").published,
        lambda: derived("eq21").chosen,
        how="derived anew from the conditions",
    ),
    Claim(
        "S-21-normalised",
        "Eq. 21",
        "Eq. 21 on [1 - m, 1], 0 below, keeps the normalisation",
        1,
        lambda: max(
            (total(T * eq_21() / sp.pi, {M: each}, 1 - each) for each in SLOPES), key=lambda found: abs(found - 1)
        ),
        how="quadrature at the m of Figure 7",
    ),
    Claim(
        "S-21-ends",
        "Eq. 21",
        "Eq. 21 is 0 at t = 1 - m and 1/m^2 at t = 1",
        (0, 4),
        lambda: tuple(float(values(eq_21(), {T: t, M: 0.5})) for t in (0.5, 1.0)),
        how="at m = 1/2",
    ),
    Claim(
        "S-21-form",
        "Section 4.4",
        "its weighted form is a multiple of u'/u^2, which can be integrated in closed form",
        True,
        lambda: is_single_fraction(derived("eq21").chosen.subs(card("eq21").problem.variable, T)),
        how="symbolic",
    ),
    Claim(
        "DP-model",
        "Micro-facet BRDF lighting",
        "D F G/(4 (N.L)(N.V)) is Cook and Torrance's term, s/(4 pi v v') F G D of schlick1994",
        lambda: eq_20() / (4 * sp.pi * V * V_PRIME),
        lambda: distribution.beckmann(T, M) / (4 * V * V_PRIME),
        how="its D being that of schlick1994 over pi",
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
        lambda: totals_at_half(weight=sp.S.One),
        readings=(Reading("with the cosine N.H as a weight, by projected area", lambda: totals_at_half(weight=T)),),
    ),
    Claim(
        "DP-D-beckmann",
        "D term",
        "Beckmann's D is exp(-tan^2/alpha^2)/(pi alpha^2 (N.H)^4)",
        lambda: sp.exp(-(TANGENT**2) / ALPHA**2) / (sp.pi * ALPHA**2 * T**4),
        lambda: eq_20().subs(M, ALPHA) / sp.pi,
        how="Eq. 20 of schlick1994 over pi",
    ),
    Claim(
        "DP-D-ggx",
        "D term",
        "the two forms of GGX, with and without the tangent, are equivalent",
        ALPHA**2 / (sp.pi * T**4 * (ALPHA**2 + TANGENT**2) ** 2),
        lambda: distribution.ggx(T, ALPHA),
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
        lambda: roughness.alpha_by_peak(roughness.exponent_by_peak(ALPHA)),
        how="at 50 digits",
    ),
    Claim(
        "DP-roughness-both",
        "Conversions",
        "the conversion from Phong's exponent serves Beckmann's and GGX's alpha alike",
        (1 / (sp.pi * ALPHA**2), 1 / (sp.pi * ALPHA**2), 1 / (sp.pi * ALPHA**2)),
        lambda: (
            distribution.phong(T, roughness.exponent_by_peak(ALPHA)).subs(T, 1),
            distribution.beckmann(T, ALPHA).subs(T, 1),
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
        lambda: farthest_total(T * distribution.blinn(T, ALPHA), ALPHA, (0.1, 0.5, 1.0)),
        how="quadrature with the cosine at three roughnesses",
    ),
    Claim(
        "PM-D-beckmann",
        "Cook-Torrance, distribution",
        "the two forms of Beckmann's D, with angle and with dot products, are equal",
        lambda: sp.exp((T**2 - 1) / (T**2 * ALPHA**2)) / (sp.pi * ALPHA**2 * T**4),
        lambda: distribution.beckmann(T, ALPHA),
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
        lambda: farthest_total(T * distribution.ggx(T, ALPHA), ALPHA, (0.1, 0.5, 1.0)),
        how="quadrature with the cosine at three roughnesses",
    ),
    Claim(
        "PM-D-ggx-cost",
        "Cook-Torrance, distribution",
        "the GGX version is about as complex as Blinn's",
        AtMost(1.25),
        weight_of_ggx,
        how="weight of its operations over that of Blinn's, a power counted as a function",
    ),
    Claim(
        "SM-D",
        "Introduction",
        "Smoothie looks like the distribution of Trowbridge and Reitz",
        lambda: distribution.ggx(T, roughness.ggx_from_wide(ALPHA)) * sp.pi / (4 + ALPHA**2),
        lambda: distribution.smoothie_as_printed(T, ALPHA),
        how="it is GGX with alpha_g^2 = alpha^2/(4 + alpha^2), but for a constant",
    ),
    Claim(
        "SM-gaussian",
        "Previous work",
        "Beckmann's and Phong's distributions come from Gaussian heights",
        (True, True),
        lambda: (is_gaussian(distribution.beckmann(T, ALPHA)), is_gaussian(distribution.phong(T, N))),
        instead=Reading(
            "Beckmann's slopes are Gaussian, Phong's only in the limit of large exponents",
            lambda: is_gaussian(distribution.beckmann(T, ALPHA)) and off_beckmann(0.02) < off_beckmann(0.1) / 10,
        ),
    ),
    Claim(
        "SM-tail",
        "Previous work",
        "Trowbridge-Reitz has a long tail where a Gaussian has none",
        AtLeast(100.0),
        tail,
        how="GGX over Beckmann at slopes four times alpha, alpha = 0.1",
    ),
)


def totals_at_half(weight: sp.Expr) -> tuple[float, ...]:
    """The integrals of Phong's, Beckmann's and GGX's distributions at alpha = 1/2, with a weight."""
    at = {ALPHA: 0.5}
    phong = distribution.phong(T, roughness.exponent_by_peak(ALPHA))
    return tuple(
        total(weight * each, at) for each in (phong, distribution.beckmann(T, ALPHA), distribution.ggx(T, ALPHA))
    )
