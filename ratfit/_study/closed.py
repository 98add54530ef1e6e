"""Closed forms: a number recognised, and proved to be what it looks like."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import mpmath
import sympy as sp

from ratfit._field import is_zero
from ratfit._generators import sampled
from ratfit._multiprecise import multiprecise
from ratfit._parse import RatfitError, parse_expression
from ratfit._solver import normal, plain
from ratfit._study.clock import Clock
from ratfit._study.crossings import kinked_arguments
from ratfit._study.curve import DIGITS, Curve
from ratfit._target import Target, sample_values

LARGEST = 10**5
"""Largest denominator of a recognised fraction: at 42 digits, 30 more than it has, chance plays no part."""

SLACK = mpmath.mpf(10) ** -42
TINY = mpmath.mpf(10) ** -40

# (what undoes it, what it is): p = q*unit, or p = function(q), for a fraction q
_UNITS = (
    sp.S.One,
    sp.pi,
    sp.sqrt(sp.pi),
    sp.E,
    sp.log(2),
    sp.log(3),
    sp.log(5),
    sp.sqrt(2),
    sp.sqrt(3),
    sp.GoldenRatio,
)
_INVERSES: tuple[tuple[Callable, Callable], ...] = (
    (lambda p: p * p, sp.sqrt),
    (lambda p: p**3, sp.cbrt),
    (lambda p: p * p / mpmath.pi, lambda q: sp.sqrt(q * sp.pi)),
    (mpmath.exp, sp.log),
    (mpmath.log, sp.exp),
    (mpmath.tan, sp.atan),
    (mpmath.cos, sp.acos),
    (mpmath.tanh, sp.atanh),
    (mpmath.sinh, sp.asinh),
)


def recognised(number: mpmath.mpf) -> Iterator[sp.Expr]:
    """Expressions that agree with a number, known to 50 digits, to 42 of them; none of them is proved."""
    with mpmath.workdps(DIGITS):
        size, sign = abs(number), int(mpmath.sign(number))
        if size < TINY:
            yield sp.S.Zero
            return
        for unit in _UNITS:
            if (q := _fraction(size / multiprecise(unit))) is not None:
                yield sign * q * unit
        for undone, function in _INVERSES:
            image = undone(size)
            if mpmath.isfinite(image) and (q := _fraction(image)) is not None:
                yield from _agreeing(sign * function(q), number)
        yield from _quadratic(number)


def _fraction(number: mpmath.mpf) -> sp.Rational | None:
    """The convergent of a continued fraction that meets the number, not larger than the largest."""
    if not mpmath.mpf(10) ** -8 < abs(number) < 10**8:
        return None
    best = sp.Rational(str(number)).limit_denominator(LARGEST)
    return best if abs(number - multiprecise(best)) < SLACK * (1 + abs(number)) else None


def _quadratic(number: mpmath.mpf) -> Iterator[sp.Expr]:
    coefficients = mpmath.findpoly(number, 2, maxcoeff=1000, tol=SLACK)
    if coefficients:
        for root in sp.roots(sp.Poly(coefficients, sp.Dummy("root"))):
            yield from _agreeing(root, number)


def _agreeing(closed: sp.Expr, number: mpmath.mpf) -> Iterator[sp.Expr]:
    if closed.is_real and abs(multiprecise(closed) - number) < TINY * (1 + abs(number)):
        yield closed


def proved_zero(expression: sp.Expr, clock: Clock) -> bool:
    """Whether an expression of constants and parameters is zero by algebra, and by numbers at 50 digits."""
    if expression == 0:
        return True
    if expression.has(sp.nan, sp.zoo, sp.oo, -sp.oo):
        return False
    numbers = clock.attempt(lambda: sampled(expression))
    if numbers is None or any(abs(value) > TINY for value in numbers):
        return False
    if clock.attempt(lambda: is_zero(expression)):
        return True
    return clock.attempt(lambda: sp.simplify(expression)) == 0


def closed_place(curve: Curve, equation: sp.Expr, place: mpmath.mpf, clock: Clock) -> sp.Expr | None:
    """The closed form of a place at which `equation` is seen to vanish, proved for all values of the parameters."""
    at_hand = (closed for closed in recognised(place) if _vanishes(equation, curve.x, closed, clock))
    if (closed := next(at_hand, None)) is not None:
        return closed
    for solution in _solutions(curve, equation, clock):
        if _is_the_place(curve, solution, place, clock) and _vanishes(equation, curve.x, solution, clock):
            return solution
    return None


def closed_kink(curve: Curve, place: mpmath.mpf, clock: Clock) -> sp.Expr | None:
    """The closed form of a place at which something inside Abs, Min, Max or a step changes its sign."""
    for argument in kinked_arguments(curve):
        if (closed := closed_place(curve, argument, place, clock)) is not None:
            return closed
    return None


def _vanishes(equation: sp.Expr, x: sp.Symbol, place: sp.Expr, clock: Clock) -> bool:
    return proved_zero(equation.xreplace({x: place}), clock)


def _solutions(curve: Curve, equation: sp.Expr, clock: Clock) -> list[sp.Expr]:
    key = (equation, curve.x)
    if key not in clock.solved:
        found = clock.attempt(lambda: sp.solve(equation, curve.x), seconds=0.8)
        clock.solved[key] = [s for s in found or [] if isinstance(s, sp.Expr)]
    return clock.solved[key]


def _is_the_place(curve: Curve, solution: sp.Expr, place: mpmath.mpf, clock: Clock) -> bool:
    """Whether a solution is the place seen at the middle of the parameters, and stays in the domain elsewhere."""
    if solution.free_symbols - set(curve.parameters) or not readable(solution):
        return False
    with mpmath.workdps(DIGITS):
        here = clock.attempt(lambda: multiprecise(solution.xreplace(curve.middle)))
        if here is None or abs(here - place) > TINY * (1 + abs(place)):
            return False
    return clock.attempt(lambda: inside(solution, curve.target)) is True


def readable(expression: sp.Expr) -> bool:
    """Whether ratfit's grammar has words for an expression: not for CRootOf or LambertW."""
    try:
        parse_expression(str(expression), {s.name: s for s in expression.free_symbols}, "place")
    except RatfitError:
        return False
    return True


def inside(place: sp.Expr, target: Target) -> bool:
    """Whether a place lies in the closed domain for all sampled values of the parameters."""
    low, high = target.domain
    for values in sample_values(place.free_symbols | low.free_symbols | high.free_symbols):
        if not (low.xreplace(values) <= place.xreplace(values) <= high.xreplace(values)):
            return False
    return True


def shorter(expression: sp.Expr, clock: Clock) -> sp.Expr:
    """The expression without squares in its roots, in the exact field's form, or simplified, where that is shorter."""
    if expression.is_Atom or expression.is_Rational:
        return expression
    for way in (plain, normal):
        found = clock.attempt(partial(way, expression))
        if found is not None and len(str(found)) < len(str(expression)):
            expression = found
    simple = clock.attempt(lambda: sp.simplify(expression), seconds=0.5)
    if simple is None or len(str(simple)) >= len(str(expression)) or _depth(simple) > _depth(expression):
        return expression
    return simple


def _depth(expression: sp.Basic) -> int:
    return 1 + max((_depth(part) for part in expression.args), default=0)
