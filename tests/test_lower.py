"""The boundary to arrays: every function against sympy's own arbitrary precision, dtypes, special values, refusals."""

import math
import warnings
from fractions import Fraction

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from ratfit._kernel import Program, hoist, kernel, precision
from ratfit._lower import lower, rounded
from ratfit._parse import RatfitError

x, y, m = sp.symbols("x y m", real=True)
POINTS = (0.1875, 0.5, 0.8125)  # exact in float32, inside the domain of every function below

FUNCTIONS = [
    x, -x, sp.Integer(7) / 3, x + sp.pi, sp.pi - x, -x - 1, x / 3, -1 / x, 2 / (3 * x), x**2, x**7, x**-1, x**-3,
    sp.sqrt(x), x ** sp.Rational(5, 2), x ** sp.Rational(-3, 2), sp.cbrt(x), x ** sp.Rational(2, 3), x**x, 2**x, x**-x,
    sp.exp(x), sp.exp(-x), sp.log(x), sp.sin(x), sp.cos(x), sp.tan(x), sp.asin(x), sp.acos(x), sp.atan(x),
    sp.sinh(x), sp.cosh(x), sp.tanh(x), sp.asinh(x), sp.acosh(1 + x), sp.atanh(x), sp.sec(x), sp.csc(x), sp.cot(x),
    sp.sech(x), sp.csch(x), sp.coth(x), sp.atan2(x, -2), sp.erf(x), sp.erfc(x), sp.gamma(x), sp.loggamma(x),
    sp.Abs(x - 1), sp.sign(x - sp.Rational(1, 3)), sp.floor(5 * x), sp.ceiling(5 * x),
    sp.Min(x, sp.Rational(1, 2), 1 - x), sp.Max(x, 1 - x), sp.Heaviside(x - sp.Rational(1, 3)),
    sp.Piecewise((x, x < sp.Rational(1, 3)), (x**2, (x >= sp.Rational(1, 3)) & (x < sp.Rational(2, 3))), (7, True)),
    sp.Piecewise((1, (x < sp.Rational(1, 4)) | (x > sp.Rational(3, 4))), (2, True)),
    sp.Piecewise((1, sp.Piecewise((1 - x, x > sp.Rational(1, 2)), (x, True)) > sp.Rational(1, 4)), (2, True)),
    sp.Piecewise((1, sp.Not(sp.Eq(x, 2))), (2, True)), sp.Piecewise((1, sp.Ne(x, 2)), (2, True)),
    x * (x - sp.pi**2 / 4) / ((sp.pi - sp.pi**2 / 4) * x - sp.pi**2 / 4),
    sp.sqrt(3) * x * (1 - x) ** 5 / (sp.sqrt(2) * (x**2 + 1) ** 2 * (3 - x)),
    sp.exp((x**2 - 1) / x**2) / x**4,
]  # fmt: skip


@pytest.mark.parametrize("expression", FUNCTIONS, ids=str)
def test_every_function_agrees_with_arbitrary_precision(expression):
    expected = [float(expression.subs(x, sp.Rational(point)).evalf(30)) for point in POINTS]
    on_numpy, on_jax = lower(expression, [x]), lower(expression, [x], "jax")
    assert [on_numpy(point) for point in POINTS] == pytest.approx(expected, rel=1e-13)
    assert all(type(on_numpy(point)) is float for point in POINTS)
    for dtype, tolerance in (("float32", 3e-6), ("float64", 1e-13)):
        with precision(dtype):
            values = {"numpy": on_numpy(np.array(POINTS, dtype)), "jax": jax.jit(on_jax)(jnp.array(POINTS, dtype))}
        for backend, value in values.items():
            assert (value.dtype, value.shape) == (np.dtype(dtype), (3,)), backend
            assert np.asarray(value, float).tolist() == pytest.approx(expected, rel=tolerance), backend


SPECIAL = [
    (1 / x, 0.0, math.inf), (sp.sin(x) / x, 0.0, math.nan), (sp.log(x), 0.0, -math.inf), (sp.log(x), -1.0, math.nan),
    (sp.sqrt(x), -1.0, math.nan), (sp.cbrt(x), -8.0, math.nan), (sp.cbrt(x), -0.0, 0.0), (sp.asin(x), 2.0, math.nan),
    (2 - sp.erfc(sp.sqrt(x)), math.inf, 2.0), (sp.exp(-1 / x), 0.0, 0.0), (sp.exp(x), 1e4, math.inf),
    (x**2, 1e200, math.inf), (sp.loggamma(x), -0.5, math.nan), (sp.Max(x, 0), math.nan, math.nan),
    (sp.Heaviside(x), 0.0, 0.5), (sp.Piecewise((1, x < 0)), 1.0, math.nan), (sp.Piecewise((1, x < 0)), -1.0, 1.0),
    (sp.Integer(10) ** 400 * x, 1.0, math.inf), (sp.Min(x, sp.oo), 3.0, 3.0), (x + sp.nan, 1.0, math.nan),
]  # fmt: skip


@pytest.mark.parametrize(("expression", "at", "expected"), SPECIAL, ids=str)
def test_infinite_and_undefined_are_values_without_a_warning(expression, at, expected):
    with warnings.catch_warnings(), precision("float64"):
        warnings.simplefilter("error")
        values = [
            lower(expression, [x])(at),
            lower(expression, [x])(np.array([at]))[0],
            lower(expression, [x], "jax")(jnp.array([at]))[0],
        ]
    assert [float(value) for value in values] == pytest.approx([expected] * 3, nan_ok=True)


def test_parameters_as_python_floats_leave_float32_alone():
    fit = sp.Piecewise((0, x < 1 - m), (sp.sqrt(m) * sp.erf(m) * x / (1 + m * x**2) ** 2, True))
    samples = np.linspace(0, 1, 5, dtype="float32")
    assert lower(fit, [x, m])(samples, 0.5).dtype == np.float32
    assert lower(fit, [x, m])(samples, np.float64(0.5)).dtype == np.float32
    assert lower(fit, [x, m])(np.float32(0.75), 0.5).dtype == np.float32
    for wide in (False, True):
        with jax.enable_x64(wide):
            assert jax.jit(lower(fit, [x, m], "jax"))(jnp.asarray(samples), 0.5).dtype == jnp.float32


def test_a_choice_between_two_numbers_is_of_the_dtype_of_the_arrays():
    step = sp.Piecewise((1, x < sp.Rational(1, 2)), (2, True))
    for expression in (step, step / 3, sp.Piecewise((1, m < 1), (2, True)) * x):
        assert lower(expression, [x, m])(np.zeros(2, "float32"), 0.5).dtype == np.float32


def test_arguments_broadcast_and_constants_fill():
    assert lower(x + y, [x, y])(np.zeros((3, 1)), np.zeros(2)).shape == (3, 2)
    assert lower(sp.Integer(1), [x])(np.zeros((2, 2), "float32")).tolist() == [[1, 1], [1, 1]]
    assert lower(sp.pi, [x], "jax")(jnp.zeros(3)).shape == (3,)
    assert lower(x / 2, [x])([1, 2]).tolist() == [0.5, 1.0]
    assert lower(x**40, [x])(np.array([3])).tolist() == [3.0**40]
    assert lower(x / 2, [x], "jax")(np.arange(3)).tolist() == [0, 0.5, 1]
    assert lower(x / 2, [x])(Fraction(1, 4)) == lower(x / 2, [x])(sp.Rational(1, 4)) == 0.125


def test_the_input_is_never_handed_back():
    samples = np.zeros(3)
    lower(x, [x])(samples)[:] = 1
    assert samples.tolist() == [0, 0, 0]


def test_the_lowered_function_can_be_differentiated_by_jax():
    assert float(jax.grad(lower(x**5 / (1 + x), [x], "jax"))(1.0)) == pytest.approx(5 / 2 - 1 / 4)


@pytest.mark.parametrize(
    ("number", "expected"),
    [
        (sp.Rational(1, 3), 1 / 3),
        (sp.Rational(10**23), 1e23),
        (sp.pi, math.pi),
        (sp.pi**2 / 4, float.fromhex("0x1.3bd3cc9be45dep+1")),
        (sp.sqrt(2), 2**0.5),
        (-sp.oo, -math.inf),
        (sp.Float("0.1"), 0.1),
        (sp.roots(sp.Poly(x**3 - 3 * x + 1), multiple=True)[0], -2 * math.cos(math.pi / 9)),
    ],
    ids=str,
)
def test_numbers_are_rounded_once(number, expected):
    assert rounded(number) == pytest.approx(expected, rel=1e-16)


@given(st.fractions())
@settings(deadline=None, max_examples=50)
def test_rationals_are_rounded_correctly(fraction):
    assert rounded(sp.Rational(fraction.numerator, fraction.denominator)) == fraction.numerator / fraction.denominator


@pytest.mark.parametrize(
    ("expression", "named"),
    [
        (sp.besselj(0, x), "besselj"),
        (sp.Function("f")(x), "f"),
        (sp.Integral(sp.sin(x * y), (y, 0, 1)), "Integral"),
        (x + y, "y"),
        (x + sp.I, "I"),
        (sp.sqrt(-2) * x, "sqrt(2)*I"),
        (x + sp.zoo, "zoo"),
        (sp.Function("f")(1) * x, "f(1)"),
    ],
    ids=str,
)
def test_what_arrays_do_not_have_is_refused_by_name(expression, named):
    with pytest.raises(RatfitError, match=named.replace("(", r"\(").replace(")", r"\)").replace("*", r"\*")):
        lower(expression, [x])


def test_text_is_not_evaluated_and_an_unknown_library_is_refused():
    with pytest.raises(RatfitError, match="has the type str"):
        lower("__import__('os')", [x])
    with pytest.raises(RatfitError, match="torch"):
        lower(x, [x], "torch")


HOISTED = [
    (m**2 * x, 1), (x / m + x / m**2, 2), (x + m - 1, 1), (sp.sin(m) * sp.sin(x * m), 2), (x**m, 1), (m**2 + 1, 1),
    (sp.Piecewise((0, x < 1 - m), (1 / (x - 1 + m), True)), 2), (sp.Piecewise((m, m < 1), (x, True)), 1),
    (sp.Max(x, m, 0), 1), (2 * sp.pi * x, 0), (sp.exp((x**2 - 1) / (m**2 * x**2)) / (m**2 * x**4), 1),
    (sp.Heaviside(x - m) * sp.Abs(x - m), 2), (sp.Piecewise((0, (x < m) | ~(x > -m)), (1, True)), 1),
]  # fmt: skip


@pytest.mark.parametrize(("expression", "constants"), HOISTED, ids=str)
def test_parts_free_of_the_variable_are_taken_out_and_the_value_stays(expression, constants):
    hoisted = hoist(Program(expression), (x,))
    symbols = {symbol for symbol, _ in hoisted.constants}
    assert len(symbols) == constants
    assert hoisted.result.free_symbols <= symbols | {x}
    value = lower(hoisted.result, (x, *(symbol for symbol, _ in hoisted.constants)))(0.75, *hoisted.values({m: 0.375}))
    assert value == pytest.approx(lower(expression, [x, m])(0.75, 0.375), rel=1e-14)


def test_steps_free_of_the_variable_are_taken_out_of_a_program_too():
    k, s, t = sp.symbols("k s t")
    program = Program(s / (t - m), ((k, m**2 + 1), (s, k * x), (t, s + k * m)))
    hoisted = hoist(program, (x,))
    assert program.free_symbols == {x, m}
    assert [name for name, _ in hoisted.steps] == [s, t]
    names = [name for name, _ in hoisted.constants]
    value = lower(hoisted.result, (x, *names), "numpy", hoisted.steps)(0.75, *hoisted.values({m: 0.5}))
    assert value == 1.25 * 0.75 / (1.25 * 0.75 + 1.25 * 0.5 - 0.5)
    drawn = hoist(program, (x, m))
    assert drawn.constants == ()
    assert lower(drawn.result, (x, m), "numpy", drawn.steps)(0.75, 0.5) == value


def test_one_kernel_serves_all_parameter_values():
    built = kernel(Program(m * x / (1 + m**2 * x)), (x,))
    assert kernel(Program(m * x / (1 + m**2 * x)), (x,)) is built
    samples = jnp.linspace(0, 1, 3)
    for value in (0.25, 0.5):
        assert built.at({m: value}, "float32")(samples)[2] == pytest.approx(value / (1 + value**2))
    assert built.jitted._cache_size() == 1


@pytest.mark.parametrize(
    ("expression", "arguments", "remedy"),
    [
        ("x**2", (x,), "type str: give sympy's"),
        (None, (x,), "type NoneType: give sympy's"),
        (x**2, x, "a tuple of symbols"),
        (x**2, "x", "a tuple of symbols"),
        (x**2, ("x",), "'x' has the type str: give a sympy.Symbol"),
        (x**2, (x**2,), "give a sympy.Symbol"),
    ],
)
def test_what_is_not_sympys_is_refused_with_a_remedy(expression, arguments, remedy):
    with pytest.raises(RatfitError, match=remedy) as refused:
        lower(expression, arguments)
    assert "\n" not in str(refused.value)
