"""Slopes that are Gaussian: Beckmann's distribution and Ward's."""

from collections.abc import Callable

from sympy import Expr, Min, Piecewise, S, exp, oo, pi
from sympy.core.relational import Relational

from ratfit.brdf._arguments import FROM_ZERO, takes
from ratfit.brdf._limits import instead
from ratfit.brdf.distribution._lobe import (
    SMOOTH,
    dirac,
    dirac_on_a_line,
    lobe_above,
    rough_enough,
    sine_squared_of,
    spread,
)

UNDERFLOW = 700  # exp(-700) is the last power of ten or so that float64 has in full


@takes(alpha=FROM_ZERO)
def beckmann(t: Expr, alpha: Expr, sine_squared: Expr | None = None) -> Expr:
    """Beckmann's distribution, of slopes that are Gaussian: exp(-tan^2/alpha^2)/(pi alpha^2 t^4).

    alpha >= 0 is the root mean square of the slope in two dimensions, sqrt(2) times that along one axis. Vanishes with
    all its derivatives at t = 0; 1/(pi alpha^2) at t = 1; a Dirac at alpha = 0.
    Source: schlick1994 Eq. 20 (m is alpha, D is pi times this); microfacet and polimi2024 (rho is alpha: the root
    mean square slope, not the average slope that is said there).
    """
    s2 = sine_squared_of(t, sine_squared)
    lobe = _gaussian(
        t, s2, _beyond(t, s2, 1, alpha**2), 1 / rough_enough(alpha) ** 2, lambda t: pi * rough_enough(alpha) ** 2 * t**4
    )
    return lobe_above(t, alpha < SMOOTH, dirac(t), lobe)


@takes(m=FROM_ZERO, n=FROM_ZERO)
def ward(t: Expr, w: Expr, m: Expr, n: Expr, sine_squared: Expr | None = None) -> Expr:
    """Ward's elliptical Gaussian, normalised: Beckmann's distribution with two roughnesses.

    exp(-tan^2 (w^2/m^2 + (1 - w^2)/n^2))/(pi m n t^4), m along the tangent and n across, each as `beckmann`'s alpha.
    With one of them 0 it is a Dirac on a line of directions, with both at N.
    Source: schlick1994 Eq. 10 and ward1992, with the 1/t^4 that Eq. 7 asks for (times 1/pi).
    """
    return _ward(t, w, m, n, sine_squared, lambda along, across, t: pi * along * across * t**4)


@takes(m=FROM_ZERO, n=FROM_ZERO)
def ward_as_printed(t: Expr, w: Expr, m: Expr, n: Expr, sine_squared: Expr | None = None) -> Expr:
    """Ward's D in print, exp(-tan^2 (w^2/m^2 + (1 - w^2)/n^2))/(m n); without the 1/t^4 its Eq. 7 is below 1.

    Source: schlick1994 Eq. 10, in its own normalisation; the first two forms of polimi2024 are this over
    4 pi sqrt(v v').
    """
    return _ward(t, w, m, n, sine_squared, lambda along, across, t: along * across)


@takes(m=FROM_ZERO, n=FROM_ZERO)
def ward_third_form_as_printed(t: Expr, w: Expr, m: Expr, n: Expr, sine_squared: Expr | None = None) -> Expr:
    """Ward's D in the third form of polimi2024: the exponent has lost its minus sign, so it grows to infinity.

    Source: polimi2024; the normalisation is that of `ward_as_printed`.
    """
    s2 = sine_squared_of(t, sine_squared)
    along, across, endless = rough_enough(m), rough_enough(n), _ward_beyond(t, w, s2, m, n)
    exponent = s2 * spread(w, along, across) / instead(t, 1, endless) ** 2
    lobe = Piecewise((oo, endless), (exp(exponent) / (along * across), True))
    return lobe_above(t, Min(m, n) < SMOOTH, oo, lobe)


def _gaussian(t: Expr, s2: Expr, nothing: Relational, spread: Expr, below: Callable[[Expr], Expr]) -> Expr:
    """exp(-tan^2 spread)/below; where the exponential is nothing, below may be 0 too."""
    inside = instead(t, 1, nothing)
    gaussian = exp(-s2 * spread / inside**2) / below(inside)
    return Piecewise((S.Zero, nothing), (gaussian, True))


def _ward(
    t: Expr, w: Expr, m: Expr, n: Expr, sine_squared: Expr | None, below: Callable[[Expr, Expr, Expr], Expr]
) -> Expr:
    along, across, s2 = rough_enough(m), rough_enough(n), sine_squared_of(t, sine_squared)
    nothing = _ward_beyond(t, w, s2, m, n)
    lobe = _gaussian(t, s2, nothing, spread(w, along, across), lambda t: below(along, across, t))
    return lobe_above(t, Min(m, n) < SMOOTH, dirac_on_a_line(t, w, m, n), lobe)


def _beyond(t: Expr, s2: Expr, spread: Expr | int, scale: Expr) -> Relational:
    """Whether tan^2 spread/scale is beyond `UNDERFLOW`, for any t and scale: without a division."""
    return s2 * spread >= UNDERFLOW * t**2 * scale


def _ward_beyond(t: Expr, w: Expr, s2: Expr, m: Expr, n: Expr) -> Relational:
    return _beyond(t, s2, (w * n) ** 2 + (1 - w) * (1 + w) * m**2, (m * n) ** 2)
