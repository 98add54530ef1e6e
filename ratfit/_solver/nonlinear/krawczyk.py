"""Krawczyk: a proof that a true root, and only one, lies in a tiny box around a polished one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import flint
import mpmath
from flint import arb, arb_mat

from ratfit._parse import RatfitError
from ratfit._solver.nonlinear.enclosure import Enclosure, bits, enclosure
from ratfit._solver.nonlinear.residuals import Residuals

GUARD_DIGITS = 20
SLOPE_DIGITS = 40
"""Of the Jacobian over the box: it need only be near enough to an inverse, so a box that is wider adds nothing."""

WIDEST = 12
"""The widest box tried has the radius 10**-WIDEST: a point that needs more was no root to begin with."""

_PIVOT = 1e-18
"""A pivot this small against the largest entry of its row's start counts as 0: the roots come from 16 digits."""


@dataclass(frozen=True)
class Certificate:
    """`radius`: of the box, "1e-48" for one, in which exactly one true root is proved; None where nothing is proved.

    For an overdetermined system that root is one of as many residuals as unknowns; `reason` names the others, whose
    balls merely contain 0.
    """

    radius: str | None
    reason: str


def certificate(residuals: Residuals, root: Sequence[arb | mpmath.mpf | float], digits: int = 50) -> Certificate:
    """Proves by the Krawczyk test that a box around the root holds a true root of the residuals, and only one.

    **Arguments:**

    - `residuals`: without parameters, at least as many as unknowns.
    - `root`: a polished root, taken as the exact centre of the box.
    - `digits`: to which the root is right; the smallest box tried is a hundred times as wide as its last digit.

    **Returns:** the smallest box that proves, or why none does. `radius` bounds |u_i - root_i| for every unknown; the
    box, in which the root is the only one, is narrower for an unknown that is smaller than others of more than 1.

    Source: R. Krawczyk, "Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken", Computing 4 (1969);
    uniqueness: A. Neumaier, "Interval Methods for Systems of Equations" (1990), theorem 5.1.8.
    """
    if len(residuals.parts) < len(residuals.unknowns):
        return Certificate(None, "fewer residuals than unknowns: a root is not isolated, so none can be certified")
    try:
        system = enclosure(residuals)
    except RatfitError as error:
        return Certificate(None, str(error))
    return _certified(system, [_exact(value) for value in root], digits)


def _certified(system: Enclosure, centre: list[arb], digits: int) -> Certificate:
    with flint.ctx.workprec(bits(digits + GUARD_DIGITS)):
        found = system.values(centre)
    with flint.ctx.workprec(bits(SLOPE_DIGITS)):
        slopes = system.jacobian(centre)
        if not all(ball.is_finite() for ball in (*found, *(slope for row in slopes for slope in row))):
            return Certificate(None, "no finite ball holds the residuals and their derivatives at the root")
        rows = _independent_rows(slopes)
        if rows is None:
            return Certificate(None, "the Jacobian is singular at the root: a multiple root, or a family of them")
        inverse = _inverse([slopes[row] for row in rows])
        if inverse is None:
            return Certificate(None, "the Jacobian is too near to a singular one: perhaps a multiple root")
        step = inverse * arb_mat([[found[row]] for row in rows])
        scales = [max(arb(1), abs(value)) for value in centre]
        for exponent in _exponents(step.entries(), scales, digits):
            # A shade less than the power of ten: the radius that is reported is rounded up.
            radii = [(scale * arb(10) ** -exponent * arb(0.999)).mid() for scale in scales]
            box = [arb(value, radius) for value, radius in zip(centre, radii, strict=True)]
            image = _image(system, rows, inverse, step.entries(), box)
            if all(bool(abs(part) < ball.rad()) for part, ball in zip(image, box, strict=True)):
                return _conclusion(system, rows, box, image, digits)
    return Certificate(None, _refusal(step.entries()))


def _exact(value: arb | mpmath.mpf | float) -> arb:
    if isinstance(value, arb):
        return value.mid()
    sign, mantissa, exponent, _ = mpmath.mpf(value)._mpf_
    return arb((-int(mantissa) if sign else int(mantissa), int(exponent)))


def _independent_rows(slopes: list[list[arb]]) -> list[int] | None:
    """As many rows as unknowns, by elimination with complete pivoting of scaled rows; None where the rank is less."""
    matrix = [[float(slope.mid()) for slope in row] for row in slopes]
    scaled = {i: [v / (max(map(abs, row)) or 1.0) for v in row] for i, row in enumerate(matrix)}
    columns, chosen = set(range(len(matrix[0]))), []
    while columns:
        size, row, column = max((abs(scaled[i][j]), i, j) for i in scaled for j in columns)
        if size < _PIVOT:
            return None
        pivot = scaled.pop(row)
        scaled = {i: _eliminated(other, pivot, column) for i, other in scaled.items()}
        columns.remove(column)
        chosen.append(row)
    return sorted(chosen)


def _eliminated(row: list[float], pivot: list[float], column: int) -> list[float]:
    factor = row[column] / pivot[column]
    return [value - factor * other for value, other in zip(row, pivot, strict=True)]


def _inverse(slopes: list[list[arb]]) -> arb_mat | None:
    """Any matrix will do for the test: the midpoint of the inverse, taken as exact."""
    try:
        inverse = arb_mat(slopes).mid().inv().mid()
    except ZeroDivisionError:
        return None
    return inverse if all(entry.is_finite() for entry in inverse.entries()) else None


def _exponents(step: Sequence[arb], scales: Sequence[arb], digits: int) -> Iterator[int]:
    """Of the radii to be tried, smallest first: no box smaller than the Newton step from its centre can prove."""
    least = max(float(abs(part).upper() / scale) for part, scale in zip(step, scales, strict=True))
    fitting = [k for k in range(digits - 2, WIDEST - 1, -1) if least < 0.5 * 10.0**-k]
    yield from fitting[:3]
    yield from fitting[5::6]


def _image(
    system: Enclosure, rows: Sequence[int], inverse: arb_mat, step: Sequence[arb], box: Sequence[arb]
) -> list[arb]:
    """-Y f(c) + (1 - Y J(X)) (X - c): inside X - c it proves one root in X, which then lies in c + image too."""
    slopes, size = system.jacobian(box), len(box)
    identity = arb_mat(size, size, [int(i == j) for i in range(size) for j in range(size)])
    defect = identity - inverse * arb_mat([slopes[row] for row in rows])
    moved = defect * arb_mat([[arb(0, ball.rad())] for ball in box])
    return [part - first for part, first in zip(moved.entries(), step, strict=True)]


def _conclusion(
    system: Enclosure, rows: Sequence[int], box: Sequence[arb], image: Sequence[arb], digits: int
) -> Certificate:
    radius = _written(max((ball.rad() for ball in box), key=float))
    others = [i for i in range(len(system.terms)) if i not in rows]
    proof = f"Krawczyk test: exactly one root in a box of radius {radius}"
    if not others:
        return Certificate(radius, proof)
    with flint.ctx.workprec(bits(digits + GUARD_DIGITS)):
        balls = system.values([ball.mid() + part for ball, part in zip(box, image, strict=True)])
    names = ", ".join(str(i + 1) for i in others)
    if not all(balls[i].contains(0) for i in others):  # a ball that is not finite contains 0
        return Certificate(None, f"no common root of the residuals within {radius}: not all of {names} vanish there")
    widest = _written(max((abs(balls[i]).upper() for i in others), key=float))
    kept = ", ".join(str(row + 1) for row in rows)
    return Certificate(
        radius, f"{proof} of the residuals {kept}; not proved: {names}, which are at most {widest} at this root"
    )


def _written(bound: arb) -> str:
    """One significant digit, rounded up."""
    exponent = int(mpmath.floor(mpmath.log10(mpmath.mpf(float(bound))))) if bound > 0 else 0
    leading = next((k for k in range(1, 11) if bound <= k * arb(10) ** exponent), 11)
    return f"{leading}e{exponent}" if leading < 10 else f"{1 if leading == 10 else 2}e{exponent + 1}"


def _refusal(step: Sequence[arb]) -> str:
    largest = max(float(abs(part).upper()) for part in step)
    if largest > 10.0**-WIDEST:
        return f"not near enough to a simple root: Newton's method would move it by {largest:.1e}"
    return "no box proves a root: the Jacobian is singular or nearly so in all of them, as at a multiple root"
