"""Walter's rational fraction for the masking on a Gaussian surface, and Phong's, which is that fraction too."""

from sympy import Expr, Or, Piecewise, Rational, sqrt

from ratfit.brdf._arguments import FROM_ZERO, takes
from ratfit.brdf.masking._cosines import sine, slope_ratio

WALTER_END, WALTER_END_AS_PRINTED = (1259 - sqrt(1081)) / 792, Rational(8, 5)
"""Where `beckmann_rational` comes to 1, and where its source puts it there."""


@takes(alpha=FROM_ZERO)
def beckmann_rational(v: Expr, alpha: Expr) -> Expr:
    """Walter's rational G1 of a Gaussian surface, held at 1 from where it comes to 1: a = (1259 - sqrt(1081))/792.

    (3.535 a + 2.181 a**2)/(1 + 2.276 a + 2.577 a**2), continuous and at most 1; `beckmann_rational_as_printed` is
    neither.

    Arguments: v in [-1, 1], alpha the two-dimensional RMS slope.
    Source: walter2007 Eq. 27, microfacet (Beckmann's G1).
    """
    return _rational(v, alpha * sine(v), WALTER_END)


@takes(alpha=FROM_ZERO)
def beckmann_rational_as_printed(v: Expr, alpha: Expr) -> Expr:
    """Walter's rational G1 as it is printed, the fraction for all a < 1.6 and 1 from there on.

    It is 1 + 6.13e-5 at its greatest, near a = 1.589, and falls by 2/35121 = 5.69e-5 to 1 at a = 1.6.

    Arguments: v in [-1, 1], alpha the two-dimensional RMS slope.
    Source: walter2007 Eq. 27, microfacet (Beckmann's G1), which lacks the 0 for v <= 0.
    """
    return _rational(v, alpha * sine(v), WALTER_END_AS_PRINTED)


@takes(exponent=FROM_ZERO)
def phong(v: Expr, exponent: Expr) -> Expr:
    """G1 for Phong's distribution: that of `beckmann_rational` at a = sqrt(exponent/2 + 1)/tan(theta).

    The true G1 of Phong's distribution has no closed form; this one is poor for small exponents.

    Arguments: v in [-1, 1], exponent from 0 on, greater for smoother surfaces.
    Source: microfacet (Phong's G1), walter2007.
    """
    return _rational(v, sine(v, 2 / (exponent + 2)), WALTER_END)


@takes(exponent=FROM_ZERO)
def phong_as_printed(v: Expr, exponent: Expr) -> Expr:
    """The same with the jump of `beckmann_rational_as_printed`."""
    return _rational(v, sine(v, 2 / (exponent + 2)), WALTER_END_AS_PRINTED)


def _rational(v: Expr, spread: Expr, end: Expr) -> Expr:
    """The fraction of walter2007 Eq. 27 for a < end, 1 from there on, over 1000/a: constants that no rounding meets."""
    a = slope_ratio(v, spread)
    fraction = (3535 + 2181 * a) / (2276 + 2577 * a + 1000 / a)
    return Piecewise((0, v <= 0), (1, Or(v >= 1, end * spread <= v)), (fraction, True))
