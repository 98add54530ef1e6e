"""Masking and shadowing: the part of a facet that is seen, and the part that is seen and lit.

v = N.V and v' = N.L are the cosines of the two directions, t = N.H, u = H.V. Roughness is either m, the RMS slope along
one axis, or alpha = sqrt(2) m, the RMS slope over both axes (Beckmann's letter; GGX has an alpha of its own). The
variable of every Smith function is a = cot(theta)/alpha = v/(alpha sqrt(1 - v**2)).

What holds for every function of v here, those `_as_printed` of `torrance_sparrow` and `ggx` left out: it is 0 for
v <= 0; from v = 1 on, which rounding may bring about, and for a roughness of 0 it is 1; it is never nan for a roughness
from 0 on whose square is finite. Gradients are finite where the squares of v and of v/roughness do not underflow.
float64 is within 4 ulp where v is in [0.02, 0.98] and within 5 in all of (0, 1); Lambda of GGX within 6, of a Gaussian
surface see there. No exponential magnifies an error here: where it is small it is added to something that is not.
"""

from collections.abc import Callable

from sympy import Expr, Integer, Max, Min, Or, Piecewise, Rational, S, erf, erfc, exp, oo, pi, sqrt
from sympy.logic.boolalg import Boolean

from ratfit.brdf._limits import instead

_FAR = Integer(30)
"""a is held below this: from here on 1 - G and erfc(a) are less than exp(-900), which no double tells from 0."""

WALTER_END, WALTER_END_AS_PRINTED = (1259 - sqrt(1081)) / 792, Rational(8, 5)
"""Where `beckmann_rational` comes to 1, and where its source puts it there."""


def torrance_sparrow(t: Expr, u: Expr, v: Expr, v_prime: Expr) -> Expr:
    """G of facets in V-shaped grooves of equal slopes: min(1, 2 t v/u, 2 t v'/u).

    Arguments: t, v, v_prime in [-1, 1], 0 where one of them is not positive; u in [0, 1].
    Limits: none as u, v, v' go to 0 together; where u is 0 and t, v, v' are not, which no vectors have, it is 1.
    Source: torrance1967, cook1981; schlick1994 Eq. 16, which is 0/0 at u = 0 where t v = 0; polimi2024 ("microfacet"
    G) is the same without the conditions on signs.
    """
    lowest = 2 * _positive(t) * Min(_positive(v), _positive(v_prime))
    hidden = Or(t <= 0, u < 0, t * Min(v, v_prime) <= 0)  # the product too, which may underflow to 0
    return Piecewise((0, hidden), (lowest / Max(u, lowest), True))


def torrance_sparrow_as_printed(t: Expr, u: Expr, v: Expr, v_prime: Expr) -> Expr:
    """The same as schlick1994 Eq. 16 and polimi2024 print it: 0/0 at u = 0, and below 0 under the horizon."""
    return Min(1, 2 * t * v / u, 2 * t * v_prime / u)


def smith(v: Expr, m: Expr) -> Expr:
    """S(v) of Smith: the probability that a facet of a Gaussian surface is seen, whatever way it faces.

    g/(g + exp(-a**2)) with g = a sqrt(pi) (1 + erf a). This is `beckmann` times (1 + erf a)/2, the part of the slopes
    that face the viewer; its slope at v = 0 is sqrt(pi/2)/m.

    Arguments: v in [-1, 1], m the RMS slope along one axis.
    Source: smith1967; schlick1994 Eq. 18 is meant to be this and is not, see `smith_as_printed`.
    """
    a = _slope_ratio(v, m * _sine(v, 2))
    seen = (1 + erf(a)) / (2 * (1 + _gaussian_lambda(a)))
    return Piecewise((0, v <= 0), (1, _flat(v, m)), (seen, True))


def smith_as_printed(v: Expr, m: Expr) -> Expr:
    """Smith's function as schlick1994 Eq. 18 prints it: g/(g + 1), which lacks the exponential in place of the 1.

    It has the value and slope of `smith` at v = 0, but comes to 1 with a vertical tangent at v = 1, where `smith` is
    flat. Eq. 19 was made for this one.

    Arguments: v in [-1, 1], m the RMS slope along one axis.
    """
    spread = m * _sine(v, 2)
    weight = sqrt(pi) * _positive(v) * (1 + erf(_slope_ratio(v, spread)))
    return _above(v, weight / (weight + spread))


def beckmann_lambda(v: Expr, alpha: Expr) -> Expr:
    """Lambda of a Gaussian surface: (exp(-a**2)/(a sqrt(pi)) - erfc(a))/2, hidden area over visible area.

    Arguments: v in [-1, 1], alpha the two-dimensional RMS slope.
    Limits: infinite for v <= 0; 0 from v = 1 on. It is a difference: 1 + Lambda is right to the last digits,
    Lambda itself to 10 ulp for a < 1/2, some 50 for a < 2, and thousands at a = 10, where it is exp(-100).
    Source: heitz2014 Eq. 66, smith1967.
    """
    a = _slope_ratio(v, alpha * _sine(v))
    return Piecewise((oo, v <= 0), (0, _flat(v, alpha)), (_gaussian_lambda(a), True))


def beckmann(v: Expr, alpha: Expr) -> Expr:
    """G1 of a Gaussian surface, the masking used today: 1/(1 + Lambda) = 2 a sqrt(pi)/(g + exp(-a**2)).

    The part of a facet that is seen, if it faces the viewer; the only one for which the visible facets add up to v.
    Its slope at v = 0 is sqrt(2 pi)/m = 2 sqrt(pi)/alpha, twice that of `smith`.

    Arguments: v in [-1, 1], alpha the two-dimensional RMS slope.
    Source: walter2007 Eq. 26, heitz2014 Eq. 66.
    """
    a = _slope_ratio(v, alpha * _sine(v))
    return Piecewise((0, v <= 0), (1, _flat(v, alpha)), (1 / (1 + _gaussian_lambda(a)), True))


def beckmann_correlated(v: Expr, v_prime: Expr, alpha: Expr) -> Expr:
    """G of a Gaussian surface, seen and lit at the same height: 1/(1 + Lambda(v) + Lambda(v')).

    Arguments: v, v_prime in [-1, 1], alpha the two-dimensional RMS slope.
    Source: heitz2014 Eqs. 66 and 99.
    """
    a, b = (_slope_ratio(cosine, alpha * _sine(cosine)) for cosine in (v, v_prime))
    return _both_above(v, v_prime, 1 / (1 + _gaussian_lambda(a) + _gaussian_lambda(b)))


def beckmann_rational(v: Expr, alpha: Expr) -> Expr:
    """Walter's rational G1 of a Gaussian surface, held at 1 from where it comes to 1: a = (1259 - sqrt(1081))/792.

    (3.535 a + 2.181 a**2)/(1 + 2.276 a + 2.577 a**2), continuous and at most 1; `beckmann_rational_as_printed` is
    neither.

    Arguments: v in [-1, 1], alpha the two-dimensional RMS slope.
    Source: walter2007 Eq. 27, microfacet (Beckmann's G1).
    """
    return _rational(v, alpha * _sine(v), WALTER_END)


def beckmann_rational_as_printed(v: Expr, alpha: Expr) -> Expr:
    """Walter's rational G1 as it is printed, the fraction for all a < 1.6 and 1 from there on.

    It is 1 + 6.13e-5 at its greatest, near a = 1.589, and falls by 2/35121 = 5.69e-5 to 1 at a = 1.6.

    Arguments: v in [-1, 1], alpha the two-dimensional RMS slope.
    Source: walter2007 Eq. 27, microfacet (Beckmann's G1), which lacks the 0 for v <= 0.
    """
    return _rational(v, alpha * _sine(v), WALTER_END_AS_PRINTED)


def phong(v: Expr, exponent: Expr) -> Expr:
    """G1 for Phong's distribution: that of `beckmann_rational` at a = sqrt(exponent/2 + 1)/tan(theta).

    The true G1 of Phong's distribution has no closed form; this one is poor for small exponents.

    Arguments: v in [-1, 1], exponent from 0 on, greater for smoother surfaces.
    Source: microfacet (Phong's G1), walter2007.
    """
    return _rational(v, _sine(v, 2 / (exponent + 2)), WALTER_END)


def phong_as_printed(v: Expr, exponent: Expr) -> Expr:
    """The same with the jump of `beckmann_rational_as_printed`."""
    return _rational(v, _sine(v, 2 / (exponent + 2)), WALTER_END_AS_PRINTED)


def ggx_lambda(v: Expr, alpha: Expr) -> Expr:
    """Lambda of GGX: (sqrt(1 + 1/a**2) - 1)/2, written without the difference.

    Arguments: v in [-1, 1], alpha GGX's roughness.
    Limits: infinite for v <= 0, 0 from v = 1 on.
    Source: heitz2014 Eq. 72.
    """
    p, excess, root = _ggx_parts(v, alpha)
    return Piecewise((oo, v <= 0), (excess / (2 * p * (p + root)), True))


def ggx(v: Expr, alpha: Expr) -> Expr:
    """G1 of GGX: 2/(1 + sqrt(1 + alpha**2 tan(theta)**2)).

    Arguments: v in [-1, 1], alpha GGX's roughness.
    Source: walter2007 Eq. 34; microfacet and polimi2024 print this one function in two ways, see `ggx_as_printed`.
    """
    p, _, root = _ggx_parts(v, alpha)
    return _above(v, 2 * p / (p + root))


def ggx_as_printed(v: Expr, alpha: Expr) -> Expr:
    """The same without the condition on v: as large below the horizon as above, and without a value at v = 0.

    Source: polimi2024 (g_GGX); microfacet's, with tan(theta) = sqrt(1 - v**2)/v put in, is this one.
    """
    return 2 / (1 + sqrt(1 + alpha**2 * (1 - v**2) / v**2))


def ggx_correlated(v: Expr, v_prime: Expr, alpha: Expr) -> Expr:
    """G of GGX, seen and lit at the same height: 1/(1 + Lambda(v) + Lambda(v')).

    Arguments: v, v_prime in [-1, 1], alpha GGX's roughness.
    Source: heitz2014 Eqs. 72 and 99.
    """
    p, _, root = _ggx_parts(v, alpha)
    q, _, root_prime = _ggx_parts(v_prime, alpha)
    return _both_above(v, v_prime, 2 / (root / p + root_prime / q))


def schlick(v: Expr, m: Expr) -> Expr:
    """Schlick's rational G1: v/(v + k (1 - v)) with k = sqrt(2/pi) m.

    Made to have the value and slope at v = 0 and the value at v = 1 of `smith_as_printed` (and so of `smith`); the
    slope of `beckmann` is twice its own.

    Arguments: v in [-1, 1], m the RMS slope along one axis.
    Source: schlick1994 Eq. 19.
    """
    return schlick_roughness(v, sqrt(2 / pi) * m)


def schlick_roughness(v: Expr, r: Expr) -> Expr:
    """G1 of Schlick's own model: v/(v + r (1 - v)).

    Arguments: v in [-1, 1], r the roughness factor in [0, 1].
    Source: schlick1994 Eq. 31.
    """
    held = _held(v)
    return _above(v, held / (held + r * (1 - held)))


def implicit(v: Expr, v_prime: Expr) -> Expr:
    """G = v v', what it means to set the visibility term G/(v v') to 1: no roughness, and too dark at grazing angles.

    Arguments: v, v_prime in [-1, 1].
    Source: microfacet (visibility, the simple approximation).
    """
    return _both_above(v, v_prime, _held(v) * _held(v_prime))


def kelemen(u: Expr, v: Expr, v_prime: Expr) -> Expr:
    """G = v v'/u**2, what it means to set the visibility term to 1/(L.H)**2; also 4 v v'/(h.h) with h = L + V.

    Of unit vectors it is at most 1, as u = (v + v')/(2 t); for cosines of no such vectors, u is held at (v + v')/2.

    Arguments: u in [0, 1], v, v_prime in [-1, 1].
    Limits: none as u, v, v' go to 0 together.
    Source: kelemen2001; smoothie (the geometric term); microfacet (visibility, the better approximation).
    """
    above, above_prime = _positive(v), _positive(v_prime)
    twice = Max(2 * u, above + above_prime)
    # The minima with 2 change nothing: they keep sympy from writing v v'/u**2, whose parts underflow.
    ratio, ratio_prime = Min(2, 2 * above / twice), Min(2, 2 * above_prime / twice)
    return Piecewise((0, Or(v <= 0, v_prime <= 0, u < 0)), (Min(1, ratio * ratio_prime), True))


def kelemen_visibility(u: Expr) -> Expr:
    """G/(v v') of `kelemen`: 1/u**2, infinite at u = 0.

    Source: microfacet (visibility, the better approximation).
    """
    return 1 / u**2


def separable(one_sided: Callable[[Expr, Expr], Expr], v: Expr, v_prime: Expr, roughness: Expr) -> Expr:
    """G = G1(v) G1(v'): seen and lit as if the two had nothing to do with each other.

    Arguments: one_sided, a function of this module with the arguments cosine and roughness; the two cosines; roughness.
    Source: schlick1994 Eq. 17; microfacet ("Smith form"); polimi2024 (GGX).
    """
    return one_sided(v, roughness) * one_sided(v_prime, roughness)


def _above(v: Expr, value: Expr) -> Expr:
    """A value above the horizon, 0 on it and below.

    The value is computed there too, so each function puts a harmless cosine in place of v: nan times 0 is nan.
    """
    return Piecewise((0, v <= 0), (value, True))


def _both_above(v: Expr, v_prime: Expr, value: Expr) -> Expr:
    return Piecewise((0, Or(v <= 0, v_prime <= 0)), (value, True))


def _flat(v: Expr, roughness: Expr) -> Boolean:
    """Where nothing hides: for sympy exactly, for arrays already where a is held."""
    return Or(v >= 1, roughness <= 0)


def _positive(cosine: Expr) -> Expr:
    """The cosine, or a harmless one under the horizon."""
    return instead(cosine, 1, cosine <= 0)


def _held(v: Expr) -> Expr:
    """A cosine in (0, 1]: what rounding has put above 1 is 1, with the function's own slope at 1."""
    return instead(v, 1, Or(v <= 0, v > 1))


def _sine(v: Expr, scale: Expr | int = 1) -> Expr:
    """sqrt(scale) times the sine, 0 from v = 1 on: its slope there is infinite, so the root is not taken of 0.

    The scale is put inside the root, where 2 is exact: sqrt(2) is not.
    """
    oblique = instead(v, S.Half, Or(v <= 0, v >= 1))
    return Piecewise((0, v >= 1), (sqrt(scale * (1 - oblique) * (1 + oblique)), True))


def _slope_ratio(v: Expr, spread: Expr) -> Expr:
    """a = v/spread with spread = alpha sin(theta): cot(theta) over alpha, at most 30."""
    return 1 / Max(spread / _positive(v), 1 / _FAR)


def _gaussian_lambda(a: Expr) -> Expr:
    """Never below 0, by rounding either: so no G is above 1."""
    return Max(0, exp(-(a**2)) / (2 * sqrt(pi) * a) - erfc(a) / 2)


def _ggx_parts(v: Expr, alpha: Expr) -> tuple[Expr, Expr, Expr]:
    """v, alpha**2 (1 - v**2) and sqrt(v**2 + alpha**2 (1 - v**2)), by powers of the greater one of v and alpha.

    So no square underflows that matters: without it GGX at alpha = 0 would be 2 instead of 1 for very small v. The
    minima with 1 change nothing: sympy would write the square of a quotient as a quotient of squares.
    """
    held, smooth = _held(v), Or(v <= 0, alpha <= v)
    p = Min(1, Piecewise((1, smooth), (held / instead(alpha, 1, smooth), True)))
    q = Min(1, Piecewise((alpha / held, smooth), (1, True)))
    excess = q**2 * (1 - held) * (1 + held)
    return p, excess, sqrt(p**2 + excess)


def _rational(v: Expr, spread: Expr, end: Expr) -> Expr:
    """The fraction of walter2007 Eq. 27 for a < end, 1 from there on, over 1000/a: constants that no rounding meets."""
    a = _slope_ratio(v, spread)
    fraction = (3535 + 2181 * a) / (2276 + 2577 * a + 1000 / a)
    return Piecewise((0, v <= 0), (1, Or(v >= 1, end * spread <= v)), (fraction, True))
