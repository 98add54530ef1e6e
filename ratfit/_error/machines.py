"""Several processes, on one machine or on many, that measure the same thing together, by JAX's own means."""

from __future__ import annotations

import contextlib
import socket
import time
from collections.abc import Iterator
from typing import Any

from ratfit._parse import RatfitError

PATIENCE = 60.0
"""Seconds to wait for the others."""

GREETING = 2.0
"""Seconds that somebody who has come may take to say who it is."""


def join(coordinator: str, processes: int, process: int) -> None:
    """Make this process one of several that measure together.

    **Arguments:**

    - `coordinator`: address and port of process 0, `"host:port"`, the same for all.
    - `processes`, `process`: how many there are, and which of them this is, from 0.

    **Fails** with `RatfitError` for what cannot be right, and when the others do not come within a minute. Once all
    have met, the loss of one ends the others: JAX sees to that.
    """
    import jax

    host, colon, port = coordinator.rpartition(":")
    if not (host and colon and port.isdecimal() and 0 < int(port) < 2**16):
        raise RatfitError(f"--coordinator {coordinator}: the address of process 0 is needed, as in 10.0.0.1:9876")
    if processes < 1 or not 0 <= process < processes:
        raise RatfitError(f"--process {process} of --processes {processes}: count them from 0 to {processes - 1}")
    # JAX ends a process that waits in vain without a word that a person could use: so all are counted before.
    try:
        _call_roll(int(port), processes) if process == 0 else _answer(host, int(port), processes, process)
    except OSError as reason:
        raise RatfitError(f"--coordinator {coordinator}: {reason.strerror or reason}; choose another port") from None
    jax.config.update("jax_cpu_collectives_implementation", "gloo")
    jax.distributed.initialize(coordinator, processes, process, initialization_timeout=round(PATIENCE))


def _call_roll(port: int, processes: int) -> None:
    """Wait until every other process has said which one it is, and let all go on."""
    end = time.monotonic() + PATIENCE
    with socket.create_server(("", port)) as server, contextlib.ExitStack() as open_ones:
        present: dict[str, socket.socket] = {}
        while len(present) < processes - 1:
            server.settimeout(max(end - time.monotonic(), 0.001))
            try:
                other = open_ones.enter_context(server.accept()[0])
            except TimeoutError:
                came = f"{len(present) + 1} of {processes} processes came within {PATIENCE:.0f} s"
                raise RatfitError(f"{came}: begin the others, with --process 1 to {processes - 1}") from None
            name = _line(other, min(end, time.monotonic() + GREETING))
            if name in {_name(number, processes) for number in range(1, processes)} - {*present}:
                present[name] = other
        for other in present.values():
            other.sendall(b"go\n")


def _answer(host: str, port: int, processes: int, process: int) -> None:
    """Tell process 0 that this one is there, as soon as that one is, and wait for its word."""
    end = time.monotonic() + PATIENCE
    for _ in _while(end):
        with (
            contextlib.suppress(ConnectionRefusedError, TimeoutError),
            socket.create_connection((host, port), 1) as first,
        ):
            first.sendall(f"{_name(process, processes)}\n".encode())
            if _line(first, end) == "go":
                return
            break
    raise RatfitError(
        f"process 0 at {host}:{port} did not let process {process} in within {PATIENCE:.0f} s: begin all "
        f"{processes} with the same --coordinator and --processes, each with a --process of its own"
    )


def _while(end: float) -> Iterator[None]:
    while time.monotonic() < end:
        yield
        time.sleep(0.1)


def _name(process: int, processes: int) -> str:
    return f"ratfit {process} of {processes}"


def _line(other: socket.socket, end: float) -> str:
    """One short line; what comes late, or is too long, is none."""
    text = b""
    with contextlib.suppress(TimeoutError, ConnectionResetError):
        while not text.endswith(b"\n") and len(text) < 64:
            other.settimeout(max(end - time.monotonic(), 0.001))
            part = other.recv(64)
            if not part:
                break
            text += part
    return text.decode("ascii", "replace").rstrip("\n")


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
