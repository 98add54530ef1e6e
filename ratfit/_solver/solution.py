"""Solution: one set of coefficients that satisfies the equations, before anything is verified."""

from __future__ import annotations

from dataclasses import dataclass, field

import sympy as sp


class Undecided(Exception):
    """A route ended without an answer for a reason that the text gives; never raised out of `derive`."""


@dataclass(frozen=True)
class Solution:
    """Numerator and denominator with the unknowns put in (the form's factor is left out).

    `free` holds what stays open, each with its range; `nature` is a reason for rejecting it at once, or "".
    """

    numerator: sp.Expr
    denominator: sp.Expr
    free: dict[sp.Symbol, tuple[sp.Expr, sp.Expr]] = field(default_factory=dict)
    nature: str = ""
