"""Float64 arithmetic that every device rounds alike: sums, square roots and quotients as IEEE has them, and these.

A compiler may round `a*b + c` once or twice, and the cosines of two libraries differ in their last digits: a point
that rests on either is no longer a function of the seed and the counter alone.
"""

from __future__ import annotations

from typing import Any

# (pi/2)^(2k + 1)/(2k + 1)! with alternating signs, k = 0 ... 10: Taylor's series of sin(pi*z/2). On [0, 1] the first
# term left out is 1.3e-18.
_QUARTER = (
    1.5707963267948966,
    -0.6459640975062463,
    0.07969262624616705,
    -0.004681754135318688,
    0.00016044118478735983,
    -3.598843235212085e-06,
    5.692172921967927e-08,
    -6.688035109811468e-10,
    6.0669357311061955e-12,
    -4.377065467313742e-14,
    2.571422892860474e-16,
)


def product(left: Any, right: Any) -> Any:
    """`left*right`, rounded, with the last bit of its significand cleared.

    The cleared bit keeps a compiler from fusing the product with a sum that follows it, at the price of one unit in the
    last place.
    """
    import jax
    import jax.numpy as jnp

    bits = jax.lax.bitcast_convert_type(left * right, jnp.uint64)
    return jax.lax.bitcast_convert_type(bits & jnp.uint64(2**64 - 2), jnp.float64)


def quarter_sine(turn: Any) -> Any:
    """`sin(pi*turn/2)` for a turn in [-1, 1], to a few units in the last place."""
    square = product(turn, turn)
    series = _QUARTER[-1]
    for coefficient in reversed(_QUARTER[:-1]):
        series = product(series, square) + coefficient
    return product(series, turn)


def quarter_cosine(turn: Any) -> Any:
    """`cos(pi*turn/2)` for a turn in [-1, 1]; where `1 - abs(turn)` is exact, with the sine's relative accuracy."""
    import jax.numpy as jnp

    return quarter_sine(1 - jnp.abs(turn))
