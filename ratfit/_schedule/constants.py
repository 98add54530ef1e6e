"""Constants: what may be divided by, and drawn a root of."""

from __future__ import annotations

from typing import Any

import sympy as sp

from ratfit._schedule.context import Context, Refused
from ratfit._schedule.fraction import Form


def as_number(context: Context, form: Form, coefficient: Any) -> sp.Expr:
    """A coefficient as an expression, unless it divides by what may be zero."""
    if coefficient not in form.numbers:
        factors = [factor for factor, _ in coefficient.denom.factor_list()[1] if factor.monic() not in form.granted]
        known = all(context.sign(factor.as_expr(*form.constants)) for factor in factors)
        form.numbers[coefficient] = coefficient.as_expr(*form.constants) if known else None
    number = form.numbers[coefficient]
    if number is None:
        raise Refused
    return number


def positive_root(context: Context, form: Form, coefficient: Any, degree: int) -> tuple[int, sp.Expr]:
    """`(sign, root)` with `sign*root**degree` equal to the coefficient and the root positive."""
    sign, root = 1, sp.S.One
    for polynomial, side in ((coefficient.numer, 1), (coefficient.denom, -1)):
        content, factors = polynomial.factor_list()
        pieces = [(sp.Rational(int(content.numerator), int(content.denominator)), 1)]
        pieces += [(factor.as_expr(*form.constants), exponent) for factor, exponent in factors]
        for piece, exponent in pieces:
            known = context.sign(piece)
            if known is None:
                raise Refused
            sign *= known**exponent
            root *= (known * piece) ** sp.Rational(side * exponent, degree)
    return sign, root
