"""What part of the plane a picture shows: where infinite domains are cut, how high it is, and gaps at poles."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise

CUTS = (1, 2, 3, 5, 10, 20, 50, 100, 1000)
"""Where an infinite domain may be cut: the first at which the curve has come near its limit."""


def cut(height: Callable[[float], float], start: float, side: int, limit: float | None, reach: float) -> float:
    """How far from `start` an infinite domain is drawn.

    Arguments: `height`, the function of the place; `side`, 1 to the right and -1 to the left; `limit`, the function's,
    None where it has none; `reach`, what must be seen at least.
    """
    for there in CUTS:
        if there < reach:
            continue
        if limit is None:
            return max(10.0, there)
        heights = [height(start + side * there * k / 20) for k in range(1, 21)]
        finite = [h for h in heights if math.isfinite(h)] or [0.0]
        if abs(finite[-1] - limit) <= 0.03 * max(max(finite) - min(finite), abs(limit), 1e-300):
            return float(there)
    return max(10.0, reach)


def broken(places: Sequence[float], heights: Sequence[float], poles: Sequence[float] = ()) -> list[float]:
    """The heights with a gap at every pole and jump, so that no line joins the branches.

    `poles` are those that are known. Others show themselves by a change of sign towards which the curve grows from
    both sides, and jumps by a leap that nothing beside it announces.
    """
    step = max(b - a for a, b in pairwise(places))
    found = [
        math.nan if any(abs(p - pole) < step for pole in poles) else h for p, h in zip(places, heights, strict=True)
    ]
    finite = [h for h in found if math.isfinite(h)]
    height = (max(finite) - min(finite)) if finite else 0.0
    for k in range(2, len(found) - 1):
        leap, before, after = (abs(found[j] - found[j - 1]) for j in (k, k - 1, k + 1))
        if height and leap > 0.02 * height and (leap > 20 * max(before, after) or is_pole(heights, k)):
            found[k] = math.nan
    return found


def is_pole(heights: Sequence[float], k: int) -> bool:
    """Whether the sign changes before place k at a pole: the curve grows towards it from both sides."""
    outer, left, right, far = heights[k - 2 : k + 2]
    return left * right < 0 and abs(left) > 1.5 * abs(outer) and abs(right) > 1.5 * abs(far)


def span(heights: Iterable[float], marked: Iterable[float], with_poles: bool) -> tuple[float, float]:
    """The range of heights to show; near poles the outermost tenths are cut away."""
    ordered = sorted(h for h in heights if math.isfinite(h))
    if not ordered:
        return -1.0, 1.0
    keep = 0.08 if with_poles else 0.0
    shown = ordered[int(keep * (len(ordered) - 1)) : int((1 - keep) * (len(ordered) - 1)) + 1]
    shown = shown + [h for h in marked if math.isfinite(h)]
    low, high = min(shown), max(shown)
    margin = 0.08 * (high - low) or 0.5 * (abs(high) or 1.0)
    return low - margin, high + margin
