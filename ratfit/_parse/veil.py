"""Veils over the long parts of an expression.

sympy answers questions about signs by walking through everything below, exponentially often in the depth, and it asks
them of the base of every power. So a long part is a symbol of its own while the rest is built: behind this veil there
is nothing to walk through. At the end each symbol gives way to its meaning, and nothing is evaluated anew.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from itertools import islice

import sympy as sp

from ratfit._parse.limits import SHORT
from ratfit._parse.reading import current_reading
from ratfit._parse.values import is_number, value_of


def is_short(expr: sp.Expr) -> bool:
    meanings = current_reading.get().meanings
    parts = list(islice(sp.preorder_traversal(expr), SHORT + 1))
    # For the sign of a sum sympy looks for the roots of its derivative, or for a minimal polynomial.
    if len(parts) > SHORT or any(part in meanings or part.is_Add for part in parts):
        return False
    return all(map(_is_plain, parts)) if is_number(expr) else _layers(expr) <= 2


def _is_plain(part: sp.Expr) -> bool:
    """Whether a part of a number keeps the number where sympy's comparisons are quick."""
    if part.is_Pow:
        return part.exp.is_Rational and part.exp.q <= 6
    return part.is_Mul or all(arg.is_Rational for arg in part.args)


def _layers(expr: sp.Expr) -> int:
    below = max(map(_layers, expr.args), default=0)
    return below + 1 if expr.args and not expr.is_Mul else below


def veiled(expr: sp.Expr) -> sp.Expr:
    """The expression itself where it is short or a power of a symbol, or else a symbol that means it."""
    base, exponent = expr.as_base_exp()
    return expr if (base.is_Symbol and exponent.is_Rational) or is_short(expr) else behind_veil(expr)


def behind_veil(expr: sp.Expr) -> sp.Dummy:
    reading = current_reading.get()
    if expr not in reading.veils:
        reading.veils[expr] = _new_veil(expr)
        reading.meanings[reading.veils[expr]] = expr
    return reading.veils[expr]


def _new_veil(expr: sp.Expr) -> sp.Dummy:
    if not is_number(expr):
        return sp.Dummy()
    value = value_of(expr)
    symbol = sp.Dummy(positive=value.high > 0, negative=value.high < 0)
    current_reading.get().values[symbol] = value
    return symbol


def unveiled(expr: sp.Expr, done: dict[sp.Expr, sp.Expr]) -> sp.Expr:
    meanings = current_reading.get().meanings
    if expr not in done:
        if expr in meanings:
            done[expr] = unveiled(meanings[expr], done)
        elif expr.free_symbols.isdisjoint(meanings):
            done[expr] = expr
        else:
            done[expr] = _rebuilt(expr, [unveiled(arg, done) for arg in expr.args])
    return done[expr]


def _rebuilt(expr: sp.Expr, args: Sequence[sp.Expr]) -> sp.Expr:
    if expr.is_Add or expr.is_Mul:
        # sympy's own order: an expression is equal to another only with its parts in the same order.
        flat = [part for arg in args for part in expr.func.make_args(arg)]
        number = expr.func(*[part for part in flat if part.is_Rational])
        rest = sorted([part for part in flat if not part.is_Rational], key=_canonical)
        args = rest if number == expr.func.identity else [number, *rest]
    return args[0] if len(args) == 1 and not expr.is_Function else expr.func(*args, evaluate=False)


_canonical = functools.cmp_to_key(sp.Basic.compare)
