"""The total integral and the first two moments."""

from __future__ import annotations

from collections.abc import Iterator

import mpmath
import sympy as sp

from ratfit._condition import Integral
from ratfit._multiprecise import multiprecise
from ratfit._study.closed import shorter
from ratfit._study.crossings import Scans
from ratfit._study.curve import SHOWN, Curve, Number, decimal, growth, numbers_of, shown
from ratfit._study.fact import SYMBOLIC, Fact

QUADRATURE_DIGITS = 40
SECONDS = 1.5
KINDS = ("integral", "moment", "moment")


def moment_facts(scans: Scans) -> Iterator[Fact]:
    """The integrals of f, f*x and f*x**2 over the domain: finite ones as conditions, others said to diverge."""
    curve = scans.curve
    for power in range(3):
        what = "integral of f" + ("" if power == 0 else f"*{curve.x**power}")
        reason = _divergence(scans, power)
        if reason:
            yield Fact(KINDS[power], f"{what} diverges: {reason}", None, "numeric, the growth there")
        elif (fact := _moment(scans, power, what)) is not None:
            yield fact
        else:
            scans.clock.notes.append(f"{what}: neither a closed form nor enough digits by quadrature")


def _divergence(scans: Scans, power: int) -> str:
    """Where the integrand grows like distance**-1 or faster, or falls off far out like 1/x or slower."""
    curve = scans.curve
    number = numbers_of((curve.target.expression * curve.x**power).xreplace(curve.middle), curve.x)
    for end, place, side in zip(curve.target.domain, curve.ends, (1, -1), strict=True):
        infinite = mpmath.isinf(place)
        exponent = growth(number, place, (1 if place > 0 else -1) if infinite else side)
        if infinite and exponent is None and _keeps_up(number, 1 if place > 0 else -1):
            return f"it does not fall off at {end}{curve.label}"
        if exponent is not None and (exponent >= -1 if infinite else exponent <= -1):
            far = curve.x if infinite else sp.Symbol("distance")
            return f"it behaves like {far**exponent} at {end}{curve.label}"
    for crossing in (c for order in (0, 1) for c in scans.scan(order).crossings if c.nature == "pole"):
        exponent = growth(number, crossing.place, 1)
        if exponent is not None and exponent <= -1:
            return f"there is a pole at {shown(crossing.place)}{curve.label}"
    return ""


def _keeps_up(number: Number, side: int) -> bool:
    """Whether something that follows no power is of one sign far out and no smaller than 1/x."""
    with mpmath.workdps(QUADRATURE_DIGITS):
        places = [side * mpmath.mpf(10) ** k * mpmath.pi for k in (4, 6, 8, 10)]
        values = [number(place) for place in places]
        if any(value is None for value in values):
            return False
        sizes = [value * abs(place) for value, place in zip(values, places, strict=True)]
    return len({mpmath.sign(size) for size in sizes}) == 1 and abs(sizes[3]) > abs(sizes[2]) > abs(sizes[1])


def _falls_off(scans: Scans, number: Number) -> bool:
    """Whether the integrand is small enough far out for a quadrature to be trusted."""
    with mpmath.workdps(QUADRATURE_DIGITS):
        for side, end in zip((-1, 1), scans.curve.ends, strict=True):
            if mpmath.isinf(end):
                near, far = (number(side * place) for place in (mpmath.mpf(10) ** 3, mpmath.mpf(10) ** 9))
                if far is None or near is None or abs(far) * 10**9 > 1e-2 * (abs(near) * 10**3 + 1e-30):
                    return False
    return True


def _moment(scans: Scans, power: int, what: str) -> Fact | None:
    curve, clock = scans.curve, scans.clock
    weight = curve.x**power
    numbers = clock.attempt(lambda: _quadrature(scans, weight), seconds=3.0)
    seconds = SECONDS / (1 if power == 0 else 2)  # where sympy fails at the first it mostly fails at the others
    value = clock.attempt(lambda: curve.target.integral(weight, curve.target.domain), what, seconds)
    if value is not None and numbers is not None and _agree(curve, value, numbers):
        value = shorter(value, clock)
        return Fact(KINDS[power], f"{what} = {value}", Integral(weight), SYMBOLIC, None, value)
    if numbers is None:
        return None
    number, digits = numbers
    if digits < 6:
        return None
    condition = None if curve.middle else Integral(weight, equals=decimal(number, digits))
    text = f"{what} = {shown(number, min(digits, 12))}{curve.label}"
    return Fact(KINDS[power], text, condition, f"numeric to {digits} digits", None, decimal(number, digits))


def _quadrature(scans: Scans, weight: sp.Expr) -> tuple[mpmath.mpf, int]:
    """The integral by numbers, split where derivatives break, and the digits that two refinements share."""
    curve = scans.curve
    number = numbers_of((curve.target.expression * weight).xreplace(curve.middle), curve.x)
    if not _falls_off(scans, number):
        raise ValueError("no quadrature is to be trusted here")
    breaks = [*scans.breaks, *scans.kinks, *(c.place for order in (0, 1, 2) for c in scans.scan(order).crossings)]
    low, high = curve.ends
    with mpmath.workdps(QUADRATURE_DIGITS):
        pieces = [low, *sorted(p for p in set(breaks) if low < p < high), high]

        def integrand(place: mpmath.mpf) -> mpmath.mpf:
            value = number(place)
            return mpmath.mpf(0) if value is None else value

        total, error = mpmath.quad(integrand, pieces, error=True)
        again = mpmath.quad(integrand, [low, *_between(low, high), high], maxdegree=8)
        error = max(abs(total - again) / (1 + abs(total)), mpmath.mpf(10) ** -SHOWN)
        return total, int(-mpmath.log10(error))


def _between(low: mpmath.mpf, high: mpmath.mpf) -> list[mpmath.mpf]:
    """Another place to split at, so that two quadratures do not make the same mistake."""
    if mpmath.isinf(low) and mpmath.isinf(high):
        return [mpmath.mpf("0.37")]
    if mpmath.isinf(low) or mpmath.isinf(high):
        return [low + mpmath.mpf("1.37")] if mpmath.isinf(high) else [high - mpmath.mpf("1.37")]
    return [low + (high - low) * mpmath.mpf("0.37")]


def _agree(curve: Curve, value: sp.Expr, numbers: tuple[mpmath.mpf, int]) -> bool:
    number, digits = numbers
    with mpmath.workdps(QUADRATURE_DIGITS):
        claimed = multiprecise(value.xreplace(curve.middle))
        return bool(abs(claimed - number) <= mpmath.mpf(10) ** -max(3, digits - 2) * (1 + abs(number)))
