"""Calls of functions, with the checks that come before sympy's evaluation."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import Any

import sympy as sp
from sympy.core.function import Application

from ratfit._parse.arithmetic import power_of
from ratfit._parse.bounds import bits_of
from ratfit._parse.errors import Refusal
from ratfit._parse.functions import CONSTANTS, FUNCTIONS, ROOTS, STEPS
from ratfit._parse.limits import MAX_NAME
from ratfit._parse.names import nearest
from ratfit._parse.reading import current_reading
from ratfit._parse.remedies import ELSEWHERE
from ratfit._parse.values import contexts, evaluated, is_number, value_of
from ratfit._parse.veil import is_short, veiled


def check_call(name: str, count: int) -> None:
    if name not in FUNCTIONS:
        if name in current_reading.get().names or name in CONSTANTS:
            raise Refusal(f"this name is no function; write {name[:MAX_NAME]}*(...) for a product")
        elsewhere = f"; write {ELSEWHERE[name.lower()]}" if name.lower() in ELSEWHERE else nearest(name, FUNCTIONS)
        raise Refusal(f"there is no such function{elsewhere}")
    counts = FUNCTIONS[name][1]
    if count not in counts:
        wanted = f"{min(counts)} to {max(counts)}" if len(counts) > 1 else f"{counts[0]}"
        raise Refusal(f"{name} takes {wanted} argument{'s' * (max(counts) > 1)}, not {count}")


def call_of(name: str, arguments: list[sp.Expr]) -> sp.Expr:
    if name in ROOTS:
        return power_of(arguments[0], ROOTS[name])
    if name == "exp":
        return power_of(sp.E, arguments[0])
    if name == "clamp":
        return _extreme(sp.Min, [_extreme(sp.Max, arguments[:2]), arguments[2]])
    if name in ("Min", "Max"):
        return _extreme(FUNCTIONS[name][0], arguments)
    numbers = all(map(is_number, arguments))
    if name in STEPS:
        # sympy's evaluation of these asks for signs in many ways: for a symbol alone they are all short.
        return _step(name, arguments[0]) if numbers else _applied(name, arguments, arguments[0].is_Symbol)
    if numbers:
        evaluated(name, arguments)
    # loggamma(n) becomes log(gamma(n)), and gamma(n) a number of any length.
    large = name == "loggamma" and numbers and value_of(arguments[0]).high > 100
    # acos(cos(2**1000)) asks for the place of a number among the multiples of pi, and sympy gives up with a traceback.
    large = large or (numbers and any(bits_of(r) > 64 for a in arguments for r in a.atoms(sp.Rational)))
    # The same question takes it milliseconds for every acos(cos(2)); log(E**2) is quick.
    large = large or (numbers and name != "log" and any(a.has(Application) for a in arguments))
    return _applied(name, arguments, not large and all(map(is_short, arguments)))


def _applied(name: str, arguments: Sequence[sp.Expr], short: bool) -> sp.Expr:
    function = FUNCTIONS[name][0]
    if short:
        result = function(*arguments)
        # What becomes cot, re or another function outside the grammar stays as it was written.
        if all(part.func.__name__ in FUNCTIONS for part in result.atoms(Application)):
            return result
    return veiled(function(*arguments, evaluate=False))


def _step(name: str, number: sp.Expr) -> sp.Expr:
    """A step function of a number, from its value: sympy's own way is a search of unknown length."""
    if name in ("floor", "ceiling"):
        return sp.Integer(_floor(number) if name == "floor" else -_floor(-number))
    sign = _sign(number)
    if name == "Heaviside":
        return sp.Rational(sign + 1, 2)
    return sp.Integer(sign) if name == "sign" else sign * number


def _sign(number: sp.Expr) -> int:
    high = value_of(number).high
    return int(high > 0) - int(high < 0)


def _floor(number: sp.Expr) -> int:
    if number.is_Rational:
        return int(number.p // number.q)
    low, high = value_of(number)
    below = int(contexts()[1].floor(high))
    # No integer may lie within a generous multiple of the doubt.
    doubt = abs(low - high) * 2**20 + abs(high) * 2.0**-150
    if not below + doubt < high < below + 1 - doubt:
        raise Refusal("too close to an integer to tell; write the integer")
    return below


def _extreme(function: Any, arguments: Sequence[sp.Expr]) -> sp.Expr:
    """`Min` or `Max`: its numbers are compared here; sympy would compare each pair of arguments at length."""
    parts = [part for argument in arguments for part in _operands(argument, function)]
    numbers = [part for part in parts if is_number(part)]
    rest = [part for part in parts if not is_number(part)]
    if numbers:
        wanted = 1 if function is sp.Max else -1
        rest.append(functools.reduce(lambda a, b: b if _sign(b - a) == wanted else a, numbers))
    return rest[0] if len(set(rest)) == 1 else veiled(function(*rest, evaluate=False))


def _operands(expr: sp.Expr, function: Any) -> Sequence[sp.Expr]:
    meaning = current_reading.get().meanings.get(expr, expr)
    return meaning.args if isinstance(meaning, function) else [expr]
