"""The formula alone, for calculus."""

from sympy import Expr, Max, Min, Piecewise


def interior(expression: Expr) -> Expr:
    """An exact factor of this room as it reads within its domain: no horizon, no limits, no guards.

    What is right on arrays (pieces for every limit) is in the way of an integral, a derivative or a proof. Each piece
    stands here by its last branch, the formula; an argument held in its range (`Min`, `Max`) by itself.
    """
    bare = expression.replace(Piecewise, lambda *branches: branches[-1][0])
    return bare.replace(lambda part: isinstance(part, Max | Min), lambda part: _variable(part))


def _variable(held: Expr) -> Expr:
    return next((part for part in held.args if part.free_symbols), held)
