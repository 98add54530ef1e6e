"""Roots along parameters: certified at the nodes of a grid, then recognised as formulas or interpolated between."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

import sympy as sp

from ratfit._parse import RatfitError
from ratfit._solver.nonlinear.assembly import Assembly
from ratfit._solver.nonlinear.certified import certified_root
from ratfit._solver.nonlinear.interpolation import interpolant
from ratfit._solver.nonlinear.recognise_function import recognised_function
from ratfit._solver.solution import Numbers, Solution, Table, Undecided
from ratfit._target import Parameter

GRIDS = (17, 33, 65)
"""Nodes of one parameter: the next number is tried where interpolation is ROUGH."""

ROUGH = 1e-8
"""Estimated error of an interpolant, relative to its size, above which more nodes are tried."""

FINEST = 10**5
"""Largest denominator of a node: short numbers let formulas be recognised."""

Node = tuple[sp.Rational, ...]


def tabulated(assembly: Assembly, parameters: Sequence[sp.Symbol], seed: int) -> Iterator[Solution]:
    """A solution for each branch of roots that reaches all nodes of a grid of the parameters.

    With one parameter the grid is made finer where interpolation between its nodes is poor. Raises Undecided for more
    than two parameters, infinite ranges, and where no branch reaches all nodes.
    """
    if not all(isinstance(p, Parameter) for p in parameters):
        raise Undecided(f"equations that are not linear need numbers for {', '.join(map(str, parameters))}")
    ordered = tuple(p for p in parameters if isinstance(p, Parameter))
    counts = GRIDS if len(ordered) == 1 else (None,)
    for count in counts:
        rough = False
        for branch in _branches(assembly, ordered, count, seed):
            found = _tabulated_branch(assembly, ordered, branch)
            if found is None:
                continue
            if found.error > ROUGH and found.guess is None and count != counts[-1]:
                rough = True
                break
            yield _solution(assembly, found)
        if not rough:
            return


def _branches(assembly: Assembly, parameters: tuple[Parameter, ...], count: int | None, seed: int) -> list:
    from ratfit._solver.nonlinear.grid import roots_on_grid

    try:
        branches = roots_on_grid(assembly.residuals, parameters, count, seed=seed)
    except RatfitError as error:
        raise Undecided(str(error)) from None
    whole = [branch for branch in branches if not branch.failed.any()]
    if branches and not whole:
        raise Undecided(
            f"no branch of solutions reaches over the whole ranges of the parameters{_reach(parameters, branches)}; "
            "narrow them"
        )
    return whole


def _reach(parameters: tuple[Parameter, ...], branches: list) -> str:
    """How far the branch that reaches farthest does, in words."""
    widest = max(branches, key=lambda branch: int((~branch.failed).sum()))
    reached = widest.parameters[~widest.failed]
    if not len(reached):
        return ""
    spans = zip(parameters, reached.min(0), reached.max(0), strict=True)
    ranges = (f"{p.name} from {low:.3g} to {high:.3g}" for p, low, high in spans)
    return f" (the longest was followed for {', '.join(ranges)})"


def _short(value: float) -> sp.Rational:
    nearest = Fraction(float(value)).limit_denominator(FINEST)
    return sp.Rational(nearest.numerator, nearest.denominator)


@dataclass(frozen=True)
class _Tabulated:
    """A branch at its nodes: the table, the interpolants and their estimated error, what is proved, and a guess."""

    table: Table
    between: tuple[sp.Expr, ...]
    error: float
    words: str
    guess: Solution | None


def _tabulated_branch(assembly: Assembly, parameters: tuple[Parameter, ...], branch) -> _Tabulated | None:
    """The roots of one branch, certified; None where a node's root is not one to 50 digits."""
    nodes = [tuple(_short(value) for value in row) for row in branch.parameters]
    rows, widest = [], sp.S.Zero
    for node, root in zip(nodes, branch.coefficients, strict=True):
        found = certified_root(assembly.residuals.at(dict(zip(parameters, node, strict=True))), root)
        if found is None:
            return None
        rows.append(found.numbers)
        widest = None if widest is None or found.radius is None else max(widest, sp.Rational(found.radius))
    if assembly.residuals.homogeneous:
        rows = _scaled(rows)
    columns = list(zip(*rows, strict=True))
    unknowns = assembly.residuals.unknowns
    proof = "not all certified" if widest is None else f"each within {sp.Float(widest, 2)} of a true root"
    words = f"found at {len(nodes)} values of {', '.join(p.name for p in parameters)}, {proof}; interpolated between"
    table = Table(parameters, tuple(nodes), unknowns, tuple(map(tuple, rows)), assembly.numerator, assembly.denominator)
    polynomials = [interpolant(parameters, nodes, column) for column in columns]
    error = max(p.error for p in polynomials)
    return _Tabulated(table, tuple(p.shortened() for p in polynomials), error, words, _guess(assembly, table))


def _solution(assembly: Assembly, found: _Tabulated) -> Solution:
    values = dict(zip(found.table.unknowns, found.between, strict=True))
    numbers = Numbers(assembly.numerical, found.words, found.guess, found.table)
    return Solution(assembly.numerator.subs(values), assembly.denominator.subs(values), numbers=numbers)


def _scaled(rows: list[tuple[sp.Rational, ...]]) -> list[tuple[sp.Rational, ...]]:
    """Rows with 1 in the column that stays farthest from zero."""
    pivot = max(range(len(rows[0])), key=lambda k: min(abs(row[k]) for row in rows))
    return [tuple(value / row[pivot] for value in row) for row in rows]


def _guess(assembly: Assembly, table: Table) -> Solution | None:
    """Coefficients that look like rational functions of one parameter, or of its root, for the caller to verify."""
    if len(table.parameters) > 1:
        return None
    places = [node[0] for node in table.nodes]
    found = {}
    for unknown, column in zip(table.unknowns, zip(*table.rows, strict=True), strict=True):
        formula = recognised_function(table.parameters[0], places, column)
        if formula is None:
            return None
        found[unknown] = formula
    whole = assembly.numerator.subs(found) / assembly.denominator.subs(found)
    return Solution(*sp.fraction(sp.factor(whole) if whole.is_rational_function() else whole))
