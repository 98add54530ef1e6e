"""Sections 2 and 3 of schlick1994: laws of a reflectance, and the models that it starts from."""

from __future__ import annotations

import sympy as sp

from ratfit.brdf import distribution, masking
from ratfit.claims._agreement import ZERO, AtLeast, AtMost
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import albedo, over_pairs
from ratfit.claims._models import V_PRIME, T, V, W, named

ALPHA = sp.Symbol("alpha", positive=True)
VIEWS = (0.05, 0.2, 0.5, 1.0)


def facets(masked: sp.Expr) -> sp.Expr:
    """The specular term of Eq. 8 for facets that reflect all: Beckmann's D with a G."""
    return distribution.beckmann(T, ALPHA) * masked / (4 * V * V_PRIME)


def greatest_albedo(reflectance: sp.Expr, views: tuple[float, ...] = VIEWS, **parameters: float) -> float:
    return max(albedo(reflectance, view, **parameters) for view in views)


def asymmetry(reflectance: sp.Expr, **parameters: float) -> float:
    """The greatest relative change when view and light change places, over pairs of directions."""
    swapped = reflectance.xreplace({V: V_PRIME, V_PRIME: V})
    there, back = over_pairs(reflectance, **parameters), over_pairs(swapped, **parameters)
    return float(abs(there - back).max() / abs(there).max())


def of_power(weight: sp.Expr, factor: sp.Expr, power: int) -> sp.Expr:
    """The integral of t**power with a weight over t in [0, 1], times a factor."""
    return factor * sp.integrate(T**power * weight, (T, 0, 1))


def diffuse_of_eq_8() -> str:
    """What has to stand as the colour in the diffuse term of Eq. 8 for it to be Eq. 4."""
    d, s, c, unknown = sp.symbols("d s C_lambda X")
    specular = sp.Symbol("specular")
    (colour,) = sp.solve(d / sp.pi * unknown + s * specular - (d / sp.pi * c + s * specular), unknown)
    return str(colour)


def attenuation(heights: float) -> float:
    """He's coefficient of the coherent term at normal incidence, for RMS heights over the wavelength."""
    from ratfit.models.he import attenuation as coefficient

    return float(coefficient(sp.S.One, sp.S.One, sp.Float(heights)))


CLAIMS = (
    Claim(
        "S-3-lambert",
        "Eqs. 3, 4",
        "the constant C/pi reflects the share C of the light, so the diffuse term keeps the energy law",
        1,
        lambda: albedo(named("lambert").reflectance, 0.5, albedo=1.0),
        how="quadrature over the hemisphere for C = 1",
    ),
    Claim(
        "S-5-energy",
        "Eqs. 3, 5",
        "facets normalised by Eq. 5 keep the energy law of Eq. 3",
        AtMost(1.0),
        lambda: greatest_albedo(facets(sp.S.One), alpha=0.5),
        how="greatest share reflected at four angles by Beckmann's facets with alpha = 1/2 and F = G = 1",
        readings=(
            Reading(
                "with the masking that belongs to the facets; with G = 1 they reflect too much at grazing angles",
                lambda: greatest_albedo(facets(masking.separable(masking.beckmann, V, V_PRIME, ALPHA)), alpha=0.5),
            ),
        ),
    ),
    Claim(
        "S-6",
        "Eqs. 5, 6",
        "for a D without azimuth Eq. 5 is pi times the integral of Eq. 6",
        sp.pi,
        lambda: of_power(T, 2 * sp.pi, 3) / of_power(2 * T, sp.S.One, 3),
        how="symbolic, for D = t^3",
    ),
    Claim(
        "S-7",
        "Eqs. 6, 7",
        "in the cosine t Eq. 6 is the integral of 2 t D(t)",
        lambda: of_power(2 * T, sp.S.One, 3),
        lambda: sp.integrate(sp.cos(ALPHA) ** 3 * 2 * sp.cos(ALPHA) * sp.sin(ALPHA), (ALPHA, 0, sp.pi / 2)),
        how="symbolic, for D = t^3",
    ),
    Claim(
        "S-8-colour",
        "Eq. 8",
        "in cosines the diffuse term of Eq. 4 has the colour D_lambda",
        "D_lambda",
        diffuse_of_eq_8,
        instead=Reading(
            "C_lambda, as in Eq. 4: a misprint, as is Equation 5 for Equation 4 in the line before it",
            lambda: diffuse_of_eq_8() == "C_lambda",
        ),
    ),
    Claim(
        "S-9-coherent",
        "Section 2.2",
        "the coherent term decreases rapidly as roughness increases",
        "decreases",
        None,
        readings=(
            Reading(
                "with A = exp(-g) of he1991: its value at normal incidence for heights of a fifth of the wavelength "
                "over that for a twentieth",
                lambda: attenuation(0.2) / attenuation(0.05),
                AtMost(0.1),
            ),
        ),
        open="the source gives no expression of the roughness attenuation A of Eq. 9",
    ),
    Claim(
        "S-10-reciprocal",
        "Eqs. 2, 10",
        "Ward's model is symmetric in view and light",
        ZERO,
        lambda: asymmetry(
            named("ward-as-printed").reflectance, diffuse=0.5, specular=1.0, specular_share=0.5, m=0.3, n=0.5
        ),
        how="greatest relative change when they change places",
    ),
    Claim(
        "S-10-elliptical",
        "Section 2.3",
        "the more m and n differ, the more anisotropic is Ward's D",
        AtLeast(1.0),
        lambda: anisotropy(0.2, 0.6) / anisotropy(0.2, 0.3),
        how="ratio of D along and across the scratches at 20 degrees, n/m = 3 over n/m = 3/2",
    ),
)


def anisotropy(m: float, n: float) -> float:
    """How many times Ward's D along one axis is that along the other, at 20 degrees."""
    slopes = sp.symbols("m n", positive=True)
    lobe = distribution.ward_as_printed(T, W, *slopes)
    along, across = (float(lobe.subs({T: sp.cos(sp.pi / 9), W: w, slopes[0]: m, slopes[1]: n}).evalf()) for w in (1, 0))
    return max(along / across, across / along)
