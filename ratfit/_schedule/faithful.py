"""Whether an arrangement has the input's values, and rounds not much worse: trial points."""

from __future__ import annotations

import operator
from typing import Any

import mpmath
import sympy as sp

from ratfit._schedule.context import Context
from ratfit._schedule.program import Operation, Program

_LOSS = 64  # how many times worse than the input an arrangement may round
_DIGITS = 40
# The places in its range where the variable is tried. None is dyadic: so the input's own rounding takes part, and an
# ill-conditioned place does not count against an arrangement.
_PLACES = tuple(sp.Rational(i, 61) for i in (1, 16, 29, 46, 60))

_Point = dict[sp.Expr, sp.Expr]


def trial_of(context: Context, expression: sp.Expr) -> list[tuple[_Point, Any]]:
    """Points of the ranges, and the expression's values there as far as they are real numbers."""
    points = [_point(context, expression, i) for i in range(len(_PLACES))]
    pairs = [(point, expression.xreplace(point).evalf(_DIGITS)) for point in points]
    return [(point, mpmath.mpmathify(sp.Float(value, _DIGITS))) for point, value in pairs if _is_number(value)]


def _is_number(value: sp.Expr) -> bool:
    return bool(value.is_Rational or value.is_Float)


def _point(context: Context, expression: sp.Expr, i: int) -> _Point:
    """The i-th trial point; the variable last, for the ends of its range may name parameters."""
    ends = sp.Tuple(*context.ranges.get(context.variable, ()))
    parameters = sorted((expression.free_symbols | ends.free_symbols) - {context.variable}, key=lambda s: s.name)
    point: _Point = {}
    for j, symbol in enumerate([*parameters, context.variable]):
        low, high = (end.xreplace(point) for end in sp.Tuple(*context.ranges.get(symbol, (0, 1))))
        if low.is_infinite:
            low = high - 8 if not high.is_infinite else sp.Integer(-4)
        if high.is_infinite:
            high = low + 8
        # Over another prime, and from another place each: no two symbols are equal by accident, nor all of them large.
        step = _PLACES[i] if symbol == context.variable else sp.Rational((14 * i + 23 * j + 15) % 66 + 1, 67)
        # A Float, for an exact number to a high power would not fit into memory.
        point[symbol] = (low + step * (high - low)).evalf(_DIGITS)
    return point


def is_faithful(trial: list[tuple[_Point, Any]], program: Program, given: Program) -> bool:
    """Whether an arrangement has the value of the input, and rounds not much worse than the input as given.

    The first is a guard, not a proof: the algebra is exact, but does not see that `sqrt(2)*sqrt(3)` and `sqrt(6)` are
    one number, and could divide by their difference.
    """
    peak = max((abs(value) for _, value in trial), default=mpmath.mpf(0))
    if _error(trial, program, bits=120) > peak * mpmath.mpf(2) ** -60:
        return False
    return _error(trial, program, bits=24) <= _LOSS * max(_error(trial, given, bits=24), peak * mpmath.mpf(2) ** -24)


def _error(trial: list[tuple[_Point, Any]], program: Program, bits: int) -> Any:
    """The worst absolute error over the trial's points, in arithmetic of so many bits."""
    try:
        return max((abs(_run(program, point, bits) - value) for point, value in trial), default=mpmath.mpf(0))
    except ZeroDivisionError:
        return mpmath.inf


def _run(program: Program, point: _Point, bits: int) -> Any:
    known: dict[sp.Expr, Any] = {}

    def value(atom: sp.Expr) -> Any:
        if atom not in known:
            known[atom] = _rounded(atom.xreplace(point))
        return known[atom]

    with mpmath.workprec(bits):
        for name, operation in program.operations.items():
            known[name] = _performed(operation, [value(atom) for atom in operation.operands], point)
        return value(program.result)


_ARITHMETIC = {"add": operator.add, "sub": operator.sub, "mul": operator.mul, "div": operator.truediv}


def _performed(operation: Operation, operands: list[Any], point: _Point) -> Any:
    if operation.head is None:
        return _ARITHMETIC[operation.kind](*operands)
    return _rounded(operation.head(*(sp.Float(operand, _DIGITS) for operand in operands)).xreplace(point))


def _rounded(expression: sp.Expr) -> Any:
    """A number at the working precision; infinite where it is not a real one, so that no comparison passes."""
    value = expression.evalf(_DIGITS)
    return +mpmath.mpmathify(sp.Float(value, _DIGITS)) if _is_number(value) else mpmath.inf
