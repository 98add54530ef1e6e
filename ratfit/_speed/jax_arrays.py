"""The regime of jitted arrays: JAX, on the processor or on a graphics card."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable
from typing import Any

from ratfit._kernel import kernel, precision
from ratfit._speed.contest import Contest, Entrant, Runs


def devices(platform: str) -> list[Any]:
    """JAX's devices of a platform; none where it has no such platform."""
    import jax

    try:
        return jax.devices(platform)
    except RuntimeError:  # JAX's way to say that it has none
        return []


def lacking(platform: str) -> str:
    """What this machine lacks for it; nothing when it may run."""
    return "" if devices(platform) else f"JAX finds no {platform}"


def prepare(contest: Contest, platform: str) -> Runs:
    """Three compiled kernels on the first device of the platform; their compilation is left to their first call."""
    import jax

    device = devices(platform)[0]
    scope = functools.partial(precision, contest.dtype)
    with scope():
        samples = tuple(jax.device_put(array, device) for array in contest.samples)
    calls = tuple(_call(entrant, contest, samples, device) for entrant in contest.entrants)
    return Runs(calls, os.environ.get("XLA_FLAGS", ""), scope=scope)


def _call(entrant: Entrant, contest: Contest, samples: tuple[Any, ...], device: Any) -> Callable[[], Any]:
    run = kernel(entrant.program, entrant.varying).at(contest.place.values, contest.dtype, device)
    return lambda: run(*samples).block_until_ready()
