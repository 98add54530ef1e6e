"""The rows of the measurements: each on the disk as soon as it is known, and gone on from after an interruption."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ratfit._bench import asked, measure
from ratfit._error import Watch
from ratfit._record import Row, append_row, check_resumable, read_rows, same_measurement
from ratfit.report.paper.closest import Finding
from ratfit.report.paper.measurements import Task
from ratfit.report.progress import Meter, progress

About = Callable[[Task], Mapping[str, Any]]


def begin(path: Path, tasks: Sequence[Task], resume: bool) -> list[Row]:
    """The rows to go on from; a file of something else is refused, and one that is not gone on from is begun anew."""
    held = read_rows(path)
    if resume:
        check_resumable(held, [key for task in tasks for key in _keys(task)], path)
        return held
    path.unlink(missing_ok=True)
    return []


def rows(tasks: Sequence[Task], held: Sequence[Row], path: Path, about: About) -> Iterator[tuple[Task, Row]]:
    """Each measurement with its row, or with its rows, one for each backend, in order; what is held is not measured."""
    for number, task in enumerate(tasks, 1):
        known = [next((row for row in held if same_measurement(row, **key)), None) for key in _keys(task, held)]
        missing = [backend for backend, row in zip(task.backends or ("",), known, strict=True) if row is None]
        fresh = _measured(task, missing, path, about, f"{task.place}, {number}/{len(tasks)}: {_words(task)}")
        yield from ((task, row or next(fresh)) for row in known)
    progress("")


def _keys(task: Task, held: Sequence[Row] | None = None) -> list[dict[str, Any]]:
    """What each row of a task is the result of; not worked out where there is nothing to compare it with."""
    backends = task.backends or ("",)
    if held is not None and not held:
        return [{"name": ""} for _ in backends]
    first = asked(task.job, task.how, backends[0])
    return [first | {"backend": backend} for backend in backends]


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
