"""The rigorous half of the nonlinear route: balls enclose, the Krawczyk test proves, recognition guesses well."""

import random

import flint
import mpmath
import pytest
import sympy as sp
from flint import acb, arb
from hypothesis import given, settings
from hypothesis import strategies as st

from ratfit._ball import ball_function, ball_integral
from ratfit._parse import RatfitError
from ratfit._solver.nonlinear.krawczyk import certificate
from ratfit._solver.nonlinear.polish import polished
from ratfit._solver.nonlinear.recognise import recognised
from ratfit._solver.nonlinear.residuals import Moment, Residual, Residuals

x, a, b, c = sp.symbols("x a b c", real=True)
R = sp.Rational
ROOT = sp.CRootOf(x**5 - x - 1, 0)
PAIR = [sp.CRootOf(x**4 - 10 * x**2 + 1, k) for k in range(4)]  # ±sqrt(2) ± sqrt(3), in order


@pytest.fixture(autouse=True)
def sixty_digits():
    with flint.ctx.workdps(60), mpmath.workdps(75):
        yield


def ball(expression):
    """Of a number, by mpmath: not by the code under test, and right to 60 digits."""
    with mpmath.workdps(75):
        value = sp.lambdify((), expression, "mpmath")()
        return arb(mpmath.nstr(mpmath.mpf(value), 70)) + arb(0, "1e-62")


# --- functions

FUNCTIONS = [
    x, -x, x + sp.pi, sp.E - x, sp.GoldenRatio * x, sp.EulerGamma + x, sp.Catalan - x, x / 3, 2 / (3 * x), x**7, x**-3,
    sp.sqrt(x), x ** R(5, 2), x ** R(-3, 2), sp.cbrt(x), x ** R(-2, 3), x**x, 2**x, x**-x, x**sp.pi, x ** sp.Float(0.3),
    sp.exp(x), sp.exp(-1 / x), sp.log(x), sp.sin(x), sp.cos(x), sp.tan(x), sp.asin(x), sp.acos(x), sp.atan(x),
    sp.sinh(x), sp.cosh(x), sp.tanh(x), sp.asinh(x), sp.acosh(1 + x), sp.atanh(x), sp.sec(x), sp.csc(x), sp.cot(x),
    sp.sech(x), sp.csch(x), sp.coth(x), sp.erf(x), sp.erfc(x), sp.gamma(x), sp.loggamma(x), sp.Abs(x - R(1, 2)),
    sp.atan2(x, 2), sp.atan2(x, -2), sp.atan2(-x, -2), x * (x - sp.pi**2 / 4) / ((sp.pi - 1) * x - 7),
    sp.sqrt(3) * x * (1 - x) ** 5 / (sp.sqrt(2) * (x**2 + 1) ** 2 * (3 - x)), sp.Float(0.1) * x, R(1, 3) + x,
]  # fmt: skip


@pytest.mark.parametrize("expression", FUNCTIONS, ids=str)
@settings(max_examples=8, deadline=None)
@given(place=st.fractions(R(1, 1000), R(999, 1000), max_denominator=1000), width=st.integers(5, 50))
def test_a_ball_contains_the_value_whether_real_complex_or_wide(expression, place, width):
    with mpmath.workdps(75):
        exact = mpmath.mpf(place.numerator) / place.denominator
        expected = arb(mpmath.nstr(sp.lambdify(x, expression, "mpmath")(exact), 70)) + arb(0, "1e-60")
    function = ball_function(expression, [x])
    point = arb(flint.fmpq(place.numerator, place.denominator))
    found, broad = function([point]), function([arb(point, arb(10) ** -width)])
    assert found.is_finite() and found.overlaps(expected) and found.rad() < 1e-50
    assert broad.contains(found)
    on_complex = function([acb(point)])
    assert on_complex.real.overlaps(found) and on_complex.imag.contains(0)


@pytest.mark.parametrize(
    ("number", "expected"),
    [
        (PAIR[0], -sp.sqrt(2) - sp.sqrt(3)), (PAIR[1], sp.sqrt(2) - sp.sqrt(3)), (PAIR[3], sp.sqrt(2) + sp.sqrt(3)),
        (sp.AlgebraicNumber(sp.sqrt(2)), sp.sqrt(2)), (sp.Float("0.1", 50), R(1, 10)),
        (sp.Float(0.1), R(3602879701896397, 2**55)), (sp.sin(1) ** 2 + sp.cos(1) ** 2, sp.S.One),
    ],
)  # fmt: skip
def test_numbers_are_taken_exactly(number, expected):
    with mpmath.workdps(75):
        value = mpmath.nstr(sp.lambdify((), expected, "mpmath")() + mpmath.mpf(0), 70)
    assert ball_function(number, [])([]).overlaps(arb(value) + arb(0, "1e-48"))


def test_a_root_without_radicals_is_one():
    value = ball_function(ROOT, [])([])
    assert (value**5 - value - 1).contains(0)


@pytest.mark.parametrize(
    "jumping",
    [
        sp.sign(x), sp.floor(x), sp.ceiling(x), sp.Min(x, 1), sp.Max(x, 1), sp.Heaviside(x), sp.oo, sp.zoo, sp.I,
        sp.Piecewise((x, x < 1), (1, True)), sp.CRootOf(x**5 - x - 1, 1),
    ],
    ids=str,
)  # fmt: skip
def test_what_has_no_ball_arithmetic_is_refused(jumping):
    with pytest.raises(RatfitError, match="no ball arithmetic for"):
        ball_function(jumping, [x])


def test_a_symbol_without_a_value_is_refused():
    with pytest.raises(RatfitError, match="b has no value"):
        ball_function(x + b, [x])


@pytest.mark.parametrize(
    ("expression", "place"),
    [
        (1 / x, arb(0, 1)), (sp.log(x), arb(-1)), (sp.sqrt(x), arb(-1)), (sp.sqrt(x), arb(0, 1)), (sp.asin(x), arb(2)),
        (sp.cbrt(x), arb(-8)), (sp.loggamma(x), arb(-0.5)), (sp.acosh(x), arb(0)), (sp.atan2(0 * x, x), arb(-1)),
    ],
    ids=str,
)  # fmt: skip
def test_what_may_be_undefined_has_no_finite_ball(expression, place):
    if expression == sp.atan2(0, x):
        expression = sp.atan2(x + 1, x)
    assert not ball_function(expression, [x])([place]).is_finite()


# --- integrals

INTEGRALS = [  # integrand, low, high, closed form; b is 2
    (1 / (1 + b * x), 0, 1, sp.log(3) / 2),
    (x / (b + x**2) ** 2, 0, 1, R(1, 12)),
    (sp.Integer(3), 0, 2, sp.Integer(6)),
    (sp.cos(x), 0, sp.pi / 2, sp.S.One),
    (sp.exp(-b * x), -1, 1, sp.sinh(2)),
    (sp.Abs(x - R(1, 3)), 0, 1, R(5, 18)),
    (sp.sqrt(x), 0, 1, R(2, 3)),
    (1 / sp.sqrt(x), 0, 1, sp.Integer(2)),
    (1 / sp.sqrt(1 - x**2), -1, 1, sp.pi),
    (sp.sqrt(x * (1 - x)), 0, 1, sp.pi / 8),
    (x ** R(-1, 3) * (1 - x) ** R(-2, 3), 0, 1, 2 * sp.pi / sp.sqrt(3)),
    (sp.log(x), 0, 1, sp.Integer(-1)),
    (sp.sqrt(x) * sp.log(x) ** 2, 0, 1, R(16, 27)),
    (sp.sin(b * x) / x, 0, sp.pi / 4, sp.Si(sp.pi / 2)),
    (1 / (1 + x**2) ** 2, 0, sp.oo, sp.pi / 4),
    (1 / (1 + x**2) ** 2, -sp.oo, sp.oo, sp.pi / 2),
    (1 / (b - 1 + x**2), -sp.oo, 1, 3 * sp.pi / 4),
    ((1 + x**2) ** R(-3, 2), 0, sp.oo, sp.S.One),
    (1 / (sp.sqrt(x) * (1 + x)), 0, sp.oo, sp.pi),
    (sp.exp(-x), 0, sp.oo, sp.S.One),
    (sp.exp(-(x**2)), -sp.oo, sp.oo, sp.sqrt(sp.pi)),
    (x**3 * sp.exp(-b * x) * sp.cos(x), 0, sp.oo, R(-42, 625)),
    (sp.exp(-sp.sqrt(x)), 0, sp.oo, sp.Integer(2)),
    (sp.log(x) * sp.exp(-x), 0, sp.oo, -sp.EulerGamma),
]


@pytest.mark.parametrize(("integrand", "low", "high", "expected"), INTEGRALS, ids=str)
def test_integrals_contain_their_closed_forms(integrand, low, high, expected):
    function = ball_integral(Moment(sp.sympify(integrand), sp.sympify(low), sp.sympify(high)), x, [b])
    found = function([arb(2)])
    assert found.overlaps(ball(expected)) and found.rad() < 1e-55
    assert function([arb(2, 1e-20)]).contains(found)


UNDEFINED = [
    (1 / x, -1, 1), (1 / x, 0, 1), (1 / (x - R(1, 3)) ** 2, 0, 1), (sp.tan(x), 0, 2), (1 / (b - x), 0, 3),
    (x ** R(-3, 2), 0, 1), (1 / (x * sp.log(x)), 0, R(1, 2)), (sp.sqrt(x - R(1, 2)), 0, 1), (sp.cot(x), 0, 1),
    (1 / x, 1, sp.oo), (sp.sqrt(x) / (1 + x**2) ** R(3, 4), 0, sp.oo), (1 / (x**2 * (x - 2)), 1, sp.oo),
    (sp.S.One, 0, sp.oo), (sp.exp(x), 0, sp.oo), (sp.exp((2 - b) * x), 0, sp.oo), (x**-b, 1, sp.oo),
    (sp.exp(-x) / (x - 1), 0, sp.oo), (sp.exp(-x) * sp.cos(sp.sqrt(-b) * x), 0, sp.oo),
]  # fmt: skip


@pytest.mark.parametrize(("integrand", "low", "high"), UNDEFINED, ids=str)
def test_what_diverges_or_is_unknown_has_no_finite_ball(integrand, low, high):
    flint.ctx.dps = 20
    try:
        found = ball_integral(Moment(sp.sympify(integrand), sp.sympify(low), sp.sympify(high)), x, [b])([arb(2)])
    except RatfitError as refusal:
        assert "x = " in str(refusal) or "no bound of" in str(refusal)
    else:
        assert not found.is_finite()


@settings(max_examples=15, deadline=None)
@given(st.lists(st.integers(-5, 5), min_size=1, max_size=5), st.integers(1, 9), st.fractions(-3, 3, max_denominator=9))
def test_integrals_of_fractions_agree_with_their_antiderivative(coefficients, shift, low):
    """(P/(x**2 + shift))' integrates to its difference, whatever P is."""
    antiderivative = sp.Poly(coefficients, x).as_expr() / (x**2 + shift)
    ends = R(low.numerator, low.denominator), R(low.numerator, low.denominator) + 1
    low_ball, high_ball = (arb(flint.fmpq(int(v.p), int(v.q))) for v in (antiderivative.subs(x, e) for e in ends))
    found = ball_integral(Moment(sp.diff(antiderivative, x), *ends), x, [])([])
    assert (high_ball - low_ball - found).contains(0) and found.rad() < 1e-50


# --- polish and certificate


def system(unknowns, *parts):
    return Residuals(x, unknowns, tuple(Residual(sp.sympify(plain), tuple(moments)) for plain, *moments in parts))


def integral(integrand, low=0, high=1):
    return Moment(sp.sympify(integrand), sp.sympify(low), sp.sympify(high))


FRACTION = (1 + a * x) / (1 + b * x + c * x**2)
KNOWN = FRACTION.xreplace({a: R(1, 2), b: sp.S.One, c: R(1, 3)})

SIMPLE = [  # residuals, a start in floats, the root
    (system((b,), [b**2 - 2]), [1.414213562], [sp.sqrt(2)]),
    (system((b,), [sp.exp(b) - 3]), [1.0986], [sp.log(3)]),
    (system((a, b), [a**2 + b**2 - 1], [a - b]), [0.7071, 0.7071], [sp.sqrt(2) / 2] * 2),
    (system((a, b), [a * b - 6], [a - 10**6 * b]), [2449.489742, 0.002449489], [sp.sqrt(6) * 1000, sp.sqrt(6) / 1000]),
    (system((b,), [b**3 - b]), [1e-7], [sp.S.Zero]),
    (system((b,), [-sp.log(3) / 2, integral(1 / (1 + b * x))]), [2.0000003], [sp.Integer(2)]),
    (system((b,), [-sp.pi, integral(1 / (1 + b * x**2), -sp.oo, sp.oo)]), [1.0000001], [sp.S.One]),
    (system((b,), [-1, integral(sp.exp(-b * x), 0, sp.oo)]), [1.0000001], [sp.S.One]),
    (
        system((a, b, c), [FRACTION.subs(x, 1) - KNOWN.subs(x, 1)], [0, integral(FRACTION), integral(-KNOWN)],
               [0, integral(x * FRACTION), integral(-x * KNOWN)]),
        [0.5 + 1e-13, 1 - 3e-13, 0.3333333333333], [R(1, 2), sp.S.One, R(1, 3)],
    ),
]  # fmt: skip


@pytest.mark.parametrize(("residuals", "start", "root"), SIMPLE)
def test_simple_roots_are_polished_and_proved(residuals, start, root):
    found = polished(residuals, start)
    assert found is not None and all(value.is_exact() for value in found)
    assert all(abs(value - ball(exact)) < 1e-55 * (1 + abs(value)) for value, exact in zip(found, root, strict=True))
    proof = certificate(residuals, found)
    assert proof.radius is not None and float(proof.radius) < 1e-47 * max(1, *map(float, found), 1)
    assert "exactly one root" in proof.reason and "not proved" not in proof.reason


@pytest.mark.parametrize("digits", [20, 60, 90])
def test_residuals_are_as_small_as_asked(digits):
    found = polished(system((b,), [-sp.log(3) / 2, integral(1 / (1 + b * x))]), [2 + 1e-12], digits)
    with flint.ctx.workdps(digits + 20):
        assert abs((1 + 2 * found[0]).log() - (1 + 2 * arb(2)).log()) < arb(10) ** -(digits - 5)


REFUSED = [  # residuals, a point, why not
    (system((b,), [(b - 1) ** 2]), [1.0], "singular"),
    (system((b,), [(b - 1) ** 2]), [1 + 1e-9], "not near enough"),
    (system((b,), [b**2 - 2]), [1.4], "not near enough"),
    (system((b,), [b**2 + 1]), [0.25], "not near enough"),
    (system((a, b), [a + b - 2], [2 * a + 2 * b - 4]), [1.0, 1.0], "singular"),
    (system((a, b), [a + b - 2]), [1.0, 1.0], "fewer residuals"),
    (system((b,), [sp.Max(b, 0) - 2]), [2.0], "no ball arithmetic for Max"),
    (system((b,), [sp.Abs(b) - 2]), [2.0], "no ball arithmetic for"),
    (system((b,), [a * b - 2]), [2.0], "a has no value"),
    (system((b,), [b - 2], [b**2 - 4 + R(1, 10**30)]), [2.0], "no common root"),
    (system((b,), [-1, integral(1 / (b * x), 0, 1)]), [2.0], "no finite ball"),
    (system((b,), [sp.log(b)]), [-1.0], "no finite ball"),
]


@pytest.mark.parametrize(("residuals", "point", "reason"), REFUSED)
def test_what_is_not_proved_is_not_claimed(residuals, point, reason):
    proof = certificate(residuals, [arb(value) for value in point])
    assert proof.radius is None and reason in proof.reason


def test_a_near_double_root_is_two_roots_or_none():
    """(b - 1)**2 = e has the roots 1 ± sqrt(e): a box around one proves for e > 0, never for e <= 0."""
    for e, proved in ((R(1, 10**20), True), (sp.S.Zero, False), (-R(1, 10**90), False)):
        centre = arb(1) + arb(10) ** -10 if proved else arb(1) + arb(10) ** -30
        assert (certificate(system((b,), [(b - 1) ** 2 - e]), [centre]).radius is not None) == proved


def test_more_residuals_than_unknowns_prove_a_square_part():
    residuals = system((b,), [b**2 - 2], [b**4 - 4], [-sp.log(3) + sp.log(1 + b**2)])
    found = polished(residuals, [1.41421356])
    assert abs(found[0] - arb(2).sqrt()) < 1e-55
    proof = certificate(residuals, found)
    assert proof.radius is not None and "not proved" in proof.reason


NOT_POLISHED = [
    (system((b,), [b**2 - 2]), [1.3]), (system((b,), [b**2 + 1]), [0.1]), (system((b,), [(b - 1) ** 2]), [1.0001]),
    (system((b,), [b**2 - 2], [b**3 - 3]), [1.43]), (system((a, b), [a + b]), [0.0, 0.0]),
    (system((b,), [b - 1]), [float("nan")]), (system((b,), [-1, integral(1 / (b * x))]), [1.0]),
]  # fmt: skip


@pytest.mark.parametrize(("residuals", "start"), NOT_POLISHED)
def test_what_does_not_converge_nearby_is_none(residuals, start):
    assert polished(residuals, start) is None


def test_mpmath_polishes_where_there_are_no_balls():
    residuals = system((b,), [sp.Max(b, 1) - 5, integral(x ** sp.Max(b - 1, 0) * b * 3)])
    assert abs(polished(residuals, [2.0000001])[0] - 2) < 1e-50


def test_parameters_need_values():
    with pytest.raises(RatfitError, match=r"give a with Residuals\.at"):
        polished(system((b,), [a * b - 2]), [1.0])
    assert polished(system((b,), [a * b - 2]).at({a: sp.Integer(2)}), [1.0])[0] == 1


@settings(max_examples=15, deadline=None)
@given(st.lists(st.integers(-20, 20), min_size=3, max_size=3, unique=True), st.floats(-1e-9, 1e-9))
def test_simple_roots_of_polynomials_are_always_proved(roots, shift):
    residuals = system((b,), [sp.expand(sp.prod([3 * b - root for root in roots]))])
    found = polished(residuals, [roots[0] / 3 + shift])
    assert abs(3 * found[0] - roots[0]) < 1e-55
    assert certificate(residuals, found).radius is not None


# --- recognition

CLOSED = [  # a number, the constants of its problem
    (sp.S.Zero, []), (sp.Integer(-7), []), (R(1, 3), []), (R(-12345, 6789), [sp.pi]), (sp.sqrt(2) - 1, []),
    ((1 + sp.sqrt(5)) / 2, [sp.pi]), (R(2, 7) - 3 * sp.sqrt(13) / 5, []), (sp.pi / 4 + 1, [sp.pi]),
    (2 * sp.sqrt(sp.pi), [sp.pi]), (-sp.sqrt(sp.pi) / 7, [sp.pi, sp.sqrt(2)]), (sp.log(3) / 2, [sp.log(3)]),
    (sp.sqrt(2) * sp.pi / 3 - 2, [sp.pi, sp.sqrt(2)]), (sp.E**2 / 5 - sp.pi**2, [sp.pi, sp.E]),
    ((3 + sp.pi) / (5 - 2 * sp.pi), [sp.pi]), (sp.pi / 3, [sp.pi, 2 * sp.pi]),
]  # fmt: skip


def digits(expression):
    return mpmath.mpf(sp.Float(sp.N(expression, 50), 50)._mpf_)


@pytest.mark.parametrize(("number", "constants"), CLOSED, ids=str)
def test_closed_forms_are_recognised(number, constants):
    (found,) = recognised([digits(number)], constants)
    assert sp.simplify(found - number) == 0


def test_all_numbers_or_none_and_balls_are_read_by_their_midpoints():
    third = arb(1) / 3
    assert recognised([third, digits(sp.sqrt(2))], []) == [R(1, 3), sp.sqrt(2)]
    assert recognised([third, digits(sp.sin(1))], []) is None


@pytest.mark.parametrize("seed", range(4))
def test_random_numbers_are_not_recognised(seed):
    number = mpmath.mpf(random.Random(seed).getrandbits(200)) / 2**198
    assert recognised([number], [sp.pi, sp.sqrt(2)] if seed % 2 else []) is None
