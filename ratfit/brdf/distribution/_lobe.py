"""What every distribution is made of: the horizon, the Dirac of a smooth surface, and 1 - x^2 with its digits."""

from sympy import Eq, Expr, Piecewise, Rational, S, oo
from sympy.core.relational import Relational

from ratfit.brdf._limits import instead

SMOOTH = Rational(1, 10**15)  # its square is a normal number in float32


def lobe_above(t: Expr, smooth: Relational, dirac: Expr, lobe: Expr) -> Expr:
    return Piecewise((S.Zero, t < 0), (dirac, smooth), (lobe, True))


def dirac(t: Expr) -> Expr:
    return Piecewise((S.Zero, t < 1), (oo, True))


def dirac_across(w: Expr) -> Expr:
    return Piecewise((oo, Eq(w, 0)), (S.Zero, True))


def dirac_on_a_line(t: Expr, w: Expr, along: Expr, across: Expr) -> Expr:
    """The Dirac of slopes without spread along the tangent, across it, or both: infinite where those slopes are 0."""
    nothing_along = Piecewise((S.Zero, across < SMOOTH), (dirac_across(w), True))
    nothing_across = Piecewise((oo, Eq(w**2, 1)), (S.Zero, True))
    return Piecewise((oo, t >= 1), (nothing_along, along < SMOOTH), (nothing_across, True))


def rough_enough(alpha: Expr) -> Expr:
    return instead(alpha, 1, alpha < SMOOTH)


def complement(t: Expr) -> Expr:
    """1 - t, and 0 where rounding has made t greater than 1.

    A piece of its own, so that sympy leaves m - (1 - t) as it is: 1 - t is exact for t near 1, m + t is not.
    """
    return Piecewise((S.Zero, t > 1), (1 - t, True))


def sine_squared_of(t: Expr, known: Expr | None) -> Expr:
    """1 - t^2, or what is known of it."""
    return one_less_square(t) if known is None else known


def one_less_square(x: Expr) -> Expr:
    """1 - x^2; near 1 by 1 - x, which is exact there, as the square of x would lose what is left."""
    away = complement(x)
    return Piecewise((1 - x**2, x < S.Half), (2 * away - away**2, True))


def spread(w: Expr, along: Expr, across: Expr) -> Expr:
    """What tan^2 is multiplied by in the exponent of an elliptical Gaussian."""
    return w**2 / along**2 + one_less_square(w) / across**2
