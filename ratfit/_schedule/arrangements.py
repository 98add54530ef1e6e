"""Arrangements that follow the algebra."""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Iterator
from typing import Any

from ratfit._schedule.bounded import MOST_VOLUME
from ratfit._schedule.constants import as_number
from ratfit._schedule.context import Context, Plan
from ratfit._schedule.factors import Part, Product, horner, write, write_part
from ratfit._schedule.fraction import Factors, Form
from ratfit._schedule.program import Value
from ratfit._schedule.tape import Tape
from ratfit._schedule.variants import MOST_MOVED, about_centres, growth, scalings


def arrangements(context: Context, form: Form) -> Iterator[Plan]:
    """The algebraic arrangements, the ones closest to a factored fraction first."""
    products = [
        Product(form.constant, tuple(Part(polynomial, exponent) for polynomial, exponent in over + _inverted(under)))
        for over, under in itertools.product(_merged(form.over), _merged(form.under))
    ]
    for product in products:
        for moved in about_centres(form, product):
            yield from (functools.partial(write, context, form, scaled) for scaled in scalings(context, form, moved))
    if len(form.generators) == 1:
        yield from _by_numerator(context, form, products)
        yield from _by_parity(context, form)
        yield from _by_division(context, form, products)


def _inverted(factors: Factors) -> Factors:
    return [(polynomial, -exponent) for polynomial, exponent in factors]


def _merged(factors: Factors) -> list[Factors]:
    """The factors, and the factors with those of one exponent multiplied out."""
    groups: dict[int, list[Any]] = {}
    for polynomial, exponent in factors:
        groups.setdefault(exponent, []).append(polynomial)
    merged = [(math.prod(group[1:], start=group[0]), exponent) for exponent, group in groups.items()]
    return [factors, merged] if len(merged) < len(factors) else [factors]


def _by_numerator(context: Context, form: Form, products: list[Product]) -> Iterator[Plan]:
    """Where the denominator is `q*numerator + r`: `w/(q*w + r)`, with the numerator w in its factors."""
    over, under = form.numerator, form.denominator
    if over.degree() != under.degree() or over.degree() < 2:
        return
    slope = under.LC / over.LC
    rest = under - over.mul_ground(slope)
    if rest.degree() > 0:
        return
    for numerator in dict.fromkeys(product.side(1) for product in products):
        # over = constant*w, and the denominator is divided by the constant along with it
        line = Part(over.ring.gens[0].mul_ground(slope) + rest.mul_ground(numerator.lead() / over.LC))
        for moved in about_centres(form, numerator):
            yield functools.partial(_write_by_numerator, context, form, moved, line)


def _write_by_numerator(context: Context, form: Form, numerator: Product, line: Part, tape: Tape) -> Value:
    value = write(context, form, numerator, tape)
    terms = line.polynomial.terms()
    return tape.div(value, horner(tape, terms, [value], lambda c: tape.constant(as_number(context, form, c))))


def _by_parity(context: Context, form: Form) -> Iterator[Plan]:
    """Where `N(-z) = ratio*D(z)`: `ratio*(E + O)/(E - O)`, E and O the even and odd parts of N."""
    over, under = form.numerator, form.denominator
    halves = [over.ring.from_dict({e: c for e, c in over.terms() if e[0] % 2 == parity}) for parity in (0, 1)]
    mirrored = halves[0] - halves[1]
    ratio = mirrored.LC / under.LC
    if mirrored != under.mul_ground(ratio) or not all(halves):
        return
    for scale in dict.fromkeys((form.one, 1 / halves[0].LC, 1 / halves[1].LC)):
        even, odd = (Part(half).times(scale) for half in halves)
        yield functools.partial(_write_by_parity, context, form, ratio, even, odd)


def _write_by_parity(context: Context, form: Form, ratio: Any, even: Part, odd: Part, tape: Tape) -> Value:
    a, b = (write_part(context, form, part, tape) for part in (even, odd))
    return tape.mul(tape.constant(as_number(context, form, ratio)), tape.div(tape.add(a, b), tape.sub(a, b)))


def _by_division(context: Context, form: Form, products: list[Product]) -> Iterator[Plan]:
    """Polynomial part plus proper fraction. Last, for it is the one that cancels near a zero."""
    over, under = form.numerator, form.denominator
    steps = over.degree() - under.degree() + 1
    if not under.degree() > 0 or steps < 1 or over.degree() > MOST_MOVED:
        return
    if growth(over, under.coeffs(), steps) > MOST_VOLUME:
        return
    quotient, remainder = over.div(under)
    if not remainder:
        return
    for denominator in dict.fromkeys(product.side(-1) for product in products):
        constant = 1 / (under.LC * denominator.lead())
        parts = (Part(quotient), Part(remainder), *denominator.parts)
        for moved in about_centres(form, Product(constant, parts)):
            polynomial, top, *bottom = moved.parts
            # a remainder of degree 0 belongs to the coefficient
            proper = Product(constant, (top, *bottom)) if top.degree else Product(constant * top.lead, tuple(bottom))
            for scaled in scalings(context, form, proper):
                yield functools.partial(_write_by_division, context, form, polynomial, scaled)


def _write_by_division(context: Context, form: Form, polynomial: Part, proper: Product, tape: Tape) -> Value:
    return tape.add(write_part(context, form, polynomial, tape), write(context, form, proper, tape))
