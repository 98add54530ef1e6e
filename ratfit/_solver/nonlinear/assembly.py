"""From a system to residuals: what is linear is solved exactly first, the rest is what must be brought to zero."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace

import sympy as sp

from ratfit._condition import AbstractCondition, AbstractPointCondition, Equation, Integral, Limit, describe
from ratfit._deadline import TimeLimit
from ratfit._field import is_zero
from ratfit._form import Shape, letters_of
from ratfit._integral import integral_parts
from ratfit._inverse import inverted
from ratfit._jets import same
from ratfit._parse import RatfitError
from ratfit._pieces import smooth_pieces
from ratfit._rows import rows, sides_of
from ratfit._series import LOCAL, local_coordinate
from ratfit._solver.linear import combination, fractions, null_space
from ratfit._solver.nonlinear.residuals import Moment, Residual, Residuals
from ratfit._solver.solution import Undecided
from ratfit._system import Demanded, System, columns, completed, of_pairs, residuals

LIMIT_SECONDS = 3.0
"""How long sympy may look for the limit of a form with unknowns."""


@dataclass(frozen=True)
class Assembly:
    """The form's numerator and denominator in the unknowns of `residuals`; its columns keep all linear conditions.

    `numerical` are the conditions that the residuals stand for.
    """

    numerator: sp.Expr
    denominator: sp.Expr
    residuals: Residuals
    numerical: tuple[AbstractCondition, ...]


def assembled(system: System) -> Assembly | None:
    """The residuals of a system; None where the linear conditions alone clash.

    A fraction is written in a basis of the null space of its linear conditions, on the unit sphere where its scale is
    free: few unknowns, and no condition that is linear is ever only nearly kept.
    """
    if not system.fraction:
        return _with_linear_unknowns_solved(_assembly(system, system.shape, system.pairs))
    linear, rest = split(system)
    leftover, symbols = system.completion.leftover, set(system.completion.symbols)
    if any(not e.free_symbols & symbols and is_zero(e) is False for e in leftover):
        return None
    vectors = null_space(linear)
    if not vectors:
        return None
    shape = _in_basis(system, vectors)
    return None if shape is None else _assembly(system, shape, rest)


def split(system: System) -> tuple[System, list[Demanded]]:
    """The part of a system whose rows are linear as it stands, and what is left, as it was stated."""
    whole = completed(system)
    symbols = set(system.completion.symbols)
    open_nodes = [c.at for c, d in system.completion.facts if d.free_symbols & symbols]
    stated = set(system.conditions)
    linear = [(c, d) for c, d in whole.pairs if _is_linear(whole, symbols, c, d)]
    kept = {c for c, _ in linear}
    closed = [c for c in system.conditions if isinstance(c, Equation) and not _among(c.at, open_nodes)]
    rest = [(c, d) for c, d in system.pairs if c in stated - kept - set(closed)]
    return of_pairs(system, linear), rest


def _among(at: sp.Expr, places: list[sp.Expr]) -> bool:
    return any(same(at, place) for place in places)


def _is_linear(whole: System, symbols: set[sp.Symbol], condition: AbstractCondition, demand: sp.Expr) -> bool:
    """Whether a condition of a completed system has rows without the derivatives that nobody stated."""
    if isinstance(condition, AbstractPointCondition):
        return not any(
            d.free_symbols & symbols
            for c, d in whole.pairs
            if isinstance(c, AbstractPointCondition) and c.order <= condition.order and same(c.at, condition.at)
        )
    if isinstance(condition, Integral) and not whole.fixed_denominator:
        return False
    try:
        rows(of_pairs(whole, [(condition, demand)]))
    except RatfitError:
        return False
    return True


def _in_basis(system: System, vectors: list[list[sp.Expr]]) -> Shape | None:
    """The form in a basis of its coefficients: c0*v0 + c1*v1 + ..., or with the fixed part 1 where it has one."""
    pairs, has_fixed = columns(system.shape)
    if has_fixed:
        solutions = fractions(system, vectors)
        if not solutions:
            return None
        found = solutions[0]
        return Shape(found.numerator, found.denominator, system.shape.factor, tuple(found.free), homogeneous=False)
    letter = letters_of("c", [system.problem.variable.name, *(p.name for p in system.problem.parameters)])
    unknowns = tuple(sp.Symbol(f"{letter}{i}", real=True) for i in range(len(vectors)))
    return Shape(*combination(pairs, unknowns, vectors), system.shape.factor, unknowns, homogeneous=True)


def _assembly(system: System, shape: Shape, rest: list[Demanded]) -> Assembly:
    """Raises Undecided for a condition that no residual is known for, and where residuals are too few."""
    there = replace(system, shape=shape)
    parts = []
    for condition, demand in rest:
        parts += [part for part in _parts(there, condition, demand) if not _is_kept_anyway(part, condition, shape)]
    if len(shape.unknowns) > len(parts) + shape.homogeneous:
        raise Undecided(_too_few(len(shape.unknowns) - len(parts) - shape.homogeneous))
    if shape.homogeneous:
        parts.append(Residual(sp.Add(*(u**2 for u in shape.unknowns)) - 1))
    found = Residuals(system.problem.variable, shape.unknowns, tuple(parts), shape.homogeneous)
    return Assembly(shape.numerator, shape.denominator, found, tuple(c for c, _ in rest))


def _is_kept_anyway(part: Residual, condition: AbstractCondition, shape: Shape) -> bool:
    """Whether a residual is zero whatever the unknowns are; Undecided where it is anything else without them."""
    if part.moments or part.plain.has(*shape.unknowns):
        return False
    if is_zero(part.plain) is False:
        raise Undecided(
            f"no member of this form keeps the {describe(condition)}: it is off by {part.plain} in all of them"
        )
    return True


def _with_linear_unknowns_solved(assembly: Assembly) -> Assembly:
    """Unknowns that stand alone and linear in a residual are put in: exact, and no search for their size."""
    residuals = assembly.residuals
    for part in residuals.parts:
        plain = sp.S.Zero if part.moments else sp.fraction(sp.together(inverted(part.plain, residuals.unknowns)))[0]
        for unknown in residuals.unknowns:
            slope = sp.diff(plain, unknown)
            if slope == 0 or slope.free_symbols & set(residuals.unknowns) or is_zero(slope) is not False:
                continue
            value = {unknown: sp.cancel(-plain.subs(unknown, 0) / slope)}
            others = tuple(p.subs(value) for p in residuals.parts if p is not part)
            left = tuple(u for u in residuals.unknowns if u != unknown)
            return _with_linear_unknowns_solved(
                replace(
                    assembly,
                    numerator=assembly.numerator.subs(value),
                    denominator=assembly.denominator.subs(value),
                    residuals=replace(residuals, unknowns=left, parts=others),
                )
            )
    return assembly


def _too_few(missing: int) -> str:
    what = "one more condition is" if missing == 1 else f"{missing} more conditions are"
    return (
        f"equations that are not linear leave {missing} coefficient{'s' * (missing > 1)} open, and such a family has "
        f"no formula: {what} needed (a value or a slope at a place, as in --value AT), or a smaller form"
    )


def _parts(system: System, condition: AbstractCondition, demand: sp.Expr) -> list[Residual]:
    if isinstance(condition, Integral):
        return [_integral(system, condition, demand)]
    if isinstance(condition, Limit):
        return [Residual(limit - demand) for limit in _limits(system, condition)]
    return [Residual(residual) for residual in residuals(system, condition, demand)]


def _limits(system: System, condition: Limit) -> list[sp.Expr]:
    """The limit from each side as a formula of the unknowns, taken for positive, or else for negative.

    exp(-b*x) tends to 0 for a positive b alone: whether the signs are those of the solution, verifying tells.
    """
    function = (system.shape.expression - condition.minus) * condition.scale
    found = []
    for side in sides_of(system, condition):
        (moved,) = local_coordinate([function], system.problem.variable, condition.at, side)
        limit = next((value for sign in (1, -1) if (value := _signed_limit(system, moved, sign)) is not None), None)
        if limit is None:
            raise Undecided(
                f"the limit of this form at {condition.place} is no formula of its unknowns, whether they are positive "
                "or negative; state values or slopes instead"
            )
        found.append(limit)
    return found


def _signed_limit(system: System, moved: sp.Expr, sign: int) -> sp.Expr | None:
    positive = {u: sp.Dummy(u.name, positive=True) for u in system.shape.unknowns}
    back = {dummy: sign * u for u, dummy in positive.items()}
    value = sp.nan
    with TimeLimit(LIMIT_SECONDS), suppress(NotImplementedError, ValueError, RecursionError):
        value = sp.limit(moved.xreplace({u: sign * dummy for u, dummy in positive.items()}), LOCAL, 0, "+")
    known = not value.has(sp.nan, sp.oo, -sp.oo, sp.zoo, sp.Limit, sp.AccumBounds, sp.sign)
    return value.xreplace(back) if known else None


def _integral(system: System, condition: Integral, demand: sp.Expr) -> Residual:
    """The moment, in pieces between the kinks of the weight."""
    inside, rest = integral_parts(system.problem, condition)
    integrand = condition.weight * system.shape.factor * system.shape.numerator / system.shape.denominator
    pieces = smooth_pieces(integrand, system.problem.variable, inside)
    return Residual(rest - demand, tuple(Moment(piece, low, high) for piece, (low, high) in pieces))
