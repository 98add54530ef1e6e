"""Peer: another way to compute the exact function, to be measured beside a fit; Unavailable: why there is none."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from ratfit._fit import Fit
from ratfit._poles import poles
from ratfit._problem import Problem
from ratfit._schedule import Cost, schedule
from ratfit.baselines.original import Original


@dataclass(frozen=True)
class Peer:
    """What a fit must beat, at the values of the parameters that it was made for: it is measured like a fit.

    `formula` is in the variable alone. `about` says in a line what it is: its size, how it was made, and the poles on
    the domain, where it has any. `cost` is that of its best arrangement; a table look-up counts as one function.
    """

    name: str
    problem: Problem
    formula: sp.Expr
    about: str
    cost: Cost


@dataclass(frozen=True)
class Unavailable:
    """A peer that cannot be made here, and the reason."""

    name: str
    reason: str


def peer(name: str, fit: Fit, original: Original, formula: sp.Expr, about: str) -> Peer:
    """The record of a peer: its cost is counted, and the poles that it has on the domain are told."""
    ranges = {original.variable: original.ends}
    found = pole_places(formula, original)
    told = f"; infinite inside the domain, at {', '.join(found)}" if found else ""
    return Peer(name, fit.problem, formula, about + told, schedule(formula, original.variable, ranges).cost)


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
        return int(sp.degree(above, x)), int(sp.degree(below, x))
    shape = fit.problem.form.shape(x, ())
    count = len(shape.unknowns) - shape.homogeneous
    return count - 1 - (count - 1) // 2, (count - 1) // 2


Values = Mapping[str, float | str]
