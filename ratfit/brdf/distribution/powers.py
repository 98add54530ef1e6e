"""Powers of the cosine: Phong's and Blinn's."""

from sympy import Expr, Min, Piecewise, S, pi
from sympy.core.relational import Relational

from ratfit.brdf._arguments import FROM_ZERO, UNIT, takes
from ratfit.brdf.distribution._lobe import SMOOTH, dirac, lobe_above, rough_enough

MIRROR = 10**35  # an exponent: with it t**n is 0 for every double below 1, and float32 can still hold n


@takes(n=FROM_ZERO)
def phong(t: Expr, n: Expr) -> Expr:
    """Phong's power of the cosine, (n + 2) t^n/(2 pi).

    n in [0, oo], the shininess: 1/pi at n = 0, a Dirac at n = oo. 0 at t = 0 for n > 0.
    Source: microfacet.
    """
    finite = Min(n, MIRROR)
    return _power(t, finite, (finite + 2) / (2 * pi), n >= MIRROR, n <= 0)


@takes(rho=UNIT)
def blinn(t: Expr, rho: Expr) -> Expr:
    """Blinn's power of the cosine with a roughness, t^(2/rho^2 - 2)/(pi rho^2): `phong` with n = 2/rho^2 - 2.

    rho in [0, 1], with the peak of `beckmann` for alpha = rho; 1/pi at rho = 1, a Dirac at rho = 0.
    Source: polimi2024.
    """
    rough = rough_enough(rho)
    exponent = 2 * (1 - rough) * (1 + rough) / rough**2
    return _power(t, exponent, 1 / (pi * rough**2), rho < SMOOTH, rho >= 1)


def _power(t: Expr, n: Expr, peak: Expr, smooth: Relational, flat: Relational) -> Expr:
    """peak t**n; at t = 0 the limit, in place of a gradient's logarithm of 0. flat: where n is 0."""
    inside = t - Piecewise((t - 1, t <= 0), (t - 1, t > 1), (S.Zero, True))
    foot = Piecewise((peak, flat), (S.Zero, True))
    return lobe_above(t, smooth, dirac(t), Piecewise((foot, t <= 0), (peak * inside**n, True)))
