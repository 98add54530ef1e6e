"""Cosines and slopes as every masking takes them: the horizon, normal view and what rounding puts beyond it."""

from sympy import Expr, Integer, Max, Or, Piecewise, S, sqrt

from ratfit.brdf._limits import instead

_FAR = Integer(30)
"""a is held below this: from here on 1 - G and erfc(a) are less than exp(-900), which no double tells from 0."""


def above(v: Expr, value: Expr) -> Expr:
    """A value above the horizon, 0 on it and below.

    The value is computed there too, so each function puts a harmless cosine in place of v: nan times 0 is nan.
    """
    return Piecewise((0, v <= 0), (value, True))


def both_above(v: Expr, v_prime: Expr, value: Expr) -> Expr:
    return Piecewise((0, Or(v <= 0, v_prime <= 0)), (value, True))


def positive(cosine: Expr) -> Expr:
    """The cosine, or a harmless one under the horizon."""
    return instead(cosine, 1, cosine <= 0)


def held(v: Expr) -> Expr:
    """A cosine in (0, 1]: what rounding has put above 1 is 1, with the function's own slope at 1."""
    return instead(v, 1, Or(v <= 0, v > 1))


def sine(v: Expr, scale: Expr | int = 1) -> Expr:
    """sqrt(scale) times the sine, 0 from v = 1 on: its slope there is infinite, so the root is not taken of 0.

    The scale is put inside the root, where 2 is exact: sqrt(2) is not.
    """
    oblique = instead(v, S.Half, Or(v <= 0, v >= 1))
    return Piecewise((0, v >= 1), (sqrt(scale * (1 - oblique) * (1 + oblique)), True))


def slope_ratio(v: Expr, spread: Expr) -> Expr:
    """a = v/spread with spread = alpha sin(theta): cot(theta) over alpha, at most 30."""
    return 1 / Max(spread / positive(v), 1 / _FAR)
