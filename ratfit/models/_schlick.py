"""The directional factors of Schlick's model, of one layer.

Z and A are those of `ratfit.brdf.distribution` without the limits at r = 0 and p = 0, where no layer comes. A division
is what the model costs, so a factor is one fraction, arranged so that float32 holds all of its products: what the
distribution is below its peak is a number from 1 to 1e30, what the cosines divide by one from 1e-36 to 1.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import sympy as sp

from ratfit._target import Parameter, parameter
from ratfit.models.directions import SINE2, T2, V_PRIME, W2, V

LOW, LOW_PRINTED = sp.Rational(1, 10**9), sp.Rational(1, 10**4)
"""Cosines below count as this where one divides by them, so that float32 holds the result; in print by more of them."""

NEARLY_MIRROR = sp.Rational(1, 10**12)
"""Z of a smaller r counts as that of this one: its lobe is narrower than float64 can tell directions apart."""

SMALLEST = sp.Rational(1, 10_000)
"""The least r of the factors that come to a Dirac at r = 0; with weights, a mirror takes the Dirac's place."""

SEEN, LIT = sp.Max(V, LOW), sp.Max(V_PRIME, LOW)
"""v and v', to divide by."""


@dataclass(frozen=True)
class Layer:
    """The parameters of a SINGLE material: reflection factor, roughness, isotropy."""

    c: Parameter
    r: Parameter
    p: Parameter

    def __iter__(self) -> Iterator[Parameter]:
        return iter((self.c, self.r, self.p))


Formula = Callable[[Layer, bool], sp.Expr]


@dataclass(frozen=True)
class Directional:
    """A directional factor, the least r it takes, and the share of a mirror that goes with it.

    The formula is a function of a layer and of whether the A in print is taken; for what is divided twice see `twice`.
    """

    formula: Formula
    source: str
    least: sp.Expr
    mirror: Callable[[sp.Expr], sp.Expr]
    is_divided_twice: bool = False


def layer(mark: str, least: sp.Expr) -> Layer:
    """The parameters of a layer, their names ending with the mark; r from the least on."""
    c, r = parameter(f"C{mark}", 0, 1), parameter(f"r{mark}", least, 1)
    return Layer(c, r, parameter(f"p{mark}", "1/1000", 1))


def weights(r: sp.Expr) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """The shares a of the diffuser, b of the facets and c of the mirror (schlick1994, Eq. 33)."""
    rest, rough = (1 - 2 * r) ** 2, r >= sp.S.Half
    return sp.Piecewise((rest, rough), (0, True)), 4 * r * (1 - r), sp.Piecewise((0, rough), (rest, True))


def no_mirror(r: sp.Expr) -> sp.Expr:
    """0."""
    return sp.S.Zero


def mirror(r: sp.Expr) -> sp.Expr:
    """c, the share of the mirror in Eq. 32."""
    return weights(r)[2]


# --- Z, A and G ---


@dataclass(frozen=True)
class Lobe:
    """A distribution Z A as its peak, of parameters alone, over how far below the peak it is, in the letters."""

    peak: sp.Expr
    below: sp.Expr

    @property
    def value(self) -> sp.Expr:
        return self.peak / self.below


def lobe(layer: Layer, *, printed: bool = False) -> Lobe:
    """Z A (schlick1994, Eq. 28), Z = r/(1 + r t^2 - t^2)^2 and A = p/(p^2 - p^2 w^2 + w^2), the A that keeps Eq. 27.

    In print A is the square root of that.
    """
    r, p = sp.Max(layer.r, NEARLY_MIRROR), layer.p
    zenith, azimuth = (T2 + SINE2 / r) ** 2, 1 - W2 + W2 / p**2
    return Lobe(1 / (r * sp.sqrt(p)), zenith * sp.sqrt(azimuth)) if printed else Lobe(1 / (r * p), zenith * azimuth)


def weighted_lobe(layer: Layer, *, printed: bool = False) -> Lobe:
    """b Z A/4 with the b of Eq. 33: finite for every r, and 0 for r = 0."""
    whole = lobe(layer, printed=printed)
    return Lobe((1 - layer.r) * layer.r * whole.peak, whole.below)


def distributed(layer: Layer, *, printed: bool = False) -> sp.Expr:
    """Z A/pi, the distribution of the normals of the facets per steradian."""
    return lobe(layer, printed=printed).value / sp.pi


def visible(v: sp.Expr, k: sp.Expr) -> sp.Expr:
    """v/G(v) = v + k (1 - v), of the masking of Eq. 31, k = r."""
    return v + k * (1 - v)


def both_visible(k: sp.Expr) -> sp.Expr:
    """v v'/(G(v) G(v'))."""
    return visible(SEEN, k) * visible(LIT, k)


def obstructed(r: sp.Expr) -> sp.Expr:
    """(1 - G(v) G(v')) v v'/(G(v) G(v')), written without the difference."""
    return r * (SEEN * (1 - LIT) + (1 - SEEN) * visible(LIT, r))


# --- D ---


def facets(layer: Layer, printed: bool) -> sp.Expr:
    """Z A/(4 pi v v') (schlick1994, Eq. 25)."""
    return lobe(layer, printed=printed).value / (4 * sp.pi * SEEN * LIT)


def reemitted(layer: Layer, printed: bool) -> sp.Expr:
    """(G G' Z A + 1 - G G')/(4 pi v v') (schlick1994, Eq. 30)."""
    return _with_obstructed(lobe(layer, printed=printed), layer.r, sp.S.One) / 4


def continuum_of_facets(layer: Layer, printed: bool) -> sp.Expr:
    """a/pi + b times `facets` (schlick1994, Eq. 32 with B = Z A, Eq. 33)."""
    return weights(layer.r)[0] / sp.pi + weighted_lobe(layer, printed=printed).value / (sp.pi * SEEN * LIT)


def continuum(layer: Layer, printed: bool) -> sp.Expr:
    """a/pi + b times `reemitted` (schlick1994, Eq. 32 with B = G G' Z A + 1 - G G', Eq. 33)."""
    diffuse, b, _ = weights(layer.r)
    return diffuse / sp.pi + _with_obstructed(weighted_lobe(layer, printed=printed), layer.r, b / 4)


def _with_obstructed(facets: Lobe, r: sp.Expr, weight: sp.Expr) -> sp.Expr:
    """(G G' B + weight (1 - G G'))/(pi v v') as one fraction, B being the lobe."""
    whole = facets.peak * SEEN * LIT + weight * obstructed(r) * facets.below
    return whole / (sp.pi * SEEN * LIT * both_visible(r) * facets.below)


def twice(right: Formula) -> Formula:
    """Eq. 32 to the letter, its B being "given by" Eq. 25 or 30: what is not a/pi is over 4 pi v v' once more."""

    def formula(layer: Layer, printed: bool) -> sp.Expr:
        diffuse = weights(layer.r)[0] / sp.pi
        once_more = (right(layer, printed) - diffuse) / (4 * sp.pi * SEEN * LIT)
        return diffuse + once_more.xreplace({SEEN: sp.Max(V, LOW_PRINTED), LIT: sp.Max(V_PRIME, LOW_PRINTED)})

    return formula


DIRECTIONAL: Mapping[str, Directional] = {
    "facets": Directional(facets, "Eq. 25", SMALLEST, no_mirror),
    "reemitted": Directional(reemitted, "Eq. 30", SMALLEST, no_mirror),
    "continuum-of-facets": Directional(
        continuum_of_facets, "Eqs. 25, 32, 33", sp.S.Zero, mirror, is_divided_twice=True
    ),
    "continuum": Directional(continuum, "Eqs. 30, 32, 33", sp.S.Zero, mirror, is_divided_twice=True),
}
