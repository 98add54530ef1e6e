"""Limit: asymptotes, residues of poles, growth orders."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import sympy as sp

from ratfit._condition.abstract import AbstractCondition, check_inside, needed, refuse_infinite, set_exact
from ratfit._parse import RatfitError
from ratfit._target import Target


@dataclass(frozen=True)
class Limit(AbstractCondition):
    """The limit of (f - minus)*scale at a place.

    Arguments: `at`, a number or an expression of the parameters inside the closed domain, or oo or -oo, inside the
    domain or beyond it; `scale` and `minus`, expressions of the variable; `equals`, the limit demanded. At infinity it
    is an asymptote (`minus` gives an oblique one its other terms), with a scale that vanishes at a place the residue of
    a pole there, which the fit may then have. At an end of the domain the limit is taken from inside. Raises
    RatfitError for a scale of zero.
    """

    at: sp.Expr
    scale: sp.Expr = sp.S.One
    minus: sp.Expr = sp.S.Zero
    equals: sp.Expr | None = None
    kind: ClassVar[str] = "limit"

    def __post_init__(self) -> None:
        for field in ("at", "scale", "minus", "equals"):
            set_exact(self, field)
        if self.at not in (sp.oo, -sp.oo):
            refuse_infinite(self.at, f"limit at {self.at}: a place is a number, oo or -oo")
        for field in ("scale", "minus"):
            refuse_infinite(getattr(self, field), f"limit at {self.at}: {field} must be finite and real")
        if self.scale == 0:
            raise RatfitError(f"limit at {self.at}: a scale of zero asks for nothing; leave it out or state another")

    @property
    def place(self) -> str:
        return str(self.at)

    @property
    def what(self) -> str:
        """What the limit is of, "f" or "(f - x/2)*x", as text."""
        inner = "f" if self.minus == 0 else f"f - ({self.minus})" if self.minus.is_Add else f"f - {self.minus}"
        bare = not self.scale.is_Add and sp.fraction(self.scale)[1] == 1
        scale = str(self.scale) if bare else f"({self.scale})"
        return inner if self.scale == 1 else f"({inner})*{scale}" if self.minus != 0 else f"{inner}*{scale}"

    def demanded(self, target: Target | None) -> sp.Expr:
        if self.equals is not None:
            return self.equals
        return needed(target, self).limit(self.at, self.scale, self.minus)

    def check(self, domain: tuple[sp.Expr, sp.Expr], what: str = "domain") -> None:
        if not self.at.is_infinite:
            check_inside("limit at", self.at, domain, what)
        elif what == "support" and self.at not in domain:
            raise RatfitError(f"limit at {self.at}: the fit ends where its support does, at {domain}; leave one out")

    def expressions(self) -> tuple[sp.Expr, ...]:
        return tuple(e for e in (self.at, self.scale, self.minus, self.equals) if e is not None)
