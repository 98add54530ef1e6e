"""The nonlinear route."""

from __future__ import annotations

from ratfit._solver.solution import Solution, Undecided
from ratfit._system import System


def solve_nonlinear(system: System) -> list[Solution]:
    raise Undecided("not yet")
