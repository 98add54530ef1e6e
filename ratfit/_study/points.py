"""Zeros, extrema and inflections inside the domain: seen by numbers, then put in closed form where that is proved."""

from __future__ import annotations

from collections.abc import Iterator

import mpmath
import sympy as sp

from ratfit._study.clock import Clock
from ratfit._study.closed import closed_kink, closed_place, inside, shorter
from ratfit._study.crossings import WORK, Scans
from ratfit._study.curve import SHOWN, Curve, agrees, decimal, growth, shown
from ratfit._study.ends import condition_at
from ratfit._study.fact import SYMBOLIC, Fact

NUMERIC = f"numeric to {SHOWN} digits"


def zero_facts(scans: Scans) -> Iterator[Fact]:
    """Zeros with their multiplicity: where the target changes its sign, and where it touches zero."""
    curve = scans.curve
    places = [c.place for c in scans.scan(0).crossings if c.nature == "zero"]
    places += [c.place for c in scans.scan(1).crossings if c.nature != "pole" and _is_zero_at(curve, c.place)]
    for place in sorted(places):
        yield from _zero(scans, place)
    yield from _end_zeros(curve)


def _is_zero_at(curve: Curve, place: mpmath.mpf) -> bool:
    number = curve.number(0)
    with mpmath.workdps(WORK):
        near, far = number(place), number(place + mpmath.mpf("1e-3"))
        return near is not None and far is not None and abs(near) < mpmath.mpf("1e-35") * abs(far)


def _zero(scans: Scans, place: mpmath.mpf) -> Iterator[Fact]:
    curve, clock = scans.curve, scans.clock
    closed = _closed(scans, curve.target.expression, place)
    multiplicity = growth(curve.number(0), place, 1) or sp.S.One
    often = "" if multiplicity == 1 else f", of order {multiplicity}"
    orders = range(max(1, int(sp.floor(multiplicity)))) if multiplicity.is_Integer else range(1)
    for order in orders:
        mark = f"f{chr(39) * order}"
        yield _stated(curve, clock, "zero", place, closed, order, sp.S.Zero, f"{mark}({{}}) = 0{often}")


def _closed(scans: Scans, equation: sp.Expr, place: mpmath.mpf) -> sp.Expr | None:
    """The closed form of a zero of the equation, or else of a kink."""
    closed = closed_place(scans.curve, equation, place, scans.clock) if equation.has(scans.curve.x) else None
    return closed if closed is not None else closed_kink(scans.curve, place, scans.clock)


def _end_zeros(curve: Curve) -> Iterator[Fact]:
    """Zeros at the ends: their order; the condition stands among the values."""
    for end, place, side in zip(curve.target.domain, curve.ends, (1, -1), strict=True):
        order = None if end.is_infinite else growth(curve.number(0), place, side)
        if order is not None and order > 0:
            text = f"f({end}) = 0, of order {order}{curve.label}"
            yield Fact("zero", text, None, "numeric, the growth on the way from the end", end, sp.S.Zero)


def extremum_facts(scans: Scans) -> Iterator[Fact]:
    """Maxima and minima inside the domain: smooth ones, kinks and cusps."""
    curve, clock = scans.curve, scans.clock
    for crossing in scans.scan(1).crossings:
        if any(abs(crossing.place - broken) < mpmath.mpf("1e-30") for broken in scans.breaks):
            continue
        kind = "maximum" if crossing.before > 0 else "minimum"
        smooth = crossing.nature == "zero"
        closed = _closed(scans, curve.expression(1) if smooth else sp.S.One, crossing.place)
        what = "" if smooth else " in a kink" if crossing.nature == "jump" else " in a cusp"
        yield _height(curve, clock, kind, crossing.place, closed, f"{kind} f({{}}) = {{}}{what}")
        if smooth:
            yield _stated(curve, clock, kind, crossing.place, closed, 1, sp.S.Zero, "f'({}) = 0")


def inflection_facts(scans: Scans) -> Iterator[Fact]:
    """Inflections inside the domain: where the second derivative changes its sign, the target being finite."""
    curve, clock = scans.curve, scans.clock
    broken = (*scans.breaks, *scans.kinks)
    for crossing in scans.scan(2).crossings:
        if any(abs(crossing.place - place) < mpmath.mpf("1e-30") for place in broken):
            continue
        closed = _closed(scans, curve.expression(2), crossing.place)
        yield _height(curve, clock, "inflection", crossing.place, closed, "inflection f({}) = {}")
        if crossing.nature == "zero":
            yield _slope(curve, clock, crossing.place, closed)
            yield _stated(curve, clock, "inflection", crossing.place, closed, 2, sp.S.Zero, "f''({}) = 0")


def _height(
    curve: Curve, clock: Clock, kind: str, place: mpmath.mpf, closed: sp.Expr | None, text: str, order: int = 0
) -> Fact:
    """The value (or slope) at a place, in closed form where place and value have one."""
    if closed is not None:
        value = clock.attempt(lambda: curve.target.derivative(closed, order))
        if value is not None and agrees(curve, curve.expression(order), closed, 1, value):
            value = shorter(value, clock)
            condition = condition_at(closed, order) if inside(closed, curve.target) else None
            return Fact(kind, text.format(closed, value), condition, SYMBOLIC, closed, value)
    with mpmath.workdps(WORK):
        found = curve.number(order)(place)
    if found is None:
        return Fact(kind, text.format(shown(place), "?") + curve.label, None, NUMERIC, decimal(place))
    value = decimal(found)
    at = closed if closed is not None else decimal(place)
    condition = None if curve.middle else condition_at(at, order, value)
    where = closed if closed is not None else shown(place)
    return Fact(kind, text.format(where, shown(found)) + curve.label, condition, NUMERIC, at, value)


def _slope(curve: Curve, clock: Clock, place: mpmath.mpf, closed: sp.Expr | None) -> Fact:
    return _height(curve, clock, "inflection", place, closed, "f'({}) = {}", 1)


def _stated(
    curve: Curve,
    clock: Clock,
    kind: str,
    place: mpmath.mpf,
    closed: sp.Expr | None,
    order: int,
    value: sp.Expr,
    text: str,
) -> Fact:
    """A derivative that vanishes at a place: exactly there where the place has a closed form, else nearly."""
    if closed is not None:
        return Fact(kind, text.format(closed), condition_at(closed, order, value), SYMBOLIC, closed, value)
    at = decimal(place)
    condition = None if curve.middle else condition_at(at, order, value)
    return Fact(kind, text.format(shown(place)) + curve.label, condition, NUMERIC, at, value)
