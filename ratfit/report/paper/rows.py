"""The rows of the measurements: each on the disk as soon as it is known, and gone on from after an interruption."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ratfit._bench import asked, measure
from ratfit._error import Watch
from ratfit._record import Row, append_row, check_resumable, read_rows, same_measurement
from ratfit.report.paper.closest import Finding
from ratfit.report.paper.measurements import Task
from ratfit.report.progress import Meter, progress

About = Callable[[Task], Mapping[str, Any]]


@dataclass(frozen=True)
class Planned:
    """A measurement, and the rows of it that are there already: one for each backend, None where it must be made."""

    task: Task
    known: tuple[Row | None, ...]


def plan(path: Path, tasks: Sequence[Task], resume: bool) -> list[Planned]:
    """What is to be measured, and what a file of rows has of it.

    Without `resume` the file is begun anew. **Fails** with `RatfitError` for a file of something else, which stays as
    it is, and for rows that cannot be gone on from.
    """
    held = read_rows(path)
    if not resume:
        path.unlink(missing_ok=True)
        return [Planned(task, (None,) * len(task.backends or ("",))) for task in tasks]
    keys = [_keys(task) for task in tasks]
    check_resumable(held, [key for each in keys for key in each], path)
    known = [tuple(next((row for row in held if same_measurement(row, **key)), None) for key in each) for each in keys]
    return [Planned(task, rows) for task, rows in zip(tasks, known, strict=True)]


def _keys(task: Task) -> list[dict[str, Any]]:
    """What each row of a task is the result of."""
    backends = task.backends or ("",)
    first = asked(task.job, task.how, backends[0])
    return [first | {"backend": backend} for backend in backends]


def rows(plans: Sequence[Planned], path: Path, about: About) -> Iterator[tuple[Task, Row]]:
    """Each measurement with its row, or with its rows, one for each backend, in order, each written as it is known."""
    for number, planned in enumerate(plans, 1):
        task = planned.task
        missing = [backend for backend, row in zip(task.backends or ("",), planned.known, strict=True) if row is None]
        fresh = _measured(task, missing, path, about, f"{task.place}, {number}/{len(plans)}: {_words(task)}")
        yield from ((task, row or next(fresh)) for row in planned.known)
    progress("")


def _measured(task: Task, backends: Sequence[str], path: Path, about: About, title: str) -> Iterator[Row]:
    if not backends:
        return
    meter = Meter(title)
    timed = [backend for backend in backends if backend]
    for record in measure(task.job, task.how, timed, about=about(task), watch=Watch(meter.at), say=meter.say):
        append_row(path, record)
        yield record.to_line()


def _words(task: Task) -> str:
    return " ".join(filter(None, (task.protocol, task.against, task.setting)))


def finding(task: Task, row: Row) -> Finding:
    """A measured row as the search for the closest sees it."""
    return Finding(task.place, task.protocol, task.setting, task.is_random, task.against, row["epsilon"])
