"""Values, slopes and curvatures at the finite ends of the domain."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise

import mpmath
import sympy as sp

from ratfit._condition import Derivative, Value
from ratfit._multiprecise import endpoint
from ratfit._study.clock import Clock
from ratfit._study.closed import shorter
from ratfit._study.curve import FINE, SHOWN, Curve, Number, agrees, decimal, exponent_of, growth, numbers_of, shown
from ratfit._study.fact import SYMBOLIC, Fact

KINDS = ("value", "slope", "curvature")
MARKS = ("f", "f'", "f''")

LIMIT_SECONDS = 4.0
"""How long a limit at an end may take: the curvature of a metal's Fresnel factor takes two and a half."""


def end_facts(curve: Curve, clock: Clock) -> Iterator[Fact]:
    """Value and first two derivatives at both ends, from inside the domain; values first, found soonest."""
    ends = [(end, side) for end, side in zip(curve.target.domain, (1, -1), strict=True) if not end.is_infinite]
    for order in range(3):
        finite = []
        for end, side in ends:
            fact = _at_end(curve, clock, end, side, order)
            if fact is None:
                clock.notes.append(f"{_where(curve, end, order)}: no limit found, neither by sympy nor by numbers")
                continue
            yield fact
            if fact.value is not None:  # infinite otherwise: the derivatives that follow are too
                finite.append((end, side))
        ends = finite


def by_end(facts: Iterable[Fact], low: sp.Expr) -> list[Fact]:
    """The facts, those of the lower end before those of the upper one, and both before the others."""
    return sorted(facts, key=lambda fact: 2 if fact.kind not in KINDS else int(fact.place != low))


def _at_end(curve: Curve, clock: Clock, end: sp.Expr, side: int, order: int) -> Fact | None:
    value = None
    if not _is_infinite(curve, side, order):  # sympy would look long for a limit that is not there
        value = clock.attempt(lambda: curve.target.derivative(end, order), _where(curve, end, order), LIMIT_SECONDS)
    if value is None or not agrees(curve, curve.expression(order), end, side, value):
        return _by_numbers(curve, end, side, order)
    value = shorter(value, clock)
    return Fact(KINDS[order], f"{MARKS[order]}({end}) = {value}", condition_at(end, order), SYMBOLIC, end, value)


def _where(curve: Curve, end: sp.Expr, order: int) -> str:
    return f"{MARKS[order]} at {curve.x} = {end}"


def condition_at(place: sp.Expr, order: int, equals: sp.Expr | None = None) -> Value | Derivative:
    """A value, or a derivative where the order is not 0."""
    return Derivative(place, order, equals) if order else Value(place, equals)


def _by_numbers(curve: Curve, end: sp.Expr, side: int, order: int) -> Fact | None:
    """What numbers say about an end where sympy says nothing: infinite with its growth, or a value to some digits."""
    number, place = curve.number(order), curve.ends[0 if side == 1 else 1]
    samples = curve.all_samples() if curve.middle else curve.samples()
    if all(_vanishes(curve, values, side, order) for values in samples):
        settings = f" at {len(samples)} values of the parameters" if curve.middle else ""
        found = f"numeric, falls off like a power{settings}"
        return Fact(
            KINDS[order], f"{MARKS[order]}({end}) = 0", condition_at(end, order, sp.S.Zero), found, end, sp.S.Zero
        )
    with mpmath.workdps(FINE):
        near, mid, far = (number(place + side * mpmath.mpf(10) ** -k) for k in (40, 30, 10))
    if near is None or mid is None or far is None:
        return None
    if abs(near) > 1.05 * abs(mid) > 1.05 * abs(far):
        return _infinite(curve, end, side, order, near > 0) if _grows(number, place, side) else None
    off = abs(near - mid)
    if off > mpmath.mpf("1e-8") * (1 + abs(near)):
        return None
    digits = SHOWN if off == 0 else min(SHOWN, int(-mpmath.log10(off / (1 + abs(near)))))
    near = mpmath.mpf(0) if abs(near) < mpmath.mpf(10) ** -digits else near
    value = decimal(near, digits)
    condition = None if curve.middle else condition_at(end, order, value)
    text = f"{MARKS[order]}({end}) = {shown(near)}{curve.label}"
    return Fact(KINDS[order], text, condition, f"numeric to {digits} digits", end, value)


def _grows(number: Number, place: mpmath.mpf, side: int) -> bool:
    """Whether a function grows on the whole way to a place with one sign: what oscillates there grows at some steps."""
    with mpmath.workdps(FINE):
        values = [number(place + side * mpmath.mpf(10) ** -(mpmath.mpf(k) * 27 / 10)) for k in range(3, 15)]
    known = [value for value in values if value is not None]
    one_sign = len(known) == len(values) and (all(v > 0 for v in known) or all(v < 0 for v in known))
    return one_sign and all(abs(a) <= abs(b) for a, b in pairwise(known))


def _vanishes(curve: Curve, values: dict[sp.Symbol, sp.Expr], side: int, order: int) -> bool:
    number = numbers_of(curve.expression(order).xreplace(values), curve.x)
    with mpmath.workdps(FINE):
        place = endpoint(curve.target.domain[0 if side == 1 else 1].xreplace(values))
        exponent = exponent_of(number, place, side)
        return exponent is not None and exponent > mpmath.mpf("1e-3")


def _is_infinite(curve: Curve, side: int, order: int) -> bool:
    exponent = exponent_of(curve.number(order), curve.ends[0 if side == 1 else 1], side)
    return exponent is not None and exponent < mpmath.mpf("-1e-3")


def _infinite(curve: Curve, end: sp.Expr, side: int, order: int, positive: bool) -> Fact:
    exponent = growth(curve.number(order), curve.ends[0 if side == 1 else 1], side)
    distance = curve.x if end == 0 else curve.x - end if side == 1 else end - curve.x
    text = f"{MARKS[order]}({end}{'+' if side == 1 else '-'}) = {'' if positive else '-'}oo"
    if exponent is not None and exponent < 0:
        what = f"f - f({end})" if order and exponent + order > 0 else "f"
        text += f", {what} behaves like {sp.Pow(distance, exponent + order)}"
    return Fact(KINDS[order], text + curve.label, None, "numeric, the growth on the way to the end", end)
