"""Schlick's model with a re-emission that conserves energy: reciprocal, and its albedo is at most 1 everywhere.

What facets hide is given back as kulla2017 do it, (1 - E(v)) (1 - E(v'))/(pi (1 - E_mean)), in place of
(1 - G G')/(4 pi v v'), which grows without bound at grazing angles. Three things make the albedo at most 1:

- The masking is v/(v + k (1 - v)) with k = sqrt(r)/(1 + p) in place of r. With k = r (schlick1994, Eq. 31) facets alone
  reflect up to 2.6 times what they receive (r = 0.01, v = 0.01). With this k, G is below the exact masking of Z A in
  whatever azimuth: for p = 1 that of GGX, for p -> 0 that of slopes along one line, 1/(1 + x atan(x)/2) with
  x = sqrt(r (1 - v^2))/v, of which no other p comes below.
- That masking knows no azimuth, so facets reflect less along their scratches than across, and what they hide there has
  to come back there: it is bounded from below by T(v) + x^2 B(v), x the view's component along the tangent
  (`ratfit.models._hidden`). A reflectance in the letters t, u, v, v', w cannot have x and the light's x' apart, but
  their sum: (x + x')^2 = 4 u^2 (1 - t^2) w^2. That is enough, because in the mean over the light x x' is 0: the
  re-emission (A A'/A_mean + (x + x')^2 B B'/B_mean)/pi comes to A + (x^2 + s) B, with s the mean of x'^2 weighted by
  B' v'; so A is T - s B. What is left is what no square of x says: white surfaces lose at most 7.4 % of the light,
  those without scratches 1.9 %.
- Of two layers the lower one has what the upper one leaves, on the way in and on the way out. S(u) is
  C + (1 - C) (1 - u)^5, so what is left is 1 - C less (1 - C) E(v), E being the `sheen` of a layer with C = 0, and more
  by what the colour takes from the re-emission. The lesser of what is left at v and at v' is the lower layer's share:
  reciprocal, and what a mirror below a mirror has exactly. What the colour takes along the scratches is lost: B would
  need x apart.

Multiplied by S(u) <= 1 the facets reflect less; the re-emission is coloured by many reflections of the mean S.
"""

from __future__ import annotations

import sympy as sp

from ratfit.models import _hidden
from ratfit.models._model import Model
from ratfit.models._schlick import Layer, both_visible, distributed, layer, mirror, weighted_lobe, weights
from ratfit.models.directions import SINE2, V_PRIME, W2, U, V
from ratfit.models.schlick import DEFAULTS, SPECTRAL

MEAN_POWER = sp.Rational(1, 21)
"""The mean of (1 - u)^5 over a hemisphere, weighted by the cosine."""

TANGENTIAL = 4 * U**2 * SINE2 * W2
"""The square of the component of V + V' along the tangent."""


def roughness(r: sp.Expr) -> sp.Expr:
    """sqrt(r), at least 1e-6: its slope at 0 is infinite, and nothing is left of the facets there."""
    tiny = sp.Rational(1, 10**12)
    return sp.sqrt(sp.Piecewise((tiny, r < tiny), (r, True)))


def facets(layer: Layer) -> sp.Expr:
    """b times G G' Z A/(4 pi v v') with k = sqrt(r)/(1 + p) in place of r, of albedo 1 at most."""
    return weighted_lobe(layer).value / (sp.pi * both_visible(roughness(layer.r) / (1 + layer.p)))


def hidden(v: sp.Expr, x: sp.Expr, r: sp.Expr, p: sp.Expr) -> sp.Expr:
    """T + x^2 B, less than what facets hide or throw below the horizon; r > 0."""
    alpha = sp.sqrt(r)
    return r / (r + _hidden.ENDS) * (_hidden.across(v, alpha, p) + x**2 * (1 - p) * _hidden.along(v, alpha))


def hidden_mean(layer: Layer) -> sp.Expr:
    """The mean of T + x^2 B over the hemisphere, weighted by the cosine."""
    alpha, p = roughness(layer.r), layer.p
    whole = _hidden.across_mean(alpha, p) + (1 - p) * _hidden.along_mean_of_square(alpha)
    return alpha**2 / (alpha**2 + _hidden.ENDS) * whole


def reemitted(layer: Layer) -> sp.Expr:
    """b times the re-emission, without its colour."""
    alpha, p = roughness(layer.r), layer.p
    square, mean = _hidden.along_mean_of_square(alpha), _hidden.along_mean(alpha)
    rest = (1 - p) * square / mean
    seen, lit = (_hidden.across(v, alpha, p) - rest * _hidden.along(v, alpha) for v in (V, V_PRIME))
    even = seen * lit / (_hidden.across_mean(alpha, p) - (1 - p) * square)
    scratched = (1 - p) * TANGENTIAL * _hidden.along(V, alpha) * _hidden.along(V_PRIME, alpha) / mean
    return weights(layer.r)[1] * layer.r / (layer.r + _hidden.ENDS) * (even + scratched) / sp.pi


def many_times(mean: sp.Expr, layer: Layer) -> sp.Expr:
    """What is left of light that comes out after two reflections or more, each by the mean S (kulla2017)."""
    lost = hidden_mean(layer)
    return mean**2 * (1 - lost) / (1 - mean * lost)


def colour(spectral: str, layer: Layer) -> sp.Expr:
    """What the re-emission is multiplied by: less than 1, and than C + (1 - C)/441."""
    return many_times(layer.c if spectral == "constant" else layer.c + (1 - layer.c) * MEAN_POWER, layer)


def one_layer(spectral: str, layer: Layer) -> sp.Expr:
    """Diffuser, facets with what they hide, and mirror, by the weights of Eq. 33; the mirror is not of the formula."""
    single = SPECTRAL[spectral][0](U, layer.c) * (weights(layer.r)[0] / sp.pi + facets(layer))
    return single + colour(spectral, layer) * reemitted(layer)


def left(spectral: str, layer: Layer, v: sp.Expr) -> sp.Expr:
    """What the layer leaves of light that comes or goes at v, at least."""
    alpha, (_, b, c) = roughness(layer.r), weights(layer.r)
    hidden_at_least = b * layer.r / (layer.r + _hidden.ENDS) * _hidden.across(v, alpha, layer.p)
    taken = hidden_at_least * sp.Max(layer.c - colour(spectral, layer), 0)
    if spectral == "constant":
        return 1 - layer.c + taken
    return (1 - layer.c) * (1 - c * (1 - v) ** 5 - (1 - c) * _hidden.sheen(v, alpha)) + taken


def conserving(spectral: str, name: str, *, layers: int = 1) -> Model:
    """One layer that conserves energy, or two."""
    where = SPECTRAL[spectral][1]
    upper, lower = layer("", sp.S.Zero), layer("_prime", sp.S.Zero)

    def formula() -> sp.Expr:
        if layers == 1:
            return one_layer(spectral, upper)
        share = sp.Min(left(spectral, upper, V), left(spectral, upper, V_PRIME))
        return one_layer(spectral, upper) + share * one_layer(spectral, lower)

    def mirrors() -> sp.Expr:
        above, below = (SPECTRAL[spectral][0](V, each.c) * mirror(each.r) for each in (upper, lower))
        return above if layers == 1 else above + left(spectral, upper, V) * below

    parameters = (*upper, *lower)[: 3 * layers]
    return Model(
        name,
        f"Schlick's {'one layer' if layers == 1 else 'two layers'} with re-emissions that conserve energy: {spectral}",
        formula,
        parameters,
        f"schlick1994, Eqs. 22, 28, 32, 33 and {where[4:]}; kulla2017",
        dict(zip([p.name for p in parameters], DEFAULTS[0] + DEFAULTS[1], strict=False)),
        mirrors,
        distribution=(lambda: distributed(upper)) if layers == 1 else None,
        sampler="schlick",
        note="The albedo is at most 1."
        + (" For C = 1 it is 0.92 at least, 0.98 where p = 1 too." if layers == 1 else ""),
    )


CONSERVING: tuple[Model, ...] = (
    conserving("fresnel", "schlick-conserving"),
    conserving("constant", "schlick-23-conserving"),
    conserving("fresnel", "schlick-double-conserving", layers=2),
)
