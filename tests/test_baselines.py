"""Peers of a fit: the table on arrays, and each peer against what is known of it by hand or from elsewhere."""

import math
import pickle
from fractions import Fraction

import jax
import jax.numpy as jnp
import mpmath
import numpy as np
import pytest
import scipy.interpolate
import sympy as sp

import ratfit as rf
from ratfit._ball import ball_function
from ratfit._fit import Candidate, Fit
from ratfit._kernel import precision
from ratfit._lower import Entries, Lookup, lower
from ratfit._parse import RatfitError
from ratfit._schedule import schedule
from ratfit._setting import setting
from ratfit.baselines import PEERS, Peer, Unavailable, peers, table_of_equal_error
from ratfit.baselines.approximant import approximant
from ratfit.baselines.original import Original, original_of
from ratfit.baselines.peer import degrees
from ratfit.baselines.polynomial import least_squares
from ratfit.baselines.taylor import taylor
from ratfit.gallery import card
from ratfit.gallery._card import names

x = sp.Symbol("x", real=True)
third = sp.Rational(1, 3)
SQUARES = [float(k * k) for k in range(8)]
TABLE = Lookup(7 * (x - 1) / 2, Entries(SQUARES))  # on [1, 3]


def by_name(fit, parameters=None, reference=None):
    return {each.name: each for each in peers(fit, parameters, reference)}


def made(name, fit, parameters=None):
    return PEERS[name](fit, original_of(setting(fit, parameters)))


def simple(target, domain, form, *places):
    conditions = [rf.Value(place) for place in places]
    return rf.derive(rf.Problem(target=rf.Target(target, x, domain), conditions=conditions, form=form))


@pytest.mark.parametrize("backend", ["numpy", "jax"])
@pytest.mark.parametrize(("dtype", "tolerance"), [("float32", 2e-6), ("float64", 1e-14)])
def test_a_table_interpolates_between_its_entries_and_is_clamped_at_its_ends(backend, dtype, tolerance):
    at = np.array([-math.inf, 0, 1, 1.2, 2, 2.9, 3, 4, math.inf, math.nan])
    expected = np.interp(at, np.linspace(1, 3, 8), SQUARES)
    with precision(dtype):
        function = lower(TABLE, [x], backend)
        found = jax.jit(function)(jnp.asarray(at, dtype)) if backend == "jax" else function(at.astype(dtype))
    assert found.dtype == np.dtype(dtype)
    np.testing.assert_allclose(np.asarray(found, float), expected, rtol=tolerance)


@pytest.mark.parametrize("count", [2, 3, 256])
def test_a_table_has_its_entries_bit_for_bit(count):
    values = [math.sin(k) for k in range(count)]
    function = lower(Lookup(x, Entries(values)), [x])
    assert function(np.arange(count, dtype=float)).tolist() == values
    assert [function(float(k)) for k in range(count)] == values
    assert type(function(0.25)) is float


def test_a_table_is_an_expression_like_any_other():
    assert Lookup(sp.Rational(7, 2), Entries(SQUARES)).evalf() == 12.5  # between 9 and 16
    assert lower(2 * TABLE + x, [x])(2.0) == 27
    assert (TABLE.free_symbols, str(TABLE)) == ({x}, "Lookup(7*x/2 - 7/2, <8 entries>)")
    assert pickle.loads(pickle.dumps(TABLE)) == TABLE != Lookup(7 * (x - 1) / 2, Entries(SQUARES[::-1]))
    found = schedule(3 * TABLE, x, {x: (1, 3)})
    assert (found.cost.as_dict(), found.expression()) == ({"add": 0, "mul": 1, "div": 0, "other": 1}, 3 * TABLE)


@pytest.mark.parametrize(
    "action",
    [
        lambda: Entries([1.0]), lambda: Entries([1.0, math.nan]), lambda: Entries([1.0, math.inf]),
        lambda: TABLE.diff(x), lambda: ball_function(TABLE, [x]),
    ],
)  # fmt: skip
def test_what_a_table_cannot_do_is_said(action):
    with pytest.raises(RatfitError):
        action()


SERIES = [
    ("exp", [Fraction(1, math.factorial(k)) for k in range(5)], (2, 2), [1, "1/2", "1/12"], [1, "-1/2", "1/12"]),
    ("exp, polynomial", [Fraction(1, math.factorial(k)) for k in range(3)], (2, 0), [1, 1, "1/2"], [1]),
    ("log(1 + x)/x", [Fraction((-1) ** k, k + 1) for k in range(3)], (1, 1), [1, "1/6"], [1, "2/3"]),
    ("atan", [0, 1, 0, Fraction(-1, 3), 0, Fraction(1, 5)], (3, 2), [0, 1, 0, "4/15"], [1, 0, "3/5"]),
    ("1/(1 - x), in its block", [1] * 7, (3, 3), [1], [1, -1]),
    ("sin, in its block", [0, 1, 0, Fraction(-1, 6)], (2, 1), [0, 1], [1]),
    ("exp(10**6*x)", [Fraction(10 ** (6 * k), math.factorial(k)) for k in range(3)], (1, 1), [1, 500000], [1, -500000]),
    ("1e-30*exp", [Fraction(1, 10**30 * math.factorial(k)) for k in range(3)], (1, 1), ["1e-30", "5e-31"], [1, "-1/2"]),
]


@pytest.mark.parametrize(
    ("series", "size", "above", "below"), [row[1:] for row in SERIES], ids=[row[0] for row in SERIES]
)
def test_pade_approximants_that_are_known(series, size, above, below):
    found = approximant([Fraction(c) for c in series], *size)
    unit = found[1][0]
    for part, expected in zip(found, (above, below), strict=True):
        assert len(part) == len(expected)
        assert [float(c / unit) for c in part] == pytest.approx([float(Fraction(c)) for c in expected], rel=1e-15)


def test_a_pade_approximant_that_is_zero_is_none():
    assert approximant([Fraction(0), Fraction(0), Fraction(1)], 1, 1) is None


TAYLOR = [
    (sp.exp(x), -1, 1, 0, [1, 1, "1/2", "1/6"]), (1 / (1 + x), 0, 1, 1, ["1/2", "-1/4", "1/8", "-1/16"]),
    (sp.sin(x) / x, 0, 1, 0, [1, 0, "-1/6", 0]), (x**3 - x, 0, 2, 1, [0, 2, 3, 1]),
    (1 + x ** sp.Rational(7, 2), 0, 1, 0, [1, 0, 0, 0]), (sp.sqrt(x), 0, 1, 0, None), (sp.log(x), 0, 1, 0, None),
    (sp.Abs(x - sp.Rational(1, 2)), 0, 1, sp.Rational(1, 2), None), (sp.exp(-1 / x), 0, 1, 0, None),
    (1 / x, 0, 1, 0, None), (sp.floor(3 * x), 0, 1, third, None), (x ** sp.Rational(5, 2), 0, 1, 0, None),
    (x**3, -1, 1, 0, [0, 0, 0, 1]), (sp.exp(-((100 * x) ** 2)), -1, 1, 0, [1, 0, -(10**4), 0]),
]  # fmt: skip


@pytest.mark.parametrize(("target", "low", "high", "at", "expected"), TAYLOR, ids=[str(row[0]) for row in TAYLOR])
def test_taylor_series_by_numbers_are_those_known_or_none(target, low, high, at, expected):
    found = taylor(Original(target, x, float(low), float(high)), sp.Rational(at), 3)
    if expected is None:
        assert found is None
    else:
        assert [float(c) for c in found] == pytest.approx([float(Fraction(c)) for c in expected], rel=1e-15, abs=1e-30)


LEAST_SQUARES = [
    (x**3 - 2 * x + 1, 0, 2, 3, [0, 1, 3, 1]),  # about 1
    (x**2, -1, 1, 1, ["1/2", 0]),  # x**2 = (T0 + T2)/2
    (x**3, -1, 1, 2, [0, "3/4", 0]),  # x**3 = (3*T1 + T3)/4
    (sp.Integer(7), 0, 1, 0, [7]),
]


@pytest.mark.parametrize(("target", "low", "high", "degree", "expected"), LEAST_SQUARES)
def test_least_squares_reproduce_polynomials_and_drop_the_next_chebyshev_polynomial(
    target, low, high, degree, expected
):
    found = least_squares(Original(target, x, float(low), float(high)), degree)
    assert [float(c) for c in found] == pytest.approx([float(Fraction(c)) for c in expected], abs=1e-14)


def test_the_polynomial_costs_no_more_than_the_fit():
    fit = rf.derive("eq19")  # a sum, a product and a division weigh 6: degree 3
    found = made("polynomial", fit, {"m": 0.25})
    assert (sp.degree(found.formula, fit.problem.variable), found.cost.weight) == (3, 6)
    assert "degree 3" in found.about and "3 add, 3 mul" in found.about


RATIONALS = [
    ((1 + 2 * x) / (3 + x), (0, 1), rf.Rational(1, 1), (0, 1, "1/2"), ""),
    (1 / (1 + x**2), (-5, 5), rf.Rational(0, 2), (0, 1, -1), ""),
    (1 / (x - third), (0, 1), rf.Rational(1, 1), (0, 1, "1/4"), "infinite inside the domain, at 0.3333"),
]


@pytest.mark.parametrize(
    ("target", "domain", "form", "places", "told"), RATIONALS, ids=[str(row[0]) for row in RATIONALS]
)
@pytest.mark.parametrize("name", ["aaa", "pade"])
def test_aaa_and_pade_reproduce_fractions_and_tell_their_poles(name, target, domain, form, places, told):
    found = made(name, simple(target, domain, form, *places))
    at = np.linspace(float(domain[0]), float(domain[1]), 1000)
    np.testing.assert_allclose(lower(found.formula, [x])(at), lower(target, [x])(at), rtol=1e-9)
    assert told in found.about and ("infinite" in found.about) == bool(told)


@pytest.mark.filterwarnings("ignore:AAA failed to converge")
def test_aaa_is_scipys():
    fit = rf.derive("eq12")
    original = original_of(setting(fit))
    expected = scipy.interpolate.AAA(original.nodes, original.at_nodes, max_terms=3)(original.places)
    found = made("aaa", fit)
    assert "[2/2]" in found.about
    np.testing.assert_allclose(lower(found.formula, [fit.problem.variable])(original.places), expected, atol=1e-13)


def test_without_aaa_in_scipy_the_reason_names_the_version(monkeypatch):
    monkeypatch.delattr(scipy.interpolate, "AAA")
    found = by_name(simple(sp.sin(x), (0, 1), rf.Rational(1, 1), 0, 1, "1/2"))
    assert isinstance(found["aaa"], Unavailable) and "scipy>=1.15" in found["aaa"].reason
    assert all(isinstance(found[name], Peer) for name in PEERS if name != "aaa")


def test_pade_is_taken_where_the_error_is_smallest():
    found = made("pade", rf.derive("pade-exp"))
    known = (x**2 + 6 * x + 12) / (x**2 - 6 * x + 12)
    for at in (-1, third, 1):
        assert float(found.formula.subs(found.problem.variable, at)) == pytest.approx(
            float(known.subs(x, at)), rel=1e-15
        )
    assert found.about.startswith("[2/2] from the Taylor series at 0;")


def test_a_function_without_a_series_has_no_pade_and_says_so():
    kinks = sp.sqrt(x) + 2 * sp.Abs(x - sp.Rational(1, 2)) + 3 * sp.sqrt(1 - x)
    fit = simple(kinks, (0, 1), rf.Rational(1, 0), 0, 1)
    found = by_name(fit)["pade"]
    assert isinstance(found, Unavailable) and "no Taylor series" in found.reason


def test_a_table_is_exact_for_straight_lines_and_at_its_entries():
    line = made("table", simple(3 * x - 1, (0, 2), rf.Rational(1, 0), 0, 1))
    at = np.linspace(0, 2, 777)
    np.testing.assert_allclose(lower(line.formula, [x])(at), 3 * at - 1, atol=1e-13)
    sine = made("table", rf.derive("eq12")).formula
    (entries,) = sine.atoms(Entries)
    expected = [float(mpmath.sin(mpmath.pi / 2 * k / 255)) for k in range(256)]
    assert entries.values == pytest.approx(expected, abs=2e-16)


def test_the_ends_of_a_table_are_limits_and_never_infinite():
    (smith,) = made("table", rf.derive("eq19"), {"m": 0.25}).formula.atoms(Entries)
    assert (smith.values[0], smith.values[-1]) == (0, pytest.approx(1, abs=1e-12))  # 0/0 in the formula at 1
    root_fit = simple(1 / sp.sqrt(x), (0, 1), rf.Rational(1, 1), 1, "1/4", "1/2")
    (root,) = made("table", root_fit).formula.atoms(Entries)
    assert root.values[0] == pytest.approx(math.sqrt(4 * 255))  # a quarter of the spacing inside
    assert root.values[-1] == 1


def test_the_table_of_equal_error():
    # Linear interpolation of the sine is off by h**2/8: 0.034 with 4 entries, 0.0063 with 8; Eq. 12 by 0.0256.
    assert "8 entries" in table_of_equal_error(rf.derive("eq12")).about
    exact = table_of_equal_error(simple(x**2, (0, 1), rf.Rational(2, 0), 0, 1, "1/2"))
    assert isinstance(exact, Unavailable) and "still off" in exact.reason


def test_a_peer_is_measured_like_a_fit():
    fit = rf.derive("eq12")
    table = made("table", fit)
    found = rf.measure_error(table, samples=20_000).epsilon["peak_max"]
    assert found == pytest.approx((math.pi / 2 / 255) ** 2 / 8, rel=0.03)


def test_no_peer_where_there_is_no_one_function():
    for found in (peers(rf.derive("tanh")), peers(rf.derive("eq19"), {"m": "random"})):
        assert [each.name for each in found] == list(PEERS)
        assert all(isinstance(each, Unavailable) for each in found)
    with pytest.raises(RatfitError, match="reference"):
        peers(rf.derive("eq15"))


DEGREES = [
    (rf.Rational(2, 1), x * (x - 2) / (x + 1), (2, 1)),
    (rf.Rational(1, 1), sp.S.Zero, (0, 0)),
    (rf.Form(sp.sqrt(sp.Symbol("a") * x + sp.Symbol("b")), (sp.Symbol("a"), sp.Symbol("b"))), sp.sqrt(1 + x), (1, 0)),
    (rf.Power(1 - x), (1 - x) ** sp.Rational(9, 2), (1, 1)),
]


@pytest.mark.parametrize(("form", "expression", "expected"), DEGREES)
def test_degrees_are_the_fits_own_or_those_with_as_many_coefficients(form, expression, expected):
    problem = rf.Problem(target=rf.Target(sp.sin(x), x, (0, 1)), conditions=[rf.Value(0)], form=form)
    assert degrees(Fit(problem, "unique", "linear", (Candidate(expression),))) == expected


def as_published(name):
    """The published formula of a card in place of its fit: it need not be derived."""
    about = card(name)
    free = {sp.Symbol(choice, real=True): (sp.S.Zero, sp.oo) for choice in about.problem.choice}
    return Fit(about.problem, "unique", "published", (Candidate(about.published, free),))


def test_a_spike_of_a_ten_thousandth_of_the_domain():
    fit = as_published("beckmann")
    original = original_of(setting(fit, {"m": 0.01}))
    found = by_name(fit, {"m": 0.01})
    errors = {name: original.float32_error(each.formula) for name, each in found.items()}
    assert errors["aaa"] < 1e-3 and errors["pade"] < 1e-2  # though written in t itself both divide by 0 in float32
    assert 0.5 < errors["table"] < 1 and 0.5 < errors["polynomial"] < 1  # they pass it by
    assert "Taylor series at 1;" in found["pade"].about  # where the spike is


# Beckmann stands above, and others have its target; some have no published formula.
CARDS = [name for name in names() if "beckmann" not in name and card(name).printed]
WITHOUT = {"azimuth", "azimuth-as-printed"}  # neither a target nor a reference
INFINITE = {"langevin", "saturation", "smith-1967", "tanh"}


@pytest.mark.parametrize("name", CARDS)
def test_every_card_has_every_peer_or_a_reason(name):
    fit, about = as_published(name), card(name)
    parameters = {key: float(value) for key, value in about.settings[0].items()} if about.settings else {}
    reference = about.problem.references[-1].name if about.problem.target is None and about.problem.references else None
    if name in WITHOUT:
        with pytest.raises(RatfitError, match="no target"):
            peers(fit, parameters)
        return
    found = by_name(fit, parameters, reference)
    assert list(found) == list(PEERS)
    for each in found.values():
        assert isinstance(each, Unavailable) == (name in INFINITE), each
        if isinstance(each, Peer):
            value = lower(each.formula, [fit.problem.variable])(np.linspace(0.01, 0.49, 50, dtype="float32"))
            assert value.dtype == np.float32 and np.all(np.isfinite(value))
