"""The parts of an exact Fresnel factor, each without a difference that cancels.

n = eta + i kappa is the index, u the cosine, s**2 = 1 - u**2, and w = a + i b the root of n**2 - s**2, q = |w|**2. The
amplitudes of the two polarisations are (u - w)/(u + w) and (n**2 u - w)/(n**2 u + w), F is the mean of their squares.
Over one denominator, with v = w + n u:

    F = R/(R + T)     R = |n - 1|**2 (1 + x)     x = (s**2/(u |w|))**2     T = 4 eta + 2 u x Z
    Z = (1 + |n|**2) a |n - 1|**2/|w + n u|**2 + 2 k ((eta**2 - j) (q + u**2)/(a + eta u) - 2 u j (eta + 1))/|n + 1|**2

with k = kappa**2/(a**2 + kappa**2) and j = 1 - k. By complex numbers Z |n + 1|**2 is shorter and dearer: the real part
of conj(1 + n**2) conj(w) g**2 less 4 u Im(conj(n) g)**2, with g = (n**2 - 1)/(w + n u).

T is also 2 a (q (q + 2) + u**2 (|n|**4 + s**2) + 4 u a (q + s**2))/(u q |n + 1|**2), a sum of positive terms, which has
more roundings; Z may be negative where the light hardly enters (total reflection: T = 0), and there that sum is used.
R and T are both taken times u**2 where u is below 1/2, so that nothing is infinite at u = 0.
"""

from sympy import Expr, Min, Piecewise, S, sqrt

from ratfit.brdf._limits import instead


def excess(eta: Expr) -> Expr:
    """eta**2 - 1, which keeps its digits for an index near 1."""
    return (eta - 1) * (eta + 1)


def slopes(u: Expr, q: Expr) -> tuple[Expr, Expr]:
    """1 and x, both times u**2 below u = 1/2.

    Above it 1 - u is exact, so s**2/u = c + c/u with c = 1 - u has two roundings; below, 1 - u**2 is as good. Pieces
    keep sympy from writing the sum in another order, and x as a part of greater fractions, which underflow.
    """
    low = u < S.Half
    inside = instead(u, 1, low)
    c = Piecewise((0, inside > 1), (1 - inside, True))
    slope = Piecewise(((1 - u**2) ** 2, low), ((c + c / inside) ** 2, True))
    return Piecewise((u**2, low), (1, True)), Piecewise((0, u >= 1), (slope / q, True))


def root(p: Expr, q: Expr, product: Expr) -> tuple[Expr, Expr]:
    """a and b from a**2 - b**2 = p, a**2 + b**2 = q > 0 and a b = product: the greater one by a sum, then the other."""
    steep = p >= 0
    greater = sqrt((q + Piecewise((p, steep), (-p, True))) / 2)
    lesser = product / greater
    return Piecewise((greater, steep), (lesser, True)), Piecewise((lesser, steep), (greater, True))


def oblique(u: Expr, eta: Expr, kappa: Expr, a: Expr, b: Expr, q: Expr) -> Expr:
    """Z, for a > 0; its second part vanishes with kappa. The minimum with 1 changes nothing, see `slopes`."""
    h, size = a + eta * u, (eta - 1) ** 2 + kappa**2
    clear = (1 + eta**2 + kappa**2) * a * size / (h**2 + (b + kappa * u) ** 2)
    share = Min(1, kappa**2 / (a**2 + kappa**2))
    rest = 1 - share
    return clear + 2 * share * ((eta**2 - rest) * (q + u**2) - 2 * u * h * rest * (eta + 1)) / (h * (size + 4 * eta))


def through(u: Expr, eta: Expr, kappa: Expr, a: Expr, q: Expr) -> Expr:
    """T as the sum of positive terms, times u**2 below u = 1/2."""
    low = u < S.Half
    s2 = 1 - u**2
    terms = q * (q + 2) + u**2 * ((eta**2 + kappa**2) ** 2 + s2) + 4 * u * a * (q + s2)
    below = ((eta + 1) ** 2 + kappa**2) * q * instead(u, 1, low)
    return 2 * a * terms * Piecewise((u, low), (1, True)) / below
