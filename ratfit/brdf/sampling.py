"""Importance sampling: two uniform numbers become a direction, with its density and the weight of its sample.

a and b are uniform in [0, 1]. A facet's normal H is drawn from D(H) N.H, by the cosine and the sine of its angle to the
surface's normal N (a = 1 gives N itself) and by its azimuth, counted from the tangent; light that comes from V then
leaves along L = 2 (V.H) H - V. The sine has a formula of its own: of a narrow lobe the cosine has lost it.

Letters: t = N.H, u = H.V, v = N.V, v_prime = N.L. An elliptical lobe takes its azimuth first, from p = along/across,
and then the cosine for the alpha at this azimuth (`roughness.alpha_at`); schlick1994's takes its factors one by one.
"""

from sympy import Expr, Min, Piecewise, S, atan2, cos, elliptic_f, elliptic_k, exp, log, pi, sin, sinh, sqrt

from ratfit.brdf._arguments import FROM_ZERO, UNIT, takes
from ratfit.brdf._limits import instead
from ratfit.brdf.distribution import MIRROR, SMOOTH


@takes(a=UNIT, alpha=FROM_ZERO)
def ggx_cosine(a: Expr, alpha: Expr) -> Expr:
    """t = sqrt(a/(alpha^2 (1 - a) + a)), distributed as `ggx` times t; 1 at alpha = 0, 0 at a = 0 else.

    Source: schlick1994 Eq. 29, the zenith angle, which is right: Z with r = alpha^2 is pi times GGX; walter2007 Eq. 35.
    """
    return Piecewise((S.One, alpha < SMOOTH), (sqrt(_squares(a, alpha)[0]), True))


@takes(a=UNIT, alpha=FROM_ZERO)
def ggx_sine(a: Expr, alpha: Expr) -> Expr:
    """The sine to `ggx_cosine`, alpha sqrt((1 - a)/(alpha^2 (1 - a) + a)); 0 at alpha = 0."""
    return Piecewise((S.Zero, alpha < SMOOTH), (sqrt(_squares(a, alpha)[1]), True))


@takes(a=UNIT, alpha=FROM_ZERO)
def beckmann_cosine(a: Expr, alpha: Expr) -> Expr:
    """t = 1/sqrt(1 - alpha^2 log a), distributed as `beckmann` times t; 1 at alpha = 0, 0 at a = 0 else.

    Source: walter2007 Eq. 28.
    """
    inside = instead(a, 1, a <= 0)
    horizon = Piecewise((S.One, alpha <= 0), (S.Zero, True))
    return Piecewise((horizon, a <= 0), (1 / sqrt(1 - alpha**2 * log(inside)), True))


@takes(a=UNIT, alpha=FROM_ZERO)
def beckmann_sine(a: Expr, alpha: Expr) -> Expr:
    """The sine to `beckmann_cosine`, alpha sqrt(-log a/(1 - alpha^2 log a)); 0 at alpha = 0."""
    inside = instead(a, 1, a <= 0)
    horizon = Piecewise((S.Zero, alpha <= 0), (S.One, True))
    return Piecewise((horizon, a <= 0), (alpha * sqrt(-log(inside) / (1 - alpha**2 * log(inside))), True))


@takes(a=UNIT, n=FROM_ZERO)
def phong_cosine(a: Expr, n: Expr) -> Expr:
    """t = a^(1/(n + 2)), distributed as `phong` times t; `blinn` with n = 2/rho^2 - 2. 1 at n = oo, else 0 at a = 0."""
    return Piecewise((_phong_foot(n, S.One), a <= 0), (exp(_phong_log(a, n)), True))


@takes(a=UNIT, n=FROM_ZERO)
def phong_sine(a: Expr, n: Expr) -> Expr:
    """The sine to `phong_cosine`, sqrt(1 - a^(2/(n + 2))) = sqrt(-2 t sinh(log t)), which loses no digits near N."""
    logarithm = _phong_log(a, n)
    return Piecewise((_phong_foot(n, S.Zero), a <= 0), (sqrt(-2 * exp(logarithm) * sinh(logarithm)), True))


@takes(a=UNIT)
def cosine_cosine(a: Expr) -> Expr:
    """N.L = sqrt(a) of a direction drawn by its cosine, as from a diffuse surface: its density is N.L/pi."""
    return sqrt(a)


@takes(a=UNIT)
def cosine_sine(a: Expr) -> Expr:
    """The sine to `cosine_cosine`, sqrt(1 - a)."""
    return sqrt(1 - a)


@takes(b=UNIT)
def uniform_azimuth(b: Expr) -> Expr:
    """phi = 2 pi b, of a lobe that is the same all round."""
    return 2 * pi * b


@takes(b=UNIT, p=UNIT)
def azimuth(b: Expr, p: Expr) -> Expr:
    """phi in [0, pi/2] with tan(phi) = tan(pi b/2)/p, distributed as schlick1994's A in the form that keeps Eq. 27.

    p in [0, 1], the isotropy; at p = 0 it is pi/2, across the tangent. Written with two arguments to the arc tangent,
    as pi/2 rounded to float32 is above pi/2 and its tangent negative.
    Source: schlick1994 Eq. 29, corrected.
    """
    return Piecewise((pi / 2, p < SMOOTH), (_stretched(pi * b / 2, p), True))


@takes(b=UNIT, p=FROM_ZERO)
def full_azimuth(b: Expr, p: Expr) -> Expr:
    """phi in [-pi, pi], the whole circle in place of the quadrant of `azimuth`: tan(phi) = tan(2 pi b)/p.

    p may be above 1 (along/across of any elliptical distribution). At p = 0 it is pi/2 or -pi/2, by halves.
    """
    across = Piecewise((pi / 2, b < S.Half), (-pi / 2, True))
    return Piecewise((across, p < SMOOTH), (_stretched(2 * pi * b, p), True))


@takes(b=UNIT, p=FROM_ZERO)
def azimuth_as_printed(b: Expr, p: Expr) -> Expr:
    """phi = (pi/2) sqrt(p^2 b^2/(1 - b^2 + b^2 p^2)), which draws neither A: `azimuth_as_printed_density`.

    At p = 0 it is 0, along the tangent, where A is 0. Source: schlick1994 Eq. 29.
    """
    rough = instead(p, 1, p < SMOOTH)
    angle = pi * rough * b / (2 * sqrt((1 - b) * (1 + b) + (rough * b) ** 2))
    return Piecewise((S.Zero, p < SMOOTH), (angle, True))


@takes(p=FROM_ZERO)
def azimuth_as_printed_density(phi: Expr, p: Expr) -> Expr:
    """The density of `azimuth_as_printed` in the quadrant: 2/(pi p) along the tangent, 2 p^2/pi across it.

    A has its peak across, 2/(pi p), and 2 p/pi along: the sample is wrong end first. p above 0.
    """
    f = 2 * phi / pi
    return 2 * p**2 / (pi * (p**2 * (1 - f) * (1 + f) + f**2) * sqrt(p**2 * (1 - f) * (1 + f) + f**2))


@takes(p=FROM_ZERO)
def azimuth_distribution(phi: Expr, p: Expr) -> Expr:
    """b, the share of the quadrant's azimuths below phi, for the A that keeps Eq. 27: the inverse of `azimuth`."""
    return 2 * atan2(p * sin(phi), cos(phi)) / pi


@takes(p=FROM_ZERO)
def azimuth_distribution_as_printed(phi: Expr, p: Expr) -> Expr:
    """b for the A in print (schlick1994 Eq. 28), F(phi | k^2)/K(k^2) with k^2 = 1 - p^2.

    Its inverse, what Eq. 29 would have to be, is the Jacobi amplitude am(b K(k^2) | k^2), which is not elementary and
    which sympy does not have; neither elliptic integral goes on arrays.
    """
    return elliptic_f(phi, 1 - p**2) / elliptic_k(1 - p**2)


@takes(distribution=FROM_ZERO)
def half_vector_density(distribution: Expr, t: Expr) -> Expr:
    """The density of H per steradian, D(H) N.H, for a D of `ratfit.brdf.distribution`; 0 below the horizon."""
    return Piecewise((S.Zero, t <= 0), (distribution * t, True))


@takes(distribution=FROM_ZERO)
def light_density(distribution: Expr, t: Expr, u: Expr) -> Expr:
    """The density of L per steradian, D(H) N.H/(4 H.V): the reflection stretches a solid angle 4 H.V times.

    0 where the facet is not seen, u <= 0. Source: walter2007 Eqs. 14 and 24; polimi2024 and microfacet have the 4.
    """
    return Piecewise((S.Zero, u <= 0), (S.Zero, t <= 0), (distribution * t / (4 * instead(u, 1, u <= 0)), True))


@takes()
def cosine_density(v_prime: Expr) -> Expr:
    """The density of L per steradian for `cosine_cosine`, N.L/pi; 0 below the horizon."""
    return Piecewise((S.Zero, v_prime <= 0), (v_prime / pi, True))


@takes(fresnel=FROM_ZERO, masking=FROM_ZERO)
def microfacet_weight(t: Expr, u: Expr, v: Expr, v_prime: Expr, fresnel: Expr, masking: Expr) -> Expr:
    """F G u/(v t), the reflectance D F G/(4 v v') times N.L over `light_density`: D has cancelled.

    0 where V, L or H is at the horizon or below it, and where V and H are not on one side. Source: walter2007 Eq. 41.
    """
    hidden = (v <= 0) | (v_prime <= 0) | (t <= 0) | (u <= 0)
    return Piecewise((S.Zero, hidden), (fresnel * masking * u / (instead(v, 1, v <= 0) * instead(t, 1, t <= 0)), True))


@takes(reflectance=FROM_ZERO)
def cosine_weight(reflectance: Expr) -> Expr:
    """pi f, any reflectance f times N.L over `cosine_density`."""
    return pi * reflectance


def _squares(a: Expr, alpha: Expr) -> tuple[Expr, Expr]:
    """Of GGX's cosine and sine."""
    rough = instead(alpha, 1, alpha < SMOOTH)
    whole = rough**2 * (1 - a) + a
    return a / whole, rough**2 * (1 - a) / whole


def _phong_log(a: Expr, n: Expr) -> Expr:
    """log t; 0 at N."""
    return log(instead(a, 1, a <= 0)) / (Min(n, MIRROR) + 2)


def _phong_foot(n: Expr, at_mirror: Expr) -> Expr:
    return Piecewise((at_mirror, n >= MIRROR), (1 - at_mirror, True))


def _stretched(angle: Expr, p: Expr) -> Expr:
    """The azimuth of an ellipse's point from that of the circle's, narrowed to p along the tangent."""
    return atan2(sin(angle), instead(p, 1, p < SMOOTH) * cos(angle))
