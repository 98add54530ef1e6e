"""Enclosure: residuals and their Jacobian as functions of balls, for the polish and for the certificate."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import sympy as sp
from flint import arb

from ratfit._ball import ball_function, ball_integral
from ratfit._parse import RatfitError
from ratfit._solver.nonlinear.residuals import Moment, Residual, Residuals

Term = Callable[[Sequence[arb]], arb]


@dataclass(frozen=True)
class Enclosure:
    """The terms of every residual, and of its derivative by every unknown."""

    terms: tuple[tuple[Term, ...], ...]
    slopes: tuple[tuple[tuple[Term, ...], ...], ...]

    def values(self, unknowns: Sequence[arb]) -> list[arb]:
        """A ball of every residual for unknowns in these balls."""
        return [_total(terms, unknowns) for terms in self.terms]

    def sized(self, unknowns: Sequence[arb]) -> tuple[list[arb], list[arb]]:
        """The residuals, and how large their terms are: what rounding, and a root, is measured against."""
        parts = [[term(unknowns) for term in terms] for terms in self.terms]
        return [sum(p, arb(0)) for p in parts], [sum((abs(t) for t in p), arb(0)) for p in parts]

    def jacobian(self, unknowns: Sequence[arb]) -> list[list[arb]]:
        """A ball of every derivative: one row a residual, one column an unknown."""
        return [[_total(terms, unknowns) for terms in row] for row in self.slopes]


@functools.lru_cache(maxsize=64)
def enclosure(residuals: Residuals) -> Enclosure:
    """The residuals in ball arithmetic, differentiated once: integrals under their sign.

    Raises RatfitError where a residual contains a parameter or a function without ball arithmetic.
    """
    terms, slopes = [], []
    for part in residuals.parts:
        terms.append(_terms(part, residuals))
        slopes.append(tuple(_terms(_derivative(part, unknown), residuals) for unknown in residuals.unknowns))
    return Enclosure(tuple(terms), tuple(slopes))


def _terms(part: Residual, residuals: Residuals) -> tuple[Term, ...]:
    plain = tuple(ball_function(t, residuals.unknowns) for t in sp.Add.make_args(part.plain) if t != 0)
    moments = (m for m in part.moments if m.integrand != 0)
    return plain + tuple(ball_integral(m, residuals.variable, residuals.unknowns) for m in moments)


def _derivative(part: Residual, unknown: sp.Symbol) -> Residual:
    moments = (Moment(_slope(m.integrand, unknown), m.low, m.high) for m in part.moments)
    return Residual(_slope(part.plain, unknown), tuple(moments))


def _slope(expression: sp.Expr, unknown: sp.Symbol) -> sp.Expr:
    found = sp.diff(expression, unknown)
    if found.has(sp.Derivative):
        raise RatfitError(f"no ball arithmetic for the derivative of {expression} by {unknown}")
    # Over one denominator what cancels at an infinite end cancels, and a ball there is narrow.
    return sp.together(found) if found.is_rational_function() else found


def _total(terms: Sequence[Term], unknowns: Sequence[arb]) -> arb:
    return sum((term(unknowns) for term in terms), arb(0))


def bits(digits: float) -> int:
    """The working precision in bits that carries so many decimal digits."""
    return math.ceil(digits * math.log2(10)) + 4
