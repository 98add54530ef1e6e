"""Schlick's factors Z of the angle to the normal and A of the azimuth, and their product."""

from sympy import Expr, Piecewise, S, elliptic_k, pi, sqrt

from ratfit.brdf._arguments import UNIT, takes
from ratfit.brdf._limits import instead
from ratfit.brdf.distribution._lobe import (
    SMOOTH,
    dirac,
    dirac_across,
    lobe_above,
    one_less_square,
    rough_enough,
    sine_squared_of,
)


@takes(r=UNIT)
def zenith(t: Expr, r: Expr, sine_squared: Expr | None = None) -> Expr:
    """Schlick's factor of the angle to the normal, Z = r/(1 + r t^2 - t^2)^2: pi times `ggx` with alpha^2 = r.

    r in [0, 1]: the constant 1 at r = 1, a Dirac at r = 0. The integral of 2 t Z over [0, 1] is 1.
    Source: schlick1994 Eq. 28, Z, which keeps Eq. 27.
    """
    rough = instead(r, 1, r < SMOOTH**2)
    below = rough * t**2 + sine_squared_of(t, sine_squared)
    # A piece of its own: sympy would divide by the square, which underflows in float32.
    lobe = Piecewise((S.Zero, t < 0), (rough / below, True)) / below
    return lobe_above(t, r < SMOOTH**2, dirac(t), lobe)


@takes(p=UNIT)
def azimuth(w: Expr, p: Expr) -> Expr:
    """Schlick's factor of the azimuth as its Eq. 27 needs it, A = p/(p^2 - p^2 w^2 + w^2).

    p in [0, 1], the isotropy: the constant 1 at p = 1, a Dirac at w = 0 (across the tangent) at p = 0. Its mean over
    the azimuth is 1: it is the azimuth's share in every elliptical distribution with alpha_x/alpha_y = p.
    Source: schlick1994 Eq. 28, A, without the root that is printed.
    """
    return Piecewise((dirac_across(w), p < SMOOTH), (1 / _ellipse(w, p), True))


@takes(p=UNIT)
def azimuth_as_printed(w: Expr, p: Expr) -> Expr:
    """Schlick's factor of the azimuth in print, the square root of `azimuth`; its mean is below 1 for p < 1.

    Source: schlick1994 Eq. 28, A; the mean that Eq. 27 wants to be 1: `azimuth_as_printed_mean`.
    """
    return Piecewise((dirac_across(w), p < SMOOTH), (1 / sqrt(_ellipse(w, p)), True))


@takes(p=UNIT)
def azimuth_as_printed_mean(p: Expr) -> Expr:
    """The mean of `azimuth_as_printed` over the azimuth, (2/pi) sqrt(p) K(1 - p^2): 1 at p = 1, 0 at p = 0.

    K is the complete elliptic integral with the parameter k^2; sympy has it, arrays have not.
    """
    return 2 * sqrt(p) * elliptic_k(1 - p**2) / pi


@takes(r=UNIT, p=UNIT)
def schlick(t: Expr, w: Expr, r: Expr, p: Expr, sine_squared: Expr | None = None) -> Expr:
    """Schlick's distribution, Z(t) A(w)/pi with the A that keeps Eq. 27: normalised for every r and p.

    As A does not depend on t, the value at N itself (t = 1) depends on the w with which one comes there.
    Source: schlick1994 Eqs. 25 to 28.
    """
    return _schlick(t, w, r, p, azimuth(w, p), sine_squared)


@takes(r=UNIT, p=UNIT)
def schlick_as_printed(t: Expr, w: Expr, r: Expr, p: Expr, sine_squared: Expr | None = None) -> Expr:
    """Schlick's distribution with the A in print, Z(t) A(w)/pi; its integral is `azimuth_as_printed_mean`.

    Source: schlick1994 Eqs. 25 to 28.
    """
    return _schlick(t, w, r, p, azimuth_as_printed(w, p), sine_squared)


def _ellipse(w: Expr, p: Expr) -> Expr:
    isotropy = rough_enough(p)
    return isotropy * one_less_square(w) + w**2 / isotropy


def _schlick(t: Expr, w: Expr, r: Expr, p: Expr, factor: Expr, sine_squared: Expr | None) -> Expr:
    """The product; where a factor is a Dirac, its value alone, as infinity times 0 is no number."""
    inside = Piecewise((dirac_across(w), p < SMOOTH), (zenith(t, r, sine_squared) * factor / pi, True))
    return lobe_above(t, r < SMOOTH**2, dirac(t), inside)
