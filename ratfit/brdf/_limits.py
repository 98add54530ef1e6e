"""Values that a formula does not have, given so that neither arrays nor their gradients meet 0/0.

An array computes every branch, and a gradient multiplies the branch not taken by zero: nan times zero is nan. So where
a limit is taken, the formula is given a harmless value in place of its variable.
"""

from collections.abc import Callable

from sympy import Expr, Piecewise, S
from sympy.logic.boolalg import Boolean


def instead(x: Expr, harmless: Expr | int, where: Boolean) -> Expr:
    """x, and a harmless value where the condition holds: exactly x where it does not.

    A sum: of a bare piece sympy takes a power into the branches, and the formula would meet x after all. x is finite.
    """
    return x + Piecewise((harmless - x, where), (S.Zero, True))


def guarded(formula: Callable[[Expr], Expr], x: Expr, limit: Expr, where: Boolean, harmless: Expr) -> Expr:
    """formula(x), and limit where the condition holds.

    Arguments: the formula as a function of x; x, a symbol or an expression, finite; its limit; where the limit is
    taken; harmless, any value at which the formula and its derivative are finite.
    Returns: an expression.
    """
    return Piecewise((limit, where), (formula(instead(x, harmless, where)), True))
