"""What was asked and what was found: specification, fit and published formula."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ratfit.report.document import Block, Cell, Code, Column, Details, Facts, Formula, Items, Paragraph, Table, Text
from ratfit.report.formula import formula
from ratfit.report.headlines import counts
from ratfit.report.measured import epsilon_range, gamma_range, number
from ratfit.report.problem_rows import ProblemRows

STATUS = {
    "unique": "one answer",
    "family": "a family: the conditions leave coefficients free",
    "several": "several answers",
    "inconsistent": "no answer: the conditions clash",
    "rejected": "no answer: every candidate was rejected",
    "timeout": "no answer in time",
}
HOLDS = {True: "✓ holds", False: "✗ fails", None: "? undecided"}


def specification(problem: ProblemRows) -> Iterator[Block]:
    fit = problem.fit
    if fit is None:
        yield Paragraph("The record holds no derivation of this row.")
        return
    if fit["target"]:
        yield formula(fit["target"], fit)
    pairs: list[tuple[str, Text]] = [("domain", f"{fit['variable']} in [{', '.join(fit['domain'])}]")]
    pairs += [("parameter", f"{name} in [{', '.join(ends)}]") for name, ends in fit["parameters"].items()]
    pairs += [("form", _form(fit["form"]))]
    if not fit["target"]:
        pairs.insert(0, ("target", "none: every condition states what it equals"))
    yield Facts(tuple(pairs))
    if fit["conditions"]:
        yield _conditions(fit["conditions"])


def _form(form: dict[str, Any]) -> Text:
    said: list[Any] = []
    for key, value in form.items():
        shown = ", ".join(map(str, value)) if isinstance(value, list) else str(value)
        said += [", " if said else "", f"{key} ", Code(shown)]
    return tuple(said)


def _conditions(conditions: Sequence[dict[str, Any]]) -> Table:
    head = (Column("condition"), Column("equals"), Column("holds"), Column("residual", numeric=True))
    rows = tuple(
        (
            Cell(c.get("words") or (c["kind"], ": ", Code(c["at"]))),
            Cell(Code(c["equals"])),
            Cell(HOLDS[c["holds"]]),
            _residual(c["residual"]),
        )
        for c in conditions
    )
    return Table(head, rows)


def _residual(residual: float | None) -> Cell:
    return Cell(number(residual, 2), residual)


def answer(problem: ProblemRows) -> Iterator[Block]:
    fit = problem.fit
    if fit is None:
        return
    if fit["expression"] is None:
        yield Paragraph(f"No formula: {STATUS.get(fit['status'], fit['status'])}.")
        yield from _derivation(fit)
        return
    yield formula(fit["expression"], fit)
    yield Details("How it was derived", tuple(_derivation(fit)))


def _derivation(fit: dict[str, Any]) -> Iterator[Block]:
    pairs: list[tuple[str, Text]] = [("status", STATUS.get(fit["status"], fit["status"])), ("route", fit["route"])]
    pairs += [("free", f"{' < '.join((f['range'][0], f['name'], f['range'][1]))}") for f in fit["free"]]
    pairs += [("choice", f"{name} = {value}") for name, value in fit["choice"].items()]
    if fit["cost"]:
        pairs.append(("cost", f"{counts(fit['cost'])} a sample, without the work on parameters alone"))
    yield Facts(tuple(pairs))
    if fit["candidates"][1:]:
        yield Paragraph("Other answers to the same conditions:")
        yield Items(tuple(Code(text) for text in fit["candidates"][1:]))
    if fit["rejected"]:
        yield _rejected(fit["rejected"])


def _rejected(rejected: Sequence[dict[str, Any]]) -> Table:
    head = (Column("rejected"), Column("reason"))
    return Table(head, tuple((Cell(Code(each["expression"] or "")), Cell(each["reason"])) for each in rejected))


def published(problem: ProblemRows) -> Iterator[Block]:
    printed = next((row["published"] for row in problem.rows if row.get("published")), None)
    if printed is None:
        return
    yield formula(printed["expression"], problem.fit) if problem.fit else Formula(printed["expression"])
    equal = {True: "equal to the fit, symbolically", False: "NOT equal to the fit", None: "not compared with the fit"}
    pairs: list[tuple[str, Text]] = [
        ("source", f"{printed['source']}, {printed['place']}"),
        ("formula", equal[printed["equal"]]),
        ("printed eps", f"{number(printed['epsilon'])}; measured: {_measured_epsilon(problem)}"),
        ("printed gamma", f"{number(printed['gamma'])}; measured: {gamma_range(problem.with_times())}"),
    ]
    yield Facts(tuple(pairs))


def _measured_epsilon(problem: ProblemRows) -> str:
    return f"{epsilon_range(problem.with_errors(), problem.leading)} ({problem.leading})"
