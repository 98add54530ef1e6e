"""Schlick's model whole: one layer or two, a spectral factor S(u) and a directional factor D(t, v, v', w) for each.

A layer has the reflection factor C, the roughness r (0 a mirror, 1 a diffuser) and the isotropy p (1 isotropic, towards
0 scratched along the tangent); the lower one C', r' and p'. `schlick` takes the factors by name: two spectral ones and
three directional ones make the six models of schlick1994, which `SCHLICK` holds, with those that its print has wrong.

What is wrong in print: the A of Eq. 28 does not keep Eq. 27 (its square does), and Eq. 32 divides by 4 pi v v' what
Eqs. 25 and 30 have divided already. What the right formulas cannot mend: every directional factor reflects more than
it receives at grazing angles, Eq. 25 too for r below 0.1, and so do two layers, whose shares are taken at the half
vector. `ratfit.models.conserving` has the model that does not.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from ratfit._parse import RatfitError, nearest
from ratfit._target import Parameter, parameter
from ratfit.brdf import distribution, fresnel
from ratfit.models._model import Model
from ratfit.models.cook_torrance import held
from ratfit.models.directions import V_PRIME, T, U, V, W

SMALLEST = sp.Rational(1, 10_000)
"""The least r of the factors that come to a Dirac at r = 0; with weights, a mirror takes the Dirac's place."""


PRINTED_HORIZON = sp.Rational(1, 10**8)
"""For the cosines that `printed_twice` divides by: so float32 can hold the result."""


NEARLY_MIRROR = sp.Rational(1, 10**12)
"""Z of a smaller r counts as that of this one: its lobe is narrower than float64 can tell directions apart."""


@dataclass(frozen=True)
class Layer:
    """The three parameters of a SINGLE material."""

    c: Parameter
    r: Parameter
    p: Parameter

    def __iter__(self) -> Any:
        return iter((self.c, self.r, self.p))


def layer(mark: str, least: sp.Expr) -> Layer:
    """The parameters of a layer, their names ending with the mark; r from the least on."""
    c, r = parameter(f"C{mark}", 0, 1), parameter(f"r{mark}", least, 1)
    return Layer(c, r, parameter(f"p{mark}", "1/1000", 1))


DEFAULTS = ((0.9, 0.2, 1.0), (0.4, 0.9, 1.0))
"""C, r and p of the upper layer and the lower."""


@dataclass(frozen=True)
class Directional:
    """A directional factor of a layer, and the share of a mirror that goes with it."""

    formula: Callable[[Layer, sp.Expr], sp.Expr]  # of the layer and its A
    printed: Callable[[Layer, sp.Expr], sp.Expr]
    source: str
    mirror: Callable[[Layer], sp.Expr] = lambda layer: sp.S.Zero
    least: sp.Expr = SMALLEST


def constant(cosine: sp.Expr, c: sp.Expr) -> sp.Expr:
    """The spectral factor that does not vary (schlick1994, Eq. 23)."""
    return c


SPECTRAL: Mapping[str, tuple[Callable[[sp.Expr, sp.Expr], sp.Expr], str]] = {
    "constant": (constant, "Eq. 23"),
    "fresnel": (fresnel.schlick, "Eq. 24"),
}


def visible(v: sp.Expr, r: sp.Expr) -> sp.Expr:
    """v/G(v) = v + r (1 - v), of the masking of Eq. 31."""
    return v + r * (1 - v)


def spread(t: sp.Expr, r: sp.Expr) -> sp.Expr:
    """r/(1 + r t^2 - t^2), whose square over r is Z(t) (schlick1994, Eq. 28), for r > 0."""
    return r / (r * t**2 + (1 - t) * (1 + t))


def weighted(t: sp.Expr, r: sp.Expr) -> sp.Expr:
    """b Z(t)/4 with the b of Eq. 33: finite for every r, and 0 for r = 0, where the mirror takes the Dirac's place."""
    least = sp.Max(r, NEARLY_MIRROR)
    return (1 - r) * r / least * spread(t, least) ** 2


def obstructed(r: sp.Expr) -> sp.Expr:
    """(1 - G(v) G(v'))/(r G(v) G(v')), written without the difference."""
    v, v_prime = held(V), held(V_PRIME)
    once = v * (1 - v_prime) + v_prime * (1 - v) + r * (1 - v) * (1 - v_prime)
    return once / (v * v_prime)


def masked(r: sp.Expr) -> sp.Expr:
    """G(v) G(v')/(v v')."""
    return 1 / (visible(held(V), r) * visible(held(V_PRIME), r))


def weights(r: sp.Expr) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """The shares a of the diffuser, b of the facets and c of the mirror (schlick1994, Eq. 33)."""
    rest = (1 - 2 * r) ** 2
    rough = r >= sp.S.Half
    return sp.Piecewise((rest, rough), (0, True)), 4 * r * (1 - r), sp.Piecewise((0, rough), (rest, True))


def facets(layer: Layer, azimuth: sp.Expr) -> sp.Expr:
    """Z A/(4 pi v v') (schlick1994, Eq. 25)."""
    return distribution.zenith(T, layer.r) * azimuth / (4 * sp.pi * held(V) * held(V_PRIME))


def reemitted(layer: Layer, azimuth: sp.Expr) -> sp.Expr:
    """(G G' Z A + 1 - G G')/(4 pi v v') (schlick1994, Eq. 30)."""
    whole = distribution.zenith(T, layer.r) * azimuth + layer.r * obstructed(layer.r)
    return masked(layer.r) / (4 * sp.pi) * whole


def continuum(layer: Layer, azimuth: sp.Expr) -> sp.Expr:
    """a/pi + b times `reemitted` (schlick1994, Eq. 32, with B = G G' Z A + 1 - G G')."""
    a, b, _ = weights(layer.r)
    whole = weighted(T, layer.r) * azimuth + b * layer.r / 4 * obstructed(layer.r)
    return a / sp.pi + masked(layer.r) / sp.pi * whole


def continuum_of_facets(layer: Layer, azimuth: sp.Expr) -> sp.Expr:
    """a/pi + b times `facets` (schlick1994, Eq. 32, with B = Z A)."""
    a, _, _ = weights(layer.r)
    return a / sp.pi + weighted(T, layer.r) * azimuth / (sp.pi * held(V) * held(V_PRIME))


def printed_twice(formula: Callable[[Layer, sp.Expr], sp.Expr]) -> Callable[[Layer, sp.Expr], sp.Expr]:
    """Eq. 32 to the letter, its B being "given by" Eq. 25 or 30: what is not a/pi is over 4 pi v v' once more."""

    def to_the_letter(layer: Layer, azimuth: sp.Expr) -> sp.Expr:
        diffuse = weights(layer.r)[0] / sp.pi
        cosines = {held(cosine): held(cosine, PRINTED_HORIZON) for cosine in (V, V_PRIME)}
        return diffuse + ((formula(layer, azimuth) - diffuse) / (4 * sp.pi * held(V) * held(V_PRIME))).xreplace(cosines)

    return to_the_letter


def mirror(layer: Layer) -> sp.Expr:
    """c, the share of the mirror in Eq. 32."""
    return weights(layer.r)[2]


DIRECTIONAL: Mapping[str, Directional] = {
    "facets": Directional(facets, facets, "Eq. 25"),
    "reemitted": Directional(reemitted, reemitted, "Eq. 30"),
    "continuum-of-facets": Directional(
        continuum_of_facets, printed_twice(continuum_of_facets), "Eqs. 25, 32, 33", mirror, sp.S.Zero
    ),
    "continuum": Directional(continuum, printed_twice(continuum), "Eqs. 30, 32, 33", mirror, sp.S.Zero),
}


def schlick(
    spectral: str = "fresnel", directional: str = "continuum", *, layers: int = 1, printed: bool = False, name: str = ""
) -> Model:
    """Schlick's model of these factors (schlick1994, Eq. 22).

    **Arguments:** names in `SPECTRAL` and `DIRECTIONAL`; layers, 1 for a SINGLE material and 2 for a DOUBLE one;
    printed, whether the A of Eq. 28 and Eq. 32 are taken to the letter; a name for the model.

    **Returns** a model with the parameters C, r, p, and for two layers C_prime, r_prime, p_prime. **Fails** with
    `RatfitError` for a name that is in no table, or another number of layers.
    """
    for table, chosen in ((SPECTRAL, spectral), (DIRECTIONAL, directional)):
        if chosen not in table:
            raise RatfitError(f"no factor {chosen!r}{nearest(chosen, table)}; there are: {', '.join(table)}")
    if layers not in (1, 2):
        raise RatfitError(f"{layers} layers: a material has 1 (SINGLE) or 2 (DOUBLE)")
    s, where = SPECTRAL[spectral]
    factor = DIRECTIONAL[directional]
    materials = [layer(mark, factor.least) for mark in ("", "_prime")[:layers]]
    azimuth = distribution.azimuth_as_printed if printed else distribution.azimuth
    formula = factor.printed if printed else factor.formula
    return Model(
        name or f"schlick({spectral}, {directional}, {layers})",
        f"Schlick's {'one layer' if layers == 1 else 'two layers'}: {spectral}, {directional}",
        layered(s, U, materials, [formula(each, azimuth(W, each.p)) for each in materials]),
        tuple(p for each in materials for p in each),
        f"schlick1994, Eq. 22, {where}, {factor.source}",
        {
            p.name: value
            for each, known in zip(materials, DEFAULTS, strict=False)
            for p, value in zip(each, known, strict=True)
        },
        layered(s, V, materials, [factor.mirror(each) for each in materials]),
    )


def layered(
    s: Callable[[sp.Expr, sp.Expr], sp.Expr], cosine: sp.Expr, materials: list[Layer], factors: list[sp.Expr]
) -> sp.Expr:
    """S D, or S D + (1 - S) S' D' (schlick1994, Eq. 22); the cosine is u, or v for what a mirror reflects."""
    upper = s(cosine, materials[0].c)
    if len(materials) == 1:
        return upper * factors[0]
    return upper * factors[0] + (1 - upper) * s(cosine, materials[1].c) * factors[1]


SCHLICK: tuple[Model, ...] = (
    schlick(name="schlick"),
    schlick(layers=2, name="schlick-double"),
    schlick("constant", "facets", name="schlick-23-25"),
    schlick("constant", "reemitted", name="schlick-23-30"),
    schlick("constant", "continuum", name="schlick-23-32"),
    schlick("fresnel", "facets", name="schlick-24-25"),
    schlick("fresnel", "reemitted", name="schlick-24-30"),
    schlick("fresnel", "facets", printed=True, name="schlick-24-25-as-printed"),
    schlick("fresnel", "reemitted", printed=True, name="schlick-24-30-as-printed"),
    schlick(printed=True, name="schlick-as-printed"),
    schlick(layers=2, printed=True, name="schlick-double-as-printed"),
)
"""The six models, `schlick` being that of Eqs. 24 and 32; two layers; and what is printed."""
