"""The slides on reflectance for scan-line rendering (polimi2024): colours, Lambert, Oren and Nayar."""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp

from ratfit._target import parameter
from ratfit.claims._agreement import Above, AtMost
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import albedo, over_pairs
from ratfit.claims._models import LETTERS, V_PRIME, U, V, named

PRINTED = (
    "oren-nayar-as-printed",
    "phong-as-printed",
    "blinn-as-printed",
    "ward-as-printed",
    "cook-torrance-beckmann-as-printed",
)

WHITE = {
    "diffuse": 1.0, "specular": 1.0, "sigma": 0.5, "exponent": 50.0, "m": 0.3, "n": 0.3, "alpha": 0.3, "f": 1.0,
    "specular_share": 0.5,
}  # fmt: skip
"""A white object, in the parameters of all models."""


def reflected(name: str, view: float = 0.5, **changed: float) -> float:
    """The share of light that a model as printed reflects, white, at an angle of view."""
    model = named(name)
    known = {**WHITE, **changed}
    return albedo(model.reflectance, view, **{p.name: known[p.name] for p in model.parameters})


def share_that_gains() -> float:
    """The share of the printed models that reflect more than falls on them."""
    return sum(reflected(name) > 1 + 1e-6 for name in PRINTED) / len(PRINTED)


def greatest_value(*names: str) -> float:
    """The greatest value of the slides' f, the cosine to the light included, for a specular colour of 1."""
    found = []
    for name in names:
        model = named(name)
        known = {**WHITE, "diffuse": 0.0, "specular_share": 1.0}
        values = {p.name: known[p.name] for p in model.parameters}
        found.append(float(over_pairs(model.reflectance * V_PRIME, **values).max()))
    return max(found)


VECTORS = (sp.symbols("n1:4", real=True), sp.symbols("d1:4", real=True))

NORMAL, LIGHT = (sp.Matrix(each) for each in VECTORS)


def mirrored(light: sp.Matrix, normal: sp.Matrix) -> sp.Matrix:
    """r = 2 (d.n) n - d."""
    return 2 * light.dot(normal) * normal - light


def by_steps(light: sp.Matrix, normal: sp.Matrix) -> sp.Matrix:
    """r = d + 2 (n (d.n) - d)."""
    return light + 2 * (normal * light.dot(normal) - light)


def is_mirror(formula: Callable[[sp.Matrix, sp.Matrix], sp.Matrix]) -> bool:
    """Whether a formula is r = 2 (d.n) n - d as a polynomial in the vectors."""
    return bool((formula(LIGHT, NORMAL) - mirrored(LIGHT, NORMAL)).expand() == sp.zeros(3, 1))


SIGMA = parameter("sigma", 0, sp.pi / 2)


def _oren_nayar() -> sp.Expr:
    return named("oren-nayar-as-printed").reflectance


def shares_of_oren_nayar() -> tuple[sp.Expr, sp.Expr]:
    """A and B of Oren and Nayar's model: its value with no retro-reflection, and what that adds, over its angles."""
    from ratfit.models.oren_nayar import A, B

    return A, B


def slopes_of_oren_nayar() -> tuple[sp.Expr, sp.Expr]:
    """How A and B change with sigma, at sigma = 0.7."""
    a, b = (sp.diff(each, SIGMA).subs(SIGMA, sp.Rational(7, 10)) for each in shares_of_oren_nayar())
    return a, b


def clamped() -> tuple[float, ...]:
    from ratfit.models.tone import clamp

    return tuple(float(each) for each in clamp([-1.0, 0.5, 2.0]))


def retroreflection() -> float:
    """What Oren and Nayar's model reflects towards the light over what it reflects away from it, at 60 degrees."""
    model = _oren_nayar().subs(SIGMA, sp.Rational(1, 2))
    back, forth = ({U: 1, V: 0.5, V_PRIME: 0.5}, {U: 0.5, V: 0.5, V_PRIME: 0.5})
    return float(model.subs(back).subs("diffuse", 1).evalf() / model.subs(forth).evalf())


def table_is_direct() -> float:
    """How far the tabled form of Oren and Nayar's model is from the direct one, at cosines above 1/10."""
    import numpy as np

    names = ("oren-nayar", "oren-nayar-tabled")
    direct, tabled = (over_pairs(named(name).reflectance, albedo=1.0, sigma=0.5) for name in names)
    near = over_pairs(sp.Min(V, V_PRIME)) > 0.1
    return float(np.abs(direct - tabled)[near].max())


def lambert_density(degrees: float) -> float:
    """The probability density of reflection at an angle to the normal over that along it, for a constant value."""
    import math

    constant = named("lambert").reflectance
    return float((constant * sp.cos(math.radians(degrees))) / (constant * sp.cos(0)))


def memory_ratio() -> float:
    """Bytes of a float32 over those of an unsigned integer of 8 bits."""
    import numpy as np

    return np.dtype("float32").itemsize / np.dtype("uint8").itemsize


D_COLOUR, S_COLOUR, F_NORMAL = sp.symbols("m_D m_S F0", positive=True)


CLAIMS = (
    Claim(
        "PM-energy",
        "BRDF models",
        "in most cases the functions used for scan-line rendering do not conserve energy",
        Above(0.5),
        share_that_gains,
        how="the share of five printed models that, white, reflect more than falls on them, at 60 degrees",
    ),
    Claim(
        "PM-range",
        "Color range",
        "the values of both components are in general in [0, 1]",
        AtMost(1.0),
        lambda: greatest_value("phong-as-printed", "blinn-as-printed", "ward-as-printed", PRINTED[-1]),
        readings=(
            Reading(
                "for Phong and Blinn; Ward's and Cook and Torrance's go beyond 1 for smooth surfaces",
                lambda: greatest_value("phong-as-printed", "blinn-as-printed"),
            ),
        ),
    ),
    Claim(
        "PM-clamp",
        "Color range",
        "clamp takes -1, 1/2 and 2 to 0, 1/2 and 1",
        (0, 0.5, 1),
        clamped,
        how="the function of the slides",
    ),
    Claim(
        "PM-hdr",
        "High dynamic range",
        "HDR needs four times the memory",
        4,
        None,
        readings=(Reading("of float32 for each colour in place of one byte; float16 needs twice", memory_ratio),),
        open="no format is named",
    ),
    Claim(
        "PM-lambert-uniform",
        "Lambert",
        "a constant function reflects with the same probability in all directions",
        1,
        lambda: lambert_density(60.0),
        how="density at 60 degrees over that along the normal",
        instead=Reading(
            "with the same radiance; the probability goes with the cosine, the found number is that at 60 degrees",
            lambda: abs(lambert_density(60.0) - 0.5) < 1e-12 and not named("lambert").reflectance.has(*LETTERS),
        ),
    ),
    Claim(
        "PM-lambert-cosine",
        "Lambert",
        "light received is light sent times cos(alpha), from the area dA/cos(alpha) that it is spread over",
        sp.Symbol("S") * sp.cos(sp.Symbol("alpha")),
        lambda: sp.solve(sp.Symbol("R") / sp.cos(sp.Symbol("alpha")) - sp.Symbol("S"), sp.Symbol("R"))[0],
        how="the printed balance solved",
    ),
    Claim(
        "PM-lambert-view",
        "Lambert",
        "the colour does not depend on where one looks from",
        0,
        lambda: len(named("lambert").reflectance.free_symbols & set(LETTERS)),
        how="the number of the cosines that the model depends on",
    ),
    Claim(
        "PM-lambert-brdf",
        "Lambert",
        "the reflectance of Lambert's model is m_D max(cos, 0), although it is constant",
        0,
        lambda: len((D_COLOUR * sp.Max(V_PRIME, 0)).free_symbols & set(LETTERS)),
        how="the number of the cosines that it depends on",
        readings=(
            Reading(
                "the cosine of the rendering equation is counted in: what is left is constant",
                lambda: len(sp.simplify(D_COLOUR * sp.Max(V_PRIME, 0) / V_PRIME).free_symbols & set(LETTERS)),
            ),
        ),
    ),
    Claim(
        "PM-lambert-white",
        "Lambert",
        "in white light an object has the colour m_D",
        D_COLOUR,
        lambda: D_COLOUR * V_PRIME,
        how="m_D times the cosine to the light",
        readings=(Reading("where the light falls along the normal", lambda: (D_COLOUR * V_PRIME).subs(V_PRIME, 1)),),
    ),
    Claim(
        "PM-oren-lambert",
        "Oren-Nayar",
        "for sigma = 0 the model becomes Lambert's: A = 1, B = 0",
        (1, 0),
        lambda: tuple(each.subs(SIGMA, 0) for each in shares_of_oren_nayar()),
        how="exact",
    ),
    Claim(
        "PM-oren-rough",
        "Oren-Nayar",
        "with sigma the share of Lambert's principle, A, falls and that of retro-reflection, B, grows",
        (True, True),
        lambda: (
            bool(slopes_of_oren_nayar()[0] < 0),
            bool(slopes_of_oren_nayar()[1] > 0),
        ),
        how="signs of the derivatives, which have no zero for sigma > 0",
    ),
    Claim(
        "PM-oren-retro",
        "Oren-Nayar",
        "the model reflects back to where the light comes from",
        Above(1.0),
        retroreflection,
        how="towards the light over away from it, at 60 degrees and sigma = 1/2",
    ),
    Claim(
        "PM-oren-table",
        "Oren-Nayar",
        "a table of sin(alpha) tan(beta) over the two cosines can stand for the formula",
        AtMost(0.02),
        table_is_direct,
        how="greatest difference for cosines above 1/10, with 64 by 64 entries between which it is bilinear",
        word="can stand for",
    ),
)
