"""Distributions against their printed formulas in mpmath; their integrals, identities, limits and gradients."""

import itertools
import math

import mpmath
import numpy as np
import pytest
import sympy as sp
from mpmath import fp, mpf

from ratfit._lower import lower
from ratfit.brdf import distribution as D
from ratfit.brdf import roughness
from ratfit.brdf.interior import interior

pytestmark = pytest.mark.thorough  # long sweeps of formulas that seldom change

LETTERS = sp.symbols("t w a b", real=True)  # of arrays: nothing may be known of them
t, w, a, b, c = sp.symbols("t w a b c", positive=True)  # of proofs


def tangent_squared(t):
    return (1 - t) * (1 + t) / t**2


def ellipse(t, w, m, n):
    return tangent_squared(t) * (w**2 / m**2 + (1 - w**2) / n**2)


def rational(t, m):
    x = t + m - 1
    return m**3 * x / (mpmath.pi * t * (m * x**2 - x**2 + m**2) ** 2) if x > 0 else mpf(0)


def ratio(w, p):
    return p / (p**2 - p**2 * w**2 + w**2)


# The formulas as their sources print them, in mpmath numbers; plain names from schlick1994 over pi.
PRINTED = {
    "beckmann": lambda t, a: mpmath.exp(-tangent_squared(t) / a**2) / (mpmath.pi * a**2 * t**4),
    "beckmann_rational": rational,
    "ggx": lambda t, a: a**2 / (mpmath.pi * (t**2 * (a**2 - 1) + 1) ** 2),
    "phong": lambda t, n: (n + 2) / (2 * mpmath.pi) * t**n,
    "blinn": lambda t, rho: t ** (2 / rho**2 - 2) / (mpmath.pi * rho**2),
    "zenith": lambda t, r: r / (1 + r * t**2 - t**2) ** 2,
    "azimuth": ratio,
    "azimuth_as_printed": lambda w, p: mpmath.sqrt(ratio(w, p)),
    "smoothie": lambda t, a: (4 + a**2) / (mpmath.pi * (a + 4 * (1 - t**2) / a) ** 2),
    "smoothie_as_printed": lambda t, a: (a + 4 * (1 - t**2) / a) ** -2,
    "ggx_anisotropic": lambda t, w, m, n: 1 / (mpmath.pi * m * n * t**4 * (1 + ellipse(t, w, m, n)) ** 2),
    "ward": lambda t, w, m, n: mpmath.exp(-ellipse(t, w, m, n)) / (mpmath.pi * m * n * t**4),
    "ward_as_printed": lambda t, w, m, n: mpmath.exp(-ellipse(t, w, m, n)) / (m * n),
    "ward_third_form_as_printed": lambda t, w, m, n: mpmath.exp(ellipse(t, w, m, n)) / (m * n),
    "schlick": lambda t, w, r, p: r / (1 + r * t**2 - t**2) ** 2 * ratio(w, p) / mpmath.pi,
    "schlick_as_printed": lambda t, w, r, p: r / (1 + r * t**2 - t**2) ** 2 * mpmath.sqrt(ratio(w, p)) / mpmath.pi,
}
EXPONENT = {  # what a rounding error of the argument is multiplied by
    "beckmann": lambda t, a: tangent_squared(t) / a**2,
    "blinn": lambda t, rho: -2 * math.log(t) / rho**2,
    "ward": ellipse,
    "ward_as_printed": ellipse,
    "ward_third_form_as_printed": ellipse,
}
T, W, A, B = LETTERS
ARGUMENTS = dict.fromkeys(PRINTED, (T, A))
ARGUMENTS |= {name: (W, B) for name in PRINTED if name.startswith("azimuth")}
FOUR = ("ggx_anisotropic", "ward", "ward_as_printed", "ward_third_form_as_printed", "schlick", "schlick_as_printed")
ARGUMENTS |= dict.fromkeys(FOUR, LETTERS)
UP_TO_ONE = ("beckmann_rational", "blinn", "zenith", "azimuth", "azimuth_as_printed", "schlick", "schlick_as_printed")
LIGHT = {"smoothie_energy": (A,), "smoothie_energy_as_printed": (A,)}


def lowered(name, backend="numpy"):
    arguments = (ARGUMENTS | LIGHT)[name]
    return lower(getattr(D, name)(*arguments), arguments, backend)


def samples(name, count, dtype):
    """Cosines over the whole range and close to 1, roughness of every size."""
    random = np.random.default_rng(7)
    cosine = np.where(random.random(count) < 0.5, random.random(count), 1 - 10 ** random.uniform(-7, -1, count))
    rough = 10 ** random.uniform(-3, 0 if name in UP_TO_ONE else 0.5, (2, count))
    rough = 2 / rough**2 if name == "phong" else rough
    columns = {2: (cosine, rough[0]), 4: (cosine, random.random(count), *rough)}[len(ARGUMENTS[name])]
    return [column.astype(dtype) for column in columns]


@pytest.mark.parametrize(("dtype", "digits"), [(np.float64, 52), (np.float32, 23)])
@pytest.mark.parametrize("name", PRINTED)
def test_values_are_those_of_the_printed_formula(name, dtype, digits):
    """To 4 units of 2**-52 in float64, 5 with two roughnesses, and 3 for every unit of an exponent, which magnifies."""
    points = samples(name, 250, dtype)
    values = lowered(name)(*points)
    assert values.dtype == dtype
    allowed = 5 if name in FOUR else 4
    with mpmath.workdps(50):
        for *place, value in zip(*points, values, strict=True):
            exact = [mpf(float(part)) for part in place]
            exponent = EXPONENT.get(name, lambda *_: 0)(*exact)
            if exponent < (600 if digits == 52 else 60):
                expected = PRINTED[name](*exact)
                if float(np.finfo(dtype).tiny) * 1e7 < expected < float(np.finfo(dtype).max):
                    unit = mpf(2) ** -digits * expected
                    assert abs(mpf(float(value)) - expected) <= (allowed + 3 * exponent) * unit, place


NORMALISED = [(name, rough) for name in ("beckmann", "ggx", "smoothie") for rough in (0.05, 0.3, 1, 2)]
NORMALISED += [(name, rough) for name in ("blinn", "beckmann_rational") for rough in (0.05, 0.3, 1)]
NORMALISED += [("phong", 0), ("phong", 1), ("phong", 40)]


@pytest.mark.parametrize(("name", "rough"), NORMALISED)
def test_the_integral_with_the_cosine_over_the_hemisphere_is_one(name, rough):
    breaks = [0, *(1 - rough for _ in range(name == "beckmann_rational" and rough < 1)), 0.9, 0.99, 0.999, 1]
    total = fp.quad(lambda t: 2 * fp.pi * t * float(PRINTED[name](mpf(t), mpf(rough))) if t else 0, sorted(breaks))
    assert total == pytest.approx(1, abs=1e-9)


def over_the_hemisphere(name, *rough):
    """By the tangent's square q = tan^2 = s/(1 - s) and a periodic rule over the azimuth, 200 x 100 nodes."""
    function = lowered(name)
    nodes, weights = np.polynomial.legendre.leggauss(200)
    share = (nodes + 1) / 2  # q = f s/(1 - s), with f the size of the lobe
    size = rough[0] * rough[1] if name != "schlick" else rough[0]
    q, jacobian = size * share / (1 - share), size / (1 - share) ** 2 * weights / 2
    turns = np.cos(2 * np.pi * (np.arange(100) + 0.5) / 100)
    values = function(1 / np.sqrt(1 + q)[:, None], np.abs(turns), *rough)
    return (values * (jacobian / (1 + q) ** 2)[:, None]).sum() * np.pi / 100  # t dt = dq/(2 (1 + q)^2)


@pytest.mark.parametrize("name", ["ggx_anisotropic", "ward", "schlick"])
@pytest.mark.parametrize("rough", [(0.3, 0.3), (0.2, 0.6), (0.5, 0.35)])
def test_two_roughnesses_leave_the_integral_one(name, rough):
    assert over_the_hemisphere(name, *rough) == pytest.approx(1, abs=1e-7)


@pytest.mark.parametrize("m", [0.05, 0.2, 0.5, 1])
def test_ward_in_print_is_not_normalised(m):
    """Eq. 7 comes to exp(1/m^2) E_2(1/m^2)/m^2 for m = n, by q = tan^2; below 1 whatever m."""
    found = over_the_hemisphere("ward_as_printed", m, m) / math.pi
    assert found == pytest.approx(float(mpmath.exp(1 / m**2) * mpmath.expint(2, 1 / m**2) / m**2), abs=1e-7)
    assert found < 0.998


@pytest.mark.parametrize("p", [0.01, 0.2, 0.5, 0.9, 1])
def test_the_mean_of_the_azimuth_factor_is_one_and_of_the_printed_one_below(p):
    mean, printed = (
        mpmath.quad(lambda phi, f=f: PRINTED[f](mpmath.cos(phi), mpf(p)), [0, mpmath.pi / 2 - p, mpmath.pi / 2])
        for f in ("azimuth", "azimuth_as_printed")
    )
    assert mean * 2 / mpmath.pi == pytest.approx(1, abs=1e-9)
    assert printed * 2 / mpmath.pi == pytest.approx(float(D.azimuth_as_printed_mean(sp.Float(p, 30))), abs=1e-9)
    assert (printed * 2 / mpmath.pi < 1 - 1e-4) == (p < 1)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (D.zenith(t, a), sp.pi * D.ggx(t, sp.sqrt(a))),
        (D.smoothie(t, a), D.ggx(t, roughness.ggx_from_wide(a))),
        (D.smoothie_as_printed(t, a), sp.pi / (4 + a**2) * D.ggx(t, roughness.ggx_from_wide(a))),
        (D.blinn(t, a), D.phong(t, roughness.exponent_by_peak(a))),
        (D.ggx_anisotropic(t, w, a, a), D.ggx(t, a)),
        (D.ward(t, w, a, a), D.beckmann(t, a)),
        (D.ward_as_printed(t, w, a, b), D.ward(t, w, a, b) * sp.pi * t**4),
        (D.azimuth_as_printed(w, b) ** 2, D.azimuth(w, b)),
        (D.schlick(t, w, a, sp.S.One), D.ggx(t, sp.sqrt(a))),
        (D.ggx_anisotropic(t, w, a, b) * a * b, D.ggx(t, c) * c**2),
        (D.ward(t, w, a, b) * a * b, D.beckmann(t, c) * c**2),
    ],
)
def test_one_distribution_is_another(first, second):
    square = roughness.alpha_at(w, a, b) ** 2
    second = sp.together(interior(second)).subs(c, sp.sqrt(b)).subs(b, square) if second.has(c) else interior(second)
    ratio = (
        sp.log(sp.cancel(interior(first) / second))
        if second.is_rational_function()
        else sp.log(interior(first) / second)
    )
    assert sp.simplify(sp.expand_log(ratio, force=True)) == 0


def test_the_normalisation_of_smoothie_by_symbols():
    assert sp.integrate(2 * sp.pi * t * interior(D.smoothie_as_printed(t, a)), (t, 0, 1)).equals(sp.pi / (4 + a**2))
    at_half = interior(D.smoothie_as_printed(t, a)).subs(t, sp.sqrt((1 + c) / 2))
    energy = sp.integrate(2 * sp.pi * c * sp.simplify(at_half), (c, 0, 1))
    assert sp.simplify(sp.expand_log(energy - interior(D.smoothie_energy(a)), force=True)) == 0


def test_the_printed_integral_of_smoothie_needs_another_variable_and_the_azimuth():
    right, printed = interior(D.smoothie_energy(a)), interior(D.smoothie_energy_as_printed(a))
    reading = 2 * sp.pi * printed.subs(a, a / sp.sqrt(2))
    assert sp.simplify(sp.expand_log((right - reading).rewrite(sp.log), force=True).together()).equals(0)
    for wrong in (printed, 2 * sp.pi * printed):
        assert abs(float((wrong / right).subs(a, sp.S.Half)) - 1) > 0.1


def test_beckmann_rational_has_the_conditions_it_is_made_for():
    printed = a**3 * c / (t * (a * c**2 - c**2 + a**2) ** 2)
    found = sp.pi * interior(D.beckmann_rational(t, a))
    assert sp.simplify(found - printed.subs(c, t + a - 1)) == 0
    assert found.subs(t, 1).equals(1 / a**2) and found.subs(t, 1 - a) == 0
    assert sp.simplify(found.subs(a, 1)) == 1
    kink = sp.diff(found, t).subs(t, 1 - a)
    assert sp.simplify(kink - 1 / (a * (1 - a))) == 0


INFINITE = math.inf
LIMITS = [
    ("beckmann", (0, 0.5), 0), ("beckmann", (1, 0.5), 4 / math.pi), ("beckmann", (-0.5, 0.5), 0),
    ("beckmann", (1, 0), INFINITE), ("beckmann", (0.999, 0), 0), ("beckmann", (1 + 2**-52, 1e-9), 1e18 / math.pi),
    ("beckmann_rational", (0.5, 0.5), 0), ("beckmann_rational", (0.3, 0.5), 0), ("beckmann_rational", (1, 0), INFINITE),
    ("beckmann_rational", (0, 1), 1 / math.pi), ("beckmann_rational", (0.7, 1), 1 / math.pi),
    ("beckmann_rational", (0, 0.9), 0), ("beckmann_rational", (-0.5, 1), 0), ("beckmann_rational", (0.9, 0), 0),
    ("ggx", (0, 0.5), 0.25 / math.pi), ("ggx", (0.3, 1), 1 / math.pi), ("ggx", (-0.1, 1), 0), ("ggx", (1, 0), INFINITE),
    ("ggx", (0.999, 0), 0), ("ggx", (1, 1e-10), 1e20 / math.pi),
    ("phong", (0, 0), 1 / math.pi), ("phong", (0, 2), 0), ("phong", (1, INFINITE), INFINITE), ("phong", (-1, 0), 0),
    ("phong", (0.9, INFINITE), 0), ("phong", (0.9, 1e300), 0), ("phong", (0.5, 1), 0.75 / math.pi),
    ("blinn", (0, 1), 1 / math.pi), ("blinn", (0, 0.5), 0), ("blinn", (1, 0), INFINITE), ("blinn", (0.9, 0), 0),
    ("zenith", (0.4, 1), 1), ("zenith", (0, 0.25), 0.25), ("zenith", (1, 0.25), 4), ("zenith", (1, 0), INFINITE),
    ("zenith", (0.999, 0), 0),
    ("azimuth", (0.4, 1), 1), ("azimuth", (0, 0.25), 4), ("azimuth", (1, 0.25), 0.25), ("azimuth", (0, 0), INFINITE),
    ("azimuth", (0.1, 0), 0), ("azimuth_as_printed", (0, 0.25), 2), ("azimuth_as_printed", (0.1, 0), 0),
    ("smoothie", (1, 0), INFINITE), ("smoothie", (0.5, 0), 0), ("smoothie_as_printed", (1, 0.5), 4),
    ("smoothie_as_printed", (-0.5, 0.5), 0), ("smoothie_energy", (0,), math.pi),
    ("smoothie_energy_as_printed", (0,), 0.5),
    ("ggx_anisotropic", (1, 0.3, 0.5, 0.25), 8 / math.pi), ("ggx_anisotropic", (1, 0.3, 0, 0), INFINITE),
    ("ggx_anisotropic", (0.5, 0, 0, 0.3), INFINITE), ("ggx_anisotropic", (0.5, 1, 0.3, 0), INFINITE),
    ("ggx_anisotropic", (0.5, 0.5, 0, 0.3), 0), ("ggx_anisotropic", (0.5, 0, 0, 0), 0),
    ("ward", (1, 0.3, 0.5, 0.25), 8 / math.pi), ("ward", (0, 0.3, 0.5, 0.25), 0), ("ward", (0.5, 0.5, 0, 0.3), 0),
    ("ward", (0.5, 0, 0, 0.3), INFINITE), ("ward", (0.5, 0, 0, 0), 0), ("ward", (-0.5, 0.3, 1, 1), 0),
    ("ward_as_printed", (0, 0.3, 1, 1), 0), ("ward_as_printed", (1, 0.3, 0.5, 0.25), 8),
    ("ward_third_form_as_printed", (0, 0.3, 1, 1), INFINITE), ("ward_third_form_as_printed", (1, 0, 1, 1), 1),
    ("schlick", (1, 0.5, 0, 0), INFINITE), ("schlick", (0.5, 0, 0, 0), 0), ("schlick", (0.5, 0, 0.5, 0), INFINITE),
    ("schlick", (0.5, 0.5, 0.5, 0), 0), ("schlick", (-0.5, 0, 0.5, 0), 0), ("schlick", (0.5, 0.5, 1, 1), 1 / math.pi),
]  # fmt: skip


@pytest.mark.parametrize(("name", "place", "limit"), LIMITS)
def test_limits(name, place, limit):
    assert lowered(name)(*place) == pytest.approx(limit, rel=1e-14)


@pytest.mark.parametrize("name", [name for name in PRINTED if "azimuth" not in name and "third" not in name])
def test_a_number_may_stand_for_roughness(name):
    """Also 0 and 1, at which sympy would divide by 0 or compare what is no number."""
    mirror, diffuse = (math.inf, 0) if name == "phong" else (0, 1)
    for azimuth in [()] if len(ARGUMENTS[name]) == 2 else [(0,), (0.3,)]:
        rough = [sp.S(mirror if mirror == 0 else sp.oo)] * (len(ARGUMENTS[name]) - 1 - len(azimuth))
        assert lower(getattr(D, name)(T, *azimuth, *rough), (T,))(1.0) == math.inf
        assert lower(getattr(D, name)(T, *azimuth, *rough), (T,))(0.9) == 0
        place = (0.9, *azimuth, *(diffuse for _ in rough))
        expected = PRINTED[name](*map(mpf, place))
        assert lower(getattr(D, name)(T, *place[1:]), (T,))(0.9) == pytest.approx(float(expected), rel=1e-14)


COSINES = [-1, -0.5, -1e-300, 0, 1e-300, 1e-30, 1e-10, 1e-3, 0.3, 0.5, 0.7, 0.99, 1 - 1e-7, 1 - 2**-53, 1, 1 + 2**-52]
AZIMUTHS = [0, 1e-30, 1e-8, 0.3, 0.7, 1 - 1e-7, 1]
ROUGH = [0, 1e-300, 1e-40, 1e-30, 1e-16, 1e-15, 1e-12, 1e-6, 1e-3, 0.1, 0.5, 0.9, 1]
ROUGHER = [*ROUGH, 2, 10]
RANGES = {T: COSINES, W: AZIMUTHS, A: ROUGHER, B: ROUGHER}


def grid(name, dtype, ranges=RANGES):
    axes = [ranges[letter] for letter in (ARGUMENTS | LIGHT)[name]]
    if name in UP_TO_ONE:
        axes = [[value for value in axis if value <= 1 or axis is ranges[T]] for axis in axes]
    if name == "phong":
        axes = [axes[0], [0, 1e-30, 0.5, 1, 2, 100, 1e6, 1e20, 1e36, 1e300, INFINITE]]
    with np.errstate(over="ignore"):
        return np.array(list(itertools.product(*axes))).astype(dtype).T


SMOOTH = {T: [-0.5, 0, 1e-18, 1e-6, 0.3, 0.5, 0.999, 1], W: [0, 0.3, 1], A: [1e-6, 1e-3, 0.3, 1], B: [1e-6, 0.3, 1]}
AT_DIRAC = {T: [-0.5, 0, 0.3, 0.9], W: [0.3, 0.7], A: [0, 0.3], B: [0, 0.3]}


PLACES = {1: [(0.6,), (1,)], 2: [(0.8, 0.4), (1, 0.6)], 4: [(0.8, 0.3, 0.4, 0.7), (1, 0.3, 0.6, 0.5)]}


def smooth(name, dtype):
    """Where a gradient must be finite."""
    if name == "ward_third_form_as_printed":
        return np.empty((4, 0), dtype)  # it overflows everywhere near
    points = np.concatenate([grid(name, dtype, SMOOTH), grid(name, dtype, AT_DIRAC)], axis=1)
    if name == "phong":  # its slope at the horizon is infinite for exponents below 1
        points = points[:, (points[1] < 1e10) & ((points[0] > 1e-20) | (points[1] == 0) | (points[1] >= 1))]
    return points


TYPED = [(name, np.float64) for name in (*PRINTED, *LIGHT)]
TYPED += [  # what is printed shares the code of the others
    pytest.param(name, np.float32, marks=pytest.mark.thorough) for name, _ in TYPED if not name.endswith("printed")
]


@pytest.mark.parametrize(("name", "dtype"), TYPED)
def test_no_value_of_the_closed_domain_is_nan_and_no_gradient_where_it_is_smooth(name, dtype):
    jax = pytest.importorskip("jax")
    swept, near = grid(name, dtype), smooth(name, dtype)
    places = np.array(PLACES[len(swept)], dtype).T
    points = np.concatenate([places, near, swept], axis=1)
    count = len(places[0]) + len(near[0])
    with jax.enable_x64(dtype is np.float64):
        function = jax.value_and_grad(lowered(name, "jax"), argnums=tuple(range(len(points))))
        values, slopes = jax.jit(jax.vmap(function))(*points)
        for found in (lowered(name)(*points), np.asarray(values)):
            assert found.dtype == dtype
            wrong = ~(found >= 0)
            assert not wrong.any(), points[:, wrong][:, :3]
        for part in map(np.asarray, slopes):
            wrong = ~np.isfinite(part[:count])
            assert not wrong.any(), points[:, :count][:, wrong][:, :3]
    if dtype is np.float64 and name in PRINTED:
        at_places = [[float(part[column]) for part in slopes] for column in range(2)]
        assert at_places == pytest.approx(np.array([printed_slopes(name, place) for place in places.T]), rel=1e-9)


def printed_slopes(name, place):
    orders = np.eye(len(place), dtype=int)
    with mpmath.workdps(30):
        return [float(mpmath.diff(PRINTED[name], tuple(map(mpf, place)), tuple(map(int, row)))) for row in orders]
