"""Micro-facet models against the equations of their sources, written here once more from vectors."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.special import erf, erfc

from ratfit._lower import lower
from ratfit._parse import RatfitError
from ratfit.brdf import distribution
from ratfit.models import LETTERS, MODELS, _schlick, conserving, named
from ratfit.models.cook_torrance import COOK_TORRANCE, cook_torrance
from ratfit.models.directions import SQUARES, T, W
from ratfit.models.he import HE
from ratfit.models.schlick import SCHLICK, schlick

pytestmark = pytest.mark.thorough  # long sweeps of formulas that seldom change

OURS = [*COOK_TORRANCE, *HE, *SCHLICK, *conserving.CONSERVING]
NORMAL = np.array([0.0, 0.0, 1.0])


def directions(count, seed, lowest=0.02):
    random = np.random.default_rng(seed)
    z, phi = random.uniform(lowest, 1, count), random.uniform(0, 2 * np.pi, count)
    return np.stack([np.sqrt(1 - z * z) * np.cos(phi), np.sqrt(1 - z * z) * np.sin(phi), z], -1)


def by_name(values):
    return {name: np.float64(value) for name, value in values.items()}


# --- The sources' formulas, from vectors ---


class Pair:
    """View, light and half vector of pairs of directions."""

    def __init__(self, view, light):
        half = view + light
        self.half = half / np.linalg.norm(half, axis=-1, keepdims=True)
        self.nh, self.nv, self.nl = self.half @ NORMAL, view @ NORMAL, light @ NORMAL
        self.hv = np.sum(self.half * view, -1)
        self.tan_h, self.tan_v, self.tan_l = (np.sqrt(1 - c * c) / c for c in (self.nh, self.nv, self.nl))
        self.cos_azimuth = np.abs(self.half[..., 0]) / np.hypot(self.half[..., 0], self.half[..., 1])


def fresnel(cosine, index):
    """Both polarisations by complex amplitudes."""
    refracted = np.sqrt(index**2 - 1 + cosine**2 + 0j)
    s = (cosine - refracted) / (cosine + refracted)
    p = (index**2 * cosine - refracted) / (index**2 * cosine + refracted)
    return (abs(s) ** 2 + abs(p) ** 2) / 2


def power(cosine, f):
    return f + (1 - f) * (1 - cosine) ** 5


def beckmann(pair, m):
    return np.exp(-((pair.tan_h / m) ** 2)) / (np.pi * m**2 * pair.nh**4)


def beckmann_fraction(pair, m):
    x = np.maximum(pair.nh + m - 1, 0)
    return m**3 * x / (pair.nh * (m * x**2 - x**2 + m**2) ** 2) / np.pi


def ggx(pair, alpha):
    return alpha**2 / (np.pi * pair.nh**4 * (alpha**2 + pair.tan_h**2) ** 2)


def phong(pair, exponent):
    return (exponent + 2) / (2 * np.pi) * pair.nh**exponent


def blinn(pair, rho):
    return pair.nh ** (2 / rho**2 - 2) / (np.pi * rho**2)


def smith_1967(tan, m):
    """Smith's probability of being seen, (1 - erfc(a)/2)/(1 + Lambda), a = cot/(sqrt(2) m)."""
    a = 1 / (np.sqrt(2) * m * tan)
    hidden_over_seen = (np.exp(-a * a) / (a * np.sqrt(np.pi)) - erfc(a)) / 2
    return (1 - erfc(a) / 2) / (1 + hidden_over_seen)


def eq18(tan, m):
    h = 1 / (2 * m * m * tan * tan)
    g = np.sqrt(h * np.pi) * (2 - (1 - erf(np.sqrt(h))))
    return g / (g + 1)


def eq19(cosine, m):
    k = np.sqrt(2 * m * m / np.pi)
    return cosine / (cosine - k * cosine + k)


def walter(tan, alpha):
    a = 1 / (alpha * tan)
    fraction = (3.535 * a + 2.181 * a * a) / (1 + 2.276 * a + 2.577 * a * a)
    return np.where(a < 1.6, np.minimum(fraction, 1), 1)


def grooves(pair):
    return np.minimum(1, 2 * pair.nh * np.minimum(pair.nv, pair.nl) / pair.hv)


def ggx_masking(tan, alpha):
    return 2 / (1 + np.sqrt(1 + (alpha * tan) ** 2))


def lobe(pair, d, f, g):
    return d * f * g / (4 * pair.nl * pair.nv)


def shares(diffuse, specular_lobe, specular_share):
    return (1 - specular_share) * diffuse / np.pi + specular_share * specular_lobe


def true_formulas(pair, alpha, eta, kappa, diffuse, specular_share):
    g = smith_1967(pair.tan_v, alpha / np.sqrt(2)) * smith_1967(pair.tan_l, alpha / np.sqrt(2))
    return shares(diffuse, lobe(pair, beckmann(pair, alpha), fresnel(pair.hv, eta + 1j * kappa), g), specular_share)


def as_printed(pair, alpha, eta, kappa, diffuse, specular_share):
    g = eq18(pair.tan_v, alpha) * eq18(pair.tan_l, alpha)
    return shares(diffuse, lobe(pair, beckmann(pair, alpha), fresnel(pair.hv, eta + 1j * kappa), g), specular_share)


def first_version(pair, alpha, eta, kappa, f, diffuse, specular_share):
    average, normal = fresnel(pair.hv, eta + 1j * kappa), fresnel(1.0, eta + 1j * kappa)
    scaled = f + (1 - f) * np.maximum(0, (average - normal) / (1 - normal))
    return shares(diffuse, lobe(pair, beckmann(pair, alpha), scaled, grooves(pair)), specular_share)


def optimised(roughness):
    def model(pair, alpha, f, diffuse, specular_share):
        g = eq19(pair.nv, roughness * alpha) * eq19(pair.nl, roughness * alpha)
        return shares(diffuse, lobe(pair, beckmann_fraction(pair, alpha), power(pair.hv, f), g), specular_share)

    return model


def starter(pair, exponent, f, diffuse):
    return diffuse / np.pi + phong(pair, exponent) * power(pair.hv, f) / (4 * pair.hv**2)


def micro_phong(pair, exponent, f, diffuse):
    alpha = 1 / np.sqrt(exponent / 2 + 1)
    g = walter(pair.tan_v, alpha) * walter(pair.tan_l, alpha)
    return diffuse / np.pi + lobe(pair, phong(pair, exponent), power(pair.hv, f), g)


def micro_beckmann(pair, alpha, f, diffuse):
    g = walter(pair.tan_v, alpha) * walter(pair.tan_l, alpha)
    return diffuse / np.pi + lobe(pair, beckmann(pair, alpha), power(pair.hv, f), g)


def micro_ggx(pair, alpha, f, diffuse):
    g = ggx_masking(pair.tan_v, alpha) * ggx_masking(pair.tan_l, alpha)
    return diffuse / np.pi + lobe(pair, ggx(pair, alpha), power(pair.hv, f), g)


def micro_glass(pair, alpha, eta, diffuse):
    g = ggx_masking(pair.tan_v, alpha) * ggx_masking(pair.tan_l, alpha)
    return diffuse / np.pi + lobe(pair, ggx(pair, alpha), fresnel(pair.hv, eta), g)


def shading(d, pi=np.pi):
    def model(pair, alpha, f, diffuse, specular, specular_share):
        whole = specular * lobe(pair, d(pair, alpha), power(pair.hv, f), grooves(pair))
        return (1 - specular_share) * diffuse / pi + specular_share * whole

    return model


def shading_ggx(pair, alpha, f, diffuse, specular, specular_share):
    g = ggx_masking(pair.tan_v, alpha) * ggx_masking(pair.tan_l, alpha)
    return shares(diffuse, specular * lobe(pair, ggx(pair, alpha), power(pair.hv, f), g), specular_share)


def coherence(weighted):
    def model(pair, alpha, eta, kappa, sigma, diffuse, specular_share):
        left = -np.expm1(-((4 * np.pi * sigma * np.minimum(pair.nv, pair.nl)) ** 2)) if weighted else 1
        g = smith_1967(pair.tan_v, alpha / np.sqrt(2)) * smith_1967(pair.tan_l, alpha / np.sqrt(2))
        whole = left * lobe(pair, beckmann(pair, alpha), fresnel(pair.hv, eta + 1j * kappa), g)
        return shares(diffuse, whole, specular_share)

    return model


def eq28(pair, r, p, root):
    z = r / (1 + r * pair.nh**2 - pair.nh**2) ** 2
    a = p / (p**2 - p**2 * pair.cos_azimuth**2 + pair.cos_azimuth**2)
    return z * (np.sqrt(a) if root else a)


def eq25(pair, r, p, root=False):
    return eq28(pair, r, p, root) / (4 * np.pi * pair.nv * pair.nl)


def eq30(pair, r, p, root=False):
    g = pair.nv / (r - r * pair.nv + pair.nv) * pair.nl / (r - r * pair.nl + pair.nl)
    return (g * eq28(pair, r, p, root) + 1 - g) / (4 * np.pi * pair.nv * pair.nl)


def eq32(pair, r, p, root=False):
    """The right one, and what root says: to the letter."""
    b = 4 * r * (1 - r)
    once_more = 4 * np.pi * pair.nv * pair.nl if root else 1
    return (0 if r < 0.5 else 1 - b) / np.pi + b / once_more * eq30(pair, r, p, root)


def one_layer(s, d, **how):
    return lambda pair, C, r, p: s(pair.hv, C) * d(pair, r, p, **how)


def two_layers(**how):
    def model(pair, C, r, p, C_prime, r_prime, p_prime):
        upper = power(pair.hv, C)
        lower_one = power(pair.hv, C_prime) * eq32(pair, r_prime, p_prime, **how)
        return upper * eq32(pair, r, p, **how) + (1 - upper) * lower_one

    return model


def flat(cosine, c):
    return c


SOURCES = {
    "cook-torrance": true_formulas,
    "cook-torrance-as-printed": as_printed,
    "cook-torrance-1981": first_version,
    "cook-torrance-optimised": optimised(np.sqrt(0.5)),
    "cook-torrance-optimised-as-printed": optimised(1.0),
    "microfacet": starter,
    "microfacet-phong": micro_phong,
    "microfacet-beckmann": micro_beckmann,
    "microfacet-ggx": micro_ggx,
    "microfacet-ggx-glass": micro_glass,
    "cook-torrance-beckmann": shading(beckmann),
    "cook-torrance-blinn": shading(blinn),
    "cook-torrance-ggx": shading_ggx,
    "cook-torrance-beckmann-as-printed": shading(beckmann, 1),
    "he": coherence(True),
    "he-as-printed": coherence(False),
    "schlick": one_layer(power, eq32),
    "schlick-double": two_layers(),
    "schlick-23-25": one_layer(flat, eq25),
    "schlick-23-30": one_layer(flat, eq30),
    "schlick-23-32": one_layer(flat, eq32),
    "schlick-24-25": one_layer(power, eq25),
    "schlick-24-30": one_layer(power, eq30),
    "schlick-24-25-as-printed": one_layer(power, eq25, root=True),
    "schlick-24-30-as-printed": one_layer(power, eq30, root=True),
    "schlick-as-printed": one_layer(power, eq32, root=True),
    "schlick-double-as-printed": two_layers(root=True),
}
SETTINGS = [
    {"alpha": 0.2, "eta": 1.5, "kappa": 0.0, "f": 0.04, "r": 0.1, "p": 1.0, "C": 0.2, "r_prime": 0.9, "sigma": 0.05},
    {"alpha": 0.45, "eta": 0.2, "kappa": 3.4, "f": 0.95, "r": 0.7, "p": 0.3, "C": 0.8, "p_prime": 0.1, "sigma": 0.3},
]


def setting(model, values):
    return {**model.defaults, **{p.name: values[p.name] for p in model.parameters if p.name in values}}


def test_every_model_has_its_source():
    ours = {model.name for model in OURS} - {model.name for model in conserving.CONSERVING}
    assert ours == set(SOURCES)
    assert all(MODELS[model.name] is model for model in OURS)


@pytest.mark.parametrize("values", SETTINGS)
@pytest.mark.parametrize("name", SOURCES)
def test_it_is_what_the_source_says(name, values):
    view, light = directions(300, 1), directions(300, 2)
    known = setting(named(name), values)
    expected = SOURCES[name](Pair(view, light), **known)
    np.testing.assert_allclose(named(name)(view, light, **known), expected, rtol=2e-11)


@pytest.mark.parametrize("model", OURS, ids=lambda m: m.name)
def test_view_and_light_may_change_places(model):
    view, light = directions(200, 3, 0.0), directions(200, 4, 0.0)
    np.testing.assert_allclose(model(view, light), model(light, view), rtol=1e-13)


# --- The closed domain ---

EDGE = np.array([
    [0, 0, 1], [1, 0, 0], [-1, 0, 0], [0.6, 0, 0.8], [-0.6, 0, 0.8], [0, -0.6, 0.8], [1, 0, 1e-7], [-1, 0, 1e-7],
    [0, 1, 1e-7], [1, 0, 1e-20], [-1, 0, 1e-20], [0, 1, 1e-30], [1, 0, 1e-40], [0, 0, -1], [-0.6, 0, -0.8],
])  # fmt: skip


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("model", OURS, ids=lambda m: m.name)
def test_every_pair_has_a_finite_reflectance(model, dtype):
    edge = EDGE.astype(dtype)
    for values in ({}, *({p.name: float(getattr(p, end)) for p in model.parameters} for end in ("low", "high"))):
        found = model(edge[:, None], edge[None], **values)
        assert found.dtype == dtype and found.shape == (15, 15)
        assert np.isfinite(found).all() and (found >= 0).all()
        assert not found[[1, 2, 13, 14]].any() and not found[:, [1, 2, 13, 14]].any()


@pytest.mark.parametrize("model", OURS, ids=lambda m: m.name)
def test_float32_is_near(model):
    view, light = directions(200, 5), directions(200, 6)
    np.testing.assert_allclose(model(view.astype("f4"), light.astype("f4")), model(view, light), rtol=2e-4)


@pytest.mark.parametrize("name", ["cook-torrance", "schlick-double"])
def test_jit_of_float32_is_the_same(name):
    edge = np.concatenate([EDGE[:12], directions(20, 5)]).astype("f4")  # JAX takes 1e-40 for 0
    found = jax.jit(lambda *pair: named(name)(*pair))(jnp.asarray(edge[:, None]), jnp.asarray(edge[None]))
    assert found.dtype == jnp.float32
    np.testing.assert_allclose(found, named(name)(edge[:, None], edge[None]), rtol=1e-4)


@pytest.mark.parametrize(
    "name", [pytest.param("cook-torrance-optimised", marks=pytest.mark.thorough), "schlick-conserving"]
)
def test_gradients_are_finite_and_parameters_may_be_traced(name):
    model = named(name)
    view, light = (jnp.asarray(np.concatenate([directions(20, seed), EDGE[[0, 3, 4, 5]]])) for seed in (7, 8))
    known = {name: jnp.asarray(value) for name, value in model.defaults.items()}

    def total(view, light, known):
        return model(view, light, **known).sum()

    for slopes in jax.grad(total, (0, 1, 2))(view, light, known):
        assert all(bool(jnp.isfinite(slope).all()) for slope in jax.tree.leaves(slopes))
    mapped = jax.vmap(lambda view, light: model(view, light, **known))(view, light)
    np.testing.assert_allclose(mapped, model(np.asarray(view), np.asarray(light)), rtol=1e-4)


def test_colours_broadcast():
    view, light, colour = directions(4, 9), directions(4, 10), np.array([0.9, 0.5, 0.1])
    found = named("schlick")(view[:, None], light[:, None], C=colour)
    assert found.shape == (4, 3)
    for channel in range(3):
        np.testing.assert_allclose(found[:, channel], named("schlick")(view, light, C=colour[channel]), rtol=1e-14)


# --- What a model is made of ---


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: cook_torrance("bekmann", "schlick", "smith"), "did you mean 'beckmann'"),
        (lambda: cook_torrance("beckmann", "schlick", "smiht"), "did you mean 'smith'"),
        (lambda: cook_torrance("beckmann", "schlick", "smith", "all"), "there are: schlick1994"),
        (lambda: schlick("constant", "facet"), "did you mean 'facets'"),
        (lambda: schlick(layers=3), "1 \\(SINGLE\\) or 2 \\(DOUBLE\\)"),
        (lambda: named("schlick")(NORMAL, NORMAL, r=1.5), "outside \\[0, 1\\]"),
        (lambda: named("schlick-24-25")(NORMAL, NORMAL, r=0.0), "outside \\[0.0001, 1\\]"),
        (lambda: named("cook-torrance")(NORMAL, NORMAL, f=0.5), "has no parameter f"),
    ],
)
def test_errors_say_the_remedy(make, said):
    with pytest.raises(RatfitError, match=said):
        make()


@pytest.mark.parametrize("masking", ["beckmann", "ggx-correlated", "implicit", "kelemen"])
@pytest.mark.parametrize("fresnel_name", ["dielectric", "schlick"])
def test_other_choices_make_models(masking, fresnel_name):
    model = cook_torrance("ggx", fresnel_name, masking)
    found = model(EDGE[:, None].astype("float32"), EDGE[None].astype("float32"))
    assert np.isfinite(found).all() and found.max() > 0


@pytest.mark.parametrize("printed", [False, True])
def test_schlicks_lobe_is_that_of_the_formulas(printed):
    layer = _schlick.layer("", 0)
    ours = _schlick.lobe(layer, printed=printed).value.xreplace(SQUARES)
    azimuth = distribution.azimuth_as_printed if printed else distribution.azimuth
    theirs = distribution.zenith(T, layer.r) * azimuth(W, layer.p)
    t, w = np.linspace(0, 1, 21)[:, None, None], np.linspace(0, 1, 11)[:, None]
    r, p = np.array([1e-3, 0.1, 0.5, 1.0]), np.array([1.0, 0.4, 1e-3, 0.2])
    found, expected = (lower(f, [T, W, layer.r, layer.p])(t, w, r, p) for f in (ours, theirs))
    np.testing.assert_allclose(found, expected, rtol=1e-13)


@pytest.mark.parametrize("r", [0.0, 0.2, 0.5, 0.7, 1.0])
def test_weights_add_up_to_one(r):
    a, b, c = (float(weight.subs({T: r})) for weight in _schlick.weights(T))
    assert a + b + c == pytest.approx(1, abs=1e-15) and min(a, b, c) >= 0
    assert (a, b, c) == pytest.approx((max(0, 1 - b) * (r >= 0.5), 4 * r * (1 - r), (1 - b) * (r < 0.5)))


def coherent(model, v, **values):
    known = by_name({**model.defaults, **values})
    return lower(model.coherent, [*LETTERS, *model.parameters])(
        v, v, v, v, v, *(known[p.name] for p in model.parameters)
    )


@pytest.mark.parametrize("name", ["schlick", "schlick-conserving"])
def test_at_both_ends_of_roughness(name):
    """r = 0 is a mirror and nothing else, r = 1 a diffuser and no mirror."""
    view, light, v = directions(50, 11), directions(50, 12), np.linspace(0, 1, 11)
    assert not named(name)(view, view * [-1, -1, 1], r=0.0, C=0.3).any()
    np.testing.assert_allclose(coherent(named(name), v, r=0.0, C=0.3), power(v, 0.3), rtol=1e-14)
    expected = power(Pair(view, light).hv, 0.3) / np.pi
    np.testing.assert_allclose(named(name)(view, light, r=1.0, C=0.3), expected, rtol=1e-13)
    assert not coherent(named(name), v, r=1.0, C=0.3).any()


def test_two_mirrors_reflect_as_one_on_another():
    v = np.linspace(0, 1, 11)
    upper, below = power(v, 0.1), power(v, 0.6)
    found = coherent(named("schlick-double"), v, r=0.0, C=0.1, r_prime=0.0, C_prime=0.6)
    np.testing.assert_allclose(found, upper + (1 - upper) * below, rtol=1e-14)


def test_the_coherent_share_of_a_smooth_surface_and_of_a_rough_one():
    """Of a smooth one all that is seen and lit goes the mirror's way and the lobe is gone; of a rough one none does."""
    he, view, light = named("he"), directions(50, 13, 0.1), directions(50, 14, 0.1)
    v = np.linspace(0.1, 0.9, 9)
    known = {"alpha": 0.2, "eta": 0.2, "kappa": 3.0, "diffuse": 0.0, "specular_share": 0.6}
    seen = smith_1967(np.sqrt(1 - v * v) / v, 0.2 / np.sqrt(2))
    np.testing.assert_allclose(coherent(he, v, sigma=0.0, **known), 0.6 * fresnel(v, 0.2 + 3j) * seen**2, rtol=1e-12)
    assert not he(view, light, sigma=0.0, **known).any()
    assert coherent(he, v, sigma=10.0, **known).max() < 1e-60
    rough = named("cook-torrance")(view, light, **known)
    np.testing.assert_allclose(he(view, light, sigma=10.0, **known), rough, rtol=1e-14)


# --- Energy ---


def reach(r, p, steps=(96, 64)):
    """Half vectors by Schlick's distribution, in equal parts of it, and the density of each per solid angle."""
    nodes, weight = np.polynomial.legendre.leggauss(steps[0])
    a, b = (nodes + 1) / 2, (np.arange(steps[1]) + 0.5) / steps[1] * 2 * np.pi
    t, phi = np.sqrt(a / (r - a * r + a))[:, None], np.arctan2(np.sin(b), p * np.cos(b))[None]
    s = np.sqrt(1 - t * t)
    half = np.stack([s * np.cos(phi), s * np.sin(phi), t + 0 * phi], -1)
    return half, np.broadcast_to(weight[:, None] / 2 / steps[1], half.shape[:2])


def density(view, light, r, p):
    pair = Pair(view, light)
    return eq28(pair, r, p, False) * pair.nh / (np.pi * 4 * pair.hv)


def albedo(model, view, r, p, **values):
    """The directional albedo, mirror included: half of the directions by the lobe, half by the cosine."""
    half, part = reach(r, p)
    from_lobe = 2 * (half @ view)[..., None] * half - view
    around, _ = reach(1.0, 1.0)
    lights = [from_lobe, around]
    total = 0.0
    for light in lights:
        inside = light[..., 2] > 1e-9
        light = np.where(inside[..., None], light, towards(0.5, 1.0))
        both = density(view, light, r, p) + light[..., 2] / np.pi
        value = model(view, light, r=r, p=p, **values) * light[..., 2] / both
        total += np.sum(np.where(inside, value, 0) * part)
    return total + float(coherent(model, view[2], r=r, p=p, **values))


def towards(v, phi):
    return np.array([np.sqrt(1 - v * v) * np.cos(phi), np.sqrt(1 - v * v) * np.sin(phi), v])


GRAZING = [1e-4, 0.02, 0.1, 0.3, 0.6, 1.0]


@pytest.mark.parametrize("C", [0.0, 0.5])
def test_a_darker_one_reflects_less(C):
    found = [albedo(named("schlick-conserving"), towards(v, 0.0), 0.3, 1.0, C=C) for v in GRAZING]
    assert max(found) < 1 and found[-1] < C + 0.03


@pytest.mark.parametrize(("name", "r"), [("schlick", 0.2), ("schlick-23-30", 0.2), ("schlick-23-25", 0.2)])
def test_the_paper_s_models_do_not(name, r):
    """Eqs. 25, 30 and 32 reflect more than they receive at grazing angles; towards the normal they do not."""
    found = [albedo(named(name), towards(v, 0.0), r, 1.0, C=1.0) for v in (0.01, 0.03, 1.0)]
    assert found[0] > found[1] > 2 and found[2] < 1.5


def test_two_layers_that_conserve_do_not_together():
    """A mirror over a diffuser, each of albedo 1 at most: shares at the half vector let both have the light."""
    model, v = named("schlick-double"), 0.02
    known = {"C": 0.0, "C_prime": 1.0, "r_prime": 1.0}
    assert albedo(model, towards(v, 0.0), 0.0001, 1.0, **known) > 1.8


def lobe_albedo(v, phi, r, p, k):
    """Of facets Z A/(4 pi v v') alone, with the masking v/(v + k (1 - v))."""
    half, part = reach(r, p, (160, 128))
    cosine = half @ towards(v, phi)
    lit = 2 * cosine * half[..., 2] - v
    inside = (cosine > 0) & (lit > 0)
    lit = np.where(inside, lit, 1)
    value = lit / ((v + k * (1 - v)) * (lit + k * (1 - lit))) * cosine / half[..., 2]
    return np.sum(np.where(inside, value, 0) * part)


def test_schlicks_masking_lets_smooth_facets_reflect_too_much():
    assert lobe_albedo(0.01, 0.0, 0.01, 1.0, 0.01) == pytest.approx(2.65, abs=0.02)
    assert lobe_albedo(0.01, 0.0, 0.1, 1.0, 0.1) > 1 > lobe_albedo(0.01, 0.0, 0.25, 1.0, 0.25)


def test_the_masking_is_below_the_exact_one():
    """Smith's Lambda of Z A, E[(x - a)+]/a for the slope x towards the view, is at most k (1 - v)/v in any azimuth.

    For a slope of length s along the angle psi to the view, c = cos(psi) > 0: the mean of (c s - a)+ over the lengths,
    2 s r/(r + s^2)^2, is c sqrt(r) atan(c sqrt(r)/a).
    """
    b = (np.arange(2880) + 0.5) / 2880 * 2 * np.pi
    v, root = np.linspace(0.001, 0.999, 24)[:, None, None], np.linspace(0.02, 1, 7)[None, :, None]
    a = v / np.sqrt(1 - v * v)
    for p in (0.02, 0.1, 0.3, 0.6, 1.0):
        for azimuth in np.linspace(0, np.pi / 2, 4):
            c = np.maximum(np.cos(np.arctan2(np.sin(b), p * np.cos(b)) - azimuth), 0)
            exact = np.mean(c * root * np.arctan(c * root / a), axis=-1) / a[..., 0]
            assert (exact <= (root / (1 + p) * (1 - v) / v)[..., 0] * (1 + 1e-6)).all()
