"""The run as a document: what the terminal was told, with everything that was measured folded beneath it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ratfit._record import Row, machine
from ratfit.report.document import (
    Block,
    Cell,
    Column,
    Details,
    Document,
    Facts,
    Link,
    Section,
    Table,
    Verbatim,
)
from ratfit.report.meaning import meaning
from ratfit.report.measured import gamma_range, number
from ratfit.report.paper.closest import Finding, closest
from ratfit.report.paper.closest_part import searched
from ratfit.report.paper.measurements import PLAIN, Derived
from ratfit.report.problem_rows import ProblemRows
from ratfit.report.problem_section import problem_section
from ratfit.report.tables import definitions_table, rows_table

TITLE = "The approximations of Schlick 1994, derived and measured"


def document_of(
    parts: Mapping[str, Section], derived: Sequence[Derived], rows: Mapping[str, Sequence[Row]], lead: Sequence[Block]
) -> Document:
    """The page.

    **Arguments:** the `parts` that the terminal shows, those of an equation by its place; the fits; the `rows` of each
    place; what stands on top, `lead`.
    """
    by_place = {each.card.place: number for number, each in enumerate(derived, 1)}
    sections = [
        Section(part.title, (*part.blocks, *_folded(by_place.get(place, 0), rows.get(place, ()))))
        for place, part in parts.items()
    ]
    return Document(TITLE, tuple(lead), tuple(sections), (meaning(), _making()))


def _folded(number: int, rows: Sequence[Row]) -> Iterator[Block]:
    """All that was measured of an equation; of one that was derived, in the order of a report."""
    if not rows:
        return
    if number:
        whole = problem_section(ProblemRows(number, "", tuple(map(_without_repeated_curve, rows))))
        yield Details("Derivation, errors over the domain, every row and definition", whole.blocks)
        return
    yield Details(f"All {len(rows)} rows", (rows_table(rows),))
    definitions = definitions_table(rows)
    if definitions is not None:
        yield definitions


def _without_repeated_curve(row: Row) -> Row:
    """The curve is drawn over an even grid, whatever the samples are: one of each setting says it all."""
    is_random = any(isinstance(value, list) for value in row["parameters"].values())
    return row | {"curve": None} if row["sampling"] != PLAIN or is_random else row


def overview(findings: Sequence[Finding], timed: Sequence[Row], titles: Mapping[str, str], printed: Any) -> Table:
    """A row an equation: the printed figures beside the nearest eps and the range of gamma.

    **Arguments:** `timed`, rows that have a place in `"place"`; `titles` of the sections by place; `printed`, for each
    place the pair of its eps and its gamma or None.
    """
    head = (
        Column("equation"), Column("printed eps", True), Column("closest measured", True), Column("by"),
        Column("printed gamma", True), Column("measured gamma", True),
    )  # fmt: skip
    rows = []
    for place, (epsilon, gamma) in printed.items():
        found = closest([f for f in searched(findings) if f.place == place], epsilon)
        own = [row for row in timed if row["place"] == place]
        by = f"{found.match.definition}, {found.match.finding.protocol}" if found else "–"
        value = found.match.value if found else None
        rows.append(
            (
                Cell(Link(place, titles[place])),
                Cell(number(epsilon), epsilon),
                Cell(number(value, 4), value),
                Cell(by),
                Cell(number(gamma), gamma),
                Cell(gamma_range(own), min((row["gamma"] for row in own if row["gamma"]), default=None)),
            )
        )
    return Table(head, tuple(rows))


def _making() -> Section:
    about = machine()
    versions = ", ".join(f"{name} {part}" for name, part in about["versions"].items() if part)
    facts = (
        ("processor", f"{about['processor']}, {about['cores']} cores"),
        ("devices", ", ".join(about["devices"]) or "–"),
        ("versions", versions),
    )
    return Section("How they were measured", (Facts(facts),))


def command(samples: int, seed: int) -> Verbatim:
    """What makes this page again."""
    return Verbatim(f"ratfit paper --samples {samples} --seed {seed}")
