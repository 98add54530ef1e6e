"""What the models of polimi2024 have in common: colours from 0 to 1, and values that hold the cosine to the light."""

import sympy as sp

from ratfit._target import parameter
from ratfit.brdf._limits import guarded
from ratfit.models.directions import HORIZON, V_PRIME

DIFFUSE = parameter("diffuse", 0, 1)
SPECULAR = parameter("specular", 0, 1)

NOTE = "polimi2024's f is this value times the cosine to the light, N.L; its colours carry no 1/pi."


def without_cosine(f: sp.Expr) -> sp.Expr:
    """The reflectance whose product with the cosine to the light is f."""
    return f / sp.Max(V_PRIME, HORIZON)


def powered(cosine: sp.Expr, exponent: sp.Expr) -> sp.Expr:
    """A diffuse share and the `highlight` of a cosine, each with its colour."""
    return without_cosine(DIFFUSE * V_PRIME + SPECULAR * highlight(cosine, exponent))


def highlight(cosine: sp.Expr, exponent: sp.Expr) -> sp.Expr:
    """clamp(cosine)**exponent; 0 where the cosine is not positive, for an exponent of 0 as well."""
    return guarded(lambda known: sp.Min(1, known) ** exponent, cosine, sp.S.Zero, cosine <= 0, sp.S.One)
