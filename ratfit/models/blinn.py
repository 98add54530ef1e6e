"""Blinn's model: Phong's with the half vector, a power of its cosine to the normal."""

import sympy as sp

from ratfit._target import parameter
from ratfit.models import _mixture, _scanline
from ratfit.models._model import Model
from ratfit.models.directions import T

EXPONENT = parameter("exponent", 0, 10_000)


def normalisation(exponent: sp.Expr) -> sp.Expr:
    """The factor with which the power of N.H reflects all light at normal incidence.

    There H halves the angle to the light: with c = cos(theta/2) the power's albedo is the integral of
    8 pi c**(n + 1) (2 c**2 - 1) from sqrt(1/2) to 1, 8 pi (n + 2**(-n/2))/((n + 2)(n + 4)).
    """
    n = exponent
    vanishing = 2 ** (-sp.Min(n, 120) / 2)  # beside n, nothing from there on; 2**(n/2) itself would overflow
    return (n + 2) * (n + 4) / (8 * sp.pi * (n + vanishing))


BLINN = Model(
    "blinn",
    "Blinn's model, normalised",
    lambda: _mixture.mixture(normalisation(EXPONENT) * _scanline.highlight(T, EXPONENT)),
    (*_mixture.PARAMETERS, EXPONENT),
    "blinn1977; the normalisation is derived in `normalisation`",
    {**_mixture.DEFAULTS, "exponent": 200.0},
    note="All light is reflected at normal incidence, less of it elsewhere.",
    sampler="phong",  # of half vectors
)

BLINN_AS_PRINTED = Model(
    "blinn-as-printed",
    "Blinn's model as printed: not reciprocal, unbounded at the horizon of the light",
    lambda: _scanline.powered(T, EXPONENT),
    (_scanline.DIFFUSE, _scanline.SPECULAR, EXPONENT),
    "polimi2024, The Blinn reflection model",
    {"diffuse": 0.5, "specular": 0.5, "exponent": 200.0},
    note=_scanline.NOTE,
    sampler="phong",
)
