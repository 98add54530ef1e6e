"""`ratfit bench`: measured rows as tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ratfit._record import Row
from ratfit.report.text import aligned

COLUMNS = ("peak_mean", "peak_rms", "peak_max", "relative_mean", "relative_max", "ulp_max")
"""The definitions of eps that a table shows; the record holds all of them."""


def tables(found: Sequence[Row]) -> str:
    """The rows as aligned text: eps as fractions, then gamma with its intervals, then what to know of them."""
    notes = _Notes()
    blocks = [
        aligned(_errors(found, notes)),
        aligned(_speeds(found, notes)) if any(row["backend"] for row in found) else [],
        notes.lines(),
    ]
    return "\n\n".join("\n".join(block) for block in blocks if block)


def _errors(found: Sequence[Row], notes: _Notes) -> list[tuple[str, ...]]:
    head = ("problem", "parameters", "samples", "sampling", "dtype", *COLUMNS, "worst relative at", "left out")
    return [head, *(_error_cells(row, notes) for row in _firsts(found))]


def _error_cells(row: Row, notes: _Notes) -> tuple[str, ...]:
    eps = (short(row["epsilon"][d]) for d in COLUMNS)
    at, samples = short(row["worst"]["at"]), f"{row['samples']:g}"
    name = row["name"] + notes.marks(row["note"], of_speed=False)
    return (name, parameters(row), samples, row["sampling"], row["dtype"], *eps, at, str(row["nonfinite"]))


def _firsts(found: Sequence[Row]) -> list[Row]:
    """One row of each measurement of errors: those of other backends repeat it."""
    firsts: dict[Any, Row] = {}
    for row in found:
        firsts.setdefault((row["name"], str(row["parameters"]), row["dtype"], row["sampling"], row["samples"]), row)
    return list(firsts.values())


def _speeds(found: Sequence[Row], notes: _Notes) -> list[tuple[str, ...]]:
    backends = list(dict.fromkeys(row["backend"] for row in found if row["backend"]))
    cells: dict[tuple[str, str, str], dict[str, str]] = {}
    for row in (row for row in found if row["backend"]):
        place = (row["name"], parameters(row), row["dtype"])
        marks = "" if row["gamma_low"] is None and row["gamma"] else notes.marks(row["note"], of_speed=True)
        cells.setdefault(place, {})[row["backend"]] = gamma(row) + marks
    head = ("gamma", "parameters", "dtype", *backends)
    return [head, *((*place, *(of.get(backend, "-") for backend in backends)) for place, of in cells.items())]


class _Notes:
    """The remarks on rows, each said once and referred to by a letter."""

    def __init__(self) -> None:
        self.letters: dict[str, str] = {}

    def marks(self, note: str, of_speed: bool) -> str:
        """The letters of the remarks of a row that belong to its speed, or of those that do not."""
        parts = [_general(part) for part in note.split("; ") if part and is_of_speed(part) == of_speed]
        marks = [self.letters.setdefault(part, letter(len(self.letters))) for part in parts]
        return f" ({','.join(marks)})" if marks else ""

    def lines(self) -> list[str]:
        return [f"({mark}) {text}" for text, mark in self.letters.items()]


def _general(remark: str) -> str:
    """A remark without the figures of one row, where many rows have the like."""
    return "noisy: time it again on a quiet machine" if remark.startswith("noisy: ") else remark


def letter(number: int) -> str:
    """a to z, then aa, ab ...: the names of remarks."""
    more, place = divmod(number, 26)
    return (letter(more - 1) if more else "") + "abcdefghijklmnopqrstuvwxyz"[place]


def is_of_speed(remark: str) -> bool:
    """Whether a remark of a row's note is on its times, not on its errors."""
    words = ("gamma", "noisy", "timed", "copy floor", "additions", "nan or infinite", "fewer than", "fast-math")
    return any(word in remark for word in words)


def parameters(row: Row) -> str:
    """The values of a row's parameters, as in "m=0.25"; of one that is drawn at random, its range."""
    return " ".join(f"{name}={_parameter(value)}" for name, value in row["parameters"].items())


def _parameter(value: Any) -> str:
    return f"{short(value[0])}..{short(value[1])}" if isinstance(value, list) else short(value)


def gamma(row: Row) -> str:
    """gamma with its interval, as in "12.3 [11.9, 12.8]"."""
    if row["gamma"] is None:
        return "-"
    if row["gamma_low"] is None:
        return short(row["gamma"])
    return f"{short(row['gamma'])} [{short(row['gamma_low'])}, {short(row['gamma_high'])}]"


def short(value: float | None) -> str:
    """A number to three digits; a dash for none."""
    return "-" if value is None else f"{value:.3g}"
