"""The linear route: the null space of the conditions over an exact field, the parameters kept symbolic."""

from __future__ import annotations

import sympy as sp

from ratfit._field import Field, ranks_agree
from ratfit._solver.solution import Solution, Undecided
from ratfit._system import System, columns, rows


def solve_linear(system: System) -> list[Solution]:
    """All fractions of the form that satisfy the linear equations: none, one, or one family.

    Raises Undecided when the exact rank and the numerical one differ: constants are then related in a way that
    the exact field does not know.
    """
    return fractions(system, [row for _, row in rows(system)])


def fractions(system: System, matrix: list[list[sp.Expr]]) -> list[Solution]:
    """The fractions whose coefficients a matrix sends to zero, its symbols taken for independent."""
    pairs, has_fixed = columns(system.shape)
    field = Field([e for row in matrix for e in row])
    basis = field.null_space([[field.encode(e) for e in row] for row in matrix], len(pairs))
    rank = len(pairs) - len(basis)
    if not ranks_agree(matrix, rank):
        raise Undecided(
            f"the equations have rank {rank} exactly but not numerically: some constants of the conditions are related "
            "in a way that is not known here; state their values with equals"
        )
    vectors = [[field.decode(e) for e in v] for v in basis]
    if has_fixed:
        vectors = _with_one_last(vectors)
    if not vectors:
        return []
    free = _free_names(system, vectors)
    if free and not has_fixed:
        vectors = [[e / v[_free_column(v)] for e in v] for v in vectors]
    weights = [sp.S.One, *free]
    combined = [sp.Add(*(w * v[i] for w, v in zip(weights, vectors, strict=True))) for i in range(len(pairs))]
    above = sp.Add(*(c * n for c, (n, _) in zip(combined, pairs, strict=True)))
    below = sp.Add(*(c * d for c, (_, d) in zip(combined, pairs, strict=True)))
    return [Solution(above, below, dict.fromkeys(free, (-sp.oo, sp.oo)))]


def _with_one_last(vectors: list[list[sp.Expr]]) -> list[list[sp.Expr]]:
    """A point with the fixed column at 1, then directions with it at 0; nothing if the fixed column must vanish."""
    pivot = next((v for v in vectors if v[-1] != 0), None)
    if pivot is None:
        return []
    point = [e / pivot[-1] for e in pivot]
    others = [v for v in vectors if v is not pivot]
    return [point] + [[e - v[-1] * p for e, p in zip(v, point, strict=True)] for v in others]


def _free_names(system: System, vectors: list[list[sp.Expr]]) -> list[sp.Symbol]:
    """The coefficients that stay open: the free columns of all vectors but the first, whose weight is 1.

    The scale of a fraction is free, so one weight may be 1; what it loses is the limit of infinite free ones.
    """
    names = (system.shape.unknowns[_free_column(v)].name for v in vectors[1:])
    return [sp.Symbol(name, real=True) for name in names]


def _free_column(vector: list[sp.Expr]) -> int:
    """Reduced echelon form: a vector's own free column is the last in which it is not zero."""
    return max(i for i, e in enumerate(vector) if e != 0)
