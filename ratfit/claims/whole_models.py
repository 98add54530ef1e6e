"""Whole models of schlick1994 and of its sources against the laws, by the measurements of `ratfit check-model`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ratfit.claims._agreement import Above, AtLeast, AtMost
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._models import named
from ratfit.claims.background import asymmetry as asymmetry_of

if TYPE_CHECKING:
    from ratfit.models import Model

ANGLES = 16
"""Angles of view from 0 to 89.6 degrees."""

CLOSE = 1e-3
"""To within this albedos are measured."""

NEW = ("schlick-24-25-as-printed", "schlick-24-30-as-printed", "schlick-as-printed", "schlick-double-as-printed")
"""The new model with Eq. 25, with Eq. 30, with Eq. 32, and of two layers, to the letter."""

THEORETICAL = ("cook-torrance-1981", "he", "ward-as-printed")
"""The models that section 2 starts from."""

Setting = dict[str, float]

ROUGH_WHITE: Sequence[Setting] = tuple(
    {"C": 1.0, "r": r, "p": p} for r in (0.05, 0.2, 0.5, 0.8, 1.0) for p in (1.0, 0.2)
)

WHITE_FACETS: Sequence[Setting] = tuple(
    {"alpha": alpha, "f": 1.0, "diffuse": 1.0, "specular_share": 1.0} for alpha in (0.1, 0.3, 0.6, 1.0)
)

WHITE_WARD: Sequence[Setting] = tuple({"m": m, "n": m, "specular": 1.0, "specular_share": 1.0} for m in (0.1, 0.2, 0.5))

SCRATCHED: Setting = {"m": 1.0, "n": 0.05, "specular": 1.0, "specular_share": 1.0}

METAL: Sequence[Setting] = tuple(
    {"alpha": alpha, "sigma": 0.2, "eta": 0.2, "kappa": 3.5, "specular_share": 1.0} for alpha in (0.3, 0.6, 1.0)
)
"""Nearly white: silver."""


def brightest(name: str, settings: Sequence[Setting]) -> float:
    """The greatest share of light that a model reflects, over angles of view and settings."""
    from ratfit.models.albedo import albedo, angles

    model = named(name)
    return max(float(albedo(model, angles(ANGLES), tolerance=CLOSE, **each).values.max()) for each in settings)


def asymmetry(names: Sequence[str]) -> float:
    """The greatest relative change of models when view and light change places, over directions and parameters."""
    from ratfit.models.laws.reciprocity import reciprocity

    return max(reciprocity(named(name), {}, 0).found or 0.0 for name in names)


def changed(model: Model) -> float:
    """The same for one model at its defaults, over pairs of directions."""
    return asymmetry_of(model.reflectance, **{p.name: float(model.defaults[p.name]) for p in model.parameters})


def keeps_energy(name: str, settings: Sequence[Setting]) -> bool:
    return brightest(name, settings) <= 1 + CLOSE


def of_layers(name: str, lower: float) -> float:
    """What two layers reflect at most, the upper one clear and smooth (a mirror by Eq. 24 with C = 0)."""
    return brightest(name, [{"C": 0.0, "r": 0.0, "C_prime": lower, "r_prime": 1.0}])


def albedos_near_mirror(r: float) -> list[float]:
    """What Eq. 25 reflects of light at four angles up to 73 degrees, for C = p = 1."""
    from ratfit.models.albedo import albedo

    return [float(each) for each in albedo(named("schlick-23-25"), [1.0, 0.7, 0.5, 0.3], C=1.0, r=r, p=1.0).values]


def off_mirror(r: float) -> float:
    """How far that is from all of it at most."""
    return max(abs(each - 1) for each in albedos_near_mirror(r))


CLAIMS = (
    Claim(
        "S-1-empirical",
        "Section 1",
        "empirical models (Phong's, Blinn's) lack the energy conservation law, for instance",
        (Above(1.0), Above(1.0)),
        lambda: tuple(
            brightest(name, [{"diffuse": 1.0, "specular": 1.0, "exponent": 50.0}])
            for name in ("phong-as-printed", "blinn-as-printed")
        ),
        how="the greatest share that they reflect in white, exponent 50",
    ),
    Claim(
        "S-2-reciprocal",
        "Section 2",
        "the theoretical models keep Helmholtz's reciprocity",
        0,
        lambda: max(changed(named(name)) for name in THEORETICAL),
        how="greatest relative change of Cook and Torrance's, He's and Ward's when view and light change places",
    ),
    Claim(
        "S-2-energy",
        "Sections 1, 2",
        "(implied) the models of Cook and Torrance and of He and others keep the energy law",
        (AtMost(1.0, CLOSE),) * 2,
        lambda: (brightest("cook-torrance-1981", WHITE_FACETS), brightest("he", METAL)),
        how="greatest share that they reflect: white facets, and silver",
    ),
    Claim(
        "S-10-energy",
        "Sections 1, 2.3",
        "(implied) Ward's model keeps the energy law",
        AtMost(1.0, CLOSE),
        lambda: brightest("ward-as-printed", [*WHITE_WARD, SCRATCHED]),
        readings=(
            Reading(
                "without scratches, for m = n up to 1/2; with m = 1 and n = 1/20, white, it reflects more than it "
                "receives along the scratches",
                lambda: brightest("ward-as-printed", WHITE_WARD),
            ),
        ),
    ),
    Claim(
        "S-32-reciprocal",
        "Section 5",
        "the new model keeps Helmholtz's reciprocity, with Eqs. 25, 30 and 32 and of two layers",
        0,
        lambda: asymmetry(NEW),
        how="greatest relative change when view and light change places, over directions and parameters",
    ),
    Claim(
        "S-32-energy",
        "Abstract, section 5",
        "the new model keeps the energy conservation law",
        AtMost(1.0, CLOSE),
        lambda: brightest("schlick-as-printed", ROUGH_WHITE),
        readings=(
            Reading(
                "with 1/(4 pi v v') once in Eq. 32, and A as Eq. 27 needs it",
                lambda: brightest("schlick", ROUGH_WHITE),
            ),
        ),
        instead=Reading(
            "neither the print nor the model with its misprints mended does; with less masking and with what facets "
            "hide given back by E(v) E(v'), as in `schlick-conserving`, the same white surfaces reflect at most 1",
            lambda: keeps_energy("schlick-conserving", ROUGH_WHITE),
        ),
    ),
    Claim(
        "S-22-layers",
        "Eq. 22",
        "two layers that keep the energy law make a material that does",
        AtMost(1.0, CLOSE),
        lambda: of_layers("schlick-double", 1.0),
        instead=Reading(
            "S(u) is taken at the half vector, so 1 - S(u) is not what the upper layer lets through: a clear mirror "
            "over a white diffuser, each with at most 1, come to nearly 2 towards the horizon",
            lambda: (
                keeps_energy("schlick", [{"C": 0.0, "r": 0.0}])
                and keeps_energy("schlick", [{"C": 1.0, "r": 1.0}])
                and of_layers("schlick-double", 1.0) > 1.9
            ),
        ),
    ),
    Claim(
        "S-25-mirror",
        "Section 5.1",
        "without a coherent term Eq. 25 cannot become a Fresnel reflector, even with a Dirac distribution of slopes",
        AtLeast(0.1),
        lambda: off_mirror(1e-4),
        how="how far what it reflects is from a perfect mirror's 1, r = 1/10000",
        instead=Reading(
            "it does: as r goes to 0 all facets are level (S-28-r0) and reflect all light from every angle; the found "
            "number is what is left at r = 1/10000",
            lambda: off_mirror(1e-4) < off_mirror(1e-3) / 5 < off_mirror(1e-2) / 25,
        ),
        word="cannot become",
    ),
)
