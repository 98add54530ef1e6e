"""Schlick's masking, a rational fraction of first order: for a Gaussian surface, and for his own model."""

from sympy import Expr, pi, sqrt

from ratfit.brdf._arguments import FROM_ZERO, takes
from ratfit.brdf.masking._cosines import above, held


@takes(m=FROM_ZERO)
def schlick(v: Expr, m: Expr) -> Expr:
    """Schlick's rational G1: v/(v + k (1 - v)) with k = sqrt(2/pi) m.

    Made to have the value and slope at v = 0 and the value at v = 1 of `smith_as_printed` (and so of `smith`); the
    slope of `beckmann` is twice its own.

    Arguments: v in [-1, 1], m the RMS slope along one axis.
    Source: schlick1994 Eq. 19.
    """
    return schlick_roughness(v, sqrt(2 / pi) * m)


@takes(r=FROM_ZERO)
def schlick_roughness(v: Expr, r: Expr) -> Expr:
    """G1 of Schlick's own model: v/(v + r (1 - v)).

    Arguments: v in [-1, 1], r the roughness factor in [0, 1].
    Source: schlick1994 Eq. 31.
    """
    cosine = held(v)
    return above(v, cosine / (cosine + r * (1 - cosine)))
