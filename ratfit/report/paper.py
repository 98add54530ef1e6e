"""`ratfit paper`: the approximations of the 1994 paper, derived and measured beside its printed figures."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ratfit._bench import Job, Measuring, jobs, measure
from ratfit._derive import derive
from ratfit._error import DEFINITIONS
from ratfit._fit import Fit
from ratfit._parse import RatfitError
from ratfit._record import Row, machine, write_text
from ratfit._sampling import check_protocol
from ratfit.gallery import Card, card
from ratfit.report.bench import COLUMNS, gamma, over_floor, parameters, short
from ratfit.report.progress import progress
from ratfit.report.text import agreement, aligned, condition_line, equals_published

EQUATIONS = ("eq12", "eq15", "eq19", "eq21")
DTYPES = ("float32", "float64")
PROTOCOL = "uniform"
BACKEND = "jax-cpu"


EXPLANATION = """\
Errors are against the exact function in float64, whatever the type under test. gamma is the exact function's median
time over the fit's, both jitted by JAX on arrays, timed in turn with the copy floor `x + 1`; a fit at the floor is
limited by memory, and gamma is then a lower bound. The paper's figures come from a scalar program of 1994, and it
defines neither measure.
"""


@dataclass(frozen=True)
class Section:
    """One equation of the paper: its card, the fit derived, the rows measured."""

    card: Card
    fit: Fit
    rows: tuple[Row, ...]


def run_paper(samples: int, seed: int, out: Path, format_: str) -> int:
    """Derives, measures, prints, and writes paper.md and paper.json into the folder `out`.

    Exit status 1 when a derivation does not give the printed formula.
    """
    check_protocol(PROTOCOL, samples, seed)
    with _folder(out):
        if format_ == "text":
            print(_preamble(samples, seed), flush=True)
        sections = []
        for name in EQUATIONS:
            section = _section(card(name), samples, seed)
            sections.append(section)
            if format_ == "text":
                print("\n" + section_text(section), flush=True)
        record = json.dumps(to_json_object(sections, samples, seed), indent=2, ensure_ascii=False, allow_nan=False)
        write_text(out / "paper.json", record + "\n")
        write_text(out / "paper.md", page(sections, samples, seed))
    print(record if format_ == "json" else f"\nwrote {out}/paper.md and {out}/paper.json")
    return 0 if all(equals_published(s.fit, s.card) for s in sections) else 1


@contextmanager
def _folder(out: Path) -> Iterator[None]:
    """Makes the folder before a minute of work, and takes it away again if nothing came of it."""
    try:
        is_new = not out.exists()
        out.mkdir(exist_ok=True)
    except OSError as error:
        raise RatfitError(f"--out {out}: no folder can be made there ({error.strerror}); name another") from None
    try:
        yield
    finally:
        if is_new and not any(out.iterdir()):
            out.rmdir()


def _section(shown: Card, samples: int, seed: int) -> Section:
    progress(f"{shown.place}: deriving")
    fit = derive(shown.problem)
    rows = []
    found = jobs(fit, shown.settings) if fit.candidates else []
    for dtype in DTYPES:
        for number, job in enumerate(found, 1):
            progress(f"{shown.place}: measuring {number}/{len(found)} {job.name} {dict(job.parameters)} {dtype}")
            how = Measuring(samples, seed, PROTOCOL, dtype, BACKEND)
            rows.append(measure(job, how, speed=_is_timed(job)).to_json_object())
    progress("")
    return Section(shown, fit, tuple(rows))


def _is_timed(job: Job) -> bool:
    """Speed is measured against the function that the paper replaced, not against corrected ones."""
    return job.reference is None or job.fit.problem.target is None


def _preamble(samples: int, seed: int) -> str:
    return (
        "The approximations of Schlick 1994, derived from their kernel conditions and measured on\n"
        f"{samples:,} samples ({PROTOCOL} in the variable, seed {seed}). eps are fractions; gamma is exact time / fit\n"
        "time, with its 95 % interval; fit/floor is the fit's time over that of x + 1: near 1 the fit runs as fast as\n"
        "memory lets it, and gamma is a lower bound. The paper defines neither of its figures; its sine is peak_mean."
    )


def section_text(section: Section) -> str:
    """One equation as text: derived and printed formula, then the table."""
    shown, fit = section.card, section.fit
    lines = [
        f"{shown.place}  {shown.title}",
        f"  derived   {fit.expression}  ({fit.status}, {fit.route} route)",
        f"  printed   {shown.printed}  -- {agreement(fit, shown)}",
    ]
    lines += [f"  choice    {s} = {v} of {s} > {fit.free[s][0]}" for s, v in fit.choice.items()]
    lines += [f"  keeps     {condition_line(c)}" for c in fit.conditions]
    lines += [f"  cost      {_counts(fit.cost.as_dict())} a sample; the paper: {_counts(shown.operations)}"]
    lines += [f"  the paper eps {_figure(shown.epsilon)}, gamma {_figure(shown.gamma)}", ""]
    lines += [f"  {line}" for line in aligned(_table(section.rows))]
    return "\n".join(lines)


def _table(rows: Sequence[Row]) -> list[tuple[str, ...]]:
    found: list[tuple[str, ...]] = [("against", "at", "dtype", *COLUMNS, "nonfinite", "gamma", "fit/floor")]
    for row in rows:
        eps = (short(row["epsilon"][d]) for d in COLUMNS)
        against = row["name"].partition(":")[2] or "the target"
        counted = str(row["nonfinite"])
        found.append((against, parameters(row), row["dtype"], *eps, counted, gamma(row), over_floor(row)))
    return found


def _counts(counts: Any) -> str:
    return "not stated" if not counts else ", ".join(f"{n} {kind}" for kind, n in counts.items() if n)


def _figure(value: float | None) -> str:
    return "not stated" if value is None else f"{value:.4g} ({100 * value:.4g} %)"


def to_json_object(sections: Sequence[Section], samples: int, seed: int) -> dict[str, Any]:
    """The record of a run: machine, every fit with what was printed, every row."""
    return {
        "machine": machine(),
        "samples": samples,
        "seed": seed,
        "equations": [
            {
                "place": s.card.place,
                "fit": s.fit.to_json_object(),
                "published": s.card.printed,
                "equal": equals_published(s.fit, s.card),
                "paper": {"epsilon": s.card.epsilon, "gamma": s.card.gamma, "operations": s.card.operations},
            }
            for s in sections
        ],
        "rows": [row for s in sections for row in s.rows],
    }


def page(sections: Sequence[Section], samples: int, seed: int) -> str:
    """The run as one Markdown page."""
    about = machine()
    lines = ["# The approximations of Schlick 1994, derived and measured", "", _preamble(samples, seed), ""]
    lines += [
        f"Made by `ratfit paper --samples {samples} --seed {seed}` on {about['processor']} ({about['cores']} cores).",
        "",
    ]
    for section in sections:
        lines += _page_section(section)
    lines += ["## What eps means", "", "| name | definition |", "|---|---|"]
    lines += [f"| {name} | `{formula.replace('|', chr(92) + '|')}` |" for name, formula in DEFINITIONS.items()]
    return "\n".join([*lines, "", EXPLANATION])


def _page_section(section: Section) -> list[str]:
    shown, fit = section.card, section.fit
    head, *body = _table(section.rows)
    return [
        f"## {shown.place}: {shown.title}",
        "",
        f"- derived ({fit.status}, {fit.route} route): `{fit.expression}`",
        f"- printed: `{shown.printed}`, {agreement(fit, shown)}",
        *(f"- recorded choice: {s} = {v}; the conditions leave {s} > {fit.free[s][0]}" for s, v in fit.choice.items()),
        *(f"- keeps {condition_line(c)}" for c in fit.conditions),
        f"- cost a sample: {_counts(fit.cost.as_dict())}; in the paper: {_counts(shown.operations)}",
        f"- the paper's figures: eps {_figure(shown.epsilon)}, gamma {_figure(shown.gamma)}",
        *([f"- {shown.note}"] if shown.note else []),
        "",
        f"| {' | '.join(head)} |",
        f"|{'---|' * len(head)}",
        *(f"| {' | '.join(line)} |" for line in body),
        "",
    ]
