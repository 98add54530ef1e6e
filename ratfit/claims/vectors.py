"""Vectors in the slides: mirror direction, half vector, tangents, and what rounding makes of them."""

from __future__ import annotations

import sympy as sp

from ratfit.claims._agreement import ZERO, Above, AtLeast
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import over_pairs
from ratfit.claims._models import LETTERS, V_PRIME, T, U, V, named
from ratfit.claims._numbers import values
from ratfit.claims.course import LIGHT, NORMAL, is_mirror, mirrored


def by_words(light: sp.Matrix, normal: sp.Matrix) -> sp.Matrix:
    """n', the light's projection on the normal, taken from the light gives d'; the light and d' twice give r."""
    projection = normal * light.dot(normal)
    perpendicular = light - projection
    return light + 2 * perpendicular


def by_words_turned(light: sp.Matrix, normal: sp.Matrix) -> sp.Matrix:
    """The same with the light taken from its projection."""
    perpendicular = normal * light.dot(normal) - light
    return light + 2 * perpendicular


def mirror_laws() -> tuple[bool, bool, bool]:
    """Whether the mirror direction lies in the plane of light and normal, as steep as the light and across from it."""
    normal = sp.Matrix([0, 0, 1])
    mirror = mirrored(LIGHT, normal)
    flat = sp.Matrix.hstack(mirror, LIGHT, normal).det().expand() == 0
    steep = mirror.dot(normal) == LIGHT.dot(normal) and sp.expand(mirror.dot(mirror) - LIGHT.dot(LIGHT)) == 0
    across = mirror[:2] == [-each for each in LIGHT[:2]]
    return flat, bool(steep), across


def lambert_at(degrees: float) -> sp.Expr:
    """m_D max(cos, 0), the slides' formula, at an angle of the light, for m_D = 1."""
    return sp.Max(sp.cos(sp.rad(degrees)), 0)


def rounded_up() -> int:
    """How many of 1000 unit vectors in float32 have a product with themselves that is above 1."""
    import numpy as np

    draw = np.random.default_rng(1994).normal(size=(1000, 3)).astype(np.float32)
    x, y, z = (draw / np.sqrt((draw * draw).sum(-1, keepdims=True, dtype=np.float32))).T
    return int((x * x + y * y + z * z > 1).sum())


def is_real_above_one() -> bool:
    """Whether the slides' tangent has a real value for a cosine a little above 1."""
    return bool(sp.sqrt(1 - V**2).subs(V, 1 + sp.Rational(1, 2**23)).is_real)


def off_middle() -> float:
    """How far the cosine of half vector and view is from that of half vector and light at most, by the letters."""
    both = (V + V_PRIME) / (2 * T)  # N.(L + V) = |L + V| N.H, and |L + V| = 2 L.H only if H is in the middle
    return float(abs(over_pairs(both - U)).max())


def off_tangent() -> float:
    """How far sqrt(1 - c^2)/c is from the tangent of the angle at most, relative to it."""
    angle = sp.Symbol("theta", positive=True)
    quotient = sp.sqrt(1 - sp.cos(angle) ** 2) / sp.cos(angle) / sp.tan(angle) - 1
    return max(abs(float(sp.N(quotient.subs(angle, sp.Rational(k, 10)), 30))) for k in range(1, 16))


def projected_at_normal() -> sp.Expr:
    """The length of the light's part along the surface where the light falls along the normal."""
    along = LIGHT - LIGHT.dot(NORMAL) * NORMAL
    level = dict(zip([*LIGHT, *NORMAL], (0, 0, 1, 0, 0, 1), strict=True))
    return along.subs(level).norm()


def retro_term_at_normal() -> float:
    """What Oren and Nayar's model adds to A cos there, for sigma = 1/2."""
    from ratfit.models.oren_nayar import A

    model = named("oren-nayar")
    known = {p: {"albedo": 1.0, "sigma": 0.5}[p.name] for p in model.parameters}
    at = dict(zip(LETTERS, (0.75**0.5, 0.75**0.5, 0.5, 1.0, 1.0), strict=True))
    first = A.subs({p: value for p, value in known.items() if p.name == "sigma"})
    return float(values(model.reflectance.subs(known), at)) - float(first) / float(sp.pi)


CLAIMS = (
    Claim(
        "DP-half",
        "Microfacet BRDFs",
        "H = (L + V)/|L + V| is half way between light and view",
        ZERO,
        off_middle,
        how="greatest difference of its cosines to the two, over pairs of directions",
    ),
    Claim(
        "DP-tangent",
        "Microfacet BRDFs",
        "sqrt(1 - (v.N)^2)/(v.N) is the tangent of the angle to the normal",
        0,
        off_tangent,
        how="greatest relative difference at fifteen angles",
    ),
    Claim(
        "DP-G1-rounding",
        "G term",
        "v.N may round up above 1, where the formulas of G1 cannot be computed",
        AtLeast(1),
        lambda: 0 if is_real_above_one() else rounded_up(),
        how="how many of 1000 unit vectors in float32 have a product with themselves above 1; the tangent is not real "
        "there",
    ),
    Claim(
        "PM-lambert-ends",
        "Lambert",
        "the light that falls in is greatest at 0 degrees, and none from 90 degrees on",
        (1, 0, 0),
        lambda: tuple(lambert_at(degrees) for degrees in (0, 90, 120)),
        how="max(cos, 0) at 0, 90 and 120 degrees",
    ),
    Claim(
        "PM-oren-normalize",
        "Oren-Nayar",
        "the projections of light and view onto the surface can be normalised",
        Above(0.0, 1e-6),
        projected_at_normal,
        instead=Reading(
            "not where one of them is the normal: its projection has no length; the term with B is 0 there, as "
            "tan(beta) is 0",
            lambda: projected_at_normal() == 0 and abs(retro_term_at_normal()) < 1e-12,
        ),
    ),
    Claim(
        "PM-mirror",
        "Specular reflection",
        "a mirror sends light into the plane of light and normal, at the opposite angle",
        (True, True, True),
        mirror_laws,
        how="2 (d.n) n - d in the frame of n: in the plane, as long and as steep as the light, on the other side",
    ),
    Claim(
        "PM-phong-words",
        "Phong",
        "n' taken from the light vector gives d'; added twice to the light it gives the reflected vector",
        True,
        lambda: is_mirror(by_words),
        how="as polynomials",
        instead=Reading(
            "the light vector taken from n' gives d', as the formula below has it: n (d.n) - d",
            lambda: is_mirror(by_words_turned),
        ),
    ),
    Claim(
        "PM-phong-notation",
        "Phong",
        "with the arrow from x to l, r = 2 (xl.n) n - xl",
        True,
        lambda: is_mirror(lambda light, normal: mirrored(-light, normal)),
        how="xl being opposite to lx, which is the direction d of the light",
        readings=(
            Reading(
                "with lx in the place of xl, as the summary has it; the opposite vector would give -r",
                lambda: is_mirror(lambda light, normal: -mirrored(-light, normal)) and is_mirror(mirrored),
            ),
        ),
    ),
)
