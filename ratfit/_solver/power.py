"""The power route: A + B*base**n, whose exponent the conditions at the base's zero bound from below and leave open."""

from __future__ import annotations

import sympy as sp

from ratfit._condition import Integral
from ratfit._field import is_zero, sampled
from ratfit._parse import RatfitError
from ratfit._solver.solution import Solution, Undecided
from ratfit._system import System, same
from ratfit._target import Parameter


def solve_power(system: System) -> list[Solution]:
    """All A + B*base**n that satisfy value and derivative conditions.

    Arguments: a system whose form is a Power, with a value at the base's zero c (it gives A). Conditions at c bound
    n from below; one condition elsewhere gives B, two give n. Raises RatfitError for conditions of other kinds,
    Undecided for three or more conditions elsewhere than at c.
    """
    x = system.problem.variable
    base, n = system.shape.power  # type: ignore[misc]
    c = sp.solve(base, x)[0]
    pairs = list(zip(system.problem.conditions, system.demands, strict=True))
    if any(isinstance(condition, Integral) for condition, _ in pairs) or system.shape.factor != 1:
        raise RatfitError("the power route takes values and derivatives of A + B*base**n without a factor")
    at_zero = {k.order: d for k, d in pairs if same(k.at, c)}  # type: ignore[attr-defined]
    elsewhere = [(k, d) for k, d in pairs if not same(k.at, c)]  # type: ignore[attr-defined]
    if 0 not in at_zero:
        raise RatfitError(f"the power route needs a value at {x} = {c}, where the base {base} vanishes")
    amplitude = at_zero.pop(0)
    if not elsewhere:
        raise Undecided(f"nothing fixes the factor of the power; add a value at another place than {x} = {c}")
    found = _exponents_at_zero(at_zero, sp.diff(base, x))
    solutions = []
    for exponent, slope in found:
        solutions += _with_conditions_elsewhere(system, amplitude, exponent, slope, elsewhere, n)
    return solutions


def _exponents_at_zero(
    demands: dict[int, sp.Expr], slope: sp.Expr
) -> list[tuple[sp.Expr | tuple[sp.Expr, sp.Expr], sp.Expr | None]]:
    """The exponents that derivatives at the base's zero allow: (exponent or open range, B if it is fixed).

    base**n has a k-th derivative of zero there for every real n > k, and for the whole numbers n < k; it has one
    that is not zero for n = k alone.
    """
    orders = sorted(k for k, d in demands.items() if is_zero(d) is not False)
    fixed = [(k, d) for k, d in sorted(demands.items()) if k not in orders]
    if len(fixed) > 1:
        return []
    lower = orders[-1] if orders else 0
    if fixed:
        k, demand = fixed[0]
        return [] if k in orders else [(sp.Integer(k), demand / (sp.factorial(k) * slope**k))]
    whole = [sp.Integer(n) for n in range(1, lower) if n not in orders]
    return [((sp.Integer(lower), sp.oo), None), *((n, None) for n in whole)]


def _with_conditions_elsewhere(system, amplitude, exponent, factor, elsewhere, n) -> list[Solution]:
    x = system.problem.variable
    base, _ = system.shape.power
    symbol = Parameter(n.name, *exponent) if isinstance(exponent, tuple) else exponent
    free = {symbol: exponent} if isinstance(exponent, tuple) else {}
    remaining = list(elsewhere)
    if factor is None:
        condition, demand = remaining.pop(0)
        unit = sp.diff(base**symbol, x, condition.order).subs(x, condition.at)
        factor = (demand - (amplitude if condition.order == 0 else 0)) / unit
    if remaining and free:
        return _with_exponent(system, amplitude, factor, remaining, n, exponent)
    return [Solution(amplitude + factor * base**symbol, sp.S.One, free)]


def _with_exponent(system, amplitude, factor, remaining, n, range_) -> list[Solution]:
    """Two conditions elsewhere fix the exponent: (base1/base2)**n, or n itself, equals a known ratio."""
    if len(remaining) > 1:
        raise Undecided("more than two conditions away from the base's zero leave no exponent in closed form")
    x = system.problem.variable
    base, _ = system.shape.power
    condition, demand = remaining[0]
    value = sp.diff(amplitude + factor * base**n, x, condition.order).subs(x, condition.at)
    ratio = sp.powsimp(sp.simplify(value - demand), force=True)
    try:
        roots = sp.solve(ratio, n)
    except NotImplementedError:
        raise Undecided("the exponent has no closed form") from None
    low, high = range_
    kept = [r for r in roots if r.is_real is not False and all(low < v < high for v in sampled(r))]
    return [Solution(amplitude + factor.subs(n, r) * base**r, sp.S.One) for r in kept]
