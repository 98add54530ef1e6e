"""One chunk of samples on a device: drawn, evaluated, and added up, all in the cache.

Groups of samples are added up one after the other, in one sweep for all results; the groups by a fixed tree, with the
rounding error of every addition beside the sums. No order of evaluation is left to the compiler: a chunk's totals are
the same numbers whichever device makes them.
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

CHUNK = 2**16
"""Samples that are added up together: fixed, because the totals of a chunk depend on it in their last bits."""

LANES = 2**13
"""Samples in a row, whose arrays stay in the innermost caches; fixed for the same reason."""

GROUP = 64
"""Samples that are added up plainly, one after the other, before sums are added with their rounding errors."""

# What is counted, added up, and looked for the greatest and the least of.
# `known`: the exact value is finite, whatever the fit is.
LEFT_OUT = ("nan_fit", "inf_fit", "nan_exact", "inf_exact")
COUNTS = ("finite", "nonzero", "known", *LEFT_OUT)
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

    def drawn(row: Any) -> tuple[Any, ...]:
        return drawing(what.sampling, what.dtype)(seed, counters(row), ends)

    def evaluated(row: Any, points: Any, wide: Any) -> tuple[Any, Any, Any]:
        fit = kernel(what.fit, what.varying).function(*points, *constants[0])
        exact, low = _exact(what, wide, constants[1])
        # Beyond the last sample the exact function is nan and the fit is not: no sum sees such a sample.
        inside = counters(row) < samples
        return jnp.where(inside, fit, 0), jnp.where(inside, exact, jnp.nan), low

    def counters(row: Any) -> Any:
        return start + row * LANES + jnp.arange(LANES, dtype=jnp.uint64)

    # The end of a loop is what XLA respects: without one, both functions would draw for themselves, and every result
    # compute the functions for itself. A loop over two widths of numbers can be vectorised badly: hence the second.
    rows = jnp.arange(CHUNK // LANES, dtype=jnp.uint64)
    points = jax.lax.map(drawn, rows)
    wide = jax.lax.map(lambda row: [point.astype(jnp.float64) for point in row], points)
    values = jax.lax.map(lambda given: evaluated(*given), (rows, points, wide))
    fit, exact = (each.reshape(-1, GROUP) for each in values[:2])
    low = None if values[2] is None else values[2].reshape(-1, GROUP)
    whole = _summary(fit, exact, low, what.dtype, complete=True)
    # A sum of the errors that is finite has met no nan and no infinity: most chunks need no mask.
    found = jax.lax.cond(
        jnp.isfinite(whole["sums"][SUMS.index("absolute"), 0]),
        lambda: whole,
        lambda: _summary(fit, exact, low, what.dtype, complete=False),
    )
    beyond = jnp.clip(start.astype(jnp.int64) + CHUNK - samples.astype(jnp.int64), 0, CHUNK)
    found["nan_exact"] = jnp.maximum(found["nan_exact"] - beyond, 0)
    for name in WORST:
        found[f"counter_{name}"] = start + found[f"counter_{name}"]
    return found | (_histograms(_errors(fit, exact, low, what.dtype, complete=False)) if what.quantiles else {})


def _summary(fit: Any, exact: Any, low: Any, dtype: str, complete: bool) -> dict[str, Any]:
    """The totals of groups of samples; `complete` says that all of them are finite, which spares the masks."""
    import jax.numpy as jnp

    groups = _reduced(_errors(fit, exact, low, dtype, complete))
    found = _folded(groups)
    for name in WORST:
        found[f"worst_{name}"] = jnp.max(groups[f"worst_{name}"])
        group = jnp.argmax(groups[f"worst_{name}"])
        again = _errors(fit[group], exact[group], None if low is None else low[group], dtype, complete)
        found[f"counter_{name}"] = (group * GROUP + jnp.argmax(_counting(name, again))).astype(jnp.uint64)
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


def _errors(fit: Any, exact: Any, low: Any, dtype: str, complete: bool) -> dict[str, Any]:
    """The errors of samples, one by one; 0 where one is not defined."""
    import jax.numpy as jnp

    fitted = fit.astype(jnp.float64)
    known = jnp.ones(exact.shape, bool) if complete else jnp.isfinite(exact)
    finite = known if complete else known & jnp.isfinite(fitted)
    nonzero = finite & (exact != 0)
    size = jnp.where(known, jnp.abs(exact), 0)
    error = jnp.where(finite, fitted - exact if low is None else (fitted - exact) - low, 0)
    relative = jnp.where(nonzero, error / exact, 0)
    none = jnp.zeros(exact.shape, bool)
    tests = [(values, test) for values in (fitted, exact) for test in (jnp.isnan, jnp.isinf)]
    kinds = (finite, nonzero, known, *(none if complete else test(values) for values, test in tests))
    return {
        "finite": finite, "nonzero": nonzero, "known": known, "exact": exact,
        # Each count has a byte of its own, which a group does not fill.
        "counts": sum(kind.astype(jnp.int64) << (8 * place) for place, kind in enumerate(kinds)),
        "size": size, "error": error, "absolute": jnp.abs(error), "square": error * error,
        "relative_signed": relative, "relative": jnp.abs(relative), "relative_square": relative * relative,
        "ulp": _in_ulp(jnp.abs(error), size, dtype),
    }  # fmt: skip


@functools.cache
def number_format(dtype: str) -> tuple[int, int]:
    """The bits of the fraction and the least exponent of a dtype's normal numbers."""
    import ml_dtypes
    import numpy as np

    about = ml_dtypes.finfo(np.dtype(dtype))
    return int(about.nmant), int(about.minexp)


def _in_ulp(error: Any, size: Any, dtype: str) -> Any:
    """The error in units in the last place of `dtype`, at numbers of this size."""
    import jax
    import jax.numpy as jnp

    fraction, least = number_format(dtype)
    biased = jnp.maximum(jax.lax.bitcast_convert_type(size, jnp.int64) >> 52, least + 1023)
    power = (fraction + 2 * 1023) - biased  # of two, with a float64's bias
    # It can be beyond 2**1023, at numbers below 2**-971, which float64 alone has: then in two steps.
    steps = (power // 2 + 512, power - power // 2 + 511) if fraction - least > 1023 else (power,)
    for step in steps:
        error = error * jax.lax.bitcast_convert_type(step << 52, jnp.float64)
    return error


def _reduced(errors: dict[str, Any]) -> dict[str, Any]:
    """The samples of each group as one, in one sweep, whose running results are a handful of numbers."""
    import jax
    import jax.numpy as jnp

    terms = {f"sum_{name}": (errors[name], 0.0) for name in SUMS} | {"counts": (errors["counts"], 0)}
    terms |= {"highest": (jnp.where(errors["known"], errors["exact"], -jnp.inf), -jnp.inf)}
    terms |= {"lowest": (jnp.where(errors["known"], errors["exact"], jnp.inf), jnp.inf)}
    terms |= {f"worst_{name}": (_counting(name, errors), -1.0) for name in WORST}
    names = list(terms)

    def together(one: tuple[Any, ...], other: tuple[Any, ...]) -> tuple[Any, ...]:
        left, right = dict(zip(names, one, strict=True)), dict(zip(names, other, strict=True))
        new = {name: left[name] + right[name] for name in names if name.startswith("sum_") or name == "counts"}
        # A choice is one instruction; maximum and minimum, which let nan through, are several, and no nan comes here.
        new["lowest"] = jnp.where(left["lowest"] < right["lowest"], left["lowest"], right["lowest"])
        for name in names:
            if name not in new:
                new[name] = jnp.where(left[name] > right[name], left[name], right[name])
        return tuple(new[name] for name in names)

    arrays = tuple(array for array, _ in terms.values())
    begins = tuple(jnp.asarray(begin, array.dtype) for array, begin in terms.values())
    return dict(zip(names, jax.lax.reduce(arrays, begins, together, (1,)), strict=True))


def _counting(name: str, errors: dict[str, Any]) -> Any:
    """The errors of a kind; -1, not 0, where one is left out: it is never the worst, not even where all are 0."""
    import jax.numpy as jnp

    return jnp.where(_mask(name, errors), errors[name], -1.0)


def _mask(name: str, errors: dict[str, Any]) -> Any:
    """Where an error of that kind is defined."""
    return errors["nonzero" if name == "relative" else "finite"]


def _histograms(errors: dict[str, Any]) -> dict[str, Any]:
    import jax.numpy as jnp

    def histogram(name: str) -> Any:
        return jnp.zeros(BINS, jnp.int64).at[_bin(errors[name])].add(_mask(name, errors).astype(jnp.int64))

    return {f"{name}_bins": histogram(name) for name in ("absolute", "relative")}


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


def _folded(groups: dict[str, Any]) -> dict[str, Any]:
    """The groups of a chunk as one."""
    import jax.numpy as jnp

    found = {name: jnp.sum((groups["counts"] >> (8 * place)) & 255) for place, name in enumerate(COUNTS)}
    high = jnp.stack([groups[f"sum_{name}"] for name in SUMS])
    low = jnp.zeros_like(high)
    while high.shape[1] > 1:
        half = high.shape[1] // 2
        high, low = _two_sum((high[:, :half], low[:, :half] + low[:, half:]), high[:, half:])
    found["sums"] = jnp.concatenate([high, low], axis=1)
    highest, lowest = jnp.max(groups["highest"]), jnp.min(groups["lowest"])
    peak = jnp.maximum(jnp.maximum(highest, -lowest), 0)  # 0 where no exact value is known
    found["extremes"] = jnp.stack([peak, highest, lowest])
    return found
