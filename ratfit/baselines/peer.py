"""Peer: another way to compute the exact function, to be measured beside a fit; Unavailable: why there is none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import sympy as sp

from ratfit._fit import Fit
from ratfit._poles import poles
from ratfit._problem import Problem
from ratfit._schedule import Cost, Schedule, schedule
from ratfit.baselines.original import Original

WORSE = 4
"""How many times its error as written an arrangement may have before another way of writing is tried."""


ROUNDING = 2.0**-22
"""Errors below four roundings of float32 are one and the same: they say nothing of the way of writing."""


@dataclass(frozen=True, repr=False)
class Peer:
    """What a fit must beat, at the values of the parameters that it was made for: it is measured like a fit.

    `formula` is in the variable alone. `about` says in a line what it is: its size, how it was made, its operations,
    and its poles on the domain, where it has any. `cost` is that of its best arrangement; a table look-up counts as
    one function.
    """

    name: str
    problem: Problem
    formula: sp.Expr
    about: str
    cost: Cost

    def __repr__(self) -> str:
        return f"<Peer {self.name} of {self.problem.name}: {self.about}>"


@dataclass(frozen=True)
class Unavailable:
    """A peer that cannot be made here, and the reason."""

    name: str
    reason: str


def peer(name: str, fit: Fit, original: Original, formula: sp.Expr, about: str) -> Peer:
    """The record of a peer: its operations are counted, and the poles that it has on the domain are told."""
    cost = _arranged(formula, original).cost
    counted = [f"{count} {kind}" for kind, count in cost.as_dict().items() if kind != "other" and count]
    found = pole_places(formula, original)
    told = [f"infinite inside the domain, at {', '.join(found)}"] if found else []
    return Peer(name, fit.problem, formula, "; ".join([about, *([", ".join(counted)] if counted else []), *told]), cost)


def stablest(formulas: Sequence[sp.Expr], original: Original) -> sp.Expr:
    """Of several ways to write one function, the one with the smallest error in float32; of equal ones the first.

    It is the schedule of a formula that is measured, and that may round worse than the formula as written: such a way
    of writing is passed over.
    """
    errors = [max(original.float32_error(formula), ROUNDING) for formula in formulas]
    arranged: list[float] = []
    ranked = sorted(range(len(formulas)), key=errors.__getitem__)
    for place in ranked:
        found = _arranged(formulas[place], original)
        arranged.append(original.float32_error(found.result, (*found.constants, *found.steps)))
        if arranged[-1] <= WORSE * errors[place]:
            return formulas[place]
    return formulas[ranked[min(range(len(ranked)), key=arranged.__getitem__)]]


@lru_cache(maxsize=100)
def _arranged(formula: sp.Expr, original: Original) -> Schedule:
    return schedule(formula, original.variable, {original.variable: original.ends})


def pole_places(formula: sp.Expr, original: Original) -> list[str]:
    """The places on the domain at which a fraction of polynomials is infinite, as text."""
    below = sp.fraction(formula)[1]
    return [f"{float(place):.4g}" for place, _ in poles(below, original.variable, original.ends)]


def degrees(fit: Fit) -> tuple[int, int]:
    """The degrees of a fit's numerator and denominator in the variable.

    Of a fit that is no fraction of polynomials, a root or a power, those of the fraction with as many free
    coefficients as its form has unknowns.
    """
    x = fit.problem.variable
    above, below = sp.fraction(sp.together(fit.chosen))
    if above.is_polynomial(x) and below.is_polynomial(x):
        return _degree(above, x), _degree(below, x)
    shape = fit.problem.form.shape(x, ())
    count = len(shape.unknowns) - shape.homogeneous
    return count - 1 - (count - 1) // 2, (count - 1) // 2


def _degree(polynomial: sp.Expr, x: sp.Symbol) -> int:
    """The degree in x, that of zero too."""
    return 0 if polynomial == 0 else int(sp.degree(polynomial, x))
