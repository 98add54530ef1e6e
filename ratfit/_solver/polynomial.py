"""The polynomial route: all solutions of equations that are polynomial in the unknowns."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import sympy as sp

from ratfit._solver.elimination import Assignment, is_complex, solutions
from ratfit._solver.incomplete import solve_incomplete
from ratfit._solver.solution import Solution, Undecided
from ratfit._system import System, polynomial_equations


def solve_polynomial(system: System) -> list[Solution]:
    """Every solution of the cleared equations, spurious roots included; verifying tells them apart.

    A `Rational` form has a free scale. Its solutions are found patch by patch: first with a leading numerator
    coefficient of 1, as the 1994 paper writes Eq. 11, then with that coefficient 0 and the next one 1, and so on;
    the patches cover every fraction once. Incomplete derivative data of a fraction go another way, with fewer
    unknowns. Raises Undecided for a root that has no closed form.
    """
    if system.fraction and not system.integrals and system.completion.symbols:
        return solve_incomplete(system)
    shape = system.shape
    equations = polynomial_equations(system)
    if not all(e.is_polynomial(*shape.unknowns) for e in equations):
        raise Undecided("the equations are not polynomial in the unknowns of this form, which no route here solves")
    found = []
    for fixed in _patches(shape.unknowns) if shape.homogeneous else [{}]:
        unknowns = [u for u in shape.unknowns if u not in fixed]
        for assignment in solutions([e.subs(fixed) for e in equations], unknowns):
            values = {**fixed, **assignment}
            found.append(_solution(system, values))
    return [s for s in found if s.denominator != 0]


def _patches(unknowns: Sequence[sp.Symbol]) -> Iterator[Assignment]:
    above = [u for u in unknowns if u.name.startswith(unknowns[0].name.rstrip("0123456789"))]
    vanished: Assignment = {}
    for lead in reversed(above):
        yield {**vanished, lead: sp.S.One}
        vanished[lead] = sp.S.Zero


def _solution(system: System, values: Assignment) -> Solution:
    shape = system.shape
    free = {u: (-sp.oo, sp.oo) for u in shape.unknowns if u not in values}
    complex_ = next((u for u, v in values.items() if is_complex(v)), None)
    nature = f"complex: {complex_} = {values[complex_]}" if complex_ is not None else ""
    return Solution(shape.numerator.subs(values), shape.denominator.subs(values), free, nature)
