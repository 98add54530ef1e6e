"""How the normals of microfacets are spread: the distributions D of reflectance models.

Letters as in schlick1994: t = N.H, the cosine of the angle between a facet's normal and the surface's, in [-1, 1]; w,
the cosine of its azimuth against the tangent. Below the horizon (t < 0) every distribution is 0, at t = 0 it is the
limit from above, and t above 1 by rounding counts as 1. Values are per steradian: the integral of D(H) N.H over the
hemisphere is 1. The D of schlick1994 is pi times that (its Eq. 5); its factors Z and A are kept as it has them.

A roughness below `SMOOTH` counts as 0, a Dirac: infinite in its direction, 0 in all others; nothing is nan. A Gaussian
whose exponent is beyond `UNDERFLOW` is 0. On arrays in float64 the values are right to 4 units of 2^-52, those with two
roughnesses to 5, and to 3 more for every unit of a Gaussian's exponent, tan^2/alpha^2, or of `blinn`'s logarithm.
Gradients are finite where there is no Dirac (in float32 for roughness from 1e-6 on). What roughness means in each:
`ratfit.brdf.roughness`. For calculus take the `interior` of a formula.

Where lobes are narrow t has no digits of the angle left: a float32 is 1 - 6e-8 next to 1, an angle of 3e-4. Those who
know 1 - t^2 better, from the tangential part of H, give it as `sine_squared`; left out, it is made of t.
"""

from collections.abc import Callable

from sympy import Eq, Expr, Max, Min, Piecewise, Rational, S, elliptic_k, exp, log, oo, pi, sqrt
from sympy.core.relational import Relational

from ratfit.brdf._limits import instead

SMOOTH = Rational(1, 10**15)  # its square is a normal number in float32
UNDERFLOW = 700  # exp(-700) is the last power of ten or so that float64 has in full
MIRROR = 10**35  # an exponent: with it t**n is 0 for every double below 1, and float32 can still hold n


def beckmann(t: Expr, alpha: Expr, sine_squared: Expr | None = None) -> Expr:
    """Beckmann's distribution, of slopes that are Gaussian: exp(-tan^2/alpha^2)/(pi alpha^2 t^4).

    alpha >= 0 is the root mean square of the slope in two dimensions, sqrt(2) times that along one axis. Vanishes with
    all its derivatives at t = 0; 1/(pi alpha^2) at t = 1; a Dirac at alpha = 0.
    Source: schlick1994 Eq. 20 (m is alpha, D is pi times this); microfacet and polimi2024 (rho is alpha: the root
    mean square slope, not the average slope that is said there).
    """
    s2 = _sine_squared(t, sine_squared)
    lobe = _gaussian(
        t, s2, _beyond(t, s2, 1, alpha**2), 1 / _rough(alpha) ** 2, lambda t: pi * _rough(alpha) ** 2 * t**4
    )
    return _lobe(t, alpha < SMOOTH, _dirac(t), lobe)


def beckmann_rational(t: Expr, m: Expr) -> Expr:
    """The rational fraction for Beckmann's distribution, with Beckmann's peak and normalisation, 0 below t = 1 - m.

    m in [0, 1] stands for beckmann's alpha. At t = 1 - m it is continuous with a kink, so it is clamped there: the
    fraction goes on to a pole. The constant 1/pi at m = 1; a Dirac at m = 0.
    Source: schlick1994 Eq. 21, m^3 x/(t (m x^2 - x^2 + m^2)^2) with x = t + m - 1 (pi times this).
    """
    rough = _rough(m)
    # x = t - (1 - m) = m - (1 - t): what is subtracted is exact in the form chosen, so x is, near the edge too.
    x = Max(0, Piecewise((t - _complement(m), m > S.Half), (m - _complement(t), True)))
    # The fraction's denominator m^2 - (1 - m) x^2 with 1 - t in place of x loses no digits: all terms are positive.
    base = rough + _complement(m) * _complement(t) * (1 + x / rough) / rough
    fraction = x / (pi * rough * instead(t, 1, t <= (1 - m) / 2) * base**2)
    constant = Piecewise((1 / pi, t <= 0), (fraction, True))
    return _lobe(t, m < SMOOTH, _dirac(t), Piecewise((constant, m >= 1), (fraction, True)))


def ggx(t: Expr, alpha: Expr, sine_squared: Expr | None = None) -> Expr:
    """GGX or Trowbridge-Reitz, alpha^2/(pi (t^2 (alpha^2 - 1) + 1)^2).

    alpha >= 0: the constant 1/pi at alpha = 1, a Dirac at 0. alpha^2/pi at t = 0, 1/(pi alpha^2) at t = 1.
    Source: walter2007 Eq. 33; microfacet; polimi2024 (rho is alpha).
    """
    rough = _rough(alpha)
    s2 = _sine_squared(t, sine_squared)
    return _lobe(t, alpha < SMOOTH, _dirac(t), 1 / (pi * (rough * t**2 + s2 / rough) ** 2))


def ggx_anisotropic(t: Expr, w: Expr, alpha_x: Expr, alpha_y: Expr, sine_squared: Expr | None = None) -> Expr:
    """GGX with a roughness along the tangent, alpha_x, and one across, alpha_y.

    1/(pi alpha_x alpha_y (t^2 + (1 - t^2) (w^2/alpha_x^2 + (1 - w^2)/alpha_y^2))^2); `ggx` where the two are equal.
    With one of them 0 it is a Dirac on a line of directions, with both at N.
    Source: heitz2014.
    """
    along, across = _rough(alpha_x), _rough(alpha_y)
    lobe = 1 / (pi * along * across * (t**2 + _sine_squared(t, sine_squared) * _spread(w, along, across)) ** 2)
    return _lobe(t, Min(alpha_x, alpha_y) < SMOOTH, _line(t, w, alpha_x, alpha_y), lobe)


def phong(t: Expr, n: Expr) -> Expr:
    """Phong's power of the cosine, (n + 2) t^n/(2 pi).

    n in [0, oo], the shininess: 1/pi at n = 0, a Dirac at n = oo. 0 at t = 0 for n > 0.
    Source: microfacet.
    """
    finite = Min(n, MIRROR)
    return _power(t, finite, (finite + 2) / (2 * pi), n >= MIRROR, n <= 0)


def blinn(t: Expr, rho: Expr) -> Expr:
    """Blinn's power of the cosine with a roughness, t^(2/rho^2 - 2)/(pi rho^2): `phong` with n = 2/rho^2 - 2.

    rho in [0, 1], with the peak of `beckmann` for alpha = rho; 1/pi at rho = 1, a Dirac at rho = 0.
    Source: polimi2024.
    """
    rough = _rough(rho)
    exponent = 2 * (1 - rough) * (1 + rough) / rough**2
    return _power(t, exponent, 1 / (pi * rough**2), rho < SMOOTH, rho >= 1)


def ward(t: Expr, w: Expr, m: Expr, n: Expr, sine_squared: Expr | None = None) -> Expr:
    """Ward's elliptical Gaussian, normalised: Beckmann's distribution with two roughnesses.

    exp(-tan^2 (w^2/m^2 + (1 - w^2)/n^2))/(pi m n t^4), m along the tangent and n across, each as `beckmann`'s alpha.
    With one of them 0 it is a Dirac on a line of directions, with both at N.
    Source: schlick1994 Eq. 10 and ward1992, with the 1/t^4 that Eq. 7 asks for (times 1/pi).
    """
    return _ward(t, w, m, n, sine_squared, lambda along, across, t: pi * along * across * t**4)


def ward_as_printed(t: Expr, w: Expr, m: Expr, n: Expr, sine_squared: Expr | None = None) -> Expr:
    """Ward's D in print, exp(-tan^2 (w^2/m^2 + (1 - w^2)/n^2))/(m n); without the 1/t^4 its Eq. 7 is below 1.

    Source: schlick1994 Eq. 10, in its own normalisation; the first two forms of polimi2024 are this over
    4 pi sqrt(v v').
    """
    return _ward(t, w, m, n, sine_squared, lambda along, across, t: along * across)


def ward_third_form_as_printed(t: Expr, w: Expr, m: Expr, n: Expr, sine_squared: Expr | None = None) -> Expr:
    """Ward's D in the third form of polimi2024: the exponent has lost its minus sign, so it grows to infinity.

    Source: polimi2024; the normalisation is that of `ward_as_printed`.
    """
    s2 = _sine_squared(t, sine_squared)
    along, across, endless = _rough(m), _rough(n), _ward_beyond(t, w, s2, m, n)
    exponent = s2 * _spread(w, along, across) / instead(t, 1, endless) ** 2
    lobe = Piecewise((oo, endless), (exp(exponent) / (along * across), True))
    return _lobe(t, Min(m, n) < SMOOTH, oo, lobe)


def zenith(t: Expr, r: Expr, sine_squared: Expr | None = None) -> Expr:
    """Schlick's factor of the angle to the normal, Z = r/(1 + r t^2 - t^2)^2: pi times `ggx` with alpha^2 = r.

    r in [0, 1]: the constant 1 at r = 1, a Dirac at r = 0. The integral of 2 t Z over [0, 1] is 1.
    Source: schlick1994 Eq. 28, Z, which keeps Eq. 27.
    """
    rough = instead(r, 1, r < SMOOTH**2)
    lobe = 1 / (rough * (t**2 + _sine_squared(t, sine_squared) / rough) ** 2)
    return _lobe(t, r < SMOOTH**2, _dirac(t), lobe)


def azimuth(w: Expr, p: Expr) -> Expr:
    """Schlick's factor of the azimuth as its Eq. 27 needs it, A = p/(p^2 - p^2 w^2 + w^2).

    p in [0, 1], the isotropy: the constant 1 at p = 1, a Dirac at w = 0 (across the tangent) at p = 0. Its mean over
    the azimuth is 1: it is the azimuth's share in every elliptical distribution with alpha_x/alpha_y = p.
    Source: schlick1994 Eq. 28, A, without the root that is printed.
    """
    return Piecewise((_across(w), p < SMOOTH), (1 / _ellipse(w, p), True))


def azimuth_as_printed(w: Expr, p: Expr) -> Expr:
    """Schlick's factor of the azimuth in print, the square root of `azimuth`; its mean is below 1 for p < 1.

    Source: schlick1994 Eq. 28, A; the mean that Eq. 27 wants to be 1: `azimuth_as_printed_mean`.
    """
    return Piecewise((_across(w), p < SMOOTH), (1 / sqrt(_ellipse(w, p)), True))


def azimuth_as_printed_mean(p: Expr) -> Expr:
    """The mean of `azimuth_as_printed` over the azimuth, (2/pi) sqrt(p) K(1 - p^2): 1 at p = 1, 0 at p = 0.

    K is the complete elliptic integral with the parameter k^2; sympy has it, arrays have not.
    """
    return 2 * sqrt(p) * elliptic_k(1 - p**2) / pi


def schlick(t: Expr, w: Expr, r: Expr, p: Expr, sine_squared: Expr | None = None) -> Expr:
    """Schlick's distribution, Z(t) A(w)/pi with the A that keeps Eq. 27: normalised for every r and p.

    As A does not depend on t, the value at N itself (t = 1) depends on the w with which one comes there.
    Source: schlick1994 Eqs. 25 to 28.
    """
    return _schlick(t, w, r, p, azimuth(w, p), sine_squared)


def schlick_as_printed(t: Expr, w: Expr, r: Expr, p: Expr, sine_squared: Expr | None = None) -> Expr:
    """Schlick's distribution with the A in print, Z(t) A(w)/pi; its integral is `azimuth_as_printed_mean`.

    Source: schlick1994 Eqs. 25 to 28.
    """
    return _schlick(t, w, r, p, azimuth_as_printed(w, p), sine_squared)


def smoothie(t: Expr, alpha: Expr, sine_squared: Expr | None = None) -> Expr:
    """Smoothie's distribution, normalised: (4 + alpha^2)/pi (alpha + 4 (1 - t^2)/alpha)^-2.

    alpha >= 0; it is `ggx` with alpha_g^2 = alpha^2/(4 + alpha^2). A Dirac at alpha = 0.
    Source: smoothie, with the factor that it leaves out.
    """
    return _lobe(t, alpha < SMOOTH, _dirac(t), (4 + alpha**2) / pi * _smoothie(t, alpha, sine_squared))


def smoothie_as_printed(t: Expr, alpha: Expr, sine_squared: Expr | None = None) -> Expr:
    """Smoothie's distribution in print, (alpha + 4 sin^2/alpha)^-2; its integral with the cosine is pi/(4 + alpha^2).

    Source: smoothie.
    """
    return _lobe(t, alpha < SMOOTH, _dirac(t), _smoothie(t, alpha, sine_squared))


def smoothie_energy(alpha: Expr) -> Expr:
    """The integral of `smoothie_as_printed` at half the light's angle times the light's cosine, over the light.

    That is, at normal incidence: pi (1 - alpha^2/2 log(1 + 2/alpha^2)), which falls from pi at alpha = 0.
    Source: smoothie, the integral under Normalization, done here.
    """
    square = _rough(alpha) ** 2
    return Piecewise((pi, alpha < SMOOTH), (pi * (1 - square * log(1 + 2 / square) / 2), True))


def smoothie_energy_as_printed(x: Expr) -> Expr:
    """The value in print for `smoothie_energy`, 1/2 + x^2 log x - x^2/2 log(1 + x^2).

    It is the right one only for x = alpha/sqrt(2), and then without the 2 pi of the azimuth. Source: smoothie.
    """
    rough = _rough(x)
    energy = S.Half + rough**2 * log(rough) - rough**2 * log(1 + rough**2) / 2
    return Piecewise((S.Half, x < SMOOTH), (energy, True))


def _complement(t: Expr) -> Expr:
    """1 - t, and 0 where rounding has made t greater than 1.

    A piece of its own, so that sympy leaves m - (1 - t) as it is: 1 - t is exact for t near 1, m + t is not.
    """
    return Piecewise((S.Zero, t > 1), (1 - t, True))


def _sine_squared(t: Expr, known: Expr | None) -> Expr:
    """1 - t^2, or what is known of it."""
    return _one_less_square(t) if known is None else known


def _one_less_square(x: Expr) -> Expr:
    """1 - x^2; near 1 by 1 - x, which is exact there, as the square of x would lose what is left."""
    away = _complement(x)
    return Piecewise((1 - x**2, x < S.Half), (2 * away - away**2, True))


def _rough(alpha: Expr) -> Expr:
    return instead(alpha, 1, alpha < SMOOTH)


def _lobe(t: Expr, smooth: Relational, dirac: Expr, lobe: Expr) -> Expr:
    return Piecewise((S.Zero, t < 0), (dirac, smooth), (lobe, True))


def _dirac(t: Expr) -> Expr:
    return Piecewise((S.Zero, t < 1), (oo, True))


def _ellipse(w: Expr, p: Expr) -> Expr:
    isotropy = _rough(p)
    return isotropy * _one_less_square(w) + w**2 / isotropy


def _across(w: Expr) -> Expr:
    return Piecewise((oo, Eq(w, 0)), (S.Zero, True))


def _line(t: Expr, w: Expr, along: Expr, across: Expr) -> Expr:
    """The Dirac of slopes without spread along the tangent, across it, or both: infinite where those slopes are 0."""
    nothing_along = Piecewise((S.Zero, across < SMOOTH), (_across(w), True))
    nothing_across = Piecewise((oo, Eq(w**2, 1)), (S.Zero, True))
    return Piecewise((oo, t >= 1), (nothing_along, along < SMOOTH), (nothing_across, True))


def _spread(w: Expr, along: Expr, across: Expr) -> Expr:
    """What tan^2 is multiplied by in the exponent of an elliptical Gaussian."""
    return w**2 / along**2 + _one_less_square(w) / across**2


def _beyond(t: Expr, s2: Expr, spread: Expr | int, scale: Expr) -> Relational:
    """Whether tan^2 spread/scale is beyond `UNDERFLOW`, for any t and scale: without a division."""
    return s2 * spread >= UNDERFLOW * t**2 * scale


def _ward_beyond(t: Expr, w: Expr, s2: Expr, m: Expr, n: Expr) -> Relational:
    return _beyond(t, s2, (w * n) ** 2 + (1 - w) * (1 + w) * m**2, (m * n) ** 2)


def _gaussian(t: Expr, s2: Expr, nothing: Relational, spread: Expr, below: Callable[[Expr], Expr]) -> Expr:
    """exp(-tan^2 spread)/below; where the exponential is nothing, below may be 0 too."""
    inside = instead(t, 1, nothing)
    gaussian = exp(-s2 * spread / inside**2) / below(inside)
    return Piecewise((S.Zero, nothing), (gaussian, True))


def _ward(
    t: Expr, w: Expr, m: Expr, n: Expr, sine_squared: Expr | None, below: Callable[[Expr, Expr, Expr], Expr]
) -> Expr:
    along, across, s2 = _rough(m), _rough(n), _sine_squared(t, sine_squared)
    nothing = _ward_beyond(t, w, s2, m, n)
    lobe = _gaussian(t, s2, nothing, _spread(w, along, across), lambda t: below(along, across, t))
    return _lobe(t, Min(m, n) < SMOOTH, _line(t, w, m, n), lobe)


def _power(t: Expr, n: Expr, peak: Expr, smooth: Relational, flat: Relational) -> Expr:
    """peak t**n; at t = 0 the limit, in place of a gradient's logarithm of 0. flat: where n is 0."""
    inside = t - Piecewise((t - 1, t <= 0), (t - 1, t > 1), (S.Zero, True))
    foot = Piecewise((peak, flat), (S.Zero, True))
    return _lobe(t, smooth, _dirac(t), Piecewise((foot, t <= 0), (peak * inside**n, True)))


def _schlick(t: Expr, w: Expr, r: Expr, p: Expr, factor: Expr, sine_squared: Expr | None) -> Expr:
    """The product; where a factor is a Dirac, its value alone, as infinity times 0 is no number."""
    inside = Piecewise((_across(w), p < SMOOTH), (zenith(t, r, sine_squared) * factor / pi, True))
    return _lobe(t, r < SMOOTH**2, _dirac(t), inside)


def _smoothie(t: Expr, alpha: Expr, sine_squared: Expr | None) -> Expr:
    rough = _rough(alpha)
    return (rough + 4 * _sine_squared(t, sine_squared) / rough) ** -2
