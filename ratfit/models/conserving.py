"""Schlick's model with a re-emission that conserves energy: reciprocal, and its albedo is at most 1 everywhere.

What facets hide is given back as kulla2017 do it, (1 - E(v)) (1 - E(v'))/(pi (1 - E_mean)), in place of
(1 - G G')/(4 pi v v'), which grows without bound at grazing angles. Two things make the albedo at most 1:

- The masking is v/(v + k (1 - v)) with k = sqrt(r)/(1 + p) in place of r. With k = r (schlick1994, Eq. 31) facets alone
  reflect up to 2.6 times what they receive (r = 0.01, v = 0.01). With this k, G is below the exact masking of Z A in
  whatever azimuth: for p = 1 that of GGX, for p -> 0 that of slopes along one line, 1/(1 + x atan(x)/2) with
  x = sqrt(r (1 - v^2))/v, of which no other p comes below.
- E is no less than the albedo of those facets in any azimuth. It is a closed form, `hidden`, whose 18 coefficients
  were found once by a linear programme: below 1 - albedo for every r, p and azimuth, and nowhere far below: weighted by
  b = 4 r (1 - r), as the model does, a white isotropic surface loses 1.8 % of the light at most. For p < 1 it loses
  more, as E is that of the azimuth that reflects most: 42 % of what comes along the scratches, grazing, at r = 0.3,
  p = 0.2.

Multiplied by S(u) <= 1 the facets reflect less; the re-emission is coloured by many reflections of the mean S.
"""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from ratfit.models._model import Model
from ratfit.models._schlick import Layer, azimuth, both_visible, distributed, layer, mirror, weighted_zenith, weights
from ratfit.models.directions import V_PRIME, U, V
from ratfit.models.schlick import DEFAULTS, SPECTRAL

ENDS = sp.Rational(1, 10)
"""hidden = r/(r + ENDS) times `hidden_shape`."""

COEFFICIENTS: Mapping[tuple[int, int, int], sp.Rational] = {
    powers: sp.Rational(number)
    for powers, number in {
        (0, 0, 0): "0.0373", (0, 0, 1): "-0.0191", (0, 1, 0): "-0.1182", (0, 1, 1): "-0.0156",
        (0, 2, 0): "0.5874", (0, 2, 1): "-0.0945", (1, 0, 0): "1.8656", (1, 0, 1): "-0.4022",
        (1, 1, 0): "-4.1481", (1, 1, 1): "1.5517", (1, 2, 0): "2.8747", (1, 2, 1): "-0.4644",
        (2, 0, 0): "-1.9010", (2, 0, 1): "0.4198", (2, 1, 0): "5.4458", (2, 1, 1): "-1.8688",
        (2, 2, 0): "-3.0681", (2, 2, 1): "0.7925",
    }.items()
}  # fmt: skip
"""Of v^i alpha^j p^k, with alpha = sqrt(r)."""

MEAN_POWER = sp.Rational(1, 21)
"""The mean of (1 - u)^5 over a hemisphere, weighted by the cosine."""


def roughness(r: sp.Expr) -> sp.Expr:
    """sqrt(r), at least 1e-6: its slope at 0 is infinite, and nothing is left of the facets there."""
    tiny = sp.Rational(1, 10**12)
    return sp.sqrt(sp.Piecewise((tiny, r < tiny), (r, True)))


def hidden_shape(v: sp.Expr, alpha: sp.Expr, p: sp.Expr) -> sp.Expr:
    """(1 - E(v)) (r + ENDS)/r, a polynomial over v + r."""
    return _polynomial(alpha, p, [sp.S.One, v, v**2]) / (v + alpha**2)


def hidden_shape_mean(alpha: sp.Expr, p: sp.Expr) -> sp.Expr:
    """The mean of `hidden_shape` over the hemisphere, weighted by the cosine."""
    r = alpha**2
    moments = [sp.log((1 + r) / r)]  # of v^n/(v + r)
    for n in (1, 2, 3):
        moments.append(sp.Rational(1, n) - r * moments[-1])
    return 2 * _polynomial(alpha, p, moments[1:])


def hidden(v: sp.Expr, r: sp.Expr, p: sp.Expr) -> sp.Expr:
    """1 - E(v), less than what facets hide or throw below the horizon, in any azimuth; r > 0."""
    return r / (r + ENDS) * hidden_shape(v, sp.sqrt(r), p)


def _polynomial(alpha: sp.Expr, p: sp.Expr, of_v: list[sp.Expr]) -> sp.Expr:
    """The polynomial in v, its powers of v being something else."""
    rows = [sum(c * alpha**j * p**k for (i, j, k), c in COEFFICIENTS.items() if i == n) for n in range(len(of_v))]
    return sp.Add(*(row * power for row, power in zip(rows, of_v, strict=True)))


def facets(layer: Layer) -> sp.Expr:
    """b times G G' Z A/(4 pi v v') with k = sqrt(r)/(1 + p) in place of r, of albedo 1 at most."""
    lobe = weighted_zenith(layer.r) * azimuth(layer.p)
    return lobe / (sp.pi * both_visible(roughness(layer.r) / (1 + layer.p)))


def reemitted(layer: Layer) -> sp.Expr:
    """b times the re-emission, without its colour."""
    alpha, p = roughness(layer.r), layer.p
    shape = hidden_shape(V, alpha, p) * hidden_shape(V_PRIME, alpha, p) / hidden_shape_mean(alpha, p)
    return weights(layer.r)[1] * layer.r / (layer.r + ENDS) * shape / sp.pi


def many_times(mean: sp.Expr, layer: Layer) -> sp.Expr:
    """What is left of light that comes out after two reflections or more, each by the mean S (kulla2017)."""
    alpha = roughness(layer.r)
    lost = alpha**2 / (alpha**2 + ENDS) * hidden_shape_mean(alpha, layer.p)
    return mean**2 * (1 - lost) / (1 - mean * lost)


def conserving(spectral: str, name: str) -> Model:
    """One layer that conserves energy: diffuser, facets with what they hide, and mirror, by the weights of Eq. 33."""
    s, where = SPECTRAL[spectral]
    one = layer("", sp.S.Zero)
    mean = one.c if spectral == "constant" else one.c + (1 - one.c) * MEAN_POWER
    single = s(U, one.c) * (weights(one.r)[0] / sp.pi + facets(one))
    return Model(
        name,
        f"Schlick's one layer with a re-emission that conserves energy: {spectral}",
        single + many_times(mean, one) * reemitted(one),
        tuple(one),
        f"schlick1994, Eqs. 22, 28, 32, 33 and {where[4:]}; kulla2017",
        {p.name: value for p, value in zip(one, DEFAULTS[0], strict=True)},
        s(V, one.c) * mirror(one.r),
        distribution=lambda: distributed(one),
        sampler="schlick",
        note="The albedo is at most 1, C = 1 included; the part of it that C = 1, p = 1 lose is 1.8 % at most.",
    )


CONSERVING: tuple[Model, ...] = (
    conserving("fresnel", "schlick-conserving"),
    conserving("constant", "schlick-23-conserving"),
)
