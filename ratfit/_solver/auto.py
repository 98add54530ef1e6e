"""Picks the route that a system allows."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import sympy as sp

from ratfit._condition import Equation, Integral, Limit
from ratfit._integral import Divergent
from ratfit._parse import RatfitError
from ratfit._rows import rows
from ratfit._solver.linear import solve_linear
from ratfit._solver.nonlinear import solve_nonlinear
from ratfit._solver.polynomial import solve_polynomial
from ratfit._solver.power import solve_power
from ratfit._solver.solution import Solution
from ratfit._system import System, completed, residuals

EXACT: Mapping[str, Callable[[System], list[Solution]]] = {
    "linear": solve_linear,
    "polynomial": solve_polynomial,
    "power": solve_power,
}
ROUTES = (*EXACT, "nonlinear")


def pick(system: System, route: str = "auto") -> str:
    """The name of the route to take; RatfitError for one that does not exist or cannot serve this system."""
    if route not in ("auto", *ROUTES):
        raise RatfitError(f"unknown route {route!r}; known: auto, {', '.join(ROUTES)}")
    natural = _natural(system)
    if route in ("auto", natural, "nonlinear"):
        return natural if route == "auto" else route
    if route == "linear":
        raise RatfitError("these equations are not linear in the unknowns; take --route auto")
    if route == "power" or natural == "power" or not is_polynomial(system):
        raise RatfitError(f"the {route} route does not serve this form and these conditions; take --route auto")
    return route


def _natural(system: System) -> str:
    if system.shape.power is not None:
        return (
            "power" if not any(isinstance(c, (Limit, Integral, Equation)) for c in system.conditions) else "nonlinear"
        )
    if is_linear(system):
        return "linear"
    return "polynomial" if is_polynomial(system) else "nonlinear"


def is_linear(system: System) -> bool:
    """Whether the null space of the rows is all there is to find."""
    if not system.fraction or system.integrals or system.completion.symbols:
        return False
    if not any(isinstance(c, (Integral, Limit)) for c in system.conditions):
        return True
    try:
        rows(completed(system))
    except Divergent:
        raise
    except RatfitError:
        return False
    return True


def is_polynomial(system: System) -> bool:
    """Whether the equations are polynomial in the unknowns, or in the derivatives that nobody stated."""
    shape = system.shape
    if system.fraction and not system.integrals and not is_linear(system):
        completion = system.completion
        return bool(completion.symbols) and all(e.is_polynomial(*completion.symbols) for e in completion.leftover)
    if not (shape.numerator.is_polynomial(*shape.unknowns) and shape.denominator.is_polynomial(*shape.unknowns)):
        return False
    try:
        special = [r for c, d in system.pairs if isinstance(c, (Integral, Limit)) for r in residuals(system, c, d)]
    except RatfitError:
        return False
    return all(sp.fraction(sp.together(r))[0].is_polynomial(*shape.unknowns) for r in special)


def solve(system: System, route: str, seed: int = 0) -> Iterable[Solution]:
    """All that the named route finds, perhaps one by one; nothing is verified yet."""
    return solve_nonlinear(system, seed) if route == "nonlinear" else EXACT[route](system)
