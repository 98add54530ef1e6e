"""Conversions of roughness: what each keeps, by integrals in mpmath; their inverses and ends."""

import math

import mpmath
import pytest
import sympy as sp
from mpmath import mpf

from ratfit._lower import lower
from ratfit._parse import RatfitError
from ratfit.brdf import distribution as D
from ratfit.brdf import roughness
from ratfit.brdf.interior import interior

w, a, b, c = sp.symbols("w a b c", positive=True)
t = sp.Symbol("t", positive=True)


def elliptical(t, w, m, n):
    return (1 - t**2) / t**2 * (w**2 / m**2 + (1 - w**2) / n**2)


PRINTED = {
    "beckmann": lambda t, a: mpmath.exp((t**2 - 1) / (t * a) ** 2) / (mpmath.pi * a**2 * t**4),
    "ggx": lambda t, a: a**2 / (mpmath.pi * (t**2 * (a**2 - 1) + 1) ** 2),
    "phong": lambda t, n: (n + 2) / (2 * mpmath.pi) * t**n,
    "ggx_anisotropic": lambda t, w, m, n: 1 / (mpmath.pi * m * n * t**4 * (1 + elliptical(t, w, m, n)) ** 2),
    "ward": lambda t, w, m, n: mpmath.exp(-elliptical(t, w, m, n)) / (mpmath.pi * m * n * t**4),
    "azimuth": lambda w, p: p / (p**2 - p**2 * w**2 + w**2),
}

INVERSES = [
    (roughness.alpha_from_slope, roughness.slope_from_alpha),
    (roughness.exponent_by_peak, roughness.alpha_by_peak),
    (roughness.exponent_by_slope, roughness.alpha_by_slope),
    (roughness.ggx_by_median, roughness.beckmann_by_median),
    (roughness.r_from_ggx, roughness.ggx_from_r),
    (roughness.r_by_zenith, roughness.slope_by_zenith),
    (roughness.r_by_masking, roughness.slope_by_masking),
    (roughness.wide_from_ggx, roughness.ggx_from_wide),
]


@pytest.mark.parametrize(("there", "back"), INVERSES)
def test_conversions_and_their_inverses(there, back):
    for exact in (sp.Rational(1, 7), sp.Rational(2, 3)):
        assert sp.simplify(back(there(exact)) - exact) == 0
    for number in (0.0, 1e-3, 0.3, 0.99):
        forth = lower(there(a), (a,))(number)
        assert lower(back(a), (a,))(forth) == pytest.approx(number, rel=1e-12)


def moment(density, power, limit=mpmath.inf):
    """The mean of tan^power over facets by projected area, in q = tan^2; D is given by its cosine."""
    return mpmath.quad(
        lambda q: q ** (power / 2) * mpmath.pi * density(1 / mpmath.sqrt(1 + q)) / (1 + q) ** 2, [0, limit]
    )


@pytest.mark.parametrize("alpha", [0.2, 0.7])
def test_conversions_keep_what_their_names_say(alpha):
    with mpmath.workdps(20):
        alpha = mpf(alpha)

        def converted(conversion):
            return mpf(conversion(sp.Float(alpha, 25)).evalf(25))

        def phong(conversion):
            return lambda t: PRINTED["phong"](t, converted(conversion))

        def beckmann(t):
            return PRINTED["beckmann"](t, alpha)

        def ggx(t):
            return PRINTED["ggx"](t, converted(roughness.ggx_by_median))

        one = mpf(1)
        assert mpmath.almosteq(beckmann(one), phong(roughness.exponent_by_peak)(one), 1e-15)
        assert mpmath.almosteq(moment(beckmann, 2), alpha**2, 1e-10)  # the mean square over both axes
        assert mpmath.almosteq(moment(beckmann, 1), converted(roughness.mean_slope), 1e-10)
        assert mpmath.almosteq(moment(beckmann, 2) / 2, converted(roughness.slope_from_alpha) ** 2, 1e-10)
        assert mpmath.almosteq(moment(phong(roughness.exponent_by_slope), 2), alpha**2, 1e-6)
        median = alpha**2 * mpmath.log(2)
        assert mpmath.almosteq(moment(beckmann, 0, median), 0.5, 1e-12)
        assert mpmath.almosteq(moment(ggx, 0, median), 0.5, 1e-12)


def test_r_through_the_zenith_factor_and_through_masking_are_two_laws():
    slope, v = sp.symbols("m v", positive=True)
    alpha, r = roughness.alpha_from_slope(slope), roughness.r_by_zenith(slope)
    assert sp.simplify(interior(D.zenith(t, r)).subs(t, 1) - sp.pi * interior(D.beckmann(t, alpha)).subs(t, 1)) == 0
    eq31 = v / (c - c * v + v)
    eq19 = v / (v - sp.sqrt(2 * slope**2 / sp.pi) * v + sp.sqrt(2 * slope**2 / sp.pi))
    assert sp.simplify(eq31.subs(c, roughness.r_by_masking(slope)) - eq19) == 0
    assert sp.solve(roughness.r_by_zenith(slope) - roughness.r_by_masking(slope), slope) == [1 / sp.sqrt(2 * sp.pi)]


@pytest.mark.parametrize("name", ["ggx_anisotropic", "ward"])
@pytest.mark.parametrize("rough", [(0.2, 0.5), (0.3, 0.3)])
def test_every_elliptical_distribution_has_the_azimuths_of_the_factor_that_keeps_eq_27(name, rough):
    """Its integral over the zenith, at one azimuth, is A/(2 pi) with p = along/across."""
    p = roughness.isotropy(*map(sp.Float, rough))
    for cosine in (0, 0.3, 0.9, 1):
        share = mpmath.quad(
            lambda q, w=cosine: PRINTED[name](1 / mpmath.sqrt(1 + q), mpf(w), *map(mpf, rough)) / (2 * (1 + q) ** 2),
            [0, mpmath.inf],
        )
        assert float(share) == pytest.approx(float(PRINTED["azimuth"](mpf(cosine), mpf(p))) / (2 * math.pi), rel=1e-8)


def test_conversions_at_their_ends():
    assert lower(roughness.exponent_by_peak(a), (a,))(0.0) == math.inf
    assert lower(roughness.alpha_by_peak(a), (a,))(math.inf) == 0
    assert lower(roughness.exponent_by_peak(a), (a,))(1.0) == 0
    assert lower(roughness.wide_from_ggx(a), (a,))(1.0) == math.inf
    assert lower(roughness.alpha_at(w, a, b), (w, a, b))(1.0, 0.2, 0.5) == pytest.approx(0.2)
    assert lower(roughness.alpha_at(w, a, b), (w, a, b))(0.0, 0.2, 0.5) == pytest.approx(0.5)
    assert roughness.alpha_from_perceived(sp.Rational(1, 2)) == sp.Rational(1, 4)


@pytest.mark.parametrize("conversion", [
    lambda number: roughness.alpha_by_slope(number(0)),
    lambda number: roughness.alpha_by_peak(number(-2)),
    lambda number: roughness.exponent_by_peak(number(0)),
    lambda number: roughness.exponent_by_slope(number(0)),
    lambda number: roughness.wide_from_ggx(number(1)),
    lambda number: roughness.isotropy(number(1), number(0)),
])  # fmt: skip
@pytest.mark.parametrize("number", [int, float, sp.Integer, sp.Float])
def test_without_finite_value_a_conversion_is_infinite(conversion, number):
    assert conversion(number) is sp.oo


def test_no_isotropy_of_a_mirror():
    with pytest.raises(RatfitError, match="both 0"):
        roughness.isotropy(0, sp.S.Zero)
