"""What a name in the text stands for, brought into the form of what is built here."""

from __future__ import annotations

import keyword
from collections.abc import Collection
from dataclasses import replace
from itertools import islice

import sympy as sp

from ratfit._parse.arithmetic import power_of, product_of, sum_of
from ratfit._parse.checks import check_height
from ratfit._parse.errors import Refusal, quote
from ratfit._parse.functions import CONSTANTS, FUNCTIONS, NOT_REAL
from ratfit._parse.limits import MAX_LENGTH, MAX_SIZE
from ratfit._parse.names import nearest
from ratfit._parse.node import Node, bounded
from ratfit._parse.reading import current_reading
from ratfit._parse.remedies import NO_PYTHON, argument_remedy
from ratfit._parse.veil import is_short, veiled


def named(name: str) -> Node:
    expr = CONSTANTS.get(name) or _declared(name)
    check_height(expr)
    # Names put in may share parts, so that the tree is exponentially larger than the object: the count stops early.
    size = sum(1 for _ in islice(sp.preorder_traversal(expr), MAX_SIZE + 1))
    node = bounded(Node(expr, 0, MAX_LENGTH, size=size))
    return replace(node, expr=_veiled_throughout(expr))


def _declared(name: str) -> sp.Expr:
    names = current_reading.get().names
    if name in NOT_REAL:
        raise Refusal(NOT_REAL[name])
    if name in FUNCTIONS:
        raise Refusal(argument_remedy(name))
    if keyword.iskeyword(name):
        raise Refusal(NO_PYTHON)
    if name not in names and name.endswith("'"):
        raise Refusal(_prime_remedy(names))
    if name not in names:
        raise Refusal(f"this name is not declared{nearest(name, [*names, *FUNCTIONS, *CONSTANTS]) or _listed(names)}")
    return names[name]


def _prime_remedy(names: Collection[str]) -> str:
    primed = [quote(name) for name in names if name.endswith("'")]
    if not primed:
        return "write names without quotes; only the residual of an equation holds derivatives, y' and y''"
    return f"this derivative is not known here; the unknown function is y, its derivatives {', '.join(primed)}"


def _listed(names: Collection[str]) -> str:
    listed = ", ".join(quote(name) for name in islice(names, 4))
    return f"; declared: {listed}{', ...' * (len(names) > 4)}" if listed else "; no names are"


def _veiled_throughout(expr: sp.Expr) -> sp.Expr:
    """An expression from outside, brought into the form of those built here."""
    if not expr.args or is_short(expr):
        return expr
    args = [_veiled_throughout(arg) for arg in expr.args]
    if expr.is_Add:
        return sum_of(args)
    if expr.is_Mul:
        return product_of(args)
    if expr.is_Pow:
        return power_of(*args)
    return veiled(expr.func(*args, evaluate=False) if expr.func.__name__ in FUNCTIONS else expr)
