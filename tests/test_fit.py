"""A Fit evaluates on floats, NumPy and JAX arrays, and shows itself as mathematics."""

import dataclasses
import math

import numpy as np
import pytest
import sympy as sp

import ratfit as rf


@pytest.fixture(scope="module")
def smith():
    return rf.derive("eq19")


def schlick_smith(v, m):
    k = math.sqrt(2 * m * m / math.pi)
    return v / (v - k * v + k)


def test_a_float_gives_a_float(smith):
    found = smith(0.3, m=0.2)
    assert isinstance(found, float)
    assert found == pytest.approx(schlick_smith(0.3, 0.2), rel=1e-14)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_a_numpy_array_keeps_its_dtype(smith, dtype):
    at = np.linspace(0, 1, 5, dtype=dtype)
    found = smith(at, m=0.2)
    assert found.dtype == at.dtype and found.shape == at.shape
    np.testing.assert_allclose(found, [schlick_smith(float(v), 0.2) for v in at], rtol=1e-5)


def test_a_jax_array_stays_one_and_can_be_differentiated(smith):
    import jax
    import jax.numpy as jnp

    found = smith(jnp.array([0.25, 0.5]), m=0.2)
    assert isinstance(found, jax.Array)
    assert jax.grad(lambda v: smith(v, m=0.2))(jnp.float32(0.0)) == pytest.approx(
        math.sqrt(math.pi / 2) / 0.2, rel=1e-5
    )


def test_outside_its_support_the_fit_is_what_the_form_says():
    beckmann = rf.derive("eq21")
    assert beckmann(0.4, m=0.5) == 0
    assert beckmann(1.0, m=0.5) == pytest.approx(4)


def test_choices_are_put_in():
    assert rf.derive("eq15")(0.5, f=0.04) == pytest.approx(0.04 + 0.96 / 32)


@pytest.mark.parametrize("values, words", [({}, "give m by name"), ({"m": 0.2, "k": 1}, "has no parameter k")])
def test_wrong_names_are_refused(smith, values, words):
    with pytest.raises(rf.RatfitError, match=words):
        smith(0.3, **values)


def test_it_is_mathematics_in_a_notebook(smith):
    assert smith._repr_latex_().startswith("$\\displaystyle \\frac{")


def test_a_condition_says_itself_in_a_line():
    kept = rf.derive("eq12").conditions
    assert [str(each) for each in kept] == [
        "✓ value at 0 = 0",
        "✓ derivative at 0 = 1",
        "✓ value at pi/2 = 1",
        "✓ derivative at pi/2 = 0",
    ]
    assert kept[0].line(unicode=False, width=12) == "ok value at 0   = 0"
    broken = dataclasses.replace(kept[1], holds=False)
    assert (str(broken), str(dataclasses.replace(broken, holds=None))) == (
        "✗ derivative at 0 = 1",
        "? derivative at 0 = 1",
    )


def test_records_are_frozen(smith):
    with pytest.raises(dataclasses.FrozenInstanceError):
        smith.status = "unique"


def test_the_readme_of_python_use():
    x = sp.Symbol("x")
    problem = rf.Problem(
        target=rf.Target(sp.sin(x), x, (0, sp.pi / 2)),
        conditions=[rf.Value(0), rf.Derivative(0), rf.Value(sp.pi / 2), rf.Derivative(sp.pi / 2)],
        form=rf.Rational(2, 1),
    )
    fit = rf.derive(problem)
    assert fit.status == "unique"
    assert fit(math.pi / 2) == pytest.approx(1, abs=1e-15)
    assert fit(0.0) == 0


def test_a_parameter_made_in_python():
    v, m = sp.Symbol("v", positive=True), rf.parameter("m", "1/100", "1/2")
    problem = rf.Problem(
        target=rf.Target(v**m, v, (1, 2)),
        conditions=[rf.Value(1), rf.Derivative(1), rf.Derivative(1, order=2)],
        form=rf.Rational(1, 1),
    )
    fit = rf.derive(problem)
    assert list(problem.parameters) == [m]
    assert sp.simplify(fit.expression - ((1 + m) * v + 1 - m) / ((1 - m) * v + 1 + m)) == 0


def test_a_symbol_that_nobody_declared_is_refused():
    x, k = sp.symbols("x k")
    with pytest.raises(rf.RatfitError, match="nobody declared k"):
        rf.Problem(target=rf.Target(sp.exp(k * x), x, (0, 1)), conditions=[rf.Value(0)], form=rf.Rational(1, 1))
