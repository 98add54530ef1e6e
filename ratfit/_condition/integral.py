"""Integral: a normalisation or any moment."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import sympy as sp

from ratfit._condition.abstract import AbstractCondition, check_inside, needed, set_exact
from ratfit._parse import RatfitError
from ratfit._target import Target, check_domain


@dataclass(frozen=True)
class Integral(AbstractCondition):
    """The integral of weight times the fit over a range inside the domain (all of it when left out).

    Arguments: `weight`, an expression of the variable; `over`, (low, high). Raises RatfitError for a weight of zero
    and for an empty or reversed range.
    """

    weight: sp.Expr = sp.S.One
    over: tuple[sp.Expr, sp.Expr] | None = None
    equals: sp.Expr | None = None
    kind: ClassVar[str] = "integral"

    def __post_init__(self) -> None:
        set_exact(self, "weight")
        set_exact(self, "equals")
        if self.weight == 0:
            raise RatfitError("integral: a weight of zero asks for nothing; leave it out or state another")
        if self.over is not None:
            object.__setattr__(self, "over", check_domain(self.over))

    @property
    def place(self) -> str:
        over = "the domain" if self.over is None else f"[{self.over[0]}, {self.over[1]}]"
        return f"weight {self.weight} over {over}"

    def range(self, domain: tuple[sp.Expr, sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
        """The range of integration: `over`, or else the domain."""
        return domain if self.over is None else self.over

    def demanded(self, target: Target | None) -> sp.Expr:
        if self.equals is not None:
            return self.equals
        target = needed(target, self)
        return target.integral(self.weight, self.range(target.domain))

    def check(self, domain: tuple[sp.Expr, sp.Expr], what: str = "domain") -> None:
        for end in self.over or ():
            check_inside("integral over", end, domain, what)

    def expressions(self) -> tuple[sp.Expr, ...]:
        return tuple(e for e in (self.weight, *(self.over or ()), self.equals) if e is not None)
