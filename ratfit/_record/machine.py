"""Where rows are measured."""

from __future__ import annotations

import contextlib
import functools
import os
import platform
import sys
from importlib import metadata
from pathlib import Path
from typing import Any


def machine() -> dict[str, Any]:
    """Where the rows are measured: processor, cores that this process may use, JAX's devices, versions."""
    packages = {name: _version(name) for name in ("numpy", "jax", "sympy")}
    return {
        "processor": _processor(),
        "cores": cores(),
        "devices": _devices(),
        "versions": {"python": platform.python_version(), **packages, "ratfit": ratfit_version()},
    }


def cores() -> int:
    """The cores that this process may use."""
    return len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1


def ratfit_version() -> str:
    """The version of the code that runs, which need not be the one that an installer noted some time ago."""
    import ratfit

    return ratfit.__version__


@functools.cache
def _version(package: str) -> str | None:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


@functools.cache
def _processor() -> str:
    with contextlib.suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def _devices() -> list[str]:
    """The devices of a JAX that is loaded already; what measured nothing with JAX does not wait for it."""
    jax = sys.modules.get("jax")
    return [f"{device.platform}: {device.device_kind}" for device in jax.devices()] if jax else []
