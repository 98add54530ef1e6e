"""Samplers against their densities and against what integrals are known in closed form; albedos by both ways."""

import math

import numpy as np
import pytest
import sympy as sp

from ratfit import models
from ratfit._parse import RatfitError
from ratfit.models import MODELS, Model
from ratfit.models.albedo import albedo, angles, monte_carlo_albedo
from ratfit.models.directions import R_DOT_V, SQUARES, V_PRIME, T, U, V, W
from ratfit.models.lambert import LAMBERT
from ratfit.models.laws.drawing import chi_square
from ratfit.models.oren_nayar import OREN_NAYAR
from ratfit.models.samplers import ANY, COSINE, GGX, SAMPLERS, Blend, named, sampler_for, weight

ALPHA = GGX.pdf.parameters[0]
RIGHT = [name for name in SAMPLERS if name != "schlick-as-printed"]


def own(reflectance, *parameters, **more):
    return Model("mine", "a model of a test", sp.sympify(reflectance, strict=True), parameters, "none", **more)


def ggx(t, alpha):
    return alpha**2 / (math.pi * (t**2 * (alpha**2 - 1) + 1) ** 2)


def facing(angle, azimuth=0.0):
    return np.array([math.sin(angle) * math.cos(azimuth), math.sin(angle) * math.sin(azimuth), math.cos(angle)])


# (reflectance, what its integral with the cosine to the light is at the cosine v of the view)
KNOWN = {
    "diffuse": (1 / sp.pi, lambda v: 1.0),
    "light's cosine": (V_PRIME, lambda v: 2 * math.pi / 3),
    "grows at grazing angles": (1 / (2 * sp.pi * V * V_PRIME), lambda v: 1 / v),
    # the integral of l l^T (n.l) is pi/4 diag(1, 1, 2), and R is the mirror image of the view
    "mirror's cosine squared": (R_DOT_V**2, lambda v: math.pi / 4 * (1 - v**2 + 2 * v**2)),
    "angle between": ((2 * U**2 - 1) ** 2, lambda v: math.pi / 4 * (1 - v**2 + 2 * v**2)),
}


@pytest.mark.parametrize("name", KNOWN)
def test_albedo_of_integrals_done_by_hand(name):
    reflectance, exact = KNOWN[name]
    found = albedo(own(reflectance))
    expected = np.array([exact(v) for v in angles()])
    assert np.all(np.abs(found.values - expected) <= 1e-4 * np.maximum(1, expected))
    assert len(found.values) == 64 and found.errors.max() <= 1e-4 * expected.max()


@pytest.mark.parametrize("alpha", [1e-4, 1e-3, 0.01, 0.1, 1.0])
def test_albedo_of_lobes_however_narrow(alpha):
    """At normal incidence V.H is N.H: D/(4 v') sends the facets below 45 degrees, a share of 1/(1 + alpha^2)."""
    sharp = (ALPHA / (T**2 * (ALPHA**2 - 1) + 1)) ** 2 / sp.pi
    found = albedo(own(sharp / (4 * V_PRIME), ALPHA), [1.0], alpha=alpha)
    assert found.values[0] == pytest.approx(1 / (1 + alpha**2), abs=1e-5)
    assert found.errors[0] <= 1e-4


@pytest.mark.parametrize("azimuth", [0.0, 0.6, math.pi / 2])
def test_albedo_of_what_depends_on_the_azimuth(azimuth):
    """At normal incidence the half vector has the light's azimuth: the mean of w^2 is 1/2, that of w 2/pi."""
    assert albedo(own(W**2), [1.0], azimuth=azimuth).values[0] == pytest.approx(math.pi / 2, abs=1e-6)
    assert albedo(own(W), [1.0], azimuth=azimuth).values[0] == pytest.approx(2, abs=1e-6)


@pytest.mark.parametrize("azimuth", [0.0, 0.5, math.pi / 2])
def test_both_ways_agree_for_an_elliptical_lobe(azimuth):
    lobe = W**2 * SAMPLERS["ggx"].pdf.reflectance
    model = own(lobe, ALPHA)
    cosines = [0.9, 0.3]
    exact = albedo(model, cosines, azimuth=azimuth, alpha=0.2)
    drawn = monte_carlo_albedo(model, cosines, azimuth=azimuth, alpha=0.2, samples=40_000, sampler=Blend(((GGX, {}),)))
    assert np.all(np.abs(exact.values - drawn.values) <= exact.errors + 5 * drawn.errors)


WITHOUT_INTEGRAL = {"ward-third-form-as-printed", "schlick-as-printed", "schlick-double-as-printed"}


@pytest.mark.thorough
@pytest.mark.parametrize("name", [name for name in MODELS if name not in WITHOUT_INTEGRAL])
def test_both_ways_agree_for_every_model(name):
    exact = albedo(MODELS[name], [0.8])
    drawn = monte_carlo_albedo(MODELS[name], [0.8], samples=4000)
    assert np.all(np.abs(exact.values - drawn.values) <= exact.errors + 5 * drawn.errors)


@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
def test_what_a_model_says_of_its_facets_and_its_sampler_fits_it(model):
    own_names = {p.name for p in model.parameters}
    if model.sampler is not None:
        assert {p.name for p in named(model.sampler).pdf.parameters} <= own_names
    if model.facets is not None:
        assert model.facets.free_symbols <= {T, W, *SQUARES, *model.parameters}


def test_oren_nayar_at_normal_incidence_is_its_first_term():
    sigma = 0.5
    first = 0.8 * (1 - sigma**2 / (2 * (sigma**2 + 0.33)))
    assert albedo(OREN_NAYAR, [1.0], albedo=0.8, sigma=sigma).values[0] == pytest.approx(first, abs=1e-6)


def test_jumps_cost_digits_not_correctness():
    lit = albedo(own(sp.Piecewise((1 / sp.pi, V_PRIME > V), (0, True))))
    assert np.all(np.abs(lit.values - (1 - angles() ** 2)) <= 0.02)
    assert lit.errors.max() >= 1e-3
    model = own(sp.Piecewise((1, sp.Rational(9, 10) < U), (0, True)))
    found = albedo(model, [1.0])  # U = cos of half the light's angle
    assert abs(found.values[0] - math.pi * (1 - (2 * 0.81 - 1) ** 2)) <= max(1e-4, 10 * found.errors[0])


def test_the_coherent_share_counts():
    with_mirror = own(1 / (2 * sp.pi), mirror=V / 2)
    assert albedo(with_mirror, [0.5]).values[0] == pytest.approx(0.75, abs=1e-6)
    drawn = monte_carlo_albedo(with_mirror, [0.5], sampler=Blend(((COSINE, {}),)))
    assert drawn.values[0] == pytest.approx(0.75, abs=1e-12)


@pytest.mark.parametrize("cosines", [[0.0], [-0.5], [1.1], [math.nan], [[0.5]]])
def test_cosines_that_no_view_has_are_refused(cosines):
    with pytest.raises(RatfitError, match="above 0"):
        albedo(LAMBERT, cosines)


def test_albedo_takes_one_number_for_each_parameter():
    with pytest.raises(RatfitError, match="albedo is one number here"):
        albedo(LAMBERT, albedo=np.array([0.1, 0.2, 0.3]))
    with pytest.raises(RatfitError, match="has no parameter"):
        albedo(LAMBERT, albedos=1.0)


@pytest.mark.parametrize("name", RIGHT)
@pytest.mark.parametrize("view", [(0.95, 0.0), (0.3, 0.7)])
def test_samples_follow_their_density(name, view):
    assert chi_square(SAMPLERS[name], *view, samples=20_000).chance > 1e-4


@pytest.mark.parametrize("stated", [{"alpha": 1e-3}, {"alpha": 1.0}])
def test_samples_follow_their_density_at_the_ends_of_the_range(stated):
    assert chi_square(GGX, 0.7, samples=20_000, **stated).chance > 1e-4


def test_blends_follow_their_density():
    assert chi_square(ANY, 0.5, samples=20_000).chance > 1e-4


def test_the_azimuth_in_print_is_seen_to_be_wrong():
    assert chi_square(SAMPLERS["schlick-as-printed"], 0.95, samples=20_000, r=0.3, p=0.5).chance < 1e-30
    isotropic = chi_square(SAMPLERS["schlick-as-printed"], 0.95, samples=20_000, r=0.3, p=1.0)
    assert isotropic.chance > 1e-4  # at p = 1 both azimuths are uniform


def test_a_lobe_drawn_a_little_too_wide_is_seen():
    class Wider:
        def sample(self, view, pair, alpha):
            return GGX.sample(view, pair, alpha=1.05 * alpha)

        def density(self, view, light, alpha):
            return GGX.density(view, light, alpha=alpha)

    assert chi_square(Wider(), 0.8, samples=40_000, alpha=0.2).chance < 1e-6


def test_density_is_the_facets_over_the_stretch_of_reflection():
    view, light, alpha = facing(0.9), facing(0.4, 2.0), 0.35
    half = (view + light) / np.linalg.norm(view + light)
    expected = ggx(half[2], alpha) * half[2] / (4 * view @ half)
    assert GGX.density(view, light, alpha=alpha) == pytest.approx(expected, rel=1e-12)
    assert COSINE.density(view, light) == pytest.approx(light[2] / math.pi, rel=1e-12)
    both = Blend(((COSINE, {}), (GGX, {"alpha": alpha})))
    assert both.density(view, light) == pytest.approx((expected + light[2] / math.pi) / 2, rel=1e-12)


def test_zenith_and_azimuth_of_schlick_at_chosen_numbers():
    """tan^2(theta) = r (1 - a)/a of Eq. 29's zenith angle, and tan(phi) = tan(2 pi b)/p around the tangent."""
    a, b, r, p = 0.2, 0.1, 0.3, 0.4
    light = SAMPLERS["schlick"].sample(np.array([0.0, 0.0, 1.0]), np.array([a, b]), r=r, p=p)
    half = light + [0, 0, 1]
    assert (half[0] ** 2 + half[1] ** 2) / half[2] ** 2 == pytest.approx(r * (1 - a) / a, rel=1e-12)
    assert half[1] / half[0] == pytest.approx(math.tan(2 * math.pi * b) / p, rel=1e-12)


def test_white_paper_by_its_own_sampler_has_no_noise():
    view, random = facing(0.5), np.random.default_rng(0).random((100, 2))
    weights = weight(COSINE, LAMBERT, view, COSINE.sample(view, random), albedo=0.6)
    assert np.allclose(weights, 0.6, rtol=1e-12, atol=0)


def test_light_below_the_horizon_carries_nothing():
    view, random = facing(1.5), np.random.default_rng(0).random((2000, 2))
    light = GGX.sample(view, random, alpha=1.0)
    below = light[:, 2] <= 0
    assert below.any() and not below.all()
    weights = ANY.weight(LAMBERT, view, light)
    assert np.all(weights[below] == 0) and np.all(weights[~below] > 0)
    assert np.allclose(np.linalg.norm(light, axis=-1), 1)


@pytest.mark.parametrize("name", SAMPLERS)
@pytest.mark.parametrize("pair", [(0.0, 0.0), (0.0, 0.5), (1 - 2**-24, 1 - 2**-24), (0.5, 0.25)])
def test_the_ends_of_the_unit_square_give_directions(name, pair):
    for dtype in (np.float32, np.float64):
        light = SAMPLERS[name].sample(facing(0.7).astype(dtype), np.array(pair, dtype))
        assert light.dtype == dtype and np.linalg.norm(light) == pytest.approx(1, abs=1e-5)


def test_shapes_broadcast():
    view, pairs = np.stack([facing(0.1), facing(0.8)])[:, None, :], np.full((5, 2), 0.3)
    for sampler in (COSINE, GGX, ANY):
        assert sampler.sample(view, pairs).shape == (2, 5, 3)
        assert sampler.density(view, sampler.sample(view, pairs)).shape == (2, 5)


def test_jax_draws_what_numpy_draws():
    import jax

    view, pairs = facing(0.6).astype(np.float32), np.random.default_rng(1).random((50, 2)).astype(np.float32)
    both = Blend(((COSINE, {}), (GGX, {})))

    def drawn(pair, alpha):
        return both.sample(view, pair, alpha=alpha)

    found, slopes = jax.jit(jax.vmap(jax.value_and_grad(lambda *given: drawn(*given)[0], 1)))(
        jax.numpy.asarray(pairs), jax.numpy.full(50, 0.3, np.float32)
    )
    assert np.allclose(found, drawn(pairs, 0.3)[:, 0], atol=2e-6)
    step = (drawn(pairs.astype(float), 0.301)[:, 0] - drawn(pairs.astype(float), 0.299)[:, 0]) / 0.002
    assert np.allclose(slopes, step, atol=1e-3)


@pytest.mark.parametrize(
    ("call", "fragment"),
    [
        (lambda: named("gxg"), "ggx"),
        (lambda: GGX.sample(facing(0.1), np.zeros(3)), "shape"),
        (lambda: GGX.sample(facing(0.1), np.zeros((4, 2), int)), "uniform floats"),
        (lambda: GGX.sample(np.zeros(2), np.zeros(2)), "view"),
        (lambda: GGX.sample(facing(0.1), np.zeros(2), alpha=2.0), "outside"),
        (lambda: GGX.sample(facing(0.1), np.zeros(2), rough=0.2), "alpha"),
        (lambda: GGX.sample(facing(0.1), np.array([1.5, 0.5])), r"outside \[0, 1\]"),
        (lambda: GGX.sample(facing(0.1), np.array([0.5, -1e-3])), r"outside \[0, 1\]"),
        (lambda: COSINE.sample(facing(0.1), np.array([[0.5, 0.5], [math.nan, 0.5]])), r"outside \[0, 1\]"),
        (lambda: ANY.sample(facing(0.1), np.array([math.inf, 0.5])), r"outside \[0, 1\]"),
        (lambda: monte_carlo_albedo(LAMBERT, samples=0), "samples = 0: give a whole number from 2 on"),
        (lambda: monte_carlo_albedo(LAMBERT, samples=1), "from 2 on"),
        (lambda: monte_carlo_albedo(LAMBERT, samples=-5), "from 2 on"),
        (lambda: monte_carlo_albedo(LAMBERT, samples=1.5), "from 2 on"),
        (lambda: monte_carlo_albedo(LAMBERT, samples=math.inf), "from 2 on"),
        (lambda: monte_carlo_albedo(LAMBERT, samples="many"), "samples = 'many'"),
        (lambda: monte_carlo_albedo(LAMBERT, seed=-1), "seed = -1: give a whole number from 0 on"),
        (lambda: monte_carlo_albedo(LAMBERT, azimuth=math.nan), "azimuth = nan"),
        (lambda: albedo(LAMBERT, azimuth=[0.1, 0.2]), "one number, in radians"),
        (lambda: albedo(LAMBERT, "0.5"), "real numbers"),
        (lambda: albedo(LAMBERT, [0.5], tolerance=0), "tolerance = 0: give a number above 0"),
        (lambda: angles(0), "count = 0: give a whole number from 1 on"),
        (lambda: monte_carlo_albedo(LAMBERT, [0.5], sampler="gxg"), "did you mean 'ggx'"),
        (lambda: monte_carlo_albedo(LAMBERT, [0.5], sampler=LAMBERT), "is no sampler: give one, or its name"),
        (lambda: weight(3, LAMBERT, facing(0.1), facing(0.2)), "3 is no sampler"),
    ],
)
def test_bad_input_is_said(call, fragment):
    with pytest.raises(RatfitError, match=fragment):
        call()


ASKED_OF_A_MODEL = {
    "named": models.named,
    "sampler_for": sampler_for,
    "weight": lambda model: weight(GGX, model, facing(0.1), facing(0.2)),
    "Blend.weight": lambda model: ANY.weight(model, facing(0.1), facing(0.2)),
    "albedo": lambda model: albedo(model, [0.5]).values[0],
    "monte_carlo_albedo": lambda model: monte_carlo_albedo(model, [0.5], samples=100).values[0],
}


@pytest.mark.parametrize("asked", ASKED_OF_A_MODEL)
def test_a_model_may_be_given_by_its_name(asked):
    ask = ASKED_OF_A_MODEL[asked]
    assert ask("lambert") == ask(LAMBERT)
    listed = f"`ratfit check-model` lists the {len(MODELS)} models"
    with pytest.raises(RatfitError, match=f"no model 'lamber'; did you mean 'lambert'. {listed}$"):
        ask("lamber")
    for other in (3, None, ["lambert"], GGX):
        with pytest.raises(RatfitError, match=rf" is no model: give one, or its name; {listed}$") as told:
            ask(other)
        assert len(str(told.value)) < 160 and str(told.value).isprintable()


def test_a_sampler_may_be_given_by_its_name():
    assert named("ggx") is named(GGX) is GGX
    by_name, itself = (monte_carlo_albedo(LAMBERT, [0.5], sampler=each, samples=100) for each in ("ggx", GGX))
    assert by_name.values[0] == itself.values[0]


def test_a_sampler_alone_draws_as_a_blend_of_it():
    mine, theirs = (
        monte_carlo_albedo(LAMBERT, [0.5], sampler=each, samples=100) for each in (COSINE, Blend(((COSINE, {}),)))
    )
    assert mine.values[0] == theirs.values[0]


def test_a_whole_number_may_be_written_as_a_power_of_ten():
    mine, theirs = (monte_carlo_albedo(LAMBERT, [0.5], samples=count, seed=3) for count in (1e3, 1000))
    assert mine.values[0] == theirs.values[0] and mine.errors[0] == theirs.errors[0]


@pytest.mark.parametrize("name", SAMPLERS)
def test_the_ends_of_the_uniform_numbers_give_directions(name):
    """A generator of float32 numbers may round to 1."""
    corners = np.array([[a, b] for a in (0.0, 1.0) for b in (0.0, 1.0)])
    for kind in (np.float32, np.float64):
        lengths = np.linalg.norm(SAMPLERS[name].sample(facing(0.1).astype(kind), corners.astype(kind)), axis=-1)
        assert np.allclose(lengths, 1, atol=1e-5)


def test_a_transformation_of_jax_is_not_looked_into():
    import jax

    drawn = jax.jit(lambda pair: GGX.sample(facing(0.1), pair))(np.array([1.5, 0.5], np.float32))
    assert drawn.shape == (3,)
    with pytest.raises(RatfitError, match="outside"):
        GGX.sample(facing(0.1), jax.numpy.asarray([1.5, 0.5]))


def test_a_model_without_a_sampler_gets_the_general_one():
    assert sampler_for(LAMBERT) is ANY
    mine = sampler_for(own(T, sampler="ggx"))
    assert [sampler.name for sampler, _ in mine.parts] == ["cosine", "ggx"]
