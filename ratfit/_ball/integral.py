"""Ball integrals: the integral of an expression over a range, enclosed."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import flint
import sympy as sp
from flint import acb, arb

from ratfit._ball.ends import at_end, new_variable
from ratfit._ball.function import Tape, ball_function, compiled, real_part
from ratfit._parse import RatfitError

_PROBE_BITS = 64
"""At this precision a factor is seen not to vanish at an end; 0 within it counts as a zero, which costs time alone."""

_EVALUATIONS = 20_000
"""Places at which one integrand is looked at before the integral is given up, as at a pole: some tenths of a second."""


_UNIT = sp.Dummy("unit", nonnegative=True)


class AnyMoment(Protocol):
    """What an integral is made of: its integrand and the ends of its range."""

    @property
    def integrand(self) -> sp.Expr: ...
    @property
    def low(self) -> sp.Expr: ...
    @property
    def high(self) -> sp.Expr: ...


def ball_integral(
    moment: AnyMoment, variable: sp.Symbol, symbols: Sequence[sp.Symbol]
) -> Callable[[Sequence[arb]], arb]:
    """The integral as a function of balls, at flint's working precision of the moment of the call.

    **Arguments:**

    - `moment`: the integrand, and the ends: numbers, or infinite. Rational powers and logarithms may vanish or be
      infinite at an end. At an infinite end a rational or algebraic integrand must fall off faster than 1/x, any other
      as the exponential of a power.
    - `variable`: of the integration.
    - `symbols`: whose real values the function takes, as one list of `flint.arb` in this order.

    **Returns:** a function whose ball contains the integral for all values of the symbols in their balls. The ball is
    not finite where there is a pole inside, where the integrand may not be real, or where the integral diverges.

    **Fails** with `RatfitError` for an integrand without ball arithmetic, ends with symbols, or an end where no bound
    of the integrand is known; the message says which.

    Source: F. Johansson, "Numerical integration in arbitrary-precision ball arithmetic", ICMS 2018.
    """
    pieces = _pieces(moment.integrand, variable, moment.low, moment.high, tuple(symbols))

    def integral(values: Sequence[arb]) -> arb:
        if not all(isinstance(value, arb) for value in values):
            raise RatfitError("an integral takes real balls: flint.arb")
        return sum((piece.value(values) for piece in pieces), arb(0))

    return integral


@dataclass(frozen=True)
class _Piece:
    """The integral of a tape from low to (high - low of the old variable)**(1/degree), or as the ends say."""

    tape: Tape
    low: Callable[[Sequence[Any]], arb]
    high: Callable[[Sequence[Any]], arb]

    def value(self, values: Sequence[arb]) -> arb:
        integrand = self.tape.integrand(values)
        low, high = self.low(()), self.high(())
        # Nothing beyond what the widths of the values leave to be known is worth a subdivision.
        width = max((float(v.rad()) / max(1.0, abs(float(v.mid()))) for v in values if v.is_finite()), default=0.0)
        goal = arb(max(min(width, 0.01), 0.0)) + arb((1, -flint.ctx.prec))
        found = acb.integral(integrand, acb(low), acb(high), rel_tol=goal, abs_tol=goal, eval_limit=_EVALUATIONS)
        return real_part(found)


@functools.lru_cache(maxsize=512)
def _pieces(
    integrand: sp.Expr, variable: sp.Symbol, low: sp.Expr, high: sp.Expr, symbols: tuple[sp.Symbol, ...]
) -> tuple[_Piece, ...]:
    if low.free_symbols | high.free_symbols:
        raise RatfitError(f"no ball integral from {low} to {high}: the ends must be numbers")
    hard_low, hard_high = (_is_hard(integrand, variable, end, symbols) for end in (low, high))
    if not (hard_low or hard_high):
        return (_regular(integrand, variable, low, high, symbols),)
    if (hard_low and hard_high) or (low.is_finite and high.is_finite):
        middle = _middle(low, high)
    else:
        middle = high if hard_low else low
    found = []
    if hard_low:
        found.append(_approach(integrand, variable, low, 1, middle, symbols))
    elif middle != low:
        found.append(_regular(integrand, variable, low, middle, symbols))
    if hard_high:
        found.append(_approach(integrand, variable, high, -1, middle, symbols))
    elif middle != high:
        found.append(_regular(integrand, variable, middle, high, symbols))
    return tuple(found)


def _regular(
    integrand: sp.Expr, variable: sp.Symbol, low: sp.Expr, high: sp.Expr, symbols: tuple[sp.Symbol, ...]
) -> _Piece:
    """A piece between two ends without trouble, moved to [0, 1]: ends that are no dyadic numbers are balls, and the
    subdivision would not end before it had tried to narrow them.
    """
    length = high - low
    moved = integrand.xreplace({variable: low + length * _UNIT}) * length
    return _Piece(compiled(moved, symbols, _UNIT), ball_function(sp.S.Zero, ()), ball_function(sp.S.One, ()))


def _middle(low: sp.Expr, high: sp.Expr) -> sp.Expr:
    if low.is_finite and high.is_finite:
        return (low + high) / 2
    if low.is_finite:
        return low + 1
    return high - 1 if high.is_finite else sp.S.Zero


def _approach(
    integrand: sp.Expr, variable: sp.Symbol, end: sp.Expr, side: int, other: sp.Expr, symbols: tuple[sp.Symbol, ...]
) -> _Piece:
    """The piece between an end that is 0 in the new variable and the other, where a ball sees nothing special."""
    mapped, degree = at_end(integrand, variable, end, side, other)
    length = side * (other - end) if end.is_finite else sp.S.One
    if length.is_positive is not True:
        raise RatfitError(f"no ball integral between {end} and {other}: write the lower end first")
    top = sp.Pow(length, sp.Rational(1, degree))
    return _Piece(compiled(mapped, symbols, new_variable()), ball_function(sp.S.Zero, ()), ball_function(top, ()))


def _is_hard(integrand: sp.Expr, variable: sp.Symbol, end: sp.Expr, symbols: tuple[sp.Symbol, ...]) -> bool:
    """Whether the end is infinite, or a root, a logarithm or a denominator is not regular there."""
    if not end.is_finite:
        return True
    if integrand.is_rational_function(variable):
        return False
    bases = [p.base for p in integrand.atoms(sp.Pow) if p.exp.is_Integer is not True or p.exp.is_negative]
    bases += [logarithm.args[0] for logarithm in integrand.atoms(sp.log)]
    return any(base.has(variable) and _may_vanish(base.xreplace({variable: end}), symbols) for base in bases)


def _may_vanish(value: sp.Expr, symbols: tuple[sp.Symbol, ...]) -> bool:
    """Whether an expression is 0, or undefined, at an unremarkable place of its symbols."""
    try:
        function = ball_function(value, symbols)
    except RatfitError:
        return True
    with flint.ctx.workprec(_PROBE_BITS):
        found = function([arb(17 + 6 * k) / (11 + 4 * k) for k in range(len(symbols))])
        return not found.is_finite() or bool(found.contains(0))
