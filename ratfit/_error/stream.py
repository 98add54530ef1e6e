"""Chunks of samples streamed through all devices that JAX has: one, several, or those of several machines.

Which device makes a chunk does not show in it, and the totals of the chunks are added exactly; so the result is the
same to the last bit on 1 device and on 8, in 1 process and in 2, in one go or resumed.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from ratfit._error.chunk import CHUNK, Pass, chunk_totals, exact_program
from ratfit._error.totals import NOTHING, Totals, of_chunks
from ratfit._kernel import Program, kernel, precision
from ratfit._sampling import bounds
from ratfit._setting import Setting

CHUNKS = 32
"""The most chunks that a device takes at once: some tenths of a second, after which one hears how far it is."""

SAVED = 10.0
"""Seconds of work that an interruption may cost at most."""


@dataclass(frozen=True)
class Watch:
    """What goes on beside a long pass: who is told of progress, and where the state is kept that it is resumed from."""

    progress: Callable[[int, int], None] = lambda done, samples: None
    state: Mapping[str, Any] | None = None
    save: Callable[[Mapping[str, Any]], None] | None = None


def stream(what: Pass, place: Setting, samples: int, seed: int, watch: Watch) -> Totals:
    """The totals of all samples, in one pass of this kind."""
    done, total = _resumed(watch.state)
    saved = time.monotonic()
    try:
        for reached, part in _parts(what, place, samples, seed, done):
            done, total = reached, total + part
            watch.progress(min(done * CHUNK, samples), samples)
            if watch.save and time.monotonic() - saved > SAVED:
                watch.save(_state(done, total))
                saved = time.monotonic()
    except KeyboardInterrupt:
        if watch.save:
            watch.save(_state(done, total))
        raise
    return total


def _resumed(state: Mapping[str, Any] | None) -> tuple[int, Totals]:
    return (state["chunks"], Totals.from_state(state["totals"])) if state else (0, NOTHING)


def _state(done: int, total: Totals) -> dict[str, Any]:
    return {"chunks": done, "totals": total.to_state()}


def _parts(what: Pass, place: Setting, samples: int, seed: int, done: int) -> Iterator[tuple[int, Totals]]:
    """The totals from chunk `done` on, part by part, each with the number of chunks that are done after it.

    The next part is given to the devices before the last one is added up, so that they never wait.
    """
    import numpy as np

    run, devices = _compiled(what), _devices()
    chunks = -(-samples // CHUNK)
    size = devices * min(CHUNKS, -(-chunks // devices))
    constants = kernel(what.fit, what.varying).constants(place.values, what.dtype), _constants_of_exact(what, place)
    # Few arrays: each takes its time to reach the devices.
    given = np.array([samples, seed], np.uint64), np.array(bounds(place, what.dtype)), *map(np.array, constants)
    waiting = None
    with precision("float64"), np.errstate(over="ignore"):  # constants of the fit may leave the dtype under test
        for first in range(done, chunks, size):
            begun = run(np.arange(first, first + size, dtype=np.uint64) * np.uint64(CHUNK), *given)
            if waiting:
                yield first, _fetched(waiting)
            waiting = begun
        if waiting:
            yield chunks, _fetched(waiting)


def _constants_of_exact(what: Pass, place: Setting) -> list[Any]:
    import numpy as np

    if what.double_double:
        return [np.asarray(place.values[symbol]) for symbol in what.fixed]
    return kernel(what.exact, what.varying).constants(place.values, "float64")


def pass_of(place: Setting, sampling: str, dtype: str, quantiles: bool, double_double: bool = False) -> Pass:
    """What is to be compiled for a setting; `double_double` is the arithmetic of its exact function."""
    fixed = tuple(place.values) if double_double else ()
    exact = Program(place.exact) if double_double else exact_program(place)
    return Pass(place.program, exact, place.varying, sampling, dtype, quantiles, double_double, fixed)


def _fetched(found: Mapping[str, Any]) -> Totals:
    import numpy as np

    return of_chunks({name: np.asarray(array) for name, array in found.items()})


def _devices() -> int:
    import jax

    return len(jax.devices())


@functools.lru_cache(maxsize=64)
def _compiled(what: Pass) -> Callable[..., dict[str, Any]]:
    """The pass over the chunks that begin at `starts`, shared out among the devices; every process gets all totals."""
    import jax
    from jax.sharding import AxisType, NamedSharding, PartitionSpec

    mesh = jax.make_mesh((_devices(),), ("devices",), (AxisType.Auto,))
    each, whole = PartitionSpec("devices"), PartitionSpec()

    def local(starts: Any, numbers: Any, ends: Any, *constants: Any) -> dict[str, Any]:
        samples, seed = numbers
        found = jax.lax.map(lambda start: chunk_totals(what, start, samples, seed, list(ends), constants), starts)
        return {n: part.sum(axis=0, keepdims=True) if n.endswith("_bins") else part for n, part in found.items()}

    shared = jax.shard_map(local, mesh=mesh, in_specs=(each, *[whole] * 4), out_specs=each, check_vma=False)
    return jax.jit(shared, out_shardings=NamedSharding(mesh, whole))
