"""The Fresnel factor: section 4.2 of schlick1994."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy as sp

from ratfit._target import parameter
from ratfit.brdf import fresnel, metals
from ratfit.claims._agreement import AtLeast, AtMost
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._models import made
from ratfit.claims._numbers import midpoints, values
from ratfit.claims.method import derived

U, F = parameter("u", 0, 1), parameter("f", 0, 1)

ETA, KAPPA = parameter("eta", "11/10", 4), parameter("kappa", 0, 6)

Material = tuple[sp.Expr, sp.Expr]
"""Index and extinction coefficient, exact."""

YELLOW = sp.Rational("0.5821")
"""The wavelength of the tables' row nearest to 589 nm, in micrometres."""


def of_index(*indices: str) -> tuple[Material, ...]:
    return tuple((sp.Rational(index), sp.S.Zero) for index in indices)


def of_metals(*names: str) -> tuple[Material, ...]:
    return tuple(metals.material(name).at(YELLOW) for name in names)


DIELECTRICS = of_index("2.417", "1.5")
"""Diamond and glass."""

COMMON = of_index("1.33", "1.4", "1.5")
"""The indices that the smoothie article names."""


def of_figure_5() -> tuple[Material, ...]:
    """Diamond, glass, copper and gold, in yellow light."""
    return (*DIELECTRICS, *of_metals("copper", "gold"))


def all_materials() -> tuple[Material, ...]:
    return (*DIELECTRICS, *of_index("1.33"), *of_metals("copper", "gold", "silver", "aluminium", "iron"))


def curve(material: Material, u: Any) -> Any:
    """The true factor at many u."""
    return values(made(fresnel.conductor, U, ETA, KAPPA), {U: u, **_constants(material)})


def _constants(material: Material) -> dict[sp.Symbol, float]:
    return {ETA: float(material[0]), KAPPA: float(material[1])}


def normal(material: Material) -> sp.Expr:
    return fresnel.normal(*material)


def from_refraction(material: Material, u: sp.Expr) -> Any:
    """The mean of the reflected parts of both polarisations, from Snell's law with a complex index; 40 digits."""
    import mpmath

    with mpmath.workdps(40):
        cosine, eta, kappa = (mpmath.mpf(each.p) / each.q for each in (u, *material))
        index = mpmath.mpc(eta, kappa)
        inside = mpmath.sqrt(1 - (1 - cosine**2) / index**2)
        across = (cosine - index * inside) / (cosine + index * inside)
        along = (index * cosine - inside) / (index * cosine + inside)
        return (abs(across) ** 2 + abs(along) ** 2) / 2


def is_fresnel(formula: Callable[[sp.Expr, Material], sp.Expr], materials: tuple[Material, ...]) -> bool:
    """Whether a formula agrees with refraction to 30 digits, for every material at five angles."""
    return all(
        abs(sp.N(formula(u, each), 40) - sp.Float(from_refraction(each, u), 40)) < 1e-30
        for each in materials
        for u in (sp.Rational(k, 11) for k in (1, 3, 5, 8, 10))
    )


def least_at_grazing() -> float:
    """The least of Eq. 13 for all materials where the light all but grazes, u = 1e-30."""
    tiny = sp.Rational(1, 10**30)
    return min(float(sp.N(fresnel.conductor_as_printed(tiny, *each), 60)) for each in all_materials())


def derivative_at_normal(order: int) -> float:
    """The greatest size of a derivative of the true factor by u, at u = 1, over all materials; by differences."""
    import mpmath

    formula = sp.lambdify((U, ETA, KAPPA), fresnel.conductor_as_printed(U, ETA, KAPPA), "mpmath")
    with mpmath.workdps(40):
        constants = [[mpmath.mpf(each.p) / each.q for each in material] for material in all_materials()]
        return max(abs(float(mpmath.diff(lambda u, each=each: formula(u, *each), 1, order))) for each in constants)


def flat_index() -> sp.Expr:
    """The one index above 1 of a dielectric whose second derivative vanishes at u = 1."""
    index = sp.Symbol("n", positive=True)
    second = sp.diff(fresnel.dielectric_as_printed(U, index), U, 2).subs(U, 1)
    (root,) = [each for each in sp.solve(sp.numer(sp.together(second)), index) if each > 1]
    return root


def shape(material: Material) -> Any:
    """The curve from 0 at normal incidence to 1 at grazing: (F - f)/(1 - f), over u."""
    f = float(normal(material))
    return (curve(material, midpoints()) - f) / (1 - f)


def spread_of_shapes(materials: tuple[Material, ...]) -> float:
    """How far the shapes of the curves of some materials are apart at most."""
    import numpy as np

    shapes = np.array([shape(each) for each in materials])
    return float((shapes.max(0) - shapes.min(0)).max())


def spread_of_levels(materials: tuple[Material, ...]) -> float:
    levels = [float(normal(each)) for each in materials]
    return max(levels) - min(levels)


def spectral_at(formula: Callable[..., sp.Expr], f: float) -> Any:
    """Eq. 14 or its clamped form at the normal reflectance f, for all materials."""
    import numpy as np

    average = sp.Symbol("average", real=True)
    level = parameter("level", 0, 1)
    scaled = formula(average, level, F)
    u = midpoints(count=2000)
    return np.array([values(scaled, {average: curve(each, u), level: normal(each), F: f}) for each in all_materials()])


def is_clamped(f: float) -> bool:
    """Whether Eq. 14, clamped, stays in [f, 1] for all materials."""
    found = spectral_at(fresnel.spectral, f)
    return bool(found.min() >= f - 1e-12 and found.max() <= 1 + 1e-12)


def exponents() -> str:
    """The exponents that the four conditions leave, as an interval, or the one."""
    free = derived("eq15").free
    return ", ".join(f"({low}, {high})" for low, high in free.values()) or str(derived("eq15").chosen)


def keeps(exponent: int) -> bool:
    """Whether f + (1 - f) (1 - u)**exponent keeps the four conditions of Eq. 15."""
    power = F + (1 - F) * (1 - U) ** exponent
    return all(sp.expand(sp.diff(power, U, order).subs(U, at) - demand) == 0 for order, at, demand in KEEPS)


def falls_with_u(materials: tuple[Material, ...]) -> bool:
    """Whether the reflected part grows all the way from normal to grazing incidence."""
    import numpy as np

    return all(bool(np.all(np.diff(curve(each, midpoints())) < 0)) for each in materials)


KEEPS = (
    (0, sp.S.Zero, sp.S.One),
    (0, sp.S.One, F),
    (1, sp.S.One, sp.S.Zero),
    (2, sp.S.One, sp.S.Zero),
)
"""Order, place and value of the four conditions of Eq. 15."""


CLAIMS = (
    Claim(
        "S-13",
        "Eq. 13",
        "Eq. 13 is the reflected part of unpolarised light at an interface with a complex index",
        True,
        lambda: is_fresnel(lambda u, each: fresnel.conductor_as_printed(u, *each), all_materials()),
        how="against Snell's law and both polarisations, eight materials, five angles, 30 digits",
    ),
    Claim(
        "S-13-grazing",
        "Section 4.2",
        "whatever the material, all light is reflected at grazing incidence: F(0) = 1",
        (1, 1),
        lambda: (sp.limit(fresnel.dielectric_as_printed(U, ETA), U, 0), least_at_grazing()),
        how="the limit for a dielectric of any index, and the least of eight materials at u = 1e-30; at u = 0 Eq. 13 "
        "itself divides by 0",
    ),
    Claim(
        "S-14-ends",
        "Eq. 14",
        "Eq. 14 gives f at normal incidence and 1 at grazing incidence",
        (F, sp.S.One),
        lambda: (fresnel.spectral_as_printed(F / 2, F / 2, F), fresnel.spectral_as_printed(sp.S.One, F / 2, F)),
        how="symbolic",
    ),
    Claim(
        "S-14-range",
        "Eqs. 4, 14",
        "(implied) the Fresnel factor is in [0, 1], so Eq. 14 is not below 0 for any f in [0, 1]",
        AtLeast(0.0),
        lambda: spectral_at(fresnel.spectral_as_printed, 0.04).min(),
        how="least value over eight materials",
        instead=Reading(
            "Eq. 14 falls below f, and below 0 for small f, for metals whose factor first falls before it rises to 1 "
            "(here aluminium at f = 0.04); clamped to f it stays in [f, 1]",
            lambda: is_clamped(0.04),
        ),
    ),
    Claim(
        "S-4.2-shape",
        "Section 4.2, Figure 5",
        "the curves of different materials have much the same shape and differ mainly in their value at u = 1",
        "much the same",
        None,
        readings=(
            Reading(
                "the shapes (F - f)/(1 - f) of diamond, glass, copper and gold are apart by less than a quarter "
                "of what their values f are apart by",
                lambda: spread_of_shapes(of_figure_5()) / spread_of_levels(of_figure_5()),
                AtMost(0.25),
            ),
        ),
        open="much the same means no number",
    ),
    Claim(
        "S-4.2-F0",
        "Section 4.2",
        "first condition: the Fresnel factor is 1 at u = 0",
        1,
        lambda: min(float(curve(each, 0.0)) for each in all_materials()),
        how="least of eight materials, by the factor arranged so that it has a value there",
    ),
    Claim(
        "S-4.2-F1",
        "Section 4.2",
        "third condition: the Fresnel factor has slope 0 at normal incidence, F'(1) = 0",
        0,
        lambda: derivative_at_normal(1),
        how="greatest size over eight materials",
    ),
    Claim(
        "S-4.2-F2",
        "Section 4.2",
        "fourth condition: the second derivative of the Fresnel factor is 0 at normal incidence, F''(1) = 0",
        0,
        lambda: derivative_at_normal(2),
        instead=Reading(
            "for a dielectric it vanishes at the index 2 + sqrt(3) alone; the found number is its greatest size over "
            "eight materials",
            lambda: bool(sp.simplify(flat_index() - 2 - sp.sqrt(3)) == 0),
        ),
    ),
    Claim(
        "S-15-keeps",
        "Eq. 15",
        "Eq. 15 keeps the four conditions",
        (True, True, True, True),
        lambda: tuple(
            sp.diff(fresnel.schlick(U, F), U, order).subs(U, at) - demand == 0 for order, at, demand in KEEPS
        ),
        how="symbolic",
    ),
    Claim(
        "S-15-exponent",
        "Eq. 15",
        "the four conditions lead to the exponent 5",
        "5",
        lambda: exponents(),
        instead=Reading(
            "they ask for an exponent above 2 and leave it open; 3 gives the smallest polynomial, 5 is a fit",
            lambda: derived("eq15").status == "family" and exponents() == "(2, oo)" and keeps(3) and not keeps(2),
        ),
    ),
    Claim(
        "S-3-proportion",
        "Section 3, Figure 2",
        "a varnish reflects more as the angle of incidence grows: most light at large angles, little at small ones",
        (True, AtLeast(0.5), AtMost(0.5)),
        lambda: (falls_with_u(DIELECTRICS), *(float(curve(DIELECTRICS[1], cosine)) for cosine in (0.05, 1.0))),
        how="F of diamond and glass falls in u all the way; glass at 87 degrees and at normal incidence",
        word="most, little",
    ),
)
