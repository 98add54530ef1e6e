"""The verb: derives, measures, says section by section what is found, and writes page and record."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ratfit._derive import derive
from ratfit._error.devices import use_all_cores
from ratfit._record import Row, drop_checkpoint, read_rows, write_text
from ratfit._sampling import check_protocol
from ratfit._speed import available
from ratfit.gallery import card
from ratfit.report.document import Block, Document, Paragraph, Section
from ratfit.report.paper.closest import closest
from ratfit.report.paper.closest_part import closest_part, searched
from ratfit.report.paper.common_part import common_part, common_sentence
from ratfit.report.paper.errors_part import equation, footnote_part
from ratfit.report.paper.footnote import EPSILON, PLACE
from ratfit.report.paper.gamma_part import gammas_part
from ratfit.report.paper.materials_part import materials_part
from ratfit.report.paper.measurements import (
    CHECK,
    DTYPE,
    EQUATIONS,
    PLAIN,
    Derived,
    Task,
    error_tasks,
    footnote_tasks,
    speed_task,
)
from ratfit.report.paper.page import command, document_of, overview
from ratfit.report.paper.results import Results, to_json_object
from ratfit.report.paper.smith_part import smith_part
from ratfit.report.paper.text import section_text
from ratfit.report.progress import progress
from ratfit.report.rows import Book, Measurement, Planned, plan, rows
from ratfit.report.text import published_object, recorded
from ratfit.report.write import folder_for, write_document


@dataclass(frozen=True)
class Asked:
    """What the command line asks for."""

    samples: int
    seed: int
    out: Path
    format: str
    resume: bool = False
    backends: tuple[str, ...] | None = None  # None: all that this machine has


def run_paper(asked: Asked) -> int:
    """Derives, measures, prints, and writes page and record into the folder `out`.

    Writes paper.html, paper.md with its figures, paper.json, and rows.jsonl, to which every row is appended as soon as
    it is measured. Exit status 1 when a derivation does not give the printed formula. **Fails** with `RatfitError` for
    samples and a seed that nothing can be measured with, for a folder that cannot be made, and for rows that cannot be
    gone on from.
    """
    for protocol in (PLAIN, CHECK):  # now, not after minutes
        check_protocol(protocol, asked.samples, asked.seed, DTYPE)
    parts: dict[str, Section] = {}
    with folder_for(asked.out):
        results = _said(asked, parts)
        found = to_json_object(results, asked.samples, asked.seed)
        record = json.dumps(found, indent=2, ensure_ascii=False, allow_nan=False)
        write_text(asked.out / "paper.json", record + "\n")
        written = write_document(_document(results, parts, asked), asked.out, "paper")
    print(record if asked.format == "json" else f"\nwrote {written[0]}, paper.md, paper.json and rows.jsonl")
    return 0 if results.is_as_printed else 1


def _said(asked: Asked, parts: dict[str, Section]) -> Results:
    """All that is measured; each part is kept in `parts` and said as soon as it is known."""

    def say(key: str, part: Section) -> None:
        parts[key] = part
        if asked.format == "text":
            print("\n" + section_text(part), flush=True)

    if asked.format == "text":
        print(lead(asked.samples, asked.seed), flush=True)
    use_all_cores()
    results = Results(_derived())
    errors, times = _tasks(results.derived, asked)
    path = asked.out / "rows.jsonl"
    book = Book(path, asked.resume)
    if not asked.resume:
        _begin_anew(path)
    measurements = _measurements([*errors, *times], _about(results.derived, asked))
    planned = list(zip([*errors, *times], plan(measurements, book), strict=True))
    for place in (*(each.card.place for each in results.derived), PLACE):
        own = [(task, each) for task, each in planned[: len(errors)] if task.place == place]
        results = replace(results, measured=(*results.measured, *_rows(own, book)))
        say(place, _place_part(results, place))
    say("closest", closest_part(results.findings, results.epsilons))
    say("common", common_part(*results.ways, results.epsilons))
    results = replace(results, measured=(*results.measured, *_rows(planned[len(errors) :], book)))
    say("gamma", gammas_part(results.timed, results.gammas))
    say("smith", smith_part(results.of(card("eq19").place)))
    say("materials", materials_part())
    return results


def _begin_anew(path: Path) -> None:
    """Takes the rows of an earlier run away, and its state; a file of something else is refused and stays."""
    read_rows(path)
    path.unlink(missing_ok=True)
    drop_checkpoint(path)


def _measurements(tasks: Sequence[Task], about: Callable[[Task], Mapping[str, Any]]) -> list[Measurement]:
    titles = [f"{task.place}, {number}/{len(tasks)}: {task.words}" for number, task in enumerate(tasks, 1)]
    return [
        Measurement(task.job, task.how, task.backends, title, about(task))
        for task, title in zip(tasks, titles, strict=True)
    ]


def _rows(planned: Sequence[tuple[Task, Planned]], book: Book) -> Iterator[tuple[Task, Row]]:
    return ((task, row) for task, each in planned for row in rows(each, book))


def lead(samples: int, seed: int) -> str:
    """What the whole is, for the top of page and terminal."""
    return (
        "The approximations of Schlick 1994, derived from their kernel conditions and measured on\n"
        f"{samples:,} samples (seed {seed}) in {DTYPE}. eps is a fraction; it depends on its definition, on how the\n"
        "samples are drawn and on the parameters. gamma is exact time / fit time. The paper defines neither figure."
    )


def _derived() -> tuple[Derived, ...]:
    found = []
    for name in EQUATIONS:
        progress(f"{card(name).place}: deriving")
        found.append(Derived(card(name), derive(card(name).problem)))
    progress("")
    return tuple(found)


def _tasks(derived: Sequence[Derived], asked: Asked) -> tuple[list[Task], list[Task]]:
    """The measurements of errors and those of times."""
    backends = available() if asked.backends is None else asked.backends
    errors = [task for each in derived for task in error_tasks(each, asked.samples, asked.seed)]
    times = [task for each in derived for task in speed_task(each, backends, asked.samples, asked.seed)]
    return [*errors, *footnote_tasks(asked.samples, asked.seed)], times


def _about(derived: Sequence[Derived], asked: Asked) -> Callable[[Task], Mapping[str, Any]]:
    """What makes the rows of an equation stand for themselves."""
    command = f"ratfit paper --samples {asked.samples} --seed {asked.seed}"
    known = {
        each.card.place: {"fit": recorded(each.fit), "published": published_object(each.fit, each.card)}
        for each in derived
    }
    return lambda task: {"command": command, **known.get(task.place, {})}


def _place_part(results: Results, place: str) -> Section:
    for each in results.derived:
        if each.card.place == place:
            return equation(each, results.of(place))
    sine = closest(searched(results.of("Eq. 12")), results.epsilons["Eq. 12"])
    names = dict.fromkeys(match.definition for match in sine.rounding) if sine else ()
    return footnote_part(results.of(place), EPSILON, tuple(names))


def _document(results: Results, parts: Mapping[str, Section], asked: Asked) -> Document:
    by_place: dict[str, list[Row]] = {}
    for task, row in results.measured:
        by_place.setdefault(task.place, []).append(row)
    timed = [row | {"place": task.place} for task, row in results.timed]
    printed = {place: (figure, results.gammas.get(place)) for place, figure in results.epsilons.items()}
    titles = {place: parts[place].title for place in printed}
    top: tuple[Block, ...] = (
        Paragraph(" ".join(lead(asked.samples, asked.seed).split())),
        overview(results.findings, timed, titles, printed),
        *(Paragraph(common_sentence(ways, results.epsilons)) for ways in results.ways if ways),
        command(asked.samples, asked.seed),
    )
    return document_of(parts, results.derived, by_place, top)
