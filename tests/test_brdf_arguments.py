"""What a formula of reflectance refuses: text, arrays, nothing, and numbers that mean nothing; what it takes."""

import inspect
import math
from fractions import Fraction

import numpy as np
import pytest
import sympy as sp

from ratfit._parse import RatfitError
from ratfit.brdf import distribution, fresnel, masking, roughness, sampling

u, x = sp.symbols("u x", real=True)

NO_NUMBERS = ["3/2", np.linspace(0, 1, 3), [1, 2], None, True, np.array(1.5), 1j, sp.true]


@pytest.mark.parametrize("given", NO_NUMBERS, ids=lambda given: type(given).__name__)
@pytest.mark.parametrize(
    "formula", [lambda x: fresnel.conductor(u, x, 0), lambda x: masking.ggx(x, 0.3), lambda x: sampling.azimuth(x, 1)]
)
def test_what_is_no_number_is_refused_with_a_remedy(formula, given):
    with pytest.raises(RatfitError, match=r"has the type \w+: give a symbol, .*ratfit\.lower") as refused:
        formula(given)
    assert "\n" not in str(refused.value)


IMPOSSIBLE = [
    (fresnel.conductor, (u, -1, 0), "conductor: eta is -1: give 0 or more"),
    (fresnel.conductor, (u, 1.5, sp.Rational(-1, 9)), "conductor: kappa is -1/9: give 0 or more"),
    (fresnel.dielectric, (u, -1.5), "dielectric: eta is -1.5"),
    (fresnel.schlick, (u, 1.01), "schlick: f is 1.01: give a number from 0 to 1"),
    (fresnel.schlick, (u, 0.04, -2), "schlick: n is -2: give 0 or more"),
    (fresnel.spectral, (x, sp.S(2), 0.5), "spectral: average_normal is 2"),
    (fresnel.index, (sp.sqrt(2),), r"index: f is sqrt\(2\): give a number from 0 to 1"),
    (fresnel.normal, (sp.nan,), "normal: eta is nan: give a real number"),
    (fresnel.normal, (float("nan"),), "normal: eta is nan: give a real number"),
    (fresnel.lazanyi, (u, sp.I, 0), "lazanyi: eta is I: give a real number"),
    (masking.smith, (u, -0.1), "smith: m is -0.1"),
    (masking.ggx_correlated, (u, x, np.float32(-0.5)), "ggx_correlated: alpha is -0.5"),
    (masking.phong, (u, -sp.oo), "phong: exponent is -oo"),
    (masking.schlick_roughness, (u, -1), "schlick_roughness: r is -1"),
    (distribution.beckmann, (u, -0.3), "beckmann: alpha is -0.3: give 0 or more"),
    (distribution.ward, (u, x, 0.2, -1), "ward: n is -1"),
    (distribution.zenith, (u, 2), "zenith: r is 2: give a number from 0 to 1"),
    (distribution.ggx, (u, x, sp.I), "ggx: sine_squared is I: give a real number"),
    (roughness.alpha_by_peak, (-3,), "alpha_by_peak: n is -3: give -2 or more"),
    (roughness.wide_from_ggx, (2,), "wide_from_ggx: alpha is 2: give a number from 0 to 1"),
    (roughness.ggx_from_r, (1.5,), "ggx_from_r: r is 1.5"),
    (sampling.ggx_cosine, (2, 0.3), "ggx_cosine: a is 2: give a number from 0 to 1"),
    (sampling.azimuth, (x, 1.5), "azimuth: p is 1.5"),
]


@pytest.mark.parametrize(("formula", "arguments", "text"), IMPOSSIBLE)
def test_impossible_numbers_are_refused(formula, arguments, text):
    with pytest.raises(RatfitError, match=text):
        formula(*arguments)


@pytest.mark.parametrize("half", [0.5, np.float64(0.5), np.float32(0.5), Fraction(1, 2), sp.Rational(1, 2), x])
def test_numbers_of_every_kind_are_taken(half):
    want = fresnel.schlick(u, x).subs(x, sp.Rational(1, 2))
    assert abs((fresnel.schlick(u, half).subs(x, 0.5) - want).subs(u, sp.Rational(1, 3))) < 1e-15
    assert float(masking.ggx(sp.S.One, half).subs(x, 0.5)) == 1


def test_numbers_alone_give_a_number():
    assert float(distribution.ggx(1, 0.5)) == pytest.approx(4 / math.pi, rel=1e-15)
    assert float(distribution.ggx(1.0, 0.5, 0)) == pytest.approx(4 / math.pi, rel=1e-15)
    assert float(distribution.ward(0.8, 0.6, 0.3, 0.3)) == pytest.approx(
        float(distribution.beckmann(0.8, 0.3)), rel=1e-14
    )
    assert float(roughness.alpha_by_peak(roughness.exponent_by_peak(2))) == 2


@pytest.mark.parametrize("end", [0, 1, 0.0, 1.0, sp.S.Zero, sp.S.One])
def test_the_ends_of_a_range_belong_to_it(end):
    assert float(fresnel.schlick(0, end)) == 1 and float(fresnel.schlick(1, end)) == float(end)


def test_a_cosine_may_be_what_rounding_makes_it():
    assert masking.beckmann(1 + 2.0**-52, sp.Rational(1, 3)) == 1 and masking.beckmann(-0.5, 0.3) == 0


@pytest.mark.parametrize("room", [distribution, fresnel, masking, roughness, sampling])
def test_every_formula_is_held_and_keeps_its_signature_and_text(room):
    """`separable` takes a formula, which is held itself."""
    formulas = {
        name: each
        for name, each in vars(room).items()
        if inspect.isfunction(each) and each.__module__.startswith(room.__name__) and not name.startswith("_")
    }
    assert len(formulas) > 10
    for name, formula in formulas.items():
        assert formula.__name__ == name and formula.__doc__
        if name != "separable":
            parameters = inspect.signature(formula).parameters
            assert parameters and inspect.unwrap(formula) is not formula
            with pytest.raises(RatfitError, match=f"{name}: {next(iter(parameters))} has the type NoneType"):
                formula(*(None for _ in parameters))


def test_a_wrong_number_of_arguments_is_pythons_own_error():
    with pytest.raises(TypeError, match="missing a required argument"):
        fresnel.conductor(u)
