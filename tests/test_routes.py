"""The routes: problem -> answer, each answer worked out by hand; random fractions come back from their own data."""

from __future__ import annotations

import pytest
import sympy as sp
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import ratfit as rf
from ratfit._inline import Words, problem_of_words
from ratfit._parse import RatfitError

PLACES = [sp.Rational(2, 7), sp.Rational(5, 9), sp.Rational(9, 11), sp.Rational(1, 17)]
NAMES = {"m": sp.Rational(3, 11), "f": sp.Rational(2, 13), "n": sp.Rational(23, 7), "a": sp.Rational(4, 9)}
TIMEOUT = 20


def words(target: str, on: str, form: str | None = None, **stated):
    return problem_of_words(target, Words(on=tuple(on.split()), form=form, **stated))


def free_of(expression: sp.Expr) -> sp.Expr:
    """The expression with every name but the variable given a number by its name, whatever its assumptions."""
    return expression.subs({s: NAMES[s.name] for s in expression.free_symbols if s.name in NAMES})


def same_function(found: sp.Expr, expected: sp.Expr) -> bool:
    """By high-precision evaluation at places that no condition names."""
    variables = {s.name: s for s in found.free_symbols if s.name not in NAMES}
    found, expected = free_of(found), free_of(expected)
    for place in PLACES:
        values = [e.subs(dict.fromkeys(e.free_symbols, place)) for e in (found, expected)]
        if abs(sp.N(values[0] - values[1], 40, maxn=400)) > sp.Rational(1, 10**30):
            return False
    return len(variables) <= 1


def text(expression: str) -> sp.Expr:
    return sp.sympify(expression, locals={"E": sp.E})


# name -> (arguments, status, every accepted expression)
ANSWERS = {
    # the linear route
    "line": (("x", "0 1", "1", {"value": ["0;equals=1", "1;equals=3"]}), "unique", ["1 + 2*x"]),
    "sine, Eq. 12": (
        ("sin(x)", "0 pi/2", "2/1", {"value": ["0", "pi/2"], "derivative": ["0", "pi/2"]}),
        "unique",
        ["x*(x - pi**2/4)/(-pi**2/4 + (pi - pi**2/4)*x)"],
    ),
    "Pade [1/1] of exp": (
        ("exp(x)", "0 1", "1/1", {"value": ["0"], "derivative": ["0", "0;order=2"]}),
        "unique",
        ["(2 + x)/(2 - x)"],
    ),
    "logarithm at 1, sqrt(2), 2": (
        ("log(x)", "1 2", "1/1", {"value": ["1", "sqrt(2)", "2"]}),
        "unique",
        ["(2 + sqrt(2))*log(2)*(x - 1)/(x + sqrt(2))"],
    ),
    "a pole at 0 that the target has": (("1/x", "0 1", "1/1", {"value": ["1", "1/2", "1/3"]}), "unique", ["1/x"]),
    "a node that is a parameter": (
        ("x**2", "0 1", "2", {"value": ["0", "m", "1"], "parameter": ["m=1/5:1/3"]}),
        "unique",
        ["x**2"],
    ),
    "bias": (
        ("x", "0 1", "1/1", {"value": ["0;equals=0", "1;equals=1", "1/2;equals=a"], "parameter": ["a=1/10:9/10"]}),
        "unique",
        ["x/((1/a - 2)*(1 - x) + 1)"],
    ),
    "phong": (
        ("x**n", "0 1", "1/1", {"value": ["0", "1"], "derivative": ["1"], "parameter": ["n=2:9"]}),
        "unique",
        ["x/(n - n*x + x)"],
    ),
    "too high a degree is one function": (
        ("1/(1 + x)", "0 1", "3/3", {"value": ["0", "1", "1/2", "1/3", "1/4"]}),
        "unique",
        ["1/(1 + x)"],
    ),
    "more conditions than unknowns, consistent": (
        ("x", "0 1", "1/1", {"value": [f"{v};equals=(2+{v})/(3+{v})" for v in ("0", "1", "1/2", "pi/4", "sqrt(2)/2")]}),
        "unique",
        ["(2 + x)/(3 + x)"],
    ),
    "the same condition twice": (
        ("x", "0 1", "1/1", {"value": ["0;equals=1", "0;equals=1", "1;equals=3"], "derivative": ["0;equals=1"]}),
        "unique",
        ["(2 + x)/(2 - x)"],
    ),
    "zero": (("0*x", "0 1", "2/1", {"value": ["0", "1", "1/2"]}), "unique", ["0"]),
    "odd": (
        ("atan(x)", "0 1", "1/2", {"value": ["1"], "derivative": ["0"], "parity": "odd"}),
        "unique",
        ["x/(1 + (4/pi - 1)*x**2)"],
    ),
    "odd over a pole": (("1/x", "-1 1", "2/1", {"value": ["1", "1/2"], "parity": "odd"}), "unique", ["1/x"]),
    "even": (
        ("cos(x)", "-1 1", "2/2", {"value": ["0"], "derivative": ["0;order=2", "0;order=4"], "parity": "even"}),
        "unique",
        ["(12 - 5*x**2)/(12 + x**2)"],
    ),
    "factor 1/x": (
        ("1/x + 1", "0 1", "1", {"value": ["1"], "derivative": ["1"], "factor": "1/x"}),
        "unique",
        ["1 + 1/x"],
    ),
    "factor x**2 and its own zeros": (
        ("x**2*(1 + x)", "0 1", "1", {"value": ["0", "1"], "derivative": ["0", "0;order=2"], "factor": "x**2"}),
        "unique",
        ["x**2*(1 + x)"],
    ),
    "inner variable": (
        ("tanh(x)", "-1 1", "1/1", {"value": ["0", "1", "-1"], "of": "exp(2*x)"}),
        "unique",
        ["(exp(2*x) - 1)/(exp(2*x) + 1)"],
    ),
    "shared coefficient": (
        (
            "v",
            "0 1",
            "v/(v - k*v + k)",
            {"unknowns": "k", "value": ["0;equals=0", "1;equals=1"], "derivative": ["0;equals=5"]},
        ),
        "unique",
        ["5*v/(4*v + 1)"],
    ),
    "a moment": (("x**2", "0 1", "1", {"value": ["0"], "integral": ["weight=x"]}), "unique", ["3*x/4"]),
    "removable 0/0 at the node": (
        ("(exp(x) - 1)/x", "0 1", "1/1", {"value": ["0", "1"], "derivative": ["0"]}),
        "unique",
        ["(1 + ((5/2 - E)/(E - 2) + 1/2)*x)/(1 + (5/2 - E)/(E - 2)*x)"],
    ),
    # the polynomial route
    "curvature without slope": (
        (
            "v",
            "0 1",
            "v/(v - k*v + k)",
            {"unknowns": "k", "value": ["0;equals=0", "1;equals=1"], "derivative": ["0;order=2;equals=-40"]},
        ),
        "unique",  # v*k**-1 - ... : 2*(k - 1)/k**2 = -40 has k = 1/5 and k = -1/4; the second has a pole at 1/5
        ["5*v/(4*v + 1)"],
    ),
    "slopes alone, and a value": (
        ("x", "0 1", "1/1", {"value": ["0;equals=0"], "derivative": ["0;equals=1", "1;equals=1/4"]}),
        "unique",
        ["x/(1 + x)"],
    ),
    "squares": (
        (
            "x",
            "0 1",
            "(a*x + b)**2/(c*x + 1)",
            {"unknowns": "a,b,c", "value": ["0;equals=1", "1;equals=2", "1/2;equals=3/2"]},
        ),
        "unique",  # b = 1, then (a - 1)**2 = 0 and c = 1; b = -1 is the same function
        ["1 + x"],
    ),
    "two real answers": (
        ("x", "0 1", "a**2*x + a*x*(1 - x)", {"unknowns": "a", "value": ["1;equals=2"]}),
        "several",
        ["2*x + sqrt(2)*x*(1 - x)", "2*x - sqrt(2)*x*(1 - x)"],
    ),
    # the power route
    "power, two values": (
        ("x", "0 1", None, {"power": "1 - x", "value": ["1;equals=0", "0;equals=1", "1/2;equals=1/8"]}),
        "unique",
        ["(1 - x)**3"],
    ),
    "power, irrational exponent": (
        ("x", "0 1", None, {"power": "1 - x", "value": ["1;equals=0", "0;equals=1", "1/2;equals=1/3"]}),
        "unique",
        ["(1 - x)**(log(3)/log(2))"],
    ),
    "power, curvature at the zero": (
        (
            "x",
            "0 1",
            None,
            {"power": "1 - x", "value": ["1;equals=0"], "derivative": ["1;order=2;equals=3", "0;equals=-3"]},
        ),
        "unique",
        ["3*(1 - x)**2/2"],
    ),
    "power, falling": (
        ("x", "1/2 1", None, {"power": "2*x - 1", "value": ["1/2;equals=1", "1;equals=0", "3/4;equals=3/4"]}),
        "unique",
        ["1 - (2*x - 1)**2"],
    ),
    # found wrong: see KNOWN_BUGS
    "lost real root": (
        ("x", "0 1", "1/1", {"value": ["1/2;equals=1/3"], "derivative": ["0;equals=1", "1;equals=1/4"]}),
        "unique",  # 1/(1 + b)**2 = 1/4: b = 1 gives x/(1 + x), b = -3 a pole at 1/3
        ["x/(1 + x)"],
    ),
    "three real roots of a cubic": (
        ("x", "0 1", "(a**3 - 3*a)*x + a*x*(1 - x)", {"unknowns": "a", "value": ["1;equals=-1"]}),
        "several",  # a = 2*cos(t) with 2*cos(3*t) = -1
        [f"-x + 2*cos({t}*pi/9)*x*(1 - x)" for t in (2, 4, 8)],
    ),
    "zero on the polynomial route": (
        ("x", "0 1", "1/1", {"value": ["0;equals=0", "1;equals=0"], "derivative": ["0;order=2;equals=0"]}),
        "unique",
        ["0"],
    ),
    "weight with a root": (("x**2", "0 1", "1", {"value": ["0"], "integral": ["weight=sqrt(x)"]}), "unique", ["5*x/7"]),
    "weight that is a cosine": (("x", "0 pi", "1", {"value": ["0"], "integral": ["weight=cos(x)"]}), "unique", ["x"]),
    "integral to infinity": (
        ("exp(-x)", "0 oo", "a/(x + b)**3", {"unknowns": "a,b", "value": ["0"], "integral": ["weight=1"]}),
        "unique",  # a/b**3 = 1 and a/(2*b**2) = 1
        ["8/(x + 2)**3"],
    ),
    "value where the factor has its pole": (
        ("1 + x", "0 1", "2", {"value": ["0", "1"], "derivative": ["0"], "factor": "1/x"}),
        "unique",
        ["1 + x"],
    ),
    "value where the factor has its zero": (
        ("1 + x", "0 1", "1/1", {"value": ["0", "1", "1/2"], "factor": "x"}),
        "unique",  # x*(1 + x)/x
        ["1 + x"],
    ),
    "factor with a pole at the right end": (
        ("x", "0 1", "2", {"value": ["0", "1", "1/2"], "factor": "1/(1 - x)"}),
        "unique",
        ["x"],
    ),
    "nodes of a pentagon": (
        ("x**2", "-1 1", "2", {"value": ["cos(pi/10)", "cos(3*pi/10)", "0"]}),
        "unique",
        ["x**2"],
    ),
    "nodes of a heptagon": (("x**2", "-1 1", "2", {"value": ["cos(pi/7)", "cos(3*pi/7)", "0"]}), "unique", ["x**2"]),
    "nested radicals": (
        (
            "x",
            "0 1",
            "1/1",
            {"value": ["0;equals=sqrt(3 + 2*sqrt(2))", "1/3;equals=1 + sqrt(2)", "1;equals=1 + sqrt(2)"]},
        ),
        "unique",
        ["1 + sqrt(2)"],
    ),
    "power, the values in the other order": (
        ("x", "0 2", None, {"power": "x", "value": ["0;equals=0", "2;equals=8", "1;equals=1"]}),
        "unique",
        ["x**3"],
    ),
    "power, value that is a parameter": (
        (
            "x",
            "0 1",
            None,
            {"power": "1 - x", "value": ["1;equals=0", "0;equals=1", "1/2;equals=m"], "parameter": ["m=1/10:1/2"]},
        ),
        "unique",
        ["(1 - x)**(-log(m)/log(2))"],
    ),
    "forced polynomial route, five conditions": (
        (
            "1/(1 + x + x**2)",
            "0 1",
            "2/2",
            {"value": ["0", "1"], "derivative": ["0", "1", "0;order=2"], "route": "polynomial"},
        ),
        "unique",
        ["1/(1 + x + x**2)"],
    ),
    "a scale that cancels is not free": (
        ("x", "0 1", "a*x/(b*x + c)", {"unknowns": "a,b,c", "value": ["1;equals=1"], "derivative": ["1;equals=1/2"]}),
        "unique",
        ["2*x/(1 + x)"],
    ),
    "a scale that cancels, squared": (
        (
            "x",
            "0 1",
            "a*x/(b*x**2 + c)**2",
            {
                "unknowns": "a,b,c",
                "value": ["1;equals=1"],
                "derivative": ["0;equals=2"],
                "integral": ["equals=sqrt(2)/2"],
            },
        ),
        "unique",  # a = 2*c**2 = (b + c)**2 and b + c = sqrt(2)*c
        ["2*x/(1 + (sqrt(2) - 1)*x**2)**2"],
    ),
}


def rows(table):
    return [pytest.param(*row, id=name) for name, row in table.items()]


def fit_of(arguments):
    target, on, form, stated = arguments
    stated = dict(stated)
    route = stated.pop("route", "auto")
    return rf.derive(words(target, on, form, **stated), route=route, timeout=TIMEOUT)


@pytest.mark.parametrize(("arguments", "status", "expected"), rows(ANSWERS))
def test_answer(arguments, status, expected):
    fit = fit_of(arguments)
    assert (fit.status, len(fit.candidates)) == (status, len(expected)), fit.reasons
    for wanted in map(text, expected):
        assert any(same_function(c.expression, wanted) for c in fit.candidates), fit.candidates
    assert all(checked.holds for c in fit.candidates for checked in c.conditions)


def test_family_of_fractions():
    fit = fit_of(("x", "0 1", "1/1", {"value": ["0", "1"]}))
    assert fit.status == "family" and len(fit.free) == 1
    (free,) = fit.free
    # every [1/1] through (0, 0) and (1, 1) is x*(1 + t)/(1 + t*x): one parameter, the slope at 0
    slope = sp.diff(fit.expression, fit.problem.variable).subs(fit.problem.variable, 0)
    assert slope.has(free)
    for value in (sp.Rational(1, 2), sp.Integer(3)):
        member = fit.expression.subs(free, value)
        assert [member.subs(fit.problem.variable, place) for place in (0, 1)] == [0, 1]


def test_family_of_powers():
    problem = words(
        "x",
        "0 1",
        None,
        power="1 - x",
        value=["1;equals=0", "0;equals=1"],
        derivative=["1;equals=0", "1;order=2;equals=0"],
    )
    fit = rf.derive(problem, timeout=TIMEOUT)
    assert fit.status == "family"
    ((n, (low, high)),) = fit.free.items()
    assert (n.name, low, high) == ("n", 2, sp.oo)
    assert sp.simplify(fit.expression - (1 - problem.variable) ** n) == 0


def test_family_of_powers_above_three():
    problem = words(
        "x",
        "0 1",
        None,
        power="1 - x",
        value=["1;equals=0", "0;equals=1"],
        derivative=["1;equals=0", "1;order=2;equals=0", "1;order=3;equals=0"],
    )
    fit = rf.derive(problem, timeout=TIMEOUT)
    assert [(s.name, r) for s, r in fit.free.items()] == [("n", (3, sp.oo))]


# base, what is chosen: A + B*base**n has a denominator in eta from the target, and one in the base's own scale.
CHOSEN_POWERS = [("1 - x", "4"), ("1 - x", "9/2"), ("1 - x", "5"), ("3 - 3*x", "4"), ("1/2 - x/2", "5/2")]


@pytest.mark.parametrize(("base", "n"), CHOSEN_POWERS)
def test_a_member_of_a_family_of_powers_is_checked_with_its_denominator(base, n):
    x, eta = sp.Symbol("x", nonnegative=True), rf.parameter("eta", "1.3", 3)
    c = sp.sqrt(eta**2 - 1 + x**2)
    fresnel = (((x - c) / (x + c)) ** 2 + ((eta**2 * x - c) / (eta**2 * x + c)) ** 2) / 2
    problem = rf.Problem(
        target=rf.Target(fresnel, x, (0, 1)),
        conditions=[rf.Value(0), rf.Value(1), rf.Derivative(1)],
        form=rf.Power(sp.sympify(base, locals={"x": x}), "n"),
    )
    fit = rf.derive(problem.with_choice({"n": n}), timeout=TIMEOUT)
    head_on = ((eta - 1) / (eta + 1)) ** 2
    assert sp.simplify(fit.chosen - head_on - (1 - head_on) * (1 - x) ** sp.Rational(n)) == 0


def test_an_exponent_may_be_a_symbol():
    assert rf.Power(1 - sp.Symbol("x"), sp.Symbol("k")) == rf.Power(1 - sp.Symbol("x"), "k")


@pytest.mark.parametrize("exponent", [5, 2.5, sp.Integer(5), 2 * sp.Symbol("n"), None, rf.parameter("n", 1, 3)])
def test_an_exponent_that_is_not_open_is_told_where_it_belongs(exponent):
    with pytest.raises(RatfitError, match=r"stands in Form\("):
        rf.Power(1 - sp.Symbol("x"), exponent)


# name -> (arguments, status, words that the reasons must hold)
HONEST_NOES = {
    "contradiction": (("x", "0 1", "1/1", {"value": ["0;equals=1", "0;equals=2"]}), "rejected", "value at 0"),
    "unattainable point": (
        ("x", "0 1", "1/1", {"value": ["0;equals=1", "1/3;equals=1", "1;equals=1", "1/2;equals=2"]}),
        "rejected",
        "value at 1/2",
    ),
    "an integral and another": (
        ("x", "0 1", "1", {"value": ["0"], "integral": ["equals=1", "equals=2"]}),
        "inconsistent",
        "integral",
    ),
    "odd through a value": (("x", "-1 1", "1", {"value": ["0;equals=1"], "parity": "odd"}), "rejected", "value at 0"),
    "only complex": (
        ("x", "0 1", "a**2*x + a*x**2*(1 - x)", {"unknowns": "a", "value": ["1;equals=-1"]}),
        "rejected",
        "complex",
    ),
    "a pole between": (("x", "0 1", "0/1", {"value": ["0;equals=1", "1;equals=-1"]}), "rejected", "pole at x = 0.5"),
    "two powers at once": (
        ("x", "0 1", None, {"power": "1 - x", "value": ["1;equals=0", "0;equals=1"], "derivative": ["1;equals=-2"]}),
        "rejected",
        "value at 0",
    ),
}


@pytest.mark.parametrize(("arguments", "status", "said"), rows(HONEST_NOES))
def test_honest_no(arguments, status, said):
    fit = fit_of(arguments)
    assert fit.status in ("rejected", "inconsistent") and not fit.candidates and fit.expression is None
    assert said in " ".join(fit.reasons), fit.reasons


BAD_INPUT = {
    "equals names the variable": (("x", "0 1", "1", {"value": ["0;equals=x"]}), "equals"),
    "reversed support": (("x", "0 1", "1", {"value": ["0", "1"], "support": ("1", "1/2")}), "support"),
    "a value outside the support": (
        ("x", "0 1", "1", {"value": ["0;equals=1", "1;equals=2"], "support": ("1/2", "1")}),
        "support",
    ),
    "the exponent is the variable": (
        ("x", "0 1", None, {"power": "1 - x;exponent=x", "value": ["1;equals=0", "0;equals=1"]}),
        "exponent",
    ),
    "the exponent is a parameter": (
        (
            "x",
            "0 1",
            None,
            {"power": "1 - x;exponent=m", "value": ["1;equals=0", "0;equals=m"], "parameter": ["m=1:2"]},
        ),
        "m",
    ),
}


def test_a_form_that_no_route_solves_is_an_honest_no():
    fit = fit_of(("x", "0 1", "sqrt(a*x + b)", {"unknowns": "a,b", "value": ["0;equals=1"]}))
    assert not fit.candidates and "one more condition is needed" in fit.reasons[0]


@pytest.mark.parametrize("name", BAD_INPUT)
def test_bad_input_is_refused(name):
    arguments, said = BAD_INPUT[name]
    with pytest.raises(RatfitError, match=said):
        fit_of(arguments)


def test_complex_for_part_of_the_range_is_rejected():
    fit = fit_of(
        (
            "x",
            "0 1",
            "a**2*x + a*x**2*(1 - x)",
            {"unknowns": "a", "value": ["1;equals=m - 1/20"], "parameter": ["m=0:1"]},
        )
    )
    assert not fit.candidates  # a = sqrt(m - 1/20) is not real at m = 0


def test_a_power_of_a_negative_base_is_rejected():
    fit = fit_of(("x", "-1 1", None, {"power": "x", "value": ["0;equals=0", "1;equals=1"]}))
    assert not fit.candidates  # x**n is not real at x = -1 but for whole n


def test_a_pole_for_some_parameters_is_found():
    bump = "1/(1 + 100*(m - 1/5)*(m - 1/2))"  # 1 + c*x with c < -1 for m between the two
    fit = fit_of(
        (
            "x",
            "0 1",
            "a/(1 + b*x)",
            {"unknowns": "a,b", "value": ["0;equals=1", f"1;equals={bump}"], "parameter": ["m=0:1"]},
        )
    )
    assert not fit.candidates


def test_a_choice_that_makes_a_pole_is_refused():
    problem = words("x", "0 1", "1/1", value=["0", "1"]).with_choice({"b1": -2})  # x/(2*x - 1)
    try:
        assert not rf.derive(problem, timeout=TIMEOUT).candidates
    except RatfitError as error:
        assert "pole" in str(error)


@pytest.mark.thorough
def test_forced_polynomial_route_agrees_with_the_linear_one():
    problem = words("exp(x)", "0 1", "2/2", value=["0", "1"], derivative=["0", "1", "0;order=2"])
    linear, polynomial = (rf.derive(problem, route=route, timeout=TIMEOUT) for route in ("linear", "polynomial"))
    assert (linear.status, polynomial.status) == ("unique", "unique"), polynomial.reasons
    assert same_function(linear.expression, polynomial.expression)


def test_a_short_timeout_in_a_long_integral_is_a_timeout():
    problem = words("exp(-x**2)*sin(x)/(1 + x**3)", "0 1", "1", value=["0"], integral=["weight=1"])
    assert rf.derive(problem, timeout=0.5).status == "timeout"


def test_a_kink_of_a_plain_symbol_is_seen():
    x = sp.Symbol("x")
    problem = rf.Problem(
        target=rf.Target(sp.sqrt(x**2), x, (-1, 1)), conditions=[rf.Value(0), rf.Derivative(0)], form=rf.Rational(1, 1)
    )
    with pytest.raises(RatfitError, match="left"):
        rf.derive(problem, timeout=TIMEOUT)


@pytest.mark.thorough
def test_forty_conditions_at_one_node():
    derivatives = ["0", *(f"0;order={k}" for k in range(2, 41))]
    fit = rf.derive(words("exp(x)", "0 1", "20/20", value=["0"], derivative=derivatives), timeout=TIMEOUT)
    assert fit.status == "unique"
    # the classical Pade table: the coefficient of x**i above is (40-i)!/(i! (20-i)!), below with (-1)**i
    k = [sp.factorial(40 - i) / (sp.factorial(i) * sp.factorial(20 - i)) for i in range(21)]
    x = fit.problem.variable
    above, below = (sum(c * (s * x) ** i for i, c in enumerate(k)) for s in (1, -1))
    assert same_function(fit.expression, above / below)


small = st.integers(-4, 4)
nodes = st.lists(
    st.sampled_from([sp.Integer(0), sp.Integer(1), sp.Rational(1, 2), sp.Rational(2, 3), sp.sqrt(2) / 2, sp.pi / 4]),
    min_size=1,
    max_size=3,
    unique=True,
)
X = sp.Symbol("x", real=True)


def polynomial(coefficients) -> sp.Expr:
    return sp.Add(*(c * X**i for i, c in enumerate(coefficients)))


@settings(max_examples=20, deadline=None)
@given(st.lists(small, min_size=1, max_size=3), st.lists(small, max_size=2), nodes, st.data())
def test_a_random_fraction_comes_back_from_full_hermite_data(above, below, places, data):
    numerator, denominator = polynomial(above), polynomial([9, *below])  # 9 + b*x + c*x**2 > 0 on [0, 1]
    degrees = len(above) - 1, len(below)
    conditions, orders = [], dict.fromkeys(places, 0)
    for _ in range(sum(degrees) + 1):
        place = data.draw(st.sampled_from(places))
        order, orders[place] = orders[place], orders[place] + 1
        value = sp.diff(numerator / denominator, X, order).subs(X, place)
        conditions.append(rf.Derivative(place, order, equals=value))
    problem = rf.Problem(variable=X, domain=(0, 1), conditions=conditions, form=rf.Rational(*degrees))
    fit = rf.derive(problem, timeout=TIMEOUT)
    assert (fit.route, fit.status) == ("linear", "unique"), fit.reasons
    assert same_function(fit.expression, numerator / denominator)


@pytest.mark.thorough
@settings(max_examples=10, deadline=None)
@given(small, small, st.integers(-3, 3), st.sampled_from([1, 2]))
def test_a_random_fraction_is_among_the_answers_to_incomplete_data(a0, a1, b1, order):
    """(a0 + a1*x)/(4 + b1*x) from two values and a higher derivative, the orders between left out."""
    assume(4 * a1 != a0 * b1 and b1 != 0)  # else a constant, or no curvature
    fraction = (a0 + a1 * X) / (4 + b1 * X)
    conditions = [
        rf.Value(0, equals=fraction.subs(X, 0)),
        rf.Derivative(0, order + 1, equals=sp.diff(fraction, X, order + 1).subs(X, 0)),
        rf.Value(1, equals=fraction.subs(X, 1)),
    ]
    problem = rf.Problem(variable=X, domain=(0, 1), conditions=conditions, form=rf.Rational(1, 1))
    fit = rf.derive(problem, timeout=TIMEOUT)
    assert fit.status in ("unique", "several"), fit.reasons
    assert any(same_function(c.expression, fraction) for c in fit.candidates)
    for candidate in fit.candidates:
        for condition in conditions:
            found = sp.diff(candidate.expression, X, condition.order).subs(X, condition.at)
            assert abs(sp.N(found - condition.equals, 30)) < sp.Rational(1, 10**20)
