"""Checks of results."""

from __future__ import annotations

import sympy as sp

from ratfit._parse.bounds import bits_of, bound_power
from ratfit._parse.errors import Refusal
from ratfit._parse.functions import INFINITE
from ratfit._parse.limits import MAX_BITS, MAX_HEIGHT
from ratfit._parse.remedies import NOT_FINITE
from ratfit._parse.values import is_number, value_of


def check_result(expr: sp.Expr) -> None:
    for term in sp.Add.make_args(expr):
        for factor in sp.Mul.make_args(term):
            _check_part(factor)
    if is_number(expr):
        value_of(expr)
    for factor in sp.Mul.make_args(expr):
        if factor.is_Pow:
            bound_power(factor, sp.S.One)


def _check_part(part: sp.Expr) -> None:
    if part in (sp.nan, sp.zoo, *INFINITE):
        raise Refusal(NOT_FINITE)
    if part.is_Rational and bits_of(part) > MAX_BITS:
        raise Refusal("this number has too many digits; round it")
    if part is sp.I or (part.is_Pow and part.base.is_Rational and part.base < 0 and not part.exp.is_Integer):
        raise Refusal("not real; keep to where the expression is real")


def check_height(expr: sp.Expr) -> None:
    level = {expr}
    for _ in range(MAX_HEIGHT):
        level = {arg for part in level for arg in part.args}
    if level:
        raise Refusal(f"more than {MAX_HEIGHT} levels once the names are put in; simplify it")


def check_whole(expr: sp.Expr) -> None:
    check_height(expr)
    if expr not in INFINITE:
        for part in sp.preorder_traversal(expr):
            _check_part(part)
