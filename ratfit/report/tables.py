"""Tables of measured rows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ratfit._error import DEFINITIONS
from ratfit._record import Row
from ratfit.report.bench import COLUMNS
from ratfit.report.document import Cell, Code, Column, Details, Table, Text
from ratfit.report.measured import (
    NONE,
    about_peer,
    count,
    counted,
    error_remarks,
    gamma,
    name_of,
    nonfinite,
    number,
    over_floor,
    parameter,
    parameters,
    speed_remarks,
    worst,
)


@dataclass(frozen=True)
class _Shown:
    """A column of a table of rows: what it says of each, and whether it is left out where all say the same."""

    label: str
    cell: Callable[[Row], Cell]
    numeric: bool = True


def _words(label: str, text: Callable[[Row], str]) -> _Shown:
    return _Shown(label, lambda row: Cell(text(row) or NONE), numeric=False)


def _epsilon(definition: str) -> _Shown:
    def cell(row: Row) -> Cell:
        value = row["epsilon"].get(definition)
        return Cell(number(value), value)

    return _Shown(definition, cell)


def _gamma(row: Row) -> Cell:
    return Cell(gamma(row), row["gamma"], speed_remarks(row), counted(row))


def _nonfinite(row: Row) -> Cell:
    return Cell(nonfinite(row), row["nonfinite"], error_remarks(row))


def _worst(row: Row) -> Cell:
    at = (row["worst"] or {}).get("at")
    return Cell(worst(row), at if isinstance(at, (int, float)) else None)


def _milliseconds(key: str, label: str) -> _Shown:
    """The time of one call, whose samples need not be those that the errors were measured at."""

    def cell(row: Row) -> Cell:
        time = None if row[key] is None else 1e3 * row[key]
        return Cell(number(time), time)

    return _Shown(label, cell)


def _parameter(name: str) -> _Shown:
    def cell(row: Row) -> Cell:
        value = row["parameters"].get(name)
        least = value[0] if isinstance(value, (list, tuple)) else value
        return Cell(parameter(value), least)

    return _Shown(name, cell)


_WHOSE = (
    _Shown("method", lambda row: Cell(name_of(row).method, aside=about_peer(row)), numeric=False),
    _words("against", lambda row: name_of(row).against),
)
_CIRCUMSTANCES = (
    _words("backend", lambda row: row["backend"]),
    _words("regime", lambda row: row["regime"]),
    _words("flags", lambda row: row["flags"]),
    _words("dtype", lambda row: row["dtype"]),
    _words("sampling", lambda row: row["sampling"]),
    _Shown("samples", lambda row: Cell(count(row["samples"]), row["samples"])),
    _words("seed", lambda row: str(row["seed"])),
)
_SPEED = (
    _Shown("gamma", _gamma),
    _milliseconds("exact_s", "exact, ms"),
    _milliseconds("fit_s", "time, ms"),
    _Shown("time/floor", lambda row: Cell(number(over_floor(row)), over_floor(row))),
)
_ENDING = (_Shown("nonfinite", _nonfinite), _Shown("worst at", _worst))


def rows_table(rows: Sequence[Row], definitions: Sequence[str] = COLUMNS) -> Table:
    """The rows with eps, gamma and what qualifies them; a circumstance that all share is said once, in the caption.

    A column of nothing but dashes is left out, so that a phone need not show it.
    """
    names = dict.fromkeys(name for row in rows for name in row["parameters"])
    circumstances = (*_WHOSE, *map(_parameter, names), *_CIRCUMSTANCES)
    shared = [c for c in circumstances if len({c.cell(row) for row in rows}) == 1]
    apart = [c for c in circumstances if c not in shared]
    numbers = (_SPEED[0], *map(_epsilon, definitions), *_ENDING, *_SPEED[1:])
    said = [c for c in numbers if any(c.cell(row).key is not None or c.cell(row).remarks for row in rows)]
    columns = [*apart, *said]
    return Table(
        tuple(Column(c.label, c.numeric) for c in columns),
        tuple(tuple(c.cell(row) for c in columns) for row in rows),
        _shared_text([(c.label, str(c.cell(rows[0]).text)) for c in shared]),
    )


def _shared_text(said: Sequence[tuple[str, str]]) -> Text:
    text = ", ".join(f"{label} {value}" for label, value in said if value != NONE and label != "regime")
    return f"All rows: {text}." if text else ""


def definitions_table(rows: Sequence[Row]) -> Details | None:
    """Every definition of eps, a line each, for the rows that differ in more than their speed; None without any."""
    found: dict[tuple[str, ...], Row] = {}
    for row in rows:
        if any(value is not None for value in row["epsilon"].values()):
            label = (name_of(row).method, name_of(row).against, parameters(row), row["dtype"], row["sampling"])
            found.setdefault(label, row)
    if not found:
        return None
    varying = [k for k in range(5) if len({label[k] for label in found}) > 1]
    heads = [" · ".join(label[k] for k in varying if label[k]) or "eps" for label in found]
    names = list(dict.fromkeys(name for row in found.values() for name in row["epsilon"]))
    lines = []
    for name in names:
        values = [row["epsilon"].get(name) for row in found.values()]
        lines.append((Cell(Code(name)), *(Cell(number(v), v) for v in values), Cell(Code(DEFINITIONS.get(name, "")))))
    head = (Column("definition"), *(Column(h, numeric=True) for h in heads), Column("formula"))
    return Details("Every definition of eps", (Table(head, tuple(lines)),))
