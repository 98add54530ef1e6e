"""What one process of `test_scale` measures: run with the number of its devices in XLA_FLAGS.

`python scale_worker.py [COORDINATOR PROCESSES PROCESS]` prints one JSON object: what a name stands for, bit for bit.
"""

import dataclasses
import hashlib
import json
import sys

import jax
import numpy as np

import ratfit as rf
from ratfit._kernel import precision
from ratfit._sampling import EXHAUSTIVE, drawing
from ratfit._sampling.ends import ends
from ratfit._sampling.protocols import CARRIERS

SAMPLES = 3_000_000  # 12 chunks, the last one not full
MEASURED = {"eq12": {}, "eq19": {"m": "random"}}


def main() -> None:
    if sys.argv[1:]:
        jax.config.update("jax_cpu_collectives_implementation", "gloo")
        jax.distributed.initialize(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
    found = {name: measured(name, parameters) for name, parameters in MEASURED.items()}
    if jax.process_count() == 1 and jax.device_count() <= 2:
        found |= {f"{sampling} {dtype}": points(sampling, dtype) for sampling, dtype in protocols()}
    if jax.process_index() == 0:
        print(json.dumps({"devices": jax.device_count(), "processes": jax.process_count(), "found": found}))


def measured(name: str, parameters: dict[str, str]) -> dict[str, object]:
    """All of a measurement; JSON writes floats so that they read back as they were."""
    return dataclasses.asdict(rf.measure_error(rf.derive(name), samples=SAMPLES, seed=7, parameters=parameters))


def protocols() -> list[tuple[str, str]]:
    """Every protocol, in a dtype."""
    return [*((name, "float64") for name in CARRIERS), *(("exhaustive", dtype) for dtype in EXHAUSTIVE)]


def points(sampling: str, dtype: str) -> str:
    """A digest of the points of a protocol that all devices draw together, with a random parameter where it may be."""
    spec = jax.sharding.PartitionSpec("devices")
    mesh = jax.make_mesh((jax.device_count(),), ("devices",), (jax.sharding.AxisType.Auto,))
    ranges = [ends(0.0, 1.0, dtype)] + ([] if sampling == "exhaustive" else [ends(0.01, 0.5, dtype)])

    def local(counters: jax.Array) -> tuple[jax.Array, ...]:
        return drawing(sampling, dtype)(np.uint64(5), counters, ranges)

    with precision("float64"):
        run = jax.jit(jax.shard_map(local, mesh=mesh, in_specs=spec, out_specs=spec, check_vma=False))
        drawn = run(np.arange(2**12, dtype=np.uint64))
    return hashlib.sha256(b"".join(np.asarray(each).tobytes() for each in drawn)).hexdigest()


if __name__ == "__main__":
    main()
