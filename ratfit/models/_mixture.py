"""A diffuse reflector and a specular one, side by side in shares that add up to 1."""

import sympy as sp

from ratfit._target import parameter

DIFFUSE = parameter("diffuse", 0, 1)
SPECULAR = parameter("specular", 0, 1)
SHARE = parameter("specular_share", 0, 1)

PARAMETERS = (DIFFUSE, SPECULAR, SHARE)
DEFAULTS = {"diffuse": 0.5, "specular": 1.0, "specular_share": 0.5}


def mixture(lobe: sp.Expr) -> sp.Expr:
    """(1 - s)/pi C + s C' lobe, with s = `SHARE`, C = `DIFFUSE` and C' = `SPECULAR` (schlick1994, Eqs. 4 and 10).

    Because the shares add up to 1, the whole conserves energy wherever the lobe does.
    """
    return (1 - SHARE) * DIFFUSE / sp.pi + SHARE * SPECULAR * lobe
