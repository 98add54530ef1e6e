"""Names for numbers whose roots are too much for algebra: the answer is found in the names, then they are put in."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

Meaning = dict[sp.Symbol, sp.Expr]
"""What names stand for."""


def names_of(numbers: Iterable[sp.Expr], depth: int = 1) -> Meaning:
    """A name for each of the numbers with parameters, if one of them has so many roots of parameters within each other.

    None at all where none has: the algebra of the parameters themselves then gives shorter answers.
    """
    several = list(dict.fromkeys(numbers))
    if all(_depth(number) < depth for number in several):
        return {}
    long = [number for number in several if number.free_symbols and not number.is_Symbol]
    return {sp.Dummy(f"d{k}", real=True): number for k, number in enumerate(long)}


def named(numbers: Iterable[sp.Expr], meaning: Meaning) -> tuple[sp.Expr, ...]:
    """The numbers, those that have a name by it."""
    names = {number: name for name, number in meaning.items()}
    return tuple(names.get(number, number) for number in numbers)


def _depth(number: sp.Expr) -> int:
    """How many roots of parameters stand within each other."""
    inner = max((_depth(part) for part in number.args), default=0)
    is_root = number.is_Pow and not number.exp.is_Integer and bool(number.base.free_symbols)
    return inner + is_root
