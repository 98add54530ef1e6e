"""How to read a gamma: what limits it, and what disturbed it."""

from __future__ import annotations

import os
import statistics
import sys
from collections.abc import Sequence

from ratfit._record.machine import cores

AT_FLOOR = 1.1  # a time within 10 % of the floor's is that of the memory, however little is computed
NOISY = 1.25  # an interval wider than that from end to end says little
DRIFT = 1.25  # the machine ran that much slower in one half of the rounds than in the other
FEW = 100_000  # below that many samples the work of a call is not small beside that of the samples


def load() -> float:
    """How many processes wanted to run in the last minute, on the average; 0 where the system does not say."""
    return os.getloadavg()[0] if sys.platform != "win32" else 0.0


def floor_note(exact_s: float, fit_s: float, floor_s: float) -> str:
    """What the copy floor says about the ratio of two times."""
    exact, fit = (seconds <= AT_FLOOR * floor_s for seconds in (exact_s, fit_s))
    if exact and fit:
        return "exact function and fit at the copy floor: gamma says nothing about their arithmetic"
    if fit:
        return "fit at the copy floor: gamma is a lower bound"
    return "exact function at the copy floor: gamma is an upper bound" if exact else ""


def noise_note(low: float, high: float, times: Sequence[Sequence[float]], waiting: float) -> str:
    """What disturbed a measurement: its interval, its two halves, the load before it began."""
    if high > NOISY * low:
        return "noisy: the interval of gamma is wide, time it again on a quiet machine"
    if max(map(_drift, times)) > DRIFT:
        return "noisy: the machine changed its pace midway, time it again"
    if waiting > cores() + 0.5:  # a measurement before this one may have kept every core busy
        return f"noisy: the load average was {waiting:.1f} on {cores()} cores, time it again on a quiet machine"
    return ""


def size_note(samples: int) -> str:
    """What the number of samples says."""
    return f"fewer than {FEW} samples: what a call costs is part of the times" if samples < FEW else ""


def _drift(times: Sequence[float]) -> float:
    """By how much the slower half of the rounds is slower than the other; too few rounds show nothing."""
    half = len(times) // 2
    if half < 6:
        return 1.0
    first, second = statistics.median(times[:half]), statistics.median(times[half:])
    return max(first, second) / min(first, second)
