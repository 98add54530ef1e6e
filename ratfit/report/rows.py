"""Rows measured one by one: each on the disk as soon as it is known, and gone on from after an interruption."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import ratfit
from ratfit._bench import Job, Measuring, asked, measure
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


@dataclass(frozen=True)
class Measurement:
    """What to measure, and how: the errors once, and the speed on each backend, a row for each; without backends one.

    `title` says which it is while it goes on; `about` has further fields of its rows.
    """

    job: Job
    how: Measuring
    backends: Sequence[str]
    title: str
    about: Mapping[str, Any]


@dataclass(frozen=True)
class Book:
    """Where rows go: to the file `out`, appended one by one, nowhere where that is None; `resume` goes on from it."""

    out: str | os.PathLike[str] | None = None
    resume: bool = False


@dataclass(frozen=True)
class Planned:
    """A measurement, and the rows of it that are there already: one for each backend, None where it must be made."""

    measurement: Measurement
    known: tuple[Row | None, ...]

    @property
    def missing(self) -> list[str]:
        """The backends without a row; the empty name stands for the errors alone."""
        backends = self.measurement.backends or ("",)
        return [backend for backend, row in zip(backends, self.known, strict=True) if row is None]


def plan(measurements: Sequence[Measurement], book: Book) -> list[Planned]:
    """What is to be measured, and what a file of rows has of it.

    **Fails** with `RatfitError` for a file of something else, before the work and not after, and for rows that cannot
    be gone on from. Tells on standard error of a file that is in the place of a state and holds none.
    """
    held = read_rows(book.out) if book.out and is_first() else []
    if book.out and is_first() and (remark := no_checkpoint(book.out)):
        print(f"ratfit: {remark}", file=sys.stderr)
    if not book.resume:
        return [Planned(each, (None,) * len(each.backends or ("",))) for each in measurements]
    keys = [_keys(each) for each in measurements]
    check_resumable(held, [key for each in keys for key in each], book.out or "")
    known = [tuple(next((row for row in held if same_measurement(row, **key)), None) for key in each) for each in keys]
    return [Planned(each, rows) for each, rows in zip(measurements, known, strict=True)]


def _keys(measurement: Measurement) -> list[dict[str, Any]]:
    """What each row of a measurement is the result of."""
    first = asked(measurement.job, measurement.how, "")
    return [first | {"backend": backend} for backend in measurement.backends or ("",)]


def rows(planned: Planned, book: Book) -> Iterator[Row]:
    """The rows of one measurement in order, each as it is known, and written if it was not there.

    Of several processes each measures the errors with the others; the first alone times, writes and reads files.
    """
    known: Sequence[Row | None] = planned.known
    if int(as_first_says([len(planned.missing)])[0]):
        fresh = _measured(planned, book)
        known = [row or next(fresh, None) for row in known]  # of the times the other processes have none
    yield from (row for row in known if row is not None)
    progress("")


def _measured(planned: Planned, book: Book) -> Iterator[Row]:
    """The rows that were not there, one for each backend, each written before the next is begun."""
    this, meter = planned.measurement, Meter(planned.measurement.title)
    timed = [backend for backend in planned.missing if backend] if is_first() else ()
    watch = _watch(this, book, meter)
    for record in measure(this.job, this.how, timed, about=this.about, watch=watch, say=meter.say):
        if book.out and is_first():
            append_row(book.out, record)
            drop_checkpoint(book.out)  # the errors are in the row; what is left of a measurement is only timed
        yield record.to_line()


def _watch(measurement: Measurement, book: Book, meter: Meter) -> Watch:
    out = book.out
    if out is None or not is_first():
        return Watch(meter.at)
    key = asked(measurement.job, measurement.how, "") | {"protocol": PROTOCOL, "ratfit": ratfit.__version__}
    state = read_checkpoint(out, key) if book.resume else None
    return Watch(meter.at, state, lambda made: write_checkpoint(out, key, made))
