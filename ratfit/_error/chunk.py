"""One chunk of samples on a device: drawn, evaluated, and added up, all in the cache.

The samples of a chunk pass through in rows. Each lane of a row keeps running totals of its own, sums with the rounding
error of every addition beside them, so that no order of evaluation is left to the compiler: a chunk's totals are the
same numbers whichever device makes them.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ratfit._double_double import double_double
from ratfit._kernel import Program, kernel
from ratfit._sampling import drawing
from ratfit._setting import Setting

CHUNK = 2**18
"""Samples that are added up together: fixed, because the totals of a chunk depend on it in their last bits."""

LANES = 2**12
"""Samples in a row, whose arrays stay in the innermost caches; fixed for the same reason."""

ROWS, GROUP = CHUNK // LANES, 16
"""Rows of a chunk; and those of them that a lane adds up plainly before it adds their sum with its rounding error."""

# What is counted, added up, and looked for the greatest and the least of.
LEFT_OUT = ("nan_fit", "inf_fit", "nan_exact", "inf_exact")
COUNTS = ("finite", "nonzero", "known", *LEFT_OUT)  # known: the exact value is finite, whatever the fit is
SUMS = ("error", "absolute", "square", "relative_signed", "relative", "relative_square", "size", "ulp")
EXTREMES = ("peak", "highest", "lowest")  # of |exact| and of exact
WORST = ("absolute", "relative", "ulp")

BINS_AN_OCTAVE = 64
LEAST_EXPONENT, OCTAVES = -192, 256
BINS = OCTAVES * BINS_AN_OCTAVE
"""Bins of the histograms that quantiles come from: 64 between 2**n and 2**(n + 1), n from -192 to 63."""


@dataclass(frozen=True)
class Pass:
    """What is compiled: the programs, the protocol and the dtype, but no value of a parameter, seed or domain."""

    fit: Program
    exact: Program
    varying: tuple[Any, ...]
    sampling: str
    dtype: str
    quantiles: bool
    double_double: bool = False  # the arithmetic of the exact function; its constants are then the values of `fixed`
    fixed: tuple[Any, ...] = ()


def exact_program(place: Setting) -> Program:
    """The exact function as it is computed: as it is written, or as the fit is where the fit is that very formula."""
    return place.program if place.formula == place.exact else Program(place.exact)


def chunk_totals(what: Pass, start: Any, samples: Any, seed: Any, ends: Any, constants: Any) -> dict[str, Any]:
    """The totals of the samples `start` to `start + CHUNK`, as far as they are below `samples`; to be traced by JAX.

    Counts are integers, a sum is the pair of its high and low part, the worst of each kind a pair of its value and its
    counter; `absolute_bins` and `relative_bins` are the histograms, if asked for.
    """
    import jax
    import jax.numpy as jnp

    lane = jnp.arange(LANES, dtype=jnp.uint64)

    def evaluated(number: Any) -> tuple[Any, Any, Any]:
        counters = start + number * LANES + lane
        points = drawing(what.sampling, what.dtype)(seed, counters, ends)
        fit = kernel(what.fit, what.varying).function(*points, *constants[0])
        exact, low = _exact(what, [point.astype(jnp.float64) for point in points], constants[1])
        # Beyond the last sample the exact function is nan and the fit is not: `_errors` then counts nothing there.
        inside = counters < samples
        return jnp.where(inside, fit, 0), jnp.where(inside, exact, jnp.nan), low

    def add(number: Any, carried: dict[str, Any]) -> dict[str, Any]:
        low = lows if lows is None else lows[number]
        return _added(carried, _errors(fits[number], exacts[number], low, what.dtype))

    def add_group(group: Any, carried: tuple[dict[str, Any], dict[str, Any], dict[str, Any]]) -> tuple[Any, ...]:
        rest, sums, worst = carried
        rest = jax.lax.fori_loop(group * GROUP, (group + 1) * GROUP, add, rest | {"sums": _zeros(), "worst": _none()})
        sums = {name: _two_sum(sums[name], value) for name, value in rest.pop("sums").items()}
        return rest, sums, {name: _worse(worst[name], value, group) for name, value in rest.pop("worst").items()}

    # Two loops, because the end of a loop is what XLA respects: in one, each sum computes the functions for itself.
    fits, exacts, lows = jax.lax.map(evaluated, jnp.arange(ROWS, dtype=jnp.uint64))
    sums = {name: (value, value) for name, value in _zeros().items()}
    worst = {name: (value, jnp.zeros(LANES, jnp.int64)) for name, value in _none().items()}
    rest, sums, worst = jax.lax.fori_loop(0, ROWS // GROUP, add_group, (_empty(what.quantiles), sums, worst))

    def errors(rows: Any, lane: Any) -> dict[str, Any]:
        low = lows if lows is None else lows[rows, lane]
        return _errors(fits[rows, lane], exacts[rows, lane], low, what.dtype)

    found = _folded(rest, sums)
    beyond = jnp.clip(start.astype(jnp.int64) + CHUNK - samples.astype(jnp.int64), 0, CHUNK)
    found["nan_exact"] = found["nan_exact"] - beyond
    for name, (value, group) in worst.items():
        found[f"worst_{name}"], place = _first_worst(name, value, group, errors)
        found[f"counter_{name}"] = start + place.astype(jnp.uint64)
    return found


def _exact(what: Pass, points: list[Any], constants: Any) -> tuple[Any, Any]:
    """The exact function, in float64 or in double-double, whose low part is None for float64.

    The latter is NumPy's work: XLA contracts products and sums into one operation, which error terms do not survive.
    """
    import jax
    import jax.numpy as jnp

    if not what.double_double:
        return kernel(what.exact, what.varying).function(*points, *constants), None
    # The halves of the numbers cross as integers: in the thread of a callback JAX may be set to 32 bits.
    given = jax.lax.bitcast_convert_type(
        jnp.stack([jnp.broadcast_to(v, LANES) for v in (*points, *constants)]), jnp.uint32
    )
    halves = jax.ShapeDtypeStruct((2, LANES, 2), jnp.uint32)
    found = jax.lax.bitcast_convert_type(jax.pure_callback(_in_double_double(what), halves, given), jnp.float64)
    return found[0], found[1]


def _in_double_double(what: Pass) -> Callable[[Any], Any]:
    run = double_double(what.exact.result, (*what.varying, *what.fixed))

    def halves(given: Any) -> Any:
        import numpy as np

        values = np.ascontiguousarray(given).view(np.float64)[..., 0]
        return np.stack(run(*values)).view(np.uint32).reshape(2, LANES, 2)

    return halves


def _zeros() -> dict[str, Any]:
    import jax.numpy as jnp

    return {name: jnp.zeros(LANES) for name in SUMS}


def _none() -> dict[str, Any]:
    """-1, not 0: a sample that is left out is never the worst one, not even where every error is 0."""
    import jax.numpy as jnp

    return {name: jnp.full(LANES, -1.0) for name in WORST}


def _worse(worst: tuple[Any, Any], found: Any, group: Any) -> tuple[Any, Any]:
    """The greatest error of each lane so far, and the group of rows that it was first met in."""
    import jax.numpy as jnp

    value, place = worst
    return jnp.maximum(value, found), jnp.where(found > value, group, place)


def _first_worst(name: str, value: Any, group: Any, errors: Callable[..., dict[str, Any]]) -> tuple[Any, Any]:
    """The greatest error of all lanes, and its place in the chunk: the rows of its group are looked at again.

    Of equal errors one is named, always the same: that of the first lane in the first group.
    """
    import jax.numpy as jnp

    most = jnp.max(value)
    first = jnp.min(jnp.where(value == most, group, ROWS))
    lane = jnp.argmax((value == most) & (group == first))
    rows = first * GROUP + jnp.arange(GROUP)
    row = errors(rows, lane)
    return most, rows[jnp.argmax(_counting(name, row))] * LANES + lane


def _counting(name: str, row: dict[str, Any]) -> Any:
    """The errors of a kind where they count, and -1 elsewhere."""
    import jax.numpy as jnp

    return jnp.where(row["nonzero" if name == "relative" else "finite"], row[name], -1.0)


def _empty(quantiles: bool) -> dict[str, Any]:
    import jax.numpy as jnp

    nothing: dict[str, Any] = {"counts": jnp.zeros(LANES, jnp.int64)}
    nothing |= {"peak": jnp.zeros(LANES), "highest": jnp.full(LANES, -jnp.inf), "lowest": jnp.full(LANES, jnp.inf)}
    bins = {f"{name}_bins": jnp.zeros(BINS, jnp.int64) for name in ("absolute", "relative")}
    return nothing | (bins if quantiles else {})


def _errors(fit: Any, exact: Any, low: Any, dtype: str) -> dict[str, Any]:
    """The errors of a row, sample by sample; 0 where one is not defined."""
    import jax.numpy as jnp

    fitted = fit.astype(jnp.float64)
    known = jnp.isfinite(exact)
    finite = known & jnp.isfinite(fitted)
    nonzero = finite & (exact != 0)
    size = jnp.where(known, jnp.abs(exact), 0)
    error = jnp.where(finite, fitted - exact if low is None else (fitted - exact) - low, 0)
    relative = jnp.where(nonzero, error / jnp.where(nonzero, exact, 1), 0)
    kinds = (finite, nonzero, known, jnp.isnan(fitted), jnp.isinf(fitted), jnp.isnan(exact), jnp.isinf(exact))
    return {
        "finite": finite, "nonzero": nonzero, "known": known, "exact": exact,
        # Each count has a byte of its own: a lane sees 64 samples of a chunk.
        "counts": sum(kind.astype(jnp.int64) << (8 * place) for place, kind in enumerate(kinds)),
        "size": size, "error": error, "absolute": jnp.abs(error), "square": error * error,
        "relative_signed": relative, "relative": jnp.abs(relative), "relative_square": relative * relative,
        "ulp": _in_ulp(jnp.abs(error), size, dtype),
    }  # fmt: skip


@functools.cache
def _format(dtype: str) -> tuple[int, int]:
    """The bits of the fraction and the least exponent of a dtype's normal numbers."""
    import ml_dtypes
    import numpy as np

    about = ml_dtypes.finfo(np.dtype(dtype))
    return int(about.nmant), int(about.minexp)


def _in_ulp(error: Any, size: Any, dtype: str) -> Any:
    """The error in units in the last place of `dtype`, at numbers of this size."""
    import jax
    import jax.numpy as jnp

    fraction, least = _format(dtype)
    bits = jax.lax.bitcast_convert_type(size, jnp.uint64)
    exponent = jnp.maximum((bits >> 52).astype(jnp.int64) - 1023, least)
    # A power of two can be beyond 2**1023, at numbers below 2**-971, which float64 alone has: then in two steps.
    power = fraction - exponent
    steps = (power // 2, power - power // 2) if fraction - least > 1023 else (power,)
    for step in steps:
        error = error * jax.lax.bitcast_convert_type(((step + 1023).astype(jnp.uint64)) << 52, jnp.float64)
    return error


def _added(carried: dict[str, Any], row: dict[str, Any]) -> dict[str, Any]:
    import jax.numpy as jnp

    new = {
        "counts": carried["counts"] + row["counts"],
        "sums": {name: value + row[name] for name, value in carried["sums"].items()},
        "worst": {name: jnp.maximum(value, _counting(name, row)) for name, value in carried["worst"].items()},
        "peak": jnp.maximum(carried["peak"], row["size"]),
        "highest": jnp.maximum(carried["highest"], jnp.where(row["known"], row["exact"], -jnp.inf)),
        "lowest": jnp.minimum(carried["lowest"], jnp.where(row["known"], row["exact"], jnp.inf)),
    }
    for name in ("absolute", "relative"):
        if f"{name}_bins" in carried:
            counted = row["nonzero" if name == "relative" else "finite"].astype(jnp.int64)
            new[f"{name}_bins"] = carried[f"{name}_bins"].at[_bin(row[name])].add(counted)
    return new


def _two_sum(total: tuple[Any, Any], value: Any) -> tuple[Any, Any]:
    """A sum and what its rounding lost (Knuth's two-sum, without regard to which of the two is greater)."""
    high, low = total
    new = high + value
    added = new - high
    return new, low + ((high - (new - added)) + (value - added))


def _bin(error: Any) -> Any:
    """The bin of an error: the exponent and the first six bits of the fraction of its float64."""
    import jax
    import jax.numpy as jnp

    bits = jax.lax.bitcast_convert_type(error, jnp.uint64) >> (52 - 6)
    return jnp.clip(bits.astype(jnp.int32) - (1023 + LEAST_EXPONENT) * BINS_AN_OCTAVE, 0, BINS - 1)


def _folded(rest: dict[str, Any], sums: dict[str, tuple[Any, Any]]) -> dict[str, Any]:
    """The lanes of a chunk as one."""
    import jax.numpy as jnp

    found = {name: jnp.sum((rest["counts"] >> (8 * place)) & 255) for place, name in enumerate(COUNTS)}
    high, low = (jnp.stack([sums[name][part] for name in SUMS]) for part in (0, 1))
    while high.shape[1] > 1:
        half = high.shape[1] // 2
        high, low = _two_sum((high[:, :half], low[:, :half] + low[:, half:]), high[:, half:])
    found["sums"] = jnp.concatenate([high, low], axis=1)
    found["extremes"] = jnp.stack([jnp.max(rest["peak"]), jnp.max(rest["highest"]), jnp.min(rest["lowest"])])
    return found | {name: part for name, part in rest.items() if name.endswith("_bins")}
