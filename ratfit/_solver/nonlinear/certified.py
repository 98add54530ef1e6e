"""A float's root, polished and proved."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from ratfit._solver.nonlinear.krawczyk import certificate
from ratfit._solver.nonlinear.polish import polished
from ratfit._solver.nonlinear.residuals import Residuals

DIGITS = 60
"""Digits that roots are polished to; fewer are shown."""


@dataclass(frozen=True)
class Root:
    """A root to DIGITS digits; `radius` says within what a true one lies, None where `reason` says why not proved."""

    numbers: tuple[sp.Rational, ...]
    radius: str | None
    reason: str

    @property
    def words(self) -> str:
        """What is proved."""
        if self.radius is None:
            return f"not certified: {self.reason}"
        part = "in part " if "not proved" in self.reason else ""
        return f"{part}certified by balls: {self.reason}"


def certified_root(residuals: Residuals, start) -> Root | None:
    """The root near a start, an array of floats; None where Newton's method finds none."""
    point = polished(residuals, [float(value) for value in start], DIGITS)
    if point is None:
        return None
    proof = certificate(residuals, point)
    numbers = tuple(sp.Rational(value.mid().str(DIGITS + 10, radius=False)) for value in point)
    return Root(numbers, proof.radius, proof.reason)
