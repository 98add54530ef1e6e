"""What Eqs. 13 and 14 of schlick1994 take and give: their ranges, the meaning of n, and what Eq. 14 saves."""

from __future__ import annotations

import sympy as sp

from ratfit.brdf import fresnel
from ratfit.claims._agreement import Below
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._numbers import midpoints
from ratfit.claims.fresnel import ETA, KAPPA, F, U, all_materials, curve, from_refraction
from ratfit.claims.highlights import operations

COLOURS = 3
"""Wavelengths of a picture, by section 2 of schlick1994."""

GLASS = sp.Rational(3, 2)


def range_of_eq_13() -> tuple[float, float]:
    """The least and the greatest value over all materials and angles."""
    curves = [curve(each, midpoints()) for each in all_materials()]
    return float(min(each.min() for each in curves)), float(max(each.max() for each in curves))


def off_glass(eta: sp.Expr) -> float:
    """How far Eq. 13 with an n is from what glass in air reflects at most, at ten angles."""
    angles = [sp.Rational(k, 11) for k in range(1, 11)]
    exact = [float(from_refraction((GLASS, sp.S.Zero), u)) for u in angles]
    printed = [complex(sp.N(fresnel.conductor_as_printed(u, eta, sp.S.Zero), 20)) for u in angles]
    return max(abs(a - b) for a, b in zip(exact, printed, strict=True))


def at_full_reflection() -> sp.Expr | None:
    """Eq. 14 where all light is reflected at the mean index, at every angle; None where it has no value."""
    found = fresnel.spectral_as_printed(sp.S.One, sp.S.One, F)
    return None if found.has(sp.nan) else found


def towards_full_reflection() -> float:
    """How far Eq. 14, clamped, is from f at most, as the mean material comes to reflect all: kappa = 10^6."""
    material = (sp.S.One, sp.Integer(10**6))
    average, level = curve(material, midpoints(0.01, 1, 100)), sp.N(fresnel.normal(*material), 30)
    scaled = [fresnel.spectral(sp.Float(each, 17), level, sp.Rational(3, 10)) for each in average]
    return max(abs(float(each) - 0.3) for each in scaled)


def cost_of_eq_14() -> float:
    """The weight of Eq. 13 once and of Eq. 14 for each colour, over that of Eq. 13 for each colour."""
    average, level = sp.symbols("average level", positive=True)
    full = operations(fresnel.conductor_as_printed(U, ETA, KAPPA))
    scaled = operations(fresnel.spectral_as_printed(average, level, F))
    return (full + COLOURS * scaled) / (COLOURS * full)


CLAIMS = (
    Claim(
        "S-13-range",
        "Eqs. 4, 13",
        "the Fresnel factor is a share, in [0, 1]",
        (True, True),
        lambda: (range_of_eq_13()[0] >= 0, range_of_eq_13()[1] <= 1),
        how="Eq. 13 for eight materials at all angles",
    ),
    Claim(
        "S-13-ratio",
        "Section 4.2",
        "the n of Eq. 13 is the ratio of the refraction indices above and below the surface",
        0,
        lambda: off_glass(1 / GLASS),
        how="glass in air, with n = 2/3",
        readings=(
            Reading(
                "the index below the surface over that above: n = 3/2 for glass in air, where 2/3 reflects all light "
                "from 48 degrees on",
                lambda: off_glass(GLASS),
            ),
        ),
    ),
    Claim(
        "S-14-mirror",
        "Eq. 14",
        "(implied) Eq. 14 has a value for every mean material, whatever it reflects at normal incidence",
        F,
        at_full_reflection,
        instead=Reading(
            "it is 0/0 where the mean material reflects all light at normal incidence; its limit, clamped to f, is f",
            lambda: at_full_reflection() is None and towards_full_reflection() < 1e-5,
        ),
    ),
    Claim(
        "S-14-cost",
        "Section 4.2",
        "Eq. 14 is less work than Eq. 13 for every wavelength, since Eq. 13 is computed once",
        Below(1.0),
        cost_of_eq_14,
        how="weight of the operations for three colours over that of Eq. 13 three times, as by the cost model",
    ),
)
