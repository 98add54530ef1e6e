"""Polynomials with exact coefficients, the constant one first, and how a fraction of two is written for float32."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import reduce

import sympy as sp

Polynomial = Sequence[Fraction]


def times(first: Polynomial, second: Polynomial) -> list[Fraction]:
    """The product of two polynomials."""
    product = [Fraction(0)] * (len(first) + len(second) - 1)
    for i, a in enumerate(first):
        for j, b in enumerate(second):
            product[i + j] += a * b
    return product


def plus(first: Polynomial, second: Polynomial) -> list[Fraction]:
    """The sum of two polynomials."""
    size = max(len(first), len(second))
    padded = [[*polynomial, *[Fraction(0)] * (size - len(polynomial))] for polynomial in (first, second)]
    return [a + b for a, b in zip(*padded, strict=True)]


def composed(outer: Polynomial, inner: Polynomial) -> list[Fraction]:
    """The outer polynomial of the inner one, by Horner's rule."""
    *rest, leading = outer
    return reduce(lambda value, coefficient: plus(times(value, inner), [coefficient]), reversed(rest), [leading])


def about(centre: sp.Expr, polynomial: Polynomial) -> list[Fraction]:
    """A polynomial of the variable as one of the distance from a centre."""
    return composed(polynomial, [rational(centre), Fraction(1)])


def horner(polynomial: Polynomial, x: sp.Expr) -> sp.Expr:
    """By Horner's rule in an expression of the variable; each coefficient becomes the double nearest to it."""
    value: sp.Expr = sp.S.Zero
    for coefficient in reversed(polynomial):
        value = value * x + sp.Rational(float(coefficient))
    return value


def fraction(above: Polynomial, below: Polynomial, x: sp.Symbol, centre: sp.Expr) -> sp.Expr:
    """A quotient of two polynomials in the distance from a centre; below the line the largest coefficient is 1."""
    moved = [about(centre, polynomial) for polynomial in (above, below)]
    scale = max(moved[1], key=abs)
    upper, lower = (horner([coefficient / scale for coefficient in part], x - centre) for part in moved)
    return upper / lower


def rational(number: sp.Expr) -> Fraction:
    """An exact rational number of sympy as Python's."""
    return Fraction(int(number.p), int(number.q))
