"""Random fractions come back from conditions read off them: 200 problems of every kind and mix."""

from __future__ import annotations

import re
from collections import Counter

import mpmath
import pytest
import sympy as sp
from random_problems import ALL, Recovery, m, random_problem, series, shifted, x

import ratfit as rf

DIGITS = 40
TIMEOUT = 60

BETWEEN = 1e-6
"""What interpolation between the nodes of a parameter may miss."""

RADIUS = re.compile(r"\d[eE]-\d\d")

KNOWN: dict[int, str] = {}
"""Problems that do not come back yet, with the reason: this table is meant to empty."""

PLACES = [sp.Rational(2, 7), sp.Rational(13, 5), -sp.Rational(17, 9), sp.Rational(31, 3)]
"""Where numbers are compared: two fractions of degrees up to 4/3 with coefficients of these sizes differ at one."""


EVERYDAY = 16
"""One problem of so many is solved in the everyday suite; the others are left to CI."""


@pytest.mark.parametrize(
    "number", [pytest.param(n, marks=[] if n % EVERYDAY == 0 else pytest.mark.thorough) for n in range(len(ALL))]
)
def test_the_fraction_comes_back(number, request):
    if number in KNOWN:
        request.applymarker(pytest.mark.xfail(reason=KNOWN[number], strict=True))
    made = random_problem(number)
    fit = rf.derive(made.problem, timeout=TIMEOUT)
    assert fit.status != "timeout", fit.reasons
    assert not (found := complaints(made, fit)), f"{made}: {fit}: {found}"


def complaints(made: Recovery, fit: rf.Fit) -> list[str]:
    """What is wrong with an answer, in words: nothing, if it is right."""
    found = []
    if not any(is_original(made, candidate) for candidate in fit.candidates):
        found.append(f"not recovered ({fit.status}, {fit.route})")
    for candidate in fit.candidates:
        if candidate.certificate and not certified(candidate.certificate):
            found.append(f"not certified: {candidate.certificate}")
        limit = 10.0**-DIGITS if candidate.table is None else BETWEEN
        if any(not c.holds or c.residual is None or c.residual >= limit for c in candidate.conditions):
            found.append(f"accepted with {[(c.holds, c.residual) for c in candidate.conditions]}")
        if failed := unkept(made.problem, candidate):
            found.append(f"accepted {candidate.expression}, which does not keep {failed}")
    return found


def certified(words: str) -> bool:
    """Whether a certificate, as words, claims a proof with a radius."""
    return not words.startswith("not ") and ", not all certified" not in words and bool(RADIUS.search(words))


# --- the original among the candidates


def is_original(made: Recovery, candidate: rf.Candidate) -> bool:
    """Exactly, with the parameter a symbol; where numbers are allowed to 40 digits, at nodes of the parameter."""
    if candidate.free:
        return is_member(made, candidate)
    if not candidate.certificate:
        return vanishes(candidate.expression - made.original)
    if made.exact:
        return False
    return all(agrees(f, made.original.xreplace(values)) for values, f in numerically(made.problem, candidate))


def numerically(problem: rf.Problem, candidate: rf.Candidate) -> list[tuple[dict[sp.Symbol, sp.Expr], sp.Expr]]:
    """Values of the parameter, and the candidate there: at the nodes of its table, from its rows, if it has one."""
    table = candidate.table
    if table is None:
        values = {
            s: sp.Rational(1237, 1009) for s in (candidate.expression.free_symbols | set(problem.parameters)) - {x}
        }
        return [(values, candidate.expression.xreplace(values))]
    found = []
    for node, row in zip(table.nodes, table.rows, strict=True):
        values = dict(zip(table.parameters, node, strict=True))
        there = problem.form.factor * table.numerator / table.denominator
        found.append((values, there.subs(dict(zip(table.unknowns, row, strict=True))).xreplace(values)))
    return found


def vanishes(difference: sp.Expr) -> bool:
    """Whether an expression is zero, exactly: looked at by numbers first."""
    for place in PLACES[:2]:
        here = difference.xreplace({x: place, m: sp.Rational(8, 7)})
        if abs(sp.N(here, 30, maxn=200)) > 1e-20:
            return False
    left = sp.fraction(sp.together(difference))[0]
    return sp.expand(left) == 0 or sp.radsimp(sp.simplify(left)) == 0


def agrees(a: sp.Expr, b: sp.Expr) -> bool:
    """To DIGITS digits at PLACES, relative to the size of the value."""
    for place in PLACES:
        left, right = (sp.N(e.xreplace({x: place}), DIGITS + 10, maxn=400) for e in (a, b))
        if not abs(left - right) <= sp.Float(10, 60) ** -DIGITS * (1 + abs(right)):
            return False
    return True


def is_member(made: Recovery, family: rf.Candidate) -> bool:
    """Whether some values of the free coefficients give the original."""
    expression, far = family.expression, sp.Symbol("far")
    left = sp.Poly(sp.fraction(sp.together(expression - made.original))[0], x)
    found = [expression.subs(values) for values in sp.solve(left.coeffs(), list(family.free), dict=True)]
    # A family is written with a coefficient of 1; the members without it are where a free one is infinite.
    found += [sp.limit(sp.cancel(expression.subs(free, 1 / far)), far, 0) for free in family.free]
    return any(vanishes(member - made.original) for member in found)


# --- whether conditions are kept, found out by means of this file's own


def unkept(problem: rf.Problem, candidate: rf.Candidate) -> list[str]:
    """The conditions that a candidate does not keep at 50 digits; for a parameter and free names somewhere."""
    everywhere = numerically(problem, candidate)
    found = []
    for values, expression in everywhere[:: max(1, len(everywhere) - 1)]:
        with mpmath.workdps(50):
            for condition in problem.conditions:
                error = misfit(problem, condition, expression, values)
                if not error < mpmath.mpf(10) ** -(DIGITS - 3):
                    found.append(f"{condition} (off by {mpmath.nstr(error, 3)})")
    return found


def misfit(problem: rf.Problem, condition: rf.AbstractCondition, expression: sp.Expr, values) -> mpmath.mpf:
    """|found - demanded| / (1 + |demanded|), at 50 digits."""
    f = expression.xreplace(values)
    f = f.xreplace({root: root.evalf(DIGITS + 40) for root in f.atoms(sp.CRootOf)})
    if isinstance(condition, rf.Limit):
        return (decimal_limit_misfit if f.has(sp.Float) else limit_misfit)(condition, f, values)
    function = sp.lambdify(x, f, "mpmath")
    if isinstance(condition, rf.Equation):
        return equation_misfit(condition, f, values)
    demand = number(condition.equals.xreplace(values))
    if isinstance(condition, rf.Integral):
        low, high = (e.xreplace(values) for e in condition.over or problem.domain)
        weighted = sp.lambdify(x, condition.weight.xreplace(values) * f, "mpmath")
        if f.has(sp.exp) and high.is_infinite:
            high = low + 140  # exp(-140) is nothing here
        error = abs(quadrature(weighted, low, high) - demand)
    else:
        order = getattr(condition, "order", 0)
        at = number(condition.at.xreplace(values))
        error = abs((mpmath.diff(function, at, order) if order else function(at)) - demand)
    return error / (1 + abs(demand))


def number(e: sp.Expr) -> mpmath.mpf:
    return mpmath.mpf(sp.N(e, mpmath.mp.dps + 10)._mpf_) if not e.is_Integer else mpmath.mpf(int(e))


def quadrature(function, low: sp.Expr, high: sp.Expr) -> mpmath.mpf:
    """Gauss-Legendre in pieces; an infinite range goes through tan."""
    ends = [(-mpmath.pi / 2 if e < 0 else mpmath.pi / 2) if e.is_infinite else number(e) for e in (low, high)]
    if not (low.is_infinite or high.is_infinite):
        return mpmath.quad(function, mpmath.linspace(*ends, 3 if ends[1] - ends[0] < 100 else 12))
    ends = [end if e.is_infinite else mpmath.atan(end) for e, end in zip((low, high), ends, strict=True)]
    return mpmath.quad(lambda t: function(mpmath.tan(t)) * (1 + mpmath.tan(t) ** 2), mpmath.linspace(*ends, 3))


def limit_misfit(condition: rf.Limit, f: sp.Expr, values) -> mpmath.mpf:
    """Very near the place: what is left falls off with the distance."""
    with mpmath.workdps(600):
        whole = sp.lambdify(x, ((f - condition.minus) * condition.scale).xreplace(values), "mpmath")
        near = mpmath.mpf(10) ** -80
        at = condition.at.xreplace(values)
        place = (1 if at is sp.oo else -1) / near if at.is_infinite else number(at) + near
        demand = number(condition.equals.xreplace(values))
        return abs(whole(place) - demand) / (1 + abs(demand))


def decimal_limit_misfit(condition: rf.Limit, f: sp.Expr, values) -> mpmath.mpf:
    """From series: what decimals leave of a pole or of a term that must cancel is of the size of their last digit."""
    at = condition.at.xreplace(values)
    wanted = condition.minus + condition.equals / condition.scale
    found, expected = (local_series(e.xreplace(values), at, top=8) for e in (f, wanted))
    if at.is_infinite:
        power = sp.degree(sp.fraction(condition.scale)[0], x) - sp.degree(sp.fraction(condition.scale)[1], x)
    else:
        power = -local_series(condition.scale.xreplace(values), at, top=0).lowest
    return max(abs(found.at(k) - expected.at(k)) for k in range(min(found.lowest, expected.lowest), power + 1))


def local_series(e: sp.Expr, at: sp.Expr, top: int):
    parts = [[number(c) for c in sp.Poly(part, x).all_coeffs()[::-1]] for part in sp.fraction(sp.together(e))]
    if at.is_infinite:
        return series(*parts, None, top)
    above, below = (
        [c if abs(c) > mpmath.mpf(10) ** -DIGITS else mpmath.mpf(0) for c in shifted(part, number(at))]
        for part in parts
    )
    return series(above, below, mpmath.mpf(0), top)


def equation_misfit(condition: rf.Equation, f: sp.Expr, values) -> mpmath.mpf:
    jet = {s: k for k in range(3) for s in condition.residual.free_symbols if s.name == "y" + "'" * k}
    residual = condition.residual.xreplace(values)

    def along(t):
        found = {s: sp.diff(f, x, k) for s, k in jet.items()}
        return sp.lambdify(x, residual.xreplace(found), "mpmath")(t)

    at = number(condition.at.xreplace(values))
    return max(abs(mpmath.diff(along, at, k) if k else along(at)) for k in range(condition.order + 1))


# --- the table is tested too


@pytest.mark.thorough
def test_every_kind_occurs_often():
    everything = [random_problem(number) for number in range(len(ALL))]
    assert len(everything) == 200
    kinds = Counter(kind for made in everything for kind in made.kinds)
    tags = Counter(tag for made in everything for tag in made.tags)
    assert kinds["value"] >= 150 and kinds["derivative"] >= 70 and kinds["integral"] >= 40
    assert kinds["equation"] >= 25 and kinds["limit at infinity"] >= 35 and kinds["pole"] >= 15
    assert tags["parameter"] >= 50 and tags["whole line"] >= 15 and tags["half-infinite"] >= 30
    assert tags["redundant"] >= 5 and tags["odd"] >= 3 and tags["even"] >= 3 and tags["factor"] >= 15
    mixed = sum(len(made.kinds - {"value", "derivative"}) >= 2 for made in everything)
    assert mixed >= 10 and sum(not made.exact for made in everything) >= 30


@pytest.mark.parametrize("number", range(len(ALL)))
def test_the_original_keeps_its_conditions(number):
    made = random_problem(number)
    assert not unkept(made.problem, rf.Candidate(made.original))


def test_known_failures_are_few():
    assert len(KNOWN) <= 20 and set(KNOWN) <= set(range(len(ALL)))


@pytest.mark.parametrize("number", range(0, len(ALL), 7))
def test_an_answer_that_is_nearly_right_is_noticed(number):
    made = random_problem(number)
    near = made.original * (1 + sp.Rational(1, 10**30))
    assert unkept(made.problem, rf.Candidate(near))
    assert not is_original(made, rf.Candidate(near)) and not is_original(made, rf.Candidate(near, certificate="1e-48"))
