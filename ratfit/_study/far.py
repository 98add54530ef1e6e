"""Limits at infinity, asymptotes, and how fast the target comes near them or grows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import mpmath
import sympy as sp

from ratfit._condition import Limit
from ratfit._study.clock import Clock
from ratfit._study.closed import shorter
from ratfit._study.curve import DIGITS, FINE, Curve, agrees, growth, numbers_of
from ratfit._study.fact import SYMBOLIC, Fact

SECONDS = 1.5


def far_facts(curve: Curve, clock: Clock) -> Iterator[Fact]:
    """What happens at oo and -oo: at an infinite end of the domain, and beyond a finite one where a limit exists."""
    for place, side in ((sp.oo, 1), (-sp.oo, -1)):
        if place in curve.target.domain:
            yield from _at_infinity(curve, clock, place, side)
        # A variable that is known to be nonnegative was simplified for that: its formula says nothing at -oo.
        elif side == 1 or not curve.x.is_nonnegative:
            yield from _beyond(curve, clock, place, side)


def _at_infinity(curve: Curve, clock: Clock, place: sp.Expr, side: int) -> Iterator[Fact]:
    value = _limit(curve, clock, place, side, sp.S.One, sp.S.Zero)
    if value is not None:
        condition = Limit(place, equals=value)
        yield Fact("limit", f"f -> {value} as {curve.x} -> {place}", condition, SYMBOLIC, place, value)
        yield from _decay(curve, clock, place, side, value)
        return
    found = list(_growth(curve, clock, place, side))
    yield from found
    if not found:
        clock.notes.append(f"no limit and no order of growth found as {curve.x} -> {place}")


def _beyond(curve: Curve, clock: Clock, place: sp.Expr, side: int) -> Iterator[Fact]:
    if curve.parameters and not _is_real_far_out(curve, side):
        return
    value = _limit(curve, clock, place, side, sp.S.One, sp.S.Zero)
    if value is not None:
        text = f"f -> {value} as {curve.x} -> {place}, beyond the domain"
        yield Fact("limit", text, Limit(place, equals=value), SYMBOLIC, place, value)
        return
    if _power(curve, side, curve.target.expression) == 1:
        yield from _oblique(curve, clock, place, side, ", beyond the domain")


def _is_real_far_out(curve: Curve, side: int) -> bool:
    with mpmath.workdps(DIGITS):
        return curve.number(0)(side * mpmath.mpf(10) ** 8) is not None


def _limit(curve: Curve, clock: Clock, place: sp.Expr, side: int, scale: sp.Expr, minus: sp.Expr) -> sp.Expr | None:
    """The limit of (f - minus)*scale, where sympy finds a finite one and numbers agree."""
    what = f"the limit as {curve.x} -> {place}" if place in curve.target.domain else ""
    value = clock.attempt(lambda: curve.target.limit(place, scale, minus), what, SECONDS)
    if value is None or value.has(sp.I) or value.free_symbols - set(curve.parameters):
        return None
    function = (curve.target.expression - minus) * scale
    if not agrees(curve, function, place, side, value):
        return None
    return shorter(value, clock)


def _power(curve: Curve, side: int, expression: sp.Expr) -> sp.Rational | None:
    """The exponent that an expression grows with far out, if it is the same for all values of the parameters."""
    found = set()
    for values in curve.samples():
        number = numbers_of(expression.xreplace(values), curve.x)
        found.add(growth(number, mpmath.mpf("inf"), side))
    return found.pop() if len(found) == 1 else None


def _decay(curve: Curve, clock: Clock, place: sp.Expr, side: int, value: sp.Expr) -> Iterator[Fact]:
    """How fast the target comes near its limit: as a power, with its coefficient, or faster."""
    rest = curve.target.expression - value
    exponent = _power(curve, side, rest)
    if exponent is not None and exponent < 0 and (side == 1 or exponent.is_Integer):
        scale = curve.x**-exponent
        coefficient = _limit(curve, clock, place, side, scale, value)
        if coefficient is not None and coefficient != 0:
            condition = Limit(place, scale=scale, minus=value, equals=coefficient)
            text = f"{condition.what} -> {coefficient} as {curve.x} -> {place}"
            yield Fact("decay", text, condition, SYMBOLIC, place, coefficient)
    elif _vanishes_fast(curve, side, rest):
        text = f"{'f' if value == 0 else f'f - {value}'} vanishes faster than any power as {curve.x} -> {place}"
        yield Fact("decay", text + curve.label, None, "numeric, at 10**2, 10**3 and 10**4", place)


def _vanishes_fast(curve: Curve, side: int, rest: sp.Expr) -> bool:
    number = numbers_of(rest.xreplace(curve.middle), curve.x)
    with mpmath.workdps(FINE):
        sizes: list[Any] = [number(side * mpmath.mpf(10) ** k) for k in (2, 3, 4)]
        if any(size is None for size in sizes) or sizes[0] == 0:
            return bool(sizes[0] == 0 and sizes[1] == 0)
        return abs(sizes[2]) < mpmath.mpf("1e-40") and abs(sizes[1]) <= abs(sizes[0]) * mpmath.mpf("1e-8")


def _growth(curve: Curve, clock: Clock, place: sp.Expr, side: int) -> Iterator[Fact]:
    exponent = _power(curve, side, curve.target.expression)
    if exponent == 1:
        yield from _oblique(curve, clock, place, side, "")
        return
    if exponent is not None and exponent > 0 and (side == 1 or exponent.is_Integer):
        scale = curve.x**-exponent
        coefficient = _limit(curve, clock, place, side, scale, sp.S.Zero)
        if coefficient is not None and coefficient != 0:
            condition = Limit(place, scale=scale, equals=coefficient)
            text = f"f grows like {coefficient * curve.x**exponent} as {curve.x} -> {place}"
            yield Fact("growth", text, condition, SYMBOLIC, place, coefficient)
            return
    yield from _other_growth(curve, place, side)


def _oblique(curve: Curve, clock: Clock, place: sp.Expr, side: int, beyond: str) -> Iterator[Fact]:
    """The slope far out, and the asymptote a*x + b."""
    slope = _limit(curve, clock, place, side, 1 / curve.x, sp.S.Zero)
    if slope is None or slope == 0:
        return
    where = f"as {curve.x} -> {place}{beyond}"
    condition = Limit(place, scale=1 / curve.x, equals=slope)
    yield Fact("growth", f"f/{curve.x} -> {slope} {where}", condition, SYMBOLIC, place, slope)
    line = slope * curve.x
    height = _limit(curve, clock, place, side, sp.S.One, line)
    if height is not None:
        text = f"f - {line} -> {height} {where}: the asymptote is {line + height}"
        yield Fact("asymptote", text, Limit(place, minus=line, equals=height), SYMBOLIC, place, height)


def _other_growth(curve: Curve, place: sp.Expr, side: int) -> Iterator[Fact]:
    """Growth that is no power: only said, as no fraction follows it."""
    number = curve.number(0)
    with mpmath.workdps(DIGITS):
        sizes: list[Any] = [number(side * mpmath.mpf(10) ** k) for k in (2, 4, 6)]
        if any(size is None for size in sizes) or not abs(sizes[0]) < abs(sizes[1]) < abs(sizes[2]):
            return
        exponent = mpmath.log10(abs(sizes[2] / sizes[1])) / 2
    sign = "" if sizes[2] > 0 else "-"
    speed = "slower than any power" if exponent < 0.2 else "faster than any power" if exponent > 50 else ""
    if speed:
        text = f"f -> {sign}oo as {curve.x} -> {place}, {speed}{curve.label}"
        yield Fact("growth", text, None, "numeric, at 10**2, 10**4 and 10**6", place)
