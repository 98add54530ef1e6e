"""The polynomial route for incomplete derivative data: f(0) and f''(0) without f'(0), say.

With a symbol for each missing derivative the equations are linear again. More equations than coefficients allow have a
null space only where all largest minors vanish: polynomial equations in the few symbols, in place of the many unknowns.
"""

from __future__ import annotations

from itertools import combinations, islice

import sympy as sp

from ratfit._field import Field
from ratfit._rows import rows
from ratfit._solver.elimination import is_complex, solutions
from ratfit._solver.linear import fractions, null_space
from ratfit._solver.solution import Solution
from ratfit._system import System, columns, completed, of_pairs

MAX_MINORS = 30
"""Minors beyond that many add nothing new in practice; verification would reject what they had excluded."""


def solve_incomplete(system: System) -> list[Solution]:
    """All fractions that keep the conditions; a missing derivative that stays open is a free name of the answer."""
    whole, symbols = completed(system), system.completion.symbols
    matrix = rows(whole)
    width = len(columns(system.shape)[0])
    field = Field([*(e for row in matrix for e in row), *symbols])
    minors = islice(combinations(matrix, width), MAX_MINORS)
    equations = [field.decode(field.determinant([[field.encode(e) for e in row] for row in minor])) for minor in minors]
    equations += system.completion.leftover
    found = []
    for assignment in solutions(equations, symbols):
        if bad := [s for s, value in assignment.items() if is_complex(value)]:
            nature = f"complex: the derivative {bad[0]} that nobody stated would be {assignment[bad[0]]}"
            found.append(Solution(system.shape.numerator, system.shape.denominator, nature=nature))
            continue
        open_ = {s: (-sp.oo, sp.oo) for s in symbols if s not in assignment}
        known = of_pairs(whole, [(c, d.subs(assignment)) for c, d in whole.pairs])
        for solution in fractions(system, null_space(known)):
            found.append(
                Solution(solution.numerator, solution.denominator, {**solution.free, **open_}, solution.nature)
            )
    return found
