"""The Fresnel factor F(u): what part of the light a smooth facet reflects, exactly and by formulas made for speed.

u in [0, 1] is the cosine of the angle between the light and the facet's normal, u = L.H = V.H; light unpolarised.
eta >= 0 is the refraction index and kappa >= 0 the extinction coefficient, both relative to the medium that the light
comes from, which is transparent: eta < 1 where that is the denser one. f in [0, 1] is F(1), `normal(eta, kappa)`.
Every F lies in [0, 1], but for the printed formulas that are kept because they are wrong.

Accuracy in float64, in ulp of F itself, by `python benchmarks/accuracy.py 200000`: how often F is within 4, and the
most that was met, away from the critical angle (|w| of `conductor` above 0.45; nearly no surface: u > 0.01).

    metals, eta in [0.02, 10] and kappa in [1, 20]                 all        2.9
    eta in [1.5, 10] and kappa in [0, 1]                           all        3.4
    eta in [1, 1.5] and kappa in [0, 1]                            99.991 %   4.9
    eta in [0.02, 1] and kappa in [0, 1]                           99.978 %   7.0
    glass, eta in [1.05, 10]: `dielectric` and `conductor`         99.998 %   5.0
    glass from its inside, eta in [0.5, 0.95]: both                99.997 %   4.1
    nearly no surface, eta in [1, 1.05]: `dielectric`              99.89 %    6.8
    the same with kappa in [0, 0.001]                              99.73 %    7.3

What is left above 4 is a dozen roundings that happen to add up. `normal`, `index`, `spectral`, `lazanyi` and `schlick`
are within 4 (3.6 at most, for eta up to 10). An exponential magnifies the error of its argument: at f = 0 and u > 0.75
`spherical_gaussian` is within 4 at 98.7 % and 4.6 at most, `karis` at 73 % and 13.3, `smoothie` at 79 % and 12.1; for
f >= 0.01 all three are within 4.
"""

from __future__ import annotations

from sympy import Expr, Integer, Max, Min, Piecewise, Rational, S, exp, sqrt

from ratfit.brdf._arguments import FROM_ZERO, UNIT, takes
from ratfit.brdf._limits import guarded, instead
from ratfit.brdf._refraction import excess, oblique, root, slopes, through

SCHLICK_N = Integer(5)
"""The published exponent of `schlick`."""

SMOOTHIE_A, SMOOTHIE_B = Rational("-1.71983"), Rational("-5.43926")
"""The published constants of `smoothie`."""

KARIS_A, KARIS_B = Rational("-5.55473"), Rational("-6.98316")
"""The published constants of `karis`: of u**2 and of u."""

TOTAL = Rational(1, 2**110)
"""What the square of a cosine counts as 0 below: the root, 3e-17, is less than any digit that F then has."""


@takes(eta=FROM_ZERO, kappa=FROM_ZERO)
def conductor(u: Expr, eta: Expr, kappa: Expr) -> Expr:
    """The Fresnel factor of a metal, or of anything with a complex index n = eta + i kappa (schlick1994, Eq. 13).

    At u = 0 it is 1. kappa = 0 is the dielectric, total reflection included. Where there is no surface, eta = 1 and
    kappa = 0, it is 0, and 1 at u = 0, where it has no limit. It is not smooth at the critical angle, kappa = 0 and
    u**2 = 1 - eta**2, and loses half of its digits there.

    F is R/(R + T) with R = |n - 1|**2 (1 + (s**2/(u |w|))**2), s**2 = 1 - u**2, w = a + i b the square root of
    n**2 - s**2: what is reflected and what goes through are in the ratio R:T, both without a difference that cancels.
    The source writes the polarisations apart, with 1/u, which is oo/oo at u = 0 (`conductor_as_printed`).
    """
    p = excess(eta) + u**2 - kappa**2  # the real part of w**2, in an order that is exact for an index near 1
    product = eta * kappa  # half of its imaginary part

    def refracted(q2: Expr) -> Expr:
        q = sqrt(q2)  # |w|**2
        a, b = root(p, q, product)
        unit, spread = slopes(u, q)
        # Else the light hardly enters, and a may be 0.
        z = oblique(u, eta, kappa, instead(a, 1, p + 2 * product < 0), b, q)
        enters = 4 * eta * unit + 2 * u * spread * z
        passed = Piecewise((enters, p + 2 * product >= 0), (through(u, eta, kappa, a, q), True))
        reflected = ((eta - 1) ** 2 + kappa**2) * (unit + spread)
        return reflected / (reflected + passed)

    q2 = p**2 + 4 * product**2
    return guarded(refracted, q2, S.One, q2 <= 0, S.One)


@takes(eta=FROM_ZERO, kappa=FROM_ZERO)
def conductor_as_printed(u: Expr, eta: Expr, kappa: Expr) -> Expr:
    """`conductor` as it is printed (schlick1994, Eq. 13), for u > 0: smooth, for calculus; at u = 0 it is oo/oo."""
    p = eta**2 - kappa**2 + u**2 - 1
    q = sqrt(p**2 + 4 * eta**2 * kappa**2)
    a, b2 = sqrt((q + p) / 2), (q - p) / 2
    first = ((a - u) ** 2 + b2) / ((a + u) ** 2 + b2)
    return first * (((a + u - 1 / u) ** 2 + b2) / ((a - u + 1 / u) ** 2 + b2) + 1) / 2


@takes(eta=FROM_ZERO)
def dielectric(u: Expr, eta: Expr) -> Expr:
    """The Fresnel factor of a transparent material: eta = eta_t/eta_i, above 1 or below (microfacet, F term).

    Below 1 the light is reflected totally, F = 1, where u**2 <= 1 - eta**2: the source leaves that out, and its formula
    is `dielectric_as_printed`. At u = 0 it is 1, exactly; where there is no surface, eta = 1, it is 0 elsewhere. At
    the critical angle its slope is infinite and half of its digits are lost.

    With g**2 = eta**2 - 1 + u**2 it is R/(R + T), R = (eta - 1)**2 (1 + (s**2/(u g))**2) as in `conductor` and
    T = 4 eta + 2 (eta - 1)**2 (1 + eta**2) s**4/(u g (g + eta u)**2): nothing cancels in either.
    """

    def refracted(g2: Expr) -> Expr:
        g, size, (unit, spread) = sqrt(g2), (eta - 1) ** 2, slopes(u, g2)
        rest = 2 * (1 + eta**2) * u * g * spread / (g + eta * u) ** 2
        reflected = size * (unit + spread)
        return reflected / (reflected + (4 * eta * unit + size * rest))

    g2 = excess(eta) + u**2
    return guarded(refracted, g2, S.One, g2 <= TOTAL, S.One)


@takes(eta=FROM_ZERO)
def dielectric_as_printed(u: Expr, eta: Expr) -> Expr:
    """`dielectric` as it is printed (microfacet, F term): not real under total reflection; smooth, for calculus."""
    g = sqrt(eta**2 - 1 + u**2)
    return (g - u) ** 2 / (g + u) ** 2 * (1 + (u * (g + u) - 1) ** 2 / (u * (g - u) + 1) ** 2) / 2


@takes(average_normal=UNIT, f=UNIT)
def spectral(average: Expr, average_normal: Expr, f: Expr) -> Expr:
    """F at a wavelength where f alone is known, from F at an average index (cook1981; schlick1994, Eq. 14).

    It is clamped to f: for most metals the average falls below its normal value before it rises to 1, and the formula
    below f. Its limit where the average is 1 for every angle, average_normal = 1, is f.

    Arguments: average, F(u) at the average index; average_normal, F(1) there, in [0, 1]; f, F(1) at the wavelength.
    """

    def scaled(normal: Expr) -> Expr:
        return f + (1 - f) * _from_zero(average - normal) / (1 - normal)

    return guarded(scaled, average_normal, f, average_normal >= 1, S.Zero)


@takes(average_normal=UNIT, f=UNIT)
def spectral_as_printed(average: Expr, average_normal: Expr, f: Expr) -> Expr:
    """`spectral` as it is printed (schlick1994, Eq. 14): without the clamp, and 0/0 at average_normal = 1."""
    return f + (1 - f) * (average - average_normal) / (1 - average_normal)


@takes(f=UNIT, n=FROM_ZERO)
def schlick(u: Expr, f: Expr, n: Expr = SCHLICK_N) -> Expr:
    """The power approximation of F, for u <= 1 (schlick1994, Eq. 15; microfacet, F term).

    It is 1 at u = 0 and f at u = 1. Every n > 2 keeps the published conditions; 5 is the published choice.
    """
    return f + (1 - f) * (1 - u) ** n


@takes(f=UNIT, n=FROM_ZERO)
def schlick_clamped(u: Expr, f: Expr, n: Expr = SCHLICK_N) -> Expr:
    """`schlick` with u held in [0, 1] (polimi2024, Fresnel term): rounding can make a cosine 1 + 2e-16."""
    return schlick(Max(0, Min(1, u)), f, n)


@takes(f=UNIT)
def schlick_as_printed(u: Expr, f: Expr) -> Expr:
    """`schlick` as it is printed in smoothie, Fresnel term: 1 in place of f, so F >= 1, and 2 - f at u = 0."""
    return 1 + (1 - f) * (1 - u) ** 5


@takes(eta=FROM_ZERO, kappa=FROM_ZERO)
def lazanyi(u: Expr, eta: Expr, kappa: Expr) -> Expr:
    """`schlick` with f of a complex index, over one denominator (lazanyi2005, without its correction term)."""
    least = (eta - 1) ** 2 + kappa**2
    return (least + 4 * eta * (1 - u) ** 5) / (least + 4 * eta)


@takes(f=UNIT)
def spherical_gaussian(u: Expr, f: Expr) -> Expr:
    """`schlick` with exp(-6 u) in place of (1 - u)**5 (smoothie, Fresnel term): f + 0.0025 (1 - f) at u = 1."""
    return f + (1 - f) * exp(-6 * u)


@takes(f=UNIT)
def karis(u: Expr, f: Expr) -> Expr:
    """`schlick` with 2**((-5.55473 u - 6.98316) u) in place of (1 - u)**5 (karis2013)."""
    return f + (1 - f) * 2 ** ((KARIS_A * u + KARIS_B) * u)


@takes(f=UNIT)
def smoothie(u: Expr, f: Expr, a: Expr = SMOOTHIE_A, b: Expr = SMOOTHIE_B) -> Expr:
    """From f to 1 by 2**(a + b L.h), with the half vector not normalised, h = L + V (smoothie, Fresnel term).

    L.h = 2 u**2, for h has the length 2 u. At u = 0 it is f + 0.30 (1 - f), not 1: made for the middle of the range.
    """
    return f + (1 - f) * 2 ** (a + 2 * b * u**2)


@takes(eta=FROM_ZERO, kappa=FROM_ZERO)
def normal(eta: Expr, kappa: Expr = S.Zero) -> Expr:
    """F(1), the reflectance at normal incidence; 1/eta has the same as eta where kappa = 0."""
    least = (eta - 1) ** 2 + kappa**2
    return least / (least + 4 * eta)  # 4 eta is exact, |n + 1|**2 takes one rounding more


@takes(f=UNIT)
def index(f: Expr) -> Expr:
    """The index eta >= 1 of the dielectric with the normal reflectance f (cook1981): f in [0, 1), infinite at 1."""
    return (1 + 2 * sqrt(f) + f) / (1 - f)  # 1 - sqrt(f) would cancel


def _from_zero(rise: Expr) -> Expr:
    """The greater of 0 and an expression, which sympy is not asked to compare: that takes it a second."""
    return Max(0, rise, evaluate=not rise.free_symbols)
