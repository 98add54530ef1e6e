"""The figures of schlick1994: errors, speed-ups and operation counts. It defines neither the error nor the test."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import sympy as sp

from ratfit.brdf import distribution, fresnel, masking
from ratfit.claims._agreement import AtMost, Near, Rounded
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._models import T, V, made
from ratfit.claims._numbers import midpoints, peak_mean, relative_mean, values
from ratfit.claims.fresnel import F, U, curve, normal, of_figure_5
from ratfit.claims.masking import SLOPES, M
from ratfit.claims.method import X, derived
from ratfit.gallery import card

Definition = Callable[[Any, Any], float]

SETTINGS = "the mean over the settings of the figure, every value of the variable weighing the same"


def _mean(found: Sequence[float]) -> float:
    return sum(found) / len(found)


def of_sine(definition: Definition) -> float:
    fit, x = derived("eq12"), midpoints(0, float(sp.pi / 2))
    return definition(values(fit.chosen.subs(fit.problem.variable, X), {X: x}), values(sp.sin(X), {X: x}))


def of_fresnel(definition: Definition) -> float:
    u = midpoints()
    return _mean([definition(values(fresnel.schlick(U, F), {U: u, F: normal(m)}), curve(m, u)) for m in of_figure_5()])


def of_smith(definition: Definition) -> float:
    return _over_slopes(definition, masking.schlick(V, M), masking.smith_as_printed(V, M), V)


def of_beckmann(definition: Definition) -> float:
    return _over_slopes(definition, distribution.beckmann_rational(T, M), made(distribution.beckmann, T, M), T)


def _over_slopes(definition: Definition, fit: sp.Expr, exact: sp.Expr, variable: sp.Symbol) -> float:
    places = [{variable: midpoints(), M: each} for each in SLOPES]
    return _mean([definition(values(fit, at), values(exact, at)) for at in places])


def operations(name: str) -> dict[str, int]:
    """The operations of a fit in the cheapest arrangement found, what depends on parameters alone left out."""
    return {kind: count for kind, count in derived(name).cost.as_dict().items() if count}


def timed(name: str, **setting: Any) -> float | None:
    """gamma on this machine, one sample after the other in C, as 1994 had it."""
    from ratfit._speed import measure_speed

    return measure_speed(derived(name), backend="c-scalar", **setting).gamma


def printed(name: str) -> tuple[float, float]:
    """The error and the speed-up that are printed for an equation."""
    epsilon, gamma = card(name).epsilon, card(name).gamma
    assert epsilon is not None and gamma is not None
    return epsilon, gamma


NO_DEFINITION = (
    "the source defines neither its error nor how its samples are drawn; the found number is the mean error over the "
    f"peak, which gives its figure for the sine: {SETTINGS}"
)
NO_MACHINE = (
    "a ratio of times belongs to a machine, a compiler and its flags, which are not named; --measure times it here"
)


def error_claim(id: str, place: str, claim: str, claimed: Any, measured: Callable[[Definition], float]) -> Claim:
    """A claim on an error: by the two definitions that come into question."""
    return Claim(
        id,
        place,
        claim,
        claimed,
        None,
        readings=(
            Reading(f"the mean error over the peak of the true function; {SETTINGS}", lambda: measured(peak_mean)),
            Reading(f"the mean relative error; {SETTINGS}", lambda: measured(relative_mean)),
        ),
        open=NO_DEFINITION,
    )


def _speed(id: str, place: str, what: str, gamma: float, name: str, **setting: Any) -> Claim:
    words = "timed here in C, one sample after the other, to within a quarter"
    return Claim(
        id,
        place,
        f"{what} is {gamma:g} times as fast as the true function",
        gamma,
        None,
        open=NO_MACHINE,
        measured=(Reading(words, lambda: timed(name, **setting), Near(gamma, 0.25)),),
    )


ARRANGED = "the cheapest arrangement found; what depends on parameters alone is computed beforehand"

CLAIMS = (
    error_claim("S-4.1-eps", "Section 4.1", "Eq. 12 has an error of 1.4 %", Rounded(0.014, 0.001), of_sine),
    _speed("S-4.1-gamma", "Section 4.1", "Eq. 12", 2.3, "eq12"),
    Claim(
        "S-15-operations",
        "Section 4.2",
        "Eq. 15 costs 4 multiplications and 2 additions",
        {"add": 2, "mul": 4},
        lambda: operations("eq15"),
        how=ARRANGED,
    ),
    error_claim("S-15-eps", "Section 4.2", "Eq. 15 has an error of 0.6 %", Rounded(0.006, 0.001), of_fresnel),
    error_claim("S-15-one-percent", "Section 4.2", "the error of Eq. 15 is less than 1 %", AtMost(0.01), of_fresnel),
    _speed("S-15-gamma", "Section 4.2", "Eq. 15", 31.8, "eq15", reference="copper"),
    Claim(
        "S-15-32-times",
        "Section 4.2",
        "3180 % is almost 32 times",
        Rounded(32, 1),
        lambda: printed("eq15")[1],
        how="read as a ratio of times, not as what is gained over one",
    ),
    Claim(
        "S-19-operations",
        "Section 4.3",
        "Eq. 19 costs 1 division, 1 multiplication and 1 addition",
        {"add": 1, "mul": 1, "div": 1},
        lambda: operations("eq19"),
        how=ARRANGED,
    ),
    error_claim("S-19-eps", "Section 4.3", "Eq. 19 has an error of 1.8 %", Rounded(0.018, 0.001), of_smith),
    _speed("S-19-gamma", "Section 4.3", "Eq. 19", 28.7, "eq19", parameters={"m": 0.25}),
    Claim(
        "S-21-operations",
        "Section 4.4",
        "Eq. 21 costs 1 division, 4 multiplications and 2 additions",
        {"add": 2, "mul": 4, "div": 1},
        lambda: operations("eq21"),
        how=ARRANGED,
    ),
    error_claim("S-21-eps", "Section 4.4", "Eq. 21 has an error of 2.7 %", Rounded(0.027, 0.001), of_beckmann),
    _speed("S-21-gamma", "Section 4.4", "Eq. 21", 16.5, "eq21", parameters={"m": 0.25}),
    Claim(
        "S-21-less-good",
        "Section 4.4",
        "the results for Eq. 21 are less good than those for Eqs. 15 and 19, in error and in speed",
        (True, True),
        lambda: (
            printed("eq21")[0] > max(printed(name)[0] for name in ("eq15", "eq19")),
            printed("eq21")[1] < min(printed(name)[1] for name in ("eq15", "eq19")),
        ),
        how="the printed figures compared",
    ),
    Claim(
        "S-4.4-arithmetic",
        "Section 4.4",
        "the approximated model uses the four basic operations alone",
        0,
        lambda: sum(derived(name).cost.other for name in ("eq15", "eq19", "eq21")),
        how="the number of functions for each sample, in the cheapest arrangements found",
    ),
    Claim(
        "S-3-errors",
        "Section 3",
        "a precision of 0.1 % is lost where other steps are only at 5 % and 15 %",
        Rounded(0, 0.001),
        lambda: (0.001**2 + 0.05**2 + 0.15**2) ** 0.5 - (0.05**2 + 0.15**2) ** 0.5,
        how="what it adds to the sum, when errors are independent and their squares add up",
    ),
)
