"""`ratfit bench`: rows measured one by one, written as soon as they are done, shown as a table."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

from ratfit._bench import Job, Measuring, formula_tag, jobs, measure, parameters_of
from ratfit._fit import Fit
from ratfit._record import Row, append_row, machine, read_rows, same_measurement
from ratfit._sampling import check_protocol
from ratfit._target import exact
from ratfit.gallery import Card
from ratfit.report.progress import progress
from ratfit.report.text import aligned

COLUMNS = ("peak_mean", "peak_rms", "relative_mean", "relative_max", "absolute_max")
"""The definitions of eps that a table shows; the record holds all of them."""


def run_bench(
    fit: Fit, card: Card | None, given: Mapping[str, str], how: Measuring, out: str | None, resume: bool, format_: str
) -> str:
    """Measures every row of a fit and returns the text to print; with `out` rows are appended as they are done."""
    check_protocol(how.sampling, how.samples, how.seed, how.dtype)
    values = {name: float(exact(text, f"--set {name}")) for name, text in given.items()}
    settings = [values] if values else list(card.settings) if card else []
    written = read_rows(out) if out else []  # a file of something else is refused before the work, not after
    rows = list(_rows(jobs(fit, settings), how, out, written if resume else []))
    if format_ == "json":
        return json.dumps({"machine": machine(), "rows": rows}, indent=2, ensure_ascii=False)
    return table(rows)


def _rows(found: Sequence[Job], how: Measuring, out: str | None, done: Sequence[Row]) -> Iterator[Row]:
    for number, job in enumerate(found, 1):
        progress(f"{number}/{len(found)} {job.name} {dict(job.parameters)}")
        asked = {"name": job.name, "parameters": parameters_of(job), **asdict(how)}
        tag = formula_tag(job)
        known = next((row for row in done if same_measurement(row, **asked) and row["note"].startswith(tag)), None)
        if known is not None:
            yield known
            continue
        record = measure(job, how)
        if out:
            append_row(Path(out), record)
        yield record.to_json_object()
    progress("")


def table(rows: Sequence[Row]) -> str:
    """The rows as an aligned table: eps as fractions, gamma with its interval."""
    head = ("problem", "parameters", "dtype", *COLUMNS, "worst relative at", "nonfinite", "gamma", "fit/floor", "note")
    return "\n".join(aligned([head, *(_cells(row) for row in rows)]))


def _cells(row: Row) -> tuple[str, ...]:
    eps = (short(row["epsilon"][d]) for d in COLUMNS)
    at = short(row["worst"]["at"])
    return (
        row["name"],
        parameters(row),
        row["dtype"],
        *eps,
        at,
        str(row["nonfinite"]),
        gamma(row),
        over_floor(row),
        row["note"].partition("; ")[2],  # the formula's tag is for --resume
    )


def parameters(row: Row) -> str:
    """The values of a row's parameters, as in "m=0.25"."""
    return " ".join(f"{n}={short(v)}" for n, v in row["parameters"].items())


def over_floor(row: Row) -> str:
    """The fit's time over that of the copy floor."""
    return short(row["fit_s"] / row["floor_s"]) if row["fit_s"] else "-"


def gamma(row: Row) -> str:
    """gamma with its interval, as in "12.3 [11.9, 12.8]"."""
    if row["gamma"] is None:
        return "-"
    return f"{short(row['gamma'])} [{short(row['gamma_low'])}, {short(row['gamma_high'])}]"


def short(value: float | None) -> str:
    """A number to three digits; a dash for none."""
    return "-" if value is None else f"{value:.3g}"
