"""The laws, on models that keep them and on models broken on purpose; and the command that measures them."""

import functools
import json
import math

import numpy as np
import pytest
import sympy as sp

from ratfit._parse import RatfitError
from ratfit._target import parameter
from ratfit.brdf import distribution
from ratfit.models import MODELS, Model
from ratfit.models.albedo import Albedo, angles
from ratfit.models.check import check
from ratfit.models.directions import SINE2, V_PRIME, T, U, V, W, cosines
from ratfit.models.laws import FAILS, HOLDS, NOT_APPLICABLE, UNDECIDED
from ratfit.models.laws.drawing import agreement, sampling
from ratfit.models.laws.energy import Brightest, brightest, energy
from ratfit.models.laws.limits import limits
from ratfit.models.laws.normalisation import normalisation
from ratfit.models.laws.reciprocity import reciprocity
from ratfit.models.laws.settings import settings
from ratfit.models.laws.single import single

K = parameter("k", 0, 1)
ALPHA = parameter("alpha", "1/100", 1)
R, P = parameter("r", "1/100", 1), parameter("p", "1/100", 1)


def own(reflectance, *parameters, **more):
    defaults = {p.name: 0.5 for p in parameters}
    return Model("mine", "of a test", sp.sympify(reflectance, strict=True), parameters, "none", defaults, **more)


WHITE = own(1 / sp.pi)


@pytest.mark.parametrize(
    ("model", "verdict", "found"),
    [
        (WHITE, HOLDS, 0),
        (own(V * V_PRIME + T), HOLDS, 0),
        (own(2 + V), FAILS, 1 / 3),  # at most: (2 + 1) against (2 + 0)
        (own(1 / sp.pi + K * V**2, K), FAILS, math.pi / (1 + math.pi)),  # at k = 1
    ],
)
def test_reciprocity(model, verdict, found):
    law = reciprocity(model, {}, 0)
    assert law.verdict == verdict and law.found == pytest.approx(found, rel=0.02)
    if verdict == FAILS:
        assert abs(law.place["view"] - law.place["light"]) > 60
        assert law.place.get("k", 1) == 1


@pytest.mark.parametrize(
    ("model", "verdict", "found", "place"),
    [
        (WHITE, HOLDS, 1, {}),
        (own((1 - K) / sp.pi, K), HOLDS, 1, {"k": 0}),
        (own(2 / sp.pi), FAILS, 2, {}),
        (own((1 + 4 * K * (1 - K)) / sp.pi, K), FAILS, 2, {"k": 0.5}),  # between the ends of the range
        (own(1 / (2 * sp.pi * V * V_PRIME)), FAILS, 1 / angles().min(), {"view": 89.97}),
        (own(V_PRIME, mirror=sp.S.Half), FAILS, 2 * math.pi / 3 + 0.5, {}),
        (own(sp.log(-V)), FAILS, math.nan, {}),
    ],
)
def test_energy(model, verdict, found, place):
    law = energy(model, brightest(model, {}, 0))
    assert law.verdict == verdict and law.found == pytest.approx(found, rel=0.01, nan_ok=True)
    assert {name: law.place[name] for name in place} == pytest.approx(place, rel=0.02)


def test_energy_beyond_what_the_quadrature_can_tell_is_undecided():
    at = Brightest({}, 0.0, Albedo(np.array([0.5]), np.array([1.2]), np.array([0.4])), 1)
    assert energy(WHITE, at).verdict == UNDECIDED
    at = Brightest({}, 0.0, Albedo(np.array([0.5]), np.array([1.2]), np.array([0.1])), 1)
    assert energy(WHITE, at).verdict == FAILS


def test_energy_of_an_elliptical_lobe_is_searched_over_the_azimuth():
    across = own(2 * (1 - W**2) * distribution.ggx(T, ALPHA) / (4 * V * V_PRIME), ALPHA)
    law = energy(across, brightest(across, {"alpha": 0.05}, 0))
    assert law.verdict == FAILS and "view's azimuth" in law.place


@pytest.mark.parametrize("name", ["schlick-24-30", "schlick-23-25", "schlick"])
def test_schlicks_model_reflects_more_than_it_receives_at_grazing_angles(name):
    fixed = {"C": 1.0, "r": 0.3, "p": 1.0}
    law = energy(MODELS[name], brightest(MODELS[name], fixed, 0))
    assert law.verdict == FAILS and law.found > 100 and law.place["view"] > 85


@pytest.mark.parametrize("fixed", [{"C": 1.0, "r": 0.3, "p": 1.0}, {"C": 1.0, "r": 0.05, "p": 0.3}])
def test_the_conserving_model_conserves(fixed):
    law = energy(MODELS["schlick-conserving"], brightest(MODELS["schlick-conserving"], fixed, 0))
    assert law.verdict == HOLDS and law.found <= 1 + 1e-4


@pytest.mark.parametrize(
    ("facets", "verdict", "found"),
    [
        (None, NOT_APPLICABLE, None),
        (distribution.ggx(T, ALPHA), HOLDS, 0),
        (distribution.beckmann(T, ALPHA), HOLDS, 0),
        (2 * distribution.ggx(T, ALPHA), FAILS, 1),
        (1 / sp.pi + 0 * ALPHA, HOLDS, 0),
        (sp.S.One, FAILS, math.pi - 1),
        (2 * W**2 / sp.pi, HOLDS, 0),
        (T / sp.pi, FAILS, 1 / 3),
    ],
)
def test_normalisation(facets, verdict, found):
    law = normalisation(own(1 / sp.pi, ALPHA, distribution=facets), {}, 0)
    assert law.verdict == verdict
    if verdict != NOT_APPLICABLE:
        assert law.found == pytest.approx(found, abs=1e-4)


@pytest.mark.parametrize(
    ("model", "verdict"),
    [
        (WHITE, HOLDS),
        (own(distribution.ggx(T, ALPHA), ALPHA, sampler="ggx"), HOLDS),
        (own(W * 0 + T, R, P, sampler="schlick-as-printed"), FAILS),
    ],
)
def test_sampling(model, verdict):
    law = sampling(model, {p.name: 0.3 for p in model.parameters}, 0)
    assert law.verdict == verdict


def test_monte_carlo_is_held_against_the_quadrature():
    ones = np.ones(3)
    exact, drawn = Albedo(ones / 2, ones, 0 * ones), Albedo(ones / 2, ones + [0, 0.01, 0], 0.01 * ones)
    assert agreement(exact, drawn, {}).found == pytest.approx(1)
    assert agreement(exact, Albedo(ones / 2, ones + 0.06, 0.01 * ones), {}).verdict == FAILS
    assert agreement(exact, Albedo(ones / 2, ones * math.nan, 0.01 * ones), {}).verdict == FAILS


@pytest.mark.parametrize(
    ("reflectance", "remark"),
    [
        (1 / sp.pi, ""),
        (1 / (V**2 + sp.Rational(1, 10**300)), "infinite in float32"),  # where the square of 1e-20 is 0
        (1 / V**2 / V_PRIME**2, "infinite"),
        (sp.log(U - sp.S.Half), "nan"),
        (V - V_PRIME, "negative"),
    ],
)
def test_limits(reflectance, remark):
    law = limits(own(reflectance), {}, 0)
    assert law.verdict == (FAILS if remark else HOLDS) and remark in law.remark
    assert bool(law.place) == bool(remark)


@pytest.mark.parametrize(
    ("reflectance", "verdict"),
    [
        (1 / sp.pi, HOLDS),
        (distribution.ggx(T, sp.Rational(3, 10)), HOLDS),
        (distribution.ggx(T, sp.Rational(1, 10_000)), FAILS),  # 1 - t is nothing in float32 across the lobe,
        (distribution.ggx(T, sp.Rational(1, 10_000), SINE2), HOLDS),  # 1 - t^2 has all its digits
        (1 + sp.sin(10**8 * U), FAILS),
    ],
)
def test_float32(reflectance, verdict):
    assert single(own(reflectance), {}, 0).verdict == verdict


@pytest.mark.parametrize(("name", "fixed"), [
    ("schlick", {"r": 1e-11}), ("schlick-conserving", {"r": 1e-9, "p": 0.01}), ("smoothie", {"roughness": 0.01}),
    ("cook-torrance-ggx", {"alpha": 0.01}), ("ward", {"m": 0.01, "n": 0.01}),
])  # fmt: skip
def test_narrow_lobes_keep_their_digits_in_float32(name, fixed):
    """A hundredth would do for the law; the sine of H as a letter makes it less than 2e-4."""
    assert single(MODELS[name], fixed, 0).found < 2e-4


def test_the_squares_are_right_where_the_cosines_have_no_digits():
    """H at an angle of 1e-5 from N in float32: 1 - t^2 = 1e-10 is below the last digit of t."""
    angle, view = np.float32(2e-5), np.array([0, 0, 1], np.float32)
    light = np.array([0.6 * angle, 0.8 * angle, 1], np.float32)
    t, *_, sine2, w2 = cosines(view, light)
    assert t == 1 and sine2 == pytest.approx(1e-10, rel=1e-6) and w2 == pytest.approx(0.36, rel=1e-6)


@pytest.mark.parametrize("name", ["ward", "schlick", "microfacet-ggx", "oren-nayar"])
@pytest.mark.parametrize("light", [[math.nan, 0.6, 0.8], [0.6, 0.0, math.nan]])
def test_a_direction_that_is_no_number_has_no_reflectance(name, light):
    assert math.isnan(MODELS[name]([0.6, 0, 0.8], light)) and MODELS[name]([0.6, 0, 0.8], [0, 0.6, -0.8]) == 0


def test_settings_hold_the_ends_and_keep_what_is_fixed():
    model = own(K * ALPHA, K, ALPHA)
    found = settings(model, {"alpha": 0.2}, 10, 0)
    assert len(found) == 10 and all(each["alpha"] == 0.2 for each in found)
    assert {0.0, 0.5, 1.0} <= {each["k"] for each in found}
    corners = {(each["k"], each["alpha"]) for each in settings(model, {}, 20, 0)}
    assert {(0, 0.01), (0, 1), (1, 0.01), (1, 1)} <= corners
    assert settings(WHITE, {}, 10, 0) == [{}]
    assert settings(model, {}, 20, 1) == settings(model, {}, 20, 1) != settings(model, {}, 20, 2)


def test_a_check_keeps_every_law_of_white_paper():
    found = check(WHITE, seed=3)
    assert found.holds and len(found.albedo.values) == 64
    assert [law.name for law in found.laws if law.verdict == NOT_APPLICABLE] == ["normalisation of D"]


@pytest.fixture
def run(run):
    return functools.partial(run, "check-model")


def test_command_lists_the_models(run):
    code, out, _ = run()
    assert code == 0 and all(name in out for name in MODELS)
    code, out, _ = run("--format", "json")
    assert code == 0 and [each["model"] for each in json.loads(out)] == list(MODELS)


def test_command_says_yes(run):
    code, out, _ = run("lambert", "--set", "albedo=1/2")
    assert code == 0 and "albedo = 0.5" in out and "FAILS" not in out


def test_command_says_no_and_where(run, tmp_path):
    picture = tmp_path / "albedo.svg"
    arguments = ("schlick-24-30", "--set", "r=0.3", "--set", "p=1", "--set", "C=1", "--plot", str(picture))
    code, out, err = run(*arguments, "--format", "json")
    assert err == f"wrote {picture}\n"
    found = json.loads(out)
    laws = {law["law"]: law for law in found["laws"]}
    assert code == 1 and not found["holds"] and found["fixed"] == {"r": 0.3, "p": 1.0, "C": 1.0}
    assert laws["energy"]["verdict"] == FAILS and laws["energy"]["place"]["view"] > 85
    assert laws["reciprocity"]["verdict"] == HOLDS
    assert len(found["albedo"]["value"]) == 64
    assert picture.read_text().startswith("<?xml") and "</svg>" in picture.read_text()


@pytest.mark.parametrize(
    ("arguments", "fragment"),
    [
        (["lambrt"], "lambert"),
        (["lambert", "--set", "albedo"], "--set"),
        (["lambert", "--set", "albedo=2"], "outside"),
        (["lambert", "--set", "albedo=white"], "number"),
        (["lambert", "--set", "albedo=oo"], "number"),
        (["lambert", "--set", "r=0.3"], "albedo"),
        (["lambert", "--set", "albedo=1", "--set", "albedo=1"], "twice"),
        (["lambert", "--plot", "albedo.bmp"], "svg"),
        (["lambert", "--seed", "-1"], "seed"),
        (["lambert", "--seed", "x"], "whole number"),
        (["lambert", "ward"], "ward"),
        (["--set", "r=0.3"], "name one"),
        (["--plot", "albedo.svg"], "name one"),
    ],
)
def test_command_refuses_bad_input_in_one_line(run, arguments, fragment):
    code, out, err = run(*arguments)
    assert code == 2 and not out and fragment in err and len(err.strip().splitlines()) == 1


def test_checks_with_unknown_parameters_fail_before_the_work():
    with pytest.raises(RatfitError, match="albedo"):
        check(MODELS["lambert"], {"r": 0.3})
    with pytest.raises(RatfitError, match="albedo"):
        check("lambert", {"r": 0.3})


@pytest.mark.parametrize(("model", "said"), [("lamber", "did you mean 'lambert'"), (3, "3 is no model")])
def test_what_is_no_model_is_not_checked(model, said):
    with pytest.raises(RatfitError, match=said):
        check(model)
