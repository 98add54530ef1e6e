"""Polish: a root known to a float's precision becomes one of 50 digits and more."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TypeAlias

import flint
import mpmath
import sympy as sp
from flint import arb, arb_mat

from ratfit._multiprecise import compiled, midpoint
from ratfit._parse import RatfitError
from ratfit._solver.nonlinear.enclosure import Enclosure, bits, enclosure
from ratfit._solver.nonlinear.residuals import Moment, Residual, Residuals

Point: TypeAlias = list[arb]

WANDERING = 1e-3
"""How far from the start, relative to 1 + its size, the polished root may lie: further off it is another root."""

GUARD_DIGITS = 20
FIRST_DIGITS = 36  # a Newton step from a float's 16 digits gives about 32
STEPS = 16
_SLOPE_DIGITS = 35
_WORTHWHILE = 9.0  # digits that a step must add for the slopes of an earlier one to stay


def polished(residuals: Residuals, start: Sequence[float], digits: int = 60) -> list[arb] | None:
    """Newton's method from a root in floats, in multiprecision; Gauss-Newton where residuals outnumber unknowns.

    **Arguments:**

    - `residuals`: without parameters.
    - `start`: the root in floats.
    - `digits`: the residuals fall below 10**-(digits - 10), relative to the size of their terms and slopes.

    **Returns:** exact midpoints, which prove nothing by themselves; None where the method does not converge, as at a
    multiple root, leaves the neighbourhood of the start, or has fewer residuals than unknowns.

    **Fails** with `RatfitError` where a parameter has no value.
    """
    _check(residuals)
    if len(residuals.parts) < len(residuals.unknowns):
        return None
    origin = [arb(float(value)) for value in start]
    if not all(value.is_finite() for value in origin):
        return None
    try:
        system = enclosure(residuals)
    except RatfitError:
        return _polished_without_balls(residuals, origin, digits)
    return _newton(system, origin, digits)


def _check(residuals: Residuals) -> None:
    known = {residuals.variable, *residuals.unknowns}
    parts = [part.plain for part in residuals.parts] + [m.integrand for part in residuals.parts for m in part.moments]
    missing = set().union(*(part.free_symbols for part in parts)) - known
    if missing:
        names = ", ".join(sorted(str(symbol) for symbol in missing))
        raise RatfitError(f"a root is polished at values of the parameters: give {names} with Residuals.at")


def _newton(system: Enclosure, origin: Point, digits: int) -> Point | None:
    """Newton's method with slopes that stay while each step still adds `gain` digits: they cost most of the time.

    The precision follows the digits that are right: a residual is worth computing to those that its step will reach.
    """
    most = digits + GUARD_DIGITS
    point, working, right, gain, slopes = origin, min(FIRST_DIGITS, most), 0.0, 0.0, [[arb(0)]]
    for _ in range(STEPS):
        with flint.ctx.workprec(bits(working)):
            found, sizes = system.sized(point)
        fresh = gain < _WORTHWHILE
        if fresh:
            with flint.ctx.workprec(bits(working / 2 + 5)):
                slopes = system.jacobian(point)
        with flint.ctx.workprec(bits(working)):
            step = _step(slopes, found)
        if working == most and _vanish(found, sizes, slopes, digits - 10):
            return point if step is None else _moved(point, step, origin, digits)
        moved = None if step is None else _moved(point, step, origin, digits)
        if step is None or moved is None:
            return None
        before, right = right, _right_digits(step, point)
        gain = right if fresh else right - before
        point, working = moved, min(most, max(working, math.ceil(right + 2 * gain + 8)))
    return None


def _step(slopes: list[list[arb]], found: Point) -> Point | None:
    """The Newton step at the midpoints, by the normal equations where there are more rows than columns."""
    matrix = arb_mat([[slope.mid() for slope in row] for row in slopes])
    right = arb_mat([[-value.mid()] for value in found])
    if matrix.nrows() > matrix.ncols():
        matrix, right = matrix.transpose() * matrix, matrix.transpose() * right
    try:
        step = [value.mid() for value in matrix.solve(right).entries()]
    except ZeroDivisionError:
        return None
    return step if all(value.is_finite() for value in step) else None


def _moved(point: Point, step: Point, origin: Point, digits: int) -> Point | None:
    with flint.ctx.workprec(bits(digits + 2 * GUARD_DIGITS)):
        moved = [(value + change).mid() for value, change in zip(point, step, strict=True)]
        size = 1 + max(abs(value) for value in origin)
        near = all(abs(new - old) < WANDERING * size for new, old in zip(moved, origin, strict=True))
    return moved if near else None


def _vanish(found: Point, sizes: Point, slopes: list[list[arb]], digits: int) -> bool:
    """Against the terms, and the slopes: at 0 as a root of b + b**2 all terms vanish with the residual."""
    limit = arb(10) ** -digits
    scales = [sum((abs(slope.mid()) for slope in row), size.mid()) for size, row in zip(sizes, slopes, strict=True)]
    return all(bool(abs(value) <= limit * scale) for value, scale in zip(found, scales, strict=True))


def _right_digits(step: Point, point: Point) -> float:
    """The digits that were right before this step."""
    moved = max(float(abs(change)) for change in step) / (1 + max(float(abs(value)) for value in point))
    return min(400.0, -math.log10(moved)) if moved > 0 else 400.0


def _polished_without_balls(residuals: Residuals, origin: Point, digits: int) -> Point | None:
    """The same by mpmath, where a function jumps: slopes are differences, taken once, so each step adds 15 digits."""
    system = _multiprecise(residuals)
    point = [_to_mpf(value, digits + GUARD_DIGITS) for value in origin]
    try:
        with mpmath.workdps(_SLOPE_DIGITS):
            slopes = _differences(system, point)
        with mpmath.workdps(digits + GUARD_DIGITS):
            return _chord(system, slopes, point, origin, digits)
    except (ZeroDivisionError, ValueError, TypeError, NameError, mpmath.libmp.NoConvergence):
        return None  # TypeError: a value that is not real; NameError: a function that mpmath does not have


_Values: TypeAlias = tuple[list[mpmath.mpf], list[mpmath.mpf]]  # residuals, and how large their terms are


def _chord(
    system: Callable[[Sequence[mpmath.mpf]], _Values],
    slopes: mpmath.matrix,
    point: list[mpmath.mpf],
    origin: Point,
    digits: int,
) -> Point | None:
    for _ in range(STEPS):
        found, sizes = system(point)
        step = mpmath.lu_solve(slopes, mpmath.matrix([-value for value in found]))
        moved = _moved([_to_arb(v) for v in point], [_to_arb(v) for v in step], origin, digits)
        if moved is None:
            return None
        point = [_to_mpf(value, digits + 2 * GUARD_DIGITS) for value in moved]
        limit = mpmath.mpf(10) ** -(digits - 10)
        scales = [size + mpmath.fsum(map(abs, slopes[i, :])) for i, size in enumerate(sizes)]
        if all(abs(value) <= limit * scale for value, scale in zip(found, scales, strict=True)):
            return moved
    return None


def _differences(system: Callable[[Sequence[mpmath.mpf]], _Values], point: list[mpmath.mpf]) -> mpmath.matrix:
    here, columns = system(point)[0], []
    for place, value in enumerate(point):
        length = mpmath.mpf(10) ** -(_SLOPE_DIGITS // 2) * (1 + abs(value))
        there = system([*point[:place], value + length, *point[place + 1 :]])[0]
        columns.append([(new - old) / length for new, old in zip(there, here, strict=True)])
    return mpmath.matrix(columns).T


def _multiprecise(residuals: Residuals) -> Callable[[Sequence[mpmath.mpf]], _Values]:
    parts = [_terms(part, residuals) for part in residuals.parts]

    def system(values: Sequence[mpmath.mpf]) -> _Values:
        terms = [[term(values) for term in part] for part in parts]
        return [mpmath.fsum(part) for part in terms], [mpmath.fsum(map(abs, part)) for part in terms]

    return system


def _terms(part: Residual, residuals: Residuals) -> list[Callable[[Sequence[mpmath.mpf]], mpmath.mpf]]:
    plain = [compiled(term, residuals.unknowns) for term in sp.Add.make_args(part.plain)]
    return [
        *(lambda values, f=function: f(*values) for function in plain),
        *(_quadrature(moment, residuals) for moment in part.moments),
    ]


def _quadrature(moment: Moment, residuals: Residuals) -> Callable[[Sequence[mpmath.mpf]], mpmath.mpf]:
    """By mpmath, whose error estimate is taken at its word; ValueError where it admits too large a one."""
    function = compiled(moment.integrand, (residuals.variable, *residuals.unknowns))
    ends = [compiled(end, ()) for end in (moment.low, moment.high)]

    def value(values: Sequence[mpmath.mpf]) -> mpmath.mpf:
        interval = [mpmath.mpf(end()) for end in ends]
        found, error = mpmath.quad(lambda place: function(place, *values), interval, error=True)
        if error > mpmath.mpf(10) ** -(mpmath.mp.dps - 2 * GUARD_DIGITS // 3) * (1 + abs(found)):
            raise ValueError("the quadrature does not converge")
        return found

    return value


def _to_arb(value: mpmath.mpf) -> arb:
    sign, mantissa, exponent, _ = mpmath.mpf(value)._mpf_
    return arb((-int(mantissa) if sign else int(mantissa), int(exponent)))


def _to_mpf(value: arb, digits: int) -> mpmath.mpf:
    with mpmath.workdps(digits):
        return midpoint(value)
