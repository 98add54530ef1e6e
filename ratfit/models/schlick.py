"""Schlick's model whole: one layer or two, a spectral factor S(u) and a directional factor D(t, v, v', w) for each.

A layer has the reflection factor C, the roughness r (0 a mirror, 1 a diffuser) and the isotropy p (1 isotropic, towards
0 scratched along the tangent); the lower one C', r' and p'. `schlick` takes the factors by name: two spectral ones and
three directional ones make the six models of schlick1994, which `SCHLICK` holds, with those that its print has wrong.

What is wrong in print: the A of Eq. 28 does not keep Eq. 27 (its square does), and Eq. 32 divides by 4 pi v v' what
Eqs. 25 and 30 have divided already. What the right formulas cannot mend: every directional factor but the diffuser's
reflects more than it receives at grazing angles (for r up to 0.1 even the facets alone, masked by Eq. 31), and so do
two layers that conserve energy each, whose shares are taken at the half vector. `ratfit.models.conserving` mends both.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import sympy as sp

from ratfit._parse import RatfitError, nearest
from ratfit.brdf import fresnel
from ratfit.models._model import Model
from ratfit.models._schlick import DIRECTIONAL, distributed, layer, twice
from ratfit.models.directions import U, V

DEFAULTS = ((0.9, 0.2, 1.0), (0.4, 0.9, 1.0))
"""C, r and p of the upper layer and of the lower."""

Spectral = Callable[[sp.Expr, sp.Expr], sp.Expr]


def constant(u: sp.Expr, c: sp.Expr) -> sp.Expr:
    """The spectral factor that does not vary (schlick1994, Eq. 23)."""
    return c


SPECTRAL: Mapping[str, tuple[Spectral, str]] = {
    "constant": (constant, "Eq. 23"),
    "fresnel": (fresnel.schlick, "Eq. 24"),
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
    formula = twice(factor.formula) if printed and factor.is_divided_twice else factor.formula
    wrong = "A, Eq. 32" if factor.is_divided_twice else "A"
    title = f"Schlick's {'one layer' if layers == 1 else 'two layers'}: {spectral}, {directional}"
    parameters = tuple(p for material in materials for p in material)
    return Model(
        name or f"schlick({spectral}, {directional}, {layers})",
        f"{title}, as printed ({wrong})" if printed else title,
        lambda: layered([s(U, each.c) for each in materials], [formula(each, printed) for each in materials]),
        parameters,
        f"schlick1994, Eq. 22, {where}, {factor.source}",
        dict(zip([p.name for p in parameters], DEFAULTS[0] + DEFAULTS[1], strict=False)),
        lambda: layered([s(V, each.c) for each in materials], [factor.mirror(each.r) for each in materials]),
        distribution=(lambda: distributed(materials[0], printed=printed)) if layers == 1 else None,
        sampler="schlick",
    )


def layered(spectral: Sequence[sp.Expr], directional: Sequence[sp.Expr]) -> sp.Expr:
    """S D, or S D + (1 - S) S' D' (schlick1994, Eq. 22)."""
    upper = spectral[0] * directional[0]
    return upper if len(spectral) == 1 else upper + (1 - spectral[0]) * spectral[1] * directional[1]


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
