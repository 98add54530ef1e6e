"""The backends by name: in which regime each measures, and what a machine must have for it."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ratfit._parse import RatfitError, nearest
from ratfit._speed import compiled, compiler, jax_arrays, numpy_arrays
from ratfit._speed.contest import Contest, Runs

COST_MODEL = "cost-model"


@dataclass(frozen=True)
class Backend:
    """What runs a contest, and what a machine lacks for it: nothing where it may run."""

    regime: str
    lacking: Callable[[], str]
    prepare: Callable[[Contest], Runs] | None  # None where nothing runs


def _jax(platform: str) -> Backend:
    return Backend(
        "jitted arrays",
        functools.partial(jax_arrays.lacking, platform),
        functools.partial(jax_arrays.prepare, platform=platform),
    )


def _c(regime: str, flags: tuple[str, ...]) -> Backend:
    return Backend(regime, compiler.lacking, functools.partial(compiled.prepare, flags=flags))


def _nothing() -> str:
    return ""


_TABLE: Mapping[str, Backend] = {
    "jax-cpu": _jax("cpu"),
    "jax-gpu": _jax("gpu"),
    "numpy": Backend("NumPy arrays", _nothing, numpy_arrays.prepare),
    "c-scalar": _c("compiled scalar C", compiled.SCALAR),
    "c-fast": _c("compiled vectorised C", compiled.FAST),
    COST_MODEL: Backend("operation costs", _nothing, None),
}

BACKENDS: Mapping[str, str] = {name: backend.regime for name, backend in _TABLE.items()}
"""Name of a backend -> the regime in which it measures."""


def available() -> tuple[str, ...]:
    """The backends that this machine has, by name."""
    return tuple(name for name, backend in _TABLE.items() if not backend.lacking())


def backend_named(name: str) -> Backend:
    """The backend of a name.

    **Fails** with `RatfitError` for an unknown name, and for a backend that this machine cannot run.
    """
    if name not in _TABLE:
        raise RatfitError(f"no backend {name!r}, there is: {', '.join(_TABLE)}{nearest(name, _TABLE)}")
    lack = _TABLE[name].lacking()
    if lack:
        raise RatfitError(f"no {name} on this machine ({lack}); it has: {', '.join(available())}")
    return _TABLE[name]
