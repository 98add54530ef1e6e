"""Picks the route that a system allows."""

from __future__ import annotations

from ratfit._parse import RatfitError
from ratfit._solver.linear import solve_linear
from ratfit._solver.polynomial import solve_polynomial
from ratfit._solver.power import solve_power
from ratfit._solver.solution import Solution
from ratfit._system import System

ROUTES = {"linear": solve_linear, "polynomial": solve_polynomial, "power": solve_power}


def pick(system: System, route: str = "auto") -> str:
    """The name of the route to take; RatfitError for one that does not exist or cannot serve this system."""
    natural = "power" if system.shape.power is not None else "linear" if system.linear else "polynomial"
    if route not in ("auto", *ROUTES):
        raise RatfitError(f"unknown route {route!r}; known: auto, {', '.join(ROUTES)}")
    if route == "linear" and natural != "linear":
        raise RatfitError("these equations are not linear in the unknowns; take --route auto")
    if (route == "power") != (natural == "power") and route != "auto":
        raise RatfitError(f"the {route} route does not serve this form; take --route auto")
    return natural if route == "auto" else route


def solve(system: System, route: str) -> list[Solution]:
    """All that the named route finds; nothing is verified yet."""
    return ROUTES[route](system)
