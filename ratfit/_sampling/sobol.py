"""Sobol's points, with the direction numbers of Joe and Kuo (joe2008: new-joe-kuo-6.21201) and a random digital shift.

Point i is the sum modulo 2 of the direction numbers that the binary digits of i select: the digits of i itself, not
those of its Gray code, which would give the same 2^k first points in another order. The shift, one random number for
each coordinate, turns the same digits of all points: the first 2^k points still fall one into each of 2^k equal parts.
"""

from __future__ import annotations

from typing import Any

from ratfit._parse import RatfitError
from ratfit._sampling.counter import midpoints, shift_bits

DIGITS = 40
"""The binary digits of a counter that are used: points from 2^40 on are not to be asked for."""

# (degree s, inner coefficients a of the primitive polynomial, the first s direction integers m), coordinate 1 upwards.
_JOE_KUO = (
    (1, 0, (1,)),
    (2, 1, (1, 3)),
    (3, 1, (1, 3, 1)),
    (3, 2, (1, 1, 1)),
    (4, 1, (1, 1, 3, 3)),
    (4, 4, (1, 3, 5, 13)),
    (5, 2, (1, 1, 5, 5, 17)),
    (5, 4, (1, 1, 5, 5, 5)),
    (5, 7, (1, 1, 7, 11, 19)),
    (5, 11, (1, 1, 5, 1, 1)),
    (5, 13, (1, 1, 1, 3, 11)),
    (5, 14, (1, 3, 5, 5, 31)),
    (6, 1, (1, 3, 3, 9, 7, 49)),
    (6, 13, (1, 1, 1, 15, 21, 21)),
    (6, 16, (1, 3, 1, 13, 27, 49)),
)

COORDINATES = 1 + len(_JOE_KUO)


def sobol_fractions(seed: Any, counters: Any, coordinate: int) -> Any:
    """One number of (0, 1) for each counter below 2^40. **Fails** with `RatfitError` beyond the last coordinate."""
    if coordinate >= COORDINATES:
        raise RatfitError(f"sobol draws {COORDINATES - 1} parameters at most: give some of them values")
    digits = _reversed(counters) if coordinate == 0 else _summed(counters, coordinate)
    return midpoints(digits ^ shift_bits(seed, coordinate))


def directions(coordinate: int) -> list[int]:
    """The direction numbers of a coordinate from 1 upwards: `v[j]` has its leading digit at 2^(63 - j)."""
    degree, inner, integers = _JOE_KUO[coordinate - 1]
    found = [integer << (63 - j) for j, integer in enumerate(integers)]
    for j in range(degree, DIGITS):
        number = found[j - degree] ^ (found[j - degree] >> degree)
        for k in range(1, degree):
            if inner >> (degree - 1 - k) & 1:
                number ^= found[j - k]
        found.append(number)
    return found


def _summed(counters: Any, coordinate: int) -> Any:
    import jax.numpy as jnp

    digits = jnp.zeros_like(counters)
    for j, number in enumerate(directions(coordinate)):
        chosen = jnp.uint64(0) - ((counters >> j) & 1)  # all ones or all zeros
        digits = digits ^ (chosen & jnp.uint64(number))
    return digits


def _reversed(bits: Any) -> Any:
    """The 64 digits from last to first: coordinate 0, whose direction numbers are the powers of 1/2."""
    import jax.numpy as jnp

    for width in (1, 2, 4, 8, 16, 32):
        lower = jnp.uint64((2**64 - 1) // (2**width + 1))  # width ones, width zeros, ...
        bits = ((bits >> width) & lower) | ((bits & lower) << width)
    return bits
