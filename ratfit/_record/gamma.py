"""Whether a gamma of now differs from one of then beyond noise."""

from __future__ import annotations

from ratfit._record.noise import PRECISION
from ratfit._record.pairs import remarks, where
from ratfit._record.row import Row

GAMMA = 0.05
"""A smaller change of gamma is none, however narrow its intervals: the placement of code alone moves as much."""


def gamma_verdict(old: Row, new: Row) -> tuple[str, str]:
    """The verdict on two gammas, at least one of which is there, and by which rule."""
    if old["gamma"] is None or new["gamma"] is None:
        return _one_sided(old, new)
    if old["exact_s"] is None and new["exact_s"] is None:
        return _counted(old, new)
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
    return _direction(old, new), "; ".join([_times(old, new), *remarks(old, new)])


def _direction(old: Row, new: Row) -> str:
    return "worse" if new["gamma"] < old["gamma"] else "better"


def _one_sided(old: Row, new: Row) -> tuple[str, str]:
    """What was timed and has no gamma was found to compute something else; what was not timed says nothing."""
    empty = new if new["gamma"] is None else old
    if empty["exact_s"] is None:
        return ("gone", "only the old row has it") if empty is new else ("added", "only the new row has it")
    verdict = "worse" if empty is new else "better"
    return verdict, f"timed, but without a gamma: {empty['note'] or 'no reason is given'}"


def _counted(old: Row, new: Row) -> tuple[str, str]:
    """Operations that were counted, not timed, are the same wherever they are counted."""
    if _change(old["gamma"], new["gamma"]) <= PRECISION:
        return "same", ""
    return _direction(old, new), "; ".join(["counted, not timed", *remarks(old, new)])


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
