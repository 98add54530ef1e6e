"""Fractions: GGX with one roughness and with two, Smoothie's, and the one for Beckmann's distribution."""

from sympy import Expr, Max, Min, Piecewise, S, log, pi

from ratfit.brdf._arguments import FROM_ZERO, UNIT, takes
from ratfit.brdf._limits import instead
from ratfit.brdf.distribution._lobe import (
    SMOOTH,
    complement,
    dirac,
    dirac_on_a_line,
    lobe_above,
    rough_enough,
    sine_squared_of,
    spread,
)


@takes(alpha=FROM_ZERO)
def ggx(t: Expr, alpha: Expr, sine_squared: Expr | None = None) -> Expr:
    """GGX or Trowbridge-Reitz, alpha^2/(pi (t^2 (alpha^2 - 1) + 1)^2).

    alpha >= 0: the constant 1/pi at alpha = 1, a Dirac at 0. alpha^2/pi at t = 0, 1/(pi alpha^2) at t = 1.
    Source: walter2007 Eq. 33; microfacet; polimi2024 (rho is alpha).
    """
    rough = rough_enough(alpha)
    s2 = sine_squared_of(t, sine_squared)
    return lobe_above(t, alpha < SMOOTH, dirac(t), 1 / (pi * (rough * t**2 + s2 / rough) ** 2))


@takes(alpha_x=FROM_ZERO, alpha_y=FROM_ZERO)
def ggx_anisotropic(t: Expr, w: Expr, alpha_x: Expr, alpha_y: Expr, sine_squared: Expr | None = None) -> Expr:
    """GGX with a roughness along the tangent, alpha_x, and one across, alpha_y.

    1/(pi alpha_x alpha_y (t^2 + (1 - t^2) (w^2/alpha_x^2 + (1 - w^2)/alpha_y^2))^2); `ggx` where the two are equal.
    With one of them 0 it is a Dirac on a line of directions, with both at N.
    Source: heitz2014.
    """
    along, across = rough_enough(alpha_x), rough_enough(alpha_y)
    lobe = 1 / (pi * along * across * (t**2 + sine_squared_of(t, sine_squared) * spread(w, along, across)) ** 2)
    return lobe_above(t, Min(alpha_x, alpha_y) < SMOOTH, dirac_on_a_line(t, w, alpha_x, alpha_y), lobe)


@takes(m=UNIT)
def beckmann_rational(t: Expr, m: Expr) -> Expr:
    """The rational fraction for Beckmann's distribution, with Beckmann's peak and normalisation, 0 below t = 1 - m.

    m in [0, 1] stands for beckmann's alpha. At t = 1 - m it is continuous with a kink, so it is clamped there: the
    fraction goes on to a pole. The constant 1/pi at m = 1; a Dirac at m = 0.
    Source: schlick1994 Eq. 21, m^3 x/(t (m x^2 - x^2 + m^2)^2) with x = t + m - 1 (pi times this).
    """
    rough = rough_enough(m)
    # x = t - (1 - m) = m - (1 - t): what is subtracted is exact in the form chosen, so x is, near the edge too.
    x = Max(0, Piecewise((t - complement(m), m > S.Half), (m - complement(t), True)))
    # The fraction's denominator m^2 - (1 - m) x^2 with 1 - t in place of x loses no digits: all terms are positive.
    base = rough + complement(m) * complement(t) * (1 + x / rough) / rough
    fraction = x / (pi * rough * instead(t, 1, t <= (1 - m) / 2) * base**2)
    constant = Piecewise((1 / pi, t <= 0), (fraction, True))
    return lobe_above(t, m < SMOOTH, dirac(t), Piecewise((constant, m >= 1), (fraction, True)))


@takes(alpha=FROM_ZERO)
def smoothie(t: Expr, alpha: Expr, sine_squared: Expr | None = None) -> Expr:
    """Smoothie's distribution, normalised: (4 + alpha^2)/pi (alpha + 4 (1 - t^2)/alpha)^-2.

    alpha >= 0; it is `ggx` with alpha_g^2 = alpha^2/(4 + alpha^2). A Dirac at alpha = 0.
    Source: smoothie, with the factor that it leaves out.
    """
    share = 4 / pi + alpha**2 / pi  # each over pi: a narrow lobe meets one rounding less
    return lobe_above(t, alpha < SMOOTH, dirac(t), share * _smoothie(t, alpha, sine_squared))


@takes(alpha=FROM_ZERO)
def smoothie_as_printed(t: Expr, alpha: Expr, sine_squared: Expr | None = None) -> Expr:
    """Smoothie's distribution in print, (alpha + 4 sin^2/alpha)^-2; its integral with the cosine is pi/(4 + alpha^2).

    Source: smoothie.
    """
    return lobe_above(t, alpha < SMOOTH, dirac(t), _smoothie(t, alpha, sine_squared))


@takes(alpha=FROM_ZERO)
def smoothie_energy(alpha: Expr) -> Expr:
    """The integral of `smoothie_as_printed` at half the light's angle times the light's cosine, over the light.

    That is, at normal incidence: pi (1 - alpha^2/2 log(1 + 2/alpha^2)), which falls from pi at alpha = 0.
    Source: smoothie, the integral under Normalization, done here.
    """
    square = rough_enough(alpha) ** 2
    return Piecewise((pi, alpha < SMOOTH), (pi * (1 - square * log(1 + 2 / square) / 2), True))


@takes(x=FROM_ZERO)
def smoothie_energy_as_printed(x: Expr) -> Expr:
    """The value in print for `smoothie_energy`, 1/2 + x^2 log x - x^2/2 log(1 + x^2).

    It is the right one only for x = alpha/sqrt(2), and then without the 2 pi of the azimuth. Source: smoothie.
    """
    rough = rough_enough(x)
    energy = S.Half + rough**2 * log(rough) - rough**2 * log(1 + rough**2) / 2
    return Piecewise((S.Half, x < SMOOTH), (energy, True))


def _smoothie(t: Expr, alpha: Expr, sine_squared: Expr | None) -> Expr:
    rough = rough_enough(alpha)
    return (rough + 4 * sine_squared_of(t, sine_squared) / rough) ** -2
