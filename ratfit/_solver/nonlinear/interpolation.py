"""Interpolation of coefficients in one or two parameters, through the nodes of a tensor grid of Chebyshev points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mpmath
import sympy as sp

from ratfit._multiprecise import multiprecise
from ratfit._target import Parameter

DIGITS = 70

SPARE = 2
"""Digits that are kept beyond those that interpolation has right."""

Powers = tuple[int, ...]


@dataclass(frozen=True)
class Interpolant:
    """A polynomial in the parameters, each scaled to [-1, 1]: its coefficients by their powers.

    `error` estimates how far it is from what it interpolates, relative to its size: the coefficients of the highest
    powers tell how fast the others would have gone on to fall.
    """

    parameters: tuple[Parameter, ...]
    coefficients: dict[Powers, mpmath.mpf]
    error: float

    def shortened(self) -> sp.Expr:
        """The polynomial with the digits that are known: the error says how many, and SPARE more."""
        size = max(map(abs, self.coefficients.values()))
        smallest = size * mpmath.mpf(max(self.error, 10.0 ** (SPARE - 40))) / 10**SPARE
        scaled = [(2 * p - p.low - p.high) / (p.high - p.low) for p in self.parameters]
        terms = []
        for powers, coefficient in self.coefficients.items():
            digits = int(mpmath.floor(mpmath.log10(abs(coefficient) / smallest))) + 1 if coefficient else 0
            if digits > 0:
                number = sp.Rational(mpmath.nstr(coefficient, digits, strip_zeros=False))
                terms.append(number * sp.Mul(*(t**k for t, k in zip(scaled, powers, strict=True))))
        return sp.Add(*terms)


def interpolant(
    parameters: Sequence[Parameter], nodes: Sequence[tuple[sp.Rational, ...]], values: Sequence[sp.Rational]
) -> Interpolant:
    """The polynomial that takes the values at the nodes of a tensor grid, the last parameter running fastest."""
    with mpmath.workdps(DIGITS):
        axes = [list(dict.fromkeys(node[k] for node in nodes)) for k in range(len(parameters))]
        scaled = [[_scaled(p, value) for value in axis] for p, axis in zip(parameters, axes, strict=True)]
        grid: dict[Powers, list[mpmath.mpf]] = {(): [multiprecise(v) for v in values]}
        for places in scaled:
            # One axis after the other: rows along it become coefficients, a list for each power.
            block = len(next(iter(grid.values()))) // len(places)
            grid = {
                (*powers, k): [column[k] for column in columns]
                for powers, flat in grid.items()
                for columns in [[_newton(places, flat[i::block]) for i in range(block)]]
                for k in range(len(places))
            }
        coefficients = {powers: flat[0] for powers, flat in grid.items()}
        size = max(map(abs, coefficients.values()))
        # Of x**k the Chebyshev polynomial of that degree is the part 2**(1 - k): what the last two leave undone.
        last = [len(axis) - 2 for axis in axes]
        tail = [
            abs(c) * mpmath.ldexp(1, sum(1 - k for k in powers if k))
            for powers, c in coefficients.items()
            if any(k >= top for k, top in zip(powers, last, strict=True))
        ]
        return Interpolant(tuple(parameters), coefficients, float(max(tail) / size) if size else 0.0)


def _scaled(parameter: Parameter, value: sp.Rational) -> mpmath.mpf:
    return multiprecise((2 * value - parameter.low - parameter.high) / (parameter.high - parameter.low))


def _newton(places: Sequence[mpmath.mpf], values: Sequence[mpmath.mpf]) -> list[mpmath.mpf]:
    """Divided differences, multiplied out into powers: on [-1, 1] these stay of moderate size."""
    table = list(values)
    for k in range(1, len(places)):
        for i in range(len(places) - 1, k - 1, -1):
            table[i] = (table[i] - table[i - 1]) / (places[i] - places[i - k])
    found = [mpmath.mpf(0)] * len(places)
    for place, difference in zip(reversed(places), reversed(table), strict=True):
        shifted = [mpmath.mpf(0), *found[:-1]]
        found = [s - place * c for s, c in zip(shifted, found, strict=True)]
        found[0] += difference
    return found
