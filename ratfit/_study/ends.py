"""Values, slopes and curvatures at the finite ends of the domain."""

from __future__ import annotations

from collections.abc import Iterator

import mpmath
import sympy as sp

from ratfit._condition import Derivative, Value
from ratfit._poles import endpoint, multiprecise
from ratfit._study.clock import Clock
from ratfit._study.closed import shorter
from ratfit._study.curve import DIGITS, SHOWN, Curve, decimal, growth, numbers_of, tends_to
from ratfit._study.fact import SYMBOLIC, Fact

KINDS = ("value", "slope", "curvature")
MARKS = ("f", "f'", "f''")


def end_facts(curve: Curve, clock: Clock) -> Iterator[Fact]:
    """Value and first two derivatives at both ends, from inside the domain."""
    for end, side in zip(curve.target.domain, (1, -1), strict=True):
        if not end.is_infinite:
            yield from _at_end(curve, clock, end, side)


def _at_end(curve: Curve, clock: Clock, end: sp.Expr, side: int) -> Iterator[Fact]:
    for order in range(3):
        where = f"{MARKS[order]} at {curve.x} = {end}"
        value = clock.attempt(lambda k=order: curve.target.derivative(end, k), where, 1.5)  # type: ignore[misc]
        if value is not None and confirmed(curve, order, end, side, value):
            value = shorter(value, clock)
            text = f"{MARKS[order]}({end}) = {value}"
            yield Fact(KINDS[order], text, condition_at(end, order), SYMBOLIC, end, value)
            continue
        fact = _by_numbers(curve, end, side, order)
        if fact is None:
            clock.notes.append(f"{where}: no limit found, neither by sympy nor by numbers")
            return
        yield fact
        if fact.value is None:
            return  # infinite: the derivatives that follow are too


def condition_at(place: sp.Expr, order: int, equals: sp.Expr | None = None) -> Value | Derivative:
    """A value, or a derivative where the order is not 0."""
    return Derivative(place, order, equals) if order else Value(place, equals)


def confirmed(curve: Curve, order: int, place: sp.Expr, side: int, value: sp.Expr) -> bool:
    """Whether numbers on the way to the place tend to the value, for three values of each parameter."""
    for values in curve.samples():
        number = numbers_of(curve.expression(order).xreplace(values), curve.x)
        with mpmath.workdps(3 * DIGITS):
            if not tends_to(number, endpoint(place.xreplace(values)), side, multiprecise(value.xreplace(values))):
                return False
    return True


def _by_numbers(curve: Curve, end: sp.Expr, side: int, order: int) -> Fact | None:
    """What numbers say about an end where sympy says nothing: infinite with its growth, or a value to some digits."""
    number, place = curve.number(order), curve.ends[0 if side == 1 else 1]
    with mpmath.workdps(3 * DIGITS):
        near, mid, far = (number(place + side * mpmath.mpf(10) ** -k) for k in (40, 30, 10))
    if near is None or mid is None or far is None:
        return None
    if abs(near) > 1.05 * abs(mid) > 1.05 * abs(far):
        return _infinite(curve, end, side, order, near > 0)
    off = abs(near - mid)
    if off > mpmath.mpf("1e-8") * (1 + abs(near)):
        return None
    digits = SHOWN if off == 0 else min(SHOWN, int(-mpmath.log10(off / (1 + abs(near)))))
    value = decimal(near, digits)
    condition = None if curve.middle else condition_at(end, order, value)
    text = f"{MARKS[order]}({end}) = {mpmath.nstr(near, 12)}{curve.label}"
    return Fact(KINDS[order], text, condition, f"numeric to {digits} digits", end, value)


def _infinite(curve: Curve, end: sp.Expr, side: int, order: int, positive: bool) -> Fact:
    exponent = growth(curve.number(order), curve.ends[0 if side == 1 else 1], side)
    distance = curve.x if end == 0 else curve.x - end if side == 1 else end - curve.x
    text = f"{MARKS[order]}({end}{'+' if side == 1 else '-'}) = {'' if positive else '-'}oo"
    if exponent is not None and exponent < 0:
        what = MARKS[0] if order == 0 or exponent + order <= 0 else f"f - f({end})"
        text += f", {what if order else 'f'} grows like {sp.Pow(distance, exponent + order)}"
    return Fact(KINDS[order], text + curve.label, None, "numeric, the growth on the way to the end", end)
