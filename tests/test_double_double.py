"""Double-double values against mpmath at 60 digits, at nasty points; ends as float64 has them; what needs 106 bits."""

import math
import warnings

import mpmath
import numpy as np
import pytest
import sympy as sp

from ratfit._double_double import double_double, reference_error
from ratfit._double_double.arithmetic import DoubleDouble, two_product, two_sum
from ratfit._lower import Entries, Lookup, lower
from ratfit._parse import RatfitError
from ratfit.gallery import cards

x, y, m = sp.symbols("x y m", real=True)
UNIT = 2.0**-106  # u**2, u float64's unit roundoff
RANDOM = np.random.default_rng(20)


def spread(first, last, count=60):
    """Random numbers of every size from `first` to `last`."""
    return np.exp(RANDOM.uniform(math.log(first), math.log(last), count))


def both(values):
    return np.concatenate([values, -values])


SIZES = both(spread(1e-250, 1e300))
USUAL = both(spread(0.01, 30))
TURNS = np.concatenate([np.arange(1, 63662, 997) * turn for turn in (np.pi, np.pi / 2, np.pi / 4)])  # up to 2e5
TURNS = np.concatenate([TURNS, np.nextafter(TURNS, 0), [6381956970095103 * 2.0**797]])  # muller2018: the worst double
BELOW_ONE = np.concatenate([both(spread(1e-250, 1)), both(1 - spread(1e-16, 1))])

FUNCTIONS = [
    (sp.exp(x), mpmath.exp, np.concatenate([RANDOM.uniform(-640, 709, 100), both(spread(1e-40, 1))])),
    (sp.log(x), mpmath.log, np.concatenate([spread(1e-290, 1e300), 1 + both(spread(1e-16, 0.5, 99))])),
    (sp.sin(x), mpmath.sin, np.concatenate([SIZES, USUAL, TURNS])),
    (sp.cos(x), mpmath.cos, np.concatenate([SIZES, USUAL, TURNS])),
    (sp.tan(x), mpmath.tan, np.concatenate([SIZES, USUAL, TURNS])),
    (sp.asin(x), mpmath.asin, BELOW_ONE),
    (sp.acos(x), mpmath.acos, BELOW_ONE),
    (sp.atan(x), mpmath.atan, np.concatenate([SIZES, USUAL])),
    (sp.sinh(x), mpmath.sinh, np.concatenate([both(spread(1e-250, 710)), USUAL])),
    (sp.cosh(x), mpmath.cosh, np.concatenate([both(spread(1e-250, 710)), USUAL])),
    (sp.tanh(x), mpmath.tanh, np.concatenate([both(spread(1e-250, 710)), USUAL])),
    (sp.asinh(x), mpmath.asinh, np.concatenate([SIZES, USUAL])),
    (sp.acosh(x), mpmath.acosh, np.concatenate([1 + spread(1e-15, 1), 1 + spread(1, 1e300)])),
    (sp.atanh(x), mpmath.atanh, BELOW_ONE),
    (sp.erf(x), mpmath.erf, np.concatenate([both(spread(1e-250, 6)), both(spread(0.1, 6))])),
    (sp.erfc(x), mpmath.erfc, np.concatenate([both(spread(1e-250, 1)), RANDOM.uniform(-7, 25.5, 150)])),
    (sp.sqrt(x), mpmath.sqrt, spread(1e-280, 1e300)),
    (sp.cbrt(x), mpmath.cbrt, spread(1e-280, 1e300)),
    (x**7, lambda a: a**7, spread(1e-40, 1e40)),
    (x**-5, lambda a: a**-5, spread(1e-50, 1e50)),
    (x ** sp.Rational(-5, 2), lambda a: 1 / (a * a * mpmath.sqrt(a)), spread(1e-100, 1e100)),
    (sp.coth(x), mpmath.coth, USUAL),
    (x / (x + sp.pi) + sp.Rational(1, 3), lambda a: a / (a + mpmath.pi) + mpmath.mpf(1) / 3, spread(1e-9, 1e9)),
]  # fmt: skip


def relative_errors(expression, exact, *points, symbols=(x,)):
    high, low = double_double(expression, symbols)(*points)
    with mpmath.workdps(60):
        for *place, h, low_ in zip(*np.broadcast_arrays(*points, high, low), strict=True):
            expected = exact(*map(mpmath.mpf, map(float, place)))
            if abs(expected) > 1e-280:  # below, the errors of products underflow
                assert abs(low_) <= np.spacing(abs(h)) / 2
                yield float(abs(mpmath.mpf(float(h)) + float(low_) - expected) / abs(expected)), place


@pytest.mark.parametrize(("expression", "exact", "points"), FUNCTIONS, ids=[str(row[0]) for row in FUNCTIONS])
def test_every_function_agrees_with_mpmath_to_eight_units_of_106_bits(expression, exact, points):
    error, at = max(relative_errors(expression, exact, points))
    assert error < 8 * UNIT, at


POWERS = {
    sp.Rational(7, 10): spread(1e-280, 1e300),
    sp.Rational(-22, 7): spread(1e-80, 1e80),
    sp.pi: spread(1e-90, 1e90),
    sp.Rational(2000, 3): 1 - spread(1e-12, 0.4),
}


@pytest.mark.parametrize("exponent", [*POWERS, 1000], ids=str)
def test_a_power_loses_as_its_logarithm_grows(exponent):
    points = POWERS.get(exponent, 1 - spread(1e-12, 0.4))
    for error, (at, power) in relative_errors(x**y, lambda a, b: a**b, points, float(exponent), symbols=(x, y)):
        assert error < (8 + 4 * abs(power * math.log(at))) * UNIT


@pytest.mark.parametrize("exponent", POWERS, ids=str)
def test_the_exponent_of_a_power_is_no_float64(exponent):
    def exact(base):
        return base ** mpmath.mpf(exponent.evalf(70)._mpf_)

    for error, (at,) in relative_errors(x**exponent, exact, POWERS[exponent]):
        assert error < (8 + 4 * abs(float(exponent) * math.log(at))) * UNIT


def test_an_integer_power_loses_as_its_exponent_grows():
    assert max(relative_errors(x**1000, lambda a: a**1000, 1 - spread(1e-12, 0.4)))[0] < 4000 * UNIT


def test_the_angle_of_a_point_in_every_quadrant_and_of_any_size():
    first, second = both(spread(1e-100, 1e100)), RANDOM.permutation(both(spread(1e-100, 1e100)))
    error, at = max(relative_errors(sp.atan2(x, y), mpmath.atan2, first, second, symbols=(x, y)))
    assert error < 8 * UNIT, at


def settings_of(card):
    """The targets of a card and its references, each with values of their parameters that float64 holds."""
    problem = card.problem
    at = {s: float((low + 2 * high) / 3) for s, (low, high) in problem.parameters.items()}
    targets = [problem.target.expression] if problem.target else []
    for reference in problem.references:
        own = {s: float(value) for s, value in reference.parameters.items()}
        symbols = sorted(reference.expression.free_symbols - {problem.variable}, key=str)
        yield reference.expression, {s: {**at, **own}[s] for s in symbols}
    for target in (*targets, *([card.published] if card.published is not None else [])):
        choices = {s: 5.0 for s in target.free_symbols if s.name in problem.choice}
        yield target, {s: v for s, v in {**at, **choices}.items() if s in target.free_symbols}


@pytest.mark.parametrize("card", cards(), ids=lambda card: card.name)
def test_every_formula_of_the_gallery(card):
    variable = card.problem.variable
    low, high = (min(max(float(end), -9), 9) for end in card.problem.domain)
    points = RANDOM.uniform(low + (high - low) / 20, high, 200)  # near an end, 1/tanh(x) - 1/x and others cancel
    for expression, parameters in settings_of(card):
        symbols, values = (variable, *parameters), list(parameters.values())
        exact = sp.lambdify(symbols, expression, "mpmath")
        error, at = max(relative_errors(expression, exact, points, *values, symbols=symbols), default=(0, None))
        assert error < 1e-27, at  # exp of -600 magnifies as much


ENDS = np.array(
    [0.0, -0.0, math.inf, -math.inf, math.nan, 5e-324, -5e-324, 1e-310, 2.3e-308, 1.79e308, -1.79e308, 1.0, -1.0, 2.0]
    + [-2.0, 0.5, -0.5, 709.8, -745.0, -746.0, 711.0, -711.0, 1e-160, 1e160, 26.0, 28.0, -30.0, 1e16, 1 + 2**-52]
)  # fmt: skip
LIKE_FLOAT64 = [
    *(row[0] for row in FUNCTIONS), 1 / x, 2**x, sp.floor(x), sp.ceiling(x), sp.sign(x), sp.Heaviside(x), sp.Abs(x),
    sp.Max(x, 1), sp.Min(x, -1), sp.exp(-1 / x), sp.exp(-(x**2)), 1 / (1 + x**2), x / (1 + x), -x, x + 1, sp.sec(x),
    sp.Piecewise((0, x < 1), (x, True)), sp.Piecewise((sp.sin(x) / x, sp.Ne(x, 0)), (1, True)),
    sp.Piecewise((1, (x < 1) | (x > 2))), sp.Piecewise((1, sp.Not(sp.Eq(x, 1))), (2, True)),
    sp.Piecewise((1, (x <= 1) & (x >= 0)), (2, True)), Lookup(2 * x, Entries([1, 4, 2])),
]  # fmt: skip
LIKE_FLOAT64_OF_TWO = [
    x**y, sp.atan2(x, y), x + y, x - y, x * y, x / y, sp.Max(x, y), sp.Min(x, y),
    sp.Piecewise((1, x < y), (2, x >= y)), sp.Piecewise((1, sp.Eq(x, y)), (2, True)),
]  # fmt: skip


@pytest.mark.parametrize("expression", [*LIKE_FLOAT64, *LIKE_FLOAT64_OF_TWO], ids=str)
def test_zeros_infinities_nan_and_overflow_are_those_of_float64(expression):
    places = np.meshgrid(ENDS, ENDS) if y in expression.free_symbols else [ENDS]
    symbols = (x, y)[: len(places)]
    plain = lower(expression, symbols)(*places)
    high, plain = finite_ones(expression, symbols, places, plain)
    # With an eye on subnormal results, of which both keep what they can.
    assert np.all(np.abs(high - plain) <= 8 * np.spacing(np.abs(high)))
    assert np.array_equal(np.signbit(high), np.signbit(plain))


def finite_ones(expression, symbols, places, plain):
    """The finite values beside float64's; the others are the same."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        high, low = double_double(expression, symbols)(*places)
    finite = np.isfinite(plain)
    assert np.array_equal(np.isfinite(high), finite)
    assert np.array_equal(high[~finite], plain[~finite], equal_nan=True)
    assert not low[~finite].any()
    assert np.isfinite(low).all()
    return high[finite], plain[finite]


@pytest.mark.parametrize(
    "expression",
    [1 - sp.exp(-x), 1 - sp.cosh(x), sp.sqrt(1 + x**2) - 1, 1 - sp.tanh(x), 1 - sp.erf(x), sp.erfc(x) - 1]
    + [2 - 2 * sp.cos(x)],
    ids=str,
)
def test_differences_from_one_have_the_infinities_and_nan_of_float64(expression):
    high, plain = finite_ones(expression, [x], [ENDS], lower(expression, [x])(ENDS))
    assert np.all(np.abs(high - plain) <= 8 * np.spacing(np.maximum(np.abs(high), 1)))


@pytest.mark.parametrize("operation", [two_sum, two_product])
def test_error_free_transformations_are_exact(operation):
    a, b = both(spread(1e-100, 1e100)), RANDOM.permutation(both(spread(1e-100, 1e100)))
    result, error = operation(a, b)
    with mpmath.workprec(1500):
        for p, q, r, e in zip(*(values.tolist() for values in (a, b, result, error)), strict=True):
            exact = mpmath.mpf(p) + q if operation is two_sum else mpmath.mpf(p) * q
            assert (mpmath.mpf(r) + e, r) == (exact, float(exact))


def test_arithmetic_of_two_double_doubles_that_cancel():
    """(a + b) - a with a far larger than b, both with a low part: what is left of b has lost a's last place alone."""
    a, b = (DoubleDouble(spread(1, 2), spread(1e-19, 1e-17)) for _ in range(2))
    b = b.scaled(2.0**-40)
    left = (a + b) - a
    assert np.all(np.abs((left - b).high) <= 8 * UNIT * a.high)
    assert np.all(np.abs(((a * b) / b - a).high) <= 22 * UNIT * a.high)


def test_formulas_that_cancel_keep_what_float64_loses():
    near_zero = spread(1e-7, 1e-4)
    gap = (1 - sp.cos(x)) / x**2
    high, low = double_double(gap, [x])(near_zero)
    series = 0.5 - near_zero**2 / 24 + near_zero**4 / 720
    assert high == pytest.approx(series, rel=2e-15)
    assert np.max(reference_error(gap, [x], [near_zero])) > 1e9
    assert np.max(reference_error(sp.sin(x), [x], [near_zero])) < 1
    assert np.all(low != 0)


CANCELLING = [
    ((1 - sp.cos(x)) / x**2, lambda a: 2 * mpmath.sin(a / 2) ** 2 / a**2),
    (sp.pi * sp.cos(m * x) - sp.pi, lambda a: -2 * mpmath.pi * mpmath.sin(3 * a / 2) ** 2),
    ((sp.cosh(x) - 1) / x, lambda a: 2 * mpmath.sinh(a / 2) ** 2 / a),
    (m - m * sp.exp(-(x**2)), lambda a: -3 * mpmath.expm1(-a * a)),
    (2 * m * sp.exp(x) / 3 - 2 * m / 3 + x, lambda a: 2 * mpmath.expm1(a) + a),
    (1 - sp.tanh(1 / x), lambda a: 2 / (mpmath.exp(2 / a) + 1)),
    (1 - sp.erf(1 / x), lambda a: mpmath.erfc(1 / a)),
    (sp.erfc(x) - 1, lambda a: -mpmath.erf(a)),
    ((sp.sqrt(1 + x) - 1) / x, lambda a: 1 / (mpmath.sqrt(1 + a) + 1)),
    (sp.log(1 + x) / x, lambda a: mpmath.log1p(a) / a),
]  # fmt: skip


@pytest.mark.parametrize(("expression", "exact"), CANCELLING, ids=[str(row[0]) for row in CANCELLING])
def test_differences_from_one_are_accurate_down_to_the_smallest_float32(expression, exact):
    points = spread(1e-45, 1) if not expression.has(1 / x) or expression.is_Mul else spread(0.05, 10)
    error, at = max(relative_errors(expression, lambda a, _: exact(a), points, 3.0, symbols=(x, m)))
    assert error < 1e-29, at


def test_units_in_the_last_place():
    assert reference_error(x + 1, [x], [np.array([2.0**-53, 2.0**-54, 0.0])]).tolist() == [0.5, 0.25, 0]
    assert reference_error(1 / x, [x], [np.array([0.0, math.nan, 4.0])]).tolist() == [0, 0, 0]
    assert reference_error(sp.pi * x, [x], [1.0]) == pytest.approx(abs(math.sin(math.pi)) / 2**-51)


def test_numbers_enter_with_106_bits_and_comparisons_see_them():
    high, low = double_double(sp.pi, [x])(np.zeros(2))
    assert high.tolist() == [math.pi] * 2
    assert low == pytest.approx(math.sin(math.pi), rel=1e-15)
    tenth = sp.Rational(1, 10)
    assert double_double(sp.Piecewise((1, x > tenth), (2, True)), [x])(0.1)[0] == 1  # float64's 0.1 lies above
    assert double_double(sp.floor(x * tenth), [x])(np.array([29.0, 30.0, -1.0]))[0].tolist() == [2, 3, -1]
    assert double_double(sp.floor(x + y), [x, y])(1.0, -1e-20)[0] == 0
    assert double_double(sp.Integer(2) ** 60 + 1 - x, [x])(2.0**60)[0] == 1


def test_shapes_blocks_and_dtypes():
    function = double_double(sp.sin(x) * m, [x, m])
    points = np.linspace(0, 6, 20000)
    high, low = function(points, 2.0)
    expected = [function(point, 2.0) for point in points[8190:8195]]
    assert [(h, low_) for h, low_ in zip(high[8190:8195], low[8190:8195], strict=True)] == expected
    assert function(np.zeros((3, 1)), np.zeros(2))[0].shape == (3, 2)
    assert function(np.zeros(0), 1.0)[0].shape == (0,)
    assert function(np.float32([0.1]), 1)[0].dtype == np.float64
    assert double_double(x, [x])(points)[0] is not points
    with pytest.raises(TypeError, match="1 values for the 2 arguments"):
        function(points)


@pytest.mark.parametrize(
    ("expression", "named"),
    [(sp.loggamma(x), "loggamma"), (sp.besselj(0, x), "besselj"), (sp.pi * x + y, r"y .*\(x\)"), (x + sp.I, "I")],
    ids=str,
)
def test_what_has_no_double_double_form_is_refused_by_name(expression, named):
    with pytest.raises(RatfitError, match=named):
        double_double(expression, [x])
