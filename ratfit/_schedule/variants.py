"""One product in several ways: about another centre, monic, its coefficient in front or inside."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any

from ratfit._schedule.bounded import MOST_VOLUME
from ratfit._schedule.constants import as_number, positive_root
from ratfit._schedule.context import Context, attempt
from ratfit._schedule.factors import Part, Product
from ratfit._schedule.fraction import Form

MOST_MOVED = 16  # degree of a polynomial that is moved to another centre, or divided
_MOST_CENTRES = 3


def about_centres(form: Form, product: Product) -> Iterator[Product]:
    """The product as it is, then about each centre that rids a part of degree two or more of a term."""
    yield product
    if len(form.generators) > 1 or not all(part.degree <= MOST_MOVED for part in product.parts):
        return
    centres = [_centre(part) for part in product.parts if part.degree]
    for centre in list(dict.fromkeys(centre for centre in centres if centre))[:_MOST_CENTRES]:
        moved = [_about(part, centre) for part in product.parts]
        if any(new is not old and old.degree > 1 for new, old in zip(moved, product.parts, strict=True)):
            yield Product(product.coefficient, tuple(moved))


def _centre(part: Part) -> Any:
    """Where the term after the leading one vanishes: a linear factor's root, a polynomial's Tschirnhaus shift."""
    second = part.polynomial.get((part.degree - 1,), part.polynomial.ring.domain.zero)
    return -second / (part.degree * part.lead)


def _about(part: Part, centre: Any) -> Part:
    """The part about a centre, if that leaves it with fewer terms."""
    polynomial, degree = part.polynomial, part.degree
    if growth(polynomial, [centre], degree) > MOST_VOLUME:
        return part
    coefficients = [polynomial.get((i,), polynomial.ring.domain.zero) for i in range(degree + 1)]
    for done in range(degree):
        for i in reversed(range(done, degree)):
            coefficients[i] += centre * coefficients[i + 1]
    moved = polynomial.ring.from_dict({(i,): coefficient for i, coefficient in enumerate(coefficients) if coefficient})
    return replace(part, polynomial=moved, centre=centre) if len(moved) < len(polynomial) else part


def growth(polynomial: Any, factors: Iterable[Any], times: int) -> int:
    """A bound on the volume of the coefficients after they have been multiplied by the factors so many times."""
    start, grown = _degrees(polynomial.coeffs()), _degrees(factors)
    return math.prod(a + times * b + 1 for a, b in zip(start, grown, strict=True))


def _degrees(coefficients: Iterable[Any]) -> list[int]:
    sides = [side.degrees() for c in coefficients for side in (c.numer, c.denom)]
    return [max(0, *degrees) for degrees in zip(*sides, strict=True)]


def scalings(context: Context, form: Form, product: Product) -> Iterator[Product]:
    """The coefficient in front or inside a part, the parts as they are or monic."""
    for variant in dict.fromkeys((product, _monic(context, form, product))):
        yield variant
        for i, part in enumerate(variant.parts):
            absorbed = attempt(functools.partial(_absorbed, context, form, variant.coefficient, part))
            if absorbed is not None and len(part.polynomial) > 1 and variant.coefficient != 1:
                yield Product(absorbed[0], (*variant.parts[:i], absorbed[1], *variant.parts[i + 1 :]))


def _monic(context: Context, form: Form, product: Product) -> Product:
    """Leading coefficients taken out, where they are known not to vanish."""
    coefficient, parts = product.coefficient, []
    for part in product.parts:
        divisible = attempt(functools.partial(as_number, context, form, 1 / part.lead)) is not None
        coefficient *= part.lead**part.exponent if divisible else 1
        parts.append(part.times(1 / part.lead) if divisible else part)
    return Product(coefficient, tuple(parts))


def _absorbed(context: Context, form: Form, coefficient: Any, part: Part) -> tuple[Any, Part]:
    """`coefficient*part` with what can be of the coefficient inside the part; what is left is 1 or -1."""
    if abs(part.exponent) == 1:
        return form.one, part.times(coefficient**part.exponent)
    sign, root = positive_root(context, form, coefficient, part.exponent)
    return form.one * sign, replace(part, scale=root)
