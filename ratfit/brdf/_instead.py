"""A harmless value in place of one at which a formula has no value, that outlasts sympy's arithmetic."""

from sympy import Expr, Piecewise, S
from sympy.core.relational import Relational


def instead(x: Expr, value: int, where: Relational) -> Expr:
    """x, and `value` where the condition holds and the formula in x is not taken: a gradient computes that branch too.

    A sum: sympy raises the branches of a bare piece to a power one by one, and there is x**-4 at x = 0 again.

    Arguments: x, finite; the value; where, a condition without pieces (arrays cannot select by a piece within one).
    Returns: an expression, exactly x where the condition does not hold.
    """
    return x + Piecewise((value - x, where), (S.Zero, True))
