"""Which row of now belongs to which of then."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable
from typing import Any

from ratfit._record.row import Row

Key = tuple[Any, ...]

IDENTITY = ("name", "parameters", "samples", "sampling", "dtype", "backend", "seed")
"""The keys in which rows of the same measurement agree."""


def where(row: Row) -> tuple[Any, ...]:
    """The processor of a row: that of the graphics card too where it was at work."""
    machine = row["machine"]
    return machine.get("processor"), machine.get("devices") if "gpu" in row["backend"] else None


def identity(row: Row) -> dict[str, Any]:
    """What a row is a measurement of, and by which means."""
    return {key: row[key] for key in IDENTITY}


def take_pairs(old: Iterable[Row], new: Iterable[Row]) -> tuple[list[tuple[Row, Row]], list[Row], list[Row]]:
    """The pairs, and the rows that are left over of the old and of the new.

    Of a measurement that was made twice on a processor the last row stands. Rows of the same processor are paired
    first, then those of any, then those that differ in samples or seed.
    """
    before, after = _last(old), _last(new)
    pairs = [pair for key in (_here, _anywhere, _of_any_sample) for pair in _taken(before, after, key)]
    return pairs, before, after


def _last(rows: Iterable[Row]) -> list[Row]:
    return list({_here(row): row for row in rows}.values())


def _taken(before: list[Row], after: list[Row], key: Callable[[Row], Key]) -> list[tuple[Row, Row]]:
    """Takes the rows that agree in a key out of both lists; of several, those of most samples come first."""
    waiting = defaultdict(list)
    for row in sorted(before, key=_samples):
        waiting[key(row)].append(row)
    found = sorted(after, key=_samples, reverse=True)
    pairs = [(waiting[key(row)].pop(), row) for row in found if waiting[key(row)]]
    taken = {id(row) for pair in pairs for row in pair}
    for rows in (before, after):
        rows[:] = [row for row in rows if id(row) not in taken]
    return pairs


def _samples(row: Row) -> int:
    return row["samples"]


def _here(row: Row) -> Key:
    """The measurement, on this processor."""
    return *_anywhere(row), repr(where(row))


def _anywhere(row: Row) -> Key:
    """The measurement, whatever it was made on."""
    return *_of_any_sample(row), row["samples"], row["seed"]


def _of_any_sample(row: Row) -> Key:
    keys = [key for key in IDENTITY if key not in ("parameters", "samples", "seed")]
    return *(row[key] for key in keys), *_parameters(row)


def _parameters(row: Row) -> Key:
    given = sorted(row["parameters"].items())
    return tuple((name, tuple(value) if isinstance(value, list) else value) for name, value in given)


def remarks(old: Row, new: Row) -> list[str]:
    """What else differs between two rows of a pair, and may be why a number changed."""
    formula = [] if old["formula"] == new["formula"] else ["of another formula than then"]
    return formula + ([] if old["flags"] == new["flags"] else ["flags differ"])
