"""What a picture of a fit is drawn from: exact function, fit and error as arrays, at settings of the parameters."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from ratfit._fit import Candidate, Fit
from ratfit._lower import lower
from ratfit._parse import RatfitError
from ratfit._problem import Problem
from ratfit._setting import Setting, by_name, setting
from ratfit._target import Parameter, Target, sample_values
from ratfit.gallery import card, is_card
from ratfit.plot.far import seen, within
from ratfit.plot.style import SERIES
from ratfit.plot.text import significant
from ratfit.plot.view import broken, is_pole

Parameters = Mapping[str, float | Sequence[float]]

PLACES = 2000
"""Points of a curve: the middles of so many equal parts, more of them towards the ends, and the ends."""

NEAREST = 1e-5
"""How near to an end the places go, in parts of the range: nearer by, what is 0/0 there loses its digits."""

MOST = 2 * len(SERIES)
"""Curves of a family that an eye can still tell apart."""


@dataclass(frozen=True)
class FitCurves:
    """Exact function and fit at one setting of the parameters, nan where there is none; heights are as they are.

    `label` says what the setting is ("m = 0.1"); `exact` is None where nothing is known to compare with.
    """

    setting: Setting
    label: str
    places: Any
    exact: Any
    fit: Any

    @property
    def known(self) -> Any:
        """The exact function, or the fit where there is none."""
        return self.fit if self.exact is None else self.exact

    @property
    def peak(self) -> float:
        """The largest size of what is known, as far as it is drawn."""
        import numpy as np

        return float(np.nanmax(abs(self.known), initial=0.0))

    @property
    def has_pole(self) -> bool:
        """Whether what is known is infinite somewhere: it then has no peak."""
        import numpy as np

        formula = self.setting.formula if self.exact is None else self.setting.exact
        raw = _raw(self.places, formula, self.setting)
        known = raw[np.isfinite(raw)].tolist()
        return bool(np.isinf(raw).any()) or any(is_pole(known, k) for k in range(2, len(known) - 1))

    def errors(self, definition: str) -> Any:
        """The signed errors by one of ERRORS."""
        import numpy as np

        difference = self.fit - self.exact
        with np.errstate(all="ignore"):
            found = {
                "absolute": difference,
                "peak": difference / self.peak,
                "relative": difference / abs(self.exact),
            }[definition]
        return np.where(np.isfinite(found), found, math.nan)

    def number(self, expression: sp.Expr) -> float:
        """An expression of the parameters at this setting; nan where it is no number."""
        values = self.setting.values
        return float(lower(expression, tuple(values))(*values.values()))

    def drawn(self, formula: sp.Expr, places: Any) -> Any:
        """Another formula of the same problem at this setting."""
        return heights_at(places, formula, self.setting)


ERRORS: Mapping[str, str] = {
    "peak": "error / peak",
    "relative": "error / |exact|",
    "absolute": "error",
}
"""What an error strip may show, and how its axis is named."""


def curves_of(fit: Fit, parameters: Parameters | None, reference: str | None) -> tuple[FitCurves, ...]:
    """The curves at every setting that `parameters` name.

    A parameter with a list of values makes a family; one that is left out has the middle of its range, and where all
    are left out a gallery problem has its card's settings. Raises RatfitError where there is no fit, for a coefficient
    that is still free, an unknown name and a value outside its range.
    """
    free = sorted(s.name for s in fit.chosen.free_symbols & set(fit.free))
    if free:
        raise RatfitError(f"still free: {', '.join(free)}; choose a value, in [choice] or with --set {free[0]}=...")
    has_exact = reference is not None or fit.problem.target is not None
    # A fit without an exact function is held against itself: its parameters are checked as those of any other.
    compared = fit if has_exact else replace(fit, problem=_with_target(fit))
    asked = _settings(fit.problem, parameters, reference)
    places = [setting(compared, values, reference, within(fit.problem, values)) for values in asked]
    low, high = seen(fit, places)
    varying = [name for name in (asked[0] if asked else {}) if len({values.get(name) for values in asked}) > 1]
    return tuple(
        _drawn(place, (place.low if low is None else low, place.high if high is None else high), varying, has_exact)
        for place in places
    )


def other_formulas(fit: Fit) -> list[tuple[Candidate, sp.Expr]]:
    """The further candidates and the rejected ones, each with its formula on the whole domain, where it is a curve."""
    found = []
    for candidate in (*fit.candidates[1:], *fit.rejected):
        formula = replace(fit, candidates=(candidate,)).formula
        symbols = formula.free_symbols - {fit.problem.variable, *fit.problem.parameters}
        if not symbols and not formula.has(sp.I, sp.nan, sp.zoo, sp.oo):
            found.append((candidate, formula))
    return found


def heights_at(places: Any, formula: sp.Expr, at: Setting) -> Any:
    """A formula at places, with a gap at every pole and jump."""
    import numpy as np

    raw = _raw(places, formula, at)
    return np.array(broken(places.tolist(), np.where(np.isfinite(raw), raw, math.nan).tolist()))


def _raw(places: Any, formula: sp.Expr, at: Setting) -> Any:
    return lower(formula, (at.variable, *at.values))(places, *at.values.values())


def _with_target(fit: Fit) -> Problem:
    problem = fit.problem
    return replace(problem, target=Target(fit.formula, problem.variable, problem.domain))


def _drawn(place: Setting, ends: tuple[float, float], varying: Sequence[str], has_exact: bool) -> FitCurves:
    import numpy as np

    low, high = ends
    close = np.geomspace(NEAREST, 0.5 / PLACES, 40, endpoint=False)
    shares = np.concatenate([[0], close, (np.arange(PLACES) + 0.5) / PLACES, 1 - close[::-1], [1]])
    places = low + (high - low) * shares
    label = ", ".join(f"{name} = {significant(place.parameters[name], 4)}" for name in varying)
    exact = heights_at(places, place.exact, place) if has_exact else None
    return FitCurves(place, label, places, exact, heights_at(places, place.formula, place))


def _settings(problem: Problem, parameters: Parameters | None, reference: str | None) -> list[dict[str, Any]]:
    """The values of the parameters, one mapping a curve."""
    given = {s.name for each in problem.references if each.name == reference for s in each.parameters}
    if parameters is None and (settings := _settings_of_card(problem)):
        return [{name: float(value) for name, value in each.items() if name not in given} for each in settings]
    asked = by_name(parameters)
    families = [name for name, value in asked.items() if isinstance(value, Iterable) and not isinstance(value, str)]
    if len(families) > 1:
        raise RatfitError(f"a picture has one family of curves: give {' or '.join(families)} one value")
    for parameter in problem.parameters:
        if parameter.name not in given:
            asked.setdefault(parameter.name, middle(parameter))
    values = list(asked[families[0]]) if families else []
    if families and not 1 <= len(values) <= MOST:
        raise RatfitError(f"{families[0]} has {len(values)} values: a picture holds 1 to {MOST} curves")
    found = [{**asked, families[0]: value} for value in values] if families else [asked]
    for name, value in (pair for each in found for pair in each.items()):
        if isinstance(value, str):
            raise RatfitError(f"{name} = {value!r}: a picture is drawn at numbers; give one, or a list of them")
    return found


def middle(parameter: Parameter) -> float:
    """The middle of a parameter's range; of an infinite one, a place some way inside."""
    return float(sample_values({parameter}, ("1/2",))[0][parameter])


def _settings_of_card(problem: Problem) -> tuple[Mapping[str, sp.Expr], ...]:
    """The settings that a gallery problem is published with; none for other problems, whatever they are called."""
    if not is_card(problem.name):
        return ()
    known = card(problem.name)
    return known.settings if replace(known.problem, choice=problem.choice) == problem else ()
