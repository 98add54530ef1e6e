"""What is measured: an approximant and its exact function, at values of the parameters, on an interval."""

from __future__ import annotations

import functools
import math
import numbers
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from ratfit._kernel import Program
from ratfit._lower import lower
from ratfit._parse import RatfitError, nearest, shortened
from ratfit._schedule import schedule

RANDOM = "random"
"""In place of a parameter's value: every sample draws a value of its own from the parameter's range."""

PAIR = ("t", "u", "v", "v_prime", "w")
"""The cosines of a pair of directions, in the letters of schlick1994: what a whole reflectance model is written in."""

Value = float | str


@dataclass(frozen=True)
class Setting:
    """An approximant and the exact function that it stands for, at values of the parameters that may be measured."""

    exact: sp.Expr
    formula: sp.Expr
    program: Program  # the formula as it is computed: in the cheapest arrangement found
    variable: sp.Symbol
    values: Mapping[sp.Symbol, float]  # of the parameters that stand still, those of the reference among them
    ranges: Mapping[sp.Symbol, tuple[float, float]]  # of the parameters that every sample draws anew
    low: float
    high: float

    @property
    def parameters(self) -> dict[str, Any]:
        """The values by name, in the order of the names, and (low, high) of what is drawn: what a record says."""
        known = {symbol.name: value for symbol, value in (*self.values.items(), *self.ranges.items())}
        cosines = PAIR if self.whole else ()
        return {name: known[name] for name in sorted(known) if name not in cosines}

    @property
    def drawn(self) -> tuple[str, ...]:
        """The names of what every sample draws anew beside the variable."""
        return tuple(symbol.name for symbol in self.ranges)

    @property
    def whole(self) -> bool:
        """Whether this is a whole model, whose variables are the cosines of a pair of directions."""
        return (self.variable.name, *self.drawn)[: len(PAIR)] == PAIR

    @property
    def varying(self) -> tuple[sp.Symbol, ...]:
        """The symbols of which every sample has a value of its own: the variable first."""
        return (self.variable, *self.ranges)


def in_words(measured: Any) -> str:
    """Type, samples, parameters and reference of a measurement, as its `repr` shows them."""
    said = [measured.dtype, f"{measured.samples:,} samples"]
    for name, value in measured.parameters.items():
        said.append(
            f"{name} = {value:.6g}"
            if isinstance(value, float)
            else f"{name} random in [{value[0]:.6g}, {value[1]:.6g}]"
        )
    return ", ".join([*said, *([f"against {measured.reference}"] if measured.reference else [])])


def setting(
    fit: Any,
    parameters: Mapping[str, Value] | None = None,
    reference: str | None = None,
    within: tuple[float, float] | None = None,
) -> Setting:
    """What is measured when this fit is, at these parameter values.

    **Arguments:**

    - `fit`: a `Fit`, or anything with a `problem` and a `formula`, which may hold the variable and the parameters, but
      no coefficient that is still free.
    - `parameters`: the value of each parameter by name, or `"random"`: each sample then draws one from its range,
      uniformly. A value that the reference gives may be left out.
    - `reference`: the name of one of the problem's references; without one the target is the exact function.
    - `within`: the part of the domain to measure on, `(low, high)`; left out, all of it.

    **Fails** with `RatfitError` where there is nothing exact to compare with, for a value that is missing, unknown,
    outside its range or in contradiction with the reference, and for an infinite interval.
    """
    problem = fit.problem
    asked = by_name(parameters)
    exact, given = _exact(problem, reference)
    values = _values(problem, {name: value for name, value in asked.items() if value != RANDOM}, given)
    ranges = _ranges(problem, [name for name, value in asked.items() if value == RANDOM], given)
    for parameter in problem.parameters:
        if parameter not in ranges:
            _check_range(parameter, values)
    _check_free(fit, {*values, *ranges})
    low, high = _interval(tuple(_number(end, values, "the domain", ranges) for end in problem.domain), within)
    return Setting(exact, fit.formula, arranged(fit), problem.variable, values, ranges, low, high)


def by_name(parameters: Any) -> dict[str, Any]:
    """Values by name; none for None. **Fails** with `RatfitError` for what is no mapping."""
    if parameters is not None and not isinstance(parameters, Mapping):
        raise RatfitError(f"parameters = {shortened(repr(parameters), 60)}: give values by name, as in {{'m': 0.2}}")
    return dict(parameters or {})


def _interval(domain: tuple[float, ...], within: tuple[float, float] | None) -> tuple[float, float]:
    if within is not None and not _is_pair(within):
        raise RatfitError(f"within = {shortened(repr(within), 60)}: give two floats, low and high, as in (0, 9)")
    low, high = within or domain
    if within and low >= high:
        raise RatfitError(f"[{low}, {high}] is empty or reversed: measure within low < high, as in --within 0 9")
    if not -math.inf < low < high < math.inf:
        where = "this part of it" if within else "the domain"
        raise RatfitError(
            f"{where}, [{low}, {high}], cannot be sampled: measure within finite ends, as in --within 0 9"
        )
    if not domain[0] <= low < high <= domain[1]:
        raise RatfitError(
            f"[{low}, {high}] is not inside the domain [{domain[0]}, {domain[1]}]: measure on a part of it"
        )
    return low, high


def _is_pair(within: Any) -> bool:
    return isinstance(within, Sequence) and len(within) == 2 and all(isinstance(end, numbers.Real) for end in within)


def _is_real(value: Any) -> bool:
    return isinstance(value, numbers.Real) or (isinstance(value, sp.Expr) and value.is_extended_real is True)


def arranged(fit: Any) -> Program:
    """The formula of a fit in the cheapest arrangement found: what is timed, and what errors are measured of."""
    if fit.formula.has(sp.nan, sp.zoo, sp.oo, -sp.oo):  # infinite somewhere: a fit all the same, and measured as it is
        return Program(fit.formula)
    problem = fit.problem
    ranges = {problem.variable: tuple(problem.domain), **{p: (p.low, p.high) for p in problem.parameters}}
    return _scheduled(fit.formula, problem.variable, tuple(ranges.items()))


@functools.lru_cache(maxsize=64)
def _scheduled(formula: sp.Expr, variable: sp.Symbol, ranges: tuple[tuple[sp.Symbol, tuple[Any, ...]], ...]) -> Program:
    """Kept: one fit is measured at many settings and on many backends."""
    found = schedule(formula, variable, dict(ranges))
    return Program(found.result, (*found.constants, *found.steps))


def _ranges(problem: Any, names: list[str], given: Mapping[sp.Symbol, sp.Expr]) -> dict[sp.Symbol, tuple[float, float]]:
    known = {parameter.name: parameter for parameter in problem.parameters if parameter not in given}
    for name in names:
        if name not in known:
            there = ", ".join(known) or "none"
            raise RatfitError(f"no parameter {name!r} to draw at random, there is: {there}{nearest(name, known)}")
    # In the order of the problem, that the first are the cosines of a pair where there are such.
    return {each: (float(each.low), float(each.high)) for name, each in known.items() if name in names}


def reference_of(problem: Any, name: str) -> Any:
    """The reference of that name. **Fails** with `RatfitError`, which says the names that there are."""
    known = {each.name: each for each in problem.references}
    if name not in known:
        there = ", ".join(known) or "none"
        raise RatfitError(f"no reference {name!r}, there is: {there}{nearest(str(name), known)}")
    return known[name]


def _exact(problem: Any, reference: str | None) -> tuple[sp.Expr, Mapping[sp.Symbol, sp.Expr]]:
    if reference is not None:
        found = reference_of(problem, reference)
        return found.expression, found.parameters
    if problem.target is None:
        names = ", ".join(each.name for each in problem.references) or "none"
        raise RatfitError(f"this problem has no target, so eps and gamma need a reference; it has: {names}")
    return problem.target.expression, {}


def _values(problem: Any, asked: Mapping[str, Value], given: Mapping[sp.Symbol, sp.Expr]) -> dict[sp.Symbol, float]:
    symbols = {symbol.name: symbol for symbol in (*problem.parameters, *given)}
    known = ", ".join(symbols) or "none"
    for name, value in asked.items():
        if name not in symbols:
            raise RatfitError(f"no parameter {name!r}, there is: {known}{nearest(name, symbols)}")
        if not _is_real(value):
            raise RatfitError(f"{name} = {value!r}: a number is needed, or {RANDOM!r}{nearest(str(value), [RANDOM])}")
    values = {symbols[name]: float(value) for name, value in asked.items()}
    for symbol, expression in given.items():
        # A reference may write one of its values in terms of others, its reflectance f in terms of its index n.
        value = _number(expression.subs(given), values, f"{symbol.name} under this reference")
        if values.setdefault(symbol, value) != value:
            raise RatfitError(f"the reference says {symbol.name} = {value}: leave {symbol.name} = {values[symbol]} out")
    return values


def _check_range(parameter: Any, values: Mapping[sp.Symbol, float]) -> None:
    low, high = float(parameter.low), float(parameter.high)
    if parameter not in values:
        raise RatfitError(f"the parameter {parameter.name} has no value: give it one in [{low}, {high}]")
    if not low <= values[parameter] <= high:
        raise RatfitError(f"{parameter.name} = {values[parameter]} is outside its range [{low}, {high}]")


def _check_free(fit: Any, known: set[sp.Symbol]) -> None:
    free = sorted(symbol.name for symbol in fit.formula.free_symbols - {fit.problem.variable, *known})
    if free:
        raise RatfitError(f"still free: {', '.join(free)}; choose a value, in [choice] or with --set {free[0]}=...")


def _number(
    expression: sp.Expr, values: Mapping[sp.Symbol, float], what: str, drawn: Mapping[sp.Symbol, Any] | None = None
) -> float:
    moving = sorted(symbol.name for symbol in expression.free_symbols & set(drawn or {}))
    if moving:
        raise RatfitError(f"{what} depends on {', '.join(moving)}, which cannot be random: give it a value")
    missing = sorted(symbol.name for symbol in expression.free_symbols - set(values))
    if missing:
        raise RatfitError(f"{what} needs a value of {', '.join(missing)}: add it to the parameters")
    return lower(expression, tuple(values))(*values.values())
