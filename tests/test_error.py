"""Errors: closed forms worked out by hand, an independent NumPy computation, and what must be refused."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import jax
import numpy as np
import pytest
import sympy as sp

import ratfit._error
from ratfit._error import DEFINITIONS, measure_error
from ratfit._parse import RatfitError
from ratfit._problem import Reference
from ratfit._sampling import sample
from ratfit._target import Target, parameter

x = sp.Symbol("x")
a, b = parameter("a", 0, 2), parameter("b", "1/10", 1)


@dataclass(frozen=True)
class Problem:
    variable: sp.Symbol
    domain: tuple[sp.Expr, sp.Expr]
    target: Target | None
    parameters: tuple[sp.Symbol, ...] = ()
    references: tuple[Reference, ...] = ()


@dataclass(frozen=True)
class Fit:
    problem: Problem
    formula: sp.Expr
    free: Mapping[sp.Symbol, tuple[sp.Expr, sp.Expr]] = field(default_factory=dict)


def fit(exact, formula, domain=(0, 1), parameters=()):
    target = Target(sp.sympify(exact), x, domain)
    return Fit(Problem(x, target.domain, target, parameters), sp.sympify(formula))


SINE = fit(sp.sin(x), x * (x - sp.pi**2 / 4) / ((sp.pi - sp.pi**2 / 4) * x - sp.pi**2 / 4), (0, sp.pi / 2))  # S Eq. 12
WITH_REFERENCES = Fit(
    Problem(
        x,
        (sp.Integer(0), sp.Integer(1)),
        None,
        (a,),
        (
            Reference("dielectric", a + sp.Symbol("n") * x, "", {sp.Symbol("n"): sp.Rational(3, 2)}),
            Reference("derived", a * x, "", {a: sp.Symbol("n") / 2, sp.Symbol("n"): sp.Rational(3, 2)}),
        ),
    ),
    a + x,
)


# --- Errors in closed form: definition -> exact value; a mean of a million points is known to about 1e-3 ---

CLOSED = [
    (
        fit(x, x + sp.Rational(1, 8), (1, 3)),
        {
            "peak_mean": 1 / 24, "peak_rms": 1 / 24, "peak_max": 1 / 24, "absolute_max": 1 / 8, "absolute_mean": 1 / 8,
            "relative_mean": math.log(3) / 16, "relative_max": 1 / 8,
        },
        1.0,
    ),
    (
        fit(x, x**2, (0, 1)),
        {
            "peak_mean": 1 / 6, "peak_rms": math.sqrt(1 / 30), "peak_max": 1 / 4, "absolute_max": 1 / 4,
            "absolute_mean": 1 / 6, "relative_mean": 1 / 2, "relative_max": 1.0,
        },
        0.0,
    ),
    (
        fit(-2 * x, -2 * x - sp.sin(x), (0, sp.pi)),
        {
            "peak_mean": 1 / sp.pi**2, "peak_rms": sp.sqrt(2) / (4 * sp.pi), "peak_max": 1 / (2 * sp.pi),
            "absolute_max": 1.0, "absolute_mean": 2 / sp.pi, "relative_mean": float(sp.Si(sp.pi) / (2 * sp.pi)),
            "relative_max": 1 / 2,
        },
        0.0,
    ),
]  # fmt: skip


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize(("measured", "expected", "worst"), CLOSED, ids=lambda value: "")
def test_every_definition_in_closed_form(measured, expected, worst, dtype):
    found = measure_error(measured, dtype=dtype)
    assert list(found.epsilon) == list(expected) == list(DEFINITIONS)
    assert found.epsilon == pytest.approx({name: float(value) for name, value in expected.items()}, rel=2e-3)
    assert (found.worst["definition"], found.nonfinite) == ("relative_max", 0)
    assert found.worst["at"] == pytest.approx(worst, abs=0.01)


def test_the_definitions_agree_with_an_independent_computation():
    points = np.asarray(sample("uniform", 0.0, math.pi / 2, 12_345, 3))
    exact, quarter = np.sin(points), math.pi**2 / 4
    error = np.abs(points * (points - quarter) / ((math.pi - quarter) * points - quarter) - exact)
    found = measure_error(SINE, samples=12_345, seed=3, dtype="float64")
    expected = {
        "peak_mean": error.mean() / exact.max(), "peak_rms": math.sqrt((error**2).mean()) / exact.max(),
        "peak_max": error.max() / exact.max(), "absolute_max": error.max(), "absolute_mean": error.mean(),
        "relative_mean": (error / exact).mean(), "relative_max": (error / exact).max(),
    }  # fmt: skip
    assert found.epsilon == pytest.approx(expected, rel=1e-12)
    assert found.worst == {"definition": "relative_max", "at": points[(error / exact).argmax()]}
    assert (found.samples, found.sampling, found.seed, found.dtype) == (12_345, "uniform", 3, "float64")
    assert (found.parameters, found.reference) == ({}, None)


def test_the_sine_of_1994_has_the_error_stated_there():
    assert round(measure_error(SINE).epsilon["peak_mean"], 3) == 0.014  # S, after Eq. 12: 1.4 %


# --- What the measurement rests on ---


def test_the_same_function_differs_by_the_rounding_of_the_dtype_alone():
    same = fit(sp.sin(x), sp.sin(x), (0, sp.pi / 2))
    assert set(measure_error(same, samples=10_000, dtype="float64").epsilon.values()) == {0}
    assert 1e-9 < measure_error(same, samples=10_000).epsilon["relative_max"] < 2.0**-22


def test_the_exact_function_is_computed_at_the_rounded_samples():
    assert set(measure_error(fit(x, x), samples=10_000).epsilon.values()) == {0}


def test_the_exact_function_is_float64_whatever_the_dtype():
    # 1 + x^8 - 1 is all rounding error in float32, so that a float32 exact function would be far from the fit.
    error = measure_error(fit((1 + x**4) ** 2 - 2 * x**4 - 1, x**8, (0, sp.Rational(1, 8))), samples=1000)
    assert error.epsilon["peak_max"] < 1e-6


def test_chunks_change_neither_the_points_nor_the_sums(monkeypatch):
    whole = measure_error(SINE, samples=2500, dtype="float64")
    monkeypatch.setattr(ratfit._error, "CHUNK", 1000)
    chunked = measure_error(SINE, samples=2500, dtype="float64")
    assert chunked.epsilon == pytest.approx(whole.epsilon, rel=1e-12)
    assert replace(chunked, epsilon={}) == replace(whole, epsilon={})


def test_the_seed_decides():
    first, again, other = (measure_error(SINE, samples=1000, seed=seed) for seed in (1, 1, 2))
    assert first == again
    assert first.epsilon["peak_mean"] != other.epsilon["peak_mean"]


@pytest.mark.parametrize("wide", [False, True])
def test_the_precision_of_the_user_is_neither_changed_nor_used(wide):
    before = jax.config.jax_enable_x64
    expected = measure_error(SINE, samples=1000)
    with jax.enable_x64(wide):
        assert measure_error(SINE, samples=1000) == expected
        assert jax.config.jax_enable_x64 is wide
    assert jax.config.jax_enable_x64 is before


# --- Non-finite values, zeros ---


@pytest.mark.parametrize("hole", ["exact", "fit"])
def test_nonfinite_values_are_counted_and_left_out(hole):
    holed = sp.Piecewise((x, x < sp.Rational(1, 2)), (sp.log(-x), x < sp.Rational(3, 4)), (sp.oo, True))
    pair = (holed, x + 1) if hole == "exact" else (x, holed + 1)
    found = measure_error(fit(*pair), samples=10_000, dtype="float64")
    assert found.nonfinite == (np.asarray(sample("uniform", 0.0, 1.0, 10_000, 0)) >= 0.5).sum()
    assert found.epsilon["absolute_mean"] == found.epsilon["absolute_max"] == 1
    # The peak is that of the exact function wherever it is finite, also where the fit is not.
    assert found.epsilon["peak_max"] == pytest.approx(2 if hole == "exact" else 1, rel=1e-3)


def test_nothing_finite_is_none_everywhere():
    found = measure_error(fit(x, sp.log(-x)), samples=1000)
    assert (found.nonfinite, set(found.epsilon.values())) == (1000, {None})
    assert found.worst == {"definition": "absolute_max", "at": None}


def test_where_the_exact_function_is_zero_there_is_no_relative_error():
    step = sp.Piecewise((0, x < sp.Rational(1, 2)), (1, True))
    found = measure_error(fit(step, step + sp.Rational(1, 4)), samples=1000)
    assert (found.epsilon["relative_mean"], found.epsilon["relative_max"]) == (0.25, 0.25)
    assert found.worst["at"] > 0.5
    zero = measure_error(fit(0, x), samples=1000, dtype="float64")
    assert [name for name, value in zero.epsilon.items() if value is not None] == ["absolute_max", "absolute_mean"]
    assert zero.worst == {"definition": "absolute_max", "at": zero.epsilon["absolute_max"]}


# --- Parameters, references, refusals ---


def test_parameters_reach_the_fit_the_target_and_the_domain():
    scaled = fit(a * x, a * x + b, (0, b), (a, b))
    found = measure_error(scaled, samples=1000, parameters={"b": 0.5, "a": 2}, dtype="float64")
    assert list(found.parameters.items()) == [("a", 2.0), ("b", 0.5)]
    assert found.epsilon["absolute_mean"] == pytest.approx(0.5)
    assert found.epsilon["peak_mean"] == pytest.approx(0.5, rel=1e-2)
    with pytest.raises(RatfitError, match=r"a = 2\.5 is outside its range \[0\.0, 2\.0\]"):
        measure_error(scaled, parameters={"a": 2.5, "b": 0.5})
    with pytest.raises(RatfitError, match="parameter b has no value"):
        measure_error(scaled, parameters={"a": 1})
    with pytest.raises(RatfitError, match="no parameter 'c'"):
        measure_error(scaled, parameters={"a": 1, "b": 0.5, "c": 1})
    with pytest.raises(RatfitError, match="a = '1': a number is needed"):
        measure_error(scaled, parameters={"a": "1", "b": 0.5})
    with pytest.raises(RatfitError, match="outside its range"):
        measure_error(scaled, parameters={"a": math.nan, "b": 0.5})


def test_a_reference_takes_the_place_of_the_target_and_gives_values():
    found = measure_error(WITH_REFERENCES, samples=1000, reference="dielectric", parameters={"a": 1}, dtype="float64")
    assert (found.parameters, found.reference) == ({"a": 1.0, "n": 1.5}, "dielectric")
    points = np.asarray(sample("uniform", 0.0, 1.0, 1000, 0))
    assert found.epsilon["absolute_mean"] == pytest.approx(points.mean() / 2)
    assert measure_error(WITH_REFERENCES, samples=10, reference="derived").parameters == {"a": 0.75, "n": 1.5}
    with pytest.raises(RatfitError, match=r"no target.*dielectric, derived"):
        measure_error(WITH_REFERENCES, parameters={"a": 1})
    with pytest.raises(RatfitError, match="did you mean 'dielectric'"):
        measure_error(WITH_REFERENCES, reference="dialectric", parameters={"a": 1})
    with pytest.raises(RatfitError, match=r"the reference says n = 1\.5"):
        measure_error(WITH_REFERENCES, reference="dielectric", parameters={"a": 1, "n": 2})


@pytest.mark.parametrize(
    ("measured", "options", "named"),
    [
        (SINE, {"samples": 0}, "samples = 0"),
        (SINE, {"dtype": "float16"}, "float16.*float32 or float64"),
        (SINE, {"sampling": "sobol"}, "sobol"),
        (SINE, {"reference": "sine"}, "there is: none"),
        (fit(x, x ** sp.Symbol("n")), {}, r"still free: n.*--set n="),
        (fit(x, x, (0, sp.oo)), {}, "finite ends"),
        (fit(sp.Function("f")(x), x), {}, "no f"),
    ],
    ids=str,
)
def test_what_cannot_be_measured_is_refused(measured, options, named):
    with pytest.raises(RatfitError, match=named):
        measure_error(measured, **options)
