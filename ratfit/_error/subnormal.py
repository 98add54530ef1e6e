"""Numbers so small that some processors, told so by JAX, take them for 0."""

from __future__ import annotations

from ratfit._kernel import precision
from ratfit._sampling import count
from ratfit._setting import Setting


def flushed_samples(place: Setting, dtype: str) -> int:
    """How many of the numbers of a dtype in the closed domain are not 0, but are taken for 0 where this runs."""
    import numpy as np

    tiny = np.finfo(dtype).smallest_normal
    low, high = (min(max(end, -float(tiny)), float(tiny)) for end in (place.low, place.high))
    if not low < high or not _flushes(dtype):
        return 0
    zeros = 2 if low <= 0 <= high else 0  # -0.0 and +0.0
    return count(low, high, dtype) - zeros - sum(abs(end) == tiny for end in (low, high))


def _flushes(dtype: str) -> bool:
    import jax
    import numpy as np

    half = np.finfo(dtype).smallest_normal / np.dtype(dtype).type(2)
    with precision(dtype):
        return bool(jax.jit(lambda number: number + number)(half) == 0)
