"""The linear route: the null space of the conditions over an exact field, the parameters kept symbolic."""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace

import sympy as sp

from ratfit._condition import AbstractPointCondition, Limit
from ratfit._field import Field, is_zero, ranks_agree
from ratfit._generators import far_turns, sampled
from ratfit._rows import limit_rows, rows
from ratfit._solver.naming import Meaning, named, names_of
from ratfit._solver.solution import Solution, Undecided
from ratfit._system import System, columns, completed

NESTED = 2
"""Roots within each other from which on a number is given a name: the exact field of one root is small."""

NOTHING = 1e-30
"""A denominator below this vanishes."""


def solve_linear(system: System) -> list[Solution]:
    """All fractions of the form that satisfy the linear equations: none, one, or one family.

    Where numbers have roots within roots of parameters the algebra is done in names for them.
    Raises Undecided when the exact rank and the numerical one differ: constants are then related in a way that
    the exact field does not know.
    """
    if any(is_zero(e) is False for e in system.completion.leftover):
        return []
    return _in_names(system) or fractions(system, null_space(completed(system)))


def _in_names(system: System) -> list[Solution]:
    """The same with names for numbers with roots within roots; nothing where there are none, or names would differ.

    The algebra of names alone is that of a field of fractions. It says the same as that of the numbers where the rank
    does not drop and no denominator vanishes when these are put in.
    """
    meaning = names_of(system.demands, NESTED)
    points = all(isinstance(c, AbstractPointCondition) for c in completed(system).conditions)
    if not meaning or not points or len(completed(system).conditions) > len(system.conditions):
        return []
    plain = replace(system, demands=named(system.demands, meaning))
    matrix = rows(plain)
    vectors = kernel(matrix, len(columns(plain.shape)[0]))
    numbers = [[e.xreplace(meaning) for e in row] for row in matrix]
    solution = fractions(plain, vectors)
    if not solution or not ranks_agree(numbers, len(numbers[0]) - len(vectors)):
        return []
    return [replace(s, meaning=meaning) for s in solution if _is_finite(s, meaning)]


def _is_finite(solution: Solution, meaning: Meaning) -> bool:
    """Whether no coefficient of a fraction loses its denominator when the names' numbers are put in."""
    divisors = [sp.fraction(sp.together(part))[1] for part in (solution.numerator, solution.denominator)]
    return all(min(map(abs, sampled(divisor.xreplace(meaning)))) > NOTHING for divisor in divisors)


def null_space(system: System) -> list[list[sp.Expr]]:
    """A basis of the coefficients that satisfy a completed system's linear equations.

    Where all of them make Q vanish to a higher order at the place of a limit than its rows were made for, the rows
    of the next order are added.
    """
    limits = [(c, d) for c, d in system.pairs if isinstance(c, Limit)]
    raised = dict.fromkeys((limit for limit, _ in limits), 0)
    while True:
        vectors = kernel(rows(system, raised), len(columns(system.shape)[0]))
        stuck = [c for c, d in limits if vectors and _vanishes(limit_rows(system, c, d, raised[c])[1], vectors)]
        if not stuck or max(raised.values()) > 2 * len(system.shape.unknowns):
            return vectors
        raised |= {limit: raised[limit] + 1 for limit in stuck}


def kernel(matrix: list[list[sp.Expr]], width: int) -> list[list[sp.Expr]]:
    """A basis of the vectors that every row sends to zero, its symbols taken for independent.

    Sines and cosines of far turns too, where the rank is the same for it: the answer is then short to write.
    """
    matrix = [_without_content(row) for row in matrix]
    apart = far_turns([e for row in matrix for e in row])
    vectors = _null_vectors(matrix, width, apart) if apart else []
    if vectors and ranks_agree(matrix, width - len(vectors)) and ranks_agree(vectors, len(vectors)):
        return vectors
    vectors = _null_vectors(matrix, width)
    rank = width - len(vectors)
    if not ranks_agree(matrix, rank):
        raise Undecided(
            f"the equations have rank {rank} exactly but not numerically: some constants of the conditions are related "
            "in a way that is not known here; state their values with equals"
        )
    return vectors


def _null_vectors(
    matrix: list[list[sp.Expr]], width: int, apart: AbstractSet[sp.Expr] = frozenset()
) -> list[list[sp.Expr]]:
    field = Field([e for row in matrix for e in row], apart)
    basis = field.null_space([[field.encode(e) for e in row] for row in matrix], width)
    return [[field.decode(e) for e in v] for v in basis]


def _without_content(row: list[sp.Expr]) -> list[sp.Expr]:
    """A row divided by the roots in its first term: one radical for a whole row would make the field larger for all."""
    first = next((sp.Add.make_args(e)[0] for e in row if e != 0), sp.S.One)
    roots = [f for f in sp.Mul.make_args(first) if f.is_Pow and not f.exp.is_Integer and f.exp.is_Rational]
    if not roots:
        return row
    return [sp.expand(e / sp.Mul(*roots)) for e in row]


def _vanishes(functional: list[sp.Expr], vectors: list[list[sp.Expr]]) -> bool:
    return all(is_zero(sp.Add(*(f * e for f, e in zip(functional, v, strict=True)))) is True for v in vectors)


def fractions(system: System, vectors: list[list[sp.Expr]]) -> list[Solution]:
    """The fractions with these coefficients: one, or a family with a free name for each vector but one."""
    pairs, has_fixed = columns(system.shape)
    scale = len(pairs) - 1 if has_fixed else _scale_column(system, vectors)
    frees = [_free_column(v) for v in vectors]
    pivot = next((i for i, v in enumerate(vectors) if v[scale] != 0), None)
    if pivot is None:
        return []
    if len(vectors) > 1 or has_fixed:
        vectors = _with_one_at(scale, pivot, vectors)
    names = [system.shape.unknowns[c].name for i, c in enumerate(frees) if i != pivot]
    free = [sp.Symbol(name, real=True) for name in names]
    return [Solution(*combination(pairs, [sp.S.One, *free], vectors), dict.fromkeys(free, (-sp.oo, sp.oo)))]


def combination(
    pairs: Sequence[tuple[sp.Expr, sp.Expr]], weights: Sequence[sp.Expr], vectors: Sequence[Sequence[sp.Expr]]
) -> tuple[sp.Expr, sp.Expr]:
    """Numerator and denominator of a form's columns with the weighted sum of vectors for coefficients."""
    combined = [sp.Add(*(w * v[i] for w, v in zip(weights, vectors, strict=True))) for i in range(len(pairs))]
    above = sp.Add(*(c * n for c, (n, _) in zip(combined, pairs, strict=True)))
    below = sp.Add(*(c * d for c, (_, d) in zip(combined, pairs, strict=True)))
    return above, below


def _scale_column(system: System, vectors: list[list[sp.Expr]]) -> int:
    """The coefficient that is 1 in a family: the scale of a fraction is free.

    The first coefficient of the denominator that need not vanish; what this loses is the fractions without it.
    """
    below = [i for i, u in enumerate(system.shape.unknowns) if system.shape.denominator.has(u)]
    return next((i for i in below if any(v[i] != 0 for v in vectors)), _free_column(vectors[0]) if vectors else 0)


def _with_one_at(column: int, pivot: int, vectors: list[list[sp.Expr]]) -> list[list[sp.Expr]]:
    """A point with 1 in a column, then directions with 0 there, each with 1 in its own free column."""
    point = [e / vectors[pivot][column] for e in vectors[pivot]]
    others = [[e / v[_free_column(v)] for e in v] for i, v in enumerate(vectors) if i != pivot]
    return [point] + [[e - v[column] * p for e, p in zip(v, point, strict=True)] for v in others]


def _free_column(vector: list[sp.Expr]) -> int:
    """Reduced echelon form: a vector's own free column is the last in which it is not zero."""
    return max(i for i, e in enumerate(vector) if e != 0)
