"""Changes of sign of the target and its derivatives, narrowed down to 50 digits and told apart."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, pairwise
from typing import Any

import mpmath
import sympy as sp

from ratfit._study.clock import Clock
from ratfit._study.curve import DIGITS, Curve, Number, numbers_of

WORK = DIGITS + 15
"""Digits that a change of sign is narrowed down with."""

MOST = 6
"""Changes of sign of one function that are followed up; an oscillation has no end of them."""


@dataclass(frozen=True)
class Crossing:
    """A place where a derivative of some order changes its sign: from `before` (1 or -1) to the other.

    `nature` is "zero", "jump", or "pole" where the derivative grows without bound.
    """

    place: mpmath.mpf
    before: int
    nature: str


@dataclass(frozen=True)
class Scan:
    """The changes of sign of one function inside the domain.

    `samples` are the places looked at with the signs seen (0 where it is zero, or so near that digits do not tell),
    `more` says that some changes of sign were left.
    """

    crossings: tuple[Crossing, ...]
    samples: tuple[tuple[mpmath.mpf, int], ...]
    more: bool


class Scans:
    """The scans of a curve, each made when first asked for."""

    def __init__(self, curve: Curve, clock: Clock) -> None:
        self.curve, self.clock = curve, clock
        self._made: dict[int, Scan] = {}

    def scan(self, order: int) -> Scan:
        """The scan of the derivative of that order."""
        if order not in self._made:
            self._made[order] = _scan(self.curve.number(order), self.curve.nodes)
            if self._made[order].more:
                what = f"f{chr(39) * order}"
                self.clock.notes.append(
                    f"{what} changes its sign more often than {MOST} times: the first are followed up"
                )
        return self._made[order]

    @cached_property
    def breaks(self) -> tuple[mpmath.mpf, ...]:
        """Places where the target jumps or has no bound: what is said of one side says nothing of the other."""
        number = self.curve.number(0)
        found = [c.place for order in (0, 1) for c in self.scan(order).crossings]
        found += [c.place for argument in kinked_arguments(self.curve) for c in self._of(argument).crossings]
        return _distinct(place for place in found if _is_broken(number, place))

    @cached_property
    def kinks(self) -> tuple[mpmath.mpf, ...]:
        """Places where the slope jumps."""
        number = self.curve.number(1)
        found = [c.place for c in self.scan(1).crossings if c.nature != "zero"]
        found += [c.place for argument in kinked_arguments(self.curve) for c in self._of(argument).crossings]
        return _distinct(place for place in found if _is_broken(number, place))

    def _of(self, argument: sp.Expr) -> Scan:
        return _scan(numbers_of(argument.xreplace(self.curve.middle), self.curve.x), self.curve.nodes)


def kinked_arguments(curve: Curve) -> list[sp.Expr]:
    """What stands inside Abs, Min, Max and steps, written so that it vanishes where these break."""
    expression = curve.target.expression
    found = [atom.args[0] for atom in expression.atoms(sp.Abs, sp.sign, sp.Heaviside)]
    for atom in expression.atoms(sp.Min, sp.Max):
        found += [a - b for a, b in combinations(atom.args, 2)]
    return [argument for argument in found if argument.has(curve.x)]


def _distinct(places: Iterable[mpmath.mpf]) -> tuple[mpmath.mpf, ...]:
    found: list[mpmath.mpf] = []
    for place in sorted(places):
        if not found or place - found[-1] > mpmath.mpf("1e-30"):
            found.append(place)
    return tuple(found)


def _is_broken(number: Number, place: mpmath.mpf) -> bool:
    """Whether a function differs on the two sides of a place, or grows on the way to it."""
    with mpmath.workdps(WORK):
        sides: list[Any] = [[number(place + side * mpmath.mpf(10) ** -k) for k in (24, 12)] for side in (1, -1)]
        if any(value is None for side in sides for value in side):
            return True
        (right, right_off), (left, left_off) = sides
        grows = any(abs(near) > 1.4 * abs(off) + 1 for near, off in ((right, right_off), (left, left_off)))
        # Across a vertical tangent the values still differ by distance**(1/6) at most.
        return grows or abs(right - left) > mpmath.mpf("1e-4") * (1 + abs(right_off))


def _scan(number: Number, nodes: Sequence[mpmath.mpf]) -> Scan:
    with mpmath.workdps(DIGITS):
        values = [(place, value) for place in nodes if (value := number(place)) is not None]
    least = max((abs(v) for _, v in values), default=mpmath.mpf(0)) * mpmath.mpf(10) ** (20 - DIGITS)
    values = [(p, mpmath.mpf(0) if abs(v) < least and _is_rounding(number, p, v) else v) for p, v in values]
    trusted = [(p, v) for p, v in values if v != 0]
    found: list[Crossing] = []
    brackets = [(a, b) for (a, u), (b, v) in pairwise(trusted) if (u < 0) != (v < 0)]
    for low, high in brackets[: 3 * MOST]:
        if len(found) < MOST and (crossing := _narrowed(number, low, high)) is not None:
            found.append(crossing)
    return Scan(tuple(found), tuple((p, int(mpmath.sign(v))) for p, v in values), len(found) == MOST < len(brackets))


def _is_rounding(number: Number, place: mpmath.mpf, value: mpmath.mpf) -> bool:
    """Whether more digits leave nothing of a value: far out 1 - exp(-x**2) is 1 to all digits, and its slope noise."""
    with mpmath.workdps(2 * WORK):
        finer = number(place)
    return finer is None or abs(finer - value) > abs(finer) / 2


def _narrowed(number: Number, low: mpmath.mpf, high: mpmath.mpf) -> Crossing | None:
    """The place between two signs; None where they differ by rounding alone."""
    with mpmath.workdps(2 * WORK):
        left, right = number(low), number(high)
        if left is None or right is None or left == 0 or right == 0 or (left < 0) == (right < 0):
            return None
    with mpmath.workdps(WORK):
        place = _root(number, low, high, left)
        if place is None:
            return None
        place = mpmath.mpf(0) if abs(place) < mpmath.mpf(10) ** -DIGITS else place
        nature = _nature(number, place, min(place - low, high - place))
        return Crossing(place, 1 if left > 0 else -1, nature) if nature else None


def _root(number: Number, low: mpmath.mpf, high: mpmath.mpf, left: mpmath.mpf) -> mpmath.mpf | None:
    """By halving, helped by secants: a secant's place is taken for one end where its sign allows."""
    width = mpmath.mpf(10) ** -(DIGITS + 8) * (1 + abs(low))
    for turn in range(400):
        if high - low <= width:
            return (low + high) / 2
        for place in _proposals(number, low, high, turn):
            if not low < place < high:
                continue  # the other proposal has narrowed past it
            value = number(place)
            if value is None:
                return place if high - low <= 4 * width else None
            if value == 0:
                return place
            low, high = (place, high) if (value < 0) == (left < 0) else (low, place)
    return None


def _proposals(number: Number, low: mpmath.mpf, high: mpmath.mpf, turn: int) -> Iterator[mpmath.mpf]:
    """The secant's root and a place a little beyond it on either side, else the middle."""
    if turn % 4 == 3:
        a, b = number(low), number(high)
        if a is not None and b is not None and a != b:
            root = low - a * (high - low) / (b - a)
            # What is beyond the root by the square of the bracket closes it from the other side.
            step = max((high - low) ** 2, mpmath.mpf(10) ** -(DIGITS + 9) * (1 + abs(low)))
            inner = [p for p in (root - step, root + step) if low < p < high]
            if len(inner) == 2:
                yield from inner
                return
    yield (low + high) / 2


def _nature(number: Number, place: mpmath.mpf, room: mpmath.mpf) -> str:
    """Whether a change of sign is a zero, a pole or a jump, from sizes on both sides; nothing where that is unclear."""
    natures = set()
    for side in (1, -1):
        near, far = (number(place + side * room * mpmath.mpf(10) ** -k) for k in (18, 9))
        if near is None or far is None:
            return ""
        ratio = abs(near) / abs(far) if far != 0 else mpmath.inf
        natures.add("zero" if ratio < 0.7 else "pole" if ratio > 1.4 else "jump")
    if natures == {"zero", "jump"}:
        return "jump"  # zero on one side alone, as at the foot of a ramp
    return natures.pop() if len(natures) == 1 else "pole"
