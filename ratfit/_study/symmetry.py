"""Parity about 0, and reflection about the middle of the domain."""

from __future__ import annotations

from collections.abc import Iterator

import mpmath
import sympy as sp

from ratfit._multiprecise import multiprecise
from ratfit._study.clock import Clock
from ratfit._study.closed import shorter
from ratfit._study.curve import DIGITS, SHOWN, Curve, numbers_of
from ratfit._study.fact import SYMBOLIC, Fact

PLACES = ("1/97", "1/7", "2/7", "41/97", "4/7", "5/7", "6/7", "96/97")

_DISTANCE = sp.Dummy("distance", real=True)


def symmetry_facts(curve: Curve, clock: Clock) -> Iterator[Fact]:
    """Odd, even, and symmetric about the middle, each proved, or seen at some places to 30 digits."""
    low, high = curve.target.domain
    # Infinite domains have no middle but 0, a half-line none at all: its parity is that of the formula.
    middle = sp.S.Zero if sp.oo in (-low, high) else shorter((low + high) / 2, clock)
    parity = _mirrored(curve, clock, sp.S.Zero)
    if parity is not None:
        yield parity
    if middle != 0 and (reflection := _mirrored(curve, clock, middle)) is not None:
        yield reflection


def _mirrored(curve: Curve, clock: Clock, middle: sp.Expr) -> Fact | None:
    moved = curve.target.expression.xreplace({curve.x: middle + _DISTANCE})
    other = curve.target.expression.xreplace({curve.x: middle - _DISTANCE})
    if _seen(curve, moved - other):
        found = _how(moved - other, clock)
        if middle == 0:
            return Fact("parity", f"even: f(-{curve.x}) = f({curve.x})", None, found, middle, form=("parity", "even"))
        inner = f"({curve.x} - ({middle}))**2" if middle.is_Add else f"({curve.x - middle})**2"
        text = f"symmetric about {curve.x} = {middle}: f({2 * middle - curve.x}) = f({curve.x})"
        return Fact("reflection", text, None, found, middle, form=("of", inner))
    if middle == 0:
        if not _seen(curve, moved + other):
            return None
        text = f"odd: f(-{curve.x}) = -f({curve.x})"
        return Fact("parity", text, None, _how(moved + other, clock), middle, form=("parity", "odd"))
    return _point_symmetric(curve, clock, middle, moved + other)


def _point_symmetric(curve: Curve, clock: Clock, middle: sp.Expr, total: sp.Expr) -> Fact | None:
    """f(a + b - x) = f(a) + f(b) - f(x): the total of both sides does not change with the distance."""
    height = clock.attempt(lambda: curve.target.derivative(middle, 0))
    if height is None or not _seen(curve, total - 2 * height):
        return None
    height = shorter(height, clock)
    around = f"({middle}, {height})"
    text = f"symmetric about the point {around}: f({2 * middle - curve.x}) = {2 * height} - f({curve.x})"
    return Fact("reflection", text, None, _how(total - 2 * height, clock), middle, height)


def _seen(curve: Curve, difference: sp.Expr) -> bool:
    """Whether a difference vanishes to 40 digits at places spread over the domain and the parameters."""
    low, high = curve.ends
    reach = 3 if mpmath.isinf(low) or mpmath.isinf(high) else max(abs(low), abs(high))
    for values in curve.samples():
        number = numbers_of(difference.xreplace(values), _DISTANCE)
        with mpmath.workdps(DIGITS):
            found = [number(reach * multiprecise(p)) for p in map(sp.Rational, PLACES)]
        if any(value is None or abs(value) > mpmath.mpf("1e-40") for value in found):
            return False
    return True


def _how(difference: sp.Expr, clock: Clock) -> str:
    if difference == 0 or clock.attempt(lambda: sp.expand(difference)) == 0:
        return SYMBOLIC
    if clock.attempt(lambda: sp.simplify(difference)) == 0:
        return SYMBOLIC
    return f"numeric to {SHOWN} digits at {len(PLACES)} places"
