"""Residuals: the equations that the nonlinear route brings to zero, sums of expressions and integrals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp


@dataclass(frozen=True)
class Moment:
    """The integral of `integrand` over the variable from `low` to `high`.

    The integrand is smooth between the ends, which are numbers or expressions of the parameters, or infinite.
    """

    integrand: sp.Expr
    low: sp.Expr
    high: sp.Expr

    def xreplace(self, values: Mapping[sp.Symbol, sp.Expr]) -> Moment:
        return Moment(*(e.xreplace(values) for e in (self.integrand, self.low, self.high)))


@dataclass(frozen=True)
class Residual:
    """An expression of the unknowns and the parameters, plus integrals: together they must vanish."""

    plain: sp.Expr
    moments: tuple[Moment, ...] = ()

    def subs(self, values: Mapping[sp.Symbol, sp.Expr]) -> Residual:
        """With expressions in place of unknowns, evaluated again."""
        moments = tuple(Moment(m.integrand.subs(values), m.low, m.high) for m in self.moments)
        return Residual(self.plain.subs(values), moments)

    def xreplace(self, values: Mapping[sp.Symbol, sp.Expr]) -> Residual:
        return Residual(self.plain.xreplace(values), tuple(m.xreplace(values) for m in self.moments))


@dataclass(frozen=True)
class Residuals:
    """All residuals of a problem, in its `unknowns`; every other symbol but the variable is a parameter.

    `homogeneous` says that the unknowns may be multiplied by any number without a change: the last residual then puts
    them on the unit sphere, and a root u is the same answer as -u.
    """

    variable: sp.Symbol
    unknowns: tuple[sp.Symbol, ...]
    parts: tuple[Residual, ...]
    homogeneous: bool = False

    @property
    def expressions(self) -> list[sp.Expr]:
        """Every expression in the residuals: plain ones, integrands, and ends of ranges."""
        moments = [m for part in self.parts for m in part.moments]
        return [*(p.plain for p in self.parts), *(e for m in moments for e in (m.integrand, m.low, m.high))]

    def at(self, values: Mapping[sp.Symbol, sp.Expr]) -> Residuals:
        """The residuals at exact values of the parameters."""
        return Residuals(
            self.variable, self.unknowns, tuple(part.xreplace(values) for part in self.parts), self.homogeneous
        )
