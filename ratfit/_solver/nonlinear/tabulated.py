"""Roots along parameters: certified at the nodes of a grid, then recognised as formulas or interpolated between."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

import sympy as sp

from ratfit._parse import RatfitError
from ratfit._solver.nonlinear.assembly import Assembly
from ratfit._solver.nonlinear.certified import certified_root
from ratfit._solver.nonlinear.interpolation import interpolant
from ratfit._solver.nonlinear.recognise_function import recognised_function
from ratfit._solver.solution import Numbers, Solution, Table, Undecided
from ratfit._target import Parameter

FINEST = 10**5
"""Largest denominator of a node: short numbers let formulas be recognised."""

Node = tuple[sp.Rational, ...]


def tabulated(assembly: Assembly, parameters: Sequence[sp.Symbol], seed: int) -> Iterator[Solution]:
    """A solution for each branch of roots that reaches all nodes of a grid of the parameters.

    Raises Undecided for more than two parameters, infinite ranges, and where no branch reaches all nodes.
    """
    from ratfit._solver.nonlinear.grid import roots_on_grid

    if not all(isinstance(p, Parameter) for p in parameters):
        raise Undecided(f"equations that are not linear need numbers for {', '.join(map(str, parameters))}")
    ordered = tuple(p for p in parameters if isinstance(p, Parameter))
    try:
        branches = roots_on_grid(assembly.residuals, ordered, seed=seed)
    except RatfitError as error:
        raise Undecided(str(error)) from None
    whole = [branch for branch in branches if not branch.failed.any()]
    if branches and not whole:
        raise Undecided("no branch of solutions reaches over the whole ranges of the parameters; narrow them")
    for branch in whole:
        nodes = [tuple(_short(value) for value in row) for row in branch.parameters]
        solution = _solution(assembly, ordered, nodes, branch.coefficients)
        if solution is not None:
            yield solution


def _short(value: float) -> sp.Rational:
    nearest = Fraction(float(value)).limit_denominator(FINEST)
    return sp.Rational(nearest.numerator, nearest.denominator)


def _solution(assembly: Assembly, parameters: tuple[Parameter, ...], nodes: list[Node], roots) -> Solution | None:
    """The solution of one branch; None where a node's root is not one to 50 digits."""
    rows, widest = [], sp.S.Zero
    for node, root in zip(nodes, roots, strict=True):
        found = certified_root(assembly.residuals.at(dict(zip(parameters, node, strict=True))), root)
        if found is None:
            return None
        rows.append(found.numbers)
        widest = None if widest is None or found.radius is None else max(widest, sp.Rational(found.radius))
    if assembly.residuals.homogeneous:
        rows = _scaled(rows)
    columns = list(zip(*rows, strict=True))
    unknowns = assembly.residuals.unknowns
    between = [interpolant(parameters, nodes, column) for column in columns]
    proof = "not all certified" if widest is None else f"each within {sp.Float(widest, 2)} of a true root"
    words = f"found at {len(nodes)} values of {', '.join(p.name for p in parameters)}, {proof}; interpolated between"
    table = Table(parameters, tuple(nodes), tuple(u.name for u in unknowns), tuple(map(tuple, rows)))
    found_ = dict(zip(unknowns, between, strict=True))
    return Solution(
        assembly.numerator.subs(found_),
        assembly.denominator.subs(found_),
        numbers=Numbers(assembly.numerical, words, _guess(assembly, parameters, nodes, columns), table),
    )


def _scaled(rows: list[tuple[sp.Rational, ...]]) -> list[tuple[sp.Rational, ...]]:
    """Rows with 1 in the column that stays farthest from zero."""
    pivot = max(range(len(rows[0])), key=lambda k: min(abs(row[k]) for row in rows))
    return [tuple(value / row[pivot] for value in row) for row in rows]


def _guess(
    assembly: Assembly, parameters: tuple[Parameter, ...], nodes: list[Node], columns: Sequence[Sequence[sp.Rational]]
) -> Solution | None:
    """Coefficients that look like rational functions of one parameter, or of its root, for the caller to verify."""
    if len(parameters) > 1:
        return None
    places = [node[0] for node in nodes]
    found = {}
    for unknown, column in zip(assembly.residuals.unknowns, columns, strict=True):
        formula = recognised_function(parameters[0], places, column)
        if formula is None:
            return None
        found[unknown] = formula
    whole = assembly.numerator.subs(found) / assembly.denominator.subs(found)
    return Solution(*sp.fraction(sp.cancel(whole) if whole.is_rational_function() else whole))
