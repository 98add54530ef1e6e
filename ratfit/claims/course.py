"""The slides on reflectance for scan-line rendering (polimi2024): all but their D, F and G."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy as sp

from ratfit.claims._agreement import AtLeast, AtMost, same
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import albedo, over_pairs
from ratfit.models import named
from ratfit.models.directions import LETTERS, V_PRIME, T, U, V, W
from ratfit.models.oren_nayar import SIGMA, A, B

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


def retroreflection() -> float:
    """How many times Oren and Nayar's model reflects to the light's side what it reflects to the other, at 60 degrees."""
    model = named("oren-nayar-as-printed").reflectance.subs(SIGMA, sp.Rational(1, 2))
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
