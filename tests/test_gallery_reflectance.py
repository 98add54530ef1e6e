"""Reflectance in the gallery: exact functions are those of `ratfit.brdf`, and fits are as near as their cards note.

Both sides of an equation are typed by hand in forms of their own, the one for calculus, the other for arrays.
"""

from dataclasses import replace
from functools import cache

import mpmath
import numpy as np
import pytest
import sympy as sp

import ratfit as rf
from ratfit._study.clock import Clock
from ratfit._study.crossings import Scans
from ratfit._study.curve import Curve
from ratfit._study.ends import end_facts
from ratfit._study.moments import moment_facts
from ratfit._study.poles import pole_facts
from ratfit.brdf import distribution, fresnel, masking
from ratfit.gallery import card

DIGITS = 40
PLACES = [sp.Rational(1, 50), sp.Rational(3, 10), sp.Rational(7, 10), sp.Rational(49, 50)]
GOLD = {"eta": "0.29", "kappa": "2.863"}


derived = cache(rf.derive)


def cosine(a):
    """v of a = v/sqrt(1 - v**2), the argument of masking functions at the roughness alpha = 1."""
    return a / sp.sqrt(1 + a**2)


def ward_of_slope(s):
    """Ward's lobe over its peak, at the slope s/5 along a tangent with the roughness 1/5."""
    t, m = 1 / sp.sqrt(1 + s**2 / 25), sp.Rational(1, 5)
    return sp.pi * m**2 * t**4 * distribution.ward(t, sp.S.One, m, m)


# name of the card, which of its functions (None: the target, "": the published one, else a reference), the exact
# factor of the variable and of parameters in the order given, their values
FACTORS = [
    ("azimuth", "", distribution.azimuth, {"p": "1/5"}),
    ("azimuth-as-printed", "", distribution.azimuth_as_printed, {"p": "1/5"}),
    ("beckmann", None, lambda t, m: sp.pi * distribution.beckmann(t, m), {"m": "1/3"}),
    ("beckmann-general", None, lambda t, m: sp.pi * distribution.beckmann(t, m), {"m": "1/3"}),
    ("beckmann-quartic", None, lambda t, m: sp.pi * distribution.beckmann(t, m), {"m": "1/3"}),
    ("beckmann-masking", None, lambda a: masking.beckmann(cosine(a), sp.S.One), {}),
    ("beckmann-masking", "walter-2007-rational", lambda a: masking.beckmann_rational(cosine(a), sp.S.One), {}),
    ("beckmann-lambda", None, lambda a: masking.beckmann_lambda(cosine(a), sp.S.One), {}),
    ("conductor", None, fresnel.conductor, GOLD),
    ("conductor", None, fresnel.conductor, {"eta": "2.94", "kappa": "2.99"}),
    ("conductor", "", lambda u, eta, kappa, n: fresnel.lazanyi(u, eta, kappa), GOLD | {"n": "5"}),
    ("conductor-ends", "iron", lambda u: fresnel.conductor(u, sp.Rational("2.94"), sp.Rational("2.99")), {}),
    ("dielectric", None, fresnel.dielectric, {"eta": "3/2"}),
    ("fresnel", "", fresnel.schlick, {"f": "1/25", "n": "5"}),
    ("fresnel", "glass", lambda u: fresnel.dielectric(u, sp.Rational(3, 2)), {}),
    ("fresnel", "gold", lambda u: fresnel.conductor(u, sp.Rational("0.29"), sp.Rational("2.863")), {}),
    ("ggx-masking", None, masking.ggx, {"alpha": "1/3"}),
    ("ggx-masking-ends", None, masking.ggx, {"alpha": "1/3"}),
    ("ggx", None, distribution.ggx, {"alpha": "1/3"}),
    ("ggx-lambda", None, masking.ggx_lambda, {"alpha": "1/3"}),
    ("ggx-correlated", None, lambda v, alpha: masking.ggx_correlated(v, v, alpha), {"alpha": "1/3"}),
    ("grooves", None, lambda v, k: masking.torrance_sparrow(sp.S.One, 2 / k, v, sp.S.One), {"k": "5/2"}),
    ("phong-density", None, distribution.phong, {"n": "7"}),
    ("smith", None, masking.smith_as_printed, {"m": "1/5"}),
    ("smith", "", masking.schlick, {"m": "1/5"}),
    ("schlick-masking", None, masking.schlick_roughness, {"r": "1/5"}),
    ("smith", "smith-1967", masking.smith, {"m": "1/5"}),
    ("smith", "walter-2007", lambda v, m: masking.beckmann(v, sp.sqrt(2) * m), {"m": "1/5"}),
    ("smith-1967", None, lambda a: masking.smith(cosine(a), 1 / sp.sqrt(2)), {}),
    ("ward", None, ward_of_slope, {}),
    ("zenith", "", distribution.zenith, {"r": "1/5"}),
    ("zenith", "beckmann", lambda t, r: sp.pi * distribution.beckmann(t, sp.sqrt(r)), {"r": "1/5"}),
]


@pytest.mark.parametrize("name, which, factor, values", FACTORS, ids=[f"{row[0]}:{row[1]}" for row in FACTORS])
def test_a_card_and_an_exact_factor_are_one_function(name, which, factor, values):
    shown = card(name)
    if which is None:
        formula, own = shown.problem.target.expression, {}
    elif which == "":
        formula, own = shown.published, {}
    else:
        reference = next(r for r in shown.problem.references if r.name == which)
        formula, own = reference.expression, reference.parameters
    numbers = [sp.Rational(text) for text in values.values()]
    by_name = dict(zip(values, numbers, strict=True))
    formula = formula.subs(own).subs({s: by_name[s.name] for s in formula.free_symbols if s.name in by_name})
    for place in PLACES:
        ours, exact = formula.subs(shown.problem.variable, place), factor(place, *numbers)
        assert abs(sp.N(ours - exact, DIGITS)) < 10.0 ** (5 - DIGITS), place


def fresnel_factor(u, index):
    """Snell's law and the two amplitudes of light, s and p, in mpmath; the index may be complex."""
    inside = mpmath.sqrt(index**2 - 1 + u * u)
    s, p = (u - inside) / (u + inside), (index**2 * u - inside) / (index**2 * u + inside)
    return (abs(s) ** 2 + abs(p) ** 2) / 2


@pytest.mark.parametrize("eta, distance, of_eq_15", [("3/2", 0.0069, 0.036), ("2.417", 0.0029, 0.075)])
def test_the_fraction_for_glass_and_diamond(eta, distance, of_eq_15):
    """Three terms at 0 and two at 1 of power series that mpmath takes from Snell's law; and how near it is."""
    problem = card("dielectric").problem
    target = problem.target.expression.subs(dict.fromkeys(problem.parameters, sp.Rational(eta)))
    fit = rf.derive(replace(problem, parameters=(), target=replace(problem.target, expression=target)))
    assert fit.status == "unique" and all(c.holds for c in fit.conditions)
    function = sp.lambdify(problem.variable, fit.expression, "mpmath")
    with mpmath.workdps(60):
        index = mpmath.mpf(sp.Rational(eta).p) / sp.Rational(eta).q
        for place, terms in ((0, 3), (1, 2)):
            ours = mpmath.taylor(function, place, terms - 1)
            exact = mpmath.taylor(lambda u: fresnel_factor(u, index), place, terms - 1)
            assert max(abs(x - y) for x, y in zip(ours, exact, strict=True)) < 1e-20
    f, places = ((float(index) - 1) / (float(index) + 1)) ** 2, np.linspace(0, 1, 501)
    exact = np.array([float(fresnel_factor(u, index)) for u in places])
    assert float(f"{np.max(np.abs(fit(places) - exact)):.2g}") == distance
    assert float(f"{np.max(np.abs(f + (1 - f) * (1 - places) ** 5 - exact)):.2g}") == of_eq_15


@pytest.mark.parametrize("name, distance", [("gold", 0.0009), ("copper", 0.00025), ("iron", 0.008)])
def test_metals_have_the_numbers_that_their_card_states(name, distance):
    """f, n, g and h from power series of Snell's law with a complex index; and how near the fraction is."""
    fit = derived("conductor-ends")
    metal = next(r for r in fit.problem.references if r.name == name)
    values = {s.name: value for s, value in metal.parameters.items()}
    with mpmath.workdps(60):
        of = {key: mpmath.mpmathify(sp.N(value, 60)) for key, value in values.items()}
        index, rise = mpmath.mpc(of["eta"], of["kappa"]), 1 - of["f"]
        grazing = mpmath.taylor(lambda u: fresnel_factor(u, index), 0, 2)
        normal = mpmath.taylor(lambda u: fresnel_factor(u, index), 1, 2)
        stated = [1, -of["n"] * rise, of["g"] * of["n"] ** 2 * rise / 2, of["f"], 0, of["h"] * rise / 2]
        assert max(abs(x - y) for x, y in zip(grazing + normal, stated, strict=True)) < 1e-20
    assert all(p.low <= of[p.name] <= p.high for p in fit.problem.parameters)
    places = np.linspace(0, 1, 501)
    exact = np.array([float(fresnel_factor(u, complex(index))) for u in places])
    found = fit(places, **{p.name: float(of[p.name]) for p in fit.problem.parameters})
    assert float(f"{np.max(np.abs(found - exact)):.2g}") == distance


def test_no_metal_within_the_ranges_meets_a_pole():
    fit = derived("conductor-ends")
    axes = [np.linspace(float(p.low), float(p.high), 13) for p in fit.problem.parameters]
    below = rf.lower(sp.fraction(fit.expression)[1], [*fit.problem.parameters, fit.problem.variable])
    found = below(*np.meshgrid(*axes, np.linspace(0, 1, 41), indexing="ij", sparse=True))
    assert np.min(found) > 0 or np.max(found) < 0


# name, parameters, the domain's part that is looked at, the greatest distance in parts of the peak that the card's note
# gives, to its last digit
NOTED = [
    ("ggx-masking", {"alpha": 0.05}, (0, 1), 0.15),
    ("ggx-masking", {"alpha": 0.5}, (0, 1), 0.066),
    ("ggx-masking-ends", {"alpha": 0.05}, (0, 1), 0.025),
    ("ggx-correlated", {"alpha": 0.05}, (0, 1), 0.037),
    ("ggx-correlated", {"alpha": 0.5}, (0, 1), 0.0064),
    ("ggx", {"alpha": 0.05}, (0, 1), 0.0),
    ("schlick-masking", {"r": 0.2}, (0, 1), 0.0),
    ("grooves", {"k": 2.5}, (0, 1), 0.0),
    ("beckmann-masking", {}, (0, 6), 0.0047),
    ("ward", {}, (0, 6), 0.095),
    ("smith-1967", {}, (0, 6), 0.0065),
    ("conductor", {"eta": 0.29, "kappa": 2.863}, (0, 1), 0.019),
    ("conductor", {"eta": 0.70, "kappa": 2.704}, (0, 1), 0.031),
    ("conductor", {"eta": 2.94, "kappa": 2.99}, (0, 1), 0.18),
    ("phong-density", {"n": 2.0}, (0, 1), 0.0),
    ("phong-density", {"n": 5.0}, (0, 1), 0.084),
    ("phong-density", {"n": 100.0}, (0, 1), 0.16),
]


@pytest.mark.parametrize("name, values, part, distance", NOTED, ids=[f"{row[0]}:{row[1]}" for row in NOTED])
def test_a_fit_is_as_near_as_its_card_notes(name, values, part, distance):
    problem = card(name).problem
    x = np.linspace(*part, 5003)[1:-1]
    symbols = [problem.variable, *problem.parameters]
    exact = rf.lower(problem.target.expression, symbols)(x, *(values[s.name] for s in problem.parameters))
    error = np.max(np.abs(derived(name)(x, **values) - exact)) / np.max(exact)
    assert float(f"{error:.2g}") == pytest.approx(distance, abs=1e-9)


@pytest.mark.parametrize(
    "name, values, part, distance",
    [
        ("ggx-lambda", {"alpha": 0.05}, (0, 1), 0.025),
        ("ggx-lambda", {"alpha": 0.5}, (0, 1), 0.0048),
        ("beckmann-lambda", {}, (0, 6), 0.0081),
    ],
)
def test_a_lambda_is_as_near_as_its_card_notes(name, values, part, distance):
    """In what is made of it, 1/(1 + Lambda): it has no peak of its own."""
    problem = card(name).problem
    x = np.linspace(*part, 5003)[1:-1]
    exact = rf.lower(problem.target.expression, [problem.variable, *problem.parameters])(x, *values.values())
    error = np.max(np.abs(1 / (1 + derived(name)(x, **values)) - 1 / (1 + exact)))
    assert float(f"{error:.2g}") == distance


def test_the_way_out_is_the_way_in_seen_from_the_other_side():
    """Total reflection needs no card: at eta < 1 F(u) is that of 1/eta at the other side's cosine."""
    eta, u = sp.Rational(2, 3), sp.Rational(9, 10)
    other = sp.sqrt(1 - (1 - u**2) / eta**2)
    assert abs(sp.N(fresnel.dielectric(u, eta) - fresnel.dielectric(other, 1 / eta), 30)) < 1e-25


def told(condition):
    """A condition without the number that it asks for, and at the place as it is written."""
    return replace(condition, equals=None)


@pytest.mark.parametrize(
    "name, others",
    [
        *(("ggx", 0), ("ggx-lambda", 0), ("ggx-correlated", 0), ("ggx-masking-ends", 0), ("schlick-masking", 0)),
        ("grooves", 0),
        *(
            pytest.param(*each, marks=pytest.mark.thorough)
            for each in (
                *(("ward", 0), ("dielectric", 0), ("beckmann-lambda", 2), ("beckmann-masking", 2)),
                ("phong-density", 1),
            )
        ),
    ],
)
def test_the_conditions_of_a_card_are_those_that_a_study_proposes(name, others):
    """All but those at the end of a support, which are chosen, and a weight of 2*pi*t, which is one of t."""
    problem = card(name).problem
    curve, clock = Curve(problem.target), Clock(1000)
    facts = [*end_facts(curve, clock), *pole_facts(Scans(curve, clock))]
    if name == "ward":
        facts += moment_facts(Scans(curve, clock))
    proposed = {told(fact.condition) for fact in facts if fact.condition is not None and fact.found == "symbolic"}
    assert len([c for c in problem.conditions if told(c) not in proposed]) == others


@pytest.mark.parametrize("name", ["beckmann-masking", "smith-1967"])
def test_masking_comes_to_one_from_below(name):
    """Increasing, never above 1, and 1 for good from the end of its support on."""
    fit = derived(name)
    end = float(fit.problem.form.support[1])
    found = fit(np.linspace(0, end, 20001))
    assert np.all(np.diff(found) > -1e-15) and found.max() <= 1 + 1e-15 and found[-1] == pytest.approx(1, abs=1e-15)
    assert fit(end + 1e-9) == fit(1e9) == 1


@pytest.mark.parametrize("n", [2, 7, 100])
def test_the_fit_of_phongs_distribution_is_normalised(n):
    fit = derived("phong-density")
    values = dict.fromkeys(fit.problem.parameters, n)
    density = sp.lambdify(fit.problem.variable, fit.expression.subs(values), "mpmath")
    total = mpmath.quad(lambda t: 2 * mpmath.pi * t * density(t), [0, 0.5, 0.9, 1])
    assert abs(total - 1) < 1e-12
    assert abs(density(mpmath.mpf(1)) - (n + 2) / (2 * mpmath.pi)) < 1e-12 * n
