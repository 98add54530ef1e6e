"""Masking on a Gaussian surface: as Smith has it, as schlick1994 prints that, and as it is used today."""

from sympy import Expr, Max, Or, Piecewise, erf, erfc, exp, oo, pi, sqrt
from sympy.logic.boolalg import Boolean

from ratfit.brdf._arguments import FROM_ZERO, takes
from ratfit.brdf.masking._cosines import above, both_above, positive, sine, slope_ratio


@takes(m=FROM_ZERO)
def smith(v: Expr, m: Expr) -> Expr:
    """S(v) of Smith: the probability that a facet of a Gaussian surface is seen, whatever way it faces.

    g/(g + exp(-a**2)) with g = a sqrt(pi) (1 + erf a). This is `beckmann` times (1 + erf a)/2, the part of the slopes
    that face the viewer; its slope at v = 0 is sqrt(pi/2)/m.

    Arguments: v in [-1, 1], m the RMS slope along one axis.
    Source: smith1967; schlick1994 Eq. 18 is meant to be this and is not, see `smith_as_printed`.
    """
    a = slope_ratio(v, m * sine(v, 2))
    seen = (1 + erf(a)) / (2 * (1 + _hidden(a)))
    return Piecewise((0, v <= 0), (1, _flat(v, m)), (seen, True))


@takes(m=FROM_ZERO)
def smith_as_printed(v: Expr, m: Expr) -> Expr:
    """Smith's function as schlick1994 Eq. 18 prints it: g/(g + 1), which lacks the exponential in place of the 1.

    It has the value and slope of `smith` at v = 0, but comes to 1 with a vertical tangent at v = 1, where `smith` is
    flat. Eq. 19 was made for this one.

    Arguments: v in [-1, 1], m the RMS slope along one axis.
    """
    spread = m * sine(v, 2)
    weight = sqrt(pi) * positive(v) * (1 + erf(slope_ratio(v, spread)))
    return above(v, weight / (weight + spread))


@takes(alpha=FROM_ZERO)
def beckmann_lambda(v: Expr, alpha: Expr) -> Expr:
    """Lambda of a Gaussian surface: (exp(-a**2)/(a sqrt(pi)) - erfc(a))/2, hidden area over visible area.

    Arguments: v in [-1, 1], alpha the two-dimensional RMS slope.
    Limits: infinite for v <= 0; 0 from v = 1 on. It is a difference: 1 + Lambda keeps its digits (`beckmann` is its
    reciprocal), Lambda itself is off by 9 ulp at most for a < 1/2, 115 for a < 2, 3 350 for a < 5 and 53 000 for
    a < 10, where it is exp(-100) (`python benchmarks/accuracy.py 200000 beckmann_lambda`).
    Source: heitz2014 Eq. 66, smith1967.
    """
    a = slope_ratio(v, alpha * sine(v))
    return Piecewise((oo, v <= 0), (0, _flat(v, alpha)), (_hidden(a), True))


@takes(alpha=FROM_ZERO)
def beckmann(v: Expr, alpha: Expr) -> Expr:
    """G1 of a Gaussian surface, the masking used today: 1/(1 + Lambda) = 2 a sqrt(pi)/(g + exp(-a**2)).

    The part of a facet that is seen, if it faces the viewer; the only one for which the visible facets add up to v.
    Its slope at v = 0 is sqrt(2 pi)/m = 2 sqrt(pi)/alpha, twice that of `smith`.

    Arguments: v in [-1, 1], alpha the two-dimensional RMS slope.
    Source: walter2007 Eq. 26, heitz2014 Eq. 66.
    """
    a = slope_ratio(v, alpha * sine(v))
    return Piecewise((0, v <= 0), (1, _flat(v, alpha)), (1 / (1 + _hidden(a)), True))


@takes(alpha=FROM_ZERO)
def beckmann_correlated(v: Expr, v_prime: Expr, alpha: Expr) -> Expr:
    """G of a Gaussian surface, seen and lit at the same height: 1/(1 + Lambda(v) + Lambda(v')).

    Arguments: v, v_prime in [-1, 1], alpha the two-dimensional RMS slope.
    Source: heitz2014 Eqs. 66 and 99.
    """
    a, b = (slope_ratio(cosine, alpha * sine(cosine)) for cosine in (v, v_prime))
    return both_above(v, v_prime, 1 / (1 + _hidden(a) + _hidden(b)))


def _flat(v: Expr, roughness: Expr) -> Boolean:
    """Where nothing hides: for sympy exactly, for arrays already where a is held."""
    return Or(v >= 1, roughness <= 0)


def _hidden(a: Expr) -> Expr:
    """Never below 0, by rounding either: so no G is above 1."""
    return Max(0, exp(-(a**2)) / (2 * sqrt(pi) * a) - erfc(a) / 2)
