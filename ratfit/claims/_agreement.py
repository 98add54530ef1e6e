"""When a value that was found is the value that was claimed, and how both are shown."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from ratfit._target import Parameter

DIGITS = 50
NEAR = sp.Float("1e-30")
"""Formulas that are nearer than this, relative to their size, wherever they are compared, are taken for one."""

NUMBER = 1e-9
"""The same for numbers that come out of quadrature in float64."""

NOTHING = 1e-11
"""What is smaller is the rounding of a computation whose result is 0, and shown as 0."""

SHARES = tuple(sp.Rational(share, 37) for share in (2, 7, 13, 19, 23, 29, 34))
"""Where in the range of a symbol formulas are compared."""


@dataclass(frozen=True)
class Rounded:
    """A number as it is printed, with its last digit rounded: 1.4 % is Rounded(0.014, 0.001)."""

    value: float
    unit: float


@dataclass(frozen=True)
class Near:
    """A number that is to come back to within a share of it."""

    value: float
    share: float


@dataclass(frozen=True)
class AtMost:
    """A number that is said to be no greater; `slack` is how closely it is measured."""

    bound: float
    slack: float = 0.0


@dataclass(frozen=True)
class AtLeast:
    """A number that is said to be no less."""

    bound: float


@dataclass(frozen=True)
class Above:
    """A number that is said to be greater: by so much that it is no rounding of a computation."""

    bound: float
    by: float = 0.01


@dataclass(frozen=True)
class Below:
    """A number that is said to be less: by so much that it is no rounding of a computation."""

    bound: float
    by: float = 0.01


@dataclass(frozen=True)
class Between:
    """A number that is said to be about another: neither much less nor much greater."""

    low: float
    high: float


ZERO = Rounded(0, 2e-5)
"""That two things are the same: no difference, but for what quadrature and rounding leave."""


def agrees(found: Any, claimed: Any) -> bool:
    """Whether what was found is what was claimed; None, for what has no value, agrees with nothing."""
    if found is None:
        return False
    match claimed:
        case bool() | str():
            return bool(found == claimed)
        case Rounded(value, unit):
            return abs(float(found) - value) <= unit / 2 * (1 + NUMBER)
        case Near(value, share):
            return abs(float(found) - value) <= share * abs(value)
        case AtMost(bound, slack):
            return float(found) <= bound + slack + NUMBER * (1 + abs(bound))
        case AtLeast(bound):
            return float(found) >= bound - NUMBER * (1 + abs(bound))
        case Above(bound, by):
            return float(found) >= bound + by
        case Below(bound, by):
            return float(found) <= bound - by
        case Between(low, high):
            return low <= float(found) <= high
        case tuple():
            return len(found) == len(claimed) and all(map(agrees, found, claimed))
        case Mapping():
            return bool(found == claimed)
        case sp.Basic():
            return same(found + sp.S.Zero, claimed)  # a float becomes an expression
    return abs(float(found) - float(claimed)) <= NUMBER * (1 + abs(float(claimed)))


def same(a: sp.Expr, b: sp.Expr) -> bool:
    """Whether two formulas are one function: at 50 digits they are within 1e-30 at seven places of all symbols.

    Places where both have no finite real value are passed over; with none left the answer is no.
    """
    compared = 0
    for values in _places(a.free_symbols | b.free_symbols):
        first, second = (sp.N(each.xreplace(values), DIGITS) for each in (a, b))
        if not (first.is_Float or first.is_Integer) or not (second.is_Float or second.is_Integer):
            if first != second:
                return False
            continue
        if abs(first - second) > NEAR * (1 + abs(first)):
            return False
        compared += 1
    return compared > 0


def _places(symbols: set[sp.Symbol]) -> list[dict[sp.Symbol, sp.Expr]]:
    """Values of symbols, each at other shares of its range: (0, 1) where it is no parameter."""
    ordered = sorted(symbols, key=lambda symbol: symbol.name)
    count = len(SHARES)
    return [
        {symbol: _value(symbol, SHARES[(place * (index + 1) + index) % count]) for index, symbol in enumerate(ordered)}
        for place in range(count)
    ]


def _value(symbol: sp.Symbol, share: sp.Rational) -> sp.Expr:
    if isinstance(symbol, Parameter) and symbol.low.is_finite and symbol.high.is_finite:
        return symbol.low + share * (symbol.high - symbol.low)
    return share


def shown(value: Any) -> Any:
    """A value as JSON holds it: numbers to six digits, all else as text; None for what has no finite value."""
    match value:
        case None | bool() | int() | str():
            return value
        case Rounded(number, _) | Near(number, _):
            return number
        case Above(bound, _):
            return f"above {bound:g}"
        case Below(bound, _):
            return f"below {bound:g}"
        case Between(low, high):
            return f"from {low:g} to {high:g}"
        case AtMost(bound):
            return f"at most {bound:g}"
        case AtLeast(bound):
            return f"at least {bound:g}"
        case tuple():
            return ", ".join(_in_a_row(shown(each)) for each in value)
        case Mapping():
            return ", ".join(f"{count} {name}" for name, count in value.items() if count)
        case sp.Basic():
            return int(value) if value.is_Integer else str(unguarded(value))
    number = float(value)
    if number - number != 0:
        return None
    return 0.0 if abs(number) < NOTHING else float(f"{number:.6g}")


def _in_a_row(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def unguarded(formula: sp.Expr) -> sp.Expr:
    """A formula without its guards, as a reader knows it: of pieces the one in the middle of all ranges."""
    middle = {symbol: _value(symbol, sp.S.Half) for symbol in formula.free_symbols}
    guards = (sp.Piecewise, sp.Max, sp.Min)
    while found := [each for each in formula.atoms(*guards) if not any(arg.has(*guards) for arg in each.args)]:
        formula = formula.xreplace({each: _taken(each, middle) for each in found})
    return formula


def _taken(guard: sp.Expr, values: dict[sp.Symbol, sp.Expr]) -> sp.Expr:
    if isinstance(guard, sp.Piecewise):
        return next((value for value, condition in guard.args if condition.xreplace(values) == sp.true), sp.nan)
    taken = max if isinstance(guard, sp.Max) else min
    return taken(guard.args, key=lambda each: sp.N(each.xreplace(values)))
