"""Whether a gamma of now differs from one of then beyond noise."""

from __future__ import annotations

from ratfit._record.pairs import remarks, where
from ratfit._record.row import Row

GAMMA = 0.05
"""A smaller change of gamma is none, however narrow its intervals: the placement of code alone moves as much."""


def gamma_verdict(old: Row, new: Row) -> tuple[str, str]:
    """The verdict on two gammas that were both measured, and by which rule."""
    unlike = _unlike(old, new)
    if unlike:
        return "incomparable", unlike
    if new["gamma_high"] >= old["gamma_low"] and old["gamma_high"] >= new["gamma_low"]:
        return "same", "the intervals overlap"
    change, floor = _change(old["gamma"], new["gamma"]), _change(old["floor_s"], new["floor_s"])
    if change <= GAMMA:
        return "same", f"the change is within {GAMMA:.0%}"
    if change <= floor:
        return "incomparable", "the copy floor changed by more than gamma: time it again on a quiet machine"
    return ("worse" if new["gamma"] < old["gamma"] else "better"), "; ".join([_times(old, new), *remarks(old, new)])


def _change(old: float | None, new: float | None) -> float:
    """By how much the greater of two numbers exceeds the other, as a share; 0 where one is not known or nothing."""
    return max(new / old, old / new) - 1 if old and new else 0.0


def _unlike(old: Row, new: Row) -> str:
    """Why two gammas cannot be compared; empty where they can."""
    if where(old) != where(new):
        return f"timed on different processors: {_processor(old)}, now {_processor(new)}"
    cores = old["machine"].get("cores"), new["machine"].get("cores")
    if cores[0] != cores[1]:
        return f"timed on {cores[0]} cores, now on {cores[1]}"
    if old["samples"] != new["samples"]:
        return f"timed on {old['samples']} samples, now on {new['samples']}"
    ends = [row[end] for row in (old, new) for end in ("gamma_low", "gamma_high")]
    return "a gamma has no interval" if None in ends else ""


def _processor(row: Row) -> str:
    return ", ".join(str(part) for part in where(row) if part)


def _times(old: Row, new: Row) -> str:
    """Which of the two times moved: a gamma falls too where the exact function has become faster."""
    moved = [
        f"{word} {old[key]:.3g} s -> {new[key]:.3g} s"
        for word, key in (("exact", "exact_s"), ("fit", "fit_s"))
        if old[key] is not None and new[key] is not None
    ]
    return ", ".join(moved)
