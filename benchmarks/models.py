"""Whole models on JAX: Schlick's against the copy floor of its inputs and output, and against the true Cook-Torrance.

`python benchmarks/models.py [ROUNDS]`: 1e6 pairs of directions in float32, on the CPU, every program compiled once and
run in turn. The floor reads the six coordinates of every pair and writes one number, their sum and 1. Beside it stands
what a copy of the inputs and the output takes, the slower reading of a floor.
"""

import statistics
import sys
import time
from collections.abc import Callable, Mapping
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from ratfit.models import named

PAIRS = 1_000_000
FLOOR_BAR, FASTER_BAR = 3.0, 5.0
BESIDE = ("schlick-double", "schlick-conserving", "cook-torrance-as-printed", "cook-torrance-optimised")
"""Models that no bar is set for."""


def main() -> None:
    rounds = int(sys.argv[1]) if sys.argv[1:] else 41
    jax.config.update("jax_platforms", "cpu")
    pair = directions(0), directions(1)
    names = ("schlick", "cook-torrance", *BESIDE)
    programs = {"copy floor": floor, "copy": copy} | {name: named(name).__call__ for name in names}
    times = in_turn({name: compiled(program, pair) for name, program in programs.items()}, rounds)
    print(f"{PAIRS:.0e} pairs of float32 directions, medians of {rounds} rounds in turn")
    print("program                          ms  quickest  times the floor")
    for name, each in times.items():
        ratio = middle(times, name, "copy floor")
        print(f"{name:28}{1e3 * statistics.median(each):7.2f}{1e3 * min(each):10.2f}{ratio:17.2f}")
    to_floor, faster = middle(times, "schlick", "copy floor"), middle(times, "cook-torrance", "schlick")
    kept = "" if to_floor < FLOOR_BAR else ": NOT reached"
    print(f"schlick takes {to_floor:.2f} times the copy floor; bar below {FLOOR_BAR:.0f}{kept}")
    kept = "" if faster >= FASTER_BAR else ": NOT reached"
    print(f"schlick is {faster:.2f} times as fast as cook-torrance; bar {FASTER_BAR:.0f}{kept}")
    quickest = min(times["schlick"]) / min(times["copy floor"]), min(times["cook-torrance"]) / min(times["schlick"])
    print(f"of the quickest rounds alone: {quickest[0]:.2f} and {quickest[1]:.2f}")


def directions(seed: int) -> jax.Array:
    """Directions spread evenly over the hemisphere."""
    random = np.random.default_rng(seed)
    z, phi = random.uniform(0, 1, PAIRS), random.uniform(0, 2 * np.pi, PAIRS)
    s = np.sqrt(1 - z * z)
    return jnp.asarray(np.stack([s * np.cos(phi), s * np.sin(phi), z], axis=-1), jnp.float32)


def floor(view: Any, light: Any) -> Any:
    """Every number read, one a pair written."""
    return sum(array[..., axis] for array in (view, light) for axis in range(3)) + 1


def copy(view: Any, light: Any) -> Any:
    """Every number of the inputs and of an output read and written."""
    return view + 1, light + 1, view[..., 0] + 1


def compiled(program: Callable[[Any, Any], Any], pair: tuple[Any, Any]) -> Callable[[], Any]:
    """A call that runs the program and waits for its last number; the first has compiled it."""
    function = jax.jit(lambda view, light: program(view, light))

    def run() -> None:
        jax.block_until_ready(function(*pair))

    run()
    return run


def in_turn(runs: Mapping[str, Callable[[], Any]], rounds: int) -> dict[str, list[float]]:
    """The seconds of each, run in turn, so that what disturbs the machine disturbs all of them alike."""
    times: dict[str, list[float]] = {name: [] for name in runs}
    for _ in range(rounds):
        for name, run in runs.items():
            begun = time.perf_counter()
            run()
            times[name].append(time.perf_counter() - begun)
    return times


def middle(times: Mapping[str, list[float]], over: str, under: str) -> float:
    """The ratio of two medians."""
    return statistics.median(times[over]) / statistics.median(times[under])


if __name__ == "__main__":
    main()
