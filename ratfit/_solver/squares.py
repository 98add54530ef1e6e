"""Square roots of squares: sqrt(4*a**2*b**2 + (a**2 - b**2)**2) is a**2 + b**2, which the exact field does not see.

There it would be a root of its own with a square for its radicand: a divisor of zero, so that equal numbers were not
seen to be equal.
"""

from __future__ import annotations

import sympy as sp

from ratfit._field import Field
from ratfit._parse import RatfitError


def without_squares(expression: sp.Expr) -> sp.Expr:
    """The expression with every square taken out of its square roots, the innermost first.

    A factor is taken out where its sign is known from the ranges of the symbols in it; others stay as they are.
    """
    if expression.is_Atom or not expression.has(sp.Pow):
        return expression
    rebuilt = expression.func(*(without_squares(part) for part in expression.args))
    is_root = rebuilt.is_Pow and rebuilt.exp.is_Rational and rebuilt.exp.q == 2
    return _root(rebuilt.base) ** (2 * rebuilt.exp) if is_root and rebuilt.base.free_symbols else rebuilt


def _root(radicand: sp.Expr) -> sp.Expr:
    """The square root of a radicand; as it was given where no square is in it."""
    names = {part: sp.Dummy() for part in _irrational(radicand)}
    meaning = {dummy: part for part, dummy in names.items()}
    outside, inside = sp.S.One, sp.S.One
    for part, sign in zip(sp.fraction(sp.together(radicand.xreplace(names))), (1, -1), strict=True):
        content, factors = sp.factor_list(part)
        inside *= content**sign
        for factor, power in factors:
            base = factor.xreplace(meaning)
            size = _size(base) if power > 1 else None
            if size is not None:
                outside *= size ** (sign * (power // 2))
                power %= 2
            inside *= base ** (sign * power)
    return outside * sp.sqrt(inside) if outside != 1 else sp.sqrt(radicand)


def _irrational(expression: sp.Expr) -> set[sp.Expr]:
    """What stands for itself among sums, products and whole powers: roots and functions."""
    if expression.is_Rational or expression.is_Symbol:
        return set()
    if expression.is_Add or expression.is_Mul or (expression.is_Pow and expression.exp.is_Integer):
        return set().union(*(_irrational(part) for part in expression.args))
    return {expression}


def _size(base: sp.Expr) -> sp.Expr | None:
    """The absolute value of a factor whose sign does not change; None where the sign is not known."""
    if base.is_nonnegative:
        return base
    return -base if base.is_nonpositive else None


def plain(number: sp.Expr) -> sp.Expr:
    """A number without squares in its roots, in the normal form of the exact field; as it was where none is there."""
    rooted = without_squares(number)
    return number if rooted == number else normal(rooted)


def normal(number: sp.Expr) -> sp.Expr:
    """A number in the normal form of the exact field; one that is not real stays as it is."""
    try:
        field = Field([number])
        return field.decode(field.encode(number))
    except RatfitError:
        return number
