"""The structure of the He-Torrance-Sillion-Greenberg model: Cook-Torrance and a coherent reflection by the mean plane.

schlick1994 (Eq. 9) gives the structure and leaves the factors to he1991, whose roughness attenuation coefficient is
A = exp(-g), g = (2 pi (v + v') sigma)^2, with sigma the RMS height over the wavelength: how much of the light the
surface is smooth for. There the distribution D is a sum of lobes whose weights g^n exp(-g)/n!, n >= 1, add up to 1 - A.
Here one lobe stands for them, of whatever D. In `he-as-printed` its weight is 1, for D keeps Eq. 5 as schlick1994 asks,
so that a smooth surface reflects twice. In `he` both reflections share the light: the weight is 1 - A where v' = v, as
for the mirror, and elsewhere the 1 - A of the lower of the two directions, exp(-(4 pi min(v, v') sigma)^2). With
1 - A(v, v') the two were more than the light: the mirror has A(v, v) of it, and light that comes in at a grazing angle
is scattered upwards, where A(v, v') is less than A(v, v); heights of a sixth of the wavelength, alpha = 0.1 and total
reflection came to 1.03 at 78 degrees. The weight is nowhere above 1 - A(v, v) now, facets with Smith's masking reflect
no more than they receive, and so the whole does not.
"""

from __future__ import annotations

import sympy as sp

from ratfit._target import parameter
from ratfit.brdf import fresnel, masking
from ratfit.models._mixture import DIFFUSE, SHARE
from ratfit.models._model import Model
from ratfit.models.cook_torrance import ALPHA, AXIS, DEFAULTS, DISTRIBUTIONS, ETA, FRESNELS, KAPPA, MASKINGS
from ratfit.models.directions import V_PRIME, V

SIGMA = parameter("sigma", 0, 10)
"""The RMS height of the surface over the wavelength."""

LOWER = sp.Min(V, V_PRIME)
"""The cosine of the direction that is nearer to the horizon."""

PARAMETERS = (ALPHA, ETA, KAPPA, SIGMA, DIFFUSE, SHARE)


def attenuation_exponent(v: sp.Expr, v_prime: sp.Expr, sigma: sp.Expr) -> sp.Expr:
    """g = (2 pi (v + v') sigma)^2 (he1991)."""
    return (2 * sp.pi * (v + v_prime) * sigma) ** 2


def attenuation(v: sp.Expr, v_prime: sp.Expr, sigma: sp.Expr) -> sp.Expr:
    """A(v, v') = exp(-g): 1 for a smooth surface."""
    return sp.exp(-attenuation_exponent(v, v_prime, sigma))


def attenuated(v: sp.Expr, v_prime: sp.Expr, sigma: sp.Expr) -> sp.Expr:
    """1 - A(v, v'), written without the difference: 2 x/(1 + x) with x = tanh(g/2)."""
    x = sp.tanh(attenuation_exponent(v, v_prime, sigma) / 2)
    return 2 * x / (1 + x)


def he(weight: sp.Expr, name: str, title: str) -> Model:
    """The model with this weight on the lobe of the facets; its mirror's share is s F(v) G(v)^2 A(v, v)."""

    def formula() -> sp.Expr:
        factors = DISTRIBUTIONS["beckmann"], FRESNELS["conductor"], MASKINGS["smith"]
        return (1 - SHARE) * DIFFUSE / sp.pi + SHARE * weight * sp.Mul(*(factor.formula for factor in factors)) / 4

    def mirror() -> sp.Expr:
        masked = masking.separable(masking.smith, V, V, AXIS)
        return SHARE * fresnel.conductor(V, ETA, KAPPA) * masked * attenuation(V, V, SIGMA)

    return Model(
        name,
        title,
        formula,
        PARAMETERS,
        "schlick1994, Eq. 9; he1991",
        {**{p.name: DEFAULTS[p] for p in PARAMETERS if p in DEFAULTS}, SIGMA.name: 0.1},
        mirror,
        distribution=lambda: DISTRIBUTIONS["beckmann"].formula,
        sampler="beckmann",
    )


HE: tuple[Model, ...] = (
    he(attenuated(LOWER, LOWER, SIGMA), "he", "The structure of He et al., coherent and incoherent sharing the light"),
    he(sp.S.One, "he-as-printed", "The structure of He et al., the incoherent lobe in full"),
)
