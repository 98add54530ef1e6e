"""Importance sampling: Eq. 29 of schlick1994."""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp

from ratfit.brdf import sampling
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._models import T
from ratfit.claims._numbers import integral
from ratfit.claims.schlick_model import R, Z

Sample = Callable[[sp.Expr, sp.Expr], sp.Expr]

UNIFORM = tuple(sp.Rational(k, 16) for k in range(1, 16))

FINER = 4
"""How many times the places around the worst are taken a quarter as far apart."""


def off_uniform(sample: Sample, distribution: Sample, p: sp.Expr) -> float:
    """How far a distribution function of its own samples is from the uniform numbers they are made of: 0 if right."""

    def off(b: sp.Expr) -> float:
        return abs(float(sp.N(distribution(sample(b, p), p) - b, 20)))

    worst, step = max(UNIFORM, key=off), sp.Rational(1, 16)
    for _ in range(FINER):  # nearer and nearer to the greatest, between its neighbours
        step /= 4
        worst = max((worst + k * step for k in range(-3, 4)), key=off)
    return off(worst)


def amplitude(b: sp.Expr, p: sp.Expr) -> sp.Expr:
    """The azimuth below which the share b of A as printed lies: Jacobi's amplitude am(b K(k), k), k^2 = 1 - p^2.

    A is sqrt(p)/sqrt(1 - k^2 sin^2 phi), the integrand of an elliptic integral of the first kind.
    """
    import mpmath

    k2 = 1 - mpmath.mpf(float(p)) ** 2
    return sp.Float(float(mpmath.asin(mpmath.ellipfun("sn", float(b) * mpmath.ellipk(k2), m=k2))), 17)


def off_zenith(r: float) -> float:
    """The same for the cosine of the zenith angle: the share of Z below it is the number a."""
    worst = 0.0
    for a in UNIFORM:
        cosine = float(sampling.ggx_cosine(a, sp.sqrt(sp.Float(r, 17))))
        worst = max(worst, abs(integral(2 * T * Z, T, 0.0, cosine, {R: r}) - float(a)))
    return worst


FIFTH = sp.Rational(1, 5)

CLAIMS = (
    Claim(
        "S-29-zenith",
        "Eq. 29",
        "alpha = arccos sqrt(a/(r - a r + a)) is distributed as Z",
        0,
        lambda: max(off_zenith(r) for r in (0.01, 0.2, 1.0)),
        how="greatest distance of the share of Z below a sample from its a, at three r",
    ),
    Claim(
        "S-29-azimuth",
        "Eq. 29",
        "phi = (pi/2) sqrt(p^2 b^2/(1 - b^2 + b^2 p^2)) is distributed as A",
        0,
        lambda: off_uniform(sampling.azimuth_as_printed, sampling.azimuth_distribution_as_printed, FIFTH),
        how="at p = 1/5",
        readings=(
            Reading(
                "as A without the root",
                lambda: off_uniform(sampling.azimuth_as_printed, sampling.azimuth_distribution, FIFTH),
            ),
        ),
        instead=Reading(
            "it has its peak along the scratches, where A is least; phi = arctan(tan(pi b/2)/p) is distributed as A "
            "without the root, Jacobi's amplitude am(b K(k), k) with k^2 = 1 - p^2 as A in print. The found number is "
            "how far the share of A below a sample is from its b, at p = 1/5",
            lambda: (
                off_uniform(sampling.azimuth, sampling.azimuth_distribution, FIFTH) < 1e-12
                and off_uniform(amplitude, sampling.azimuth_distribution_as_printed, FIFTH) < 1e-9
            ),
        ),
    ),
)
