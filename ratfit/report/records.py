"""`ratfit report`: the rows of record files as one Markdown page and one HTML page."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ratfit._inline import UNNAMED
from ratfit._parse import RatfitError, shortened
from ratfit._record import Row, merge
from ratfit.report.check import check_row
from ratfit.report.document import Block, Cell, Code, Column, Document, Facts, Link, Paragraph, Section, Table
from ratfit.report.headlines import counts
from ratfit.report.meaning import meaning
from ratfit.report.measured import circumstances, count, epsilon_range, gamma_range, name_of
from ratfit.report.problem_rows import ProblemRows
from ratfit.report.problem_section import problem_section
from ratfit.report.write import folder_for, write_document


def run_report(paths: Sequence[str], out: str) -> int:
    """Reads record files and writes report.html, report.md and its figures into the folder `out`, made if missing.

    Prints what was written, and returns the exit status. **Fails** with `RatfitError` for a file that is missing, is no
    record or holds no row, and for a folder that cannot be made.
    """
    rows = merge(paths)
    if not rows:
        raise RatfitError(f"{', '.join(paths)}: no row is in there; measure some with bench --out FILE")
    with folder_for(out) as folder:
        written = write_report(rows, folder)
    print(f"wrote {written[0]} and {written[1]}")
    return 0


def write_report(rows: Sequence[Row], folder: str | Path, name: str = "report") -> tuple[Path, ...]:
    """Writes the page of these rows as `name.html` and `name.md` with figures; returns the paths, pages first."""
    return write_document(document_of(rows), Path(folder), name)


def document_of(rows: Sequence[Row]) -> Document:
    """The page of these rows: a section a problem, in the order in which the rows first name them.

    The rows are objects as in a line of a record file; equal rows count once. The numbers of one problem with different
    formulas (another choice of a free coefficient, say) are different sections. **Fails** with `RatfitError`
    without rows, and for rows that no ratfit has written.
    """
    if not rows:
        raise RatfitError("no rows: name a file that bench --out has written")
    for row in rows:
        check_row(row)
    problems = tuple(_problems(_once(rows)))
    title = f"{problems[0].title}: accuracy and speed" if len(problems) == 1 else "Fits: accuracy and speed"
    sections = tuple(problem_section(problem) for problem in problems)
    return Document(title, tuple(_lead(problems)), sections, (meaning(_definitions(rows)), _making(rows)))


def _once(rows: Sequence[Row]) -> list[Row]:
    found: list[Row] = []
    for row in rows:
        if row not in found:
            found.append(row)
    return found


def _problems(rows: Sequence[Row]) -> Iterator[ProblemRows]:
    """Rows by problem and formula; a peer's row goes with the formula of the same problem that was seen last."""
    groups: dict[tuple[str, str | None], list[Row]] = {}
    last: dict[str, tuple[str, str | None]] = {}
    for row in rows:
        name, fit = name_of(row), row.get("fit")
        key = (name.problem, fit["expression"] if fit else None)
        if name.peer or fit is None:
            key = last.get(name.problem, key)
        last[name.problem] = key
        groups.setdefault(key, []).append(row)
    titles: dict[str, int] = {}
    for number, ((problem, _), group) in enumerate(groups.items(), 1):
        title = _title(problem, group)
        titles[title] = titles.get(title, 0) + 1
        again = f" ({titles[title]})" if titles[title] > 1 else ""
        yield ProblemRows(number, title + again, tuple(group))


def _title(problem: str, rows: Sequence[Row]) -> str:
    """The problem's name; of one without a name, an expression of the command line, the target."""
    target = next((row["fit"]["target"] for row in rows if row.get("fit")), None)
    return shortened(target, 40) if problem == UNNAMED and target else problem


def _lead(problems: Sequence[ProblemRows]) -> Iterator[Block]:
    if len(problems) > 1:
        yield _overview(problems)


def _overview(problems: Sequence[ProblemRows]) -> Table:
    head = (
        Column("problem"), Column("eps", numeric=True), Column("by"), Column("gamma", numeric=True), Column("on"),
        Column("operations"),
    )  # fmt: skip
    return Table(head, tuple(_overview_row(problem) for problem in problems))


def _overview_row(problem: ProblemRows) -> tuple[Cell, ...]:
    errors, times, fit = problem.with_errors(), problem.with_times(), problem.fit
    worst = max((row["epsilon"][problem.leading] for row in errors), default=None)
    return (
        Cell(Link(problem.title, problem.title)),
        Cell(epsilon_range(errors, problem.leading), worst),
        Cell(Code(problem.leading)),
        Cell(gamma_range(times), min((row["gamma"] for row in times), default=None)),
        Cell(circumstances(times[0])[0] if times else "–"),
        Cell(counts(fit["cost"]) if fit and fit["cost"] else "–"),
    )


def _definitions(rows: Sequence[Row]) -> dict[str, None]:
    return dict.fromkeys(name for row in rows for name in row["epsilon"])


def _making(rows: Sequence[Row]) -> Section:
    finished = sorted(row["finished"] for row in rows if row.get("finished"))
    dates = (
        f", finished {finished[0]}" + (f" to {finished[-1]}" if finished[0] != finished[-1] else "") if finished else ""
    )
    blocks: list[Block] = [Paragraph(f"{count(len(rows))} measured rows{dates}.")]
    machines: list[Mapping[str, Any]] = []
    for row in rows:
        if row.get("machine") and row["machine"] not in machines:
            machines.append(row["machine"])
    blocks += [Facts(tuple(_machine(machine))) for machine in machines]
    return Section("How they were measured", tuple(blocks))


def _machine(machine: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """What a record says of a machine, whatever that is: its fields are not this page's business."""
    for key, value in machine.items():
        if isinstance(value, Mapping):
            yield key, ", ".join(f"{name} {part}" for name, part in value.items() if part is not None)
        elif isinstance(value, (list, tuple)):
            yield key, ", ".join(map(str, value)) or "–"
        elif value is not None:
            yield key, str(value)
