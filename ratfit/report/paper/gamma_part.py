"""gamma in every regime of this machine beside the printed one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ratfit._record import Row
from ratfit.report.document import Cell, Column, Items, Paragraph, Section, Table
from ratfit.report.measured import gamma, number, over_floor, speed_remarks
from ratfit.report.paper.measurements import Task

Timed = tuple[Task, Row]

ABOUT = """\
The exact function's time over the fit's, timed in turn in float32 on a million samples, with its 95 % interval; \
fit/floor is the fit's time over that of copying the samples: near 1 the fit runs as fast as memory lets it. On \
cost-model nothing is timed. The paper's are of scalar code on a machine of 1994; it states none for Eq. 16."""


def gammas_part(found: Sequence[Timed], printed: Mapping[str, float]) -> Section:
    """A row an equation and backend, and where the printed figures lie among them."""
    if not found:
        return Section("gamma", (Paragraph("Nothing was timed."),))
    head = (
        Column("equation"), Column("at"), Column("backend"), Column("gamma", True), Column("printed", True),
        Column("fit/floor", True),
    )  # fmt: skip
    table = Table(head, tuple(_row(task, row, printed) for task, row in found))
    return Section("gamma", (Paragraph(ABOUT), table, Items(tuple(_sentences(found, printed)))))


def _row(task: Task, row: Row, printed: Mapping[str, float]) -> tuple[Cell, ...]:
    figure, share = printed.get(task.place), over_floor(row)
    remarks = tuple(dict.fromkeys(map(_general, speed_remarks(row))))
    return (
        Cell(task.place), Cell(task.setting or "–"), Cell(row["backend"]), Cell(gamma(row), row["gamma"], remarks),
        Cell(number(figure), figure), Cell(number(share), share),
    )  # fmt: skip


def _general(remark: str) -> str:
    """A remark without the figures of one row, where many rows have the like."""
    return "noisy: time it again on a quiet machine" if remark.startswith("noisy: ") else remark


def _sentences(found: Sequence[Timed], printed: Mapping[str, float]) -> Iterator[str]:
    for place, figure in printed.items():
        known = [(row["gamma"], row["backend"]) for task, row in found if task.place == place and row["gamma"]]
        if known:
            (low, slowest), (high, fastest) = min(known), max(known)
            lies = "lies among them" if low <= figure <= high else "lies outside"
            span = f"{number(low)} ({slowest}) to {number(high)} ({fastest})"
            yield f"{place}: {span}; the printed {number(figure)} {lies}."
