"""Masking without a roughness: V-shaped grooves, and what the shortcuts for G/(v v') mean."""

from sympy import Expr, Max, Min, Or, Piecewise

from ratfit.brdf._arguments import takes
from ratfit.brdf.masking._cosines import both_above, held, positive


@takes()
def torrance_sparrow(t: Expr, u: Expr, v: Expr, v_prime: Expr) -> Expr:
    """G of facets in V-shaped grooves of equal slopes: min(1, 2 t v/u, 2 t v'/u).

    Arguments: t, v, v_prime in [-1, 1], 0 where one of them is not positive; u in [0, 1].
    Limits: none as u, v, v' go to 0 together; where u is 0 and t, v, v' are not, which no vectors have, it is 1.
    Source: torrance1967, cook1981; schlick1994 Eq. 16, which is 0/0 at u = 0 where t v = 0; polimi2024 ("microfacet"
    G) is the same without the conditions on signs.
    """
    lowest = 2 * positive(t) * Min(positive(v), positive(v_prime))
    hidden = Or(t <= 0, u < 0, t * Min(v, v_prime) <= 0)  # the product too, which may underflow to 0
    return Piecewise((0, hidden), (lowest / Max(u, lowest), True))


@takes()
def torrance_sparrow_as_printed(t: Expr, u: Expr, v: Expr, v_prime: Expr) -> Expr:
    """The same as schlick1994 Eq. 16 and polimi2024 print it: 0/0 at u = 0, and below 0 under the horizon."""
    return Min(1, 2 * t * v / u, 2 * t * v_prime / u)


@takes()
def implicit(v: Expr, v_prime: Expr) -> Expr:
    """G = v v', what it means to set the visibility term G/(v v') to 1: no roughness, and too dark at grazing angles.

    Arguments: v, v_prime in [-1, 1].
    Source: microfacet (visibility, the simple approximation).
    """
    return both_above(v, v_prime, held(v) * held(v_prime))


@takes()
def kelemen(u: Expr, v: Expr, v_prime: Expr) -> Expr:
    """G = v v'/u**2, what it means to set the visibility term to 1/(L.H)**2; also 4 v v'/(h.h) with h = L + V.

    Of unit vectors it is at most 1, as u = (v + v')/(2 t); for cosines of no such vectors, u is held at (v + v')/2.

    Arguments: u in [0, 1], v, v_prime in [-1, 1].
    Limits: none as u, v, v' go to 0 together.
    Source: kelemen2001; smoothie (the geometric term); microfacet (visibility, the better approximation).
    """
    seen, lit = positive(v), positive(v_prime)
    twice = Max(2 * u, seen + lit)
    # The minima with 2 change nothing: they keep sympy from writing v v'/u**2, whose parts underflow.
    ratio, ratio_prime = Min(2, 2 * seen / twice), Min(2, 2 * lit / twice)
    return Piecewise((0, Or(v <= 0, v_prime <= 0, u < 0)), (Min(1, ratio * ratio_prime), True))


@takes()
def kelemen_visibility(u: Expr) -> Expr:
    """G/(v v') of `kelemen`: 1/u**2, infinite at u = 0.

    Source: microfacet (visibility, the better approximation).
    """
    return 1 / u**2
