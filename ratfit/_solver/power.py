"""The power route: A + B*base**n, whose exponent the conditions at the base's zero bound from below and leave open."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from ratfit._condition import AbstractPointCondition
from ratfit._field import is_zero
from ratfit._generators import sampled
from ratfit._jets import same
from ratfit._parse import RatfitError
from ratfit._solver.naming import Meaning, named, names_of
from ratfit._solver.solution import Solution, Undecided
from ratfit._system import System
from ratfit._target import INSIDE, Parameter, sample_values

Demand = tuple[AbstractPointCondition, sp.Expr]


@dataclass(frozen=True)
class Exponent:
    """An exponent that the conditions at the base's zero allow: `symbol` with its open range, or a number.

    `factor` is B where these conditions fix it, else None.
    """

    symbol: sp.Expr
    range: tuple[sp.Expr, sp.Expr] | None
    factor: sp.Expr | None


def solve_power(system: System) -> list[Solution]:
    """All A + B*base**n that satisfy value and derivative conditions.

    Arguments: a system whose form is a Power, with a value at the base's zero c (it gives A). Conditions at c bound
    n from below; one condition elsewhere gives B, two give n. Raises RatfitError for conditions of other kinds,
    Undecided where nothing or too much is asked elsewhere than at c.
    """
    assert system.shape.power is not None
    x, (base, n) = system.problem.variable, system.shape.power
    c = sp.solve(base, x)[0]
    points = [
        (k, d) for k, d in zip(system.conditions, system.demands, strict=True) if isinstance(k, AbstractPointCondition)
    ]
    if len(points) < len(system.conditions) or system.shape.factor != 1:
        raise RatfitError("the power route takes values and derivatives of A + B*base**n without a factor")
    at_zero = {k.order: d for k, d in points if same(k.at, c)}
    elsewhere = sorted(((k, d) for k, d in points if not same(k.at, c)), key=lambda p: p[0].order)
    if 0 not in at_zero:
        raise RatfitError(f"the power route needs a value at {x} = {c}, where the base {base} vanishes")
    # What simplifying makes of roots, the root of a product say, the exact field could not tell from them.
    meaning = names_of(system.demands)
    (amplitude,) = named([at_zero.pop(0)], meaning)
    elsewhere = [(k, *named([d], meaning)) for k, d in elsewhere]
    if not elsewhere:
        raise Undecided(f"nothing fixes the factor of the power; add a value at another place than {x} = {c}")
    found = []
    for exponent in _exponents(at_zero, sp.diff(base, x), n.name):
        found += _fitted(system, amplitude, exponent, elsewhere, meaning)
    return found


def _exponents(demands: dict[int, sp.Expr], slope: sp.Expr, name: str) -> list[Exponent]:
    """The exponents that derivatives at the base's zero allow.

    base**n has a k-th derivative of zero there for every real n > k, and for the whole numbers n < k; it has one
    that is not zero for n = k alone.
    """
    vanishing = sorted(k for k, d in demands.items() if is_zero(d) is not False)
    fixed = [(k, d) for k, d in sorted(demands.items()) if k not in vanishing]
    if len(fixed) > 1:
        return []
    if fixed:
        k, demand = fixed[0]
        return [Exponent(sp.Integer(k), None, demand / (sp.factorial(k) * slope**k))]
    lower = vanishing[-1] if vanishing else 0
    whole = [Exponent(sp.Integer(k), None, None) for k in range(1, lower) if k not in vanishing]
    range_ = (sp.Integer(lower), sp.oo)
    return [Exponent(Parameter(name, *range_), range_, None), *whole]


def _fitted(
    system: System,
    amplitude: sp.Expr,
    exponent: Exponent,
    elsewhere: list[Demand],
    meaning: Meaning,
) -> list[Solution]:
    """B from the first condition elsewhere, and a free exponent from the second.

    `meaning` holds what the names in the amplitude and the demands stand for.
    """
    assert system.shape.power is not None
    x, (base, _) = system.problem.variable, system.shape.power
    factor, remaining = exponent.factor, list(elsewhere)
    if factor is None:
        condition, demand = remaining.pop(0)
        unit = sp.diff(base**exponent.symbol, x, condition.order).subs(x, condition.at)
        factor = (demand - (amplitude if condition.order == 0 else 0)) / unit
    if exponent.range is None or not remaining:
        numbers = amplitude.xreplace(meaning), factor.xreplace(meaning)
        return [_solution(system, *numbers, exponent.symbol, exponent.range)]
    if len(remaining) > 1:
        raise Undecided("more than two conditions away from the base's zero leave no exponent in closed form")
    roots = _exponent_roots(system, amplitude, factor, remaining[0], exponent)
    low, high = exponent.range
    found = []
    for root in roots:
        number, whole = root.xreplace(meaning), factor.subs(exponent.symbol, root).xreplace(meaning)
        if not number.has(sp.I) and all(low < v < high for v in sampled(number)):
            found.append(_solution(system, amplitude.xreplace(meaning), whole, number, None))
    return found


def _exponent_roots(
    system: System, amplitude: sp.Expr, factor: sp.Expr, second: Demand, exponent: Exponent
) -> list[sp.Expr]:
    """The exponents at which a second condition elsewhere holds too, whether they lie in the range or not."""
    assert system.shape.power is not None
    x, (base, _) = system.problem.variable, system.shape.power
    condition, demand = second
    n = sp.Dummy("n", real=True)
    value = sp.diff(amplitude + factor.subs(exponent.symbol, n) * base**n, x, condition.order).subs(x, condition.at)
    equation = sp.powsimp(sp.expand(sp.simplify(value - demand)), force=True)
    try:
        return sp.solve(equation, n)
    except NotImplementedError:
        raise Undecided("the exponent has no closed form") from None


def _solution(
    system: System,
    amplitude: sp.Expr,
    factor: sp.Expr,
    exponent: sp.Expr,
    range_: tuple[sp.Expr, sp.Expr] | None,
) -> Solution:
    assert system.shape.power is not None
    base, _ = system.shape.power
    nature = "" if exponent.is_Integer else _complex_power(system, base)
    free = {exponent: range_} if range_ is not None else {}
    return Solution(amplitude + factor * base**exponent, sp.S.One, free, nature)


def _complex_power(system: System, base: sp.Expr) -> str:
    """A real power needs a base that is nowhere negative on the support; it is linear, so its ends decide."""
    for end in system.problem.support():
        place = base.subs(system.problem.variable, end)
        if any(place.xreplace(values) < 0 for values in sample_values(place.free_symbols, INSIDE)):
            return f"complex: the base {base} is negative at {system.problem.variable} = {end}"
    return ""
