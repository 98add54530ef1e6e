"""All streamed definitions of eps against drawing, fit and reference alone; then more samples, memory, every float32.

`python benchmarks/streaming.py [ROUNDS [MOST]]`: so many rounds in turn, and at most so many samples (1e9).
The peer draws the same samples, evaluates the fit in float32 and the reference in float64, keeps both, and does nothing
else, in the quickest of three forms: one array, chunks, or rows that stay in the cache, the last two on all devices.
"""

import os
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.sharding import AxisType, PartitionSpec

import ratfit as rf
from ratfit._error.chunk import LANES, Pass
from ratfit._error.devices import use_all_cores
from ratfit._error.stream import Watch, pass_of, stream
from ratfit._kernel import kernel, precision
from ratfit._sampling import bounds, count, drawing
from ratfit._setting import Setting, setting

SETTINGS = {
    "eq12": ({}, None), "eq15": ({}, "glass"), "eq19": ({"m": 0.25}, None), "eq21": ({"m": 0.25}, None),
}  # fmt: skip
SAMPLES = 1_000_000
FORMS = {"one array": (SAMPLES, False), "chunks": (2**18, False), "rows": (LANES, False), "drawn first": (LANES, True)}
BAR, LONG_BAR, MEMORY_BAR = 2.0, 1.1, 300


def main() -> None:
    rounds, most = int(sys.argv[1]) if sys.argv[1:] else 21, int(float(sys.argv[2])) if sys.argv[2:] else 10**9
    use_all_cores()  # as bench does
    devices = len(jax.devices())
    print(f"1e6 float32 samples on {devices} devices, medians of {rounds} rounds in turn")
    print("equation  peer ms (its form)    eps ms  ratio  with quantiles   bar")
    for name, (parameters, reference) in SETTINGS.items():
        print_row(name, setting(rf.derive(name), parameters, reference), rounds)
    few = 10**7
    short, long = (in_a_process("long", samples) for samples in (few, most))
    ratio = (long[0] / most) / (short[0] / few)
    print(
        f"eq12: {1e9 * long[0] / most:.2f} ns a sample at {most:.0e}, {1e9 * short[0] / few:.2f} at {few:.0e}: ", end=""
    )
    print(f"{ratio:.2f}; bar {LONG_BAR}{verdict(ratio, LONG_BAR)}")
    growth = long[1] - in_a_process("long", SAMPLES)[1]
    print(f"peak memory at {most:.0e} is {growth:+.0f} MB beside that at 1e6; bar {MEMORY_BAR}", end="")
    print(verdict(growth, MEMORY_BAR))
    if most >= 10**9:
        seconds = in_a_process("exhaustive", 0, devices=2)[0]
        print(f"sin: every float32 of [0, pi/2] in {seconds:.1f} s on 2 devices; bar 60{verdict(seconds, 60)}")


def verdict(value: float, bar: float) -> str:
    """What a line ends with: nothing where the bar is kept."""
    return "" if value <= bar else ": NOT reached"


# --- The ratio ---


def print_row(name: str, place: Setting, rounds: int) -> None:
    """One equation: the peer in its quickest form, and eps without and with quantiles."""
    plain, full = (pass_of(place, "uniform", "float32", quantiles) for quantiles in (False, True))
    runs = {form: peer(plain, place, *how) for form, how in FORMS.items()}
    runs |= {"plain": eps(plain, place), "full": eps(full, place)}
    times = medians(runs, rounds)
    best = min(FORMS, key=times.__getitem__)
    ratios = [times[kind] / times[best] for kind in ("plain", "full")]
    shown = (
        f"{1e3 * times[best]:8.2f} ({best})".ljust(22) + f"{1e3 * times['plain']:8.2f}{ratios[0]:7.2f}{ratios[1]:16.2f}"
    )
    print(f"{name:8}{shown}{BAR:6.1f}{verdict(ratios[0], BAR)}")


def medians(runs: Mapping[str, Callable[[], Any]], rounds: int) -> dict[str, float]:
    """The median seconds of each, run in turn, so that what disturbs the machine disturbs all of them alike."""
    for run in runs.values():
        run()
    times: dict[str, list[float]] = {name: [] for name in runs}
    for _ in range(rounds):
        for name, run in runs.items():
            begun = time.perf_counter()
            run()
            times[name].append(time.perf_counter() - begun)
    return {name: statistics.median(each) for name, each in times.items()}


def eps(what: Pass, place: Setting) -> Callable[[], Any]:
    """All that `measure_error` streams."""
    return lambda: stream(what, place, SAMPLES, 0, Watch())


def peer(what: Pass, place: Setting, size: int, first: bool) -> Callable[[], Any]:
    """Drawing, fit and reference, so many samples at a time; both results are kept."""
    fit, exact = (kernel(program, what.varying) for program in (what.fit, what.exact))
    constants = fit.constants(place.values, what.dtype), exact.constants(place.values, "float64")
    devices = 1 if size == SAMPLES else len(jax.devices())
    ends, parts = bounds(place, what.dtype), devices * -(-SAMPLES // (size * devices))
    mesh = jax.make_mesh((devices,), ("devices",), (AxisType.Auto,), devices=jax.devices()[:devices])
    each, whole = PartitionSpec("devices"), PartitionSpec()

    def drawn(start: Any, seed: Any, ends: Any) -> Any:
        return drawing(what.sampling, what.dtype)(seed, start + jnp.arange(size, dtype=jnp.uint64), ends)

    def evaluated(points: Any, wide: Any, constants: Any) -> tuple[Any, Any]:
        return fit.function(*points, *constants[0]), exact.function(*wide, *constants[1])

    def widened(points: Any) -> Any:
        return [point.astype(jnp.float64) for point in points]

    def all_of_them(starts: Any, seed: Any, ends: Any, constants: Any) -> tuple[Any, Any]:
        if parts == 1:
            points = drawn(starts[0], seed, ends)
            return evaluated(points, widened(points), constants)
        if not first:
            return jax.lax.map(lambda start: evaluated(*both(drawn(start, seed, ends)), constants), starts)
        points = jax.lax.map(lambda start: drawn(start, seed, ends), starts)
        wide = jax.lax.map(widened, points)
        return jax.lax.map(lambda given: evaluated(*given, constants), (points, wide))

    def both(points: Any) -> tuple[Any, Any]:
        return points, widened(points)

    shared = jax.shard_map(
        all_of_them, mesh=mesh, in_specs=(each, whole, whole, whole), out_specs=each, check_vma=False
    )
    compiled = jax.jit(shared if devices > 1 else all_of_them)
    starts = np.arange(parts, dtype=np.uint64) * np.uint64(size)

    def run() -> None:
        with precision("float64"):
            jax.block_until_ready(compiled(starts, np.uint64(0), ends, constants))

    return run


# --- Many samples, each measurement in a process of its own ---


def seconds_of(kind: str, samples: int) -> float:
    """A pass of eq12 without what compiling takes: `long`, of so many samples, or `exhaustive`, of every number."""
    place = setting(rf.derive("eq12"))
    what = pass_of(place, "uniform" if kind == "long" else "exhaustive", "float32", True)
    samples = samples if kind == "long" else count(place.low, place.high, "float32")
    stream(what, place, min(samples, 2**22), 0, Watch())
    begun = time.perf_counter()
    stream(what, place, samples, 0, Watch())
    return time.perf_counter() - begun


def in_a_process(kind: str, samples: int, devices: int = 1) -> tuple[float, float]:
    """Seconds, and the peak of memory in MB."""
    flags = f"--xla_force_host_platform_device_count={devices}"
    command = [sys.executable, __file__, "--task", kind, str(samples)]
    found = subprocess.run(command, env={**os.environ, "XLA_FLAGS": flags}, capture_output=True, text=True, check=True)
    seconds, memory = map(float, found.stdout.split())
    return seconds, memory


if __name__ == "__main__":
    if sys.argv[1:2] == ["--task"]:
        print(seconds_of(sys.argv[2], int(sys.argv[3])), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
    else:
        main()
