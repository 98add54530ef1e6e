"""Masking and shadowing against the integrals that define it, in mpmath; limits, corners, gradients, misprints."""

import functools
import itertools
import math

import jax
import mpmath
import numpy as np
import pytest
import sympy as sp
from mpmath import mpf

from ratfit._kernel import precision
from ratfit._lower import lower
from ratfit.brdf import masking
from ratfit.brdf.interior import interior

pytestmark = pytest.mark.thorough  # long sweeps of formulas that seldom change

v, v_prime, t, u, rough = sp.symbols("v v_prime t u rough", real=True)
ULP = mpf(2) ** -52


def cotangent(cosine):
    return cosine / mpmath.sqrt((1 - cosine) * (1 + cosine))


# Lambda by the integral of Smith (1967): what slopes steeper than the ray hide, over what it sees of a flat surface.
# The marginal of the slopes along the ray's azimuth is that of the Gaussian, or of GGX (Student's, two degrees).


def gaussian_slopes(slope, alpha):
    return mpmath.exp(-((slope / alpha) ** 2)) / (alpha * mpmath.sqrt(mpmath.pi))


def ggx_slopes(slope, alpha):
    return alpha**2 / (2 * (alpha**2 + slope**2) ** mpf("1.5"))


def integrated_lambda(slopes, cosine, alpha):
    edge = cotangent(cosine)
    hidden = mpmath.quad(lambda x: (x - edge) * slopes(x, alpha), [edge, edge + alpha, edge + 8 * alpha, mpmath.inf])
    return hidden / edge


# The same in closed form, for comparison in many points; the first test holds the one to the other.


def gaussian_lambda(cosine, alpha):
    a = cotangent(cosine) / alpha
    return (mpmath.exp(-(a**2)) / (a * mpmath.sqrt(mpmath.pi)) - mpmath.erfc(a)) / 2


def ggx_lambda(cosine, alpha):
    return (mpmath.sqrt(1 + (alpha / cotangent(cosine)) ** 2) - 1) / 2


def smith(cosine, m):
    alpha = mpmath.sqrt(2) * m
    facing = (1 + mpmath.erf(cotangent(cosine) / alpha)) / 2  # the share of slopes that do not look away
    return facing / (1 + gaussian_lambda(cosine, alpha))


def smith_as_printed(cosine, m):
    h = cosine**2 / (2 * m**2 * (1 - cosine**2))
    g = mpmath.sqrt(h * mpmath.pi) * (2 - mpmath.erfc(mpmath.sqrt(h)))
    return g / (g + 1)


def fraction(cosine, alpha, end):
    a = cotangent(cosine) / alpha
    return (
        mpf(1) if a >= end else (mpf("3.535") * a + mpf("2.181") * a**2) / (1 + mpf("2.276") * a + mpf("2.577") * a**2)
    )


WALTER_END = (1259 - mpmath.sqrt(1081)) / 792

# One-sided functions of v and a roughness, each with its own formula, and the ulp it may be off.
ONE_SIDED = {
    "smith": (smith, 5),
    "smith_as_printed": (smith_as_printed, 5),
    "beckmann": (lambda c, alpha: 1 / (1 + gaussian_lambda(c, alpha)), 4),
    "ggx": (lambda c, alpha: 1 / (1 + ggx_lambda(c, alpha)), 4),
    "beckmann_rational": (lambda c, alpha: fraction(c, alpha, WALTER_END), 5),
    "beckmann_rational_as_printed": (lambda c, alpha: fraction(c, alpha, mpf("1.6")), 5),
    "phong": (lambda c, n: fraction(c, 1 / mpmath.sqrt(n / 2 + 1), WALTER_END), 5),
    "phong_as_printed": (lambda c, n: fraction(c, 1 / mpmath.sqrt(n / 2 + 1), mpf("1.6")), 5),
    "schlick": (lambda c, m: c / (c - mpmath.sqrt(2 * m**2 / mpmath.pi) * (c - 1)), 4),
    "schlick_roughness": (lambda c, r: c / (r - r * c + c), 4),
}
CORRELATED = {"beckmann_correlated": gaussian_lambda, "ggx_correlated": ggx_lambda}
LAMBDAS = {"beckmann_lambda": gaussian_lambda, "ggx_lambda": ggx_lambda}


@functools.cache
def lowered(name, backend="numpy"):
    function = getattr(masking, name)
    arguments = {
        "torrance_sparrow": (t, u, v, v_prime), "kelemen": (u, v, v_prime), "implicit": (v, v_prime),
        **dict.fromkeys(CORRELATED, (v, v_prime, rough)),
    }.get(name, (v, rough))  # fmt: skip
    return lower(function(*arguments), arguments, backend)


def drawn(count):
    """Cosines over the whole range, near 0 and near 1 too, and roughness from 1/300 to 2."""
    random = np.random.default_rng(5)
    third = count // 3
    near = 10.0 ** -random.uniform(0.5, [[5], [10]], (2, third))
    cosines = np.concatenate([random.random(third), near[0], 1 - near[1]])
    return cosines, random.permutation(cosines), 10.0 ** random.uniform(-2.5, 0.3, 3 * third)


def ulp_off(found, exact):
    return max(float(abs(mpf(float(f)) - e) / (abs(e) * ULP)) for f, e in zip(found, exact, strict=True))


@pytest.mark.parametrize(("slopes", "closed"), [(gaussian_slopes, gaussian_lambda), (ggx_slopes, ggx_lambda)])
@pytest.mark.parametrize(("cosine", "alpha"), [(0.1, 0.2), (0.5, 0.7), (0.9, 1.3), (0.3, 0.3)])
def test_the_closed_forms_are_the_integrals_of_smith(slopes, closed, cosine, alpha):
    with mpmath.workdps(20):
        assert integrated_lambda(slopes, mpf(cosine), mpf(alpha)) == pytest.approx(
            closed(mpf(cosine), mpf(alpha)), 1e-12
        )


@pytest.mark.parametrize("name", ONE_SIDED)
def test_one_direction_agrees_with_fifty_digits(name):
    formula, allowed = ONE_SIDED[name]
    cosines, _, roughness = drawn(450)
    if name.startswith("phong"):
        roughness = 1 / roughness**2
    with mpmath.workdps(50):
        exact = [formula(mpf(c), mpf(r)) for c, r in zip(cosines, roughness, strict=True)]
        found = lowered(name)(cosines, roughness)
        assert ulp_off(found, exact) < allowed
        away = np.flatnonzero((cosines > 0.02) & (cosines < 0.98))  # from the limits at both ends
        assert ulp_off(found[away], [exact[place] for place in away]) < 4


@pytest.mark.parametrize("name", ONE_SIDED)
def test_one_direction_in_float32_is_as_good_as_that_allows(name):
    cosines, _, roughness = drawn(450)
    kept = cosines < 1 - 1e-7
    values = [x[kept].astype("float32") for x in (cosines, 1 / roughness**2 if name.startswith("phong") else roughness)]
    found = lowered(name)(*values)
    assert found.dtype == np.float32
    assert np.allclose(found, lowered(name)(*(x.astype(float) for x in values)), rtol=1e-6, atol=0)


@pytest.mark.parametrize("name", CORRELATED)
def test_two_directions_agree_with_fifty_digits(name):
    values = drawn(450)
    with mpmath.workdps(50):
        hidden = CORRELATED[name]
        exact = [1 / (1 + hidden(mpf(a), mpf(r)) + hidden(mpf(b), mpf(r))) for a, b, r in zip(*values, strict=True)]
        assert ulp_off(lowered(name)(*values), exact) < 5


@pytest.mark.parametrize("name", LAMBDAS)
def test_lambda_agrees_with_fifty_digits(name):
    cosines, _, roughness = drawn(450)
    with mpmath.workdps(50):
        exact = [LAMBDAS[name](mpf(c), mpf(r)) for c, r in zip(cosines, roughness, strict=True)]
        found = lowered(name)(cosines, roughness)
        assert ulp_off(1 + found, [1 + e for e in exact]) < 6
        slope = cosines / (roughness * np.sqrt((1 - cosines) * (1 + cosines)))
        smooth = slope < (0.5 if name == "beckmann_lambda" else math.inf)  # beyond, the difference loses its digits
        assert ulp_off(found[smooth], [e for e, kept in zip(exact, smooth, strict=True) if kept]) < 10


# What a distribution shows of itself: v = integral of G1 D (H.V) over the facets that face the viewer (heitz2014).


def visible(distribution, cosine):
    """The integral of D (H.V) over the facets with H.V > 0: the azimuth by hand, the zenith angle by quadrature."""
    sine = mpmath.sqrt(1 - cosine**2)

    def ring(angle):
        along, across = cosine * mpmath.cos(angle), sine * mpmath.sin(angle)
        half = mpmath.pi if along >= across else mpmath.acos(-along / across)
        return distribution(mpmath.cos(angle)) * mpmath.sin(angle) * 2 * (along * half + across * mpmath.sin(half))

    return mpmath.quad(ring, [0, mpmath.asin(cosine), mpmath.pi / 2])


DISTRIBUTIONS = {
    "beckmann": lambda h, a: mpmath.exp(-((1 / h**2 - 1) / a**2)) / (mpmath.pi * a**2 * h**4) if h > 0.05 else 0,
    "ggx": lambda h, a: a**2 / (mpmath.pi * (h**2 * (a**2 - 1) + 1) ** 2),
}


@pytest.mark.parametrize("name", DISTRIBUTIONS)
@pytest.mark.parametrize(("cosine", "alpha"), [(0.2, 0.4), (0.6, 0.4), (0.6, 0.9)])
def test_visible_facets_add_up_to_the_cosine(name, cosine, alpha):
    seen = visible(lambda h: DISTRIBUTIONS[name](h, alpha), cosine)
    assert float(seen) * lowered(name)(cosine, alpha) == pytest.approx(cosine, rel=1e-8)


@pytest.mark.parametrize(("name", "factor"), [("smith", 0.5), ("smith_as_printed", 0.5), ("schlick", 0.5)])
def test_visible_facets_do_not_add_up_with_the_older_functions(name, factor):
    """Their slope at v = 0 is half of what it must be: a grazing view would see half of the surface."""
    grazing = 1e-7
    assert lowered(name)(grazing, 0.3) / lowered("beckmann")(grazing, 0.3 * math.sqrt(2)) == pytest.approx(factor, 1e-5)
    assert lowered(name)(grazing, 0.3) / grazing == pytest.approx(math.sqrt(math.pi / 2) / 0.3, rel=1e-5)


@pytest.mark.parametrize(
    ("exponent", "cosine", "off"), [(0, 0.38, 0.217), (1, 0.26, 0.1245), (2, 0.22, 0.0875), (10, 0.1, 0.0258)]
)
def test_the_masking_printed_for_phong_is_poor_for_small_exponents(exponent, cosine, off):
    """The right one by quadrature of Phong's distribution, at the cosine where they differ most; off is its excess."""
    right = cosine / float(visible(lambda h: (exponent + 2) / (2 * mpmath.pi) * h**exponent, cosine))
    assert lowered("phong")(cosine, float(exponent)) - right == pytest.approx(off, rel=0.01)


@pytest.mark.parametrize("name", CORRELATED)
@pytest.mark.parametrize(("cosine", "other", "alpha"), [(0.2, 0.7, 0.5), (0.9, 0.05, 0.2), (0.4, 0.4, 1.0)])
def test_the_correlated_form_is_the_mean_over_heights(name, cosine, other, alpha):
    """A point at height h is seen with probability C(h)**Lambda, C the Gaussian share of lower heights (smith1967)."""
    power = CORRELATED[name](mpf(cosine), mpf(alpha)) + CORRELATED[name](mpf(other), mpf(alpha))
    mean = mpmath.quad(lambda h: mpmath.npdf(h) * mpmath.ncdf(h) ** power, [-12, -2, 0, 2, 12])
    assert lowered(name)(cosine, other, alpha) == pytest.approx(float(mean), rel=1e-9)


@pytest.mark.parametrize(("name", "one"), [("beckmann_correlated", "beckmann"), ("ggx_correlated", "ggx")])
def test_the_correlated_form_lies_between_the_product_and_the_lesser_one(name, one):
    a, b, roughness = drawn(450)
    both, first, second = lowered(name)(a, b, roughness), lowered(one)(a, roughness), lowered(one)(b, roughness)
    assert np.all(both <= np.minimum(first, second) * (1 + 1e-15)) and np.all(both >= first * second * (1 - 1e-15))
    assert np.array_equal(both, lowered(name)(b, a, roughness))
    product = lower(masking.separable(getattr(masking, one), v, v_prime, rough), (v, v_prime, rough))
    assert np.array_equal(product(a, b, roughness), first * second)


# The sources' own words.


def test_the_two_printed_forms_of_ggx_are_one():
    alpha, cosine = sp.symbols("alpha cosine", positive=True)
    tangent = sp.sqrt(1 - cosine**2) / cosine
    microfacet = 2 / (1 + sp.sqrt(1 + alpha**2 * tangent**2))
    polimi = masking.ggx_as_printed(cosine, alpha)
    assert sp.simplify(microfacet - polimi) == 0
    assert sp.simplify(interior(masking.ggx(cosine, alpha)) - polimi) == 0
    assert polimi.subs({cosine: -0.3, alpha: 0.2}) > 0.8  # seen from behind, as printed
    assert lowered("ggx")(-0.3, 0.2) == 0


def test_the_formulas_alone_are_those_of_the_sources():
    """schlick1994 Eq. 18 as printed and with its exponential, walter2007 Eq. 26: the same to 45 digits."""
    place = {v: sp.Rational(2, 7), rough: sp.Rational(3, 11)}
    h = v**2 / (2 * rough**2 * (1 - v**2))
    g = sp.sqrt(h * sp.pi) * (2 - sp.erfc(sp.sqrt(h)))
    sources = {
        masking.smith_as_printed(v, rough): g / (g + 1),
        masking.smith(v, rough): g / (g + sp.exp(-h)),
        masking.beckmann(v, sp.sqrt(2) * rough): 2 * sp.sqrt(sp.pi * h) / (g + sp.exp(-h)),
    }
    for ours, source in sources.items():
        assert abs((interior(ours) / source - 1).subs(place).evalf(50, chop=False)) < 1e-45


@pytest.mark.parametrize("name", ["smith", "smith_as_printed", "beckmann", "schlick", "schlick_roughness"])
def test_limits_are_exact_in_sympy(name):
    function, m = getattr(masking, name), sp.Symbol("m", positive=True)
    assert [function(sp.S(place), m) for place in (-1, 0, 1, 2)] == [0, 0, 1, 1]
    assert sp.simplify(function(sp.Rational(1, 3), sp.S.Zero)) == 1


def test_smith_as_printed_lacks_the_exponential():
    a, m = 1.3084868909, 0.5  # where eq. 18 is farthest from smith1967, found on two million places
    cosine = a * math.sqrt(2) * m / math.sqrt(1 + 2 * (a * m) ** 2)
    g = a * math.sqrt(math.pi) * (1 + math.erf(a))
    difference = lowered("smith")(cosine, m) - lowered("smith_as_printed")(cosine, m)
    assert difference == pytest.approx(g / (g + math.exp(-a * a)) - g / (g + 1), rel=1e-12)
    assert difference == pytest.approx(0.14352001, rel=1e-7)


def test_smith_as_printed_is_vertical_at_normal_view_and_smith_is_flat():
    """1 - G = m sqrt(2 (1 - v**2))/(2 sqrt(pi)) to first order, against less than any power."""
    short = 1e-8
    assert 1 - lowered("smith_as_printed")(1 - short, 0.5) == pytest.approx(0.5 * math.sqrt(short / math.pi), rel=1e-3)
    assert lowered("smith")(1 - short, 0.5) == 1.0


def test_the_rational_form_in_print_is_above_1_and_jumps():
    a = sp.Symbol("a", positive=True)
    printed = (sp.Rational("3.535") * a + sp.Rational("2.181") * a**2) / (
        1 + sp.Rational("2.276") * a + sp.Rational("2.577") * a**2
    )
    crossing = sorted(sp.solve(sp.Eq(printed, 1), a))
    assert crossing[0] == (1259 - sp.sqrt(1081)) / 792  # 1.548, where ours is held from
    assert printed.subs(a, sp.Rational("1.6")) - 1 == sp.Rational(2, 35121)  # the jump
    highest = max(sp.solve(sp.numer(sp.together(sp.diff(printed, a))), a))
    assert highest.evalf() == pytest.approx(1.588836, rel=1e-6)
    assert (printed.subs(a, highest) - 1).evalf() == pytest.approx(6.13393e-5, rel=1e-5)
    for place, excess in ((float(highest), 6.13393e-5), (1.6 - 1e-12, 2 / 35121), (1.6 + 1e-12, 0.0)):
        cosine = place * 0.5 / math.sqrt(1 + (place * 0.5) ** 2)
        found = lowered("beckmann_rational_as_printed")(cosine, 0.5) - 1
        assert found == pytest.approx(excess, rel=1e-5, abs=1e-12)
        assert lowered("beckmann_rational")(cosine, 0.5) == 1


def test_the_rational_form_keeps_its_third_of_a_percent():
    a = np.linspace(1e-4, 6, 20001)
    cosine = a * 0.5 / np.sqrt(1 + (a * 0.5) ** 2)
    off = lowered("beckmann_rational")(cosine, np.float64(0.5)) / lowered("beckmann")(cosine, np.float64(0.5)) - 1
    assert 0.0031 < np.abs(off).max() < 0.0032


def test_schlick_keeps_three_conditions_of_smith_in_print():
    m = sp.Symbol("m", positive=True)
    k = sp.sqrt(2 * m**2 / sp.pi)
    printed = v / (v - k * v + k)
    assert (printed.subs(v, 0), printed.subs(v, 1)) == (0, 1)
    assert sp.simplify(sp.diff(printed, v).subs(v, 0) - sp.sqrt(sp.pi / (2 * m**2))) == 0
    assert lowered("schlick")(0.3, 0.2) == pytest.approx(float(printed.subs({v: 0.3, m: 0.2})), rel=1e-15)


# Directions: what the cosines of real vectors give.


def directions(count):
    """Cosines t, u, v, v' of pairs of directions above the horizon, and the vectors V, H."""
    random = np.random.default_rng(3)
    pair = random.normal(size=(2, count, 3))
    pair /= np.linalg.norm(pair, axis=2, keepdims=True)
    pair[..., 2] = np.abs(pair[..., 2])
    half = pair.sum(0) / np.linalg.norm(pair.sum(0), axis=1, keepdims=True)
    return half[:, 2], (half * pair[0]).sum(1), pair[0][:, 2], pair[1][:, 2], pair, half


def test_the_grooves_of_torrance_and_sparrow_show_their_projected_area():
    """A groove has two facets, H and its mirror image: what is seen of both is the groove's area, 2 (N.H) (N.V)."""
    cosine_half, _, cosine, _, pair, half = directions(2000)
    mirrored = half * [-1, -1, 1]
    seen = 0
    for facet in (half, mirrored):
        facing = np.maximum((facet * pair[0]).sum(1), 0)
        seen = seen + facing * np.array(lowered("torrance_sparrow")(cosine_half, facing, cosine, np.ones_like(cosine)))
    assert np.allclose(seen, 2 * cosine_half * cosine, rtol=1e-12)


def test_torrance_sparrow_is_eq_16_where_that_is_a_number():
    values = directions(500)[:4]
    printed = lower(masking.torrance_sparrow_as_printed(t, u, v, v_prime), (t, u, v, v_prime))
    assert np.allclose(lowered("torrance_sparrow")(*values), printed(*values), rtol=1e-15, atol=0)
    assert math.isnan(printed(0.0, 0.0, 0.5, 0.5)) and lowered("torrance_sparrow")(0.0, 0.0, 0.5, 0.5) == 0
    assert printed(0.5, 0.5, -0.5, 0.5) < 0 and lowered("torrance_sparrow")(0.5, 0.5, -0.5, 0.5) == 0


def test_kelemen_is_both_shortcuts_visibility_and_at_most_1():
    cosine_half, cosine_facet, cosine, other, pair, _ = directions(2000)
    found = lowered("kelemen")(cosine_facet, cosine, other)
    h = pair.sum(0)
    assert np.allclose(found, 4 * cosine * other / (h * h).sum(1), rtol=1e-13)
    visibility = lower(masking.kelemen_visibility(u), (u,))(cosine_facet)
    assert np.allclose(found, visibility * cosine * other, rtol=1e-13) and found.max() <= 1
    assert np.allclose(2 * cosine_half * cosine_facet, cosine + other, rtol=1e-13)
    assert np.all(lowered("implicit")(cosine, other) <= found)


# The closed domain, corners included.

TINY = float(np.finfo("float32").tiny)
SMALL = (TINY, 1e-30, 1e-18, 1e-6)
COSINES = (-1.0, -0.5, -TINY, -0.0, 0.0, *SMALL, 0.3, 0.5, 1 - 2**-20, 1 - 2**-24, 1.0, 1 + 2**-23, 1.25)
ROUGHNESS = (0.0, *SMALL, 1e-3, 0.01, 0.35, 1.0, 2.0, 1e6, 1e15)
CORNERS = {
    "torrance_sparrow": (COSINES[::2], (0.0, *SMALL, 0.5, 1.0, 1 + 2**-23), COSINES, COSINES[::2]),
    "kelemen": ((0.0, *SMALL, 0.5, 1.0, 1 + 2**-23), COSINES, COSINES),
    "implicit": (COSINES, COSINES),
    **dict.fromkeys(CORRELATED, (COSINES, COSINES, ROUGHNESS)),
    **dict.fromkeys((*ONE_SIDED, *LAMBDAS), (COSINES, ROUGHNESS)),
}
GREATEST = dict.fromkeys(("beckmann_rational_as_printed", "phong_as_printed"), 1 + 6.14e-5)


def corners(name, dtype):
    return [np.array(column, dtype) for column in zip(*itertools.product(*CORNERS[name]), strict=True)]


def hold(name, found, values):
    """Not nan, in [0, 1], 0 on the horizon and below, 1 at normal view and without roughness."""
    if name in LAMBDAS:
        found = 1 / (1 + found)
    assert not np.isnan(found).any()
    assert found.min() >= 0 and found.max() <= GREATEST.get(name, 1)
    if name in ONE_SIDED or name in LAMBDAS:
        cosine, roughness = values
        assert np.all(found[cosine <= 0] == 0) and np.all(found[cosine >= 1] == 1)
        if not name.startswith("phong"):
            assert np.all(found[(roughness == 0) & (cosine >= TINY)] == 1)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("name", CORNERS)
def test_no_corner_is_nan_or_outside_0_and_1(name, dtype):
    values = corners(name, dtype)
    hold(name, lowered(name)(*values), values)


def sloped(name, values):
    single = lowered(name, "jax")
    return jax.vmap(jax.value_and_grad(lambda *x: single(*x), argnums=tuple(range(len(values)))))(*values)


@pytest.mark.parametrize("dtype", [pytest.param("float32", marks=pytest.mark.thorough), "float64"])
def test_nor_is_one_on_jax_and_gradients_are_finite_and_right(dtype):
    """Gradients where no square underflows. All functions are compiled at once: one by one takes twice as long."""
    points = {name: corners(name, dtype) for name in CORNERS}
    with precision(dtype):
        everything = jax.jit(lambda points: {name: sloped(name, values) for name, values in points.items()})
        found = {name: [np.asarray(value), np.asarray(slopes)] for name, (value, slopes) in everything(points).items()}
    for name, values in points.items():
        value, slopes = found[name]
        hold(name, value, values)
        smooth = np.all([(x <= 0) | ((x >= 1e-12) & (x <= 1e12)) for x in values], axis=0)
        assert np.isfinite(slopes[:, smooth]).all(), name
        precise = 1e-13 if dtype == "float64" else 1e-5
        assert np.allclose(value[smooth], lowered(name)(*values)[smooth], rtol=precise, atol=precise**2), name
        if name in ONE_SIDED:
            place = np.all([np.isclose(x, y) for x, y in zip(values, (0.3, 0.35), strict=True)], axis=0)
            right = [mpmath.diff(ONE_SIDED[name][0], (0.3, 0.35), order) for order in ((1, 0), (0, 1))]
            assert np.allclose(slopes[:, place].T, np.array(right, float), rtol=1e-8 if dtype == "float64" else 1e-5), (
                name
            )


@pytest.mark.parametrize(("name", "slope"), [("ggx", 0.5**2 / 2), ("schlick_roughness", 0.5), ("beckmann", 0.0)])
def test_slopes_at_normal_view_are_one_sided_limits(name, slope):
    with precision("float64"):
        assert float(jax.jit(jax.grad(lowered(name, "jax")))(1.0, 0.5)) == pytest.approx(slope)
