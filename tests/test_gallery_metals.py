"""A metal's Fresnel factor with both parts of its index symbolic, by what it does at both ends."""

from dataclasses import replace
from functools import cache, partial

import mpmath
import pytest
import sympy as sp

import ratfit as rf
from ratfit._solver import plain
from ratfit._solver.naming import named, names_of
from ratfit._solver.squares import without_squares
from ratfit._study.clock import Clock
from ratfit._study.curve import Curve
from ratfit._study.ends import end_facts
from ratfit._study.fact import Study
from ratfit.gallery import card
from ratfit.report.parts import in_parts
from ratfit.report.study import study_text

METALS = [("29/100", "2863/1000"), ("147/50", "299/100"), ("7/10", "8")]


def fresnel_factor(u, index):
    """Snell's law and the two amplitudes of light, s and p, with a complex index."""
    inside = mpmath.sqrt(index**2 - 1 + u * u)
    s, p = (u - inside) / (u + inside), (index**2 * u - inside) / (index**2 * u + inside)
    return (abs(s) ** 2 + abs(p) ** 2) / 2


@cache
def derived(orders_at_0, orders_at_1, form):
    """The fit that keeps so many orders of the Taylor series at either end."""
    problem = card("conductor").problem
    places = [(0, k) for k in range(orders_at_0)] + [(1, k) for k in range(orders_at_1)]
    conditions = tuple(rf.Derivative(at, order) if order else rf.Value(at) for at, order in places)
    return rf.derive(replace(problem, conditions=conditions, form=form, choice={}), timeout=200)


CASES = [
    (2, 1, card("conductor").problem.form),
    (2, 2, rf.Rational(2, 1)),
    pytest.param(3, 2, rf.Rational(2, 2), marks=pytest.mark.thorough),
    pytest.param(3, 3, rf.Rational(3, 2), marks=pytest.mark.thorough),
]


@pytest.mark.parametrize("orders_at_0, orders_at_1, form", CASES)
def test_a_metal_is_derived_with_its_index_symbolic(orders_at_0, orders_at_1, form):
    fit = derived(orders_at_0, orders_at_1, form)
    assert fit.status == "unique" and not fit.rejected and all(c.holds for c in fit.conditions)
    for values in METALS:
        given = dict(zip(sorted(fit.problem.parameters, key=str), map(sp.Rational, values), strict=True))
        function = sp.lambdify(fit.problem.variable, fit.expression.xreplace(given), "mpmath")
        with mpmath.workdps(60):
            index = mpmath.mpc(*(mpmath.mpf(value.p) / value.q for value in given.values()))
            exact = partial(fresnel_factor, index=index)
            for at, orders, side in ((0, orders_at_0, 1), (1, orders_at_1, -1)):
                for order in range(orders):
                    ours, true = (mpmath.diff(f, at, order, direction=side) for f in (function, exact))
                    assert abs(ours - true) < 1e-9 * (1 + abs(true)), (values, at, order)


a, b = (rf.parameter(name, "1/2", 2) for name in "ab")
c = rf.parameter("c", -1, 1)


@pytest.mark.parametrize(
    "given, expected",
    [
        (sp.sqrt(4 * a**2 * b**2 + (a**2 - b**2) ** 2), a**2 + b**2),
        (sp.sqrt(a**2 - b**2 + sp.sqrt(a**4 + 2 * a**2 * b**2 + b**4)), sp.sqrt(2) * a),
        (1 / sp.sqrt(a**3 + 2 * a**2 * b + a * b**2), 1 / (sp.sqrt(a) * (a + b))),
        (sp.sqrt(sp.expand((a + c + 1) ** 2)), sp.sqrt(sp.expand((a + c + 1) ** 2))),  # 3/2 - 1 ... 4: no sign known
        (sp.sqrt(sp.expand((c**2 + 1) ** 2 * c)), (c**2 + 1) * sp.sqrt(c)),
        (sp.sqrt(1 + a**2), sp.sqrt(1 + a**2)),
        (sp.sqrt(2 + sp.sqrt(2)), sp.sqrt(2 + sp.sqrt(2))),
        (sp.exp(sp.sqrt(sp.expand((a + 1) ** 2))), sp.exp(a + 1)),
    ],
)
def test_squares_are_taken_out_of_square_roots(given, expected):
    found = without_squares(given)
    assert sp.simplify(found - expected) == 0 and len(str(found)) <= len(str(given))
    assert len(str(found)) <= len(str(expected)) + 4
    for values in ({a: sp.Rational(2, 3), b: sp.Rational(7, 5), c: sp.Rational(1, 3)},):
        assert abs(sp.N((found - given).xreplace(values), 30)) < 1e-25


def test_a_number_without_squares_stays_as_it_is():
    number = sp.pi / (2 * a) + sp.sqrt(a + 1)
    assert plain(number) is number


def test_names_stand_for_numbers_of_parameters_once_a_number_is_deep():
    deep, flat, bare = sp.sqrt(1 + sp.sqrt(a)), a / (1 + b), sp.sqrt(2)
    meaning = names_of([deep, flat, bare, a, deep], depth=2)
    assert set(meaning.values()) == {deep, flat}
    shown = named([deep, flat, bare, a], meaning)
    assert shown[2:] == (bare, a) and [meaning[name] for name in shown[:2]] == [deep, flat]
    assert names_of([flat, bare, sp.sqrt(a)], depth=2) == {}


def test_a_study_of_metals_has_short_closed_forms_at_both_ends():
    problem = card("conductor").problem
    facts = {}
    for fact in end_facts(Curve(problem.target), Clock(1000)):
        facts[fact.text.partition(" =")[0]] = fact
        if len(facts) == 4:
            break
    assert all(fact.found == "symbolic" for fact in facts.values())
    assert facts["f(0)"].text == "f(0) = 1" and facts["f'(1)"].text == "f'(1) = 0"
    assert len(facts["f(1)"].text) < 80
    text = study_text(Study(problem.target, tuple(facts.values())))
    assert max(map(len, text.splitlines())) < 160 and "where p = sqrt(" in text


@pytest.mark.parametrize(
    "expression",
    [
        card("conductor").problem.target.expression,
        sp.sqrt(a**2 + b**2 + 17) ** 3 + sp.exp(-sp.sqrt(a**2 + b**2 + 17)) + sp.sin(a * b + sp.sqrt(a**2 + b**2 + 17)),
        sum(sp.Symbol(letter) * sp.sqrt(a**5 + b**k + 1234567) for k, letter in enumerate("pqr", 2)) ** 3,
    ],
)
def test_parts_put_together_are_the_whole(expression):
    whole, parts = in_parts(expression, ["u"])
    assert len({name for name, _ in parts} | expression.free_symbols) == len(parts) + len(expression.free_symbols)
    for name, part in reversed(parts):
        whole = whole.subs(name, part)
    assert sp.expand(whole - expression) == 0 and (parts or len(str(expression)) < 121 or "p" in str(expression))


def test_what_is_short_has_no_parts():
    assert in_parts(a + b) == (a + b, ())
