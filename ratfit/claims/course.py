"""The slides on reflectance for scan-line rendering (polimi2024): all but their D, F and G."""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp

from ratfit._lower import tape
from ratfit._target import parameter
from ratfit.brdf import fresnel
from ratfit.claims._agreement import AtLeast, AtMost, same
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import albedo, over_pairs
from ratfit.claims._models import LETTERS, V_PRIME, T, U, V, W, named

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


def by_reflect(light: sp.Matrix, normal: sp.Matrix) -> sp.Matrix:
    """-reflect(d, n) with GLSL's reflect(I, N) = I - 2 (N.I) N."""
    return -(light - 2 * normal.dot(light) * normal)


def is_mirror(formula: Callable[[sp.Matrix, sp.Matrix], sp.Matrix]) -> bool:
    """Whether a formula is r = 2 (d.n) n - d as a polynomial in the vectors."""
    return bool((formula(LIGHT, NORMAL) - mirrored(LIGHT, NORMAL)).expand() == sp.zeros(3, 1))


def half_angle_ratio(view: float, light: float) -> float:
    """The angle of the half vector to the normal over that of the view to the mirrored light, in one plane."""
    return abs(view + light) / 2 / abs(view + light)


def width(exponent: float, half: bool) -> float:
    """Where a highlight has fallen to a half, as an angle from the mirror direction in the plane of incidence."""
    import math

    angle = math.acos(0.5 ** (1 / exponent))
    return 2 * angle if half else angle


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


def highlights() -> tuple[float, ...]:
    """Phong's highlight with the exponent 5 along the mirror direction, and at 120 degrees to it."""
    from ratfit.models._scanline import highlight

    return tuple(float(highlight(sp.Rational(cosine), sp.Integer(5))) for cosine in (1, "-1/2"))


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


def ward_forms() -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """The exponential part of the slides' three forms, in t, w and the two roughnesses, times cos/sqrt(cos cos)."""
    along, across = sp.symbols("m n", positive=True)
    tangent2 = (1 - T**2) / T**2
    x2, y2 = (1 - T**2) * W**2, (1 - T**2) * (1 - W**2)  # (h.t)^2 and (h.b)^2
    first = sp.exp(-tangent2 * (W**2 / along**2 + (1 - W**2) / across**2)) * V_PRIME / sp.sqrt(V * V_PRIME)
    second = sp.exp(-(x2 / along**2 + y2 / across**2) / T**2) / sp.sqrt(V / V_PRIME)
    third = sp.exp((x2 / along**2 + y2 / across**2) / T**2) / sp.sqrt(V * V_PRIME) * V_PRIME
    return first, second, third


def symbols_of_summary() -> str:
    """The parameters that the summary of Cook and Torrance's model has, beside its colours."""
    names = {p.name for p in named("cook-torrance-beckmann-as-printed").parameters}
    letters = {"alpha": "rho", "f": "F0", "specular_share": "k"}
    return ", ".join(sorted(letters[name] for name in names & set(letters)))


def operations(formula: sp.Expr) -> float:
    """The operations of a formula in additions, each shared part once, as the cost model weighs them."""
    from ratfit._speed.cost_model import weight

    return weight(tape(formula, tuple(sorted(formula.free_symbols, key=str))), "float32")


def cosine_of_phong() -> sp.Expr:
    view = sp.Matrix(sp.symbols("v1:4", real=True))
    return mirrored(LIGHT, NORMAL).dot(view)


def cosine_of_blinn() -> sp.Expr:
    half = LIGHT + sp.Matrix(sp.symbols("v1:4", real=True))
    return half.dot(NORMAL) / sp.sqrt(half.dot(half))


def two_sums() -> tuple[sp.Expr, sp.Expr]:
    """Cook and Torrance's sum with the cosine inside both terms, and with the cosine in front."""
    k, diffuse, specular, product = sp.symbols("k m_D m_S DFG", positive=True)
    inside = k * diffuse * V_PRIME + (1 - k) * specular * product / (4 * V)
    return inside, V_PRIME * (k * diffuse + (1 - k) * specular * product / (4 * V_PRIME * V))


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

CLAIMS_OF_DIFFUSE = (
    Claim(
        "PM-energy",
        "BRDF models",
        "in most cases the functions used for scan-line rendering do not conserve energy",
        AtLeast(0.5),
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
        AtLeast(1.1),
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
    ),
)

CLAIMS_OF_SPECULAR = (
    Claim(
        "PM-phong-mirror",
        "Phong",
        "d + 2 (n (d.n) - d) is 2 (d.n) n - d",
        True,
        lambda: is_mirror(by_steps),
        how="as polynomials",
    ),
    Claim(
        "PM-phong-reflect",
        "Phong",
        "in GLSL the mirrored light is -reflect(d, n)",
        True,
        lambda: is_mirror(by_reflect),
        how="reflect(I, N) being I - 2 (N.I) N",
    ),
    Claim(
        "PM-phong-cut",
        "Phong",
        "the highlight is greatest along the mirror direction and 0 beyond 90 degrees from it",
        (1, 0),
        highlights,
        how="clamp of the cosine to a power, at 0 and 120 degrees",
    ),
    Claim(
        "PM-phong-exponent",
        "Phong",
        "the greater the exponent, the smaller the highlight",
        True,
        lambda: width(10, half=False) > width(50, half=False) > width(200, half=False),
        how="the angle at which it has fallen to a half, for exponents 10, 50 and 200",
    ),
    Claim(
        "PM-blinn-angle",
        "Blinn",
        "the angle between half vector and normal approximates that between view and mirrored light",
        1,
        lambda: half_angle_ratio(0.7, 0.4),
        how="their ratio with all vectors in a plane",
        instead=Reading(
            "it is half of it in a plane, which is why Blinn's highlights are wider",
            lambda: abs(half_angle_ratio(0.7, 0.4) - 0.5) < 1e-12 and abs(half_angle_ratio(-0.2, 1.1) - 0.5) < 1e-12,
        ),
    ),
    Claim(
        "PM-blinn-larger",
        "Blinn",
        "with the same exponent Blinn's highlight falls off over a larger area than Phong's",
        AtLeast(1.0),
        lambda: width(50, half=True) / width(50, half=False),
        how="ratio of the angles at which they have fallen to a half, exponent 50",
    ),
    Claim(
        "PM-blinn-cost",
        "Blinn",
        "Blinn's cosine costs more than Phong's, for its normalisation",
        AtLeast(1.0),
        lambda: operations(cosine_of_blinn()) / operations(cosine_of_phong()),
        how="ratio of operations, weighed as by `ratfit bench --backend cost-model`",
    ),
    Claim(
        "PM-ward-2",
        "Ward",
        "the form in angles and the form in dot products are equal",
        True,
        lambda: same(*ward_forms()[:2]),
        how="at 50 digits",
    ),
    Claim(
        "PM-ward-3",
        "Ward",
        "the form of many books is equal to the form in dot products",
        True,
        lambda: same(*ward_forms()[1:]),
        how="at 50 digits",
        instead=Reading(
            "its exponent has lost the minus sign, so it grows away from the normal; with it the forms are equal",
            lambda: same(ward_forms()[1], ward_forms()[2].replace(sp.exp, lambda power: sp.exp(-power))),
        ),
    ),
    Claim(
        "PM-ward-cost",
        "Ward",
        "the form of many books is less performant",
        "less performant",
        None,
        open="no machine is named: the form trades a quotient for two products, which some have faster and some not",
    ),
    Claim(
        "PM-ct-energy",
        "Cook-Torrance",
        "the diffuse part, balanced with the specular one, is physically accurate: white reflects at most all light",
        AtMost(1.0),
        lambda: reflected("cook-torrance-beckmann-as-printed", specular_share=0.0),
        how="the share reflected by the diffuse part alone",
        instead=Reading(
            "m_D has to be over pi, as D is: then white reflects all light",
            lambda: abs(reflected("cook-torrance-beckmann", specular_share=0.0) - 1) < 1e-6,
        ),
    ),
    Claim(
        "PM-ct-forms",
        "Cook-Torrance",
        "the sum with the cosine in each term and the one with the cosine in front are equal",
        two_sums()[0],
        lambda: two_sums()[1],
        how="at 50 digits",
    ),
    Claim(
        "PM-ct-specular-color",
        "Cook-Torrance",
        "the specular colour m_S says how much of each colour is reflected",
        S_COLOUR,
        lambda: S_COLOUR * fresnel.schlick(sp.S.One, F_NORMAL),
        how="at normal incidence, before D and G",
        readings=(
            Reading(
                "where F0 = 1: F0 says the same once more, so the colour is m_S F0",
                lambda: S_COLOUR * fresnel.schlick(sp.S.One, sp.S.One),
            ),
        ),
    ),
    Claim(
        "PM-ct-parameters",
        "Cook-Torrance, summary",
        "beside its two colours the model depends on F0, m and k",
        "F0, k, m",
        symbols_of_summary,
        how="the parameters of the summary's formulas",
        instead=Reading(
            "on F0, rho and k: roughness is called rho in all of its formulas",
            lambda: symbols_of_summary() == "F0, k, rho",
        ),
    ),
)

CLAIMS = (*CLAIMS_OF_DIFFUSE, *CLAIMS_OF_SPECULAR)
