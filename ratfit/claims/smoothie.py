"""The smoothie article: its model, the approximate version, and what it says of energy."""

from __future__ import annotations

import itertools
from collections.abc import Iterable

import sympy as sp

from ratfit._parse import RatfitError, parse_expression
from ratfit._target import parameter
from ratfit.brdf import distribution
from ratfit.claims._agreement import ZERO, Above, AtLeast, AtMost, Below
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import albedo, over_pairs
from ratfit.claims._models import V_PRIME, T, U, V, named
from ratfit.claims._numbers import integral, largest, values

ALPHA, X = parameter("alpha", "1/10", 1), parameter("x", "1/10", "3/2")
THETA = parameter("theta", 0, sp.pi / 2)
ROUGHNESSES = (0.4, 0.6, 0.8, 1.0)
VIEWS = (0.02, 0.1, 0.3, 0.6, 1.0)

TEXT, CODE, APPROXIMATE = "smoothie-as-printed", "smoothie-code-as-printed", "smoothie-approximate-as-printed"


def reflected(name: str, view: float, roughness: float, factor: sp.Expr = sp.S.One) -> float:
    """The share of light that a model reflects with a Fresnel factor of 1."""
    return albedo(named(name).reflectance * factor, view, gloss=1.0, roughness=roughness)


def greatest(name: str, factor: sp.Expr = sp.S.One) -> float:
    return max(reflected(name, view, roughness, factor) for view in VIEWS for roughness in ROUGHNESSES)


def falls(found: Iterable[float]) -> bool:
    return all(later < earlier for earlier, later in itertools.pairwise(found))


def energy(alpha: float) -> float:
    """The article's integral of D at half the angle, by quadrature: 2 pi times that over theta."""
    spread = distribution.smoothie_as_printed(sp.cos(THETA / 2), ALPHA) * sp.sin(THETA) * sp.cos(THETA)
    return 2 * float(sp.pi) * integral(spread, THETA, 0.0, float(sp.pi / 2), {ALPHA: alpha})


def off_energy(formula: sp.Expr) -> float:
    """How far a formula in alpha is from that integral at most."""
    return max(abs(float(values(formula, {ALPHA: each})) - energy(each)) for each in (0.1, 0.3, 0.6, 1.0))


def energy_formula() -> sp.Expr | None:
    """The integral done, if it agrees with quadrature."""
    formula = distribution.smoothie_energy(ALPHA)
    return formula if off_energy(formula) < 1e-9 else None


LIGHT, VIEW = sp.symbols("theta_i theta_o", real=True)
"""Angles of light and view to the normal, in one plane with it, with signs."""


def largest_in_plane(formula: sp.Expr, low: float = -1.5, high: float = 1.5) -> float:
    """The greatest size of a formula in the two angles."""
    import numpy as np

    grid = np.linspace(low, high, 151)
    return largest(formula, {LIGHT: grid[:, None], VIEW: grid[None, :]})


def off_half_angle() -> float:
    """How far the sine of the half vector's angle, from the vectors, is from sin((theta_i + theta_o)/2)."""
    across, along = sp.sin(LIGHT) + sp.sin(VIEW), sp.cos(LIGHT) + sp.cos(VIEW)
    return largest_in_plane(across / sp.sqrt(across**2 + along**2) - sp.sin((LIGHT + VIEW) / 2))


def off_sine_of_sum() -> float:
    """How far the projected half vector's length is from sin(theta_i + theta_o) at most, on opposite sides."""
    return off_sine_on(-1)


def off_sine_on(side: int) -> float:
    """The same with the view on that side of the normal, the light being on the side 1."""
    import numpy as np

    angles = np.linspace(0, np.pi / 2, 151)
    difference = abs(sp.sin(LIGHT) + sp.sin(VIEW)) - abs(sp.sin(LIGHT + VIEW))
    return largest(difference, {LIGHT: angles[:, None], VIEW: side * angles[None, :]})


def off_product() -> float:
    """The same for 2 sin((theta_i + theta_o)/2) cos((theta_i - theta_o)/2)."""
    product = 2 * sp.sin((LIGHT + VIEW) / 2) * sp.cos((LIGHT - VIEW) / 2)
    return largest_in_plane(sp.sin(LIGHT) + sp.sin(VIEW) - product)


PROJECTED = 2 * U * sp.sqrt((1 - T) * (1 + T))
"""The length of h without its part along N."""

HH = 4 * U**2


def underestimate() -> tuple[float, float]:
    """The greatest and the mean difference of the projected length and 2 sin(theta_m) over pairs of directions."""
    found = over_pairs(PROJECTED - 2 * sp.sqrt((1 - T) * (1 + T)))
    return float(found.max()), float(found.mean())


def too_wide() -> tuple[float, float]:
    """The least ratio of the approximate version to D; its mean where view and light are low over where they are high.

    Low: both below 17 degrees over the horizon; high: both within 37 degrees of the normal.
    """
    found = over_pairs(ratio(APPROXIMATE) / HH)
    low, high = over_pairs(sp.Max(V, V_PRIME)) < 0.3, over_pairs(sp.Min(V, V_PRIME)) > 0.8
    return float(found.min()), float(found[low].mean() / found[high].mean())


def ratio(name: str) -> sp.Expr:
    """A version of the model over that of the text, for gloss 1/20 and roughness 3/5."""
    values_of = {"gloss": sp.Rational(1, 20), "roughness": sp.Rational(3, 5)}
    both = (named(each).reflectance for each in (name, TEXT))
    version, text = (each.subs({p: values_of[p.name] for p in named(TEXT).parameters}) for each in both)
    return version / text


def is_formula(text: str) -> bool:
    """Whether a text is a formula in x."""
    try:
        parse_expression(text, {"x": X}, "the listing")
    except RatfitError:
        return False
    return True


CLAIMS = (
    Claim(
        "SM-perceptual",
        "Microfacet Smoothie",
        "alpha = r^2 is a roughness that looks linear",
        "linear",
        None,
        open="a statement on what people see, for which the source gives no measurement",
    ),
    Claim(
        "SM-code",
        "Implementation",
        "the code computes the model of the text, D G F/(4 (N.L)(N.V))",
        ZERO,
        lambda: abs(over_pairs(ratio(CODE)) - 1).max(),
        how="greatest relative difference over pairs of directions",
        instead=Reading(
            "it takes the normalised H for h, and so loses the factor 1/(h.h) = 1/(4 u^2)",
            lambda: bool(abs(over_pairs(ratio(CODE) / HH) - 1).max() < 1e-9),
        ),
    ),
    Claim(
        "SM-listing",
        "Implementation",
        "the exponent of F can be computed as it is listed",
        True,
        lambda: is_formula("-1.71983 \u2013 5.43926*x"),
        how="read as a formula",
        instead=Reading(
            "with a minus sign in the place of the dash, here and wherever the listings subtract",
            lambda: is_formula("-1.71983 - 5.43926*x"),
        ),
    ),
    Claim(
        "SM-energy",
        "Normalization",
        "the microfacet version and the approximate one conserve energy",
        (AtMost(1.0), AtMost(1.0)),
        lambda: (greatest(TEXT), greatest(APPROXIMATE)),
        how="greatest share reflected with F = 1",
        readings=(
            Reading(
                "with the approximate version over pi, as where the colour of a light holds that factor",
                lambda: (greatest(TEXT), greatest(APPROXIMATE, 1 / sp.pi)),
            ),
        ),
    ),
    Claim(
        "SM-energy-code",
        "Normalization, Implementation",
        "the code of the microfacet version conserves energy",
        AtMost(1.0),
        lambda: greatest(CODE),
        how="greatest share reflected with F = 1",
        readings=(
            Reading("over pi, as where the colour of a light holds that factor", lambda: greatest(CODE, 1 / sp.pi)),
        ),
    ),
    Claim(
        "SM-energy-falls",
        "Normalization",
        "both versions lose energy as alpha grows",
        (True, True),
        lambda: tuple(
            all(falls(reflected(name, view, roughness) for roughness in ROUGHNESSES) for view in (0.3, 1.0))
            for name in (TEXT, APPROXIMATE)
        ),
        how="the share reflected at two angles, for four roughnesses",
        readings=(
            Reading(
                "at normal incidence",
                lambda: tuple(
                    falls(reflected(name, 1.0, roughness) for roughness in ROUGHNESSES) for name in (TEXT, APPROXIMATE)
                ),
            ),
        ),
    ),
    Claim(
        "SM-energy-masked",
        "Approximate Smoothie",
        "with G the approximate version would not conserve energy",
        Above(1.0),
        lambda: greatest(APPROXIMATE, 1 / HH),
        how="greatest share reflected with F = 1 and the factor 1/(h.h)",
    ),
    Claim(
        "SM-normalization",
        "Normalization",
        "the integral of D at half the angle is 1/2 + x^2 log x - x^2/2 log(1 + x^2), x standing for alpha",
        lambda: distribution.smoothie_energy_as_printed(ALPHA),
        energy_formula,
        how="a formula that agrees with quadrature at four alpha",
        instead=Reading(
            "pi (1 - alpha^2/2 log(1 + 2/alpha^2)), pi and not 1/2 at alpha = 0; the printed value is this over 2 pi "
            "for x = alpha/sqrt(2)",
            lambda: (
                energy(1e-4) > 3.14
                and off_energy(2 * sp.pi * distribution.smoothie_energy_as_printed(ALPHA / sp.sqrt(2))) < 1e-9
            ),
        ),
    ),
    Claim(
        "SM-sine-limit",
        "Approximate Smoothie",
        "sin(x)/x goes to 1 as x goes to 0",
        sp.S.One,
        lambda: sp.limit(sp.sin(X) / X, X, 0),
        how="symbolic",
    ),
    Claim(
        "SM-sine",
        "Approximate Smoothie",
        "on [0, pi/2] sin(x)/x does not deviate much from 1",
        AtMost(0.1),
        lambda: 1 - sp.sin(sp.pi / 2) / (sp.pi / 2),
        how="at pi/2",
        instead=Reading(
            "it stays within a tenth up to x = 0.78, about a half of that range",
            lambda: bool(1 - sp.sin(0.78) / 0.78 < 0.1 < 1 - sp.sin(0.8) / 0.8),
        ),
        word="not much",
    ),
    Claim(
        "SM-plane",
        "Approximate Smoothie",
        "with all vectors in a plane, sin(theta_m) = sin((theta_i + theta_o)/2)",
        ZERO,
        off_half_angle,
        how="greatest difference over angles with signs",
    ),
    Claim(
        "SM-project",
        "Approximate Smoothie",
        "there, the projection of i + o onto the surface has the length sin(theta_i + theta_o)",
        ZERO,
        off_sine_of_sum,
        how="greatest difference with light and view on opposite sides of the normal",
        instead=Reading(
            "it has the length sin(theta_i) + sin(theta_o) = 2 sin((theta_i + theta_o)/2) cos((theta_i - theta_o)/2), "
            "which is 2 sin(theta_m) near the mirror direction without any approximation of the sine; the found "
            "number is the greatest difference with light and view on opposite sides of the normal, on one side it "
            "reaches 2",
            lambda: off_product() < 1e-9 and abs(off_sine_on(1) - 2) < 1e-9,
        ),
    ),
    Claim(
        "SM-underestimates",
        "Approximate Smoothie",
        "in general the projected length underestimates sin(theta_m)",
        (AtMost(0.0), Below(0.0)),
        underestimate,
        how="the most by which it is above 2 sin(theta_m), over pairs of directions, and the mean",
    ),
    Claim(
        "SM-too-wide",
        "Approximate Smoothie",
        "the highlights of the approximate version are too wide, at grazing angles most",
        (AtLeast(1.0), Above(1.0)),
        too_wide,
        how="the least ratio to D over pairs of directions, and how many times the mean ratio near the normal it is "
        "towards the horizon",
    ),
)
