"""Section 5 of schlick1994: the new model, its energy, limits and weights."""

from __future__ import annotations

import sympy as sp

from ratfit._target import parameter
from ratfit.brdf import distribution, fresnel, masking
from ratfit.claims._agreement import ZERO, AtMost, same
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import albedo
from ratfit.claims._models import V_PRIME, T, U, V, W, made
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


def eq_32(directional: sp.Expr, a: sp.Expr = sp.S.Zero, b: sp.Expr = sp.S.One) -> sp.Expr:
    """Eq. 32 as printed with that B, without its mirror; where nothing else is said for r = 1/2, all facets."""
    return a / sp.pi + b / (4 * sp.pi * V * V_PRIME) * directional


GRAZING = (0.02, 0.05, 0.2, 0.5, 1.0)


def mean_azimuth(factor: sp.Expr, p: float) -> float:
    """2/pi times the integral of a factor of the azimuth over a quadrant: 1 by Eq. 27."""
    return integral(factor.subs(W, sp.cos(PHI)), PHI, 0.0, float(sp.pi / 2), {P: p}) * 2 / float(sp.pi)


def of_ward(w: float, p: float) -> float:
    """The share of an azimuth in Ward's normalised distribution with m/n = p, as A counts it."""
    m, n = sp.symbols("m n", positive=True)
    lobe = T * made(distribution.ward, T, W, m, n)
    return 2 * float(sp.pi) * integral(lobe, T, 0.0, 1.0, {W: w, m: p / 2, n: 0.5})


def is_share_of_ward(factor: sp.Expr, p: float = 0.2) -> bool:
    """Whether a factor is the share of the azimuths in Ward's distribution."""
    return all(abs(of_ward(w, p) - float(values(factor, {W: w, P: p}))) < 1e-8 for w in (0.1, 0.5, 0.9))


def greatest(reflectance: sp.Expr) -> float:
    """The greatest share reflected over angles of view and r, for p = 1."""
    return max(albedo(reflectance, view, r=r, p=1.0) for view in GRAZING for r in (0.2, 0.5, 1.0))


def is_greatest_at_one(reflectance: sp.Expr) -> bool:
    """Whether that is at the lowest of the angles and r = 1."""
    return albedo(reflectance, GRAZING[0], r=1.0, p=1.0) == greatest(reflectance)


def reemitted(view: float) -> float:
    """The share that the second term of Eq. 30 adds, times 2 v."""
    return 2 * view * albedo((1 - MASKED) / (4 * sp.pi * V * V_PRIME), view, r=0.5)


def reflected_by_two_layers(s: sp.Expr, second: sp.Expr) -> sp.Expr:
    """The weights of the directional factors in Eq. 22, DOUBLE, added up."""
    return s + (1 - s) * second


def greatest_of_two_layers() -> float:
    import numpy as np

    u, c, second = np.meshgrid(*(np.linspace(0, 1, 41),) * 3)
    s, s_second = (fresnel.schlick(U, each) for each in (C, C_SECOND))
    return float(values(reflected_by_two_layers(s, s_second), {U: u, C: c, C_SECOND: second}).max())


CLAIMS = (
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
        "S-25-energy",
        "Section 5, Eq. 25",
        "Eq. 25 keeps the energy law",
        AtMost(1.0),
        lambda: greatest(EQ_25),
        instead=Reading(
            "at normal incidence it does; towards the horizon what it reflects grows beyond all bounds (the found "
            "number is at v = 0.02, r = p = 1)",
            lambda: all(albedo(EQ_25, 1.0, r=r, p=1.0) <= 1 for r in (0.2, 0.5, 1.0)) and is_greatest_at_one(EQ_25),
        ),
    ),
    Claim(
        "S-30-reemission",
        "Eq. 30",
        "Eq. 30 gives what is obstructed back as Eq. 25 with Z = A = 1",
        True,
        lambda: same(EQ_30, MASKED * EQ_25 + (1 - MASKED) * EQ_25.subs({R: 1, P: 1})),
        how="Eq. 30 against Eq. 25 weighted by G G', and with r = p = 1 by the rest",
    ),
    Claim(
        "S-30-energy",
        "Section 5, Eq. 30",
        "with self-obstruction and re-emission (Eq. 30) the model keeps the energy law",
        AtMost(1.0),
        lambda: greatest(EQ_30),
        instead=Reading(
            "the re-emitted share (1 - G G')/(4 pi v v') grows like 1/(2 v) towards the horizon: the found number is "
            "at v = 0.02, r = p = 1",
            lambda: abs(reemitted(0.01) - 1) < 0.02 and is_greatest_at_one(EQ_30),
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
        sp.S.One,
        lambda: eq_32(EQ_25) / EQ_25,
        how="Eq. 32 over Eq. 25 at b = 1, r = 1/2, where they are to be one",
        instead=Reading(
            "1/(4 pi v v') is counted twice: B is Z A alone, or G G' Z A + 1 - G G'",
            lambda: same(EQ_25, eq_32(Z * A)) and same(EQ_30, eq_32(MASKED * Z * A + 1 - MASKED)),
        ),
    ),
)
