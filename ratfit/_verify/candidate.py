"""What is verified: a fraction without common factors."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from ratfit._fraction import reduced
from ratfit._solver import Meaning, Solution


@dataclass(frozen=True)
class Reduced:
    """factor*numerator/denominator without common factors, and what was cancelled."""

    factor: sp.Expr
    numerator: sp.Expr
    denominator: sp.Expr
    common: sp.Expr

    @property
    def expression(self) -> sp.Expr:
        return self.factor * self.numerator / self.denominator

    def put_in(self, meaning: Meaning) -> Reduced:
        """The same with what names in it stand for."""
        return Reduced(
            *(part.xreplace(meaning) for part in (self.factor, self.numerator, self.denominator, self.common))
        )


def without_common_factors(factor: sp.Expr, solution: Solution, x: sp.Symbol) -> Reduced:
    """The form's factor goes into the fraction where it shares a zero with it, and stays in front where it does not."""
    above, below = sp.fraction(sp.together(factor))
    merged = reduced(solution.numerator * above, solution.denominator * below, x) if factor.has(x) else None
    if merged is not None and merged[2] != 1:
        return Reduced(sp.S.One, *merged)
    return Reduced(factor, *reduced(solution.numerator, solution.denominator, x))
