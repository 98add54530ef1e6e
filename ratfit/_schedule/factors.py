"""Products of polynomials, each about its own centre, and how they are written down."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import sympy as sp

from ratfit._schedule.constants import as_number
from ratfit._schedule.context import Context
from ratfit._schedule.fraction import Form
from ratfit._schedule.program import Value
from ratfit._schedule.structure import as_given, write_powers
from ratfit._schedule.tape import Tape


@dataclass(frozen=True)
class Part:
    """`(scale*polynomial(z - centre))**exponent`; with more generators than one there is no centre."""

    polynomial: Any
    exponent: int = 1
    centre: Any = None
    scale: sp.Expr = sp.S.One

    @property
    def lead(self) -> Any:
        return self.polynomial.LC

    @property
    def degree(self) -> int:
        return self.polynomial.degree()

    def times(self, factor: Any) -> Part:
        return replace(self, polynomial=self.polynomial.mul_ground(factor))


class Product(NamedTuple):
    """A coefficient times parts."""

    coefficient: Any
    parts: tuple[Part, ...]

    def lead(self) -> Any:
        return math.prod((part.lead**part.exponent for part in self.parts), start=self.coefficient)

    def side(self, sign: int) -> Product:
        """The parts of the numerator or of the denominator alone."""
        return Product(self.coefficient**0, tuple(part for part in self.parts if part.exponent * sign > 0))


def write(context: Context, form: Form, product: Product, tape: Tape) -> Value:
    coefficient = tape.constant(as_number(context, form, product.coefficient))
    factors = [(write_part(context, form, part, tape), part.exponent) for part in product.parts]
    return write_powers(tape, [(coefficient, 1), *factors])


def write_part(context: Context, form: Form, part: Part, tape: Tape) -> Value:
    values = [as_given(context, generator, tape) for generator in form.generators]
    if part.centre is not None:
        values = [tape.sub(values[0], tape.constant(as_number(context, form, part.centre)))]

    def number(coefficient: Any) -> Value:
        return tape.constant(part.scale * as_number(context, form, coefficient))

    return horner(tape, part.polynomial.terms(), values, number)


def horner(tape: Tape, terms: list[Any], values: list[Value], number: Callable[[Any], Value]) -> Value:
    """Horner's rule in the generator that most terms have, its coefficients by Horner's rule in the others."""
    counts = [sum(exponents[i] > 0 for exponents, _ in terms) for i in range(len(values))]
    if not any(counts):
        return number(terms[0][1])
    main = counts.index(max(counts))
    coefficients: dict[int, list[Any]] = {}
    for exponents, coefficient in terms:
        rest = (*exponents[:main], 0, *exponents[main + 1 :])
        coefficients.setdefault(exponents[main], []).append((rest, coefficient))
    degrees = sorted(coefficients, reverse=True)
    total = horner(tape, coefficients[degrees[0]], values, number)
    for high, low in itertools.pairwise([*degrees, 0] if degrees[-1] else degrees):
        total = tape.mul(total, tape.power(values[main], high - low))
        if low in coefficients:
            total = tape.add(total, horner(tape, coefficients[low], values, number))
    return total
