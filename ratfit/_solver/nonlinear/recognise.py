"""Recognise: closed forms for numbers of 50 digits; guesses, to be verified by whoever asks."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterator, Sequence
from typing import TypeAlias

import mpmath
import sympy as sp
from flint import arb

from ratfit._multiprecise import midpoint

Number: TypeAlias = arb | mpmath.mpf | sp.Float | str

MARGIN = 4
"""Digits at the end of a number that need not be right."""

SPARE = 2
"""A form may carry a half of the number's digits: by chance one fits with a probability of 10**-(the other half)."""

PRIMES = (2, 3, 5, 7)
"""In a product of powers of the constants, the primes of its rational factor."""

MOST_TERMS = 8
"""In a relation; with more, 50 digits no longer tell a relation from chance."""


def recognised(values: Sequence[Number], constants: Sequence[sp.Expr], digits: int = 50) -> list[sp.Expr] | None:
    """Closed forms of all the numbers: rational, quadratic, or of the given constants.

    **Arguments:**

    - `values`: real numbers, right to `digits` digits.
    - `constants`: that may occur, as pi or sqrt(2): those of the problem that the numbers come from.
    - `digits`: what is known of each value. A form is believed when its integers together have at most half as many.

    **Returns:** one expression for every number, simplest kinds first: rational; a + b*sqrt(c); a rational
    combination of products of the constants; a quotient of two such with one constant; a product of powers. These
    agree with the numbers to `digits - 4` digits and are guesses, not proofs. None as soon as one number has no form.

    Source: H. Ferguson, D. Bailey, S. Arno, "Analysis of PSLQ", Mathematics of Computation 68 (1999); mpmath.pslq.
    """
    with mpmath.workdps(digits + 10):
        found: list[sp.Expr] = []
        for value in values:
            form = _form(_multiprecise(value), tuple(constants), digits)
            if form is None:
                return None
            found.append(form)
        return found


def _multiprecise(value: Number) -> mpmath.mpf:
    if isinstance(value, arb):
        return midpoint(value)
    return mpmath.mpf(sp.Float(value, mpmath.mp.dps)._mpf_) if isinstance(value, sp.Float) else mpmath.mpf(value)


def _form(x: mpmath.mpf, constants: tuple[sp.Expr, ...], digits: int) -> sp.Expr | None:
    """The first guess that agrees with the number when it is evaluated again, from scratch."""
    for guess in _guesses(x, constants, digits):
        if guess is not None and abs(_value(guess) - x) <= mpmath.mpf(10) ** (MARGIN - digits) * (1 + abs(x)):
            return guess
    return None


def _guesses(x: mpmath.mpf, constants: tuple[sp.Expr, ...], digits: int) -> Iterator[sp.Expr | None]:
    yield _rational(x, digits)
    yield _quadratic(x, digits)
    for basis in _bases(constants, digits):
        yield _linear(x, basis, digits)
    for constant in constants:
        yield _quotient(x, constant, digits)
    yield _product(x, constants, digits)


def _value(expression: sp.Expr) -> mpmath.mpf:
    return mpmath.mpf(sp.Float(sp.N(expression, mpmath.mp.dps), mpmath.mp.dps)._mpf_)


@functools.lru_cache(maxsize=32)
def _bases(constants: tuple[sp.Expr, ...], digits: int) -> tuple[tuple[sp.Expr, ...], ...]:
    """What a linear combination may be made of: 1, the constants, and one kind of products of two at a time."""
    kinds = [
        [],
        [c**2 for c in constants],
        [c * d for c, d in itertools.combinations(constants, 2)],
        [1 / c for c in constants],
        [c / d for c, d in itertools.permutations(constants, 2)],
    ]
    return tuple(dict.fromkeys(_independent((sp.S.One, *constants, *kind), digits) for kind in kinds))


def _independent(numbers: Sequence[sp.Expr], digits: int) -> tuple[sp.Expr, ...]:
    """Those without a relation to the ones before: a relation among the constants would hide the one looked for."""
    kept: list[sp.Expr] = []
    for number in numbers:
        if len(kept) == MOST_TERMS - 1:
            break
        if not kept or _relation([_value(e) for e in (number, *kept)], digits) is None:
            kept.append(number)
    return tuple(kept)


def _relation(numbers: Sequence[mpmath.mpf], digits: int) -> list[int] | None:
    """Small integers with which the numbers add up to 0: together they have at most half the digits known."""
    largest = 10 ** (digits // SPARE // len(numbers))
    tolerance = mpmath.mpf(10) ** (MARGIN - digits) * max(map(abs, numbers))
    return mpmath.pslq(list(numbers), tol=tolerance, maxcoeff=largest, maxsteps=10_000)


def _rational(x: mpmath.mpf, digits: int) -> sp.Expr | None:
    """The first continued fraction that agrees, if it is short: a chance match needs as many digits as it explains."""
    numerators, denominators, rest = (0, 1), (1, 0), x
    most = 10 ** (digits // SPARE)
    while True:
        whole = int(mpmath.floor(rest))
        numerators = (numerators[1], whole * numerators[1] + numerators[0])
        denominators = (denominators[1], whole * denominators[1] + denominators[0])
        p, q = numerators[1], denominators[1]
        if max(abs(p), 1) * q > most:
            return None
        if abs(x - mpmath.mpf(p) / q) <= mpmath.mpf(10) ** (MARGIN - digits) * (1 + abs(x)):
            return sp.Rational(p, q)
        rest = 1 / (rest - whole)


def _quadratic(x: mpmath.mpf, digits: int) -> sp.Expr | None:
    found = _relation([mpmath.mpf(1), x, x * x], digits)
    if not found or not found[2]:
        return None
    c, b, a = found
    roots = [(-b + sign * sp.sqrt(b * b - 4 * a * c)) / (2 * a) for sign in (1, -1)]
    real = [sp.expand(root) for root in roots if root.is_real]
    return min(real, key=lambda root: abs(_value(root) - x), default=None)


def _linear(x: mpmath.mpf, basis: Sequence[sp.Expr], digits: int) -> sp.Expr | None:
    found = _relation([x, *(_value(e) for e in basis)], digits)
    if not found or not found[0]:
        return None
    return sp.Add(*(sp.Rational(-k, found[0]) * e for k, e in zip(found[1:], basis, strict=True)))


def _quotient(x: mpmath.mpf, constant: sp.Expr, digits: int) -> sp.Expr | None:
    """(a + b*c)/(d + e*c)."""
    value = _value(constant)
    found = _relation([x, x * value, mpmath.mpf(1), value], digits)
    if not found or not (found[0] or found[1]):
        return None
    return -(found[2] + found[3] * constant) / (found[0] + found[1] * constant)


def _product(x: mpmath.mpf, constants: tuple[sp.Expr, ...], digits: int) -> sp.Expr | None:
    """A rational power of small primes times rational powers of the positive constants."""
    if x == 0:
        return None
    factors = _factors(constants, digits)
    found = _relation([mpmath.log(abs(x)), *(mpmath.log(_value(f)) for f in factors)], digits)
    if not found or not found[0]:
        return None
    powers = (f ** sp.Rational(-k, found[0]) for k, f in zip(found[1:], factors, strict=True))
    return (1 if x > 0 else -1) * sp.Mul(*powers)


@functools.lru_cache(maxsize=32)
def _factors(constants: tuple[sp.Expr, ...], digits: int) -> tuple[sp.Expr, ...]:
    """Primes and positive constants of which no product of powers is 1."""
    positive = [sp.Integer(p) for p in PRIMES] + [c for c in constants if _value(c) > 0 and c != 1]
    logarithms = {sp.log(factor): factor for factor in positive}
    return tuple(logarithms[one] for one in _independent(tuple(logarithms), digits))
