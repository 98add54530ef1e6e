"""Points of a protocol: as a function for a kernel to trace, and as arrays."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ratfit._parse import RatfitError
from ratfit._sampling.check import check_protocol, resolve
from ratfit._sampling.ends import Ends, ends
from ratfit._sampling.exhaustive import check_exhaustive, number_at
from ratfit._sampling.protocols import CARRIERS, uniform

if TYPE_CHECKING:
    from jaxtyping import Array, Float, Float64

    Doubles = Float64[Array, " samples"]
    Points = Float[Array, " size"]

Drawing = Callable[[Any, Any, list[Any]], tuple[Any, ...]]

# Exponent and significand of the dtypes that float64 is rounded to.
_BITS = {"float16": (5, 10), "float32": (8, 23)}


def sample(sampling: str, low: float, high: float, samples: int, seed: int) -> Doubles:
    """The points of a sampling protocol, inside the open interval (low, high), in the order of their counters.

    **Fails** with `RatfitError` for an unknown protocol, one that does not draw from this interval, fewer than one
    sample, or a seed that is no 64-bit number.
    """
    canonical = resolve(sampling, "", low, high, "float64")
    check_protocol(canonical, samples, seed)
    return draw(canonical, low, high, seed, 0, samples)


def draw(sampling: str, low: float, high: float, seed: int, start: int, size: int, dtype: str = "float64") -> Points:
    """The points `start` to `start + size` of a protocol by its canonical name, in float64 and then rounded to `dtype`.

    A point that rounding carries out of the open interval goes to the last number inside it: nothing is measured at an
    end of its domain, where it may be 0/0, or beyond. `exhaustive` alone visits the ends.
    """
    import jax
    import jax.numpy as jnp

    with jax.enable_x64(True):
        counters = start + jnp.arange(size, dtype=jnp.uint64)
    (points,) = drawn(sampling, seed, counters, [ends(low, high, dtype)], dtype)
    return points


def drawn(sampling: str, seed: int, counters: Any, ranges: list[Any], dtype: str) -> tuple[Any, ...]:
    """The samples of these counters, as a kernel draws them: the variable, then the parameters drawn at random.

    **Arguments:** the protocol by its canonical name, the `seed`, the `counters` (uint64) and the `bounds`.
    """
    import jax
    import numpy as np

    with jax.enable_x64(True):
        return _compiled(sampling, dtype)(np.uint64(seed), counters, ranges)


@functools.cache
def drawing(sampling: str, dtype: str) -> Drawing:
    """The points of a protocol as a function for a kernel to trace, in the scope of float64.

    **Arguments:** the protocol by its canonical name (`resolve`), and the `dtype` of the points.

    **Returns** a function of the seed (uint64), the counters (uint64, of any shape) and `bounds`; it gives for each of
    the bounds an array in `dtype`: the variable, then the parameters that are drawn at random.

    **Fails** with `RatfitError`, where it is traced, for random parameters that the protocol cannot draw.
    """
    return _exhaustive(dtype) if sampling == "exhaustive" else _random(sampling, dtype)


def _random(sampling: str, dtype: str) -> Drawing:
    carrier = CARRIERS[sampling]

    def points(seed: Any, counters: Any, ranges: list[Any]) -> tuple[Any, ...]:
        variable, *drawn = (Ends(*each) for each in ranges)
        coordinates = functools.partial(carrier.variable, seed, counters)
        found = [_inside(carrier.point(coordinates, variable), variable, dtype)]
        others, parameters = drawn[: len(carrier.others)], drawn[len(carrier.others) :]
        for quantity, other in zip(carrier.others, others, strict=False):
            found.append(_inside(quantity(coordinates), other, dtype))
        for coordinate, parameter in enumerate(parameters, 1):
            exact = uniform(carrier.parameter(seed, counters, coordinate), parameter)
            found.append(_inside(exact, parameter, dtype))
        return tuple(found)

    return points


def _exhaustive(dtype: str) -> Drawing:
    check_exhaustive(dtype)

    def points(seed: Any, counters: Any, ranges: list[Any]) -> tuple[Any, ...]:
        import jax.numpy as jnp

        if len(ranges) > 1:
            raise RatfitError("exhaustive draws no parameter at random: give the parameters values")
        variable = Ends(*ranges[0])
        # A last chunk may ask for more than there are: it gets the last number again.
        places = variable.least.astype(jnp.int64) + counters.astype(jnp.int64)
        return (number_at(jnp.minimum(places, variable.greatest.astype(jnp.int64)), dtype),)

    return points


def _inside(exact: Any, ends: Ends, dtype: str) -> Any:
    import jax.numpy as jnp

    return jnp.clip(_rounded(exact, dtype), ends.first.astype(dtype), ends.last.astype(dtype))


def _rounded(exact: Any, dtype: str) -> Any:
    """A conversion that XLA may not skip, free as it is to keep more digits (xla_allow_excess_precision)."""
    import jax

    return jax.lax.reduce_precision(exact, *_BITS[dtype]).astype(dtype) if dtype in _BITS else exact


@functools.cache
def _compiled(sampling: str, dtype: str) -> Drawing:
    """Compiled, as in a larger kernel: a compiler rounds alike only what it sees."""
    import jax

    return jax.jit(drawing(sampling, dtype))
