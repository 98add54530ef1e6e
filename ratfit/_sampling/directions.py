"""Random pairs of directions, a view V and a light V', and the cosines by which a reflectance depends on them.

N is the normal and H the half vector between V and V'. In the letters of schlick1994, `v` = V.N, `u` = V.H, `t` = N.H,
and `w` is the cosine of the azimuth of H, taken in the first quadrant, as the paper has it. Each function takes
`coordinate`, which gives the fractions of a coordinate of the pair.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ratfit._sampling.portable import product, quarter_cosine, quarter_sine, root

Coordinate = Callable[[int], Any]


def plane_v(coordinate: Coordinate) -> Any:
    """The angle of V to N uniform on (-pi/2, pi/2): its cosine."""
    import jax.numpy as jnp

    turn = coordinate(0)
    return quarter_sine(2 * jnp.minimum(turn, 1 - turn))


def plane_u(coordinate: Coordinate) -> Any:
    """H lies halfway: the angle between V and H is half the difference of the angles of V and V'."""
    return quarter_cosine(coordinate(0) - coordinate(1))


def plane_t(coordinate: Coordinate) -> Any:
    """The angle between N and H is half the sum of the angles of V and V'."""
    return quarter_cosine(coordinate(0) - (1 - coordinate(1)))  # an exact difference; the sum would not be


def hemisphere_v(coordinate: Coordinate) -> Any:
    """Equal solid angles have equal heights: V.N is uniform."""
    return coordinate(0)


def hemisphere_v_prime(coordinate: Coordinate) -> Any:
    """The same of V'.N."""
    return coordinate(1)


def hemisphere_u(coordinate: Coordinate) -> Any:
    """H halves the angle between V and V', so that V + V' has the length 2 u."""
    return _length(coordinate) / 2


def hemisphere_t(coordinate: Coordinate) -> Any:
    """H is V + V' over its length, and its height the sum of theirs over it."""
    return (coordinate(0) + coordinate(1)) / _length(coordinate)


def hemisphere_w(coordinate: Coordinate) -> Any:
    """No azimuth is special: that of H is uniform on a quadrant, whatever the pair looks like otherwise."""
    return quarter_cosine(coordinate(3))


def _length(coordinate: Coordinate) -> Any:
    """|V + V'|, from the heights v, v' of the two and the angle between their azimuths, uniform on (0, pi).

    |V + V'|^2 = (v + v')^2 + (s - s')^2 + 4 s s' cos(angle/2)^2 with the sines s, s': a sum without cancellation.
    """
    height, other = coordinate(0), coordinate(1)
    sine, other_sine = (root(product(1 - z, 1 + z)) for z in (height, other))
    half = quarter_cosine(coordinate(2))
    together, apart = height + other, sine - other_sine
    across = product(product(sine, other_sine), product(half, half))
    return root(product(together, together) + product(apart, apart) + 4 * across)
