"""A long expression in named parts: what occurs in it more than once is written once."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

from ratfit._parse import RESERVED

LONG = 120
"""Letters of an expression that is read in one go."""

WORTH = 12
"""Letters of a part that is worth a name."""

NAMES = (*"pqrshkgabcdlz", *(f"p{k}" for k in range(1, 100)))
"""Names of parts, those that the expression does not hold."""

Parts = tuple[tuple[sp.Symbol, sp.Expr], ...]


def in_parts(expression: sp.Expr, taken: Iterable[str] = ()) -> tuple[sp.Expr, Parts]:
    """The expression in named parts, and the parts, each written in those before it; none where it is short.

    Arguments: `expression`; `taken`, names that no part may have, beside those of its symbols.
    """
    if len(str(expression)) <= LONG:
        return expression, ()
    used = {symbol.name for symbol in expression.free_symbols} | set(taken)
    names = (sp.Symbol(name) for name in NAMES if name not in used and name not in RESERVED)
    repeated, (whole,) = sp.cse(expression, sp.numbered_symbols("part", cls=sp.Dummy), order="canonical")
    meaning: dict[sp.Symbol, sp.Expr] = {}
    kept: list[tuple[sp.Symbol, sp.Expr]] = []
    for dummy, part in repeated:
        inner = part.xreplace(meaning)
        if len(str(inner)) < WORTH:
            meaning[dummy] = inner
        else:
            meaning[dummy] = next(names)
            kept.append((meaning[dummy], inner))
    return whole.xreplace(meaning), tuple(kept)


def where(parts: Parts) -> list[str]:
    """The parts as lines: "where p = ..." and the others below it."""
    lines = [f"{name} = {part}" for name, part in parts]
    return [f"{'where' if k == 0 else '':5} {line}" for k, line in enumerate(lines)]
