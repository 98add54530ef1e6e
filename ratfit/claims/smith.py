"""Smith's masking in section 4.3 of schlick1994: Eqs. 17 to 19, and Eq. 31."""

from __future__ import annotations

from typing import Any

import sympy as sp

from ratfit._target import parameter
from ratfit.brdf import masking
from ratfit.claims._agreement import AtMost, Rounded
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._models import V_PRIME, V, made
from ratfit.claims._numbers import largest, midpoints, values
from ratfit.claims.masking import SLOPES, M, OneSided, apart, slope_jump, turned_by
from ratfit.claims.method import derived
from ratfit.gallery import card

SIGMA, Q, TANGENT = sp.symbols("sigma q mu", positive=True)
"""The RMS slope of a surface along one axis, a slope, and the slope of the direction of view."""

GAUSSIAN = sp.exp(-(Q**2) / (2 * SIGMA**2)) / (SIGMA * sp.sqrt(2 * sp.pi))
"""The density of slopes along one axis."""


def seen_by_integration(v: float, sigma: float) -> Any:
    """Smith's function from its definition: the chance that no point of a Gaussian surface hides another (smith1967).

    (1 - Q(mu))/(1 + Lambda) with Q the share of slopes above mu = cot(theta), which face away, and Lambda the integral
    of (q - mu) p(q) over q > mu, over mu; 20 digits.
    """
    import mpmath

    with mpmath.workdps(20):
        density = sp.lambdify(Q, GAUSSIAN.subs(SIGMA, sp.Rational(sigma)), "mpmath")
        mu = mpmath.mpf(v) / mpmath.sqrt(1 - mpmath.mpf(v) ** 2)
        beyond = [mu, mu + sigma, mu + 3 * sigma, mu + 8 * sigma, mu + 20 * sigma]
        steeper = mpmath.quad(density, beyond)
        hidden = mpmath.quad(lambda q: (q - mu) * density(q), beyond) / mu
        return (1 - steeper) / (1 + hidden)


def off_smith(formula: OneSided) -> float:
    """How far a formula in v and m is from Smith's definition at most, at six places."""
    places = [(v, m) for v in (0.25, 0.875) for m in (0.125, 0.25, 0.5)]
    given = formula(V, M)
    return max(abs(float(values(given, {V: v, M: m}) - seen_by_integration(v, m))) for v, m in places)


def off_eq_18(m: float = 0.5) -> float:
    """How far Eq. 18 is from Smith's function at most: both depend on v/(m sqrt(1 - v^2)) alone."""
    difference = masking.smith(V, M) - made(masking.smith_as_printed, V, M)
    return largest(difference, {V: midpoints(), M: m})


def m_of_eq_18() -> sp.Expr:
    """The m that Eq. 18's slope at v = 0, sqrt(pi/2)/m, says a Gaussian surface has: from Smith's integral there."""
    hidden = sp.integrate(Q * GAUSSIAN, (Q, 0, sp.oo)) / TANGENT  # Lambda where mu goes to 0
    slope = sp.limit(sp.S.Half / (1 + hidden) / TANGENT, TANGENT, 0)
    return sp.sqrt(sp.pi / 2) / slope


def m_of_eq_20() -> sp.Expr:
    """The m that Eq. 20's peak, 1/m^2, says the same surface has: pi times the density of level facets."""
    level = GAUSSIAN.subs(Q, 0) ** 2  # slopes along two axes are independent
    return 1 / sp.sqrt(sp.pi * level)


def ratio_of_slopes() -> sp.Expr:
    """The m of Eq. 20 over the m of Eq. 18 for one surface."""
    return sp.simplify(m_of_eq_20() / m_of_eq_18())


def worst_at_grazing() -> float:
    """The greatest size of Eq. 18 at v = 0, at the m of Figure 6."""
    return max(abs(float(values(made(masking.smith_as_printed, V, M), {V: 0.0, M: m}))) for m in SLOPES)


def worst_place(m: float) -> float:
    """The cosine v at which Eq. 19 is farthest from Eq. 18."""
    import numpy as np

    v = midpoints()
    error = values(masking.schlick(V, M) - made(masking.smith_as_printed, V, M), {V: v, M: m})
    return float(v[np.argmax(np.abs(error))])


def slope_at_grazing(formula: sp.Expr) -> float:
    """m times a function's slope at v = 0, at m = 1/4."""
    tiny = 1e-7
    return float(values(formula, {V: tiny, M: 0.25}) / tiny) / 4


def worst_away_from_normal() -> float:
    """The greatest difference of Eqs. 19 and 18 for v up to 0.9, at the m of Figure 6."""
    v = midpoints(0, 0.9)
    return max(largest(masking.schlick(V, M) - made(masking.smith_as_printed, V, M), {V: v, M: m}) for m in SLOPES)


def roughest_of_product(one_sided: OneSided) -> float:
    """The greatest jump of the slope of G(v) G(v') and its greatest change when the view is turned, at m = 1/4."""
    product = masking.separable(one_sided, V, V_PRIME, sp.Rational(1, 4))
    return max(slope_jump(product), turned_by(product, both=False))


def _target() -> Any:
    return card("smith").problem.target


CLAIMS = (
    Claim(
        "S-17-smooth",
        "Section 4.3",
        "Smith's product depends on v and v' alone and is not subject to the restrictions of Eq. 16",
        Rounded(0, 0.02),
        lambda: roughest_of_product(masking.smith_as_printed),
        how="the greatest jump of its slope, and its change when the view is turned, at m = 1/4",
        readings=(
            Reading(
                "with Smith's own function in place of Eq. 18, whose slope jumps where the light passes the normal",
                lambda: roughest_of_product(masking.smith),
            ),
        ),
    ),
    Claim(
        "S-18-smith",
        "Eq. 18",
        "Eq. 18 is Smith's function, written more compactly",
        0,
        off_eq_18,
        instead=Reading(
            "Smith's function is g/(g + exp(-h)), Eq. 18 has 1 in place of the exponential; the two have one value and "
            "slope at v = 0, and the found number is how far they are apart at most, the same for every m",
            lambda: (
                off_smith(masking.smith) < 1e-12
                and off_eq_18(0.05) > 0.999 * off_eq_18(0.5) > 0.998 * off_eq_18(0.05)
                and abs(slope_at_grazing(masking.smith(V, M)) - slope_at_grazing(made(masking.smith_as_printed, V, M)))
                < 1e-6
            ),
        ),
    ),
    Claim(
        "S-18-m",
        "Sections 4.3, 4.4",
        "the m of Eq. 18 and the m of Eq. 20 are the same RMS slope",
        1,
        ratio_of_slopes,
        instead=Reading(
            "m is the slope along one axis in Eq. 18 and the slope in two dimensions in Eq. 20, sqrt(2) times that",
            lambda: bool(ratio_of_slopes() == sp.sqrt(2) and m_of_eq_18() == SIGMA),
        ),
    ),
    Claim(
        "S-4.3-half",
        "Section 4.3",
        "the slope m is almost never above 0.5 for real surfaces",
        AtMost(0.5),
        None,
        open="a statement on surfaces, for which the source gives no measurement",
    ),
    Claim(
        "S-4.3-G0",
        "Section 4.3",
        "first condition: G(0) = 0",
        0,
        worst_at_grazing,
        how="Eq. 18 at the m of Figure 6",
    ),
    Claim(
        "S-4.3-G1",
        "Section 4.3",
        "second condition: G(1) = 1",
        1,
        lambda: _target().limit(sp.S.One, sp.S.One, sp.S.Zero),
        how="the limit of Eq. 18, for any m",
    ),
    Claim(
        "S-4.3-dG0",
        "Section 4.3",
        "third condition: G'(0) = sqrt(pi/(2 m^2))",
        sp.sqrt(sp.pi / 2) / M,
        lambda: _target().derivative(sp.S.Zero, 1),
        how="the limit of Eq. 18's derivative, for any m",
    ),
    Claim(
        "S-19",
        "Eq. 19",
        "the three conditions lead to v/(v - k v + k) with k = sqrt(2 m^2/pi)",
        lambda: card("eq19").published,
        lambda: derived("eq19").chosen,
        how="derived anew from the conditions",
    ),
    Claim(
        "S-19-similar",
        "Section 4.3, Figure 6",
        "but for a small neighbourhood of v = 1, Eq. 19 and Eq. 18 are very similar",
        AtMost(0.05),
        worst_away_from_normal,
        how="greatest difference for v up to 0.9",
        instead=Reading(
            "for small m the greatest difference is near v = 0: for m up to 1/4 it lies below v = 0.25, and at v = 0.9 "
            "and above for m = 1/2 it is less than half as great",
            lambda: (
                all(worst_place(m) < 0.25 for m in SLOPES[:-1])
                and 2 * apart(masking.schlick(V, M), made(masking.smith_as_printed, V, M), M, SLOPES[-1:])
                < worst_away_from_normal()
            ),
        ),
        word="very similar",
    ),
    Claim(
        "S-31",
        "Eq. 31",
        "Eq. 31 is the approximated Smith factor of Eq. 19",
        lambda: masking.schlick(V, M),
        lambda: masking.schlick_roughness(V, parameter("r", 0, 1)),
        readings=(
            Reading(
                "with r in the place of k, so that r = sqrt(2/pi) m",
                lambda: masking.schlick_roughness(V, sp.sqrt(2 / sp.pi) * M),
            ),
        ),
    ),
)
