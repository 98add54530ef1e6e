"""The exact factors of reflectance as their sources print them, in python-flint's balls: what `accuracy.py` trusts.

Nothing of ratfit is used. The formulas cancel where they like: the precision is chosen so that it does not matter, and
`accuracy.py` looks at the radius of every ball. Letters as in `ratfit.brdf`.
"""

from flint import acb, arb

HALF = arb(1) / 2

# Fresnel


def conductor(u: arb, eta: arb, kappa: arb) -> arb:
    """The mean of the squares of Fresnel's two amplitudes, by complex numbers (cook1981)."""
    square = acb(eta, kappa) ** 2
    w = (square - (1 - u * u)).sqrt()
    across, along = (u - w) / (u + w), (square * u - w) / (square * u + w)
    return (size2(across) + size2(along)) / 2


def dielectric(u: arb, eta: arb) -> arb:
    """cook1981, with g real: no total reflection."""
    g = (eta * eta - 1 + u * u).sqrt()
    return ((g - u) / (g + u)) ** 2 * (1 + ((u * (g + u) - 1) / (u * (g - u) + 1)) ** 2) / 2


def normal(eta: arb, kappa: arb) -> arb:
    return ((eta - 1) ** 2 + kappa**2) / ((eta + 1) ** 2 + kappa**2)


def index(f: arb) -> arb:
    """cook1981."""
    return (1 + f.sqrt()) / (1 - f.sqrt())


def spectral(average: arb, average_normal: arb, f: arb) -> arb:
    """schlick1994 Eq. 14."""
    return f + (1 - f) * (average - average_normal) / (1 - average_normal)


def fresnel_schlick(u: arb, f: arb) -> arb:
    """schlick1994 Eq. 15."""
    return f + (1 - f) * (1 - u) ** 5


def lazanyi(u: arb, eta: arb, kappa: arb) -> arb:
    """lazanyi2005."""
    return ((eta - 1) ** 2 + 4 * eta * (1 - u) ** 5 + kappa**2) / ((eta + 1) ** 2 + kappa**2)


def spherical_gaussian(u: arb, f: arb) -> arb:
    return f + (1 - f) * (-6 * u).exp()


def karis(u: arb, f: arb) -> arb:
    """karis2013."""
    return f + (1 - f) * arb(2) ** ((-arb("5.55473") * u - arb("6.98316")) * u)


def fresnel_smoothie(u: arb, f: arb) -> arb:
    """smoothie, with h = L + V and so L.h = 2 u^2."""
    return f + (1 - f) * arb(2) ** (-arb("1.71983") - arb("5.43926") * 2 * u * u)


# Distributions


def beckmann(t: arb, alpha: arb) -> arb:
    """schlick1994 Eq. 20 over pi."""
    return (-tangent2(t) / alpha**2).exp() / (arb.pi() * alpha**2 * t**4)


def ggx(t: arb, alpha: arb) -> arb:
    """walter2007 Eq. 33."""
    return alpha**2 / (arb.pi() * t**4 * (alpha**2 + tangent2(t)) ** 2)


def ggx_anisotropic(t: arb, w: arb, alpha_x: arb, alpha_y: arb) -> arb:
    """heitz2014 Eq. 85."""
    return 1 / (arb.pi() * alpha_x * alpha_y * t**4 * (1 + elliptical(t, w, alpha_x, alpha_y)) ** 2)


def zenith(t: arb, r: arb) -> arb:
    """schlick1994 Eq. 28."""
    return r / (1 + r * t**2 - t**2) ** 2


def azimuth(w: arb, p: arb) -> arb:
    """schlick1994 Eq. 28, without its root."""
    return p / (p**2 - p**2 * w**2 + w**2)


def distribution_schlick(t: arb, w: arb, r: arb, p: arb) -> arb:
    return zenith(t, r) * azimuth(w, p) / arb.pi()


def ward(t: arb, w: arb, m: arb, n: arb) -> arb:
    """ward1992, normalised."""
    return (-elliptical(t, w, m, n)).exp() / (arb.pi() * m * n * t**4)


def phong(t: arb, n: arb) -> arb:
    return (n + 2) / (2 * arb.pi()) * t**n


def blinn(t: arb, rho: arb) -> arb:
    return t ** (2 / rho**2 - 2) / (arb.pi() * rho**2)


def beckmann_rational(t: arb, m: arb) -> arb:
    """schlick1994 Eq. 21 over pi, where it is above 0."""
    x = t + m - 1
    return m**3 * x / (arb.pi() * t * (m * x**2 - x**2 + m**2) ** 2)


def distribution_smoothie(t: arb, alpha: arb) -> arb:
    """smoothie, normalised."""
    return (4 + alpha**2) / arb.pi() / (alpha + 4 * (1 - t**2) / alpha) ** 2


# Masking


def smith(v: arb, m: arb) -> arb:
    """smith1967: Lambda, and the share of the slopes along one axis that face the viewer."""
    alpha = arb(2).sqrt() * m
    return (1 + slope(v, alpha).erf()) / 2 / (1 + beckmann_lambda(v, alpha))


def smith_as_printed(v: arb, m: arb) -> arb:
    """schlick1994 Eq. 18."""
    h = v**2 / (2 * m**2 * (1 - v**2))
    g = (h * arb.pi()).sqrt() * (2 - h.sqrt().erfc())
    return g / (g + 1)


def beckmann_lambda(v: arb, alpha: arb) -> arb:
    """heitz2014 Eq. 66."""
    a = slope(v, alpha)
    return (a.erf() - 1) / 2 + (-a * a).exp() / (2 * a * arb.pi().sqrt())


def masking_beckmann(v: arb, alpha: arb) -> arb:
    return 1 / (1 + beckmann_lambda(v, alpha))


def beckmann_correlated(v: arb, v_prime: arb, alpha: arb) -> arb:
    """heitz2014 Eq. 99."""
    return 1 / (1 + beckmann_lambda(v, alpha) + beckmann_lambda(v_prime, alpha))


def ggx_lambda(v: arb, alpha: arb) -> arb:
    """heitz2014 Eq. 72."""
    return ((1 + 1 / slope(v, alpha) ** 2).sqrt() - 1) / 2


def masking_ggx(v: arb, alpha: arb) -> arb:
    """walter2007 Eq. 34."""
    return 2 / (1 + (1 + alpha**2 * tangent2(v)).sqrt())


def ggx_correlated(v: arb, v_prime: arb, alpha: arb) -> arb:
    """heitz2014 Eq. 99."""
    return 1 / (1 + ggx_lambda(v, alpha) + ggx_lambda(v_prime, alpha))


def masking_beckmann_rational(v: arb, alpha: arb) -> arb:
    """walter2007 Eq. 27, and 1 from where it comes to 1."""
    return held_fraction(slope(v, alpha))


def masking_phong(v: arb, exponent: arb) -> arb:
    return held_fraction((exponent / 2 + 1).sqrt() / tangent2(v).sqrt())


def masking_schlick(v: arb, m: arb) -> arb:
    """schlick1994 Eq. 19."""
    k = (2 * m**2 / arb.pi()).sqrt()
    return v / (v - k * v + k)


def schlick_roughness(v: arb, r: arb) -> arb:
    """schlick1994 Eq. 31."""
    return v / (r - r * v + v)


def torrance_sparrow(t: arb, u: arb, v: arb, v_prime: arb) -> arb:
    """schlick1994 Eq. 16."""
    return arb(1).min(2 * t * v / u).min(2 * t * v_prime / u)


def implicit(v: arb, v_prime: arb) -> arb:
    return v * v_prime


def kelemen(u: arb, v: arb, v_prime: arb) -> arb:
    """kelemen2001, at most 1."""
    return arb(1).min(v * v_prime / u**2)


def kelemen_visibility(u: arb) -> arb:
    return 1 / u**2


# What they share


def size2(z: acb) -> arb:
    return z.real**2 + z.imag**2


def tangent2(cosine: arb) -> arb:
    return (1 - cosine**2) / cosine**2


def elliptical(t: arb, w: arb, m: arb, n: arb) -> arb:
    return tangent2(t) * (w**2 / m**2 + (1 - w**2) / n**2)


def slope(cosine: arb, alpha: arb) -> arb:
    """a = cot/alpha, the variable of Smith's functions."""
    return cosine / (alpha * (1 - cosine**2).sqrt())


def held_fraction(a: arb) -> arb:
    if a >= (1259 - arb(1081).sqrt()) / 792:
        return arb(1)
    return (arb("3.535") * a + arb("2.181") * a**2) / (1 + arb("2.276") * a + arb("2.577") * a**2)
