"""The Fresnel factor in both sets of slides."""

from __future__ import annotations

import sympy as sp

from ratfit.brdf import fresnel
from ratfit.claims._agreement import AtLeast
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._numbers import midpoints, values
from ratfit.claims.fresnel import DIELECTRICS, F, Material, U, curve, falls_with_u, is_fresnel, normal, of_metals


def worst_of_schlick(materials: tuple[Material, ...]) -> float:
    """The greatest error of the power with exponent 5, with f of each material."""
    import numpy as np

    u = midpoints()
    errors = [curve(m, u) - values(fresnel.schlick(U, F), {U: u, F: normal(m)}) for m in materials]
    return float(np.max(np.abs(errors)))


def is_total_below_critical() -> bool:
    """Whether the slides' formula is real and 1 where light comes from the denser side beyond the critical angle."""
    value = sp.N(fresnel.dielectric_as_printed(sp.Rational(1, 5), sp.Rational(2, 3)), 30)
    return bool(value.is_real and abs(value - 1) < 1e-20)


def spread_over_angles(material: Material) -> float:
    found = curve(material, midpoints())
    return float(found.max() - found.min())


CLAIMS = (
    Claim(
        "DP-F-schlick",
        "F term",
        "Ks + (1 - Ks)(1 - L.H)^5 is the specular colour Ks where light, view and normal are one",
        F,
        lambda: fresnel.schlick(sp.S.One, F),
        how="symbolic",
    ),
    Claim(
        "DP-F-exact",
        "F term",
        "the formula in g and c is the exact Fresnel factor",
        True,
        lambda: (
            is_fresnel(lambda u, each: fresnel.dielectric_as_printed(u, each[0]), DIELECTRICS)
            and is_total_below_critical()
        ),
        readings=(
            Reading(
                "for light that comes from the thinner side; from the denser side g is not real beyond the critical "
                "angle, where F = 1",
                lambda: is_fresnel(lambda u, each: fresnel.dielectric_as_printed(u, each[0]), DIELECTRICS),
            ),
        ),
    ),
    Claim(
        "DP-F-grazing",
        "D, F and G",
        "the Fresnel term varies greatly with the angle of incidence",
        AtLeast(0.9),
        lambda: spread_over_angles(DIELECTRICS[1]),
        how="glass: greatest less least value",
        word="greatly",
    ),
    Claim(
        "PM-F-conductor",
        "Cook-Torrance, Fresnel term",
        "the power with exponent 5 does not work well for conductors",
        True,
        None,
        readings=(
            Reading(
                "its worst error over copper, gold, silver, aluminium and iron is above that over glass and diamond; "
                "for gold, silver and copper alone it is below",
                lambda: (
                    worst_of_schlick(of_metals("copper", "gold", "silver", "aluminium", "iron"))
                    > worst_of_schlick(DIELECTRICS)
                    > worst_of_schlick(of_metals("copper", "gold", "silver"))
                ),
            ),
        ),
        open="well means no number",
    ),
    Claim(
        "PM-F-grazing",
        "Ward and beyond",
        "objects reflect more when the light comes almost along the surface",
        True,
        lambda: falls_with_u((*DIELECTRICS, *of_metals("copper", "aluminium", "iron"))),
        readings=(
            Reading(
                "non-metals; metals dip before they rise",
                lambda: falls_with_u(DIELECTRICS) and not falls_with_u(of_metals("aluminium")),
            ),
        ),
    ),
    Claim(
        "PM-F-range",
        "Cook-Torrance, Fresnel term",
        "F0 in [0, 1] says how the response changes with the angle: F is between F0 and 1",
        (F, sp.S.One),
        lambda: (fresnel.schlick_clamped(sp.S.One, F), fresnel.schlick_clamped(sp.S.Zero, F)),
        how="at both ends; it is monotonous between",
    ),
)
