"""The devices of this machine, or of several, that a stream of samples is shared out among."""

from __future__ import annotations

import os
import sys
from typing import Any

from ratfit._parse import RatfitError

PATIENCE = 60
"""Seconds to wait for the other processes before giving up."""


def use_all_cores() -> None:
    """Make a device of every core that this process may use, where nobody has said how many there are to be.

    To be called before JAX computes anything: later it changes nothing.
    """
    import jax

    in_flags = "xla_force_host_platform_device_count" in os.environ.get("XLA_FLAGS", "")
    if not in_flags and jax.config.jax_num_cpu_devices < 0:  # type: ignore[attr-defined]  # -1: nobody has said
        jax.config.update("jax_num_cpu_devices", cores())


def cores() -> int:
    """The cores that this process may use."""
    return len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1


def join(coordinator: str, processes: int, process: int) -> None:
    """Make this process one of several, on one machine or on many, that measure the same thing together.

    **Arguments:**

    - `coordinator`: address and port of process 0, `"host:port"`, the same for all.
    - `processes`, `process`: how many there are, and which of them this is, from 0.

    **Fails** with `RatfitError` for what cannot be right, and when the others do not come within a minute.
    """
    import jax

    host, colon, port = coordinator.rpartition(":")
    if not (host and colon and port.isdecimal() and 0 < int(port) < 2**16):
        raise RatfitError(f"--coordinator {coordinator}: the address of process 0 is needed, as in 10.0.0.1:9876")
    if processes < 1 or not 0 <= process < processes:
        raise RatfitError(f"--process {process} of --processes {processes}: count them from 0 to {processes - 1}")
    jax.config.update("jax_cpu_collectives_implementation", "gloo")
    try:
        jax.distributed.initialize(coordinator, processes, process, initialization_timeout=PATIENCE)
    except (RuntimeError, ValueError) as reason:
        line = str(reason).strip().splitlines()[0]
        raise RatfitError(f"--coordinator {coordinator}: the {processes} processes did not meet ({line})") from None


def is_first() -> bool:
    """Whether this process is the one that writes and prints: the only one, or process 0 of several."""
    import jax

    return jax.process_index() == 0


def as_first_says(numbers: Any) -> Any:
    """An array of whole numbers as process 0 has it, in every process."""
    import jax
    import numpy as np
    from jax.experimental import multihost_utils

    if jax.process_count() == 1:
        return np.asarray(numbers)
    return np.asarray(multihost_utils.broadcast_one_to_all(np.asarray(numbers)))
