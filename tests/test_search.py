"""The float64 half of the nonlinear route: quadrature, many starts, the grid. Roots known from mathematics."""

import itertools
import math
import subprocess
import sys

import numpy as np
import pytest
import sympy as sp

from ratfit._deadline import TimeLimit
from ratfit._parse import RatfitError
from ratfit._solver.nonlinear.grid import grid, roots_on_grid
from ratfit._solver.nonlinear.quadrature import MOST, Rule, choose, weighted
from ratfit._solver.nonlinear.residuals import Moment, Residual, Residuals
from ratfit._solver.nonlinear.search import search, search_chunks
from ratfit._target import parameter

x, a, b, c, d = sp.symbols("x a b c d", real=True)
ZERO, ONE, HALF = sp.S.Zero, sp.S.One, sp.S.Half


def residuals(unknowns, *parts, homogeneous=False):
    """Each part an expression, or (expression, integrand, low, high)."""
    rows = [Residual(p[0], (Moment(*p[1:]),)) if isinstance(p, tuple) else Residual(sp.sympify(p)) for p in parts]
    return Residuals(x, unknowns, tuple(rows), homogeneous)


FRACTION = (a + b * x) / (c + d * x)
SPHERE = a**2 + b**2 + c**2 + d**2 - 1
# (1 + 3x)/(2 + x) = 3 - 5/(2 + x); its mean is 3 - 5 L, its first moment 3/2 - 5(1 - 2L), with L = log(3/2).
L = sp.log(sp.Rational(3, 2))
MEANS = [
    (-(3 - 5 * L), FRACTION, ZERO, ONE),
    (-(sp.Rational(3, 2) - 5 * (1 - 2 * L)), x * FRACTION, ZERO, ONE),
]

PROBLEMS = {
    "circle and hyperbola": (residuals((a, b), a**2 + b**2 - 5, a * b - 2), [(1, 2), (2, 1), (-1, -2), (-2, -1)]),
    "a tower of cubics": (
        residuals((a, b, c), a**3 - a, b**3 - b, (c - 1) * (c - 2) * (c + 30)),
        list(itertools.product((-1, 0, 1), (-1, 0, 1), (1, 2, -30))),
    ),
    "one unknown, five roots": (
        residuals((a,), a * (a - 1) * (a + 2) * (a - sp.Rational(1, 1000)) * (a - 20000) / 1000),
        [(0,), (1,), (-2,), (0.001,), (20000,)],
    ),
    "a double root": (residuals((a, b), (a - 1) ** 2, b - a), [(1, 1)]),
    "overdetermined": (residuals((a, b), a + b - 3, a * b - 2, a**2 + b**2 - 5), [(1, 2), (2, 1)]),
    "overdetermined, no root": (residuals((a, b), a + b - 3, a * b - 2, a**2 + b**2 - 6), []),
    "no real root": (residuals((a, b), a**2 + b**2 + 1, a - b), []),
    "no root but at infinity": (residuals((a, b), sp.exp(-a), a - b), []),
    "transcendental": (residuals((a, b), sp.exp(a) - b, a + b - 1), [(0, 1)]),
    # Far out, exp(-b*x) is a peak that no node sees: there a constant would do.
    "a constant in disguise": (
        residuals(
            (a, b, c),
            (-sp.Rational(3, 5), a * sp.exp(-b * x) + c, ZERO, ONE),
            (-sp.Rational(3, 10), x * (a * sp.exp(-b * x) + c), ZERO, ONE),
            a - sp.Rational(3, 10),
        ),
        [(0.3, 0, 0.3)],
    ),
    # Below b = -1 the integral has a pole on its range; above it falls from infinity to 0.
    "log(3)/2": (residuals((b,), (-sp.log(3) / 2, 1 / (1 + b * x), ZERO, ONE)), [(2,)]),
    # 1/(1 + b x) > 0: the mean is positive where it exists, though nodes beside a pole say otherwise.
    "poles only": (residuals((b,), (ONE, 1 / (1 + b * x), ZERO, ONE)), []),
    "poles only, two unknowns": (residuals((a, b), (ONE, 1 / (1 + b * x), ZERO, ONE), a - b), []),
    "homogeneous fraction": (
        residuals((a, b, c, d), 2 * a - c, *MEANS, SPHERE, homogeneous=True),
        [tuple(np.array([1, 3, 2, 1]) / math.sqrt(15))],
    ),
    "the same fraction, c = 1": (
        residuals((a, b, d), 2 * a - 1, *((p, f.xreplace({c: ONE}), *ends) for p, f, *ends in MEANS)),
        [(0.5, 1.5, 0.5)],
    ),
    "homogeneous with two": (
        residuals((a, b), (-L, a / (2 * a + b * x), ZERO, ONE), a**2 + b**2 - 1, homogeneous=True),
        [(math.sqrt(0.5), math.sqrt(0.5))],
    ),
    "the line": (residuals((b,), (-1, sp.exp(-b * x**2), -sp.oo, sp.oo)), [(math.pi,)]),
    "a ray": (
        residuals((a, b), (-1, a * sp.exp(-b * x), ZERO, sp.oo), (-HALF, a * x * sp.exp(-b * x), ZERO, sp.oo)),
        [(2, 2)],
    ),
    "a ray, a fraction": (residuals((b,), (-sp.pi / 4, 1 / (b + x**2), ZERO, sp.oo)), [(4,)]),
    # The substitution x = t**2 makes it 2 atan(sqrt(b))/sqrt(b).
    "singular weight": (
        residuals((b,), (-2 * sp.pi / 3 / sp.sqrt(3), 1 / sp.sqrt(x) / (1 + b * x), ZERO, ONE)),
        [(3,)],
    ),
    "an unknown exponent": (residuals((a,), (-sp.Rational(1, 4), x**a, ZERO, ONE)), [(3,)]),
    # A pole at -1/1000, beside the range: more than 48 nodes.
    "a near pole": (residuals((b,), (-sp.log(1001), 1 / (b + x), ZERO, ONE)), [(0.001,)]),
    # sympy's derivative of gamma is polygamma, which arrays lack.
    "gamma": (residuals((a, b), sp.gamma(a + 3) - 6, a - b - 1 + 1), [(1, 1)]),
}


@pytest.mark.parametrize("name", PROBLEMS)
def test_all_roots_are_found_and_no_other(name):
    problem, roots = PROBLEMS[name]
    found = search(problem)
    if name == "gamma":  # oscillates on the negative side: it has more roots there
        found = [root for root in found if root[0] > -2]
    assert len(found) == len(roots), found
    accuracy = 1e-5 if name == "a double root" else 1e-9
    for root in roots:
        assert min(np.abs(root - each).max() for each in found) < accuracy * max(1, np.abs(root).max()), (root, found)


def test_a_seed_gives_the_same_roots_and_another_seed_the_same_set():
    problem, roots = PROBLEMS["a tower of cubics"]
    first, again, other = search(problem), search(problem), search(problem, seed=5)
    assert all(np.array_equal(u, v) for u, v in zip(first, again, strict=True))
    assert len(other) == len(roots)


def test_what_is_found_is_told_after_each_chunk():
    problem, roots = PROBLEMS["a tower of cubics"]
    counts = []
    assert len(search(problem, progress=lambda found: counts.append(len(found)))) == len(roots)
    assert counts == sorted(counts) and len(counts) == 4
    assert len(next(search_chunks(problem))) == counts[0]


def test_a_time_limit_ends_a_search():
    with TimeLimit(0.3) as limit:
        search(PROBLEMS["a ray"][0], starts=10**6)
    assert limit.passed


def test_a_symbol_without_a_value_is_named():
    with pytest.raises(RatfitError, match="d has no value"):
        search(residuals((a,), a - d))


INTEGRALS = [
    ("smooth", np.exp, 0, 1, math.e - 1, "gauss"),
    ("root at 0", lambda t: 1 / np.sqrt(t), 0, 1, 2, "tanh-sinh"),
    ("logarithm", np.log, 0, 1, -1, "tanh-sinh"),
    ("Gauss's bell", lambda t: np.exp(-(t**2)), -math.inf, math.inf, math.sqrt(math.pi), "gauss"),
    ("ray to the left", np.exp, -math.inf, 0, 1, "gauss"),
    ("algebraic tail", lambda t: t**-1.5, 1, math.inf, 2, "tanh-sinh"),
    ("pole beside", lambda t: 1 / (t + 1e-3), 0, 1, math.log(1001), "gauss"),
]


@pytest.mark.parametrize("row", INTEGRALS, ids=lambda row: row[0])
def test_a_rule_is_chosen_that_reaches_the_tolerance(row):
    _, integrand, low, high, exact, name = row
    values = weighted(integrand, low, high)
    choice = choose(values)
    assert choice.rule.name == name and choice.error < 1e-11
    assert values(choice.rule).sum() == pytest.approx(exact, rel=1e-10)


def test_a_pole_on_the_range_never_settles():
    assert choose(weighted(lambda t: 1 / (t - 0.3), 0, 1)).error > 1e-3


@pytest.mark.parametrize("count", [48, MOST])
def test_gauss_legendre_nodes_are_those_of_numpy(count):
    points, weights = Rule(count).on(np.array([-1.0]), np.array([1.0]))
    expected = np.polynomial.legendre.leggauss(48) if count == 48 else None
    if expected:
        assert np.abs(points[0] - expected[0]).max() < 1e-15 and np.abs(weights[0] - expected[1]).max() < 1e-13
    assert weights.sum() == pytest.approx(2, abs=1e-13)
    assert (weights * points**20).sum() == pytest.approx(2 / 21, abs=1e-13)


m, n = parameter("m", "1/10", "2"), parameter("n", "1", "3")

# Residuals, parameters, and each branch as a function of the parameters' columns.
GRIDS = {
    "two branches": (residuals((a,), a**2 - m), (m,), [lambda m: [np.sqrt(m)], lambda m: [-np.sqrt(m)]]),
    "branches that come close": (
        residuals((a,), (a - m) ** 2 - sp.Rational(1, 10**8)),
        (m,),
        [lambda m: [m + 1e-4], lambda m: [m - 1e-4]],
    ),
    "a moment": (residuals((b,), (-sp.log(1 + m) / m, 1 / (1 + b * x), ZERO, ONE)), (m,), [lambda m: [m]]),
    "an end that moves": (
        residuals((a, b), (-1, a / (1 + b * x), ZERO, m), a - b),
        (m,),
        [lambda m: [(math.e - 1) / m, (math.e - 1) / m]],
    ),
    # m/(1 + x) from its value at 0, mean and first moment.
    "homogeneous": (
        residuals(
            (a, b, c, d),
            a - m * c,
            (-m * sp.log(2), FRACTION, ZERO, ONE),
            (-m * (1 - sp.log(2)), x * FRACTION, ZERO, ONE),
            SPHERE,
            homogeneous=True,
        ),
        (m,),
        [lambda m: np.array([m, 0 * m, m**0, m**0]) / np.sqrt(m**2 + 2)],
    ),
    "two parameters": (
        residuals((a, b), a**2 - m * n, b - m * a),
        (m, n),
        [lambda m, n, s=s: [s * np.sqrt(m * n), s * m * np.sqrt(m * n)] for s in (-1, 1)],
    ),
}


@pytest.mark.parametrize("name", GRIDS)
def test_branches_are_followed_and_kept_apart(name):
    problem, parameters, known = GRIDS[name]
    branches = roots_on_grid(problem, parameters)
    assert len(branches) == len(known)
    for function in known:
        expected = np.transpose(function(*branches[0].parameters.T))
        errors = [
            np.abs(branch.coefficients * sign - expected).max() for branch in branches for sign in _signs(problem)
        ]
        assert min(errors) < 1e-10
    assert not any(branch.failed.any() for branch in branches)


def _signs(problem):
    return (1, -1) if problem.homogeneous else (1,)


def test_a_branch_ends_at_a_fold():
    branches = roots_on_grid(residuals((a,), a**2 - (m - 1)), (m,))
    assert len(branches) == 2
    for branch in branches:
        assert (branch.failed == (branch.parameters[:, 0] < 1)).all()
        assert (np.isnan(branch.coefficients[:, 0]) == branch.failed).all()


def test_a_branch_that_does_not_reach_the_middle_is_found():
    high = roots_on_grid(residuals((a,), a**2 - (m - sp.Rational(3, 2))), (m,))
    assert [branch.failed.sum() for branch in high] == [(high[0].parameters[:, 0] < 1.5).sum()] * 2


def test_nodes_are_chebyshev_points_inside_the_ranges():
    values = grid((m,), 3)
    assert values[:, 0] == pytest.approx([1.05 - 0.95 * math.sqrt(0.75), 1.05, 1.05 + 0.95 * math.sqrt(0.75)])
    assert grid((m, n)).shape == (81, 2)


@pytest.mark.parametrize("parameters", [(parameter("k", "0", "oo"),), (), (m, n, parameter("k", "0", "1"))])
def test_a_grid_needs_one_or_two_finite_ranges(parameters):
    with pytest.raises(RatfitError, match=r"finite range|one or two"):
        grid(parameters)


def test_a_search_loads_no_jax():
    code = "import sys, ratfit._solver.nonlinear.grid; print([m for m in ('jax', 'scipy') if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout.strip() == "[]"
