"""Tests the conditions as they were stated, never a cleared form of them; finds poles and cancelled factors."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

import mpmath
import sympy as sp

from ratfit._condition import Integral, describe
from ratfit._field import Field, is_zero
from ratfit._fit import Candidate, Checked
from ratfit._generators import DIGITS
from ratfit._parse import RatfitError
from ratfit._solver import Solution
from ratfit._system import System, integral_parts, primitive_of, taylor
from ratfit._target import Parameter, at_values, sample_values

TOLERANCE = mpmath.mpf("1e-30")
"""A residual at 50 digits below this, relative to the size of the demand, counts as zero."""

SCAN = 2001
"""Points at which a denominator that is no polynomial is looked at for changes of sign."""


def verify(system: System, solution: Solution) -> Candidate:
    """The candidate that a solution stands for, accepted (no reason) or rejected with its reason.

    A candidate is rejected when it is complex, when its denominator vanishes identically, when a condition fails as
    it was stated (a common factor that vanishes at a node makes such), or when it has a pole on the support that
    neither the form's factor nor the target has.
    """
    shape, x = system.shape, system.problem.variable
    if solution.nature:
        return Candidate(shape.factor * solution.numerator / solution.denominator, reason=solution.nature)
    numerator, denominator, common = reduced(solution.numerator, solution.denominator, x)
    if denominator == 0:
        return Candidate(sp.nan, reason="the denominator vanishes identically")
    expression = presentable(shape.factor, numerator, denominator, x, _middle(system))
    free = {s: r for s, r in solution.free.items() if s in expression.free_symbols}
    checked = tuple(
        _check(system, condition, demand, numerator, denominator, expression)
        for condition, demand in zip(system.problem.conditions, system.demands, strict=True)
    )
    reason = _failure(system, checked, common) or _pole(system, numerator, denominator, free)
    return Candidate(expression, free, checked, reason)


def presentable(factor: sp.Expr, numerator: sp.Expr, denominator: sp.Expr, x: sp.Symbol, inside: sp.Expr) -> sp.Expr:
    """The fraction as it is shown: each sum without common constants, positive in the middle of the support.

    The constants taken out are gathered into one; inner variables stay unexpanded.
    """
    constant = sp.S.One
    shown = []
    for part, sign in ((numerator, 1), (denominator, -1)):
        for piece in sp.Mul.make_args(part):
            base, exponent = piece.as_base_exp()
            if not base.has(x) or not base.is_Add or not exponent.is_Integer:
                shown.append(piece**sign)
                continue
            scale, plain = _without_scale(base, x, inside)
            constant *= scale ** (exponent * sign)
            shown.append(plain ** (exponent * sign))
    field = Field([constant])
    above, below = sp.fraction(sp.together(field.decode(field.encode(constant))))
    return factor * above * sp.Mul(*shown) / below


def _without_scale(base: sp.Expr, x: sp.Symbol, inside: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """A sum as (constant, sum with the shortest coefficients)."""
    pairs = [term.as_independent(x, as_Add=False) for term in sp.Add.make_args(base)]
    collected: dict[sp.Expr, sp.Expr] = {}
    for coefficient, dependent in pairs:
        collected[dependent] = collected.get(dependent, sp.S.Zero) + coefficient
    field = Field(collected.values())
    elements = [field.encode(c) for c in collected.values()]
    short = field.simplest(elements)
    place = next(i for i, e in enumerate(elements) if e)
    scale = field.decode(field.multiply(elements[place], field.inverse(short[place])))
    plain = sp.Add(*(field.decode(s) * d for s, d in zip(short, collected, strict=True)))
    values = sample_values(plain.free_symbols | inside.free_symbols - {x}, ("3/7",))[0]
    values.pop(x, None)
    if sp.N(plain.subs(values).subs(x, inside.subs(values))).is_negative:
        return -scale, -plain
    return scale, plain


def _middle(system: System) -> sp.Expr:
    """A place inside the support: its middle, or one near its finite end."""
    low, high = system.problem.support()
    if low.is_infinite or high.is_infinite:
        return sp.S.One if low.is_infinite and high.is_infinite else low + 1 if high.is_infinite else high - 1
    return low + sp.Rational(4, 7) * (high - low)


def reduced(numerator: sp.Expr, denominator: sp.Expr, x: sp.Symbol) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Numerator and denominator without their common factor, and that factor (1 where there is none).

    Coprime at one place of the parameters is coprime: the exact greatest common divisor is taken only if a
    numerical one hints at it.
    """
    if not (numerator.is_polynomial(x) and denominator.is_polynomial(x)):
        return numerator, denominator, sp.S.One
    above, below = sp.Poly(numerator, x), sp.Poly(denominator, x)
    if above.is_zero or below.is_ground or below.is_zero or not _share_a_root(above, below):
        return numerator, denominator, sp.S.One
    field = Field([*above.all_coeffs(), *below.all_coeffs()])
    common = _gcd(field, _coefficients(field, above), _coefficients(field, below))
    if len(common) == 1:
        return numerator, denominator, sp.S.One
    quotients = [_divide(field, _coefficients(field, p), common)[0] for p in (above, below)]
    flat = field.simplest([*quotients[0], *quotients[1]])
    split = len(quotients[0])
    shown = [sp.Poly([field.decode(c) for c in cs], x).as_expr() for cs in (flat[:split], flat[split:])]
    factor = sp.Poly([field.decode(c) for c in field.simplest(common)], x).as_expr()
    return shown[0], shown[1], factor


def _share_a_root(above: sp.Poly, below: sp.Poly) -> bool:
    """Whether the resultant is numerically zero at a sampled place of all other symbols."""
    symbols = (above.free_symbols | below.free_symbols) - set(above.gens)
    values = sample_values(symbols, ("2/7",))[0]
    with mpmath.workdps(DIGITS):
        roots = [_polynomial_roots(p.as_expr().subs(values), above.gens[0]) for p in (above, below)]
        return any(abs(a - b) < mpmath.mpf("1e-12") * (1 + abs(a)) for a in roots[0] for b in roots[1])


def _coefficients(field: Field, polynomial: sp.Poly) -> list[Any]:
    return _trimmed([field.encode(c) for c in polynomial.all_coeffs()])


def _trimmed(polynomial: list[Any]) -> list[Any]:
    while polynomial and not polynomial[0]:
        polynomial = polynomial[1:]
    return polynomial


def _divide(field: Field, a: list[Any], b: list[Any]) -> tuple[list[Any], list[Any]]:
    """Quotient and remainder of polynomials with coefficients in the exact field, leading coefficient first."""
    inverse, quotient = field.inverse(b[0]), []
    while len(a) >= len(b):
        lead = field.multiply(a[0], inverse)
        quotient.append(lead)
        padded = b + [field.zero] * (len(a) - len(b))
        a = [u - field.multiply(lead, v) for u, v in zip(a, padded, strict=True)][1:]
    return quotient, _trimmed(a)


def _gcd(field: Field, a: list[Any], b: list[Any]) -> list[Any]:
    while b:
        a, b = b, _divide(field, a, b)[1]
    return a


def _check(system: System, condition, demand: sp.Expr, numerator, denominator, expression) -> Checked:
    """One condition, exactly and at 50 digits."""
    try:
        exact = is_zero(_found_exactly(system, condition, numerator, denominator) - demand)
        residual = _numerical_residual(system, condition, demand, expression)
    except RatfitError:
        return Checked(condition, demand, False, None)
    numerically = residual < TOLERANCE * (1 + _size(demand))
    holds = exact if exact == numerically else None
    return Checked(condition, demand, holds, float(residual))


def _size(demand: sp.Expr) -> mpmath.mpf:
    values = sample_values(demand.free_symbols, ("1/7",))[0]
    return abs(_mp(demand.subs(values)))


def _found_exactly(system: System, condition, numerator, denominator) -> sp.Expr:
    """The number that the candidate gives, in closed form."""
    x = system.problem.variable
    if isinstance(condition, Integral):
        (low, high), rest = integral_parts(system.problem, condition)
        primitive = primitive_of(condition.weight * system.shape.factor * numerator, denominator, x)
        return primitive.subs(x, high) - primitive.subs(x, low) + rest
    if system.shape.power is not None:
        # A free exponent n > 2 is written as 2 plus something positive: then sympy knows that 0**(n - 2) is 0.
        above = {s: s.low + sp.Dummy(positive=True) for s in numerator.free_symbols if isinstance(s, Parameter) and s.high == sp.oo}
        value = sp.powsimp(sp.expand(sp.diff(numerator.subs(above), x, condition.order)), combine="exp").subs(x, condition.at)
        return value.subs({v.args[1] if v.is_Add else v: s - s.low for s, v in above.items()})
    series = [taylor(p, x, condition.at, condition.order) for p in (numerator, denominator)]
    series.append(taylor(system.shape.factor, x, condition.at, condition.order))
    field = Field([c for s in series for c in s])
    above, below, factor = ([field.encode(c) for c in s] for s in series)
    inverse = field.inverse(below[0])
    quotient: list[Any] = []
    for k in range(condition.order + 1):
        total = above[k]
        for j in range(k):
            total = total - field.multiply(quotient[j], below[k - j])
        quotient.append(field.multiply(total, inverse))
    total = field.zero
    for j in range(condition.order + 1):
        total = total + field.multiply(quotient[j], factor[condition.order - j])
    return field.decode(total) * sp.factorial(condition.order)


def _numerical_residual(system: System, condition, demand: sp.Expr, expression: sp.Expr) -> mpmath.mpf:
    """The largest |found - demanded| over sampled parameters, by numerical differentiation or quadrature."""
    symbols = (expression.free_symbols | demand.free_symbols) - {system.problem.variable}
    symbols |= set().union(*(e.free_symbols for e in condition.expressions())) - {system.problem.variable}
    worst = mpmath.mpf(0)
    for values in sample_values(symbols, ("1/7", "4/7", "9/11")):
        with mpmath.workdps(DIGITS):
            found = _numerical(system, condition, expression, values)
            wanted = _mp(demand.subs(values))
            if not mpmath.isfinite(found):
                raise RatfitError("the condition has no finite value")
            worst = max(worst, abs(found - wanted))
    return worst


def _numerical(system: System, condition, expression: sp.Expr, values: Mapping[sp.Symbol, sp.Expr]) -> mpmath.mpf:
    x = system.problem.variable
    if isinstance(condition, Integral):
        (low, high), rest = integral_parts(system.problem, condition)
        function = _compiled((condition.weight * expression).subs(values), x)
        return mpmath.quad(function, [_mp(low.subs(values)), _mp(high.subs(values))]) + _mp(rest.subs(values))
    at = condition.at.subs(values)
    low, high = (end.subs(values) for end in system.problem.support())
    side = 1 if at == low else -1 if at == high else 0

    def moved(distance: mpmath.mpf) -> mpmath.mpf:
        return function(_mp(at) + distance)

    function = _compiled(expression.subs(values), x)
    try:
        return mpmath.diff(moved, 0, condition.order, direction=side)
    except ZeroDivisionError:
        raise RatfitError("the candidate has a pole there") from None


@lru_cache(maxsize=100)
def _compiled(expression: sp.Expr, x: sp.Symbol) -> Callable[[mpmath.mpf], mpmath.mpf]:
    return sp.lambdify(x, expression, "mpmath", cse=False)


def _mp(number: sp.Expr) -> mpmath.mpf:
    """A constant at the working precision of mpmath; RatfitError for one that is not real."""
    value = sp.N(number, mpmath.mp.dps + 10, maxn=2 * mpmath.mp.dps + 20)
    if value.is_real is not True:
        raise RatfitError(f"{number} is not a real number")
    return mpmath.mpf(sp.Float(value, mpmath.mp.dps + 10)._mpf_)


def _failure(system: System, checked: tuple[Checked, ...], common: sp.Expr) -> str:
    """The conditions that do not hold, in words."""
    failed = []
    for c in checked:
        if c.holds:
            continue
        what = describe(c.condition)
        if c.holds is None:
            return f"{what}: exact and numerical results disagree; it is not accepted undecided"
        found = f"off by {c.residual:.3g}" if c.residual is not None else "no finite value there"
        failed.append(f"{what} should be {c.demand} ({found})")
    if not failed:
        return ""
    cancelled = f"the factor {common} cancels, then " if common != 1 else ""
    return f"{cancelled}{'; '.join(failed)}"


def _pole(system: System, numerator: sp.Expr, denominator: sp.Expr, free: Mapping[sp.Symbol, Any]) -> str:
    """The first pole on the closed support that the target does not have; families are not searched."""
    x = system.problem.variable
    if free or not denominator.has(x):
        return ""
    for values in sample_values(denominator.free_symbols - {x}, ("0", "1/7", "4/7", "1")):
        low, high = (end.subs(values) for end in system.problem.support())
        with mpmath.workdps(DIGITS):
            for root in _real_zeros(denominator.subs(values), x, low, high):
                if not _target_infinite(system, values, root):
                    return f"it has a pole at {x} = {mpmath.nstr(root, 8)}{at_values(values)}"
    return ""


def _real_zeros(denominator: sp.Expr, x: sp.Symbol, low: sp.Expr, high: sp.Expr) -> list[mpmath.mpf]:
    ends = [(-mpmath.inf if e == -sp.oo else mpmath.inf) if e.is_infinite else _mp(e) for e in (low, high)]
    found = []
    for base in (factor.as_base_exp()[0] for factor in sp.Mul.make_args(denominator)):
        roots = _polynomial_roots(base, x) if base.is_polynomial(x) else _scanned_roots(base, x, ends)
        tolerance = mpmath.mpf("1e-15")
        found += [r.real for r in roots if abs(r.imag) < tolerance * (1 + abs(r)) and ends[0] - tolerance <= r.real <= ends[1] + tolerance]
    return found


@lru_cache(maxsize=100)
def _polynomial_roots(polynomial: sp.Expr, x: sp.Symbol) -> list[mpmath.mpc]:
    """The complex roots at DIGITS digits, kept because coprimality and poles both ask for them."""
    coefficients = [_mp(c) for c in sp.Poly(polynomial, x).all_coeffs()]
    size = max(map(abs, coefficients))
    while coefficients and abs(coefficients[0]) < mpmath.mpf("1e-45") * size:
        coefficients = coefficients[1:]
    if len(coefficients) < 2:
        return []
    try:
        return [mpmath.mpc(r) for r in mpmath.polyroots(coefficients, maxsteps=200, extraprec=mpmath.mp.prec)]
    except mpmath.libmp.NoConvergence:
        # Multiple roots converge slowly; the accuracy left is still far below the tolerance of the search.
        return [mpmath.mpc(r) for r in mpmath.polyroots(coefficients, maxsteps=2000, extraprec=20 * mpmath.mp.prec, error=False)]


def _scanned_roots(base: sp.Expr, x: sp.Symbol, ends: list[mpmath.mpf]) -> list[mpmath.mpc]:
    """Changes of sign of something that is no polynomial; an infinite end is cut at a distance of 1000."""
    if not base.has(x):
        return []
    low, high = max(ends[0], mpmath.mpf(-1000)), min(ends[1], mpmath.mpf(1000))
    function = _compiled(base, x)
    points = [low + (high - low) * i / (SCAN - 1) for i in range(SCAN)]
    values = [function(p) for p in points]
    found = [p for p, v in zip(points, values, strict=True) if v == 0]
    for i in range(SCAN - 1):
        if mpmath.sign(values[i]) * mpmath.sign(values[i + 1]) < 0:
            found.append(mpmath.findroot(function, (points[i], points[i + 1]), solver="anderson"))
    return [mpmath.mpc(f) for f in found]


def _target_infinite(system: System, values: Mapping[sp.Symbol, sp.Expr], at: mpmath.mpf) -> bool:
    target = system.problem.target
    if target is None:
        return False
    place = sp.nsimplify(at, rational=True, tolerance=1e-30)
    value = target.expression.subs(values).subs(target.variable, place)
    return bool(value.has(sp.zoo, sp.oo))
