"""Phong's model: a highlight around the mirror direction, a power of the cosine to it."""

from ratfit._target import parameter
from ratfit.brdf import distribution
from ratfit.models import _mixture, _scanline
from ratfit.models._model import Model
from ratfit.models.directions import R_DOT_V

EXPONENT = parameter("exponent", 0, 10_000)

PHONG = Model(
    "phong",
    "Phong's model, normalised",
    lambda: _mixture.mixture(distribution.phong(R_DOT_V, EXPONENT)),
    (*_mixture.PARAMETERS, EXPONENT),
    "phong1975; lafortune1994",
    {**_mixture.DEFAULTS, "exponent": 50.0},
    note="(n + 2)/(2 pi) (R.V)^n: reciprocal, and all light is reflected at normal incidence, less of it elsewhere.",
)

PHONG_AS_PRINTED = Model(
    "phong-as-printed",
    "Phong's model as printed: not reciprocal, unbounded at the horizon of the light",
    lambda: _scanline.powered(R_DOT_V, EXPONENT),
    (_scanline.DIFFUSE, _scanline.SPECULAR, EXPONENT),
    "polimi2024, The Phong reflection model",
    {"diffuse": 0.5, "specular": 0.5, "exponent": 50.0},
    note=_scanline.NOTE,
)
