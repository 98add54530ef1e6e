"""Small differential equations that the target satisfies: y' = k*y and its like, with an exact k."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import sympy as sp

from ratfit._condition import JET, Equation
from ratfit._study.clock import Clock
from ratfit._study.closed import shorter
from ratfit._study.curve import Curve, exponent_of
from ratfit._study.fact import SYMBOLIC, Fact

_Y, _SLOPE, _BEND = JET[:3]

# (left side, right side but for the constant k): k is their quotient where that does not change with x
_SHAPES: tuple[tuple[sp.Expr, Callable[[sp.Symbol], sp.Expr]], ...] = (
    (_SLOPE, lambda x: _Y),
    (_BEND, lambda x: _Y),
    (_SLOPE, lambda x: _Y / x),
    (_SLOPE, lambda x: _Y * x),
    (_SLOPE, lambda x: 1 - _Y**2),
    (_SLOPE, lambda x: 1 + _Y**2),
    (_SLOPE, lambda x: _Y * (1 - _Y)),
    (_SLOPE, lambda x: _Y**2),
)


def equation_facts(curve: Curve, clock: Clock) -> Iterator[Fact]:
    """The equations of a short list that hold identically; the simplest one is enough."""
    ends = zip(curve.target.domain, (1, -1), strict=True)
    everywhere = all(end.is_infinite for end in curve.target.domain)
    at = next((end for end, side in ends if _is_regular(curve, end, side)), sp.S.Zero if everywhere else None)
    if at is None:
        return
    for left, right_of in _SHAPES:
        right = right_of(curve.x)
        constant = clock.attempt(lambda a=left, b=right: _constant(curve, a, b), seconds=0.6)  # type: ignore[misc]
        if constant is None or constant == 0:
            continue
        constant = shorter(constant, clock)
        residual = left - constant * right
        residual = sp.numer(sp.together(residual)) if residual.has(1 / curve.x) else residual
        text = f"{residual} = 0 on the domain"
        yield Fact("equation", text, Equation(residual, at), SYMBOLIC, at)
        return


def _is_regular(curve: Curve, end: sp.Expr, side: int) -> bool:
    """Whether the target and its slope are finite at an end: where they are not the residual says nothing."""
    place = curve.ends[0 if side == 1 else 1]
    exponents = [] if end.is_infinite else [exponent_of(curve.number(order), place, side) for order in (0, 1)]
    return bool(exponents) and all(exponent is None or exponent > -0.001 for exponent in exponents)


def _constant(curve: Curve, left: sp.Expr, right: sp.Expr) -> sp.Expr | None:
    jet = {y: curve.expression(k) for k, y in enumerate(JET[:3])}
    quotient = left.xreplace(jet) / right.xreplace(jet)
    number = [sp.N(quotient.xreplace({**curve.middle, curve.x: place}), 20) for place in _places(curve)]
    if not all(n.is_Float and abs(n - number[0]) < sp.Float("1e-15") * (1 + abs(n)) for n in number):
        return None
    constant = sp.simplify(quotient)
    return None if constant.has(curve.x) or not constant.is_finite else constant


def _places(curve: Curve) -> list[sp.Expr]:
    nodes = curve.nodes
    return [sp.Rational(str(nodes[len(nodes) * k // 7])) for k in (2, 3, 5)]
