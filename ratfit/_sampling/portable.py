"""Float64 arithmetic that every device and every kernel rounds alike.

A compiler rounds `a*b + c` once or twice, makes `a/sqrt(b)` a product with a reciprocal root, and takes cosines from
libraries that differ in their last digits: a point that rests on any of these is no longer a function of the seed and
the counter alone. Sums and quotients are safe; products and roots that sums and quotients follow are settled here.
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
    """`left*right`, settled."""
    return _settled(left * right)


def root(square: Any) -> Any:
    """The square root, settled."""
    import jax.numpy as jnp

    return _settled(jnp.sqrt(square))


def _settled(number: Any) -> Any:
    """The number with the last bit of its significand cleared: what a compiler cannot merge with what follows."""
    import jax
    import jax.numpy as jnp

    bits = jax.lax.bitcast_convert_type(number, jnp.uint64)
    return jax.lax.bitcast_convert_type(bits & jnp.uint64(2**64 - 2), jnp.float64)


def quarter_sine(turn: Any) -> Any:
    """`sin(pi*turn/2)` for a turn in [-1, 1], to a few units in the last place."""
    square = product(turn, turn)
    fourth = product(square, square)
    # Two halves of Horner's rule, which a processor works out side by side.
    even, odd = _horner(_QUARTER[::2], fourth), _horner(_QUARTER[1::2], fourth)
    return product(even + product(odd, square), turn)


def _horner(coefficients: tuple[float, ...], place: Any) -> Any:
    *others, series = coefficients
    for coefficient in reversed(others):
        series = product(series, place) + coefficient
    return series


def quarter_cosine(turn: Any) -> Any:
    """`cos(pi*turn/2)` for a turn in [-1, 1]; where `1 - abs(turn)` is exact, with the sine's relative accuracy."""
    import jax.numpy as jnp

    return quarter_sine(1 - jnp.abs(turn))
