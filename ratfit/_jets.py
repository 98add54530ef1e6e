"""Jets: what the conditions say of the fit's derivatives at each node; differential equations are resolved to them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache

import sympy as sp

from ratfit._condition import JET, AbstractPointCondition, Derivative, Equation
from ratfit._field import is_zero
from ratfit._form import letters_of
from ratfit._generators import sampled

TINY = 1e-40
"""Places closer than this at 50 digits are compared exactly."""


@lru_cache(maxsize=1000)
def same(a: sp.Expr, b: sp.Expr) -> bool:
    """Whether two places are the same, however they are written."""
    if a == b:
        return True
    if a.is_infinite or b.is_infinite:
        return False
    if not (a.is_Rational and b.is_Rational) and all(abs(v) < TINY for v in sampled(a - b)):
        return is_zero(a - b) is True
    return False


@dataclass
class Jet:
    """The derivatives of the fit at a node: `known` by order, and those `added` to what was stated."""

    at: sp.Expr
    known: dict[int, sp.Expr]
    added: list[int] = field(default_factory=list)

    def add(self, order: int, value: sp.Expr) -> None:
        self.known[order] = value
        self.added.append(order)

    def facts(self) -> list[tuple[Derivative, sp.Expr]]:
        """What was added, as conditions with their demands."""
        return [(Derivative(self.at, order), self.known[order]) for order in self.added]


@dataclass(frozen=True)
class Completion:
    """Derivatives that equations give or that nobody stated, the latter as `symbols`; `leftover` must vanish."""

    facts: tuple[tuple[Derivative, sp.Expr], ...]
    symbols: tuple[sp.Symbol, ...]
    leftover: tuple[sp.Expr, ...]


def completion(
    x: sp.Symbol,
    points: list[tuple[AbstractPointCondition, sp.Expr]],
    equations: list[Equation],
    taken: set[str],
    needless: Callable[[sp.Expr], bool],
    vanishes: Callable[[sp.Expr, int], bool],
) -> Completion:
    """Every derivative that the rows of the linear route need at a node.

    `points` are the stated ones with their demands; `needless` says at which places a stated derivative needs none
    below it (a polynomial's), `vanishes` which are zero by parity. A residual whose highest derivative is linear gives
    that derivative; what it cannot give becomes a symbol, and the residual an equation that is left over.
    """
    letter = letters_of("s", taken)
    symbols: list[sp.Symbol] = []

    def open_(jet: Jet, order: int) -> None:
        symbols.append(sp.Symbol(f"{letter}{len(symbols)}", real=True))
        jet.add(order, symbols[-1])

    jets = _stated(points, equations)
    for jet in jets:
        for order in range(max(jet.known, default=0)):
            if order not in jet.known and not needless(jet.at) and not vanishes(jet.at, order):
                open_(jet, order)
    leftover: list[sp.Expr] = []
    for equation in sorted(equations, key=lambda e: e.height):
        jet = next(j for j in jets if same(j.at, equation.at))
        for k, residual in enumerate(equation.residuals_there(x)):
            top = equation.height + k
            for order in range(top):
                if order not in jet.known and vanishes(jet.at, order):
                    jet.known[order] = sp.S.Zero
                elif order not in jet.known:
                    open_(jet, order)
            leftover += _resolved(residual, jet, top, open_)
    facts = tuple(fact for jet in jets for fact in jet.facts())
    return Completion(facts, tuple(symbols), tuple(leftover))


def _stated(points: list[tuple[AbstractPointCondition, sp.Expr]], equations: list[Equation]) -> list[Jet]:
    jets: list[Jet] = []
    for at in [*(c.at for c, _ in points), *(e.at for e in equations)]:
        if not any(same(jet.at, at) for jet in jets):
            jets.append(Jet(at, {}))
    for condition, demand in points:
        jet = next(jet for jet in jets if same(jet.at, condition.at))
        jet.known.setdefault(condition.order, demand)
    return jets


def _resolved(residual: sp.Expr, jet: Jet, top: int, open_: Callable[[Jet, int], None]) -> list[sp.Expr]:
    """Adds the derivative of order `top` to the jet, or gives the residual back as an equation that is left over."""
    here = residual.xreplace({JET[k]: v for k, v in jet.known.items() if k != top})
    slope = sp.diff(here, JET[top])
    if top not in jet.known and not slope.has(JET[top]) and is_zero(slope) is not True and not _is_open(slope):
        jet.add(top, sp.cancel(-here.xreplace({JET[top]: sp.S.Zero}) / slope))
        return []
    if top not in jet.known and slope != 0:
        open_(jet, top)
    return [here.xreplace({JET[top]: jet.known[top]}) if top in jet.known else here]


def _is_open(slope: sp.Expr) -> bool:
    """Whether a factor may vanish for some value of the derivatives that nobody stated."""
    return any(type(s) is sp.Symbol for s in slope.free_symbols)
