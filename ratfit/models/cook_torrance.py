"""Micro-facet models after Cook and Torrance: a diffuse share, and facets by three factors D, F and G.

The lobe of the facets is D F G/(4 v v'), with D normalised to 1 (schlick1994's D is pi times that, so its 4 pi v v' is
the same). `cook_torrance` takes each factor by its name; `COOK_TORRANCE` holds those that have a name of their own.

One roughness `alpha` serves both D and G: the two-dimensional RMS slope of Gaussian surfaces, GGX's own alpha, Blinn's
rho. schlick1994 writes m for it in its Eqs. 20 and 21, and again for the slope along one axis, alpha/sqrt(2), in Eqs.
18 and 19: the maskings `smith` and `schlick` are right about that, the `-as-printed` ones take alpha for both.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from ratfit._parse import RatfitError, nearest
from ratfit._target import Parameter, parameter
from ratfit.brdf import distribution, fresnel, masking
from ratfit.models._mixture import DIFFUSE, SHARE, SPECULAR, mixture
from ratfit.models._model import Model
from ratfit.models.directions import HORIZON, SINE2, V_PRIME, T, U, V

ALPHA = parameter("alpha", "1/100", 1)
EXPONENT = parameter("exponent", 0, 10_000)
ETA, KAPPA = parameter("eta", "1/100", 10), parameter("kappa", 0, 20)
F_NORMAL = parameter("f", 0, 1)

DEFAULTS: Mapping[Parameter, float] = {
    ALPHA: 0.3, EXPONENT: 20.0, ETA: 1.5, KAPPA: 0.0, F_NORMAL: 0.04, DIFFUSE: 0.5, SPECULAR: 1.0, SHARE: 0.5,
}  # fmt: skip
"""Every parameter of these models, in the order in which a model lists its own: glass, somewhat rough."""


@dataclass(frozen=True)
class Factor:
    """One choice for D, F or G/(v v'). The formula is made once, when a model asks for it: some take sympy long."""

    make: Callable[[], sp.Expr]
    source: str
    parameters: tuple[Parameter, ...] = ()

    @cached_property
    def formula(self) -> sp.Expr:
        return self.make()


def held(cosine: sp.Expr, least: sp.Expr = HORIZON) -> sp.Expr:
    """A cosine above the horizon, to divide by."""
    return sp.Max(cosine, least)


def _both(g: Callable[[], sp.Expr]) -> Callable[[], sp.Expr]:
    return lambda: g() / (held(V) * held(V_PRIME))


def _each(one_sided: Callable[[sp.Expr, sp.Expr], sp.Expr], roughness: sp.Expr) -> Callable[[], sp.Expr]:
    return _both(lambda: masking.separable(one_sided, V, V_PRIME, roughness))


AXIS = ALPHA / sp.sqrt(2)

DISTRIBUTIONS: Mapping[str, Factor] = {
    "beckmann": Factor(lambda: distribution.beckmann(T, ALPHA, SINE2), "schlick1994, Eq. 20", (ALPHA,)),
    "beckmann-rational": Factor(lambda: distribution.beckmann_rational(T, ALPHA), "schlick1994, Eq. 21", (ALPHA,)),
    "ggx": Factor(lambda: distribution.ggx(T, ALPHA, SINE2), "microfacet, D term; polimi2024", (ALPHA,)),
    "phong": Factor(lambda: distribution.phong(T, EXPONENT), "microfacet, D term", (EXPONENT,)),
    "blinn": Factor(lambda: distribution.blinn(T, ALPHA), "polimi2024, D", (ALPHA,)),
}
SAMPLED_AS = {"beckmann-rational": "ggx"}
"""The sampler of a distribution that has none of its own name."""

FRESNELS: Mapping[str, Factor] = {
    "conductor": Factor(lambda: fresnel.conductor(U, ETA, KAPPA), "schlick1994, Eq. 13", (ETA, KAPPA)),
    "dielectric": Factor(lambda: fresnel.dielectric(U, ETA), "microfacet, F term", (ETA,)),
    "spectral": Factor(
        lambda: fresnel.spectral(fresnel.conductor(U, ETA, KAPPA), fresnel.normal(ETA, KAPPA), F_NORMAL),
        "schlick1994, Eq. 14",
        (ETA, KAPPA, F_NORMAL),
    ),
    "schlick": Factor(lambda: fresnel.schlick(U, F_NORMAL), "schlick1994, Eq. 15; microfacet; polimi2024", (F_NORMAL,)),
}
MASKINGS: Mapping[str, Factor] = {
    "torrance-sparrow": Factor(
        _both(lambda: masking.torrance_sparrow(T, U, V, V_PRIME)), "schlick1994, Eq. 16; polimi2024"
    ),
    "smith": Factor(_each(masking.smith, AXIS), "schlick1994, Eqs. 17 and 18, by smith1967", (ALPHA,)),
    "smith-as-printed": Factor(_each(masking.smith_as_printed, ALPHA), "schlick1994, Eqs. 17 and 18", (ALPHA,)),
    "schlick": Factor(_each(masking.schlick, AXIS), "schlick1994, Eqs. 17 and 19", (ALPHA,)),
    "schlick-as-printed": Factor(_each(masking.schlick, ALPHA), "schlick1994, Eqs. 17 and 19", (ALPHA,)),
    "beckmann": Factor(_each(masking.beckmann, ALPHA), "walter2007, Eq. 26", (ALPHA,)),
    "beckmann-rational": Factor(_each(masking.beckmann_rational, ALPHA), "microfacet, G term (Beckmann)", (ALPHA,)),
    "phong": Factor(_each(masking.phong, EXPONENT), "microfacet, G term (Phong)", (EXPONENT,)),
    "ggx": Factor(_each(masking.ggx, ALPHA), "microfacet, G term (GGX); polimi2024", (ALPHA,)),
    "ggx-correlated": Factor(_both(lambda: masking.ggx_correlated(V, V_PRIME, ALPHA)), "heitz2014, Eq. 99", (ALPHA,)),
    "kelemen": Factor(
        _both(lambda: masking.kelemen(U, V, V_PRIME)), "microfacet, visibility, the better approximation"
    ),
    "implicit": Factor(lambda: sp.S.One, "microfacet, visibility, the simple approximation"),
}
"""G/(v v') by name."""


@dataclass(frozen=True)
class Sum:
    """How the lobe and a diffuse share make a model: with weights that add up to 1, or both in full."""

    formula: Callable[[sp.Expr], sp.Expr]
    source: str
    parameters: tuple[Parameter, ...]
    note: str = ""


POLIMI = "polimi2024, with k = 1 - specular_share"
COSINE = "The source's f contains the cosine to the light, a reflectance does not."

SUMS: Mapping[str, Sum] = {
    "schlick1994": Sum(
        lambda lobe: (1 - SHARE) * DIFFUSE / sp.pi + SHARE * lobe, "schlick1994, Eq. 8", (DIFFUSE, SHARE)
    ),
    "microfacet": Sum(lambda lobe: DIFFUSE / sp.pi + lobe, "microfacet", (DIFFUSE,)),
    "polimi2024": Sum(mixture, POLIMI, (DIFFUSE, SPECULAR, SHARE), COSINE),
    "polimi2024-as-printed": Sum(
        lambda lobe: (1 - SHARE) * DIFFUSE + SHARE * SPECULAR * lobe,
        POLIMI,
        (DIFFUSE, SPECULAR, SHARE),
        f"{COSINE} D has its 1/pi there and the diffuse share none: white reflects pi times what falls on it.",
    ),
}


def cook_torrance(
    distribution: str, fresnel: str, masking: str, added: str = "schlick1994", *, name: str = "", title: str = ""
) -> Model:
    """The micro-facet model of these factors.

    **Arguments:** names in `DISTRIBUTIONS`, `FRESNELS`, `MASKINGS` and `SUMS`; `name` and `title` of the model, made of
    those names where they are left out.

    **Returns** a model whose parameters are those that its factors have. **Fails** with `RatfitError` for a name that
    is in no table.
    """
    for table, chosen in ((DISTRIBUTIONS, distribution), (FRESNELS, fresnel), (MASKINGS, masking), (SUMS, added)):
        if chosen not in table:
            raise RatfitError(f"no factor {chosen!r}{nearest(chosen, table)}; there are: {', '.join(table)}")
    d, f, g, how = DISTRIBUTIONS[distribution], FRESNELS[fresnel], MASKINGS[masking], SUMS[added]
    made_of = f"{distribution}, {fresnel}, {masking}"
    parts = (how, d, f, g)
    parameters = tuple(p for p in DEFAULTS if any(p in part.parameters for part in parts))
    return Model(
        name or f"cook-torrance({made_of}, {added})",
        title or f"Micro-facets: {made_of}",
        lambda: how.formula(d.formula * f.formula * g.formula / 4),
        parameters,
        "; ".join(part.source for part in parts),
        {p.name: DEFAULTS[p] for p in parameters},
        note=how.note,
        distribution=lambda: d.formula,
        sampler=SAMPLED_AS.get(distribution, distribution),
    )


COOK_TORRANCE: tuple[Model, ...] = tuple(
    cook_torrance(*choice, name=name, title=title)
    for name, title, choice in (
        ("cook-torrance", "Cook-Torrance by the true formulas", ("beckmann", "conductor", "smith")),
        ("cook-torrance-as-printed", "Cook-Torrance, with Smith's function as schlick1994 prints it",
         ("beckmann", "conductor", "smith-as-printed")),
        ("cook-torrance-1981", "Cook-Torrance, with its first masking and Fresnel's factor by colour",
         ("beckmann", "spectral", "torrance-sparrow")),
        ("cook-torrance-optimised", "Cook-Torrance by rational approximations",
         ("beckmann-rational", "schlick", "schlick")),
        ("cook-torrance-optimised-as-printed", "Cook-Torrance by rational approximations, one m for both slopes",
         ("beckmann-rational", "schlick", "schlick-as-printed")),
        ("microfacet", "Micro-facets, the starter set", ("phong", "schlick", "kelemen", "microfacet")),
        ("microfacet-phong", "Micro-facets after Phong", ("phong", "schlick", "phong", "microfacet")),
        ("microfacet-beckmann", "Micro-facets after Beckmann",
         ("beckmann", "schlick", "beckmann-rational", "microfacet")),
        ("microfacet-ggx", "Micro-facets after Trowbridge and Reitz (GGX)", ("ggx", "schlick", "ggx", "microfacet")),
        ("microfacet-ggx-glass", "The same, with the exact Fresnel factor of a dielectric",
         ("ggx", "dielectric", "ggx", "microfacet")),
        ("cook-torrance-beckmann", "Cook-Torrance for shading: Beckmann, V-grooves",
         ("beckmann", "schlick", "torrance-sparrow", "polimi2024")),
        ("cook-torrance-blinn", "Cook-Torrance for shading: Blinn, V-grooves",
         ("blinn", "schlick", "torrance-sparrow", "polimi2024")),
        ("cook-torrance-ggx", "Cook-Torrance for shading: GGX", ("ggx", "schlick", "ggx", "polimi2024")),
        ("cook-torrance-beckmann-as-printed", "Cook-Torrance for shading, the diffuse share without 1/pi",
         ("beckmann", "schlick", "torrance-sparrow", "polimi2024-as-printed")),
    )
)  # fmt: skip
"""The choices of the four sources."""
