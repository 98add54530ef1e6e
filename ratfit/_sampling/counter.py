"""Fractions of (0, 1) from a seed and a counter: SplitMix64 (splitmix2014), whose state is a counter by construction.

Each coordinate of a sample has a stream of its own. Coordinate 0 is the variable's, k = 1, 2, ... that of the k-th
parameter drawn at random; further coordinates of the variable's own, as a pair of directions needs them, have streams
that no parameter has.
"""

from __future__ import annotations

from typing import Any

GOLDEN = 0x9E3779B97F4A7C15  # SplitMix64's increment: 2^64 over the golden ratio
ROOT_TWO = 0x6A09E667F3BCC909  # the fractional digits of sqrt(2), made odd: leads to the directions' streams


def fractions(seed: Any, counters: Any, coordinate: int = 0) -> Any:
    """One number of (0, 1) for each counter: the variable's (coordinate 0), or that of a parameter drawn at random."""
    return midpoints(random_bits(_stream(seed, coordinate, GOLDEN), counters))


def direction_fractions(seed: Any, counters: Any, coordinate: int) -> Any:
    """One number of (0, 1) for each counter: the variable's (coordinate 0), or a further one of its directions."""
    return midpoints(random_bits(_stream(seed, coordinate, ROOT_TWO), counters))


def shift_bits(seed: Any, coordinate: int) -> Any:
    """64 random bits for a coordinate: those of its first point."""
    import jax.numpy as jnp

    return random_bits(_stream(seed, coordinate, GOLDEN), jnp.uint64(0))


def random_bits(stream: Any, counters: Any) -> Any:
    import jax.numpy as jnp

    return _mixed(stream + (counters + 1) * jnp.uint64(GOLDEN))


def midpoints(bits: Any) -> Any:
    """The leading 52 bits as the middle of one of 2^52 equal parts of (0, 1)."""
    import jax.numpy as jnp

    # 52 bits and a half: with 53 the greatest fraction would round to 1.
    return ((bits >> 12).astype(jnp.float64) + 0.5) * 2.0**-52


def _stream(seed: Any, coordinate: int, step: int) -> Any:
    """Where a stream begins; the seed is mixed first, so that the streams of neighbouring seeds do not overlap."""
    import jax.numpy as jnp

    stream = _mixed(seed + jnp.uint64(GOLDEN))
    for _ in range(coordinate):
        stream = _mixed(stream + jnp.uint64(step))
    return stream


def _mixed(bits: Any) -> Any:
    import jax.numpy as jnp

    bits = (bits ^ (bits >> 30)) * jnp.uint64(0xBF58476D1CE4E5B9)
    bits = (bits ^ (bits >> 27)) * jnp.uint64(0x94D049BB133111EB)
    return bits ^ (bits >> 31)
