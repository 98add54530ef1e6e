"""`ratfit bench`: rows measured one by one, written as soon as they are done, shown as tables."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import ratfit
from ratfit._bench import Job, Measuring, asked, is_timed, measure
from ratfit._error import Watch
from ratfit._error.machines import as_first_says, is_first
from ratfit._record import (
    PROTOCOL,
    Row,
    append_row,
    check_resumable,
    drop_checkpoint,
    no_checkpoint,
    read_checkpoint,
    read_rows,
    same_measurement,
    write_checkpoint,
)
from ratfit.report.progress import Meter, progress
from ratfit.report.text import aligned

COLUMNS = ("peak_mean", "peak_rms", "peak_max", "relative_mean", "relative_max", "ulp_max")
"""The definitions of eps that a table shows; the record holds all of them."""


@dataclass(frozen=True)
class Run:
    """Rows to measure and where they go: to the file `out`, appended one by one; with `resume` it is gone on from."""

    jobs: Sequence[Job]
    how: Measuring
    backends: Sequence[str]
    about: Callable[[Job], Mapping[str, Any]] = field(default=lambda job: {})
    out: str | None = None
    resume: bool = False


def rows(run: Run) -> Iterator[Row]:
    """Measures what is not measured yet, and gives all rows in order, as they are known.

    Of several processes each measures the errors with the others; the first alone times, writes and reads files.
    """
    written = _written(run)
    for number, job in enumerate(run.jobs, 1):
        all_asked = [asked(job, run.how, backend) for backend in _backends(run, job)]
        known = [next((row for row in written if same_measurement(row, **each)), None) for each in all_asked]
        missing = [each["backend"] for each, row in zip(all_asked, known, strict=True) if row is None]
        if int(as_first_says([len(missing)])[0]):
            fresh = _measured(run, job, missing, f"{number}/{len(run.jobs)} {job.name} {dict(job.parameters)}")
            known = [row or next(fresh) for row in known]
        yield from (row for row in known if row is not None)
    progress("")


def _backends(run: Run, job: Job) -> Sequence[str]:
    """The backends that a job is timed on; of one whose errors alone are measured, one without a name."""
    return (run.backends if is_timed(job) else ()) or ("",)


def _written(run: Run) -> list[Row]:
    """The rows to go on from; a file of something else is refused before the work, not after."""
    held = read_rows(run.out) if run.out and is_first() else []
    if run.out and is_first() and (remark := no_checkpoint(run.out)):
        print(f"ratfit: {remark}", file=sys.stderr)
    if not run.resume:
        return []
    every = [asked(job, run.how, backend) for job in run.jobs for backend in _backends(run, job)]
    check_resumable(held, every, run.out or "")
    return held


def _measured(run: Run, job: Job, backends: Sequence[str], title: str) -> Iterator[Row]:
    """The rows of a job that were not there, one for each backend, each written before the next is begun."""
    meter = Meter(title)
    key = asked(job, run.how, "") | {"protocol": PROTOCOL, "ratfit": ratfit.__version__}
    watch = _watch(run, key, meter) if run.out and is_first() else Watch(meter.at)
    timed = [backend for backend in backends if backend] if is_first() else ()
    for record in measure(job, run.how, timed, about=run.about(job), watch=watch, say=meter.say):
        if run.out and is_first():
            append_row(run.out, record)
            drop_checkpoint(run.out)  # the errors are in the row; what is left of a job is only timed
        yield record.to_line()


def _watch(run: Run, key: Mapping[str, Any], meter: Meter) -> Watch:
    out = run.out
    assert out is not None
    state = read_checkpoint(out, key) if run.resume else None
    return Watch(meter.at, state, lambda made: write_checkpoint(out, key, made))


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
