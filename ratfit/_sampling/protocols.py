"""The protocols by name: what each of them draws, and how it carries fractions of (0, 1) to a point of the domain."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from ratfit._sampling.counter import direction_fractions, fractions
from ratfit._sampling.directions import (
    Coordinate,
    hemisphere_t,
    hemisphere_u,
    hemisphere_v,
    hemisphere_v_prime,
    hemisphere_w,
    plane_t,
    plane_u,
    plane_v,
)
from ratfit._sampling.ends import Ends
from ratfit._sampling.portable import product, quarter_sine, root
from ratfit._sampling.sobol import sobol_fractions

PROTOCOLS: Mapping[str, str] = {
    "uniform": "the variable uniform on its domain",
    "angle": "the variable is cos(theta), theta uniform",
    "cosine": "density proportional to the variable, a cosine",
    "in-plane": "pairs of directions in a plane with the normal, both angles uniform on (-pi/2, pi/2)",
    "hemisphere": "pairs of directions uniform over the hemisphere by solid angle",
    "sobol": "Sobol's points in the variable and the random parameters, with a random digital shift",
    "exhaustive": "every number of the dtype in the closed domain, in increasing order",
}
"""Every sampling protocol, name -> what it draws."""


@dataclass(frozen=True)
class Carrier:
    """How a protocol gets a point of the domain, in float64 and not yet rounded to the dtype under test."""

    point: Callable[[Coordinate, Ends], Any]
    variable: Callable[[Any, Any, int], Any] = fractions  # (seed, counters, coordinate): the variable's coordinates
    parameter: Callable[[Any, Any, int], Any] = fractions  # the same, of the parameters drawn at random
    others: tuple[Callable[[Coordinate], Any], ...] = ()  # what else of the same pair of directions, before parameters


def uniform(fraction: Any, ends: Ends) -> Any:
    return ends.low + product(ends.high - ends.low, fraction)


def _variable(coordinate: Coordinate, ends: Ends) -> Any:
    return uniform(coordinate(0), ends)


def _angle(coordinate: Coordinate, ends: Ends) -> Any:
    """Uniform in asin(mu), which is uniform in acos(mu) and increasing."""
    return quarter_sine(ends.low_turn + product(ends.high_turn - ends.low_turn, coordinate(0)))


def _cosine(coordinate: Coordinate, ends: Ends) -> Any:
    """sqrt(low^2 + (high^2 - low^2) xi), in units of `high`, whose square may be too small for a number."""
    ratio = ends.low / ends.high
    square = product(ratio, ratio) + product(product(1 - ratio, 1 + ratio), coordinate(0))
    return product(ends.high, root(square))


def _pair(quantity: Callable[[Coordinate], Any]) -> Carrier:
    return Carrier(lambda coordinate, ends: quantity(coordinate), direction_fractions)


CARRIERS: Mapping[str, Carrier] = {
    "uniform": Carrier(_variable),
    "angle": Carrier(_angle),
    "cosine": Carrier(_cosine),
    "in-plane:t": _pair(plane_t),
    "in-plane:u": _pair(plane_u),
    "in-plane:v": _pair(plane_v),
    "hemisphere:t": _pair(hemisphere_t),
    "hemisphere:u": _pair(hemisphere_u),
    "hemisphere:v": _pair(hemisphere_v),
    "hemisphere:w": _pair(hemisphere_w),
    "hemisphere:pair": replace(
        _pair(hemisphere_t), others=(hemisphere_u, hemisphere_v, hemisphere_v_prime, hemisphere_w)
    ),
    "sobol": Carrier(_variable, sobol_fractions, sobol_fractions),
}
"""Every protocol that draws at random, by its canonical name, which says which cosine of a pair the variable is.

`hemisphere:pair` draws all five cosines of a pair together, for a formula of all of them (`Setting.whole`).
"""
