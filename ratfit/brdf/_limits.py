"""A formula with its limit in place of 0/0, safe for values and for gradients."""

from collections.abc import Callable

from sympy import Expr, Piecewise, S
from sympy.logic.boolalg import Boolean


def guarded(formula: Callable[[Expr], Expr], x: Expr, limit: Expr, where: Boolean, harmless: Expr) -> Expr:
    """formula(x), and limit where the condition holds.

    An array computes both branches, and a gradient multiplies the branch not taken by zero: nan times zero is nan.
    So where the condition holds the formula is given a harmless value in place of x.

    Arguments: the formula as a function of x; x, a symbol or an expression; its limit; where the limit is taken, a
    condition free of Piecewise (sympy folds it into what arrays do not have); harmless, any value at which the formula
    and its derivative are finite.
    Returns: an expression.
    """
    # A sum: of a bare piece sympy takes a power into the branches, and the formula would meet x after all.
    inside = x + Piecewise((harmless - x, where), (S.Zero, True))
    return Piecewise((limit, where), (formula(inside), True))
