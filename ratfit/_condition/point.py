"""Value and Derivative: conditions at a point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import sympy as sp

from ratfit._condition.abstract import AbstractCondition, check_inside, needed, refuse_infinite, set_exact
from ratfit._parse import RatfitError
from ratfit._target import Target


class AbstractPointCondition(AbstractCondition):
    """A derivative at a place, order 0 being the value."""

    at: sp.Expr
    order: int

    @property
    def place(self) -> str:
        return str(self.at)

    def demanded(self, target: Target | None) -> sp.Expr:
        if self.equals is not None:
            return self.equals
        return needed(target, self).derivative(self.at, self.order)

    def check(self, domain: tuple[sp.Expr, sp.Expr], what: str = "domain") -> None:
        check_inside(f"{self.kind} at", self.at, domain, what)

    def expressions(self) -> tuple[sp.Expr, ...]:
        return (self.at,) if self.equals is None else (self.at, self.equals)


@dataclass(frozen=True)
class Value(AbstractPointCondition):
    """The value at a place.

    Arguments: `at`, a number or an expression of the parameters inside the closed domain; `equals`, the number
    demanded. Where the target is 0/0 or infinite the one-sided limit inside the domain is taken. Raises RatfitError
    for a place that is not finite.
    """

    at: sp.Expr
    equals: sp.Expr | None = None
    kind: ClassVar[str] = "value"
    order: ClassVar[int] = 0  # type: ignore[misc]  # a value is a derivative of order 0, for good

    def __post_init__(self) -> None:
        set_exact(self, "at")
        set_exact(self, "equals")
        refuse_infinite(self.at, f"{self.kind} at {self.at}: a place must be finite")


@dataclass(frozen=True)
class Derivative(AbstractPointCondition):
    """The derivative of the given order at a place.

    Arguments and errors are those of `Value`, and `order`, a whole number >= 0, which RatfitError is raised for too.
    """

    at: sp.Expr
    order: int = 1
    equals: sp.Expr | None = None
    kind: ClassVar[str] = "derivative"

    def __post_init__(self) -> None:
        set_exact(self, "at")
        set_exact(self, "equals")
        refuse_infinite(self.at, f"{self.kind} at {self.at}: a place must be finite")
        if isinstance(self.order, bool) or not isinstance(self.order, int) or self.order < 0:
            raise RatfitError(f"{self.kind} at {self.at}: the order must be a whole number >= 0, not {self.order!r}")
