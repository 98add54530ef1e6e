"""Sections 2 and 3 of schlick1994: laws of a reflectance, and the models that it starts from."""

from __future__ import annotations

import functools
import itertools

import sympy as sp

from ratfit.brdf import distribution, masking
from ratfit.claims._agreement import ZERO, AtMost, Below
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import albedo, over_pairs
from ratfit.claims._models import V_PRIME, T, V, W, made, named
from ratfit.claims._numbers import values

ALPHA, PHI = sp.Symbol("alpha", positive=True), sp.Symbol("varphi", positive=True)
VIEWS = (0.05, 0.2, 0.5, 1.0)


def facets(masked: sp.Expr) -> sp.Expr:
    """The specular term of Eq. 8 for facets that reflect all: Beckmann's D with a G."""
    return made(distribution.beckmann, T, ALPHA) * masked / (4 * V * V_PRIME)


def greatest_albedo(reflectance: sp.Expr, views: tuple[float, ...] = VIEWS, **parameters: float) -> float:
    return max(albedo(reflectance, view, **parameters) for view in views)


def asymmetry(reflectance: sp.Expr, **parameters: float) -> float:
    """The greatest relative change when view and light change places, over pairs of directions."""
    swapped = reflectance.xreplace({V: V_PRIME, V_PRIME: V})
    there, back = over_pairs(reflectance, **parameters), over_pairs(swapped, **parameters)
    return float(abs(there - back).max() / abs(there).max())


ANGLES_OF_EQ_4 = {"F": {"beta"}, "G": {"theta", "theta'"}, "D": {"alpha", "phi"}}


def flat_lobe(by_radiance: bool) -> float:
    """What Lambert's model sends in a direction at 60 degrees over what it sends along the normal."""
    sent = named("lambert").reflectance * (1 if by_radiance else V)  # the view is where the light goes
    return float(sent.subs(V, 0.5) / sent.subs(V, 1))


POWERS = (0, 1, 2, 3)
"""Distributions without azimuth to try integrals on: t**power."""


def of_eq_5(power: int) -> sp.Expr:
    """The left side of Eq. 5, over both angles, for D = cos(alpha)**power."""
    around = sp.integrate(sp.cos(ALPHA) ** (power + 1) * sp.sin(ALPHA), (PHI, 0, 2 * sp.pi))
    return sp.integrate(around, (ALPHA, 0, sp.pi / 2))


def of_eq_6(power: int) -> sp.Expr:
    return sp.integrate(2 * sp.cos(ALPHA) ** (power + 1) * sp.sin(ALPHA), (ALPHA, 0, sp.pi / 2))


def of_eq_7(power: int) -> sp.Expr:
    return sp.integrate(2 * T * T**power, (T, 0, 1))


SHARES = sp.symbols("d s C_lambda D_lambda F G D", positive=True)
d, s, C_LAMBDA, D_LAMBDA, F, G, D = SHARES
EQ_4 = d / sp.pi * C_LAMBDA + s / (4 * sp.pi * V * V_PRIME) * F * G * D
EQ_5 = sp.Integral(D * sp.cos(ALPHA) * sp.sin(ALPHA), (ALPHA, 0, sp.pi / 2), (PHI, 0, 2 * sp.pi)) - sp.pi
EQ_8 = d / sp.pi * D_LAMBDA + s / (4 * sp.pi * V * V_PRIME) * F * G * D
"""As printed; Eq. 5 with its right side subtracted."""


def rewritten(equation: sp.Expr) -> bool:
    """Whether Eq. 8 is an equation in other letters: one colour put for another."""
    return bool(sp.expand(EQ_8.subs(D_LAMBDA, C_LAMBDA) - equation) == 0)


def origin_of_eq_8() -> str:
    return ", ".join(number for number, equation in (("4", EQ_4), ("5", EQ_5)) if rewritten(equation))


def diffuse_of_eq_8() -> str:
    """What has to stand as the colour in the diffuse term of Eq. 8 for it to be Eq. 4."""
    (colour,) = sp.solve(EQ_8 - EQ_4, D_LAMBDA)
    return str(colour)


def anisotropies() -> tuple[float, ...]:
    """Those of Ward's D as n/m grows from 1 to 5."""
    return tuple(anisotropy(0.2, 0.2 * ratio) for ratio in (1, 1.5, 2, 3, 5))


@functools.cache
def masked_facets() -> sp.Expr:
    """The same with the masking that belongs to them."""
    return facets(masking.separable(masking.beckmann, V, V_PRIME, ALPHA))


def least_of_facets() -> float:
    """The least share that Beckmann's facets with their masking reflect, alpha = 1."""
    return min(albedo(masked_facets(), view, alpha=1.0) for view in VIEWS)


def attenuation(heights: float) -> float:
    """He's coefficient of the coherent term at normal incidence, for RMS heights over the wavelength."""
    from ratfit.models.he import attenuation as coefficient

    return float(coefficient(sp.S.One, sp.S.One, sp.Float(heights)))


CLAIMS = (
    Claim(
        "S-2-lambert",
        "Section 2",
        "a surface with a constant reflectance reflects light equally in every direction",
        1,
        lambda: flat_lobe(by_radiance=False),
        how="the power it sends in a direction at 60 degrees over that along the normal",
        readings=(Reading("in radiance; the power goes with the cosine", lambda: flat_lobe(by_radiance=True)),),
    ),
    Claim(
        "S-4-angles",
        "Eq. 4",
        "the reflectance of Cook and Torrance's model depends on five angles",
        5,
        lambda: len(set().union(*ANGLES_OF_EQ_4.values())),
        how="those in the brackets of F, G and D; a pair of directions has four",
    ),
    Claim(
        "S-3-obstructed",
        "Section 3",
        "the light that a G blocks is missing in existing models: none gives it back",
        Below(1.0),
        least_of_facets,
        how="the least share that Beckmann's facets with their masking reflect, F = 1, alpha = 1, at four angles",
    ),
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
                lambda: greatest_albedo(masked_facets(), alpha=0.5),
            ),
        ),
    ),
    Claim(
        "S-6",
        "Eqs. 5, 6",
        "for a D without azimuth Eq. 5 is pi times the integral of Eq. 6",
        (sp.pi,) * len(POWERS),
        lambda: tuple(of_eq_5(power) / of_eq_6(power) for power in POWERS),
        how="their ratio, for D = 1, t, t^2 and t^3",
    ),
    Claim(
        "S-7",
        "Eqs. 6, 7",
        "in the cosine t Eq. 6 is the integral of 2 t D(t)",
        lambda: tuple(of_eq_7(power) for power in POWERS),
        lambda: tuple(of_eq_6(power) for power in POWERS),
        how="both integrals for D = 1, t, t^2 and t^3",
    ),
    Claim(
        "S-8-colour",
        "Eq. 8",
        "in cosines the diffuse term of Eq. 4 has the colour D_lambda",
        "D_lambda",
        diffuse_of_eq_8,
        instead=Reading(
            "C_lambda, as in Eq. 4: a misprint",
            lambda: diffuse_of_eq_8() == "C_lambda",
        ),
    ),
    Claim(
        "S-8-origin",
        "Eq. 8",
        "Eq. 8 is what Eq. 5 becomes in cosines",
        "5",
        origin_of_eq_8,
        instead=Reading("it is Eq. 4; Eq. 5 became Eq. 7: a misprint", lambda: rewritten(EQ_4) and not rewritten(EQ_5)),
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
        True,
        lambda: all(later > earlier for earlier, later in itertools.pairwise(anisotropies())),
        how="ratio of D along and across the scratches at 20 degrees, n/m = 1, 3/2, 2, 3 and 5",
    ),
)


def anisotropy(m: float, n: float) -> float:
    """How many times Ward's D along one axis is that along the other, at 20 degrees."""
    slopes = sp.symbols("m n", positive=True)
    at = {T: float(sp.cos(sp.pi / 9)), slopes[0]: m, slopes[1]: n}
    lobe = made(distribution.ward_as_printed, T, W, *slopes)
    along, across = (float(values(lobe, {**at, W: w})) for w in (1.0, 0.0))
    return max(along / across, across / along)
