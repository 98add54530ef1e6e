"""The Fresnel factor and its approximations against refraction at 50 digits; the tables of optical constants."""

import itertools
import math
import tomllib
from importlib.resources import files
from pathlib import Path

import mpmath
import numpy as np
import pytest
import sympy as sp

from ratfit import brdf
from ratfit._lower import lower
from ratfit._parse import RatfitError
from ratfit.brdf import fresnel, metals

pytestmark = pytest.mark.thorough  # long sweeps of formulas that seldom change

U, ETA, KAPPA, F, N = sp.symbols("u eta kappa f n", real=True)

COSINES = (0.0, 1e-30, 1e-8, 1e-3, 0.1, 0.3, 0.5, 0.6, 0.75, 0.9, 0.99, 1 - 2.0**-53, 1.0)
INDICES = (0.0, 0.02, 0.5, 0.9, 1.0, 1.0 + 2.0**-20, 1.1, 1.33, 1.5, 2.417, 6.0, 40.0)
EXTINCTIONS = (0.0, 1e-9, 1e-3, 0.5, 2.0, 8.0, 60.0)
REFLECTANCES = (0.0, 1e-6, 0.04, 0.5, 0.99, 1.0)


def refraction(u, eta, kappa):
    """The mean reflectance of both polarisations by Snell's law with a complex index, at 50 digits."""
    with mpmath.workdps(50):
        u, index = mpmath.mpf(u), mpmath.mpc(eta, kappa)
        w = mpmath.sqrt(index**2 - (1 - u) * (1 + u))  # the index times the refracted ray's cosine
        across, along = (u - w) / (u + w), (index**2 * u - w) / (index**2 * u + w)
        return (abs(across) ** 2 + abs(along) ** 2) / 2


def power(u, f, n=5):
    return f + (1 - f) * (1 - u) ** n


REFERENCES = {
    "schlick": (fresnel.schlick(U, F), power),
    "schlick_clamped": (fresnel.schlick_clamped(U, F), power),
    "schlick_as_printed": (fresnel.schlick_as_printed(U, F), lambda u, f: 1 + (1 - f) * (1 - u) ** 5),
    "spherical_gaussian": (fresnel.spherical_gaussian(U, F), lambda u, f: f + (1 - f) * mpmath.exp(-6 * u)),
    "karis": (
        fresnel.karis(U, F),
        lambda u, f: f + (1 - f) * 2 ** -(mpmath.mpf("5.55473") * u**2 + mpmath.mpf("6.98316") * u),
    ),
    "smoothie": (
        fresnel.smoothie(U, F),  # of L.h, from the vectors themselves
        lambda u, f: f + (1 - f) * 2 ** -(mpmath.mpf("1.71983") + mpmath.mpf("5.43926") * dot_with_half(u)),
    ),
}
"""Name -> the formula and a function of mpmath, in u and f."""

EVERY = {name: (formula, (U, F)) for name, (formula, _) in REFERENCES.items()} | {
    "conductor": (fresnel.conductor(U, ETA, KAPPA), (U, ETA, KAPPA)),
    "dielectric": (fresnel.dielectric(U, ETA), (U, ETA)),
    "lazanyi": (fresnel.lazanyi(U, ETA, KAPPA), (U, ETA, KAPPA)),
    "normal": (fresnel.normal(ETA, KAPPA), (ETA, KAPPA)),
    "spectral": (fresnel.spectral(U, ETA, F).subs(ETA, N), (U, N, F)),
}
"""Name -> the formula and its arguments: what is swept for nan, and for slopes."""

CLOSED = {U: COSINES, ETA: INDICES, KAPPA: EXTINCTIONS, F: REFLECTANCES, N: REFLECTANCES}


def dot_with_half(u):
    """L.h with h = L + V not normalised, for V mirrored to L about a normal at the cosine u."""
    u = mpmath.mpf(u)
    s = mpmath.sqrt(1 - u**2)
    light, view = (s, u), (-s, u)
    half = [a + b for a, b in zip(light, view, strict=True)]
    return sum(a * b for a, b in zip(light, half, strict=True))


def ulps(got, want, dtype=np.float64):
    """How many units in the last place of the true value a result is off."""
    return float(abs(mpmath.mpf(float(got)) - want) / mpmath.mpf(float(np.spacing(dtype(abs(float(want)))))))


def grid(arguments):
    """All combinations of the values of some arguments, as arrays."""
    return np.array(list(itertools.product(*(CLOSED[each] for each in arguments)))).T


def random_places(ranges, count=300):
    places = np.random.default_rng(5).random((len(ranges), count))
    return [low + (high - low) * row for row, (low, high) in zip(places, ranges, strict=True)]


# The limits in ulp are those of the module's own text.
KINDS = {
    "metals": ((0.02, 10), (1, 20), 4),
    "semiconductors": ((1.5, 6), (0.01, 1), 4.1),
    "glass": ((1.05, 10), (0, 0), 5.6),
    "almost nothing": ((1 + 1e-6, 1.05), (0, 1e-3), 7.7),
    "from the denser side": ((0.5, 0.95), (0, 0), 5.3),
    "thin metals": ((0.02, 1), (0.1, 1), 8.7),
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("dtype", [np.float64, np.float32])
def test_conductor_and_dielectric_agree_with_refraction(kind, dtype):
    etas, kappas, most = KINDS[kind]
    u, eta, kappa = (row.astype(dtype) for row in random_places(((0, 1), etas, kappas)))
    found = {"conductor": lower(fresnel.conductor(U, ETA, KAPPA), (U, ETA, KAPPA))(u, eta, kappa)}
    if kappas == (0, 0):
        found["dielectric"] = lower(fresnel.dielectric(U, ETA), (U, ETA))(u, eta)
    for each in found.values():
        assert each.dtype == dtype
        off = []
        for place in range(len(u)):
            if (
                abs(complex(eta[place], kappa[place]) ** 2 - 1 + float(u[place]) ** 2) < 0.2
                and kind != "almost nothing"
            ):
                continue  # near the critical angle
            want = refraction(*(float(row[place]) for row in (u, eta, kappa)))
            off.append(ulps(each[place], want, dtype))
        assert max(off) <= most and np.mean(np.array(off) <= 4) > 0.99


@pytest.mark.parametrize(
    ("formula", "reference"),
    [
        (fresnel.lazanyi(U, ETA, KAPPA), lambda u, n, k: 1 - 4 * n * (1 - (1 - u) ** 5) / ((n + 1) ** 2 + k**2)),
        (fresnel.normal(ETA, KAPPA), lambda u, n, k: abs((mpmath.mpc(n, k) - 1) / (mpmath.mpc(n, k) + 1)) ** 2),
        (fresnel.index(U), lambda u, n, k: (1 + mpmath.sqrt(u)) / (1 - mpmath.sqrt(u))),
    ],
)
def test_what_belongs_to_an_index_is_within_four_ulp(formula, reference):
    places = random_places(((0, 1), (0.02, 6), (0, 10)))
    found = lower(formula, (U, ETA, KAPPA))(*places)
    with mpmath.workdps(50):
        for *place, value in zip(*places, found, strict=True):
            assert ulps(value, reference(*map(mpmath.mpf, place))) <= 4


@pytest.mark.parametrize("u", [sp.Rational(1, 100), sp.Rational(1, 2), sp.Rational(4, 5), sp.S.One])
@pytest.mark.parametrize("eta, kappa", [("3/2", 0), ("29/100", "2.863"), ("1/20", 4), ("1.02", "2.577"), (3, "1/1000")])
def test_the_printed_conductor_is_the_same_function(u, eta, kappa):
    place = (u, sp.Rational(eta), sp.Rational(kappa))
    want = refraction(*(mpmath.mpf(each.p) / each.q for each in place))
    for formula in (fresnel.conductor, fresnel.conductor_as_printed):
        assert abs(mpmath.mpf(sp.N(formula(*place), 40)) - want) < 1e-14  # the reference's quotients are doubles
    assert abs(sp.N(fresnel.conductor(*place) - fresnel.conductor_as_printed(*place), 40)) < 1e-35


@pytest.mark.parametrize("eta", [sp.Rational(11, 10), sp.Rational(3, 2), sp.Rational("2.417")])
@pytest.mark.parametrize("u", [sp.Rational(1, 10), sp.Rational(9, 10)])
def test_the_printed_dielectric_lacks_total_reflection_alone(u, eta):
    assert abs(sp.N(fresnel.dielectric(u, eta) - fresnel.dielectric_as_printed(u, eta), 40)) < 1e-35
    inside = fresnel.dielectric_as_printed(u, 1 / eta)
    if u**2 > 1 - 1 / eta**2:
        assert abs(sp.N(fresnel.dielectric(u, 1 / eta) - inside, 40)) < 1e-35
    else:
        assert fresnel.dielectric(u, 1 / eta) == fresnel.conductor(u, 1 / eta, sp.S.Zero) == 1
        assert sp.im(sp.N(inside, 20)) != 0


def test_both_sides_of_a_surface_reflect_the_same_part():
    """A ray and the ray it is refracted to, by Snell's law: u' = sqrt(1 - (1 - u**2)/eta**2), the index 1/eta."""
    formula = lower(fresnel.dielectric(U, ETA), (U, ETA))
    u, eta = random_places(((0.05, 1), (1.2, 3)))
    np.testing.assert_allclose(formula(np.sqrt(1 - (1 - u**2) / eta**2), 1 / eta), formula(u, eta), rtol=1e-12)


def test_brewster_reflects_half_of_one_polarisation():
    """At tan(angle) = eta one polarisation is refracted whole: F = ((eta**2 - 1)/(eta**2 + 1))**2/2."""
    for eta in (sp.Rational(4, 3), sp.Rational(3, 2), sp.Rational(5, 2)):
        found = fresnel.dielectric(1 / sp.sqrt(1 + eta**2), eta)
        assert sp.simplify(found - ((eta**2 - 1) / (eta**2 + 1)) ** 2 / 2) == 0


def compiled(name, backend):
    """The formula of a name on arrays, compiled on JAX, as a function that gives a NumPy array."""
    import jax

    function = lower(*EVERY[name], backend)
    function = jax.jit(function) if backend == "jax" else function

    def evaluate(*values):
        with jax.enable_x64(True):
            return np.asarray(function(*values))

    return evaluate


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("backend", ["numpy", "jax"])
def test_limits(backend, dtype):
    eta, kappa = grid((ETA, KAPPA)).astype(dtype)
    f, eps = np.array(REFLECTANCES, dtype), np.finfo(dtype).eps
    conductor, dielectric, spectral, schlick = (
        compiled(name, backend) for name in ("conductor", "dielectric", "spectral", "schlick")
    )
    assert np.all(conductor(0 * eta, eta, kappa) == 1) and np.all(dielectric(0 * eta, eta) == 1)
    near = {"rtol": 40 * eps, "atol": 1e-37}  # an index near 0 is near its critical angle
    normal = lower(*EVERY["normal"])
    np.testing.assert_allclose(conductor(0 * eta + 1, eta, kappa), normal(eta, kappa), **near)
    np.testing.assert_allclose(dielectric(0 * eta + 1, eta), normal(eta, 0 * eta), **near)
    assert np.all(spectral(0 * f + 1, 0 * f + 1, f) == f)
    assert np.all(spectral(0 * f + dtype(0.3), 0 * f + dtype(0.9), f) == f)
    assert np.all(schlick(0 * f, f) == 1) and np.all(schlick(0 * f + 1, f) == f)


@pytest.mark.parametrize("name", EVERY)
@pytest.mark.parametrize("backend", ["numpy", "jax"])
def test_no_nan_in_the_closed_domain(name, backend):
    function, places = compiled(name, backend), grid(EVERY[name][1])
    for dtype in (np.float64, np.float32):
        found = function(*places.astype(dtype))
        assert found.dtype == dtype and np.all(np.isfinite(found))
        if not name.endswith("as_printed"):
            assert found.min() >= -4 * np.finfo(dtype).eps and found.max() <= 1 + 4 * np.finfo(dtype).eps


@pytest.mark.parametrize("name", ["conductor", "dielectric", "lazanyi"])
def test_a_cosine_that_rounding_made_greater_than_one(name):
    function, arguments = lower(*EVERY[name]), EVERY[name][1]
    _, *rest = grid((U, *arguments[1:]))[:, : len(INDICES) * len(EXTINCTIONS)]
    over, at_one = (function(np.full_like(rest[0], u), *rest) for u in (1 + 2.0**-52, 1.0))
    np.testing.assert_allclose(over, at_one, atol=1e-12)


SMOOTH = {
    "conductor": lambda u, eta, kappa: abs(complex(eta, kappa) ** 2 - 1 + u * u) > 1e-3 and complex(eta, kappa) != 0,
    "dielectric": lambda u, eta: abs(eta**2 - 1 + u * u) > 1e-3,
    "normal": lambda eta, kappa: True,
    "spectral": lambda u, n, f: abs(u - n) > 1e-3 and n < 1,
}
"""Where a formula is smooth; the others are everywhere."""


@pytest.mark.parametrize("name", EVERY)
def test_slopes_are_finite_and_right_where_the_formula_is_smooth(name):
    import jax

    formula, arguments = EVERY[name]
    smooth = SMOOTH.get(name, lambda *place: True)
    places = np.array([place for place in grid(arguments).T if smooth(*place)]).T
    with jax.enable_x64(True):
        function = lower(formula, arguments, "jax")
        slopes = jax.jit(jax.vmap(jax.grad(function, tuple(range(len(arguments))))))(*places)
    assert all(np.all(np.isfinite(each)) for each in slopes)


@pytest.mark.parametrize("u, eta, kappa", [(0.0, 0.29, 2.863), (0.0, 1.5, 0.0), (0.4, 1.5, 0.0), (0.4, 0.05, 3.9)]
    + [(0.9, 1.02, 2.577), (1.0, 1.0, 1.0), (0.95, 1.2, 1e-3), (0.6, 0.6, 0.0), (1.0, 2.417, 0.0)])  # fmt: skip
def test_slopes_of_the_conductor_are_those_of_refraction(u, eta, kappa):
    """(1, 1, 1) lies on the seam of the branches, where |w|**2 has no real part."""
    import jax

    with jax.enable_x64(True):
        function = lower(fresnel.conductor(U, ETA, KAPPA), (U, ETA, KAPPA), "jax")
        found = jax.grad(function, (0, 1, 2))(u, eta, kappa)
    total = eta**2 - 1 + u**2 < 0 and kappa == 0
    want = (0, 0) if total else [central_difference((u, eta, kappa), which) for which in (0, 1)]
    np.testing.assert_allclose([float(each) for each in found[:2]], want, rtol=1e-12, atol=1e-13)


def central_difference(place, which):
    """The slope of `refraction` along one of its arguments."""
    with mpmath.workdps(50):
        step = mpmath.mpf("1e-12")
        up, down = ([mpmath.mpf(x) + side * step * (i == which) for i, x in enumerate(place)] for side in (1, -1))
        return float((refraction(*up) - refraction(*down)) / (2 * step))


def test_kappa_is_smooth_at_zero():
    """F depends on kappa by its square where nothing is reflected totally."""
    import jax

    with jax.enable_x64(True):
        function = lower(fresnel.conductor(U, ETA, KAPPA), (U, ETA, KAPPA), "jax")
        assert abs(float(jax.grad(function, 2)(0.5, 1.5, 0.0))) == 0


@pytest.mark.parametrize("name", REFERENCES)
def test_approximations_agree_with_their_definitions(name):
    formula, reference = REFERENCES[name]
    function = lower(formula, (U, F))
    for low, most in ((0.0, 13), (0.01, 6)):
        u, f = random_places(((0, 1), (low, 1 if low else 0)))
        with mpmath.workdps(50):
            worst = max(
                ulps(function(x, y), reference(mpmath.mpf(x), mpmath.mpf(y))) for x, y in zip(u, f, strict=True)
            )
        assert worst <= (5 if name.startswith("schlick") or name == "spherical_gaussian" else most)


def test_lazanyi_is_exact_at_both_ends():
    f = fresnel.normal(ETA, KAPPA)
    assert sp.simplify(fresnel.lazanyi(sp.S.One, ETA, KAPPA) - f) == 0
    assert sp.simplify(fresnel.lazanyi(sp.S.Zero, ETA, KAPPA) - 1) == 0
    assert sp.simplify(fresnel.lazanyi(U, ETA, KAPPA) - fresnel.schlick(U, f)) == 0


def test_what_is_printed_wrong():
    third = sp.Rational(1, 3)
    assert (
        fresnel.schlick_as_printed(sp.S.Zero, third) == 2 - third and fresnel.schlick_as_printed(sp.S.One, third) == 1
    )
    assert fresnel.spectral_as_printed(sp.S.One, sp.S.One, third) is sp.nan
    assert fresnel.spectral(sp.S.One, sp.S.One, third) == third
    assert fresnel.conductor_as_printed(sp.S.Zero, sp.S(2), sp.S.One) is sp.nan
    assert fresnel.conductor(sp.S.Zero, sp.S(2), sp.S.One) == 1


def test_aluminium_falls_below_its_normal_reflectance():
    """Why Eq. 14 needs a clamp; the whole composition is lowered, conditions within."""
    eta, kappa = metals.material("aluminium").at()
    average, normal = fresnel.conductor(U, eta, kappa), fresnel.normal(eta, kappa)
    u = np.linspace(0, 1, 1001)
    assert lower(average, (U,))(u).min() < float(normal) - 0.02
    printed = lower(fresnel.spectral_as_printed(average, normal, F), (U, F))(u, 0.5)
    clamped = lower(fresnel.spectral(average, normal, F), (U, F))(u, 0.5)
    assert printed.min() < 0.4 and clamped.min() == 0.5 and clamped.max() <= 1 + 1e-15
    np.testing.assert_allclose(np.maximum(printed, 0.5), clamped, atol=1e-15)


def test_an_exponent_that_is_no_integer_takes_any_clamped_cosine():
    u = np.array([-0.2, 0, 0.5, 1, 1 + 2.0**-52])
    found = lower(fresnel.schlick_clamped(U, F, N), (U, F, N))(u, 0.04, 4.5)
    np.testing.assert_allclose(found, [1, 1, 0.04 + 0.96 * 0.5**4.5, 0.04, 0.04], rtol=1e-15)


@pytest.mark.parametrize("eta", [1, sp.Rational(4, 3), sp.Rational(3, 2), sp.Rational("2.417")])
def test_index_undoes_normal(eta):
    assert fresnel.index(fresnel.normal(sp.sympify(eta))) == eta
    assert fresnel.normal(1 / sp.sympify(eta)) == fresnel.normal(sp.sympify(eta))


def test_the_constants_of_smoothie_and_where_they_lead():
    """exp2 of the source at normal and grazing incidence, by math alone."""
    at = lower(fresnel.smoothie(U, F), (U, F))
    assert math.isclose(at(0.0, 0.0), math.exp2(-1.71983), rel_tol=1e-15)
    assert math.isclose(at(1.0, 0.0), math.exp2(-1.71983 - 2 * 5.43926), rel_tol=1e-14)


# Optical constants


def test_every_material_is_read_and_cited():
    cited = (Path(__file__).parent.parent / "docs" / "refs.bib").read_text()
    for name in metals.names():
        material = metals.material(name)
        assert f"{{{material.source}," in cited
        assert bool(material.rows) != bool(material.terms)
        wavelengths = [row[0] for row in material.rows]
        assert wavelengths == sorted(set(wavelengths))
        for wavelength in (*material.range, *wavelengths, metals.YELLOW):
            eta, kappa = material.at(wavelength)
            assert eta > 0 and kappa >= 0


@pytest.mark.parametrize(
    "name, wavelength, eta, kappa",
    [("gold", "0.5821", "0.29", "2.863"), ("copper", "0.5821", "0.70", "2.704"), ("silver", "0.7560", "0.03", "5.242")]
    + [("aluminium", "0.56357", "1.0728", "6.7839"), ("iron", "0.381", "2.12", "2.50")],
)
def test_rows_are_exact(name, wavelength, eta, kappa):
    assert metals.material(name).at(sp.Rational(wavelength)) == (sp.Rational(eta), sp.Rational(kappa))


def test_between_rows_there_is_a_line():
    part = sp.Rational(132, 347)  # of the way from 0.5821 to 0.6168
    eta, kappa = metals.material("gold").at(sp.Rational("0.5953"))
    assert eta == sp.Rational("0.29") - part * sp.Rational("0.08")
    assert kappa == sp.Rational("2.863") + part * sp.Rational("0.409")


@pytest.mark.parametrize("name, index", [("diamond", 2.417), ("fused-silica", 1.4584), ("water", 1.333)])
def test_indices_that_everybody_knows(name, index):
    eta, kappa = metals.material(name).at()
    assert abs(float(eta) - index) < 1e-3 and kappa < 1e-7


def test_gallery_and_table_hold_the_same_metals():
    card = tomllib.loads((files("ratfit.gallery") / "fresnel.toml").read_text())
    rows = {each["name"]: each["parameters"] for each in card["reference"]}
    for name in ("gold", "copper"):
        eta, kappa = metals.material(name).at(sp.Rational("0.5821"))
        assert (eta, kappa) == (sp.Rational(rows[name]["eta"]), sp.Rational(rows[name]["kappa"]))


@pytest.mark.parametrize(
    "name, wavelength, remedy",
    [("goold", "0.5", "did you mean 'gold'"), ("xyz", "0.5", "known are gold"), ("gold", "0.3", "from 0.3815 to 0.756")]
    + [("diamond", "0.9", "from 0.226 to 0.76"), ("gold", "nan", "not at nan")],
)
def test_what_no_table_holds(name, wavelength, remedy):
    with pytest.raises(RatfitError, match=remedy):
        metals.material(name).at(float(wavelength))


def test_the_room_is_open():
    assert brdf.fresnel is fresnel and brdf.metals is metals


@pytest.mark.parametrize("wavelength", ["0.55", None, True, U, sp.I, [0.55]])
def test_a_wavelength_is_a_number(wavelength):
    with pytest.raises(RatfitError, match="give a number of micrometres"):
        metals.material("gold").at(wavelength)
