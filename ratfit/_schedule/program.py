"""Straight-line programs: values up to their sign, and operations on them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import sympy as sp


class Value(NamedTuple):
    """A step, the variable or a parameter expression, up to its sign.

    Signs ride along because nearly every operation takes one for nothing: `a + (-b)` is a subtraction.
    """

    atom: sp.Expr
    negative: bool = False

    @property
    def signed(self) -> sp.Expr:
        return -self.atom if self.negative else self.atom


@dataclass(frozen=True)
class Operation:
    kind: str  # add, sub, mul, div, call
    operands: tuple[sp.Expr, ...]
    head: Callable[..., sp.Expr] | None = None


class Program(NamedTuple):
    operations: dict[sp.Expr, Operation]
    result: sp.Expr


@dataclass(frozen=True)
class Select:
    """A `Piecewise` that waits for the values of its branches."""

    conditions: tuple[Any, ...]

    def __call__(self, *values: sp.Expr) -> sp.Expr:
        return sp.Piecewise(*zip(values, self.conditions, strict=True))


@dataclass(frozen=True)
class Whole:
    """Something that is not taken apart, such as an integral."""

    node: sp.Expr

    def __call__(self) -> sp.Expr:
        return self.node
