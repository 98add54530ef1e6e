"""Values of numbers, at two precisions: what cancels shows as a disagreement."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import Any

import sympy as sp
from mpmath.ctx_mp import MPContext

from ratfit._parse.errors import Refusal
from ratfit._parse.functions import SMOOTH
from ratfit._parse.reading import Value, current_reading
from ratfit._parse.remedies import NOT_FINITE


@functools.cache
def contexts() -> tuple[MPContext, MPContext]:
    # Own contexts: mpmath's global precision belongs to the user.
    low, high = MPContext(), MPContext()
    low.prec, high.prec = 192, 256
    return low, high


def is_number(expr: sp.Expr) -> bool:
    values = current_reading.get().values
    return all(symbol in values for symbol in expr.free_symbols)


def value_of(number: sp.Expr) -> Value:
    """The value of a number that this grammar can make; it tells the number from zero."""
    values = current_reading.get().values
    if number not in values:
        low, high = value = _computed(number)
        if not number.is_Rational and (not high or abs(low - high) > abs(high) * 2.0**-40):
            raise Refusal("this number cannot be told from zero; simplify it by hand")
        values[number] = value
    return values[number]


def _computed(number: sp.Expr) -> Value:
    if number.is_Rational:
        return _in_range([context.mpf(number.p) / number.q for context in contexts()])
    if number in (sp.pi, sp.E):
        return _in_range([+(context.pi if number is sp.pi else context.e) for context in contexts()])
    operation = {sp.Add: "fsum", sp.Mul: "fprod", sp.Pow: "power"}.get(number.func, number.func.__name__)
    if operation not in ("fsum", "fprod", "power", "atan2", *SMOOTH):
        raise Refusal("this number cannot be evaluated; write it with the functions of the grammar")
    return evaluated(operation, number.args)


def evaluated(operation: str, arguments: Sequence[sp.Expr]) -> Value:
    # Asked for twice: before sympy builds the number, and when its value is wanted.
    evaluations, key = current_reading.get().evaluations, (operation, *arguments)
    if key not in evaluations:
        inputs = map(list, zip(*map(value_of, arguments), strict=True))
        evaluations[key] = _in_range([_apply(*each, operation) for each in zip(contexts(), inputs, strict=True)])
    return evaluations[key]


def _apply(context: MPContext, parts: list[Any], operation: str) -> Any:
    function = getattr(context, operation)
    try:
        return function(parts) if operation in ("fsum", "fprod") else function(*parts)
    except (ValueError, ZeroDivisionError, OverflowError):
        raise Refusal(NOT_FINITE) from None


def _in_range(parts: Sequence[Any]) -> Value:
    for context, part in zip(contexts(), parts, strict=True):
        if not isinstance(part, context.mpf) or not context.isfinite(part):
            raise Refusal(NOT_FINITE)
        if part and not 1e-308 < abs(part) < 1e308:
            raise Refusal("too large or too small for a number; rescale")
    return Value(*parts)
