"""The regime of NumPy arrays: every operation reads whole arrays and writes one, as scientific scripts do."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ratfit._speed.contest import Contest, Entrant, Runs


def prepare(contest: Contest) -> Runs:
    """Three lowered functions, each operation of which makes an array of its own."""
    return Runs(tuple(_call(entrant, contest) for entrant in contest.entrants), "")


def _call(entrant: Entrant, contest: Contest) -> Callable[[], Any]:
    function = entrant.hoisted.on_arrays(entrant.constants, contest.dtype)
    return lambda: function(*contest.samples)
