"""Limits, integrals, differential equations, structure, many starts: each answer worked out by hand."""

from __future__ import annotations

import math
import time
from itertools import pairwise

import mpmath
import pytest
import scipy.integrate
import scipy.optimize
import sympy as sp

import ratfit as rf
from ratfit._diagnosis import explained
from ratfit._generators import far_turns
from ratfit._inline import Words, problem_of_words
from ratfit._solver.nonlinear import search, tabulated

HALF = sp.Rational(1, 2)


def fit_of(target: str, on: str, form: str | None = None, *, route: str = "auto", **stated) -> rf.Fit:
    return rf.derive(
        problem_of_words(target, Words(on=tuple(on.split()), form=form, **stated)), route=route, timeout=30
    )


def same(found: sp.Expr, expected: str) -> bool:
    """Symbolically, with symbols matched by name."""
    names = {s.name: s for s in found.free_symbols}
    return sp.simplify(found - sp.sympify(expected, locals=names)) == 0


# name -> (target, domain, form, what is stated), route, answer
ANSWERS = {
    "asymptote": (
        (
            "1 - exp(-k*x)",
            "0 oo",
            "1/1",
            {"value": ["0"], "derivative": ["0"], "limit": ["oo"], "parameter": ["k=1:9"]},
        ),
        "linear",
        "k*x/(1 + k*x)",
    ),
    "oblique asymptote": (
        ("sqrt(1 + x**2)", "0 oo", "2/1", {"value": ["0"], "derivative": ["0"], "limit": ["oo;minus=x"]}),
        "linear",
        "(x**2 + x + 1)/(x + 1)",
    ),
    "two terms of an asymptote": (
        ("x", "0 oo", "1/1", {"value": ["0;equals=2"], "limit": ["oo;equals=1", "oo;scale=x;minus=1;equals=3"]}),
        "linear",
        "(x + 6)/(x + 3)",
    ),
    "a limit that lowers the degree": (
        ("x", "-1 1", "1/2", {"value": ["0;equals=1", "1;equals=1/2"], "limit": ["oo;equals=2"]}),
        "linear",
        "(3 - 2*x)/(3 - x)",
    ),
    "limit at minus infinity": (
        ("x", "-oo 0", "1/1", {"value": ["0;equals=0", "-1;equals=1"], "limit": ["-oo;equals=2"]}),
        "linear",
        "2*x/(x - 1)",
    ),
    "residue": (
        ("x", "0 1", "1/1", {"value": ["0;equals=1"], "limit": ["1;scale=x-1;equals=2"]}),
        "linear",
        "(1 - 3*x)/(1 - x)",
    ),
    "residue of the target's own pole": (
        ("1/sin(x)", "0 1", "1/1", {"limit": ["0;scale=x", "0;minus=1/x"]}),
        "linear",
        "1/x",
    ),
    "growth like a root": (
        ("x", "0 1", "1", {"factor": "sqrt(x)", "limit": ["0;scale=1/sqrt(x);equals=2"], "value": ["1;equals=5"]}),
        "linear",
        "sqrt(x)*(2 + 3*x)",
    ),
    "pole of third order as a factor": (
        ("x", "1 3", "1", {"factor": "1/(x-1)**3", "limit": ["1;scale=(x-1)**3;equals=2"], "value": ["2;equals=5"]}),
        "linear",
        "(3*x - 1)/(x - 1)**3",
    ),
    "differential equation of a polynomial": (
        ("x", "0 1", "3", {"value": ["0;equals=1"], "equation": ["y' - y;at=0;order=2"]}),
        "linear",
        "1 + x + x**2/2 + x**3/6",
    ),
    "equation with the variable in it": (
        ("x", "0 2", "2", {"value": ["1;equals=3"], "equation": ["x*y' - 2*y;at=1;order=1"]}),
        "linear",
        "3*x**2",
    ),
    "nonlinear equation, known start": (
        ("tanh(x)", "0 oo", "2/2", {"value": ["0"], "equation": ["y' - 1 + y**2;at=0;order=2"], "limit": ["oo"]}),
        "linear",
        "x*(x + 3)/(x**2 + x + 3)",
    ),
    "logistic": (
        (
            "x",
            "0 oo",
            "1/1",
            {"value": ["0;equals=1/2"], "equation": ["y' - y*(1 - y);at=0"], "limit": ["oo;equals=1"]},
        ),
        "linear",
        "(1 + x)/(2 + x)",
    ),
    "equation where nothing is known": (
        ("x", "0 1", "1/1", {"value": ["0;equals=1"], "equation": ["y' - y;at=1;order=1"]}),
        "polynomial",
        "3*(x + 1)/(3 - x)",
    ),
    "integral over a fixed denominator": (
        ("x", "0 1", "a/(1+x) + b", {"unknowns": "a,b", "value": ["0;equals=2"], "integral": ["equals=1+log(2)"]}),
        "linear",
        "1/(1 + x) + 1",
    ),
    "total and mean on a half line": (
        (
            "x",
            "0 oo",
            "a/(1+x)**3 + b/(1+x)**4",
            {"unknowns": "a,b", "integral": ["equals=1", "weight=x;equals=2"]},
        ),
        "linear",
        "6*x/(1 + x)**4",
    ),
    "three moments": (
        ("x", "0 1", "2", {"integral": ["equals=1", "weight=x;equals=1/2", "weight=x**2;equals=1/3"]}),
        "linear",
        "1",
    ),
    "a logarithm for an integral": (
        ("x", "0 1", "0/1", {"value": ["0;equals=1"], "integral": ["equals=log(3)/2"]}),
        "nonlinear",
        "1/(1 + 2*x)",
    ),
    "the same along a parameter": (
        ("x", "0 1", "0/1", {"value": ["0;equals=1"], "integral": ["equals=log(1+m)/m"], "parameter": ["m=1/2:2"]}),
        "nonlinear",
        "1/(1 + m*x)",
    ),
    "a kink in the weight": (
        ("x", "0 1", "0/1", {"value": ["0;equals=1"], "integral": ["weight=Abs(x-1/2);equals=log(2)-log(3)/2"]}),
        "nonlinear",
        "1/(1 + 2*x)",
    ),
    "a root": (
        ("x", "0 1", "sqrt(a*x+b)", {"unknowns": "a,b", "value": ["0;equals=1", "1;equals=2"]}),
        "nonlinear",
        "sqrt(3*x + 1)",
    ),
    "a power with an integral": (
        ("x", "0 1", None, {"power": "x", "value": ["0;equals=1", "1;equals=2"], "integral": ["equals=6/5"]}),
        "nonlinear",
        "x**4 + 1",
    ),
    "shared coefficients": (
        ("x", "0 1", "(a*x+b)/(b*x+a)", {"unknowns": "a,b", "value": ["0;equals=2"]}),
        "linear",
        "(x + 2)/(2*x + 1)",
    ),
    "odd by parity": (
        ("x", "0 oo", "1/2", {"parity": "odd", "derivative": ["0;equals=2"], "limit": ["oo;scale=x;equals=1"]}),
        "linear",
        "2*x/(1 + 2*x**2)",
    ),
}


@pytest.mark.parametrize("name", ANSWERS)
def test_answer(name):
    (target, on, form, stated), route, expected = ANSWERS[name]
    fit = fit_of(target, on, form, **stated)
    assert fit.route == route and any(same(c.expression, expected) for c in fit.candidates), fit
    assert all(c.holds for c in fit.conditions)


def test_an_exponential_of_a_fraction_is_found_exactly():
    """exp((a + b*x)/(1 + c*x)) with f(0) = 1, f'(0) = 1, f(1) = 2: a = 0, b = 1, 1 + c = 1/log(2)."""
    words = {"unknowns": "a,b,c", "value": ["0;equals=1", "1;equals=2"], "derivative": ["0;equals=1"]}
    fit = fit_of("x", "0 1", "exp((a+b*x)/(1+c*x))", **words)
    assert same(fit.expression, "exp(x/(1 + (1/log(2) - 1)*x))") and not fit.candidates[0].certificate
    through = {"unknowns": "a,b,c", "value": ["0;equals=1", "1/2;equals=3/2", "1;equals=2"]}
    exact = fit_of("x", "0 1", "exp((a+b*x)/(1+c*x))", **through)
    assert abs(exact(0.5) - 1.5) < 1e-12 and all(c.holds for c in exact.conditions)


def test_an_exponential_of_a_parabola_is_found_to_forty_digits():
    """exp(a + b*x + c*x**2) with total 1, mean 2/5 and second moment 1/5, by mpmath's quadrature."""
    moments = ["equals=1", "weight=x;equals=2/5", "weight=x**2;equals=1/5"]
    fit = fit_of("x", "0 1", "exp(a+b*x+c*x**2)", unknowns="a,b,c", integral=moments)
    x = fit.problem.variable
    with mpmath.workdps(50):
        f = sp.lambdify(x, fit.expression, "mpmath")
        for k, demand in enumerate(("1", "0.4", "0.2")):
            found = mpmath.quad(lambda t, k=k: t**k * f(t), [0, 1])
            assert abs(found - mpmath.mpf(demand)) < 1e-40
    assert "exactly one root" in fit.candidates[0].certificate
    assert all(c.holds and c.residual < 1e-40 for c in fit.conditions)


ROOTS_AT_ZERO = {
    "sqrt(x)": ("sqrt(x)", "0 1", "sqrt(a*x+b)", "sqrt(x)"),
    "cosine": ("cos(x)", "0 pi/2", "sqrt(a*x+b)", "sqrt(1 - 2*x/pi)"),
}


@pytest.mark.parametrize("name", ROOTS_AT_ZERO)
def test_a_root_that_vanishes_at_a_node(name):
    target, on, form, expected = ROOTS_AT_ZERO[name]
    fit = fit_of(target, on, form, unknowns="a,b", value=on.split())
    assert same(fit.expression, expected)


def test_interpolated_coefficients_are_held_to_their_range():
    words = {"value": ["0;equals=1"], "integral": ["equals=1/2+m/10"], "parameter": ["m=1/10:2"]}
    fit = fit_of("x", "0 1", "0/1", **words)
    assert 0 < fit(0.5, m=1.0) < 1
    with pytest.raises(rf.RatfitError, match="outside"):
        fit(0.5, m=3.0)


@pytest.mark.thorough
def test_coefficients_along_a_parameter_hold_at_the_nodes_of_the_table():
    """1/(1 + b*x) with the integral 1/2 + m/10: log(1 + b)/b = 1/2 + m/10."""
    fit = fit_of("x", "0 1", "0/1", value=["0;equals=1"], integral=["equals=1/2+m/10"], parameter=["m=1/10:2"])
    candidate = fit.candidates[0]
    assert len(candidate.table.nodes) == 17 and "interpolated between" in candidate.certificate
    table, x = candidate.table, fit.problem.variable
    (m,) = table.parameters
    for (node,), row in zip(table.nodes[::4], table.rows[::4], strict=True):
        with mpmath.workdps(60):
            wanted = mpmath.mpf(1) / 2 + mpmath.mpf(int(node.p)) / int(node.q) / 10
            b = mpmath.findroot(lambda b, wanted=wanted: mpmath.log(1 + b) / b - wanted, 1)
            there = (table.numerator / table.denominator).subs(dict(zip(table.unknowns, row, strict=True)))
            assert abs(mpmath.mpf(str(sp.N(there.subs(x, HALF), 50))) - 1 / (1 + b / 2)) < 1e-40
            between = sp.N(candidate.expression.subs({m: node, x: HALF}), 50)
            assert abs(mpmath.mpf(str(between)) - 1 / (1 + b / 2)) < 1e-8


def test_a_family_that_is_not_linear_says_how_many_conditions_are_missing():
    fit = fit_of("exp(x)", "0 1", "2/2", value=["0"], integral=["weight=1", "weight=x"])
    assert fit.expression is None and "2 coefficients open" in fit.reasons[0]  # 6 - 1 - 3


def test_what_came_for_free_is_said():
    fit = fit_of("x/(1+x)", "0 1", "1/1", value=["0", "1"], derivative=["0", "1"])
    assert fit.status == "unique" and fit.advice == ("came for free, the other conditions imply it: derivative at 1",)


def test_a_family_is_offered_conditions_that_single_out_one():
    fit = fit_of("sin(x)", "0 pi/2", "2/2", value=["0", "pi/2"], derivative=["0"])
    assert "b1, b2 free" in fit.advice[0]
    assert '--derivative pi/2 --derivative "0;order=2"' in fit.advice[0]
    whole = fit_of("sin(x)", "0 pi/2", "2/2", value=["0", "pi/2"], derivative=["0", "pi/2", "0;order=2"])
    assert whole.status == "unique"  # the advice, taken


@pytest.mark.parametrize("far", ["17/32", "5/2"])
def test_sines_of_places_far_in_parts_are_left_as_they_are(far):
    """In the field the sine of 17/32 is a polynomial of degree 17 in the cosine of 1/32, which nobody can read."""
    places = ["1/2", far]
    fit = fit_of("sin(x)", f"1/2 {far}", "2/1", value=places, derivative=places)
    assert fit.status == "unique" and len(str(fit.expression)) < 1000
    assert fit.expression.atoms(sp.sin) == {sp.sin(sp.sympify(place)) for place in places}
    x = fit.problem.variable
    for place in map(sp.sympify, places):
        assert abs(sp.N(fit.expression.subs(x, place) - sp.sin(place), 60)) < 1e-50
        assert abs(sp.N(fit.expression.diff(x).subs(x, place) - sp.cos(place), 60)) < 1e-50


def test_which_sines_are_taken_apart():
    near, far = sp.sin(HALF), sp.cos(5 * HALF)
    assert far_turns([near * far]) == {near, far}
    assert not far_turns([near, sp.cos(1)]) and not far_turns([sp.sin(sp.pi / 7), sp.cos(5 * sp.pi / 7)])
    assert not far_turns([near, sp.sqrt(1 - far)])  # that root is a sine


def test_what_is_undecided_is_no_clash():
    problem = problem_of_words("x", Words(on=("0", "1"), form="1/1", value=["0", "1"]))
    value = problem.conditions[0]
    undecided = rf.Candidate(sp.Symbol("x"), {}, (rf.Checked(value, sp.S.Zero, None, None),), "it is undecided")
    fit = explained(rf.Fit(problem, "rejected", "linear", rejected=(undecided,)), "linear")
    assert "no clash" in fit.reasons[-1] and "equal" in fit.reasons[-1]


def test_an_unattainable_node_is_named():
    """Through (0, 1), (1, 1) goes no [1/1] but 1, which misses (2, 2)."""
    fit = fit_of("x", "0 2", "1/1", value=["0;equals=1", "1;equals=1", "2;equals=2"])
    assert fit.status == "rejected" and any("unattainable node 2" in reason for reason in fit.reasons)


def test_out_of_time_keeps_what_was_found(monkeypatch):
    chunks = search.search_chunks

    def endless(residuals, **options):
        yield from chunks(residuals, **options)
        while True:
            time.sleep(0.01)

    monkeypatch.setattr(search, "search_chunks", endless)
    words = Words(on=("0", "1"), form="0/1", value=["0;equals=1"], integral=["equals=log(3)/2"])
    fit = rf.derive(problem_of_words("x", words), timeout=4)
    assert fit.status == "timeout" and fit.expression is None
    assert any(same(c.expression, "1/(1 + 2*x)") for c in fit.candidates)
    assert "found so far: 1/(2*x + 1)" in fit.reasons[0]


# target, domain, place, its first three derivatives there: the one-sided ones at an end and within a step
ONE_SIDED = [
    ("floor(x)", "0 3", "3", ["2", "0", "0"]),
    ("floor(x)", "0 3", "3/2", ["1", "0", "0"]),
    ("x*floor(x)", "0 3", "5/2", ["5", "2", "0"]),
    ("x*ceiling(2*x)", "0 1", "0", ["0", "1", "0"]),
    ("x + floor(x**2)", "0 2", "2", ["5", "1", "0"]),
    ("floor(sin(x))", "0 3", "pi/2", ["0", "0", "0"]),
    ("sign(x)", "0 1", "0", ["1", "0", "0"]),
    ("x*Abs(x)", "-1 1", "-1", ["-1", "2", "-2"]),
    ("Max(x, 1 - x)", "0 1", "1", ["1", "1", "0"]),
]


@pytest.mark.parametrize(("target", "on", "at", "expected"), ONE_SIDED)
def test_derivatives_of_steps_and_kinks(target, on, at, expected):
    problem = problem_of_words(target, Words(on=tuple(on.split()), form="0/0", value=["0;equals=1"]))
    found = [problem.target.derivative(sp.sympify(at), order) for order in range(3)]
    assert found == [sp.sympify(value) for value in expected]


# target, the place of a jump or a kink, the order asked for, what differs there
TWO_SIDED = [
    ("floor(x)", "1", "value", "0 from the left and 1"),
    ("floor(x)", "1", "derivative", "value at x = 1 is 0 from the left and 1"),
    ("sign(x - 1)", "1", "derivative", "value at x = 1 is -1 from the left and 1"),
    ("Abs(x - 1)", "1", "derivative", "order 1 at x = 1 is -1 from the left and 1"),
    ("Abs(x - 1)", "1;order=2", "derivative", "order 1 at x = 1 is -1 from the left and 1"),
    ("floor(1/(x - 1)**2)", "1", "derivative", "ever more steps"),
]


@pytest.mark.parametrize(("target", "at", "kind", "said"), TWO_SIDED)
def test_where_a_target_jumps_it_has_no_derivative(target, at, kind, said):
    with pytest.raises(rf.RatfitError, match=said) as caught:
        fit_of(target, "0 3", "2/1", **{kind: [at]})
    assert "equals" in str(caught.value) and "Subs" not in str(caught.value)


BAD = {
    "scale of zero": (("x", "0 1", "1/1", {"limit": ["0;scale=0"]}), "scale of zero"),
    "a limit that is infinite": (("exp(x)", "0 1", "1/1", {"limit": ["oo"], "value": ["0"]}), "not finite"),
    "a limit that does not exist": (("sin(x)", "0 1", "1/1", {"limit": ["oo"], "value": ["0"]}), "does not exist"),
    "two sides differ": (("Abs(x)/x", "-1 1", "1/1", {"limit": ["0"]}), "from the left"),
    "a limit outside": (("x", "0 1", "1/1", {"limit": ["2"]}), "outside"),
    "a limit beyond the support": (("x", "0 oo", "1/1", {"limit": ["oo;equals=1"], "support": ("0", "1")}), "support"),
    "a divergent integral of the target": (("1/x", "0 1", "1/1", {"integral": ["weight=1"]}), "diverges"),
    "a divergent integral of the form": (
        ("x", "0 oo", "1", {"integral": ["weight=1;equals=1"], "value": ["0"]}),
        "diverges",
    ),
    "an unknown function": (("x", "0 1", "1/1", {"equation": ["z' - y;at=0"]}), "not known here"),
    "a derivative beyond the fourth": (("x", "0 1", "1/1", {"equation": ["y''''' - y;at=0"]}), "not known here"),
    "no unknown function": (("x", "0 1", "1/1", {"equation": ["x - 1;at=0"]}), "holds no y"),
    "an equation without a place": (("x", "0 1", "1/1", {"equation": ["y' - 1"]}), "at"),
    "an equation outside": (("x", "0 1", "1/1", {"equation": ["y' - 1;at=3"]}), "outside"),
    "an order that is no number": (("x", "0 1", "1/1", {"equation": ["y' - 1;at=0;order=x"]}), "whole number"),
    "y is taken": (("y", "0 1", "1/1", {"equation": ["y' - 1;at=0"]}), "rename"),
    "a prime elsewhere": (("x'", "0 1", "1/1", {"value": ["0"], "variable": "x"}), "quotes"),
    "an unknown name": (("x", "0 1", "1/1", {"limit": ["0;scale=z"]}), "not declared"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input(name):
    (target, on, form, stated), said = BAD[name]
    with pytest.raises(rf.RatfitError, match=said) as caught:
        fit_of(target, on, form, **stated)
    assert "\n" not in str(caught.value)


def test_conditions_in_python_say_what_they_refuse():
    x = sp.Symbol("x")
    y = sp.Function("y")(x)
    assert rf.Equation(y.diff(x, 2) + y, 0).residual == rf.Equation("y'' + y", 0).residual
    for bad in (
        lambda: rf.Equation(y.diff(x, 5), 0),
        lambda: rf.Equation(y + sp.Function("z")(x), 0),
        lambda: rf.Equation("y' - 1", sp.oo),
        lambda: rf.Equation("y' - 1", 0, order=-1),
        lambda: rf.Limit(sp.I),
        lambda: rf.Limit(0, scale=sp.oo),
        lambda: rf.Limit(0, equals=sp.oo),
    ):
        with pytest.raises(rf.RatfitError):
            bad()


# Forms whose only candidates are no finite real functions on the domain: where, and why.
BROKEN = {
    "a radicand below zero": (
        ("sqrt(a+b*x+c*x**2)", "a,b,c", {"value": ["0;equals=1", "1;equals=1"], "derivative": ["0;equals=-3"]}),
        "must be not negative",
    ),
    "a negative power": (("(1+b*x)**c", "b,c", {"derivative": ["0;equals=3", "0;order=2;equals=12"]}), "pole at x = 1"),
    "an essential singularity": (
        ("exp((a+b*x)/(1+c*x))", "a,b,c", {"value": ["0;equals=1", "1;equals=2"], "derivative": ["0;equals=-1"]}),
        "pole at x = 0.409",
    ),
    "the logarithm of zero": (
        ("log((x-a)**2) + b", "a,b", {"value": ["0;equals=1", "1;equals=1"]}),
        "must be positive",
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_is_no_function_on_the_domain_is_rejected(name):
    (form, unknowns, stated), said = BROKEN[name]
    fit = fit_of("x", "0 1", form, unknowns=unknowns, **stated)
    assert fit.expression is None and said in " ".join(fit.reasons)


def test_an_inner_variable_brings_its_pole_along():
    fit = fit_of("x", "0 1", "1/0", of="1/(x-1/3)", value=["1/2;equals=-2", "1;equals=1"])
    assert fit.expression is None and "pole at x = 0.333" in fit.reasons[0]


@pytest.mark.thorough
def test_coefficients_that_interpolation_cannot_follow_are_no_answer(monkeypatch):
    """a*x + exp(a)*x**2 with the value sin(k) at 1: eight turns within the range of k."""
    monkeypatch.setattr(tabulated, "GRIDS", (17,))  # more nodes would do no better here, and take their time
    words = {"unknowns": "a", "value": ["1;equals=sin(k)"], "parameter": ["k=0:50"]}
    fit = fit_of("x", "0 1", "a*x+exp(a)*x**2", **words)
    assert fit.expression is None
    assert not fit.rejected or "too little" in fit.rejected[0].reason


def test_ever_more_roots_end_with_the_plainest():
    fit = fit_of("x", "0 1", "sin(a*x)", unknowns="a", value=["1;equals=1/2"])
    assert fit.status == "several" and len(fit.candidates) <= 24
    assert same(fit.expression, "sin(pi*x/6)") or abs(sp.N(fit.expression.subs(fit.problem.variable, HALF))) < 0.3


def test_a_double_root_that_is_plain_is_found():
    """a*exp(-b*x) with total 1 and the target's value at 1: b*exp(-b) = exp(-1), of which b = 1 is a double root."""
    fit = fit_of("exp(-x)", "0 oo", "a*exp(-b*x)", unknowns="a,b", integral=["weight=1"], value=["1"])
    assert any(same(c.expression, "exp(-x)") for c in fit.candidates)


def test_incomplete_data_whose_answers_are_of_lower_degree():
    """No [2/1] but a line has a second derivative that vanishes: the answers are in the form [1/0]."""
    fit = fit_of("1-x", "0 2", "2/1", derivative=["0;order=2;equals=0"], value=["1;equals=0"])
    assert fit.status == "family"
    x = fit.problem.variable
    assert sp.diff(fit.expression, x, 2) == 0 and fit.expression.subs(x, 1) == 0


def test_equations_of_a_polynomial_where_nothing_is_known():
    """y = 1 and y = -1 among others; 1 + (1 - 2c)*x + c*x**2 with c = 1 +- 1/sqrt(2)."""
    lines = fit_of("x", "0 2", "1/0", equation=["y' - 1 + y**2;at=1", "y' - 1 + y**2;at=2"])
    assert {"1", "-1"} <= {str(c.expression) for c in lines.candidates}
    data = {"value": ["0;equals=1", "2;equals=3"], "equation": ["y''*y - 1;at=1"]}
    parabolas = fit_of("x", "0 2", "2/0", **data)
    for c in (1 + 1 / sp.sqrt(2), 1 - 1 / sp.sqrt(2)):
        assert any(same(k.expression, f"1 + (1 - 2*({c}))*x + ({c})*x**2") for k in parabolas.candidates)


def test_an_integral_with_a_real_parameter():
    """sympy loses the logarithm and the arctangent of this one: (m + 2)*(log(2)/2 + 3*pi/4)."""
    fit = fit_of("(m+2)*(x+3)/(x**2+1)", "0 1", "0/0", integral=["weight=1"], parameter=["m=1/2:2"])
    assert same(fit.expression, "(m + 2)*(log(2)/2 + 3*pi/4)")


@pytest.mark.parametrize("weight", ["sign(x-1/3)", "Max(x,1/3)", "floor(3*x)", "Abs(x-1/2)", "Heaviside(x-1/4)"])
def test_weights_that_jump_or_bend(weight):
    """A parabola with the values of the sine at both ends and one weighted integral, which scipy finds too."""
    fit = fit_of("sin(x)", "0 1", "2", value=["0", "1"], integral=[f"weight={weight}"])
    x = fit.problem.variable
    function = fit.problem.conditions[-1].weight
    at = [0, 0.25, 1 / 3, 0.5, 2 / 3, 1]
    found, true = (
        sum(scipy.integrate.quad(sp.lambdify(x, function * f, "math"), a, b)[0] for a, b in pairwise(at))
        for f in (fit.expression, sp.sin(x))
    )
    assert fit.status == "unique" and abs(found - true) < 1e-9


BOTH_SIDES = {
    "scale": ("1/x", "0/1", {"limit": ["0;scale=Abs(x);equals=1"], "value": ["1"]}),
    "factor": ("x", "1/1", {"factor": "sign(x)", "limit": ["0;equals=1"], "value": ["1"]}),
}


@pytest.mark.parametrize("name", BOTH_SIDES)
def test_a_limit_inside_the_domain_has_two_sides(name):
    target, form, stated = BOTH_SIDES[name]
    assert fit_of(target, "-1 1", form, **stated).expression is None


def test_limits_five_orders_down():
    """x - x**3/6 + x**5/120 asked for by limits: the Pade approximant of the sine."""
    limits = ["0;scale=1/x", "0;scale=1/x**3;minus=x", "0;scale=1/x**5;minus=x-x**3/6"]
    fit = fit_of("sin(x)", "-1 1", "3/2", limit=limits)
    assert same(fit.expression, "(60*x - 7*x**3)/(60 + 3*x**2)") and len(fit.advice) == 1


FORMS_WITH_LIMITS = {
    "a saturating exponential": (
        ("tanh(2*x)", "0 4", "a*(1-exp(-b*x))", {"unknowns": "a,b", "derivative": ["0"], "limit": ["oo"]}),
        "1 - exp(-2*x)",
    ),
    "a root that grows like a line": (
        (
            *("x", "0 1", "sqrt(a*x**2+b*x+1)"),
            {"unknowns": "a,b", "limit": ["oo;scale=1/x;equals=2"], "value": ["1;equals=3"]},
        ),
        "sqrt(4*x**2 + 4*x + 1)",
    ),
    "a condition that the form keeps by itself": (
        ("tanh(x)", "0 1", "a*tanh(b*x)", {"unknowns": "a,b", "value": ["0", "1"], "derivative": ["0"]}),
        "tanh(x)",
    ),
}


@pytest.mark.parametrize("name", FORMS_WITH_LIMITS)
def test_forms_that_are_no_fractions(name):
    (target, on, form, stated), expected = FORMS_WITH_LIMITS[name]
    assert any(same(c.expression, expected) for c in fit_of(target, on, form, **stated).candidates)


def test_a_condition_that_no_member_of_the_form_can_keep():
    stated = {"unknowns": "a,b", "value": ["0;equals=1", "1"], "derivative": ["0"]}
    fit = fit_of("tanh(x)", "0 1", "a*tanh(b*x)", **stated)
    assert fit.expression is None and "no member of this form keeps the value at 0" in fit.reasons[0]


@pytest.mark.thorough
def test_two_parameters_make_a_table_of_two():
    """q/(1 + b*x) with the integral p: q*log(1 + b)/b = p."""
    words = {"unknowns": "a,b", "value": ["0;equals=q"], "integral": ["equals=p"]}
    fit = fit_of("x", "0 1", "a/(1+b*x)", parameter=["p=1:1.2", "q=1.5:2"], **words)
    assert len(fit.candidates[0].table.nodes) == 81
    b = scipy.optimize.brentq(lambda b: 1.7 * math.log1p(b) / b - 1.1, 0.1, 5)
    assert abs(fit(0.5, p=1.1, q=1.7) - 1.7 / (1 + b / 2)) < 1e-8
