"""One measured row: its keys, in their order, and what JSON holds of it."""

from __future__ import annotations

import math
import numbers
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from datetime import UTC, datetime
from typing import Any

from ratfit._record.machine import machine

Row = dict[str, Any]

PROTOCOL = 3
"""The meaning of a row's numbers and samples: changed whenever a number of the same name would mean something else."""


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")


@dataclass(frozen=True)
class Record:
    """The errors and the speed of one fit, at one setting of its parameters, on one backend.

    The fields are the keys of a line, in their order. Those up to `note` are the contract of `bench --format json`:
    `parameters` is name -> value, or the pair (low, high) of one that is drawn at random; `epsilon` is definition ->
    fraction; `worst` is `{definition, at}`; times are in seconds for one call on all samples; None is what was not
    measured or not finite. The further ones make the row stand for itself: `formula` is a tag of what was measured,
    `fit` what `Fit.to_json_object()` gives, with words to its conditions, `command` what makes this row again, `counts`
    how many samples were `nan_fit, inf_fit, nan_exact, inf_exact`, `curve` the error over the domain, `published` the
    source's own formula.
    """

    name: str
    parameters: Mapping[str, float | Sequence[float]]
    samples: int
    seed: int
    sampling: str
    dtype: str
    backend: str
    regime: str
    flags: str
    epsilon: Mapping[str, float | None]
    nonfinite: int | None
    worst: Mapping[str, Any]
    exact_s: float | None
    fit_s: float | None
    floor_s: float | None
    gamma: float | None
    gamma_low: float | None
    gamma_high: float | None
    note: str
    machine: Mapping[str, Any] = field(default_factory=machine)
    protocol: int = PROTOCOL
    formula: str = ""
    fit: Mapping[str, Any] | None = None
    command: str = ""
    finished: str = field(default_factory=_now)
    counts: Mapping[str, int] = field(default_factory=dict)
    curve: Mapping[str, Any] | None = None
    published: Mapping[str, Any] | None = None

    def to_json_object(self) -> Row:
        """The keys of the contract alone; JSON can hold them: plain numbers, None for nan and for the infinite."""
        return contract(self.to_line())

    def to_line(self) -> Row:
        """All keys: the object that a line of a file of rows holds."""
        return {key: plain(getattr(self, key)) for key in (*KEYS, *FURTHER)}


_NAMES = tuple(each.name for each in fields(Record))
_CONTRACT = _NAMES.index("note") + 1

KEYS = _NAMES[:_CONTRACT]
"""The keys of a row that `bench --format json` prints."""

FURTHER = _NAMES[_CONTRACT:]
"""The keys that a line of a file has beyond them."""


def contract(row: Row) -> Row:
    """Of a row as it was read or measured, the keys of the contract."""
    return {key: row[key] for key in KEYS}


def plain(value: Any) -> Any:
    """The value as JSON can hold it: None for nan and for the infinite, lists for tuples."""
    if isinstance(value, Mapping):
        return {str(key): plain(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(part) for part in value]
    if value is None or isinstance(value, (str, bool)):
        return value
    if isinstance(value, numbers.Integral):
        return int(value)
    return float(value) if math.isfinite(value) else None


def is_row(value: Any) -> bool:
    """Whether an object that was read is a row: all its keys, each with a value of its kind."""
    return (
        isinstance(value, dict)
        and value.keys() == set(_NAMES)
        and all(is_kind(value[key]) for is_kind, keys in _KINDS for key in keys)
    )


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


def _is_whole(value: Any) -> bool:
    return isinstance(value, int)


def _is_number(value: Any) -> bool:
    return value is None or isinstance(value, (int, float))


def _is_object(value: Any) -> bool:
    return isinstance(value, dict)


def _is_epsilon(value: Any) -> bool:
    return isinstance(value, dict) and all(map(_is_number, value.values()))


def _is_parameters(value: Any) -> bool:
    return isinstance(value, dict) and all(
        isinstance(part, (int, float)) or (isinstance(part, list) and len(part) == 2 and all(map(_is_number, part)))
        for part in value.values()
    )


def _is_machine(value: Any) -> bool:
    return isinstance(value, dict) and isinstance(value.get("versions"), dict)


def _is_counts(value: Any) -> bool:
    return isinstance(value, dict) and all(map(_is_whole, value.values()))


def _is_object_or_none(value: Any) -> bool:
    return value is None or isinstance(value, dict)


_KINDS: Sequence[tuple[Callable[[Any], bool], Sequence[str]]] = (
    (_is_text, ("name", "sampling", "dtype", "backend", "regime", "flags", "note", "formula", "command", "finished")),
    (_is_whole, ("samples", "seed", "protocol")),
    (_is_number, ("nonfinite", "exact_s", "fit_s", "floor_s", "gamma", "gamma_low", "gamma_high")),
    (_is_parameters, ("parameters",)),
    (_is_epsilon, ("epsilon",)),
    (_is_machine, ("machine",)),
    (_is_counts, ("counts",)),
    (_is_object, ("worst",)),
    (_is_object_or_none, ("fit", "curve", "published")),
)
