"""Kernel conditions: the facts that a fit keeps exactly."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import sympy as sp

from ratfit._parse import RatfitError
from ratfit._target import Exact, Target, at_values, check_domain, exact, sample_values


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

    @abstractmethod
    def expressions(self) -> tuple[sp.Expr, ...]:
        """Every expression it holds, for the search for undeclared symbols."""


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
        return _needed(target, self).derivative(self.at, self.order)

    def check(self, domain: tuple[sp.Expr, sp.Expr], what: str = "domain") -> None:
        _check_inside(f"{self.kind} at", self.at, domain, what)

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
        _set_exact(self, "at")
        _set_exact(self, "equals")
        _refuse_infinite(self.at, f"{self.kind} at {self.at}: a place must be finite")


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
        _set_exact(self, "at")
        _set_exact(self, "equals")
        _refuse_infinite(self.at, f"{self.kind} at {self.at}: a place must be finite")
        if isinstance(self.order, bool) or not isinstance(self.order, int) or self.order < 0:
            raise RatfitError(f"{self.kind} at {self.at}: the order must be a whole number >= 0, not {self.order!r}")


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
        _set_exact(self, "weight")
        _set_exact(self, "equals")
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
        target = _needed(target, self)
        return target.integral(self.weight, self.range(target.domain))

    def check(self, domain: tuple[sp.Expr, sp.Expr], what: str = "domain") -> None:
        for end in self.over or ():
            _check_inside("integral over", end, domain, what)

    def expressions(self) -> tuple[sp.Expr, ...]:
        return tuple(e for e in (self.weight, *(self.over or ()), self.equals) if e is not None)


def describe(condition: AbstractCondition) -> str:
    """A condition in a few words: "value at 0", "derivative of order 2 at pi/2", "integral with ..."."""
    if not isinstance(condition, AbstractPointCondition):
        return f"{condition.kind} with {condition.place}"
    if condition.order > 1:
        return f"derivative of order {condition.order} at {condition.place}"
    return f"{'derivative' if condition.order else 'value'} at {condition.place}"


def _set_exact(condition: AbstractCondition, field: str) -> None:
    given: Exact | None = getattr(condition, field)
    if given is not None:
        object.__setattr__(condition, field, exact(given, f"{condition.kind}, {field}"))
    if field == "equals":
        _refuse_infinite(condition.equals, f"{condition.kind}: equals must be finite")


def _refuse_infinite(expression: sp.Expr | None, message: str) -> None:
    if expression is not None and expression.has(sp.oo, -sp.oo, sp.zoo, sp.nan, sp.I):
        raise RatfitError(message)


def _needed(target: Target | None, condition: AbstractCondition) -> Target:
    if target is None:
        raise RatfitError(f"{condition.kind} at {condition.place}: there is no target, so it must state equals")
    return target


def _check_inside(kind: str, at: sp.Expr, domain: tuple[sp.Expr, sp.Expr], what: str) -> None:
    low, high = domain
    for values in sample_values(at.free_symbols | low.free_symbols | high.free_symbols):
        place = at.xreplace(values)
        if not (low.xreplace(values) <= place and place <= high.xreplace(values)):
            raise RatfitError(f"{kind} {at} lies outside the {what} [{low}, {high}]{at_values(values)}")
