"""Monotonicity and convexity: signs of derivatives, proved where algebra can."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import mpmath
import sympy as sp

from ratfit._study.clock import Clock
from ratfit._study.crossings import Scans
from ratfit._study.curve import Curve, shown
from ratfit._study.fact import SYMBOLIC, Fact

KINDS = {1: "monotonicity", 2: "convexity"}
WORDS = {
    1: {1: "increasing", -1: "decreasing", 0: "constant"},
    2: {1: "convex", -1: "concave", 0: "straight"},
}

_DISTANCE = sp.Dummy("distance", positive=True)


MARK = {1: "f'", 2: "f''"}


def shape_facts(scans: Scans) -> Iterator[Fact]:
    """Increasing or decreasing, convex or concave, on the whole domain or in pieces."""
    curve = scans.curve
    if curve.target.expression.has(sp.floor, sp.ceiling):
        scans.clock.notes.append("floor and ceiling: monotonicity and convexity are not looked at")
        return
    for order in (1, 2):
        scan, pieces = scans.scan(order), _pieces(scans, order)
        if scan.more or pieces is None:
            text = f"{MARK[order]} changes its sign again and again{curve.label}"
            yield Fact(KINDS[order], text, None, f"numeric, at {len(scan.samples)} points")
        elif len(pieces) == 1:
            yield _whole(scans, order, pieces[0].sign)
        elif pieces:
            yield _in_pieces(curve, order, pieces, len(scan.samples))


@dataclass(frozen=True)
class Piece:
    """A stretch of the domain on which a derivative keeps its sign; `place` is where it begins, None at the start."""

    place: mpmath.mpf | None
    sign: int


def _pieces(scans: Scans, order: int) -> list[Piece] | None:
    """The stretches between changes of sign, poles, jumps and kinks; None where signs alternate unresolved."""
    scan = scans.scan(order)
    firm = {*scans.breaks, *(scans.kinks if order == 2 else ())}
    cuts: list[mpmath.mpf | None] = [None, *sorted({*firm, *scans.kinks, *(c.place for c in scan.crossings)})]
    found: list[Piece] = []
    for low, high in zip(cuts, [*cuts[1:], None], strict=True):
        signs = [s for p, s in scan.samples if (low is None or p > low) and (high is None or p < high)]
        sign = _common(signs)
        if sign is None:
            return None
        if signs and (low in firm or not found or found[-1].sign != sign):
            found.append(Piece(low, sign))
    return found


def _common(signs: list[int]) -> int | None:
    """The one sign of a stretch; zeros among others are places where digits did not tell. None where signs differ."""
    seen = set(signs) - {0}
    return None if len(seen) > 1 else seen.pop() if seen else 0


def _whole(scans: Scans, order: int, sign: int) -> Fact:
    curve, clock = scans.curve, scans.clock
    low, high = curve.target.domain
    text = f"{WORDS[order][sign]} on [{low}, {high}]"
    if sign == 0:
        derivative = curve.expression(order)
        proved = derivative == 0 or clock.attempt(lambda: sp.simplify(derivative)) == 0
    else:
        proved = not scans.breaks and has_sign(curve, order, sign, clock)
    if proved:
        return Fact(KINDS[order], text, None, SYMBOLIC)
    seen = f"no change of sign of {MARK[order]} seen at {len(scans.scan(order).samples)} points"
    return Fact(KINDS[order], text + curve.label, None, seen)


def _in_pieces(curve: Curve, order: int, pieces: list[Piece], points: int) -> Fact:
    ends = [
        str(curve.target.domain[0]),
        *(shown(p.place, 8) for p in pieces[1:] if p.place is not None),
        str(curve.target.domain[1]),
    ]
    texts = [f"{WORDS[order][p.sign]} on [{a}, {b}]" for p, (a, b) in zip(pieces, pairwise(ends), strict=True)]
    seen = f"no other change of sign of {MARK[order]} seen at {points} points"
    return Fact(KINDS[order], ", ".join(texts) + curve.label, None, seen)


def has_sign(curve: Curve, order: int, sign: int, clock: Clock) -> bool:
    """Whether a derivative has this sign all over the open domain, by Sturm's count or sympy's assumptions."""
    derivative = curve.expression(order)
    if (flat := clock.attempt(lambda: sp.factor(sp.together(derivative)), seconds=0.5)) is None:
        return False
    if not curve.parameters and clock.attempt(lambda: _no_real_root(flat, curve)):
        return True
    return any(clock.attempt(partial(_signed, flat, curve.x, image, sign), seconds=0.3) for image in _images(curve))


def _no_real_root(flat: sp.Expr, curve: Curve) -> bool:
    """Whether numerator and denominator of a rational function have no zero inside the domain, by Sturm sequences."""
    low, high = curve.target.domain
    for part in sp.fraction(flat):
        polynomial = sp.Poly(part, curve.x)
        if not polynomial.domain.is_QQ and not polynomial.domain.is_ZZ:
            return False
        if (not low.is_Rational and not low.is_infinite) or (not high.is_Rational and not high.is_infinite):
            return False
        inside = polynomial.count_roots(low, high) if polynomial.degree() > 0 else 0
        inside -= sum(1 for end in (low, high) if end.is_finite and polynomial(end) == 0)
        if inside:
            return False
    return True


def _images(curve: Curve) -> Iterator[sp.Expr]:
    """The open domain (or more of the line) as the image of a positive number: what sympy knows the sign of."""
    low, high = curve.target.domain
    d = _DISTANCE
    if not low.is_infinite:
        yield low + d
    if not high.is_infinite:
        yield high - d
    if not low.is_infinite and not high.is_infinite:
        yield low + (high - low) / (1 + d)
    if low.is_infinite and high.is_infinite:
        yield sp.Dummy("anywhere", real=True)


def _signed(derivative: sp.Expr, x: sp.Symbol, image: sp.Expr, sign: int) -> bool:
    moved = derivative.xreplace({x: image})
    for shape in (moved, sp.factor(sp.together(moved)), sp.simplify(moved)):
        if (shape.is_positive if sign > 0 else shape.is_negative) is True:
            return True
    return False
