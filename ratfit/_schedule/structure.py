"""Arrangements that follow the structure of the input."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable

import sympy as sp

from ratfit._schedule.context import Context
from ratfit._schedule.program import Select, Value, Whole
from ratfit._schedule.tape import Tape

_ONE = Value(sp.S.One)
_Visit = Callable[[sp.Expr], Value]
_Shared = tuple[list[tuple[sp.Symbol, sp.Expr]], list[sp.Expr]]


def as_given(context: Context, expression: sp.Expr, tape: Tape) -> Value:
    @functools.cache
    def visit(part: sp.Expr) -> Value:
        if part == context.variable or not context.varies(part):
            return tape.leaf(part)
        return _node(tape, part, visit, functools.partial(_best, context, tape))

    return visit(expression)


def by_parts(context: Context, expression: sp.Expr, tape: Tape) -> Value:
    """The input's own outermost operation, on the best arrangement of each operand."""
    best = functools.partial(_best, context, tape)
    return _node(tape, expression, best, best)


def _best(context: Context, tape: Tape, expression: sp.Expr) -> Value:
    if expression not in tape.best:
        tape.best[expression] = context.plan(context, expression)(tape)
    return tape.best[expression]


def write_shared(context: Context, shared: _Shared, tape: Tape) -> Value:
    """An expression from which sympy's `cse` has taken the common parts, some operands of a sum or product included."""
    hoisted: dict[sp.Expr, sp.Expr] = {}
    known: dict[sp.Expr, Value] = {context.variable: tape.variable}

    def visit(part: sp.Expr) -> Value:
        if part in known:
            return known[part]
        if known.keys().isdisjoint(part.free_symbols):
            return tape.constant(part.xreplace(hoisted))
        return _node(tape, part, visit, visit)

    replacements, (reduced,) = shared
    for name, part in replacements:
        if known.keys().isdisjoint(part.free_symbols):
            hoisted[name] = part.xreplace(hoisted)
        else:
            known[name] = visit(part)
    return visit(reduced)


def _node(tape: Tape, node: sp.Expr, visit: _Visit, argument: _Visit) -> Value:
    """One node; `visit` writes down the operands of arithmetic, `argument` those of everything else."""
    if node.is_Add:
        return tape.sum(map(visit, node.args))
    factors = [_integer_power(factor) for factor in sp.Mul.make_args(node)]
    if factors != [(node, 1)]:
        return write_powers(tape, [(visit(base), exponent) for base, exponent in factors])
    if isinstance(node, sp.Piecewise):
        conditions = tuple(condition for _, condition in node.args)
        return tape.call(Select(conditions), *(argument(value) for value, _ in node.args))
    if node.args and all(isinstance(part, sp.Expr) for part in node.args):
        return tape.call(node.func, *map(argument, node.args))
    return tape.call(Whole(node))


def _integer_power(factor: sp.Expr) -> tuple[sp.Expr, int]:
    """A factor as `base**integer`: halves become powers of a square root, which is cheaper than a general power."""
    if factor.is_Pow and factor.exp.is_Integer:
        return factor.base, int(factor.exp)
    if factor.is_Pow and factor.exp.is_Rational and factor.exp.q == 2:
        return sp.sqrt(factor.base), int(factor.exp.p)
    return factor, 1


def write_powers(tape: Tape, factors: Iterable[tuple[Value, int]]) -> Value:
    """Powers multiplied: constants in one, one division at most, `x**2*y**2` as `(x*y)**2`."""
    constant = _ONE
    groups: dict[int, list[Value]] = {}
    for value, exponent in factors:
        if tape.is_constant(value.atom):
            constant = tape.mul(constant, tape.constant(value.signed**exponent))
        else:
            groups.setdefault(exponent, []).append(value)
    common = math.gcd(*groups)
    if common > 1 and min(groups) < 0 < max(groups):
        root = _quotient(tape, _ONE, {exponent // common: group for exponent, group in groups.items()})
        return tape.mul(constant, tape.power(root, common))
    return _quotient(tape, constant, groups)


def _quotient(tape: Tape, constant: Value, groups: dict[int, list[Value]]) -> Value:
    def multiplied(sign: int) -> Value:
        powers = [
            tape.power(functools.reduce(tape.mul, group), sign * exponent)
            for exponent, group in sorted(groups.items(), reverse=True)
            if sign * exponent > 0
        ]
        return functools.reduce(tape.mul, powers, _ONE)

    return tape.div(tape.mul(constant, multiplied(1)), multiplied(-1))
