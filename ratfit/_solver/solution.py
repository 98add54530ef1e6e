"""Solution: one set of coefficients that satisfies the equations, before anything is verified."""

from __future__ import annotations

from dataclasses import dataclass, field

import sympy as sp

from ratfit._condition import AbstractCondition
from ratfit._solver.naming import Meaning


class Undecided(Exception):
    """A route ended without an answer for a reason that the text gives; never raised out of `derive`."""


@dataclass(frozen=True)
class Solution:
    """Numerator and denominator with the unknowns put in (the form's factor is left out).

    `free` holds what stays open, each with its range; `nature` is a reason for rejecting it at once, or "". `numbers`
    says that coefficients are numbers found by iteration, written as rationals of 60 digits, and what stands behind.
    `meaning` holds names in numerator and denominator that stand for numbers of the conditions.
    """

    numerator: sp.Expr
    denominator: sp.Expr
    free: dict[sp.Symbol, tuple[sp.Expr, sp.Expr]] = field(default_factory=dict)
    nature: str = ""
    numbers: Numbers | None = None
    meaning: Meaning = field(default_factory=dict)


@dataclass(frozen=True)
class Numbers:
    """Coefficients that were found as numbers.

    `conditions` are those that they keep to their last digit and not by algebra; `certificate` says in words what is
    proved; `guess` is a closed form that looks like them, or None; `table` holds coefficients that were found at nodes
    of the parameters, and interpolated between.
    """

    conditions: tuple[AbstractCondition, ...]
    certificate: str
    guess: Solution | None = None
    table: Table | None = None


@dataclass(frozen=True)
class Table:
    """Numerator and denominator in `unknowns`, and these at nodes of the parameters.

    `nodes` holds a tuple of the parameters' values for each row of `rows`, which holds the unknowns' to 60 digits.
    """

    parameters: tuple[sp.Symbol, ...]
    nodes: tuple[tuple[sp.Expr, ...], ...]
    unknowns: tuple[sp.Symbol, ...]
    rows: tuple[tuple[sp.Expr, ...], ...]
    numerator: sp.Expr
    denominator: sp.Expr
