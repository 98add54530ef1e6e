"""What all kernel conditions share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import sympy as sp

from ratfit._parse import RatfitError
from ratfit._target import Exact, Target, at_values, exact, sample_values


class AbstractCondition(ABC):
    """A fact that the fit keeps exactly. `equals` left out means "what the target does there"."""

    kind: ClassVar[str]
    equals: sp.Expr | None

    @property
    @abstractmethod
    def place(self) -> str:
        """Where it is asked, as text in ratfit's grammar."""

    @abstractmethod
    def demanded(self, target: Target | None) -> sp.Expr:
        """The number that the fit must give: `equals`, or else the target's own; RatfitError where it has none."""

    @abstractmethod
    def check(self, domain: tuple[sp.Expr, sp.Expr], what: str = "domain") -> None:
        """Raises RatfitError for a condition that lies outside the domain, or another range that `what` names."""

    @property
    def needs_target(self) -> bool:
        """Whether the target must say what the fit has to give."""
        return self.equals is None

    @abstractmethod
    def expressions(self) -> tuple[sp.Expr, ...]:
        """Every expression it holds, for the search for undeclared symbols."""


def set_exact(condition: AbstractCondition, field: str) -> None:
    """Reads a field of a condition exactly, in place; `equals` must be finite."""
    given: Exact | None = getattr(condition, field)
    if given is not None:
        object.__setattr__(condition, field, exact(given, f"{condition.kind}, {field}"))
    if field == "equals":
        refuse_infinite(condition.equals, f"{condition.kind}: equals must be finite")


def refuse_infinite(expression: sp.Expr | None, message: str) -> None:
    """Raises RatfitError for an expression that is infinite or not real."""
    if expression is not None and expression.has(sp.oo, -sp.oo, sp.zoo, sp.nan, sp.I):
        raise RatfitError(message)


def needed(target: Target | None, condition: AbstractCondition) -> Target:
    """The target; RatfitError where there is none to ask."""
    if target is None:
        raise RatfitError(f"{condition.kind} at {condition.place}: there is no target, so it must state equals")
    return target


def check_inside(kind: str, at: sp.Expr, domain: tuple[sp.Expr, sp.Expr], what: str) -> None:
    """Raises RatfitError for a place outside a range, for the values of the parameters tried."""
    low, high = domain
    for values in sample_values(at.free_symbols | low.free_symbols | high.free_symbols):
        place = at.xreplace(values)
        if not (low.xreplace(values) <= place and place <= high.xreplace(values)):
            raise RatfitError(f"{kind} {at} lies outside the {what} [{low}, {high}]{at_values(values)}")
