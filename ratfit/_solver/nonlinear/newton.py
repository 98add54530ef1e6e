"""Newton's method at many places at once: damped from far away, pure close to a root."""

from __future__ import annotations

import numpy as np

from ratfit._solver.nonlinear.arrays import Prepared, System, Values

ROOT, NEAR = 1e-9, 1e-7
"""How small a residual must be relative to its terms, and Newton's step relative to the unknowns, at a root."""

FLOOR = 1e-3
"""The size below which an unknown counts as small: what is relative is relative to at least this."""

ROUNDING = 1e-14
"""What rounding leaves of a linear equation, relative to its coefficients and unknowns."""

DAMPING, TINY, CLOSE = 1e-3, 1e-15, 1e-26
"""The damping at the start, that which keeps every matrix regular, and the weighted sum of squares that is enough."""

_QUIET = np.errstate(all="ignore")  # a start may lie on a pole; what is no number is sorted out by comparison

SINGULAR = 1e-13
"""Singular values below this share of the greatest count as zero."""


@_QUIET
def roots(values: Values, unknowns: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Which places are roots, given Newton's next step from each (places, unknowns): (places,) of bool.

    The residuals must be small against their terms; or the step must be small, and what it leaves over. The latter
    because a residual u0 = 0 is met at u0 = 1e-17, though it is as large as its only term; the former because the step
    from a root of an ill-conditioned system is not small. Terms that have all underflowed, exp(-1000), meet nothing;
    nor does a residual of 1e200 that a step of 1e-28 would cancel.
    """
    length = np.linalg.norm(unknowns, axis=1) + FLOOR
    scale = values.size + (np.abs(values.jacobian) * np.abs(unknowns)[:, None]).sum(2)
    alive = (values.size > 0) | (values.jacobian != 0).any(2)
    left = np.abs(values.value + np.matmul(values.jacobian, step[..., None])[..., 0])
    rounding = ROUNDING * np.linalg.norm(values.jacobian, axis=2) * length[:, None]
    short = (np.linalg.norm(step, axis=1) <= NEAR * length)[:, None] & (np.abs(values.value) <= FLOOR)
    met = (np.abs(values.value) <= ROOT * scale) | (short & (left <= ROOT * scale + rounding))
    return (met & alive & np.isfinite(scale)).all(1)


@_QUIET
def scales(values: Values, unknowns: np.ndarray) -> np.ndarray:
    """What each residual is small against, (places, residuals): its terms, and what the unknowns do to it."""
    return values.size + (np.abs(values.jacobian) * (np.abs(unknowns)[:, None] + FLOOR)).sum(2)


@_QUIET
def damped(system: System, starts: np.ndarray, prepared: Prepared, steps: int = 60) -> np.ndarray:
    """Levenberg and Marquardt's method from every start, at most so many steps: where each ended.

    A step that leads to a larger sum of squares is refused, and so is one across a pole: an integral that has one on
    its range is no number, though its nodes make a smooth function of it, with false roots.

    **Arguments:** `starts` (places, unknowns); `prepared` with one row for all or one for each. **Returns:** the same
    shape as `starts`.
    """
    here, damping = starts.copy(), np.full(len(starts), DAMPING)
    values = system.at(here, prepared)
    weights = _weights(values)
    active = np.flatnonzero(np.isfinite(_squares(values, weights)))
    values = values.take(active)
    for _ in range(steps):
        if not len(active):
            break
        step = _marquardt(values, weights, damping[active])
        moved = system.at(here[active] + step, prepared.take(active))
        before, after = _squares(values, weights), _squares(moved, weights)
        better = (after < before) & (values.broken | ~moved.broken)
        here[active] += np.where(better[:, None], step, 0.0)
        damping[active] *= np.where(better, 0.1, 4.0)
        values = moved.where(better, values)
        keep = (np.where(better, after, before) > CLOSE) & (damping[active] < 1e12)
        active, values = active[keep], values.take(keep)
    return here


@_QUIET
def newton(system: System, starts: np.ndarray, prepared: Prepared, steps: int = 8) -> tuple[np.ndarray, np.ndarray]:
    """Newton's method by least squares, from places that lie close to a root, while its steps become shorter.

    That is deuflhard2011's natural test, blind to the units of the residuals.

    **Arguments:** as for `damped`. **Returns:** the places (places, unknowns), and which are roots, (places,) of bool.
    """
    here, values = starts.copy(), system.at(starts, prepared)
    step = full_step(values)
    active = np.arange(len(here))
    for _ in range(steps):
        there = here[active] + step[active]
        moved = system.at(there, prepared.take(active))
        following = full_step(moved)
        shorter = np.linalg.norm(following, axis=1) < np.linalg.norm(step[active], axis=1)
        shorter &= np.isfinite(moved.value).all(1)
        active = active[shorter]
        if not active.size:
            break
        here[active], step[active] = there[shorter], following[shorter]
        values.put(active, moved.take(shorter))
    return here, roots(values, here, step)


@_QUIET
def full_step(values: Values) -> np.ndarray:
    """The least squares solution of the linearised equations: (places, unknowns).

    Rows and then columns are scaled to length 1: unknowns or conditions in units a million apart look singular
    otherwise. Where the equations leave the step open, the shortest in the scaled unknowns.
    """
    finite = np.isfinite(values.jacobian).all((1, 2)) & np.isfinite(values.value).all(1)
    jacobian = np.where(finite[:, None, None], values.jacobian, 0.0)
    rows = _lengths(jacobian, 2)
    jacobian = jacobian / rows[:, :, None]
    columns = _lengths(jacobian, 1)
    value = np.where(finite[:, None], values.value / rows, 0.0)
    inverse = np.linalg.pinv(jacobian / columns[:, None], rcond=SINGULAR)
    return -np.matmul(inverse, value[..., None])[..., 0] / columns


def _lengths(matrices: np.ndarray, axis: int) -> np.ndarray:
    """Of the rows or columns, 1 for those of zeros."""
    largest = np.abs(matrices).max(axis, keepdims=True)  # first, lest squares overflow
    largest = np.where(largest > 0, largest, 1.0)
    lengths = np.linalg.norm(matrices / largest, axis=axis) * largest.squeeze(axis)
    return np.where(lengths > 0, lengths, 1.0)


@_QUIET
def misfit(values: Values, unknowns: np.ndarray) -> np.ndarray:
    """The largest residual relative to its scale, (places,); infinite where one is no number."""
    share = np.abs(values.value) / scales(values, unknowns)
    return np.where(np.isfinite(values.value), np.nan_to_num(share), np.inf).max(1)


@_QUIET
def _weights(values: Values) -> np.ndarray:
    """One over the typical size of each residual: a condition stated in other units finds the same roots."""
    sizes = np.where(np.isfinite(values.size) & (values.size > 0), values.size, np.nan)
    typical = [np.median(column[np.isfinite(column)]) if np.isfinite(column).any() else 1.0 for column in sizes.T]
    return 1 / np.array(typical)


@_QUIET
def _squares(values: Values, weights: np.ndarray) -> np.ndarray:
    squares = ((values.value * weights) ** 2).sum(1)
    return np.where(np.isfinite(squares) & np.isfinite(values.jacobian).all((1, 2)), squares, np.inf)


@_QUIET
def _marquardt(values: Values, weights: np.ndarray, damping: np.ndarray) -> np.ndarray:
    """The damped step, with the scaling of the unknowns by the lengths of the Jacobian's columns (more1978)."""
    jacobian = np.nan_to_num(values.jacobian * weights[:, None])
    lengths = _lengths(jacobian, 1)
    jacobian = jacobian / lengths[:, None]
    transposed = jacobian.transpose(0, 2, 1)
    normal = transposed @ jacobian + (damping[:, None, None] + TINY) * np.eye(jacobian.shape[2])
    right = np.nan_to_num(transposed @ (values.value * weights)[..., None])
    return -np.linalg.solve(normal, right)[..., 0] / lengths
