"""The regimes of compiled C: exact, fit and floor as three loops of one shared object.

`SCALAR` is what a renderer of 1994 meant by the cost of a function: one sample after the other, each operation rounded
as it is written, calls of the mathematical library. `FAST` is what one would ship today.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ratfit._kernel import in_dtype
from ratfit._speed.c_source import c_source
from ratfit._speed.compiler import compiler, load, version
from ratfit._speed.contest import NAMES, Contest, Entrant, Runs

SCALAR = (
    "-O2",  # registers and common subexpressions, no transformation that changes a result
    "-fno-tree-vectorize",  # gcc vectorises loops at -O2 since 12, and straight code by the next flag's pass
    "-fno-tree-slp-vectorize",
    "-ffp-contract=off",  # a * b + c in two roundings also where the processor could do it in one
)
FAST = (
    "-O3",  # with vectorised loops
    "-march=native",  # of the widest registers here, multiplying and adding at once
    "-ffast-math",  # sums in any order, reciprocals, glibc's vectorised functions; nan and infinity not honoured
)


def prepare(contest: Contest, flags: tuple[str, ...]) -> Runs:
    """Three functions of a shared object, each with an array of its own to write to.

    **Fails** with `RatfitError` without a compiler, and where the compiler does.
    """
    command = compiler()
    tapes = {_c_name(entrant): entrant.steps for entrant in contest.entrants}
    library = load(c_source(tapes, len(contest.samples), contest.dtype), flags, command)
    calls = tuple(_call(library[_c_name(entrant)], entrant, contest) for entrant in contest.entrants)
    caution = "-ffast-math honours neither nan nor infinity" if "-ffast-math" in flags else ""
    return Runs(calls, f"{version(command)}: {' '.join(flags)}", caution)


def _c_name(entrant: Entrant) -> str:
    """A name that the mathematical library does not have: its `floor` is another."""
    return f"run_{NAMES.index(entrant.name)}"


@dataclass(frozen=True)
class _Call:
    """A call of one function. It holds the arrays, of which the function is told bare addresses."""

    function: Callable[..., None]
    addresses: tuple[Any, ...]
    samples: tuple[Any, ...]
    constants: Any
    out: Any

    def __call__(self) -> Any:
        self.function(*self.addresses)
        return self.out


def _call(function: Any, entrant: Entrant, contest: Contest) -> _Call:
    import numpy as np

    function.argtypes, function.restype = (ctypes.c_size_t, *(ctypes.c_void_p,) * 3), None
    samples = tuple(np.ascontiguousarray(array) for array in contest.samples)
    constants = in_dtype(entrant.constants, contest.dtype)
    # nan at first: what a function leaves out is no value that an earlier one has left there.
    out = np.full(samples[0].size, np.nan, contest.dtype)
    columns = (ctypes.c_void_p * len(samples))(*(array.ctypes.data for array in samples))
    addresses = (out.size, columns, constants.ctypes.data, out.ctypes.data)
    return _Call(function, addresses, samples, constants, out)
