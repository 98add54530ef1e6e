"""Interpolation of coefficients in one or two parameters, through the nodes of a tensor grid."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from ratfit._target import Parameter

DIGITS = 70


def interpolant(
    parameters: Sequence[Parameter], nodes: Sequence[tuple[sp.Rational, ...]], values: Sequence[sp.Rational]
) -> sp.Expr:
    """The polynomial in the parameters, each scaled to [-1, 1], that takes the values at the nodes of a tensor grid.

    The nodes are ordered with the last parameter running fastest. Coefficients are rationals of DIGITS digits.
    """
    first, *others = parameters
    places = list(dict.fromkeys(node[0] for node in nodes))
    if not others:
        inner: list[sp.Expr] = list(values)
    else:
        width = len(nodes) // len(places)
        inner = [
            interpolant(others, [n[1:] for n in nodes[i : i + width]], values[i : i + width])
            for i in range(0, len(nodes), width)
        ]
    return _newton(_scaled(first), [_scaled_value(first, p) for p in places], inner)


def _scaled(parameter: Parameter) -> sp.Expr:
    return (2 * parameter - parameter.low - parameter.high) / (parameter.high - parameter.low)


def _scaled_value(parameter: Parameter, value: sp.Rational) -> sp.Expr:
    return (2 * value - parameter.low - parameter.high) / (parameter.high - parameter.low)


def _newton(t: sp.Expr, places: Sequence[sp.Expr], values: Sequence[sp.Expr]) -> sp.Expr:
    """Divided differences, multiplied out into powers of t: on [-1, 1] they stay of moderate size."""
    table = list(values)
    for k in range(1, len(places)):
        for i in range(len(places) - 1, k - 1, -1):
            table[i] = sp.expand((table[i] - table[i - 1]) / (places[i] - places[i - k]))
    u = sp.Dummy("u")
    total: sp.Expr = sp.S.Zero
    for place, difference in zip(reversed(places), reversed(table), strict=True):
        total = sp.expand(total * (u - place) + difference)
    coefficients = sp.Poly(total, u).all_coeffs()[::-1]
    return sp.Add(*(_rounded(c) * t**k for k, c in enumerate(coefficients)))


def _rounded(coefficient: sp.Expr) -> sp.Expr:
    """Rationals of thousands of digits, as exact interpolation makes them, cut to DIGITS."""
    long = {r: sp.Rational(str(sp.Float(r, DIGITS))) for r in coefficient.atoms(sp.Rational) if r.q > 10**DIGITS}
    return coefficient.xreplace(long)
