"""Lambert's model: the same radiance in every direction."""

import sympy as sp

from ratfit._target import parameter
from ratfit.models._model import Model

ALBEDO = parameter("albedo", 0, 1)

LAMBERT = Model(
    "lambert",
    "Lambert's diffuse reflector",
    lambda: ALBEDO / sp.pi,
    (ALBEDO,),
    "schlick1994, Eq. 8",
    {"albedo": 1.0},
)
