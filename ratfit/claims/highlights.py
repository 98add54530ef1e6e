"""The slides on reflectance for scan-line rendering: Phong, Blinn, Ward, and Cook and Torrance."""

from __future__ import annotations

import sympy as sp

from ratfit._lower import tape
from ratfit.brdf import fresnel
from ratfit.claims._agreement import Above, AtMost, same
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._models import V_PRIME, T, V, W, named
from ratfit.claims.course import F_NORMAL, LIGHT, NORMAL, S_COLOUR, by_steps, is_mirror, mirrored, reflected


def by_reflect(light: sp.Matrix, normal: sp.Matrix) -> sp.Matrix:
    """-reflect(d, n) with GLSL's reflect(I, N) = I - 2 (N.I) N."""
    return -(light - 2 * normal.dot(light) * normal)


def half_angle_ratio(view: float, light: float) -> float:
    """The angle of half vector and normal over that of view and mirrored light, from the vectors in a plane.

    view and light are their angles to the normal, with signs.
    """
    normal, towards, source = (sp.Matrix([sp.sin(angle), 0, sp.cos(angle)]) for angle in (0.0, view, light))
    mirror = mirrored(source, normal)
    return angle_between(towards + source, normal) / angle_between(mirror, towards)


def angle_between(a: sp.Matrix, b: sp.Matrix) -> float:
    return float(sp.acos(a.dot(b) / (a.norm() * b.norm())))


def width(exponent: float, half: bool) -> float:
    """Where a highlight has fallen to a half, as an angle from the mirror direction in the plane of incidence."""
    import math

    angle = math.acos(0.5 ** (1 / exponent))
    return 2 * angle if half else angle


def highlights() -> tuple[float, ...]:
    """Phong's highlight with the exponent 5 along the mirror direction, and at 120 degrees to it."""
    from ratfit.models._scanline import highlight

    return tuple(float(highlight(sp.Rational(cosine), sp.Integer(5))) for cosine in (1, "-1/2"))


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


CLAIMS = (
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
        Above(1.0),
        lambda: width(50, half=True) / width(50, half=False),
        how="ratio of the angles at which they have fallen to a half, exponent 50",
    ),
    Claim(
        "PM-blinn-cost",
        "Blinn",
        "Blinn's cosine costs more than Phong's, for its normalisation",
        Above(1.0),
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
