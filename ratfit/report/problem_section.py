"""One problem's part of the page, in the order in which a reader asks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ratfit.report.derivation import answer, published, specification
from ratfit.report.document import Block, Section, Verbatim
from ratfit.report.evidence import alternatives, costs, errors
from ratfit.report.headlines import headlines
from ratfit.report.problem_rows import ProblemRows


def problem_section(problem: ProblemRows) -> Section:
    """Headlines, specification, error over the domain, accuracy and cost, fit, alternatives, published, command."""
    parts: list[tuple[str, Iterable[Block]]] = [
        ("Specification", specification(problem)),
        ("Error over the domain", errors(problem)),
        ("Accuracy and cost", costs(problem)),
        ("The fit", answer(problem)),
        ("Alternatives", alternatives(problem)),
        ("Published", published(problem)),
        ("To reproduce", _commands(problem)),
    ]
    sections = [Section(title, blocks) for title, each in parts if (blocks := tuple(each))]
    return Section(problem.title, (headlines(problem), *sections))


def _commands(problem: ProblemRows) -> Iterator[Block]:
    commands = dict.fromkeys(row["command"] for row in problem.rows if row.get("command"))
    if commands:
        yield Verbatim("\n".join(commands))
