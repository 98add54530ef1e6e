"""Distributions of facets: section 4.4 and Eq. 10 of schlick1994."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterable

import sympy as sp

from ratfit._target import parameter
from ratfit.brdf import distribution
from ratfit.claims._agreement import AtMost, same, unguarded
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._models import T, W, made
from ratfit.claims._numbers import integral, midpoints
from ratfit.claims.masking import SLOPES
from ratfit.claims.method import derived
from ratfit.gallery import card

M, ALPHA, N = parameter("m", "1/100", "1/2"), parameter("alpha", "1/10", 1), parameter("n", 0, 100)

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
    return total(T * made(distribution.beckmann, T, M), {M: m}, 0.0, 1 - m)


def mean_slope(power: int, alpha: float) -> float:
    """The mean of a power of the slope, over alpha to that power, by projected area of Beckmann's facets."""
    return total(STEEP**power * T * made(distribution.beckmann, T, ALPHA), {ALPHA: alpha}) / alpha**power


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


def steeper(m: float) -> float:
    """The share of Beckmann's facets, by projected area, that are steeper than ten degrees."""
    return total(T * made(distribution.beckmann, T, M), {M: m}, 0.0, float(sp.cos(sp.pi / 18)))


@functools.cache
def eq_20() -> sp.Expr:
    return sp.pi * made(distribution.beckmann, T, M)


def printed_21(t: sp.Expr) -> sp.Expr:
    """Eq. 21 as printed, on its support."""
    eq21 = card("eq21")
    assert eq21.published is not None
    return eq21.published.subs(eq21.problem.variable, t)


@functools.cache
def eq_21() -> sp.Expr:
    return sp.pi * distribution.beckmann_rational(T, M)


CLAIMS = (
    Claim(
        "S-10-normalised",
        "Eqs. 7, 10",
        "Ward's D, put in the place of D, keeps the normalisation of Eq. 7 (m = n)",
        1,
        lambda: farthest_total(T * made(distribution.ward_as_printed, T, W, M, M).subs(W, 1) / sp.pi, M, SLOPES),
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
        lambda: same(
            made(distribution.ward_as_printed, T, W, M, M), made(distribution.ward_as_printed, T, W / 2, M, M)
        ),
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
                ("Beckmann", made(distribution.beckmann, T, ALPHA), ALPHA),
                ("Phong", of_peak_one(distribution.phong(T, N)), N),
                ("Torrance-Sparrow", sp.exp(-((sp.acos(T) / ALPHA) ** 2)) / sp.pi, ALPHA),
                ("Trowbridge-Reitz", of_peak_one(distribution.ggx(T, ALPHA)), ALPHA),
            )
            if is_normalised(T * density, symbol, (0.25, 0.5))
        ),
        how="Blinn's power, his Trowbridge-Reitz and Torrance and Sparrow's Gaussian of the angle have peak 1 there",
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
        (1, 1, 1),
        lambda: tuple(mean_slope(2, m) ** 0.5 for m in (0.1, 0.25, 0.5)),
        how="RMS of the slope in two dimensions over m, by projected area, at three m",
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
        "S-20-rough",
        "Section 4.4",
        "the greater m, the more dispersed are the facets",
        True,
        lambda: all(later > earlier for earlier, later in itertools.pairwise(map(steeper, SLOPES))),
        how="the share of facets steeper than ten degrees grows with the m of Figure 7",
    ),
    Claim(
        "S-20-constants",
        "Section 4.4",
        "Beckmann's D depends on m alone, without an arbitrary constant",
        "m",
        lambda: ", ".join(str(each) for each in eq_20().free_symbols - {T}),
        how="its letters beside t; the m of Blinn's and of Torrance and Sparrow's formula goes with a factor to choose",
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
        how="greatest share of facets there, for m from 0 to 1",
        word="almost null",
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
        (0, 1 / M**2),
        lambda: tuple(sp.simplify(printed_21(t)) for t in (1 - M, sp.S.One)),
        how="symbolic, for any m",
    ),
    Claim(
        "S-21-form",
        "Section 4.4",
        "its weighted form is a multiple of u'/u^2, which can be integrated in closed form",
        True,
        lambda: is_single_fraction(derived("eq21").chosen.subs(card("eq21").problem.variable, T)),
        how="symbolic",
    ),
)
