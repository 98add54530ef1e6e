"""Clock: the time of a study, shared out among calls of sympy that nobody can bound beforehand."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any, TypeVar

import sympy as sp
from sympy.polys.polyerrors import BasePolynomialError

from ratfit._deadline import TimeLimit

Found = TypeVar("Found")

CALL_SECONDS = 1.0
"""How long one call may last, of the processor's time: what sympy finds at all it mostly finds sooner."""

MOMENT = 0.02
"""Seconds in which nothing is worth starting."""

# What sympy raises when it cannot do what it was asked; RatfitError is a ValueError.
FAILURES = (
    *(NotImplementedError, ValueError, TypeError, RecursionError, AttributeError, ArithmeticError, LookupError),
    *(BasePolynomialError, AssertionError),
)


class Clock:
    """Counts down from `seconds`; `notes` collects what ran out of time."""

    def __init__(self, seconds: float) -> None:
        self.end = time.monotonic() + seconds
        self.notes: list[str] = []
        self.solved: dict[Any, list[sp.Expr]] = {}  # equations that sympy was given, asked once each

    def left(self) -> float:
        """Seconds that remain, never less than a moment."""
        return max(self.end - time.monotonic(), 0.01)

    def attempt(self, call: Callable[[], Found], what: str = "", seconds: float = CALL_SECONDS) -> Found | None:
        """What the call returns; None where it fails, or runs out of time, which is noted if `what` names it."""
        allowed = min(seconds, self.left() / 2)
        if allowed < MOMENT:
            return None
        found: Found | None = None
        with TimeLimit(allowed) as limit:
            try:
                found = call()
            except FAILURES:
                return None
        if limit.passed and what:
            self.notes.append(f"{what}: no closed form within {allowed:.2g} s")
        return None if limit.passed else found
