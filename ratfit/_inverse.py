"""Inverse functions: an equation f(g) = v as one in g, where f is one-to-one."""

from __future__ import annotations

import sympy as sp

from ratfit._generators import sampled


def inverted(plain: sp.Expr, unknowns: tuple[sp.Symbol, ...]) -> sp.Expr:
    """The residual c*f(g) + d as g minus the inverse of f at -d/c, as long as f is one-to-one there; else as it is.

    sqrt(b) = 0 is b = 0, which Newton's method would never reach; exp((a + b)/(1 + c)) = 2 is linear in a and b.
    """
    inside: list[sp.Expr] = []
    outside: list[sp.Expr] = []
    for term in sp.Add.make_args(plain):
        (inside if term.has(*unknowns) else outside).append(term)
    if len(inside) != 1:
        return plain
    constant, call = inside[0].as_independent(*unknowns, as_Add=False)
    inverse = inverse_of(call, -sp.Add(*outside) / constant)
    return plain if inverse is None else inverted(inverse, unknowns)


def inverse_of(call: sp.Expr, value: sp.Expr) -> sp.Expr | None:
    """The argument of a function minus what gives that value; None where that is not one number, or not real."""
    low = min(sampled(value))
    if isinstance(call, sp.exp):
        return call.args[0] - sp.log(value) if low > 0 else None
    if isinstance(call, sp.log):
        return call.args[0] - sp.exp(value)
    if isinstance(call, sp.tanh):
        return call.args[0] - sp.atanh(value) if low > -1 and max(sampled(value)) < 1 else None
    if call.is_Pow and call.exp.is_Rational and not call.exp.is_Integer:
        return call.base - value ** (1 / call.exp) if low > 0 or value == 0 else None
    return None
