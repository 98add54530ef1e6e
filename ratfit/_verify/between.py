"""Interpolated coefficients: what the conditions are worth at the nodes of the parameters, and between."""

from __future__ import annotations

import itertools
from dataclasses import replace

import mpmath
import sympy as sp

from ratfit._condition import AbstractCondition
from ratfit._fit import Checked
from ratfit._solver import Table
from ratfit._system import System
from ratfit._verify.candidate import Reduced
from ratfit._verify.numerically import numerical_residual

LOOSEST = mpmath.mpf("1e-6")
"""Residuals above this, relative to the size of the demand, between the nodes: then interpolation is no answer."""

MOST = 40
"""Places between the nodes at which residuals are measured."""

Place = dict[sp.Symbol, sp.Expr]


def nodes_of(table: Table, candidate: Reduced) -> list[tuple[Place, Reduced]]:
    """A few nodes, the outermost among them, each with the candidate that its row stands for, to all digits."""
    chosen = {0, len(table.nodes) // 2, len(table.nodes) - 1}
    found = []
    for k in sorted(chosen):
        row = dict(zip(table.unknowns, table.rows[k], strict=True))
        there = replace(candidate, numerator=table.numerator.subs(row), denominator=table.denominator.subs(row))
        found.append((dict(zip(table.parameters, table.nodes[k], strict=True)), there))
    return found


def places_between(table: Table) -> list[Place]:
    """The ends of the ranges, and the middles between neighbouring nodes, thinned out where they are many."""
    columns = []
    for place, parameter in enumerate(table.parameters):
        values = sorted({node[place] for node in table.nodes})
        middles = [(a + b) / 2 for a, b in itertools.pairwise(values)]
        columns.append([parameter.low, *middles, parameter.high])
    grid = list(itertools.product(*columns))
    step = max(1, len(grid) // MOST)
    kept = [*grid[::step], grid[-1]]
    return [dict(zip(table.parameters, values, strict=True)) for values in kept]


def measured_between(
    system: System, condition: AbstractCondition, demand: sp.Expr, candidate: Reduced, table: Table
) -> Checked:
    """A condition with its largest residual between the nodes: it holds where that is below LOOSEST."""
    places = places_between(table)
    residual = numerical_residual(system, condition, demand, candidate.expression, places)
    sizes = [abs(mpmath.mpf(str(sp.N(demand.xreplace(place), 20)))) for place in places]
    return Checked(condition, demand, bool(residual < LOOSEST * (1 + max(sizes))), float(residual))
