"""Colours in the slides on reflectance for scan-line rendering: several lights, tone curves, metals."""

from __future__ import annotations

import sympy as sp

from ratfit.brdf import fresnel, metals
from ratfit.claims._agreement import Above, AtLeast, AtMost
from ratfit.claims._claim import Claim
from ratfit.claims._models import V_PRIME, named

RED, BLUE = (sp.Rational(length, 100) for length in (65, 45))
"""Wavelengths in micrometres."""


def of_two_lights() -> float:
    """The colour of a white surface under two white lights, each 30 degrees from the normal."""
    white = named("oren-nayar-as-printed")
    lit = {p: {"diffuse": 1, "sigma": 0}[p.name] for p in white.parameters}
    one = (white.reflectance * V_PRIME).subs(lit).subs(V_PRIME, sp.cos(sp.pi / 6))
    return float(2 * one.subs(dict.fromkeys(one.free_symbols, sp.S.Half)))


def tone_curve() -> tuple[float, float, bool]:
    """The least and the greatest value of Reinhard's curve on light up to 10^6, and whether it rises all the way."""
    import numpy as np

    from ratfit.models.tone import reinhard

    shown = reinhard(np.concatenate([[0.0], np.logspace(-6, 6, 200)]))
    return float(shown.min()), float(shown.max()), bool(np.all(np.diff(shown) > 0))


def redness(name: str) -> float:
    """What a metal reflects along the normal in red over what it reflects in blue."""
    red, blue = (sp.N(fresnel.normal(*metals.material(name).at(length))) for length in (RED, BLUE))
    return float(red / blue)


CLAIMS = (
    Claim(
        "PM-lights",
        "Color range",
        "with several lights the colour of a pixel can be above 1",
        Above(1.0),
        of_two_lights,
        how="a white matt surface under two white lights at 30 degrees",
    ),
    Claim(
        "PM-hdr-curve",
        "High dynamic range",
        "a non-linear function can map all light from 0 on into [0, 1]",
        (AtLeast(0.0), AtMost(1.0), True),
        tone_curve,
        how="Reinhard's light/(1 + light): least and greatest value, and that it rises",
    ),
    Claim(
        "PM-metal-colour",
        "Specular reflection",
        "the specular colour of gold and copper is not white but that of the metal",
        (Above(1.0), Above(1.0)),
        lambda: (redness("gold"), redness("copper")),
        how="what they reflect along the normal at 650 nm over that at 450 nm, by their measured constants",
    ),
    Claim(
        "PM-metal-diffuse",
        "Specular reflection",
        "the specular colour of metals is identical to their diffuse one",
        "identical",
        None,
        open="a metal lets no light in that could come out as a diffuse part, so there is no diffuse colour to compare",
    ),
)
