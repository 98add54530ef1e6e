"""The numbers at the top of a problem's section, each with what qualifies it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ratfit._record import Row
from ratfit.report.document import Code, Headline, Headlines, Text
from ratfit.report.measured import circumstances, count, epsilon_range, error_remarks, gamma_range, label, speed_remarks
from ratfit.report.problem_rows import ProblemRows


def headlines(problem: ProblemRows) -> Headlines:
    """eps, gamma on each backend (one ratio alone misleads), the operations, and the conditions that are kept."""
    errors, fit = problem.with_errors(), problem.fit
    said = _said(errors, error_remarks)
    items = [Headline(epsilon_range(errors, problem.leading), _error_label(errors, problem.leading), said)]
    items += [
        Headline(gamma_range(rows), _speed_label(rows), _said(rows, speed_remarks)) for rows in problem.by_backend()
    ]
    if fit and fit["cost"]:
        items.append(Headline(counts(fit["cost"]), "operations a sample"))
    if fit and fit["conditions"]:
        items.append(_kept(fit["conditions"]))
    left_out = sum(row["nonfinite"] or 0 for row in errors)
    if left_out:
        items.append(Headline(count(left_out), "samples not finite", "left out of eps"))
    return Headlines(tuple(items))


def _error_label(rows: Sequence[Row], definition: str) -> Text:
    if not rows:
        return "eps"
    samples = " or ".join(dict.fromkeys(count(row["samples"]) for row in rows))
    _, dtype, sampling = circumstances(rows[0])
    return ("eps ", Code(definition), f", {dtype}, {sampling}, {samples} samples{_settings(rows)}")


def _speed_label(rows: Sequence[Row]) -> Text:
    backend, dtype, _ = circumstances(rows[0])
    return f"gamma on {backend}, {dtype}{_settings(rows)}"


def _settings(rows: Sequence[Row]) -> str:
    settings = list(dict.fromkeys(label(row) for row in rows))
    if len(settings) > 1:
        return f", over {len(settings)} settings"
    return f", {settings[0]}" if settings[0] else ""


def _said(rows: Sequence[Row], remarks: Callable[[Row], tuple[str, ...]]) -> str:
    """Each remark once, with the number of rows that it is on where that is not all of them."""
    found: dict[str, int] = {}
    for row in rows:
        for remark in dict.fromkeys(map(_general, remarks(row))):
            found[remark] = found.get(remark, 0) + 1
    return "; ".join(text if n == len(rows) else f"{text} ({n} of {len(rows)})" for text, n in found.items())


def _general(remark: str) -> str:
    """A remark without what disturbed this one row: the table has it."""
    return "noisy: time it again on a quiet machine" if remark.startswith("noisy: ") else remark


def _kept(conditions: Sequence[dict[str, Any]]) -> Headline:
    kept = sum(condition["holds"] is True for condition in conditions)
    remark = "" if kept == len(conditions) else "see the table of conditions"
    return Headline(f"{kept} of {len(conditions)}", "conditions kept", remark)


def counts(cost: dict[str, int]) -> str:
    """Operations in words: "1 add, 1 mul, 1 div"."""
    return ", ".join(f"{n} {kind}" for kind, n in cost.items() if n) or "none"
