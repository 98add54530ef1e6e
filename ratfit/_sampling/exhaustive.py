"""Every number of a dtype in a closed domain, in increasing order: a numbering in which counting is arithmetic.

The bits of a positive number, read as an integer, grow with it. So +0.0 has place 0, the least subnormal number 1, and
so on; the negative numbers mirror this one place lower, -0.0 at -1. Both zeros are numbers equal to 0, and belong to
every closed domain that 0 belongs to, -0.0 before +0.0.
"""

from __future__ import annotations

import math
from typing import Any

from ratfit._parse import RatfitError

EXHAUSTIVE = ("float16", "float32")
"""The dtypes whose numbers can all be visited."""


def count(low: float, high: float, dtype: str) -> int:
    """How many numbers of a dtype lie in the closed interval [low, high]: what `exhaustive` measures.

    **Fails** with `RatfitError` for a dtype with too many numbers, ends that are not finite or in the wrong order, and
    where there is no number at all.
    """
    check_exhaustive(dtype)
    if not -math.inf < low <= high < math.inf:
        raise RatfitError(f"[{low}, {high}] cannot be counted through: take finite ends, low <= high")
    found = place_of(high, dtype, upwards=False) - place_of(low, dtype, upwards=True) + 1
    if found < 1:
        raise RatfitError(f"no {dtype} number lies in [{low}, {high}]: widen the domain")
    return found


def check_exhaustive(dtype: str) -> None:
    """Fails with `RatfitError` for a dtype that cannot be visited whole."""
    if dtype not in EXHAUSTIVE:
        raise RatfitError(f"{dtype} has too many numbers to measure at each: take {' or '.join(reversed(EXHAUSTIVE))}")


def place_of(end: float, dtype: str, upwards: bool) -> int:
    """The place of the first finite number of the dtype at or beyond an end, upwards or downwards; a 0 means both."""
    number = nearest_number(end, dtype)
    if (float(number) < end) if upwards else (float(number) > end):
        number = next_number(number, upwards)
    bits = int(abs(number).view(f"u{number.itemsize}"))
    if number == 0:
        return -1 if upwards else 0
    return bits if number > 0 else -1 - bits


def nearest_number(value: float, dtype: str) -> Any:
    """The number of the dtype nearest to a value, as a NumPy scalar: infinite beyond the greatest."""
    import numpy as np

    with np.errstate(over="ignore"):
        return np.dtype(dtype).type(value)


def next_number(number: Any, upwards: bool) -> Any:
    """The neighbour of a NumPy scalar in its own dtype."""
    import numpy as np

    with np.errstate(over="ignore"):
        return np.nextafter(number, number.dtype.type(math.inf if upwards else -math.inf))


def number_at(places: Any, dtype: str) -> Any:
    """The numbers at these places (int64), bit for bit: a subnormal number or -0.0 is what it is until it is used."""
    import jax
    import jax.numpy as jnp

    integer = jnp.int16 if dtype == "float16" else jnp.int32
    bits = places.astype(integer)
    # A negative place is the complement of the number's magnitude: all of its bits but the sign are turned.
    return jax.lax.bitcast_convert_type(jnp.where(bits < 0, bits ^ jnp.iinfo(integer).max, bits), jnp.dtype(dtype))
