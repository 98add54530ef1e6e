"""What an arrangement is, and what all of them know beforehand."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TypeVar

import sympy as sp

from ratfit._schedule.program import Value
from ratfit._schedule.tape import Tape

Ranges = Mapping[sp.Symbol, tuple[sp.Expr, sp.Expr]]
Plan = Callable[[Tape], Value]


class Refused(Exception):
    """An arrangement that must not be used: it grows too large, or divides by what may be zero."""


_T = TypeVar("_T")


def attempt(action: Callable[[], _T]) -> _T | None:
    try:
        return action()
    except Refused:
        return None


@dataclass(frozen=True)
class Context:
    """What is known beforehand, and the plans already made for subexpressions.

    `plan` is the choice among all arrangements, handed down to those that need the best one of a subexpression.
    """

    variable: sp.Symbol
    ranges: Ranges
    plan: Callable[[Context, sp.Expr], Plan]
    plans: dict[sp.Expr, Plan] = field(default_factory=dict)
    varying: dict[sp.Expr, bool] = field(default_factory=dict)

    def varies(self, expression: sp.Expr) -> bool:
        if expression not in self.varying:
            self.varying[expression] = self.variable in expression.free_symbols
        return self.varying[expression]

    def sign(self, expression: sp.Expr) -> int | None:
        """1 or -1 where a parameter expression is known to have that sign for all values of the parameters."""
        signed = {}
        for symbol in expression.free_symbols & set(self.ranges):
            low, high = map(sp.sympify, self.ranges[symbol])
            if low.is_positive or high.is_negative:
                signed[symbol] = sp.Dummy(positive=low.is_positive, negative=high.is_negative)
        known = expression.xreplace(signed)
        return 1 if known.is_positive else -1 if known.is_negative else None
