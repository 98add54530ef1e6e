"""Poles in the closed domain: order, the coefficient that a Limit keeps, and the constant behind a simple one."""

from __future__ import annotations

from collections.abc import Iterator

import mpmath
import sympy as sp

from ratfit._condition import Limit
from ratfit._study.closed import closed_place, shorter
from ratfit._study.crossings import Scans
from ratfit._study.curve import SHOWN, Curve, agrees, decimal, growth, shown
from ratfit._study.fact import SYMBOLIC, Fact


def pole_facts(scans: Scans) -> Iterator[Fact]:
    """Places where the target grows like a power without bound, at the ends of the domain too."""
    curve = scans.curve
    seen: list[mpmath.mpf] = []
    for place, closed, side in [*_ends(curve), *_inner(scans)]:
        exponent = growth(curve.number(0), place, side)
        if exponent is None or exponent >= 0 or any(abs(place - other) < mpmath.mpf("1e-30") for other in seen):
            continue
        seen.append(place)
        pole = _pole(scans, place, closed, -exponent)
        yield pole
        if exponent == -1 and isinstance(pole.condition, Limit):
            yield from _behind(scans, pole.condition)


def _ends(curve: Curve) -> Iterator[tuple[mpmath.mpf, sp.Expr | None, int]]:
    for end, place, side in zip(curve.target.domain, curve.ends, (1, -1), strict=True):
        if not end.is_infinite:
            yield place, end, side


def _inner(scans: Scans) -> Iterator[tuple[mpmath.mpf, sp.Expr | None, int]]:
    """Where the target or its slope changes its sign at a pole: one of odd and of even order."""
    for order in (0, 1):
        for crossing in scans.scan(order).crossings:
            if crossing.nature == "pole":
                yield crossing.place, None, 1


def _pole(scans: Scans, place: mpmath.mpf, closed: sp.Expr | None, order: sp.Rational) -> Fact:
    curve, clock = scans.curve, scans.clock
    if closed is None:
        inverse = clock.attempt(lambda: sp.together(1 / curve.target.expression)) or 1 / curve.target.expression
        closed = closed_place(curve, inverse, place, clock)
    kind = "pole" if order.is_Integer else "singularity"
    if closed is None:
        text = f"{kind} of order {order} at {shown(place)}{curve.label}"
        return Fact(kind, text, None, f"numeric to {SHOWN} digits", decimal(place))
    distance = curve.x - closed if closed != curve.target.domain[1] or order.is_Integer else closed - curve.x
    scale = distance**order
    what = f"the coefficient of the pole at {closed}"
    coefficient = clock.attempt(lambda: curve.target.limit(closed, scale, sp.S.Zero), what, 1.5)
    side = -1 if closed == curve.target.domain[1] else 1
    if coefficient is None or not agrees(curve, curve.target.expression * scale, closed, side, coefficient):
        return Fact(kind, f"{kind} of order {order} at {closed}{curve.label}", None, "numeric, its growth", closed)
    coefficient = shorter(coefficient, clock)
    condition = Limit(closed, scale=scale, equals=coefficient)
    text = f"{kind} of order {order} at {closed}: {condition.what} -> {coefficient}"
    return Fact(kind, text, condition, SYMBOLIC, closed, coefficient)


def _behind(scans: Scans, pole: Limit) -> Iterator[Fact]:
    """The constant that a simple pole leaves where it is taken away."""
    curve, clock, at = scans.curve, scans.clock, pole.at
    assert pole.equals is not None
    minus = pole.equals / (curve.x - at)
    constant = clock.attempt(lambda: curve.target.limit(at, sp.S.One, minus), seconds=1.5)
    side = -1 if at == curve.target.domain[1] else 1
    if constant is None or not agrees(curve, curve.target.expression - minus, at, side, constant):
        return
    constant = shorter(constant, clock)
    condition = Limit(at, minus=minus, equals=constant)
    yield Fact(
        "remainder", f"behind the pole at {at}: {condition.what} -> {constant}", condition, SYMBOLIC, at, constant
    )
