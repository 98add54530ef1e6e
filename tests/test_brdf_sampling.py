"""Samples against their densities: inverses of the integrals of D, and chi-square of directions drawn with one seed."""

import math

import mpmath
import numpy as np
import pytest
import scipy.stats
import sympy as sp
from mpmath import mpf

from ratfit._lower import lower
from ratfit.brdf import distribution as D
from ratfit.brdf import roughness, sampling

pytestmark = pytest.mark.thorough  # long sweeps of formulas that seldom change

a, b, p, t, u, v, v_prime, w, phi, rough = sp.symbols("a b p t u v v_prime w phi rough", real=True)
F, G = sp.symbols("F G", real=True)

PRINTED = {
    "ggx": lambda t, a: a**2 / (mpmath.pi * (t**2 * (a**2 - 1) + 1) ** 2),
    "beckmann": lambda t, a: mpmath.exp((t**2 - 1) / (t * a) ** 2) / (mpmath.pi * a**2 * t**4),
    "phong": lambda t, n: (n + 2) / (2 * mpmath.pi) * t**n,
}
ZENITHS = {  # name: (cosine, sine, distribution)
    "ggx": (sampling.ggx_cosine(a, rough), sampling.ggx_sine(a, rough), D.ggx(t, rough)),
    "beckmann": (sampling.beckmann_cosine(a, rough), sampling.beckmann_sine(a, rough), D.beckmann(t, rough)),
    "phong": (sampling.phong_cosine(a, rough), sampling.phong_sine(a, rough), D.phong(t, rough)),
}
SETTINGS = [("ggx", 0.1), ("ggx", 0.7), ("beckmann", 0.1), ("beckmann", 0.7), ("phong", 0), ("phong", 1), ("phong", 60)]


@pytest.mark.parametrize(("name", "value"), SETTINGS)
def test_the_share_of_the_distribution_below_the_cosine_is_the_uniform_number(name, value):
    cosine, sine, _ = (lower(formula, (a, rough)) for formula in (*ZENITHS[name][:2], sp.S.One))
    for number in (0.01, 0.3, 0.9):
        drawn = cosine(number, float(value))
        share = mpmath.quad(lambda t: 2 * mpmath.pi * t * PRINTED[name](t, mpf(value)), [0, drawn / 2, drawn])
        assert float(share) == pytest.approx(number, abs=1e-12)
        assert sine(number, float(value)) == pytest.approx(math.sqrt((1 - drawn) * (1 + drawn)), rel=1e-12)


def test_the_zenith_of_schlick_as_printed_is_that_of_ggx():
    r = sp.Symbol("r", positive=True)
    printed = sp.sqrt(a / (r - a * r + a))
    number, isotropic = sp.Rational(1, 3), sp.Rational(1, 7)
    ours = sampling.ggx_cosine(a, roughness.ggx_from_r(r))
    assert sp.simplify((ours - printed).subs({a: number, r: isotropic})) == 0


@pytest.mark.parametrize("name", ZENITHS)
def test_a_narrow_lobe_keeps_its_sine_in_float32(name):
    narrow = 1e-5 if name != "phong" else 2e10
    sine = lower(ZENITHS[name][1], (a, rough))
    numbers = np.array([0.01, 0.5, 0.99, 1 - 1e-6], np.float32)
    expected = sine(numbers.astype(float), narrow)
    assert sine(numbers, np.float32(narrow)) == pytest.approx(expected, rel=1e-5)
    assert expected.max() < 1e-4


ENDS = [
    ("ggx", 1, 0.3, 1, 0), ("ggx", 0, 0.3, 0, 1), ("ggx", 0, 0, 1, 0), ("ggx", 0.5, 0, 1, 0),
    ("beckmann", 1, 0.3, 1, 0), ("beckmann", 0, 0.3, 0, 1), ("beckmann", 0, 0, 1, 0), ("beckmann", 0.5, 0, 1, 0),
    ("phong", 1, 3, 1, 0), ("phong", 0, 3, 0, 1), ("phong", 0, math.inf, 1, 0), ("phong", 0.5, math.inf, 1, 0),
]  # fmt: skip


@pytest.mark.parametrize(("name", "number", "value", "cosine", "sine"), ENDS)
def test_ends_of_the_zenith(name, number, value, cosine, sine):
    found = [lower(formula, (a, rough))(number, value) for formula in ZENITHS[name][:2]]
    assert found == pytest.approx([cosine, sine], abs=1e-17)


NUMBERS = np.array([0, 1e-300, 1e-40, 1e-8, 0.25, 0.5, 0.75, 1 - 1e-7, 1])
ROUGH = np.array([0, 1e-300, 1e-30, 1e-12, 1e-3, 0.5, 1, 5])
EVERY = {
    **{f"{name} {part}": (formulas[index], (a, rough)) for name, formulas in ZENITHS.items()
       for index, part in enumerate(("cosine", "sine"))},
    "azimuth": (sampling.azimuth(a, rough), (a, rough)),
    "full azimuth": (sampling.full_azimuth(a, rough), (a, rough)),
    "azimuth as printed": (sampling.azimuth_as_printed(a, sp.Min(rough, 1)), (a, rough)),
    "light": (sampling.light_density(D.ggx(t, rough), t, a), (t, a, rough)),
    "half vector": (sampling.half_vector_density(D.beckmann(t, rough), t), (t, rough)),
    "weight": (sampling.microfacet_weight(t, a, v, v_prime, sp.S.One, sp.S.One), (t, a, v, v_prime)),
}  # fmt: skip
AXES = {a: NUMBERS, rough: ROUGH, t: np.append(NUMBERS, -0.5), v: np.append(NUMBERS, -0.5), v_prime: [-0.5, 0, 1e-9, 1]}


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("name", EVERY)
def test_nothing_is_nan(name, dtype):
    jax = pytest.importorskip("jax")
    formula, arguments = EVERY[name]
    with np.errstate(over="ignore"):
        axes = np.meshgrid(*(np.asarray(AXES[argument]) for argument in arguments))
        points = [axis.ravel().astype(dtype) for axis in axes]
    with jax.enable_x64(dtype is np.float64):
        for function in (lower(formula, arguments), jax.jit(lower(formula, arguments, "jax"))):
            values = np.asarray(function(*points))
            assert values.dtype == dtype
            assert not np.isnan(values).any(), [point[np.isnan(values)][:3] for point in points]


@pytest.mark.parametrize(
    "name", ["ggx cosine", "ggx sine", "beckmann cosine", "beckmann sine", "azimuth", "full azimuth"]
)
def test_gradients_are_finite(name):
    jax = pytest.importorskip("jax")
    formula, arguments = EVERY[name]
    points = [axis.ravel().astype(np.float32) for axis in np.meshgrid([1e-6, 0.3, 0.7, 0.999], [0, 1e-6, 0.3, 1])]
    for slope in jax.jit(jax.vmap(jax.grad(lower(formula, arguments, "jax"), argnums=(0, 1))))(*points):
        assert np.isfinite(np.asarray(slope)).all()


# --- the azimuth of schlick1994 --------------------------------------------------------------------------------------


def factor(phi, p):
    """A in the form that keeps Eq. 27."""
    return p / (p**2 * mpmath.sin(phi) ** 2 + mpmath.cos(phi) ** 2)


@pytest.mark.parametrize("isotropy", [0.02, 0.3, 1])
def test_the_share_of_the_factor_below_the_azimuth_is_the_uniform_number(isotropy):
    for number in (0.05, 0.5, 0.95):
        drawn = lower(sampling.azimuth(b, p), (b, p))(number, isotropy)
        share = mpmath.quad(lambda phi: factor(phi, mpf(isotropy)) * 2 / mpmath.pi, [0, drawn / 2, drawn])
        assert float(share) == pytest.approx(number, abs=1e-9)
        back = lower(sampling.azimuth_distribution(phi, p), (phi, p))(drawn, isotropy)
        assert back == pytest.approx(number, abs=1e-14)
        printed = lower(sp.atan(sp.tan(sp.pi * b / 2) / p), (b, p))(number, isotropy)
        assert drawn == pytest.approx(printed, abs=1e-14)


def test_the_whole_circle_is_four_quadrants():
    quadrant, circle = (lower(f(b, p), (b, p)) for f in (sampling.azimuth, sampling.full_azimuth))
    numbers = np.linspace(0.01, 0.99, 7)
    first = quadrant(numbers, 0.3)
    for turn, expected in ((0, first), (1, np.pi - first[::-1]), (2, first - np.pi), (3, -first[::-1])):
        assert circle((turn + numbers) / 4, 0.3) == pytest.approx(expected, abs=1e-13)
    turn = lower(sampling.uniform_azimuth(b), (b,))(numbers)
    assert circle(numbers, 1.0) % (2 * np.pi) == pytest.approx(turn, abs=1e-13)


def test_the_azimuth_of_eq_29_as_printed_is_wrong_end_first():
    isotropy = 0.2
    drawn = lower(sampling.azimuth_as_printed(b, p), (b, p))
    density = lower(sampling.azimuth_as_printed_density(phi, p), (phi, p))
    numbers, step = np.linspace(0.05, 0.95, 7), 1e-5
    slope = (drawn(numbers + step, isotropy) - drawn(numbers - step, isotropy)) / (2 * step)
    assert density(drawn(numbers, isotropy), isotropy) == pytest.approx(1 / slope, rel=1e-6)
    total = mpmath.quad(lambda angle: density(float(angle), isotropy), [0, 0.3, mpmath.pi / 2])
    assert float(total) == pytest.approx(1, abs=1e-9)
    along, across = density(np.array([0, math.pi / 2]), isotropy)
    assert (along, across) == pytest.approx((2 / (math.pi * isotropy), 2 * isotropy**2 / math.pi))
    wanted = [float(factor(mpf(angle), isotropy) * 2 / mpmath.pi) for angle in (0, math.pi / 2)]
    assert along > 20 * wanted[0] and across < wanted[1] / 20


@pytest.mark.parametrize("isotropy", [0.1, 0.6])
def test_the_azimuth_that_the_printed_factor_needs_is_the_jacobi_amplitude(isotropy):
    """am(b K, k) by mpmath's sn; its share under the square root of A is b."""
    parameter = 1 - mpf(isotropy) ** 2
    for number in (0.2, 0.8):
        amplitude = mpmath.asin(mpmath.ellipfun("sn", number * mpmath.ellipk(parameter), m=parameter))
        share = sampling.azimuth_distribution_as_printed(phi, p).subs({phi: sp.Float(amplitude), p: isotropy})
        assert float(share) == pytest.approx(number, abs=1e-12)
        below, whole = (
            mpmath.quad(lambda angle: mpmath.sqrt(factor(angle, mpf(isotropy))), [0, end / 2, end])
            for end in (amplitude, mpmath.pi / 2)
        )
        assert float(below / whole) == pytest.approx(number, abs=1e-9)


# --- directions ------------------------------------------------------------------------------------------------------

COUNT, SIDE = 100_000, 16
SMOOTH, ROUGHER = 0.25, 0.6  # along the tangent and across, of the elliptical lobes
LOBES = {  # name: (distribution, which zenith, its roughness, isotropy)
    "ggx": (D.ggx(t, 0.4), "ggx", 0.4, 1),
    "beckmann": (D.beckmann(t, 0.4), "beckmann", 0.4, 1),
    "phong": (D.phong(t, 12), "phong", 12, 1),
    "schlick": (D.schlick(t, w, 0.16, 0.3), "ggx", 0.4, 0.3),
    "ggx_anisotropic": (D.ggx_anisotropic(t, w, SMOOTH, ROUGHER), "ggx", None, SMOOTH / ROUGHER),
    "ward": (D.ward(t, w, SMOOTH, ROUGHER), "beckmann", None, SMOOTH / ROUGHER),
}
VIEW = np.array([math.sin(0.7) * math.cos(0.4), math.sin(0.7) * math.sin(0.4), math.cos(0.7)])


def half_vectors(name):
    _, zenith, value, isotropy = LOBES[name]
    first, second = np.random.default_rng(11).random((2, COUNT))
    angle = lower(sampling.full_azimuth(b, p), (b, p))(second, isotropy)
    if value is None:
        value = lower(roughness.alpha_at(w, a, b), (w, a, b))(np.cos(angle), SMOOTH, ROUGHER)
    z, s = (lower(formula, (a, rough))(first, value) for formula in ZENITHS[zenith][:2])
    return np.stack([s * np.cos(angle), s * np.sin(angle), z], axis=-1)


def cells(directions):
    """In which of the SIDE x SIDE cells of equal solid angle a direction of the sphere lies."""
    zenith = np.clip((directions[..., 2] + 1) * SIDE / 2, 0, SIDE - 1).astype(int)
    azimuth = (np.arctan2(directions[..., 1], directions[..., 0]) / (2 * np.pi) % 1 * SIDE).astype(int) % SIDE
    return zenith * SIDE + azimuth


def sphere(fine=40):
    """Midpoints of a fine grid of equal solid angles, and the solid angle of each."""
    side = SIDE * fine
    z, angle = (np.arange(side) + 0.5) * 2 / side - 1, (np.arange(side) + 0.5) * 2 * np.pi / side
    z, angle = np.meshgrid(z, angle, indexing="ij")
    s = np.sqrt(1 - z**2)
    return np.stack([s * np.cos(angle), s * np.sin(angle), z], axis=-1), 4 * np.pi / side**2


@pytest.mark.parametrize("name", LOBES)
def test_drawn_light_has_its_density(name):
    halves = half_vectors(name)
    across = halves @ VIEW
    lights = (2 * across[:, None] * halves - VIEW)[across > 0]
    assert np.linalg.norm(lights, axis=-1) == pytest.approx(1, abs=1e-12)

    grid, solid_angle = sphere()
    half = grid + VIEW
    half /= np.linalg.norm(half, axis=-1, keepdims=True)
    planar = np.hypot(half[..., 0], half[..., 1])
    density = lower(sampling.light_density(LOBES[name][0], t, u), (t, u, w))
    values = density(half[..., 2], half @ VIEW, half[..., 0] / planar)
    expected = np.bincount(cells(grid).ravel(), values.ravel() * solid_angle, SIDE**2)
    assert expected.sum() == pytest.approx(len(lights) / COUNT, abs=0.004)  # the rest of the facets are not seen

    found = np.bincount(cells(lights), minlength=SIDE**2)
    expected *= COUNT
    enough = expected > 20
    statistic = ((found - expected)[enough] ** 2 / expected[enough]).sum()
    assert statistic < scipy.stats.chi2.ppf(1 - 1e-4, enough.sum())
    assert abs(found[~enough].sum() - expected[~enough].sum()) < 5 * math.sqrt(expected[~enough].sum() + 1)


def test_the_wrong_azimuth_fails_the_same_test():
    numbers = np.random.default_rng(11).random(COUNT)
    drawn = lower(sampling.azimuth_as_printed(b, p), (b, p))(numbers, 0.3)
    edges = np.linspace(0, np.pi / 2, 17)
    expected = COUNT * np.diff(lower(sampling.azimuth_distribution(phi, p), (phi, p))(edges, 0.3))
    right = lower(sampling.azimuth(b, p), (b, p))(numbers, 0.3)
    statistics = [((np.histogram(angles, edges)[0] - expected) ** 2 / expected).sum() for angles in (right, drawn)]
    assert statistics[0] < scipy.stats.chi2.ppf(1 - 1e-4, 15) < 1000 < statistics[1]


def test_weights_are_reflectance_times_cosine_over_density():
    d = sp.Symbol("d", positive=True)
    inside = {t: sp.Rational(5, 7), u: sp.Rational(3, 5), v: sp.Rational(1, 3), v_prime: sp.Rational(11, 21)}
    reflectance = d * F * G / (4 * v * v_prime)
    weight = sampling.microfacet_weight(t, u, v, v_prime, F, G)
    assert sp.simplify((weight - reflectance * v_prime / sampling.light_density(d, t, u)).subs(inside)) == 0
    ratio = reflectance * v_prime / sampling.cosine_density(v_prime) - sampling.cosine_weight(reflectance)
    assert sp.simplify(ratio.subs(inside)) == 0


def test_the_cosine_draws_its_density():
    drawn = lower(sampling.cosine_cosine(a), (a,))(np.array([0, 0.25, 1]))
    assert drawn == pytest.approx([0, 0.5, 1])
    cosine = sp.Symbol("c", positive=True)
    share = sp.integrate(2 * sp.pi * sampling.cosine_density(v_prime).subs(v_prime, cosine), (cosine, 0, sp.sqrt(b**2)))
    assert sp.simplify(share - b**2) == 0
    assert sampling.cosine_cosine(a) ** 2 + sampling.cosine_sine(a) ** 2 == 1
