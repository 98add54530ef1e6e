"""Quadrature in float64: nodes and weights on a range, and which rule settles an integrand."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

FEWEST, MOST = 48, 1536
"""Nodes of the first rule that is tried, and of the last."""

Name: TypeAlias = Literal["gauss", "tanh-sinh"]
NAMES: tuple[Name, ...] = ("gauss", "tanh-sinh")

TOLERANCE = 1e-11
"""The estimated error, relative to the integral of the absolute value, below which a rule has settled."""

FARTHEST = 5.0
"""Where the double exponential rules end: exp(-pi/2*sinh(5)) is about 1e-51, so x**(-9/10) at 0 loses 1e-5 at worst."""


@dataclass(frozen=True)
class Rule:
    """Gauss-Legendre nodes ("gauss"), or the trapezoidal rule after a double exponential map ("tanh-sinh").

    The former converges geometrically where the integrand is analytic up to both ends, the latter also where it is
    singular at an end (takahasi1974). An infinite range is first mapped to a finite one for Gauss-Legendre, by
    x = low + (1 + s)/(1 - s) or x = s/(1 - s**2); the double exponential map has a form of its own for each case.
    """

    count: int = FEWEST
    name: Name = "gauss"

    @property
    def doubled(self) -> Rule:
        return Rule(2 * self.count, self.name)

    def on(self, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The nodes and weights on ranges, each of shape (ranges, count).

        **Arguments:** `low` and `high`, of shape (ranges,), finite in all ranges or infinite in all.
        """
        singular = self.name == "tanh-sinh"
        steps, weights = _trapezoidal(self.count) if singular else _legendre(self.count)
        points, slopes = _mapped(steps, low[:, None], high[:, None], _DOUBLE if singular else _ALGEBRAIC)
        inside = (points > low[:, None]) & (points < high[:, None])
        # A node that rounds to an end counts nothing, at a place where the integrand is finite: 0*inf is nan.
        spare = np.take_along_axis(points, np.argmax(inside, axis=1)[:, None], axis=1)
        return np.where(inside, points, spare), np.where(inside, slopes * weights, 0.0)


def _mapped(steps: np.ndarray, low: np.ndarray, high: np.ndarray, maps: _Maps) -> tuple[np.ndarray, np.ndarray]:
    """The points of the ranges, and the slopes, at steps of the reference interval; each (ranges, count)."""
    upper, lower = bool(np.isinf(high).all()), bool(np.isinf(low).all())
    if upper and lower:
        return tuple(np.broadcast_to(part, (len(low), len(steps))) for part in maps.line(steps))  # type: ignore
    if upper or lower:
        distances, slopes = maps.ray(steps)
        return (low + distances if upper else high - distances), np.broadcast_to(slopes, (len(low), len(steps)))
    near, far, slopes = maps.segment(steps)
    # Each node from the end that it is nearer to: a distance to an end at 0 then keeps all its digits.
    points = np.where(near < far, low + (high - low) * near, high - (high - low) * far)
    return points, (high - low) * slopes


@functools.cache
def _legendre(count: int) -> tuple[np.ndarray, np.ndarray]:
    """By Newton's method from Tricomi's estimate of the zeros: numpy's matrix takes seconds for 1536."""
    zeros = np.cos(math.pi * (4 * np.arange(1, count + 1) - 1) / (4 * count + 2))
    for _ in range(6):
        value, before = zeros, np.ones(count)
        for degree in range(2, count + 1):
            value, before = ((2 * degree - 1) * zeros * value - (degree - 1) * before) / degree, value
        slopes = count * (before - zeros * value) / (1 - zeros**2)
        zeros = zeros - value / slopes
    return zeros[::-1].copy(), (2 / ((1 - zeros**2) * slopes**2))[::-1].copy()


@functools.cache
def _trapezoidal(count: int) -> tuple[np.ndarray, np.ndarray]:
    steps = np.linspace(-FARTHEST, FARTHEST, count)
    return steps, np.full(count, steps[1] - steps[0])


def _algebraic_segment(s: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return (1 + s) / 2, (1 - s) / 2, np.full_like(s, 0.5)


def _algebraic_ray(s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return (1 + s) / (1 - s), 2 / (1 - s) ** 2


def _algebraic_line(s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return s / (1 - s**2), (1 + s**2) / (1 - s**2) ** 2


def _steep(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return math.pi / 2 * np.sinh(t), math.pi / 2 * np.cosh(t)


def _double_segment(t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The distances from both ends as shares of the length, and the slope of the former."""
    inner, slope = _steep(t)
    near, far = 1 / (1 + np.exp(-2 * inner)), 1 / (1 + np.exp(2 * inner))
    return near, far, 2 * near * far * slope


def _double_ray(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    inner, slope = _steep(t)
    return np.exp(inner), np.exp(inner) * slope


def _double_line(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    inner, slope = _steep(t)
    return np.sinh(inner), np.cosh(inner) * slope


@dataclass(frozen=True)
class _Maps:
    """From the reference interval to a finite range, to one that is infinite at one end, and at both."""

    segment: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]
    ray: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
    line: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


_ALGEBRAIC = _Maps(_algebraic_segment, _algebraic_ray, _algebraic_line)
_DOUBLE = _Maps(_double_segment, _double_ray, _double_line)


@dataclass(frozen=True)
class Choice:
    """The rule that was chosen for an integrand, and the estimate of its error.

    `error` is the difference between the rule and the doubled one, relative to the integral of the absolute value; it
    is infinite where the integrand is not finite at some node.
    """

    rule: Rule
    error: float


Weighted: TypeAlias = Callable[[Rule], np.ndarray]
"""The values of an integrand at the nodes of a rule, each times its weight: (count,)."""


def weighted(integrand: Callable[[np.ndarray], np.ndarray], low: float, high: float) -> Weighted:
    """The values that rules sum, of a function of nodes (count,) on the range from low to high."""

    def values(rule: Rule) -> np.ndarray:
        points, weights = rule.on(np.array([float(low)]), np.array([float(high)]))
        return integrand(points[0]) * weights[0]

    return values


def confirmed(values: Weighted, rule: Rule) -> Choice:
    """The rule with the estimate of its error."""
    with np.errstate(all="ignore"):
        return Choice(rule, _relative_change(values(rule), values(rule.doubled)))


def choose(values: Weighted, tolerance: float = TOLERANCE) -> Choice:
    """The first rule whose sum the doubled rule confirms: Gauss-Legendre from 48 nodes upwards, then tanh-sinh.

    **Arguments:**

    - `values`: of the integrand at a rule's nodes, as `weighted` gives them.
    - `tolerance`: of the estimated error, relative to the integral of the absolute value.

    **Returns:** the rule and its estimated error. Where no rule reaches the tolerance, that with the least estimate: a
    pole inside the range shows in an estimate that stays large. The estimate is of the rule, not of rounding.
    """
    best = Choice(Rule(), math.inf)
    for name in NAMES:
        rule = Rule(FEWEST, name)
        while rule.count < MOST:
            choice = confirmed(values, rule)
            if choice.error <= tolerance:
                return choice
            best = min(best, choice, key=lambda each: each.error)
            rule = rule.doubled
    return best


def _relative_change(first: np.ndarray, second: np.ndarray) -> float:
    change, size = abs(first.sum() - second.sum()), np.abs(second).sum()
    if not (math.isfinite(change) and math.isfinite(size)):
        return math.inf
    return float(change / size) if size else 0.0
