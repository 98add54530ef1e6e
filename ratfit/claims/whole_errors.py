"""Cook and Torrance's whole model with Eqs. 15, 19 and 21 of schlick1994, with Eq. 16, and the one test of them all."""

from __future__ import annotations

import functools
from typing import Any

from ratfit.brdf import masking
from ratfit.claims._agreement import AtLeast, AtMost, Rounded, agrees
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._directions import over_pairs
from ratfit.claims._models import V_PRIME, T, U, V, made
from ratfit.claims._numbers import peak_mean, relative_mean
from ratfit.claims.fresnel import of_figure_5
from ratfit.claims.masking import SLOPES, M
from ratfit.claims.published_errors import (
    NO_DEFINITION,
    NO_MACHINE,
    SETTINGS,
    Definition,
    of_beckmann,
    of_fresnel,
    of_sine,
    of_smith,
)

FAST = "cook-torrance-optimised-as-printed"
WORST = "over pairs of directions, at the worst of four materials and of m from 0.05 on"


def stand_in(fast: bool) -> Any:
    """The model by Eqs. 15, 19 and 21, or with Eq. 16 for its masking, as `ratfit bench --model` measures it."""
    from ratfit.models.stand_ins import stand_ins

    true = "cook-torrance-as-printed"
    return next(each for each in stand_ins(true) if (each.model.name == FAST) is fast)


def of_eq_16(definition: Definition) -> float:
    """Eq. 16 in place of Smith's product, over pairs of directions, the mean over the m of Figure 6."""
    exact = made(masking.separable, masking.smith_as_printed, V, V_PRIME, M)
    grooves = over_pairs(masking.torrance_sparrow(T, U, V, V_PRIME))
    return sum(definition(grooves, over_pairs(exact, m=each)) for each in SLOPES) / len(SLOPES)


@functools.cache
def values_of_models() -> tuple[tuple[Any, Any, Any], ...]:
    """The true model, the fast one and the one with Eq. 16 over pairs of directions, for every setting."""
    fast, grooves = stand_in(fast=True), stand_in(fast=False)
    found = []
    for m in SLOPES[1:]:
        for eta, kappa in of_figure_5():
            at = {"alpha": m, "diffuse": 0.0, "specular_share": 1.0, "eta": float(eta), "kappa": float(kappa)}
            formulas = (fast.exact.reflectance, fast.formula, grooves.formula)
            found.append(tuple(over_pairs(each, **at) for each in formulas))
    return tuple(found)


def of_whole_model(definition: Definition) -> float:
    """Eqs. 15, 19 and 21 in place of 13, 18 and 20: the greatest error over the settings."""
    return max(definition(fast, true) for true, fast, _ in values_of_models())


def of_grooves(definition: Definition) -> float:
    """Eq. 16 in place of Eq. 18 in the whole model: the same."""
    return max(definition(grooves, true) for true, _, grooves in values_of_models())


def mean_mean(found: Any, exact: Any) -> float:
    """The definition `mean_mean` of eps: the mean of |found - exact| over that of |exact|."""
    return float(abs(found - exact).mean() / abs(exact).mean())


def timed_model() -> float | None:
    """gamma of the fast model on this machine, in C, one pair of directions after the other."""
    from ratfit._speed import measure_speed

    fast = stand_in(fast=True)
    return measure_speed(fast, backend="c-scalar", parameters=fast.settings({})).gamma


FIGURES = (
    (Rounded(0.014, 0.001), of_sine),
    (Rounded(0.006, 0.001), of_fresnel),
    (Rounded(0.018, 0.001), of_smith),
    (Rounded(0.027, 0.001), of_beckmann),
    (Rounded(0.53, 0.01), of_eq_16),
)
"""The printed errors, and what measures each."""


def figures_by(definition: Definition) -> int:
    """How many of the printed errors one definition gives."""
    return sum(agrees(measured(definition), printed) for printed, measured in FIGURES)


CLAIMS = (
    Claim(
        "S-4.1-one-test",
        "Sections 4.1 to 4.4",
        "one statistical test gave the five printed errors",
        len(FIGURES),
        None,
        readings=(
            Reading(f"the mean error over the peak; {SETTINGS}", lambda: figures_by(peak_mean)),
            Reading(f"the mean relative error; {SETTINGS}", lambda: figures_by(relative_mean)),
        ),
        open="the test is not defined; the found number is how many of the five the mean error over the peak gives: "
        f"{SETTINGS}",
    ),
    Claim(
        "S-4.4-whole-error",
        "Section 4.4",
        "Cook and Torrance's model with Eqs. 15, 19 and 21 has an error of less than 3 %",
        AtMost(0.03),
        None,
        readings=(
            Reading(
                f"the mean error over the peak of the true model, {WORST}; the peak is so far above the mean that this "
                "says little",
                lambda: of_whole_model(peak_mean),
            ),
        ),
        open=NO_DEFINITION,
    ),
    Claim(
        "S-4.4-whole-mean",
        "Section 4.4",
        "the same error, taken over the mean of the true model",
        AtMost(0.03),
        None,
        readings=(Reading(f"the mean error over the mean, {WORST}", lambda: of_whole_model(mean_mean)),),
        open="the source does not say what its error is relative to; the found number is the mean error over the mean "
        f"of the true model, {WORST}",
    ),
    Claim(
        "S-4.4-whole-speed",
        "Section 4.4",
        "Cook and Torrance's model with Eqs. 15, 19 and 21 is more than 20 times as fast",
        AtLeast(20.0),
        None,
        open=NO_MACHINE,
        measured=(Reading("timed here in C, one pair of directions after the other, for glass", timed_model),),
    ),
    Claim(
        "S-fn3",
        "footnote 3",
        "Eq. 16 in place of Smith's function has an error of 53 %",
        Rounded(0.53, 0.01),
        None,
        readings=(
            Reading(f"the mean error of G over its peak; {SETTINGS}", lambda: of_eq_16(peak_mean)),
            Reading(f"the mean relative error of G; {SETTINGS}", lambda: of_eq_16(relative_mean)),
            Reading(f"the mean error of the whole model over its peak, {WORST}", lambda: of_grooves(peak_mean)),
            Reading(f"the mean relative error of the whole model, {WORST}", lambda: of_grooves(relative_mean)),
        ),
        open="the source defines neither its error nor how its samples are drawn; the found number is the mean error "
        f"of G over its peak: {SETTINGS}; its mean relative error and those of the whole model are not 53 % either",
    ),
    Claim(
        "S-fn3-order",
        "footnote 3",
        "the approximated model is much more precise than the one with Eq. 16",
        "much",
        None,
        readings=(
            Reading(
                f"the mean error over the peak with Eq. 16 is at least twice that with Eqs. 15, 19 and 21, {WORST}",
                lambda: of_grooves(peak_mean) / of_whole_model(peak_mean),
                AtLeast(2.0),
            ),
        ),
        open=NO_DEFINITION,
    ),
)
