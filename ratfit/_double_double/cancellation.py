"""Differences that lose everything near a zero, written so that they lose nothing.

`1 - cos(x)` at x = 1e-20 is 0 in double-double as in float64, and every float32 below 1e-16 is such a place. Where an
identity is known the difference is replaced; what is not known (`x - sin(x)`) keeps its loss.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import sympy as sp


def _square_of_half(function: Callable[[sp.Expr], sp.Expr], factor: int) -> Callable[[sp.Expr], sp.Expr]:
    return lambda node: factor * function(node.args[0] / 2) ** 2


def _of_root(node: sp.Pow) -> sp.Expr:
    """sqrt(a) - 1 = (a - 1)/(sqrt(a) + 1); far from 1 it stays, as the quotient of infinite ones is nan."""
    return sp.Piecewise(((node.base - 1) / (node + 1), node.base < 4), (node - 1, True))


def _of_exponential(node: sp.Expr) -> sp.Expr:
    """exp(u) - 1 = tanh(u/2) (exp(u) + 1), which stays -1 and infinite at the two ends."""
    return sp.tanh(node.args[0] / 2) * (node + 1)


# f(u) -> f(u) - 1, by the formulas of half the angle and the definitions.
_LESS_ONE: Mapping[type, Callable[[sp.Expr], sp.Expr]] = {
    sp.cos: _square_of_half(sp.sin, -2),
    sp.cosh: _square_of_half(sp.sinh, 2),
    sp.exp: _of_exponential,
    sp.tanh: lambda node: -2 / (sp.exp(2 * node.args[0]) + 1),
    sp.erf: lambda node: -sp.erfc(node.args[0]),
    sp.erfc: lambda node: -sp.erf(node.args[0]),
}


def without_cancellation(expression: sp.Expr) -> sp.Expr:
    """The expression with every `k f(u) - k` that has a known form in that form."""
    return expression.replace(lambda node: isinstance(node, sp.Add), _rewritten)


def _rewritten(node: sp.Add) -> sp.Expr:
    terms = list(node.args)
    for term in node.args:
        for factor in sp.Mul.make_args(term):
            scale = term / factor
            if term in terms and -scale in terms and factor.free_symbols and _is_known(factor):
                terms.remove(term)
                terms.remove(-scale)
                terms.append(scale * _less_one(factor))
    return sp.Add(*terms)


def _is_known(factor: sp.Expr) -> bool:
    return factor.func in _LESS_ONE or (isinstance(factor, sp.Pow) and factor.exp == sp.S.Half)


def _less_one(factor: sp.Expr) -> sp.Expr:
    return _of_root(factor) if isinstance(factor, sp.Pow) else _LESS_ONE[factor.func](factor)
