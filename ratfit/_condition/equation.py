"""Equation: a differential equation that the fit satisfies at a point, to some order."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import sympy as sp
from sympy.core.function import AppliedUndef

from ratfit._condition.abstract import AbstractCondition, check_inside, refuse_infinite, set_exact
from ratfit._parse import RatfitError, parse_expression
from ratfit._target import Target

MAX_DERIVATIVE = 4
"""Highest derivative of y that a residual may hold."""

MAX_ORDER = 60
"""Highest derivative of a residual that may be asked to vanish."""

JET = tuple(sp.Symbol("y" + "'" * k, real=True) for k in range(MAX_DERIVATIVE + MAX_ORDER + 1))
"""y, y', y'', ...: the fit and its derivatives in a residual."""

JET_NAMES: Mapping[str, sp.Symbol] = {s.name: s for s in JET[: MAX_DERIVATIVE + 1]}
"""The names that the text of a residual may hold beside those of the problem."""


@dataclass(frozen=True)
class Equation(AbstractCondition):
    """A differential equation whose residual, and its first `order` derivatives, vanish at a place.

    Arguments: `residual`, an expression of the variable and of y, y', y'', ...: text such as "y' - 1 + y**2" (which can
    name the problem's variable and parameters only in a problem file), or a sympy expression with y as a function of
    the variable; `at`, a finite place inside the closed domain; `order`, a whole number. Raises RatfitError for a
    residual without y, with derivatives beyond the fourth, or with other unknown functions.
    """

    residual: sp.Expr
    at: sp.Expr
    order: int = 0
    kind: ClassVar[str] = "equation"
    equals: ClassVar[sp.Expr | None] = None  # type: ignore[misc]  # a residual vanishes, always

    def __post_init__(self) -> None:
        if isinstance(self.residual, str):
            object.__setattr__(self, "residual", parse_expression(self.residual, JET_NAMES, "equation, residual"))
        set_exact(self, "residual")
        set_exact(self, "at")
        refuse_infinite(self.at, f"equation at {self.at}: a place must be finite")
        refuse_infinite(self.residual, f"equation at {self.at}: the residual must be finite and real")
        object.__setattr__(self, "residual", _in_jet(self.residual))
        if isinstance(self.order, bool) or not isinstance(self.order, int) or not 0 <= self.order <= MAX_ORDER:
            raise RatfitError(f"equation at {self.at}: the order is a whole number from 0 to {MAX_ORDER}")
        if not self.residual.has(*JET):
            raise RatfitError(f"equation: the residual {self.residual} holds no y; write it as in y'' + y")

    @property
    def place(self) -> str:
        return str(self.at)

    @property
    def needs_target(self) -> bool:
        return False

    @property
    def height(self) -> int:
        """The highest derivative of y in the residual."""
        return max(k for k, y in enumerate(JET) if self.residual.has(y))

    def demanded(self, target: Target | None) -> sp.Expr:
        return sp.S.Zero

    def residuals(self, x: sp.Symbol) -> list[sp.Expr]:
        """The residual and its first `order` total derivatives, in x and JET."""
        found = [self.residual]
        for k in range(self.order):
            last = found[-1]
            top = self.height + k
            found.append(sp.diff(last, x) + sp.Add(*(JET[j + 1] * sp.diff(last, JET[j]) for j in range(top + 1))))
        return found

    def residuals_there(self, x: sp.Symbol) -> list[sp.Expr]:
        """The same at the place, in JET alone; RatfitError where one has no value there."""
        found = [residual.subs(x, self.at) for residual in self.residuals(x)]
        if any(residual.has(sp.nan, sp.zoo, sp.oo, -sp.oo, sp.I) for residual in found):
            raise RatfitError(
                f"equation {self.residual}: it, or a derivative up to order {self.order}, has no real value at "
                f"{self.at}; move it or lower its order"
            )
        return found

    def check(self, domain: tuple[sp.Expr, sp.Expr], what: str = "domain") -> None:
        check_inside("equation at", self.at, domain, what)

    def expressions(self) -> tuple[sp.Expr, ...]:
        return self.at, sp.Add(*(self.residual.free_symbols - set(JET)))


def _in_jet(residual: sp.Expr) -> sp.Expr:
    """The residual with y(x), y'(x), ... of sympy written as the symbols of JET."""
    functions = residual.atoms(AppliedUndef)
    if not functions:
        return residual
    if len(functions) > 1 or len(next(iter(functions)).args) != 1:
        raise RatfitError(
            f"equation: one unknown function of the variable is needed, not {sorted(map(str, functions))}"
        )
    y = functions.pop()
    x = y.args[0]
    jets: dict[Any, sp.Symbol] = {sp.diff(y, x, k) if k else y: JET[k] for k in range(MAX_DERIVATIVE + 1)}
    found = residual.xreplace(jets)
    if found.has(AppliedUndef, sp.Derivative):
        raise RatfitError(f"equation: {residual} holds a derivative beyond the order {MAX_DERIVATIVE}")
    return found
