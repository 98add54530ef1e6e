"""Roughness: what its many parameters mean, and the laws by which one goes over into another.

alpha   Beckmann's, the root mean square of the slope in two dimensions; also GGX's, Ward's (one along, one across) and
        Blinn's rho, which have no root mean square of their own but the same peak 1/(pi alpha^2)
slope   the root mean square of the slope along one axis, the m of schlick1994 Eq. 18; the m of its Eqs. 20 and 21 is
        alpha, though the text says RMS slope of both
n       Phong's exponent, which falls as roughness grows
r, p    schlick1994's roughness and isotropy
smoothie's alpha, `wide` here

A conversion is an identity where both distributions are then the same function, else it keeps one property, which its
name says. Letters are symbols or numbers, at least 0; a conversion without finite value is infinite, on arrays too.
"""

from sympy import Expr, Integer, S, log, oo, pi, sqrt

from ratfit._parse import RatfitError
from ratfit.brdf._arguments import FROM_ZERO, UNIT, takes


def _over(above: Expr, below: Expr) -> Expr:
    """above/below, infinite where below is 0: Python refuses that, and sympy leaves the sign open."""
    return oo if S(below).is_zero else above / below


@takes(slope=FROM_ZERO)
def alpha_from_slope(slope: Expr) -> Expr:
    """alpha = sqrt(2) slope: the mean squares along two axes add up. An identity, by the definition of the two."""
    return sqrt(2) * slope


@takes(alpha=FROM_ZERO)
def slope_from_alpha(alpha: Expr) -> Expr:
    """slope = alpha/sqrt(2), the inverse of `alpha_from_slope`."""
    return alpha / sqrt(2)


@takes(alpha=FROM_ZERO)
def mean_slope(alpha: Expr) -> Expr:
    """sqrt(pi)/2 alpha, the average slope of Beckmann's facets, which is what polimi2024 says that alpha is."""
    return sqrt(pi) / 2 * alpha


@takes(alpha=FROM_ZERO)
def exponent_by_peak(alpha: Expr) -> Expr:
    """n = 2/alpha^2 - 2: Phong's D(1) is that of Beckmann, GGX and Blinn; with Blinn it is an identity (rho = alpha).

    Negative for alpha > 1, infinite at 0. Source: microfacet, the conversions of D as printed; polimi2024 (Blinn).
    """
    return _over(2 * (1 - alpha) * (1 + alpha), alpha**2)


@takes(n=(Integer(-2), oo))
def alpha_by_peak(n: Expr) -> Expr:
    """alpha = sqrt(2/(n + 2)), the inverse of `exponent_by_peak`; infinite at -2. Source: microfacet, as printed."""
    return sqrt(_over(S(2), n + 2))


@takes(alpha=FROM_ZERO)
def exponent_by_slope(alpha: Expr) -> Expr:
    """n = 2/alpha^2: Phong's mean square slope, 2/n, is Beckmann's. GGX has none: its mean square slope is infinite."""
    return _over(S(2), alpha**2)


@takes(n=FROM_ZERO)
def alpha_by_slope(n: Expr) -> Expr:
    """alpha = sqrt(2/n), the inverse of `exponent_by_slope`; infinite at n = 0."""
    return sqrt(_over(S(2), n))


@takes(alpha=FROM_ZERO)
def ggx_by_median(alpha: Expr) -> Expr:
    """GGX's alpha for Beckmann's, alpha sqrt(log 2): half of the facets (by projected area) are steeper in both.

    To keep the peak both have one alpha.
    """
    return alpha * sqrt(log(2))


@takes(alpha=FROM_ZERO)
def beckmann_by_median(alpha: Expr) -> Expr:
    """Beckmann's alpha for GGX's, alpha/sqrt(log 2), the inverse of `ggx_by_median`."""
    return alpha / sqrt(log(2))


@takes(alpha=FROM_ZERO)
def r_from_ggx(alpha: Expr) -> Expr:
    """r = alpha^2: schlick1994's Z (Eq. 28) is then pi times GGX, an identity; for Beckmann's alpha the same peak."""
    return alpha**2


@takes(r=UNIT)
def ggx_from_r(r: Expr) -> Expr:
    """alpha = sqrt(r), the inverse of `r_from_ggx`."""
    return sqrt(r)


@takes(slope=FROM_ZERO)
def r_by_zenith(slope: Expr) -> Expr:
    """r = 2 slope^2: Z(1) of schlick1994 Eq. 28 is the D(1) of its Eq. 20, 1/alpha^2.

    The other identification, `r_by_masking`, agrees at slope = 1/sqrt(2 pi) alone.
    """
    return 2 * slope**2


@takes(slope=FROM_ZERO)
def r_by_masking(slope: Expr) -> Expr:
    """r = sqrt(2/pi) slope: G of schlick1994 Eq. 31 is then Eq. 19, where r is called k. An identity of the two G."""
    return sqrt(2 / pi) * slope


@takes(r=UNIT)
def slope_by_zenith(r: Expr) -> Expr:
    """slope = sqrt(r/2), the inverse of `r_by_zenith`."""
    return sqrt(r / 2)


@takes(r=UNIT)
def slope_by_masking(r: Expr) -> Expr:
    """slope = sqrt(pi/2) r, the inverse of `r_by_masking`."""
    return sqrt(pi / 2) * r


@takes(along=FROM_ZERO, across=FROM_ZERO)
def isotropy(along: Expr, across: Expr) -> Expr:
    """p = along/across, of roughness or slopes along the tangent and across, the rougher one across: p in [0, 1].

    For the A that keeps Eq. 27 of schlick1994 an identity: every elliptical distribution has this share of azimuths.
    Infinite where across alone is 0; fails with `RatfitError` where both are.
    """
    if S(along).is_zero and S(across).is_zero:
        raise RatfitError("isotropy: along and across are both 0, a mirror: give one above 0, or take p = 1")
    return _over(along, across)


@takes(along=FROM_ZERO, across=FROM_ZERO)
def alpha_at(w: Expr, along: Expr, across: Expr) -> Expr:
    """The roughness of an elliptical distribution at the azimuth with the cosine w: `along` at w = 1, `across` at 0.

    1/sqrt(w^2/along^2 + (1 - w^2)/across^2); at that azimuth the tangents are spread as in the isotropic distribution
    with this alpha. Both above 0.
    """
    return 1 / sqrt(w**2 / along**2 + (1 - w) * (1 + w) / across**2)


@takes(wide=FROM_ZERO)
def ggx_from_wide(wide: Expr) -> Expr:
    """GGX's alpha for smoothie's, wide/sqrt(4 + wide^2), below 1: then `smoothie` is `ggx`, an identity."""
    return wide / sqrt(4 + wide**2)


@takes(alpha=UNIT)
def wide_from_ggx(alpha: Expr) -> Expr:
    """Smoothie's alpha for GGX's, 2 alpha/sqrt(1 - alpha^2), the inverse of `ggx_from_wide`; infinite at alpha = 1."""
    return _over(2 * alpha, sqrt((1 - alpha) * (1 + alpha)))


@takes(roughness=UNIT)
def alpha_from_perceived(roughness: Expr) -> Expr:
    """Smoothie's alpha for a roughness in [0, 1] that looks linear, its square. Source: smoothie."""
    return roughness**2
