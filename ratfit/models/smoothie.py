"""Smoothie: a highlight with a long tail at the price of Blinn's, and its approximation without a square root."""

import sympy as sp

from ratfit._target import parameter
from ratfit.brdf import distribution, fresnel
from ratfit.models._model import Model
from ratfit.models.directions import HORIZON, SINE2, T, U

GLOSS = parameter("gloss", 0, 1)
ROUGHNESS = parameter("roughness", "1/100", 1)
PARAMETERS = (GLOSS, ROUGHNESS)
DEFAULTS = {"gloss": 0.05, "roughness": 0.4}

ALPHA = ROUGHNESS**2
FRESNEL = fresnel.smoothie(U, GLOSS)
H_SQUARED = 4 * sp.Max(U, HORIZON) ** 2
"""h.h of h = L + V, which is not normalised."""

PUNCTUAL = "Its albedo comes to pi, not 1, for small roughness: it is meant for lights whose colour holds the 1/pi."


def approximate() -> sp.Expr:
    """(alpha + |h - N (N.h)|^2/alpha)^-2: the tangential part of h has the length 2 u sin(theta_m)."""
    tangential = 4 * U**2 * SINE2
    return (ALPHA + tangential / ALPHA) ** -2


SMOOTHIE = Model(
    "smoothie",
    "Smoothie, normalised",
    lambda: FRESNEL * distribution.smoothie(T, ALPHA, SINE2) / H_SQUARED,
    PARAMETERS,
    "smoothie, Microfacet Smoothie, with the factor (4 + alpha^2)/pi that normalises its D",
    DEFAULTS,
    note="D F G/(4 v v') with G = 4 v v'/(h.h); gloss is the reflectance at normal incidence.",
    distribution=lambda: distribution.smoothie(T, ALPHA, SINE2),
    sampler="smoothie",
)

SMOOTHIE_AS_PRINTED = Model(
    "smoothie-as-printed",
    "Smoothie as its text prints it: D is not normalised",
    lambda: FRESNEL * distribution.smoothie_as_printed(T, ALPHA, SINE2) / H_SQUARED,
    PARAMETERS,
    "smoothie, Microfacet Smoothie",
    DEFAULTS,
    note="The integral of D times the cosine is pi/(4 + alpha^2) in place of 1.",
    distribution=lambda: distribution.smoothie_as_printed(T, ALPHA, SINE2),
    sampler="smoothie",
)

SMOOTHIE_CODE_AS_PRINTED = Model(
    "smoothie-code-as-printed",
    "Smoothie as its code computes it: it takes H for h and so loses h.h",
    lambda: FRESNEL * distribution.smoothie_as_printed(T, ALPHA, SINE2),
    PARAMETERS,
    "smoothie, Implementation",
    DEFAULTS,
    note=PUNCTUAL,
    distribution=lambda: distribution.smoothie_as_printed(T, ALPHA, SINE2),
    sampler="smoothie",
)

SMOOTHIE_APPROXIMATE = Model(
    "smoothie-approximate",
    "Approximate Smoothie, normalised",
    lambda: (1 + ALPHA**2) / sp.pi * FRESNEL * approximate(),
    PARAMETERS,
    "smoothie, Approximate Smoothie, with the factor (1 + alpha^2)/pi",
    DEFAULTS,
    note=(
        "The lobe falls with the distance of the projected directions: its albedo is an integral over the unit disc, "
        "greatest at normal incidence, where the factor makes it 1."
    ),
    sampler="smoothie",
)

SMOOTHIE_APPROXIMATE_AS_PRINTED = Model(
    "smoothie-approximate-as-printed",
    "Approximate Smoothie as printed",
    lambda: FRESNEL * approximate(),
    PARAMETERS,
    "smoothie, Approximate Smoothie",
    DEFAULTS,
    note=PUNCTUAL,
    sampler="smoothie",
)
