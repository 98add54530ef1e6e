"""Rows: the linear route's equations, each the coefficients of the unknowns of a condition that is to vanish."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache, partial

import sympy as sp

from ratfit._condition import JET, AbstractCondition, AbstractPointCondition, Equation, Integral, Limit
from ratfit._field import Field
from ratfit._form import Shape
from ratfit._integral import closed_integral, integral_parts, integrated
from ratfit._jets import same
from ratfit._pieces import smooth_pieces
from ratfit._series import Laurent, factor_series, laurent, local_coordinate, taylor
from ratfit._system import System, columns, is_finite_at

Row = list[sp.Expr]

NOTHING: Mapping[Limit, int] = {}


def rows(system: System, raised: Mapping[Limit, int] = NOTHING) -> list[Row]:
    """The linear equations of a completed system: the coefficients of the columns, each row to vanish.

    At a node the rows are the Taylor coefficients of factor*P - f*Q: linear, where the quotient's are not. With a
    denominator that is constant in the variable every condition is linear as it stands. `raised` says for a limit how
    many orders more the denominator is known to vanish there. Raises RatfitError for a condition that is not linear.
    """
    return [row for condition, demand in system.pairs for row in rows_of(system, condition, demand, raised)]


def rows_of(
    system: System, condition: AbstractCondition, demand: sp.Expr, raised: Mapping[Limit, int] = NOTHING
) -> list[Row]:
    """The rows of one condition among those of its system."""
    if isinstance(condition, Integral):
        return [_integral_row(system, condition, demand)]
    if isinstance(condition, Limit):
        return limit_rows(system, condition, demand, raised.get(condition, 0))[0]
    if isinstance(condition, Equation):
        return _equation_rows(system, condition)
    assert isinstance(condition, AbstractPointCondition)
    if system.plain and is_finite_at(system, condition.at):
        return [_plain_row(system, condition, demand)]
    return _hermite_rows(system, condition, demand)


def _plain_row(system: System, condition: AbstractPointCondition, demand: sp.Expr) -> Row:
    return [d - demand * below for d, below in _plain_derivatives(system, condition.at, condition.order)]


def _plain_derivatives(system: System, at: sp.Expr, order: int) -> list[tuple[sp.Expr, sp.Expr]]:
    """The derivative of each column's numerator at a place, beside its denominator."""
    x, factor = system.problem.variable, system.shape.factor
    weight = sp.factorial(order)
    return [(weight * taylor(factor * above, x, at, order)[-1], below) for above, below in columns(system.shape)[0]]


def _equation_rows(system: System, equation: Equation) -> list[Row]:
    """A linear differential equation of a polynomial: its coefficients at the place times the derivatives."""
    x, found = system.problem.variable, []
    jets = [_plain_derivatives(system, equation.at, k) for k in range(equation.height + equation.order + 1)]
    for residual in equation.residuals_there(x):
        free = residual.xreplace(dict.fromkeys(JET, sp.S.Zero))
        slopes = [(k, slope) for k in range(len(jets)) if (slope := sp.diff(residual, JET[k])) != 0]
        row = [
            sp.Add(*(slope * jets[k][column][0] for k, slope in slopes)) + free * jets[0][column][1]
            for column in range(len(jets[0]))
        ]
        found.append(row)
    return found


def _integral_row(system: System, condition: Integral, demand: sp.Expr) -> Row:
    problem = system.problem
    inside, rest = integral_parts(problem, condition)
    pairs, _ = columns(system.shape)
    x, pieces = problem.variable, smooth_pieces(condition.weight * system.shape.factor, problem.variable, inside)
    if system.plain:
        integrals = [sp.Add(*(integrated(w * above, x, over) for w, over in pieces)) for above, _ in pairs]
        return [value - (demand - rest) * below for value, (_, below) in zip(integrals, pairs, strict=True)]
    denominator = pairs[-1][1]
    row = [sp.Add(*(closed_integral(w * above, denominator, x, over) for w, over in pieces)) for above, _ in pairs]
    row[-1] -= demand - rest
    return row


def limit_rows(system: System, limit: Limit, demand: sp.Expr, raised: int) -> tuple[list[Row], Row]:
    """The rows of a limit, and the coefficient of Q that they take for the first that does not vanish there.

    (f - minus)*scale tends to L where scale*factor*P - (minus*scale + L)*Q vanishes to a higher order than Q. The rows
    are its series coefficients up to the order of Q's zero: the lowest that the columns have, raised while the rows
    themselves force that coefficient of Q to vanish, and `raised` times more.
    """
    sides = sides_of(system, limit)
    found, lead = _one_sided_rows(system, limit, demand, raised, sides[0])
    if len(sides) == 2 and not _is_smooth(system, limit):
        found = found + _one_sided_rows(system, limit, demand, raised, sides[1])[0]
    return found, lead


def sides_of(system: System, limit: Limit) -> tuple[int, ...]:
    """From above (1) and below (-1), but from inside alone at an end of the support; infinity has one side."""
    low, high = system.problem.support()
    if limit.at.is_infinite or same(limit.at, low):
        return (1,)
    return (-1,) if same(limit.at, high) else (1, -1)


def _is_smooth(system: System, limit: Limit) -> bool:
    """Whether both sides of a place see the same series: of rational functions they do."""
    parts = (
        limit.scale,
        limit.minus,
        system.shape.factor,
        *(part for pair in columns(system.shape)[0] for part in pair),
    )
    return all(part.is_rational_function(system.problem.variable) for part in parts)


def _one_sided_rows(system: System, limit: Limit, demand: sp.Expr, raised: int, side: int) -> tuple[list[Row], Row]:
    series_to = partial(_series, system.shape, system.problem.variable, limit, side)
    order = lowest = min(v for v in map(_valuation, series_to(0).below) if v is not None)
    widest = lowest + 2 * len(columns(system.shape)[0])
    while True:
        series = series_to(order)
        found = series.rows(demand, order)
        lead = [b.at(order) for b in series.below]
        forced = order < widest and _spans(found, lead)
        if not forced and raised == 0:
            return found, lead
        order, raised = order + 1, raised if forced else raised - 1


@dataclass(frozen=True)
class _Series:
    """The series of scale*factor*P, of Q and of minus*scale*Q at the place of a limit, column by column."""

    above: tuple[Laurent, ...]
    below: tuple[Laurent, ...]
    minus: tuple[Laurent, ...]

    def rows(self, demand: sp.Expr, order: int) -> list[Row]:
        """The coefficients up to `order`, those that are not empty."""
        lowest = min(s.lowest for s in (*self.above, *self.minus, *self.below))
        triples = list(zip(self.above, self.minus, self.below, strict=True))
        found = (
            [sp.expand(a.at(k) - m.at(k) - demand * b.at(k)) for a, m, b in triples] for k in range(lowest, order + 1)
        )
        return [row for row in found if any(row)]


@lru_cache(maxsize=200)
def _series(shape: Shape, x: sp.Symbol, limit: Limit, side: int, order: int) -> _Series:
    return _Series(*(tuple(laurent(e, order) for e in group) for group in _local(shape, x, limit, side)))


@lru_cache(maxsize=50)
def _local(shape: Shape, x: sp.Symbol, limit: Limit, side: int) -> tuple[list[sp.Expr], ...]:
    """The same as expressions of the local coordinate; kept, for a limit's rows are asked for again and again."""
    pairs, _ = columns(shape)
    scaled = limit.scale * shape.factor
    parts = [scaled * a for a, _ in pairs] + [b for _, b in pairs] + [limit.minus * limit.scale * b for _, b in pairs]
    moved = local_coordinate(parts, x, limit.at, side)
    n = len(pairs)
    return moved[:n], moved[n : 2 * n], moved[2 * n :]


def _valuation(series: Laurent) -> int | None:
    """The lowest power that is there; None where none is up to the order that the series goes to."""
    return next((series.lowest + k for k, c in enumerate(series.coefficients) if c != 0), None)


def _spans(found: list[Row], lead: Row) -> bool:
    """Whether the rows force what a further row takes for nonzero to vanish."""
    if not any(lead):
        return True
    field = Field([e for row in [*found, lead] for e in row])
    functional = [field.encode(e) for e in lead]
    basis = field.null_space([[field.encode(e) for e in row] for row in found], len(lead))
    return bool(basis) and not any(field.product(functional, vector) for vector in basis)


def _hermite_rows(system: System, condition: AbstractPointCondition, demand: sp.Expr) -> list[Row]:
    x, at, order = system.problem.variable, condition.at, condition.order
    data = [_known_derivative(system, condition, k) / sp.factorial(k) for k in range(order)]
    data.append(demand / sp.factorial(order))
    pole, factor = factor_series(system.shape.factor, x, at, order)
    pairs, _ = columns(system.shape)
    found = []
    # A pole of the factor must be met by zeros of P: the value brings the rows below the pole's order along.
    for k in range(order + pole + 1) if order == 0 else [order + pole]:
        row = []
        for above, below in pairs:
            p, q = taylor(above, x, at, k), taylor(below, x, at, k)
            numerator = sum((factor[j] * p[k - j] for j in range(min(k, len(factor) - 1) + 1)), sp.S.Zero)
            denominator = sum((data[j] * q[k - pole - j] for j in range(min(k - pole, order) + 1)), sp.S.Zero)
            row.append(sp.expand(numerator - denominator))
        found.append(row)
    return found


def _known_derivative(system: System, condition: AbstractPointCondition, order: int) -> sp.Expr:
    """The derivative of a lower order that another condition at the same node asks for, or parity's zero."""
    for other, demand in system.pairs:
        if isinstance(other, AbstractPointCondition) and other.order == order and same(other.at, condition.at):
            return demand
    return sp.S.Zero
