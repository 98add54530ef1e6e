"""Whether a candidate is a real, finite function all over the support: poles, and functions out of their range."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import mpmath
import sympy as sp

from ratfit._condition import Limit
from ratfit._generators import DIGITS
from ratfit._multiprecise import endpoint, function_of, multiprecise
from ratfit._parse import RatfitError
from ratfit._poles import poles
from ratfit._system import System
from ratfit._target import at_values, sample_values
from ratfit._verify.candidate import Reduced
from ratfit._verify.numbers import decimal

PLACES = 64
"""Places on the support at which the range of a function's argument is looked at."""

FAR = 100
"""Where an infinite end of the support is cut for that."""

# What must be positive on the support, or not negative, for a function of the argument to be real and finite.
_POSITIVE = {sp.log: lambda a: a, sp.gamma: lambda a: a, sp.loggamma: lambda a: a, sp.atanh: lambda a: 1 - a**2}
_NOT_NEGATIVE = {sp.asin: lambda a: 1 - a**2, sp.acos: lambda a: 1 - a**2, sp.acosh: lambda a: a - 1}
_ZEROS = {sp.tan: sp.cos, sp.sec: sp.cos, sp.cot: sp.sin, sp.csc: sp.sin, sp.coth: sp.sinh, sp.csch: sp.sinh}


def broken(system: System, candidate: Reduced) -> str:
    """Why a candidate is no function on the closed support, in words; nothing where no reason was seen.

    A pole is forgiven where the target has it or a limit asked for it; the form's factor is left out.
    """
    x = system.problem.variable
    if reason := _pole(system, candidate.denominator):
        return reason
    inner = candidate.numerator / candidate.denominator
    if candidate.numerator.is_polynomial(x) and candidate.denominator.is_polynomial(x):
        return ""
    for divisor in _divisors(inner, x):
        if reason := _pole(system, divisor):
            return reason
    for must_be, argument in _ranges(inner, x):
        if reason := _out_of_range(system, must_be, argument):
            return reason
    return ""


def _divisors(expression: sp.Expr, x: sp.Symbol) -> Iterator[sp.Expr]:
    """What must not vanish: bases of negative powers, and the cosine of a tangent's argument."""
    for power in expression.atoms(sp.Pow):
        if power.base.has(x) and power.exp.is_negative:
            yield power.base
    for call in expression.atoms(*_ZEROS):
        if call.has(x):
            yield _ZEROS[call.func](call.args[0])


def _ranges(expression: sp.Expr, x: sp.Symbol) -> Iterator[tuple[str, sp.Expr]]:
    """What must be positive, or not negative: radicands, and arguments of functions that are not real everywhere."""
    for power in expression.atoms(sp.Pow):
        if power.base.has(x) and not power.exp.is_Integer:
            yield ("not negative" if not power.exp.is_negative else "positive"), power.base
    for table, must_be in ((_POSITIVE, "positive"), (_NOT_NEGATIVE, "not negative")):
        for call in expression.atoms(*table):
            if call.has(x):
                yield must_be, table[call.func](call.args[0])


def _out_of_range(system: System, must_be: str, argument: sp.Expr) -> str:
    """The first place, at sampled values of the parameters, at which an argument is out of its range, in words."""
    x, support = system.problem.variable, system.problem.support()
    symbols = set[sp.Symbol]().union(argument.free_symbols - {x}, *(end.free_symbols for end in support))
    for values in sample_values(symbols, ("0", "1/7", "4/7", "1")):
        function = function_of(argument, x, values)
        with mpmath.workdps(DIGITS):
            low, high = (max(min(endpoint(end.xreplace(values)), FAR), -FAR) for end in support)
            for k in range(PLACES + 1):
                place = low + (high - low) * k / PLACES
                inside = 0 < k < PLACES
                try:
                    value = function(place)
                except (ZeroDivisionError, ValueError):
                    continue
                if isinstance(value, mpmath.mpc) or value < -TINY or (must_be == "positive" and inside and value <= 0):
                    where = f"at {x} = {mpmath.nstr(place, 8)}{at_values(values)}"
                    return f"it is not real {where}, where {decimal(argument)} must be {must_be}"
    return ""


TINY = mpmath.mpf("1e-35")
"""A radicand that misses zero by less has lost digits, not its sign."""


def _pole(system: System, denominator: sp.Expr) -> str:
    """The first pole on the closed support that nobody asked for, in words."""
    x = system.problem.variable
    asked = [c.at for c in system.conditions if isinstance(c, Limit) and not c.at.is_infinite]
    for root, values in poles(denominator, x, system.problem.support()):
        if any(abs(multiprecise(at.xreplace(values)) - root) < mpmath.mpf("1e-12") for at in asked):
            continue  # a limit at its place has been verified: the pole is no worse than what was asked for
        if not _target_infinite(system, values, root):
            return f"it has a pole at {x} = {mpmath.nstr(root, 8)}{at_values(values)}"
    return ""


def _target_infinite(system: System, values: Mapping[sp.Symbol, sp.Expr], at: mpmath.mpf) -> bool:
    """Whether the target grows beyond bounds on the way to a place inside the support, as its own poles do."""
    target = system.problem.target
    if target is None:
        return False
    low, high = (end.xreplace(values) for end in system.problem.support())
    side = 1 if at < (endpoint(low) + endpoint(high)) / 2 else -1
    try:
        function = function_of(target.expression, target.variable, values)
        near, far = (abs(function(at + side * mpmath.mpf(step))) for step in ("1e-12", "1e-6"))
    except ZeroDivisionError:
        return True
    except (RatfitError, KeyError):
        return False
    return bool(near > 1000 * far)
