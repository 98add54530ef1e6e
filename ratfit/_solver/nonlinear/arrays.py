"""Residuals as arrays: values and Jacobians in float64 at many places at once.

Nothing is compiled. A problem is asked once, for milliseconds of arithmetic, and a person waits for it: NumPy does the
whole search in a tenth of the time that JAX needs to compile its first step.

A moment that is a fraction, linear in the unknowns above and below the line, becomes two arrays of node values; then
no expression is evaluated while the search runs. Any other moment plays the tapes of `_lower`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import sympy as sp

from ratfit._lower import lower
from ratfit._parse import RatfitError
from ratfit._solver.nonlinear.quadrature import Rule, Weighted
from ratfit._solver.nonlinear.residuals import Moment, Residuals

Symbols: TypeAlias = tuple[sp.Symbol, ...]
Function: TypeAlias = Callable[..., np.ndarray]

STEP = 6e-6
"""Of a central difference, relative to the unknown: about the cube root of the float64 rounding."""


@dataclass(frozen=True)
class Values:
    """Residuals at places: `value` and `size` of shape (places, residuals), `jacobian` (places, residuals, unknowns).

    `size` is the sum of the absolute values of a residual's terms: what its value is small against, or not.
    `broken` (places,) says where an integrand has a pole inside its range; a False may be wrong, a True is not.
    """

    value: np.ndarray
    jacobian: np.ndarray
    size: np.ndarray
    broken: np.ndarray

    def take(self, which: np.ndarray) -> Values:
        return Values(self.value[which], self.jacobian[which], self.size[which], self.broken[which])

    def put(self, places: np.ndarray, others: Values) -> None:
        """Overwrites these places."""
        self.value[places], self.jacobian[places] = others.value, others.jacobian
        self.size[places], self.broken[places] = others.size, others.broken

    def where(self, chosen: np.ndarray, others: Values) -> Values:
        """These values where `chosen` (places,), else the others."""
        return Values(
            np.where(chosen[:, None], self.value, others.value),
            np.where(chosen[:, None, None], self.jacobian, others.jacobian),
            np.where(chosen[:, None], self.size, others.size),
            np.where(chosen, self.broken, others.broken),
        )


@dataclass(frozen=True)
class Prepared:
    """What a system's terms need that does not depend on the unknowns: arrays whose first axis is `rows` or 1.

    Row i belongs to the i-th values of the parameters.
    """

    terms: tuple[tuple[np.ndarray, ...], ...]

    def take(self, rows: np.ndarray) -> Prepared:
        """These rows, of which one may occur many times."""
        return Prepared(
            tuple(tuple(part if len(part) == 1 else part[rows] for part in arrays) for arrays in self.terms)
        )


@dataclass(frozen=True)
class System:
    """Residuals ready for arrays; `moments` are those of all residuals, in their order."""

    unknowns: Symbols
    parameters: Symbols
    homogeneous: bool
    residuals: int
    terms: tuple[_Quadratic | _Expression | _Fraction | _Moment, ...]
    places: tuple[int, ...]  # for each term, the residual that it is part of

    @staticmethod
    def of(residuals: Residuals, parameters: Sequence[sp.Symbol] = ()) -> System:
        """Raises RatfitError for a symbol that is no unknown, parameter or variable, or a function arrays lack."""
        unknowns, known = residuals.unknowns, tuple(parameters)
        terms: list[_Quadratic | _Expression | _Fraction | _Moment] = []
        places: list[int] = []
        for place, part in enumerate(residuals.parts):
            terms.append(_plain(part.plain, unknowns, known))
            terms += [_integral(moment, residuals.variable, unknowns, known) for moment in part.moments]
            places += [place] * (len(terms) - len(places))
        return System(unknowns, known, residuals.homogeneous, len(residuals.parts), tuple(terms), tuple(places))

    @property
    def moments(self) -> tuple[_Fraction | _Moment, ...]:
        return tuple(term for term in self.terms if isinstance(term, (_Fraction, _Moment)))

    def prepare(self, parameters: np.ndarray, rules: Sequence[Rule]) -> Prepared:
        """**Arguments:** `parameters` (rows, parameters); `rules`, one for each moment."""
        remaining = iter(rules)
        arrays: list[tuple[np.ndarray, ...]] = []
        for term in self.terms:
            if isinstance(term, (_Fraction, _Moment)):
                arrays.append(term.prepare(parameters, next(remaining)))
            else:
                arrays.append(term.prepare(parameters))
        return Prepared(tuple(arrays))

    def weighted(self, moment: int, unknowns: np.ndarray, parameters: np.ndarray) -> Weighted:
        """A moment's integrand as the rules see it, at one place (unknowns,) and one row (1, parameters)."""
        term = self.moments[moment]
        return lambda rule: term.integrand(unknowns[None], term.prepare(parameters, rule))[0]

    def at(self, unknowns: np.ndarray, prepared: Prepared) -> Values:
        """The residuals at places of shape (places, unknowns), for as many prepared rows or for one."""
        count, width = unknowns.shape
        value, size = np.zeros((2, count, self.residuals))
        jacobian = np.zeros((count, self.residuals, width))
        broken = np.zeros(count, bool)
        with np.errstate(all="ignore"):
            for term, place, arrays in zip(self.terms, self.places, prepared.terms, strict=True):
                part = term.at(unknowns, arrays)
                value[:, place] += part.value
                size[:, place] += part.size
                jacobian[:, place] += part.gradient
                broken |= part.broken
        return Values(value, jacobian, size, broken)


@dataclass(frozen=True)
class _Part:
    """One term at places: `value`, `size`, `broken` (places,) and `gradient` (places, unknowns)."""

    value: np.ndarray
    gradient: np.ndarray
    size: np.ndarray
    broken: np.ndarray | bool = False


@dataclass(frozen=True)
class _Quadratic:
    """A polynomial of degree 2 at most in the unknowns: v*C*v with v = (1, u); C is symmetric."""

    coefficients: tuple[tuple[Function, ...], ...]  # of the parameters

    def prepare(self, parameters: np.ndarray) -> tuple[np.ndarray, ...]:
        rows = [[_column(function, parameters) for function in row] for row in self.coefficients]
        return (np.moveaxis(np.array(rows), 2, 0),)

    def at(self, unknowns: np.ndarray, arrays: tuple[np.ndarray, ...]) -> _Part:
        extended = _extended(unknowns)
        slopes = np.matmul(arrays[0], extended[..., None])[..., 0]
        size = np.matmul(np.abs(arrays[0]), np.abs(extended)[..., None])[..., 0]
        return _Part((slopes * extended).sum(1), 2 * slopes[:, 1:], (size * np.abs(extended)).sum(1))


@dataclass(frozen=True)
class _Expression:
    """Any expression of the unknowns, by its terms."""

    terms: tuple[Function, ...]  # of the unknowns and the parameters
    gradient: Callable[[list], list]

    def prepare(self, parameters: np.ndarray) -> tuple[np.ndarray, ...]:
        return (parameters,)

    def at(self, unknowns: np.ndarray, arrays: tuple[np.ndarray, ...]) -> _Part:
        columns = [*unknowns.T, *arrays[0].T]
        terms = np.stack([np.broadcast_to(term(*columns), len(unknowns)) for term in self.terms])
        gradient = [np.broadcast_to(slope, len(unknowns)) for slope in self.gradient(columns)]
        return _Part(terms.sum(0), np.stack(gradient, axis=1), np.abs(terms).sum(0))


@dataclass(frozen=True)
class _Range:
    """The ends of a moment, functions of the parameters."""

    low: Function
    high: Function

    def nodes(self, parameters: np.ndarray, rule: Rule) -> tuple[np.ndarray, np.ndarray]:
        return rule.on(_column(self.low, parameters), _column(self.high, parameters))


@dataclass(frozen=True)
class _Fraction:
    """The integral of (p*v)/(q*v) with v = (1, u), where p and q are vectors of functions of the variable."""

    above: tuple[Function, ...]  # of the variable and the parameters
    below: tuple[Function, ...]
    range: _Range

    def prepare(self, parameters: np.ndarray, rule: Rule) -> tuple[np.ndarray, ...]:
        points, weights = self.range.nodes(parameters, rule)
        columns = [points, *parameters.T[..., None]]
        with np.errstate(all="ignore"):
            above, below = (
                np.stack([np.broadcast_to(function(*columns), points.shape) for function in side], axis=1)
                for side in (self.above, self.below)
            )
            # Only the ratio counts, and far out on an infinite range both may overflow.
            largest = np.abs(below).max(axis=1, keepdims=True)
            above, below = above / largest * weights[:, None], below / largest
        lost = ~(np.isfinite(above).all(axis=1) & np.isfinite(below).all(axis=1))[:, None]
        first = np.zeros_like(below)
        first[:, 0] = 1.0
        return np.where(lost, 0.0, above), np.where(lost, first, below)  # each (rows, 1 + unknowns, nodes)

    def integrand(self, unknowns: np.ndarray, arrays: tuple[np.ndarray, ...]) -> np.ndarray:
        """The weighted values at the nodes, (places, nodes)."""
        above, below = _sides(unknowns, arrays)
        return above / below

    def at(self, unknowns: np.ndarray, arrays: tuple[np.ndarray, ...]) -> _Part:
        above, below = _sides(unknowns, arrays)
        values, inverse = above / below, 1 / below
        gradient = np.matmul(arrays[0], inverse[..., None])[..., 0]
        gradient -= np.matmul(arrays[1], (values * inverse)[..., None])[..., 0]
        # A factor common to both sides is no pole: then both change sign between the same nodes.
        jumps = (below[:, 1:] * below[:, :-1] < 0) & (above[:, 1:] * above[:, :-1] > 0)
        return _Part(values.sum(1), gradient[:, 1:], np.abs(values).sum(1), jumps.any(1))


@dataclass(frozen=True)
class _Moment:
    """The integral of any expression."""

    value: Function  # of the unknowns, the parameters and the variable
    gradient: Callable[[list], list]
    range: _Range

    def prepare(self, parameters: np.ndarray, rule: Rule) -> tuple[np.ndarray, ...]:
        return parameters, *self.range.nodes(parameters, rule)

    def integrand(self, unknowns: np.ndarray, arrays: tuple[np.ndarray, ...]) -> np.ndarray:
        parameters, points, weights = arrays
        return self.value(*unknowns.T[..., None], *parameters.T[..., None], points) * weights

    def at(self, unknowns: np.ndarray, arrays: tuple[np.ndarray, ...]) -> _Part:
        parameters, points, weights = arrays
        columns = [*unknowns.T[..., None], *parameters.T[..., None], points]
        values = self.value(*columns) * weights
        gradient = [(slope * weights).sum(1) for slope in self.gradient(columns)]
        gradient = [np.broadcast_to(slope, len(unknowns)) for slope in gradient]
        return _Part(values.sum(1), np.stack(gradient, axis=1), np.abs(values).sum(1))


def _sides(unknowns: np.ndarray, arrays: tuple[np.ndarray, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Numerators and denominators at the nodes, each (places, nodes)."""
    extended = _extended(unknowns)
    if len(arrays[0]) == 1:
        above, below = (extended @ part[0] for part in arrays)
        return above, below
    above, below = (np.matmul(extended[:, None], part)[:, 0] for part in arrays)
    return above, below


def _extended(unknowns: np.ndarray) -> np.ndarray:
    return np.concatenate([np.ones((len(unknowns), 1)), unknowns], axis=1)


def _column(function: Function, parameters: np.ndarray) -> np.ndarray:
    """A function of the parameters at all their rows, (rows,); of no parameters, a constant."""
    return np.broadcast_to(np.asarray(function(*parameters.T), float), len(parameters))


def _plain(plain: sp.Expr, unknowns: Symbols, parameters: Symbols) -> _Quadratic | _Expression:
    expression = sp.expand(plain)
    found = _coefficients(expression, unknowns)
    if found is not None:
        table = [[_entry(found, i, j) for j in range(1 + len(unknowns))] for i in range(1 + len(unknowns))]
        return _Quadratic(tuple(tuple(lower(c, parameters) for c in row) for row in table))
    symbols = (*unknowns, *parameters)
    terms = tuple(lower(term, symbols) for term in sp.Add.make_args(plain))
    return _Expression(terms, _gradient(plain, unknowns, symbols))


def _entry(found: Mapping[tuple[int, int], sp.Expr], row: int, column: int) -> sp.Expr:
    coefficient = found.get((min(row, column), max(row, column)), sp.S.Zero)
    return coefficient if row == column else coefficient / 2


def _coefficients(expression: sp.Expr, unknowns: Symbols) -> dict[tuple[int, int], sp.Expr] | None:
    """The coefficient of v[i]*v[j], i <= j, where v = (1, unknowns); None where there is more than degree 2."""
    found: dict[tuple[int, int], sp.Expr] = {}
    for term in sp.Add.make_args(expression):
        coefficient, rest = term.as_independent(*unknowns, as_Add=False)
        powers = rest.as_powers_dict()
        factors = [unknowns.index(base) + 1 for base in powers if base in unknowns for _ in range(_whole(powers[base]))]
        if rest != sp.Mul(*(unknowns[factor - 1] for factor in factors)) or len(factors) > 2:
            return None
        first, second = ([0, 0] + sorted(factors))[-2:]
        found[first, second] = found.get((first, second), sp.S.Zero) + coefficient
    return found


def _whole(exponent: sp.Expr) -> int:
    return int(exponent) if exponent.is_Integer and 0 < exponent <= 2 else 0


def _integral(moment: Moment, variable: sp.Symbol, unknowns: Symbols, parameters: Symbols) -> _Fraction | _Moment:
    ends = _Range(*(_end(end, parameters) for end in (moment.low, moment.high)))
    sides = [_linear(side, unknowns) for side in sp.fraction(sp.together(moment.integrand))]
    if sides[0] and sides[1]:
        above, below = (tuple(lower(part, (variable, *parameters)) for part in side) for side in sides if side)
        return _Fraction(above, below, ends)
    symbols = (*unknowns, *parameters, variable)
    return _Moment(lower(moment.integrand, symbols), _gradient(moment.integrand, unknowns, symbols), ends)


def _end(end: sp.Expr, parameters: Symbols) -> Function:
    if end in (sp.oo, -sp.oo):
        return lambda *values: np.array(float(end))
    return lower(end, parameters)


def _linear(expression: sp.Expr, unknowns: Symbols) -> tuple[sp.Expr, ...] | None:
    """The constant part and the coefficients of an expression that is linear in the unknowns, else None."""
    slopes = [sp.diff(expression, unknown) for unknown in unknowns]
    if any(slope.has(*unknowns) for slope in slopes):
        # A product of sums hides that it is linear until it is multiplied out.
        slopes = [sp.expand(slope) for slope in slopes]
    if any(slope.has(*unknowns) for slope in slopes):
        return None
    return (expression.xreplace(dict.fromkeys(unknowns, sp.S.Zero)), *slopes)


def _gradient(expression: sp.Expr, unknowns: Symbols, symbols: Symbols) -> Callable[[list], list]:
    """The derivatives with respect to the unknowns, a function of the columns of all symbols.

    Exact ones, or central differences where sympy's derivative is of no function that arrays have.
    """
    try:
        slopes = [lower(sp.diff(expression, unknown), symbols) for unknown in unknowns]
    except RatfitError:
        value = lower(expression, symbols)
        return lambda columns: [_difference(value, columns, place) for place in range(len(unknowns))]
    return lambda columns: [slope(*columns) for slope in slopes]


def _difference(value: Function, columns: list, place: int) -> np.ndarray:
    step = STEP * np.maximum(np.abs(columns[place]), 1e-3)
    left, right = (value(*columns[:place], columns[place] + way * step, *columns[place + 1 :]) for way in (-1.0, 1.0))
    return (right - left) / (2 * step)
