"""Where a fit is measured: at which points, and at which values of the parameters that are drawn with them.

The points are counter-based: point i is a function of the seed and of i alone, defined in this file to the bit. So the
first n of N points are the n points, whoever asks for them, in chunks, on 1 device or on 64, now or in ten years.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from ratfit._parse import RatfitError, nearest
from ratfit._setting import Setting

if TYPE_CHECKING:
    from jaxtyping import Array, Float, Float64

    Doubles = Float64[Array, " samples"]
    Points = Float[Array, " size"]

DTYPES = ("float32", "float64")


def sample(sampling: str, low: float, high: float, samples: int, seed: int) -> Doubles:
    """The points of a sampling protocol, inside the open interval (low, high), in the order of their counters.

    **Fails** with `RatfitError` for an unknown protocol, fewer than one sample, or a seed that is no 64-bit number.
    """
    check_protocol(sampling, samples, seed)
    return draw(sampling, low, high, seed, 0, samples)


def draw(sampling: str, low: float, high: float, seed: int, start: int, size: int, dtype: str = "float64") -> Points:
    """The points `start` to `start + size` of a protocol, drawn in float64 and then rounded to `dtype`.

    A point that rounding carries out of the open interval goes to the last number inside it: nothing is measured at an
    end of its domain, where it may be 0/0, or beyond.
    """
    import jax
    import numpy as np

    with jax.enable_x64(True):
        (points,) = _compiled(sampling, size, dtype)(np.uint64(seed), np.uint64(start), [_bounds(low, high, dtype)])
    return points


def bounds(place: Setting, dtype: str) -> list[Any]:
    """The ends of all that is drawn, the variable first: for `drawing`, each as four float64 numbers."""
    return [_bounds(low, high, dtype) for low, high in ((place.low, place.high), *place.ranges.values())]


@functools.cache
def drawing(sampling: str, dtype: str) -> Callable[[Any, Any, list[Any]], tuple[Any, ...]]:
    """The points of a protocol as a function for a kernel to trace, in the scope of float64.

    It takes the seed (uint64), the counters (uint64, of any shape) and `bounds`, and gives for each of the bounds an
    array in `dtype`: the variable, then the parameters that are drawn at random.
    """

    def points(seed: Any, counters: Any, ends: list[Any]) -> tuple[Any, ...]:
        import jax.numpy as jnp

        found = []
        for place, (low, high, first, last) in enumerate(ends):
            carry = PROTOCOLS[sampling] if place == 0 else _uniform
            exact = carry(_fractions(seed, counters, place), low, high)
            found.append(jnp.clip(_rounded(exact, dtype), first.astype(dtype), last.astype(dtype)))
        return tuple(found)

    return points


def _rounded(exact: Any, dtype: str) -> Any:
    """A conversion that XLA may not skip, free as it is to keep more digits (xla_allow_excess_precision)."""
    import jax

    return jax.lax.reduce_precision(exact, 8, 23).astype(dtype) if dtype == "float32" else exact


def check_protocol(sampling: str, samples: int, seed: int, dtype: str = "float64") -> None:
    """Fails with `RatfitError` for what no measurement can be made of."""
    if sampling not in PROTOCOLS:
        raise RatfitError(f"no sampling {sampling!r}, there is: {', '.join(PROTOCOLS)}{nearest(sampling, PROTOCOLS)}")
    if not isinstance(samples, int) or samples < 1:
        raise RatfitError(f"samples = {samples}: a whole number from 1 upwards is needed")
    if not isinstance(seed, int) or not 0 <= seed < 2**64:
        raise RatfitError(f"seed = {seed}: a whole number from 0 to 2**64 - 1 is needed")
    if dtype not in DTYPES:
        raise RatfitError(f"no dtype {dtype!r}: measure in {' or '.join(DTYPES)}")


def _uniform(fraction: Any, low: Any, high: Any) -> Any:
    return low + (high - low) * fraction


# Each protocol carries a fraction of (0, 1) to a point between the ends.
PROTOCOLS: Mapping[str, Callable[[Any, Any, Any], Any]] = {"uniform": _uniform}


@functools.cache
def _compiled(sampling: str, size: int, dtype: str) -> Callable[..., Any]:
    import jax
    import jax.numpy as jnp

    def points(seed: Any, start: Any, ends: list[Any]) -> Any:
        return drawing(sampling, dtype)(seed, start + jnp.arange(size, dtype=jnp.uint64), ends)

    return jax.jit(points)


def _fractions(seed: Any, counters: Any, coordinate: int = 0) -> Any:
    """One number of (0, 1) for each counter: SplitMix64 (splitmix2014), whose state is a counter by construction.

    The seed is mixed first, so that the streams of neighbouring seeds are no shifted copies of one another; further
    coordinates of a sample have streams of their own.
    """
    import jax.numpy as jnp

    golden = jnp.uint64(0x9E3779B97F4A7C15)
    stream = _mixed(seed + golden)
    for _ in range(coordinate):
        stream = _mixed(stream + golden)
    bits = _mixed(stream + (counters + 1) * golden)
    # 52 bits and a half: with 53 the greatest fraction would round to 1.
    return ((bits >> 12).astype(jnp.float64) + 0.5) * 2.0**-52


def _mixed(bits: Any) -> Any:
    import jax.numpy as jnp

    bits = (bits ^ (bits >> 30)) * jnp.uint64(0xBF58476D1CE4E5B9)
    bits = (bits ^ (bits >> 27)) * jnp.uint64(0x94D049BB133111EB)
    return bits ^ (bits >> 31)


def _bounds(low: float, high: float, dtype: str) -> Any:
    """The ends, and the least and the greatest number of a dtype strictly between them."""
    import numpy as np

    kind = np.dtype(dtype).type
    first, last = kind(low), kind(high)
    first = first if first > low else np.nextafter(first, kind(np.inf))
    last = last if last < high else np.nextafter(last, kind(-np.inf))
    if not first <= last:
        raise RatfitError(f"no {dtype} number lies between {low} and {high}: measure in float64 or widen the domain")
    return np.array([low, high, first, last], np.float64)
