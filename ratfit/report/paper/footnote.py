"""Footnote 3 of schlick1994: Eq. 16 in place of Smith's function, over pairs of directions.

Eq. 16 depends on four cosines of a view V and a light V' to the normal N and to the half vector H, Smith's product
G(v) G(v') of Eqs. 17 and 18 on two of them. A pair is written here in the angles or heights that are drawn uniformly,
one of them the variable and the others parameters drawn at random, so that it is measured as any fit is.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from ratfit._problem import Reference
from ratfit._target import Parameter, Target, parameter
from ratfit.gallery import card

PLACE = "Eq. 16"
EPSILON = 0.53
"""What the footnote prints: 53 %."""

_SHORT = sp.Rational(10**9 - 1, 10**9)
"""The share of a range that is taken, short of an end: with V and V' at opposite horizons Eq. 16 is 0/0, and beyond the
zenith a sine is not real."""


@dataclass(frozen=True)
class Question:
    """Of a `Problem` what measuring asks for; nothing is derived here, so it has no conditions and no form."""

    name: str
    variable: sp.Symbol
    domain: tuple[sp.Expr, sp.Expr]
    target: Target
    references: tuple[Reference, ...]
    parameters: Mapping[Parameter, tuple[sp.Expr, sp.Expr]]


@dataclass(frozen=True)
class Stated:
    """A formula that is measured as a fit is, without having been derived."""

    problem: Question
    formula: sp.Expr

    @property
    def drawn(self) -> tuple[str, ...]:
        """The parameters that make up the pair together with the variable: always random."""
        return tuple(symbol.name for symbol in self.problem.parameters if symbol.name != "m")


def torrance_sparrow(t: sp.Expr, u: sp.Expr, v: sp.Expr, v_: sp.Expr) -> sp.Expr:
    """schlick1994, Eq. 16."""
    return sp.Min(1, 2 * t * v / u, 2 * t * v_ / u)


def in_plane() -> Stated:
    """V and V' in a plane with N, at angles s and a to it, both uniform on (-pi/2, pi/2)."""
    right = sp.pi / 2
    # Short by unequal shares: the middle of the range would be the normal itself, where Eq. 18 is inf/inf.
    s, a = sp.Symbol("s", real=True), parameter("a", -right * _SHORT, right * _SHORT**2)
    formula = torrance_sparrow(sp.cos((s + a) / 2), sp.cos((s - a) / 2), sp.cos(s), sp.cos(a))
    return _stated("eq16-in-plane", formula, s, (-right, right), (a,), lambda exact: _of_angle(exact, s, a))


def on_hemisphere() -> Stated:
    """V and V' uniform over the hemisphere: heights v, w uniform on (0, 1), phi between their azimuths on (0, pi)."""
    v = sp.Symbol("v", real=True)
    w, phi = parameter("w", 0, _SHORT), parameter("phi", 0, sp.pi * _SHORT)
    sine, other = sp.sqrt(1 - v**2), sp.sqrt(1 - w**2)
    # |V + V'|, a sum without cancellation, as in `_sampling/directions.py`.
    length = sp.sqrt((v + w) ** 2 + (sine - other) ** 2 + 4 * sine * other * sp.cos(phi / 2) ** 2)
    formula = torrance_sparrow((v + w) / length, length / 2, v, w)
    return _stated("eq16-hemisphere", formula, v, (sp.S.Zero, _SHORT), (w, phi), lambda exact: _of_height(exact, v, w))


def _stated(
    name: str,
    formula: sp.Expr,
    variable: sp.Symbol,
    domain: tuple[sp.Expr, sp.Expr],
    drawn: Sequence[Parameter],
    product: Callable[[sp.Expr], sp.Expr],
) -> Stated:
    smith = card("smith").problem
    assert smith.target is not None
    target = Target(product(smith.target.expression), variable, domain)
    references = tuple(Reference(r.name, product(r.expression), r.source) for r in smith.references)
    parameters = {**{each: (each.low, each.high) for each in drawn}, **smith.parameters}
    return Stated(Question(name, variable, domain, target, references, parameters), formula)


def _of_angle(exact: sp.Expr, s: sp.Symbol, a: sp.Symbol) -> sp.Expr:
    """G(v) G(v') at v = cos(s), v' = cos(a), where 1 - v^2 loses no digits as sin^2."""
    v = card("smith").problem.variable
    parts: list[Any] = [exact.xreplace({1 - v**2: sp.sin(angle) ** 2}).xreplace({v: sp.cos(angle)}) for angle in (s, a)]
    return parts[0] * parts[1]


def _of_height(exact: sp.Expr, v: sp.Symbol, w: sp.Symbol) -> sp.Expr:
    """G(v) G(v') at the heights themselves."""
    own = card("smith").problem.variable
    return exact.xreplace({own: v}) * exact.xreplace({own: w})
