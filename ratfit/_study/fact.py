"""Fact and Study: what was found about a function."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from ratfit._condition import AbstractCondition
from ratfit._problem import Problem
from ratfit._target import Target

SYMBOLIC = "symbolic"
"""How a fact was found that algebra proves, and that numbers at 50 digits confirm."""


@dataclass(frozen=True)
class Fact:
    """One thing that is true of the target.

    `kind` is a word ("value", "zero", "maximum", "pole", "parity", ...); `text` says the fact; `condition` is the
    kernel condition that keeps it, None where there is none; `found` is "symbolic", or says what stands behind it:
    "numeric to 30 digits", "no change of sign of f' seen at 811 points". `place` is where it holds and `value` the
    number it states, None where there is no one such; `form` is a key and value of a form that keeps it by itself, as
    in ("parity", "odd").
    """

    kind: str
    text: str
    condition: AbstractCondition | None = None
    found: str = SYMBOLIC
    place: sp.Expr | None = None
    value: sp.Expr | None = None
    form: tuple[str, str] | None = None


@dataclass(frozen=True)
class Study:
    """All facts about a target that were found, in the order of their groups.

    `notes` say what was not found and why, and how far a search reached; `suggested` is a problem made of these
    facts that was derived on trial, None where no trial ended with an answer.
    """

    target: Target
    facts: tuple[Fact, ...]
    notes: tuple[str, ...] = ()
    suggested: Problem | None = None

    def of(self, *kinds: str) -> tuple[Fact, ...]:
        """The facts of these kinds."""
        return tuple(fact for fact in self.facts if fact.kind in kinds)
