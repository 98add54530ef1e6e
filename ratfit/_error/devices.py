"""The devices of this machine that a stream of samples is shared out among."""

from __future__ import annotations

import contextlib
import os

from ratfit._record.machine import cores


def use_all_cores() -> None:
    """Make a device of every core that this process may use, where nobody has said how many there are to be.

    To be called before JAX computes anything: later it changes nothing.
    """
    import jax

    in_flags = "xla_force_host_platform_device_count" in os.environ.get("XLA_FLAGS", "")
    if not in_flags and jax.config.jax_num_cpu_devices < 0:  # type: ignore[attr-defined]  # -1: nobody has said
        with contextlib.suppress(RuntimeError):  # JAX has computed already, on the devices that it then made
            jax.config.update("jax_num_cpu_devices", cores())
