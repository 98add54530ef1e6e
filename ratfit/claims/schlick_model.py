"""Section 5 of schlick1994: the new model, its factors Z and A, energy, limits and weights."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy as sp

from ratfit._target import parameter
from ratfit.brdf import distribution, fresnel, masking, roughness
from ratfit.claims._agreement import ZERO, AtLeast, AtMost, same
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import albedo
from ratfit.claims._models import V_PRIME, T, U, V, W
from ratfit.claims._numbers import integral, values
from ratfit.claims.background import asymmetry

R, P, M = parameter("r", "1/100", 1), parameter("p", "1/100", 1), parameter("m", "1/100", "1/2")
PHI = parameter("phi", 0, sp.pi / 2)
C, C_SECOND = parameter("C", 0, 1), parameter("C2", 0, 1)

Z = distribution.zenith(T, R)
A, A_PRINTED = distribution.azimuth(W, P), distribution.azimuth_as_printed(W, P)
"""The factors of Eq. 28: A as Eq. 27 needs it, and as printed."""

MASKED = masking.schlick_roughness(V, R) * masking.schlick_roughness(V_PRIME, R)

EQ_25 = Z * A / (4 * sp.pi * V * V_PRIME)
EQ_30 = (MASKED * Z * A + 1 - MASKED) / (4 * sp.pi * V * V_PRIME)
GRAZING = (0.02, 0.05, 0.2, 0.5, 1.0)


def mean_azimuth(factor: sp.Expr, p: float) -> float:
    """2/pi times the integral of a factor of the azimuth over a quadrant: 1 by Eq. 27."""
    return integral(factor.subs(W, sp.cos(PHI)), PHI, 0.0, float(sp.pi / 2), {P: p}) * 2 / float(sp.pi)


def share_within(factor: sp.Expr, p: float, degrees: float) -> float:
    """The part of the azimuths' total 1 that a factor has within some degrees of the direction across."""
    low = float(sp.pi / 2) * (1 - degrees / 90)
    return integral(factor.subs(W, sp.cos(PHI)), PHI, low, float(sp.pi / 2), {P: p}) * 2 / float(sp.pi)


def zenith_total(r: float, high: float = 1.0) -> float:
    return integral(2 * T * Z, T, 0.0, high, {R: r})


def off_conic(radius: Callable[[Any], Any]) -> float:
    """How far a closed curve in polar coordinates is from every conic: 0 for an ellipse.

    The least singular value of the six monomials of x and y at 24 points, over the greatest.
    """
    import numpy as np

    angle = 2 * np.pi * (np.arange(24) + 0.3) / 24
    x, y = radius(angle) * np.cos(angle), radius(angle) * np.sin(angle)
    x, y = x / np.abs(x).max(), y / np.abs(y).max()
    sizes = np.linalg.svd(np.stack([x * x, x * y, y * y, x, y, np.ones_like(x)], 1), compute_uv=False)
    return float(sizes[-1] / sizes[0])


def zenith_at(angle: Any) -> Any:
    """Z for r = 1/5 at an angle to the normal, mirrored below the horizon."""
    import numpy as np

    return values(Z, {T: np.abs(np.cos(angle)), R: 0.2})


def azimuth_at(angle: Any) -> Any:
    import numpy as np

    return values(A_PRINTED, {W: np.abs(np.cos(angle)), P: 0.2})


def slopes_ratio(factor: sp.Expr, p: float) -> float:
    """The RMS slope along the scratch over that across, of Z A: the factor's mean cos^2 and sin^2."""
    along, across = (mean_azimuth(factor * weight, p) for weight in (W**2, 1 - W**2))
    return (along / across) ** 0.5


def of_ward(w: float, p: float) -> float:
    """The share of an azimuth in Ward's normalised distribution with m/n = p, as A counts it."""
    m, n = sp.Float(p / 2, 17), sp.Rational(1, 2)
    return 2 * float(sp.pi) * integral(T * distribution.ward(T, sp.Float(w, 17), m, n), T, 0.0, 1.0)


def is_share_of_ward(factor: sp.Expr, p: float = 0.2) -> bool:
    """Whether a factor is the share of the azimuths in Ward's distribution."""
    return all(abs(of_ward(w, p) - float(values(factor, {W: w, P: p}))) < 1e-8 for w in (0.1, 0.5, 0.9))


def ward_ratio(p: float) -> float | None:
    """p as the share of Ward's azimuths along the scratches, if A is that share at all azimuths."""
    return of_ward(1.0, p) if is_share_of_ward(A, p) else None


def greatest(reflectance: sp.Expr) -> float:
    """The greatest share reflected over angles of view and r, for p = 1."""
    return max(albedo(reflectance, view, r=r, p=1.0) for view in GRAZING for r in (0.2, 0.5, 1.0))


def reemitted(view: float) -> float:
    """The share that the second term of Eq. 30 adds, times 2 v."""
    return 2 * view * albedo((1 - MASKED) / (4 * sp.pi * V * V_PRIME), view, r=0.5)


def weights(r: sp.Expr) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """a, b and c of Eq. 33."""
    b = 4 * r * (1 - r)
    return (sp.S.Zero, b, 1 - b) if r < sp.S.Half else (1 - b, b, sp.S.Zero)


def variants(directional: int) -> int:
    """How many models two spectral factors and so many directional ones make."""
    return 2 * directional


def reflected_by_two_layers(s: sp.Expr, second: sp.Expr) -> sp.Expr:
    """The weights of the directional factors in Eq. 22, DOUBLE, added up."""
    return s + (1 - s) * second


def greatest_of_two_layers() -> float:
    import numpy as np

    u, c, second = np.meshgrid(*(np.linspace(0, 1, 41),) * 3)
    s, s_second = (fresnel.schlick(U, each) for each in (C, C_SECOND))
    return float(values(reflected_by_two_layers(s, s_second), {U: u, C: c, C_SECOND: second}).max())


def growth(reflectance: sp.Expr) -> float:
    """How many times its value at v = v' = 1 a reflectance is at v = v' = 1/4, for r = p = 1."""
    flat = reflectance.subs({R: 1, P: 1, T: sp.Rational(2, 3), W: sp.Rational(1, 3)})
    return float(flat.subs({V: 0.25, V_PRIME: 0.25}) / flat.subs({V: 1, V_PRIME: 1}))


def root_at_double_angle(angle: Any) -> Any:
    """The root of Z for r = 1/5, at twice the angle to the normal."""
    import numpy as np

    return np.sqrt(values(Z, {T: np.abs(np.cos(angle / 2)), R: 0.2}))


HALF = sp.Rational(1, 2)

ROUGHNESSES = tuple(sp.Rational(k, 20) for k in range(21))

CLAIMS = (
    Claim(
        "S-5-p",
        "Section 5",
        "p is the ratio m/n of the RMS slopes along and across the scratches",
        0.2,
        lambda: slopes_ratio(A_PRINTED, 0.2),
        how="RMS slopes of the distribution Z A for p = 1/5",
        readings=(
            Reading(
                "p is the m/n of a Ward distribution whose share of the azimuths is A without the root of Eq. 28; the "
                "RMS slopes of Z A itself have the ratio sqrt(p) with that A",
                lambda: ward_ratio(0.2) if abs(slopes_ratio(A, 0.2) ** 2 - 0.2) < 1e-9 else None,
            ),
        ),
    ),
    Claim(
        "S-5-r",
        "Section 5",
        "one law relates r to the RMS slope m, in Z (Eq. 28, by Eq. 20) and in G (Eq. 31, by Eq. 19)",
        True,
        lambda: same(roughness.r_by_zenith(M), roughness.r_by_masking(M)),
        instead=Reading(
            "two laws: r = 2 m^2 by Z and r = sqrt(2/pi) m by G, m along one axis; they agree at m = 1/sqrt(2 pi)",
            lambda: bool(
                sp.solve(roughness.r_by_zenith(M) - roughness.r_by_masking(M), M)[-1] == 1 / sp.sqrt(2 * sp.pi)
            ),
        ),
    ),
    Claim(
        "S-5-C",
        "Section 5",
        "C is the reflectivity at normal incidence",
        C,
        lambda: fresnel.schlick(sp.S.One, C),
        how="Eq. 24 at u = 1",
    ),
    Claim(
        "S-22-energy",
        "Eq. 22",
        "two layers reflect no more than falls on them: S + (1 - S) S' is at most 1",
        AtMost(1.0),
        greatest_of_two_layers,
        how="greatest over u, C and C'",
    ),
    Claim(
        "S-26",
        "Eq. 26",
        "with the integral of Z cos sin = 1/2 and that of A over the circle = 2 pi, the product keeps Eq. 5",
        float(sp.pi),
        lambda: zenith_total(0.2) / 2 * mean_azimuth(A, 0.2) * 2 * float(sp.pi),
        how="the product of the two integrals at r = p = 1/5, A without its root",
    ),
    Claim(
        "S-27-weight",
        "Eqs. 26, 27",
        "in the cosine w the condition on A has the weight 1/sqrt(1 - w^2)",
        lambda: sp.integrate(sp.cos(PHI) ** 2, (PHI, 0, sp.pi / 2)),
        lambda: sp.integrate(W**2 / sp.sqrt(1 - W**2), (W, 0, 1)),
        how="both integrals of w^2",
    ),
    Claim(
        "S-28-Z",
        "Eqs. 27, 28",
        "Z keeps its condition of Eq. 27",
        1,
        lambda: max((zenith_total(r) for r in (0.01, 0.05, 0.2, 0.5, 1.0)), key=lambda found: abs(found - 1)),
        how="quadrature at the r of Figure 8",
    ),
    Claim(
        "S-28-A",
        "Eqs. 27, 28",
        "A keeps its condition of Eq. 27: its mean over the azimuth is 1",
        1,
        lambda: mean_azimuth(A_PRINTED, 0.2),
        how="at p = 1/5",
        instead=Reading(
            "its square p/(p^2 - p^2 w^2 + w^2) keeps it for every p; the found mean is the printed A's at p = 1/5",
            lambda: all(abs(mean_azimuth(A, p) - 1) < 1e-9 for p in (0.01, 0.05, 0.2, 0.5, 1.0)),
        ),
    ),
    Claim(
        "S-28-ellipse-Z",
        "Eq. 28",
        "Z is the polar equation of an ellipse with the pole in a focus",
        ZERO,
        lambda: off_conic(zenith_at),
        how="distance from every conic at r = 1/5",
        instead=Reading(
            "the root of Z is one, in twice the angle to the normal; Z itself lies on no conic",
            lambda: off_conic(root_at_double_angle) < 1e-9,
        ),
    ),
    Claim(
        "S-28-ellipse-A",
        "Eq. 28",
        "A is the polar equation of an ellipse with the pole in its middle",
        ZERO,
        lambda: off_conic(azimuth_at),
        how="distance from every conic at p = 1/5; so it is as printed, with the root that breaks Eq. 27",
    ),
    Claim(
        "S-28-r1",
        "Section 5.1",
        "for r = 1, Z is constant",
        sp.S.One,
        lambda: Z.subs(R, 1),
        how="at seven angles",
    ),
    Claim(
        "S-28-r0",
        "Section 5.1",
        "for r = 0, Z becomes a Dirac function",
        AtMost(1e-4),
        lambda: zenith_total(1e-8, float(sp.cos(sp.pi / 180))),
        how="the share of facets steeper than one degree at r = 1e-8; the total stays 1",
    ),
    Claim(
        "S-28-p1",
        "Section 5.1",
        "for p = 1, A is constant",
        sp.S.One,
        lambda: A_PRINTED.subs(P, 1),
        how="at seven azimuths",
    ),
    Claim(
        "S-28-p0",
        "Section 5.1",
        "for p = 0, A becomes a Dirac function: its total 1 comes to lie across the scratches",
        AtLeast(0.999),
        lambda: share_within(A_PRINTED, 1e-6, 2.0),
        how="its integral within two degrees at p = 1e-6",
        readings=(
            Reading("of A without the root; as printed its total goes to 0 with p", lambda: share_within(A, 1e-6, 2.0)),
        ),
    ),
    Claim(
        "S-25-lambert",
        "Section 5.1",
        "the factor v v' in the denominator keeps Eq. 25 from being Lambert's model, even for constant Z",
        AtLeast(2.0),
        lambda: growth(EQ_25),
        how="its value at v = v' = 1/4 over that at v = v' = 1, for r = p = 1; a constant would give 1",
    ),
    Claim(
        "S-25-energy",
        "Section 5, Eq. 25",
        "Eq. 25 keeps the energy law",
        AtMost(1.0),
        lambda: greatest(EQ_25),
        instead=Reading(
            "at normal incidence it does; towards the horizon what it reflects grows beyond all bounds (the found "
            "number is at v = 0.02)",
            lambda: all(albedo(EQ_25, 1.0, r=r, p=1.0) <= 1 for r in (0.2, 0.5, 1.0)),
        ),
    ),
    Claim(
        "S-30-energy",
        "Section 5, Eq. 30",
        "with self-obstruction and re-emission (Eq. 30) the model keeps the energy law",
        AtMost(1.0),
        lambda: greatest(EQ_30),
        instead=Reading(
            "the re-emitted share (1 - G G')/(4 pi v v') grows like 1/(2 v) towards the horizon: the found number is "
            "at v = 0.02",
            lambda: abs(reemitted(0.01) - 1) < 0.02,
        ),
    ),
    Claim(
        "S-30-reciprocal",
        "Section 5",
        "the model keeps Helmholtz's reciprocity",
        ZERO,
        lambda: asymmetry(EQ_30, r=0.3, p=0.5),
        how="greatest relative change of Eq. 30 when view and light change places",
    ),
    Claim(
        "S-32-B",
        "Eqs. 25, 32",
        "the microfacet term of Eq. 32 is b/(4 pi v v') B, with B the factor of Eq. 25",
        EQ_25,
        lambda: EQ_25 / (4 * sp.pi * V * V_PRIME),
        how="at b = 1, r = 1/2, where Eq. 32 is to be Eq. 25",
        instead=Reading(
            "1/(4 pi v v') is counted twice: B is Z A alone, or G G' Z A + 1 - G G'",
            lambda: same(EQ_25, Z * A / (4 * sp.pi * V * V_PRIME)),
        ),
    ),
    Claim(
        "S-33-sum",
        "Eqs. 32, 33",
        "the weights a, b and c add up to 1 and are none below 0",
        (True, True),
        lambda: (
            all(sum(weights(r)) == 1 for r in ROUGHNESSES),
            all(min(weights(r)) >= 0 for r in ROUGHNESSES),
        ),
        how="exact, for r from 0 to 1 in steps of 1/20",
    ),
    Claim(
        "S-33-ends",
        "Eq. 33",
        "r = 0 is a mirror, r = 1 Lambert's model: the weights (a, b, c) there",
        (0, 0, 1, 1, 0, 0),
        lambda: (*weights(sp.S.Zero), *weights(sp.S.One)),
        how="exact",
    ),
    Claim(
        "S-33-continuous",
        "Eq. 33",
        "the three behaviours go over into one another: at r = 1/2 both rules give the microfacets alone",
        (0, 1, 0),
        lambda: tuple(sp.limit(each, R, HALF) for each in (sp.S.Zero, 4 * R * (1 - R), 1 - 4 * R * (1 - R))),
        how="the limit of the rule below 1/2; the rule above it gives (0, 1, 0) too",
    ),
    Claim(
        "S-5-six",
        "Section 5.1",
        "Eqs. 23, 24, 25, 30 and 32 combine to six models",
        6,
        lambda: variants(directional=4),
        how="two spectral factors; Eqs. 25 and 30 alone and inside Eq. 32",
        readings=(Reading("with Eq. 32 counted once, whichever B stands in it", lambda: variants(directional=3)),),
    ),
)
