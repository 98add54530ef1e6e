"""The expression as a fraction over a field of constants."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import sympy as sp
from sympy import QQ
from sympy.polys.fields import FracField
from sympy.polys.rings import PolyRing

from ratfit._schedule.bounded import MOST_VOLUME, added, multiplied, raised, volume
from ratfit._schedule.context import Context, Refused

_MOST_GENERATORS = 40

Factors = list[tuple[Any, int]]  # polynomials and their exponents
_Key = tuple[sp.Expr, sp.Expr]


@dataclass(frozen=True, eq=False)
class Form:
    """`numerator/denominator`, polynomials in the generators that vary over the field of those that do not.

    `constant*product(over)/product(under)` is the same in factors; `granted` are the constants' factors by which the
    input divides; `numbers` remembers coefficients as expressions, None for those that must not be used.
    """

    numerator: Any
    denominator: Any
    constant: Any
    over: Factors
    under: Factors
    generators: tuple[sp.Expr, ...]
    constants: tuple[sp.Expr, ...]
    granted: frozenset[Any]
    numbers: dict[Any, sp.Expr | None] = field(default_factory=dict)

    @property
    def one(self) -> Any:
        return self.numerator.ring.domain.one


def _leaf(expression: sp.Expr) -> tuple[_Key, sp.Rational] | None:
    """`base**(multiple*rest)` as `(base, rest), multiple`; None for what arithmetic takes apart further."""
    if expression.is_Rational or expression.is_Add or expression.is_Mul:
        return None
    base, exponent = expression.as_base_exp()
    if exponent.is_Integer and base != expression:
        return None
    multiple, rest = exponent.as_coeff_Mul()
    return (base, rest), multiple


def _unit(key: _Key, multiples: list[sp.Rational]) -> sp.Rational:
    """The largest number of which all the exponents are multiples: the generator is the power of it."""
    unit = abs(functools.reduce(sp.Rational.gcd, multiples))
    # exp(-x) is a better generator than 1/exp(-x); for x**(-1/2) it is the other way round.
    return -unit if key[1] != 1 and all(multiple < 0 for multiple in multiples) else unit


def read(context: Context, expression: sp.Expr, coarse: bool) -> Form:
    return _Reader(context, expression, coarse).form(expression)


class _Reader:
    """Reads an expression as a fraction. With `coarse`, each coefficient is one generator, whatever is in it.

    The polynomials here are over QQ in all generators, those that vary first: gcd and factors are fastest there.
    """

    def __init__(self, context: Context, expression: sp.Expr, coarse: bool) -> None:
        self.context, self.coarse = context, coarse
        powers: dict[_Key, list[sp.Rational]] = {}
        self._collect(expression, powers)
        self.units = {key: _unit(key, multiples) for key, multiples in powers.items()}
        generators = {key: key[0] ** (unit * key[1]) for key, unit in self.units.items()}
        moving = [key for key in generators if context.varies(generators[key])]
        still = [key for key in generators if key not in moving]
        if len(generators) > _MOST_GENERATORS or not moving:
            raise Refused
        self.generators = tuple(generators[key] for key in moving)
        # A field needs a generator: where there is no constant, 1 stands in.
        self.constants = tuple(generators[key] for key in still) or (sp.S.One,)
        symbols = [sp.Dummy() for _ in self.generators + self.constants]
        self.flat = PolyRing(symbols, QQ)
        self.ring = PolyRing(symbols[: len(moving)], FracField(symbols[len(moving) :], QQ).to_domain())
        self.places = dict(zip(moving + still, self.flat.gens, strict=False))
        self.granted: set[Any] = set()

    def _collect(self, expression: sp.Expr, powers: dict[_Key, list[sp.Rational]]) -> None:
        if leaf := self._leaf(expression):
            powers.setdefault(leaf[0], []).append(leaf[1])
        elif expression.is_Add or expression.is_Mul:
            for part in self._parts(expression):
                self._collect(part, powers)
        elif not expression.is_Rational:
            self._collect(expression.as_base_exp()[0], powers)

    def _leaf(self, expression: sp.Expr) -> tuple[_Key, sp.Rational] | None:
        if self.coarse and not expression.is_Rational and not self.context.varies(expression):
            return (expression, sp.S.One), sp.S.One
        return _leaf(expression)

    def _parts(self, expression: sp.Expr) -> Iterable[sp.Expr]:
        if not self.coarse:
            return expression.args
        if expression.is_Mul:
            constant, rest = expression.as_independent(self.context.variable)
            return (constant, *sp.Mul.make_args(rest))
        collected: dict[sp.Expr, list[sp.Expr]] = {}
        for term in expression.args:
            constant, rest = term.as_independent(self.context.variable, as_Add=False)
            collected.setdefault(rest, []).append(constant)
        return [sp.Mul(sp.Add(*constants), rest) for rest, constants in collected.items()]

    def form(self, expression: sp.Expr) -> Form:
        above, below = map(self._reduced, self._ratio(expression))
        if not above or not below:
            raise Refused
        if max(volume(above), volume(below)) <= MOST_VOLUME:
            above, below = above.cancel(below)
        (constant, over), (divisor, under) = self._factored(above), self._factored(below)
        sides = self._nested(above), self._nested(below)
        return Form(*sides, constant / divisor, over, under, self.generators, self.constants, frozenset(self.granted))

    def _reduced(self, polynomial: Any) -> Any:
        """`sqrt(2)**2` is 2: powers of roots of numbers taken down."""
        roots = [(key, unit) for key, unit in self.units.items() if key[0].is_Rational and key[1] == 1]
        relations = [self.places[key] ** int(unit.q) - QQ(key[0].p, key[0].q) ** int(unit.p) for key, unit in roots]
        return polynomial.rem(relations) if relations else polynomial

    def _ratio(self, expression: sp.Expr) -> tuple[Any, Any]:
        if expression.is_Rational:
            return self.flat(QQ(expression.p, expression.q)), self.flat(1)
        if leaf := self._leaf(expression):
            times = leaf[1] / self.units[leaf[0]]
            if abs(times) > MOST_VOLUME:
                raise Refused  # exponents without a common unit, as decimals are
            return self._power((self.places[leaf[0]], self.flat(1)), int(times))
        if expression.is_Add or expression.is_Mul:
            combined = added if expression.is_Add else multiplied
            return functools.reduce(combined, map(self._ratio, self._parts(expression)))
        base, exponent = expression.as_base_exp()
        return self._power(self._ratio(base), int(exponent))

    def _power(self, ratio: tuple[Any, Any], exponent: int) -> tuple[Any, Any]:
        above, below = ratio if exponent > 0 else ratio[::-1]
        if exponent < 0:
            self.granted.update(self._constant_factors(below))
        return raised(above, abs(exponent)), raised(below, abs(exponent))

    def _constant_factors(self, polynomial: Any) -> list[Any]:
        nested = self._nested(polynomial)
        if not nested.is_ground or volume(polynomial) > MOST_VOLUME:
            return []
        return [factor.monic() for factor, _ in nested.LC.numer.factor_list()[1]]

    def _factored(self, polynomial: Any) -> tuple[Any, Factors]:
        """`(constant, factors)`; a polynomial too large to be factored is its own factor."""
        large = volume(polynomial) > MOST_VOLUME
        number, factors = (QQ(1), [(polynomial, 1)]) if large else polynomial.factor_list()
        nested = [(self._nested(factor), exponent) for factor, exponent in factors]
        constants = [factor.LC**exponent for factor, exponent in nested if factor.is_ground]
        return math.prod(constants, start=self.ring.domain(number)), [pair for pair in nested if not pair[0].is_ground]

    def _nested(self, polynomial: Any) -> Any:
        """The same polynomial over the field of constants."""
        count, base = len(self.generators), self.ring.domain.field
        grouped: dict[tuple[int, ...], dict[tuple[int, ...], Any]] = {}
        for exponents, number in polynomial.terms():
            grouped.setdefault(exponents[:count], {})[exponents[count:]] = number
        return self.ring.from_dict({outer: base(base.ring.from_dict(inner)) for outer, inner in grouped.items()})
