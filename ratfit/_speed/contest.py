"""What is timed against what: exact function, fit and copy floor, of the same samples."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import sympy as sp

from ratfit._kernel import Hoisted, Program, hoist
from ratfit._lower import Step, tape
from ratfit._parse import RatfitError
from ratfit._sampling import bounds, drawn, protocol_at
from ratfit._setting import Setting

NAMES = ("exact function", "fit", "copy floor")


class Unsupported(RatfitError):
    """What one backend cannot run, whatever the machine has: that says nothing of the others."""


@dataclass(frozen=True)
class Entrant:
    """One of the three: its program with all that stands still taken out of it, and the values of that."""

    name: str
    program: Program
    hoisted: Hoisted
    varying: tuple[sp.Symbol, ...]
    constants: tuple[float, ...]  # in float64; each backend rounds them to the dtype under test

    @property
    def steps(self) -> tuple[Step, ...]:
        """The operations on each sample."""
        return tape(self.hoisted.result, self.hoisted.symbols, self.hoisted.steps)


@dataclass(frozen=True)
class Contest:
    """The three, what they run on, and the values of the parameters that stand still."""

    entrants: tuple[Entrant, ...]  # exact, fit, floor
    samples: tuple[Any, ...]  # NumPy arrays in the dtype under test: the variable, then the parameters drawn at random
    place: Setting
    dtype: str


@dataclass(frozen=True)
class Runs:
    """What a backend makes of a contest: a call for each entrant that computes every sample and waits for the last."""

    calls: tuple[Callable[[], Any], ...]
    flags: str
    caution: str = ""  # what to say beside an output that is not finite
    scope: Callable[[], contextlib.AbstractContextManager[Any]] = contextlib.nullcontext  # in which to call them


def contest(place: Setting, samples: int, seed: int, dtype: str) -> Contest:
    """Exact, fit and floor of a setting, on uniform samples; of a whole model, on pairs of directions."""
    return Contest(entrants(place), _samples(place, samples, seed, dtype), place, dtype)


def entrants(place: Setting) -> tuple[Entrant, ...]:
    """Exact, fit and floor: `x + 1`, or the sum of all that varies and 1: read every sample, write one, add."""
    floor = Program(sp.Add(*place.varying, 1))
    return tuple(map(_entrant, NAMES, (Program(place.exact), place.program, floor), [place] * len(NAMES)))


def _entrant(name: str, program: Program, place: Setting) -> Entrant:
    hoisted = hoist(program, place.varying)
    return Entrant(name, program, hoisted, place.varying, hoisted.values(place.values))


def _samples(place: Setting, samples: int, seed: int, dtype: str) -> tuple[Any, ...]:
    import numpy as np

    sampling = protocol_at(place, "hemisphere" if place.whole else "uniform", dtype)
    points = drawn(sampling, seed, np.arange(samples, dtype=np.uint64), bounds(place, dtype), dtype)
    return tuple(map(np.asarray, points))
