"""`ratfit bench`, `report` and `paper`: measuring, and what comes of it."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ratfit._fit import Fit
from ratfit._inline import settings_of
from ratfit._parse import RatfitError, shortened
from ratfit.cli.derive import rendered
from ratfit.cli.options import (
    EXPRESSION_HELP,
    WORDS,
    Number,
    check_places,
    derived,
    finite,
    numbers,
    problem_options,
    read_problem,
    stated_words,
    together,
)
from ratfit.gallery import Card

if TYPE_CHECKING:
    from ratfit._bench import Job
    from ratfit.report.rows import Book, Planned

SAMPLES = 1_000_000

TITLE = 36
"""Characters of what is measured, in the line that shows how far it is."""

BACKEND_HELP = """Time there alone (may be repeated): jax-cpu, jax-gpu, numpy, c-scalar, c-fast, cost-model; or none,
for the errors alone. Left out: all that this machine has."""

SAMPLES_HELP = """Samples for the errors: 1000000, or say 1e9. gamma is timed at 1000000 whatever it says, of a --model
too; --backend none leaves gamma out."""

measure_options = together(
    click.option("--samples", type=Number(), default=None, metavar="N", help=SAMPLES_HELP),
    click.option(
        "--sampling",
        metavar="NAME",
        help="Protocol: uniform (the default), angle, cosine, in-plane, hemisphere (that of a model), sobol.",
    ),
    click.option("--exhaustive", is_flag=True, help="Every number of --dtype in the domain, its ends included."),
    click.option(
        "--dtype", default="float32", show_default=True, metavar="float16|float32|float64", help="Type under test."
    ),
    click.option(
        "--backend",
        "backends",
        multiple=True,
        metavar="NAME",
        help=BACKEND_HELP,
    ),
    click.option("--within", nargs=2, metavar="LOW HIGH", help="Measure on that part of the domain."),
    click.option("--peers", is_flag=True, help="Beside the fit: table, AAA, polynomial of equal cost, Pade."),
)

several_options = together(
    click.option("--coordinator", metavar="HOST:PORT", help="Address of process 0, where several measure together."),
    click.option("--processes", type=int, metavar="N", help="How many processes there are."),
    click.option("--process", type=int, metavar="K", help="Which of them this is, from 0."),
)


@click.command(short_help="Measure the error and speed of a fit.", context_settings=WORDS, epilog=EXPRESSION_HELP)
@problem_options
@measure_options
@several_options
@click.option("--model", metavar="NAME", help="In place of PROBLEM: what stands for that reflectance model.")
@click.option("--resume", is_flag=True, help="Go on from the rows that --out FILE holds.")
@click.option("--against", type=click.Path(), metavar="FILE", help="Compare with older rows: what got worse. Exit 1.")
@click.option("--format", "format_", default="text", type=click.Choice(["text", "json"]), show_default=True)
def bench(problem: tuple[str, ...], degree: int | None, settings: tuple[str, ...], **options: Any) -> int:
    """Measure eps and gamma of the fit of PROBLEM, against its target and its references.

    \b
    ratfit bench eq12
    ratfit bench eq19 --set m=0.2 --peers               beside a table, AAA, a polynomial and Pade
    ratfit bench eq19 --set m=random --sampling hemisphere
    ratfit bench eq12 --exhaustive --backend none       every float32 of the domain, no timing
    ratfit bench tanh --within 0 10                     on a finite part of an infinite domain
    ratfit bench eq21 --samples 1e9 --out rows.jsonl    interrupt it; --resume goes on
    ratfit bench eq21 --out new.jsonl --against rows.jsonl
    ratfit bench --model cook-torrance --set alpha=0.1  a whole model, on pairs of directions
    ratfit bench "exp(x)" --on 0 1 --form 2/2 --value 0 --derivative 0 --derivative "0;order=2" --value 1 --derivative 1
    On several machines, K = 0 and 1:
    ratfit bench eq12 --samples 1e10 --coordinator 10.0.0.1:9876 --processes 2 --process K
    """
    from ratfit._setting import RANDOM
    from ratfit.report.rows import Book

    values = settings_of(settings, RANDOM)
    if options["model"] is not None:
        return _bench_model(problem, degree, values, options)
    found, shown = read_problem(problem, degree, options)
    names = [p.name for p in found.parameters]
    choice = {n: v for n, v in values.items() if n not in names}
    for name in (n for n, v in choice.items() if v == RANDOM):
        raise RatfitError(
            f"--set {name}=random: a parameter alone is drawn at random, there is: {', '.join(names) or 'none'}"
        )
    found = found.with_choice(choice)
    old = _old_rows(options["against"])
    _check_measuring(options)
    fit = derived(found, options)
    if fit.expression is None:
        print(rendered(fit, shown, options["format_"]))
        return 1
    _begin(options)
    book = Book(options["out"], options["resume"])
    asked = _jobs(fit, shown, {n: v for n, v in values.items() if n in names}, options)
    return _finish(_planned(asked, _about(fit, shown), options, book), book, old, options)


def _bench_model(problem: tuple[str, ...], degree: int | None, values: dict[str, str], options: dict[str, Any]) -> int:
    """Measures what stands for a whole model, on pairs of directions."""
    from ratfit._bench import model_jobs
    from ratfit._setting import RANDOM
    from ratfit.report.rows import Book

    measured = [name for name in ("exhaustive", "within", "peers") if options[name]]
    given = [*stated_words(options).given(), *measured, *(["degree"] if degree is not None else [])]
    aside = [*problem, *(f"--{name}" for name in given)]
    if aside:
        raise RatfitError(f"--model measures a whole model: leave {aside[0]} out")
    old = _old_rows(options["against"])
    _check_measuring(options)
    _begin(options)
    asked = model_jobs(options["model"], numbers(values, RANDOM))
    book, about = Book(options["out"], options["resume"]), {"fit": None, "command": _command(), "published": None}
    on_pairs = options | {"sampling": options["sampling"] or "hemisphere"}
    return _finish(_planned(asked, about, on_pairs, book), book, old, options)


def _check_measuring(options: dict[str, Any]) -> None:
    """What can be refused before any work is done."""
    check_places(options["out"])
    if options["resume"] and options["out"] is None:
        raise RatfitError("--resume needs the file to go on from: --out FILE")
    if options["exhaustive"] and options["samples"] is not None:
        raise RatfitError("--exhaustive takes every number there is: leave --samples out")
    if options["sampling"] == "exhaustive":
        raise RatfitError("--sampling exhaustive is said as --exhaustive")
    if "none" in options["backends"] and len(options["backends"]) > 1:
        raise RatfitError("--backend none is for the errors alone: leave the other --backend out, or none")
    if options["exhaustive"] and options["sampling"] is not None:
        raise RatfitError("--exhaustive is a sampling of its own: leave --sampling out")
    several = [options[name] is not None for name in ("coordinator", "processes", "process")]
    if any(several) and not all(several):
        raise RatfitError("several processes need all of --coordinator HOST:PORT, --processes N and --process K")


def _begin(options: dict[str, Any]) -> None:
    """Sees to the devices before JAX computes anything."""
    from ratfit._error.devices import use_all_cores
    from ratfit._error.machines import join

    use_all_cores()
    if options["coordinator"] is not None:
        _keep_for_results()
        join(options["coordinator"], options["processes"], options["process"])


def _keep_for_results() -> None:
    """Keeps standard output to ourselves: the library that JAX's processes talk by greets there."""
    sys.stdout.flush()
    ours = os.dup(1)
    os.dup2(2, 1)
    sys.stdout = os.fdopen(ours, "w", encoding=sys.stdout.encoding)


def _planned(found: list[Job], about: dict[str, Any], options: dict[str, Any], book: Book) -> list[Planned]:
    from ratfit._bench import Measuring, is_timed
    from ratfit._sampling import check_protocol
    from ratfit.report.rows import Measurement, plan

    asked = SAMPLES if options["samples"] is None else options["samples"]
    samples = None if options["exhaustive"] else asked
    sampling = "exhaustive" if options["exhaustive"] else options["sampling"] or "uniform"
    check_protocol(sampling, samples, options["seed"], options["dtype"])
    how, backends = Measuring(samples, options["seed"], sampling, options["dtype"]), _backends(options["backends"])
    titles = [f"{number}/{len(found)} {_title(job)}" for number, job in enumerate(found, 1)]
    measurements = [
        Measurement(job, how, backends if is_timed(job) else (), title, about)
        for job, title in zip(found, titles, strict=True)
    ]
    return plan(measurements, book)


def _title(job: Job) -> str:
    """What is measured, short enough for how far it is to stand beside it on a line of a terminal."""
    from ratfit._setting import RANDOM

    at = [f"{name}={value}" for name, value in job.parameters.items() if value != RANDOM]
    return shortened(" ".join([job.name, *at]), TITLE)


def _jobs(fit: Fit, shown: Card | None, given: dict[str, str], options: dict[str, Any]) -> list[Job]:
    from ratfit._bench import jobs, peer_jobs
    from ratfit._setting import RANDOM

    values = numbers(given, RANDOM)
    settings: Sequence[Any] = [values] if values else list(shown.settings) if shown else []
    ends = tuple(finite(end, "--within") for end in options["within"] or ())
    found = jobs(fit, settings, (ends[0], ends[1]) if ends else None)
    if not options["peers"]:
        return found
    peers, missing = peer_jobs(found)
    for name, reason in missing:
        print(f"ratfit: no {name}: {reason}", file=sys.stderr)
    return [*found, *peers]


def _backends(asked: tuple[str, ...]) -> tuple[str, ...]:
    from ratfit._speed import available
    from ratfit._speed.backends import backend_named

    if asked == ("none",):
        return ()
    for name in asked:
        backend_named(name)
    return tuple(dict.fromkeys(asked)) or available()


def _about(fit: Fit, shown: Card | None) -> dict[str, Any]:
    from ratfit.report.text import published_object, recorded

    return {"fit": recorded(fit), "command": _command(), "published": published_object(fit, shown)}


def _command() -> str:
    """The words of this command, less those that say where its rows go and who else takes part."""
    import shlex

    aside = ("--out", "--against", "--coordinator", "--processes", "--process", "--format")
    words, kept = iter(sys.argv[1:]), []
    for word in words:
        name, joined, _ = word.partition("=")
        if name in aside and not joined:
            next(words, None)
        elif name not in (*aside, "--resume"):
            kept.append(word)
    return shlex.join(["ratfit", *kept])


def _old_rows(path: str | None) -> list[Any] | None:
    from ratfit._record import read_rows

    if path is None:
        return None
    if not Path(path).exists():
        raise RatfitError(f"--against {path}: there is no such file; name one that bench --out has written")
    return read_rows(path)


def _finish(plan: Sequence[Planned], book: Book, old: list[Any] | None, options: dict[str, Any]) -> int:
    """Measures, prints, compares; the exit status."""
    from ratfit._error.machines import is_first
    from ratfit._record import compare, contract, machine
    from ratfit.report.against import against_text, got_worse
    from ratfit.report.bench import tables
    from ratfit.report.rows import rows

    found = _measured((row for each in plan for row in rows(each, book)), options)
    if not is_first():
        return 0
    if options["format_"] == "json":
        made = {"machine": machine(), "rows": [contract(row) for row in found]}
        print(json.dumps(made, indent=2, ensure_ascii=False, allow_nan=False))
    else:
        print(tables(found))
    if old is None:
        return 0
    changes = compare(old, found)
    print(against_text(changes), file=sys.stderr if options["format_"] == "json" else sys.stdout)
    compared = any(change.verdict in ("worse", "better", "same") for change in changes)
    return 1 if got_worse(changes) or not compared else 0


def _measured(found: Iterable[Any], options: dict[str, Any]) -> list[Any]:
    """All rows. Where several processes measure and one is lost, this one ends at once: JAX would wait, then dump."""
    try:
        return list(found)
    except RuntimeError:  # JAX's word for a process that does not answer
        if options["coordinator"] is None:
            raise
        kept = "what was written is kept, begin them all again with --resume"
        print(f"ratfit: another process was lost; {kept}", file=sys.stderr, flush=True)
        os._exit(1)


@click.command(short_help="Measured rows as a page.")
@click.argument("files", nargs=-1, type=click.Path())
@click.option("--out", default="ratfit-report", show_default=True, metavar="FOLDER", help="Where the pages go.")
def report(files: tuple[str, ...], out: str) -> int:
    """Turn the rows of FILES, written by `ratfit bench --out`, into one Markdown page and one HTML page.

    \b
    ratfit bench eq19 --peers --out rows.jsonl && ratfit report rows.jsonl
    ratfit report here.jsonl there.jsonl --out pages       rows of two machines
    """
    from ratfit.report.records import run_report

    if not files:
        raise RatfitError("which rows? name one or more files that bench --out has written")
    return run_report(files, out)


@click.command(short_help="The 1994 paper, derived and measured.")
@click.option("--samples", type=Number(), default=1_000_000, show_default=True, metavar="N", help="Number of samples.")
@click.option("--seed", type=Number(), default=0, show_default=True, help="Seed of the samples.")
@click.option(
    "--out",
    type=click.Path(),
    default="ratfit-paper",
    show_default=True,
    metavar="FOLDER",
    help="Where page, record and rows go.",
)
@click.option("--resume", is_flag=True, help="Go on from the rows that an interrupted run left in FOLDER.")
@click.option("--format", "format_", default="text", type=click.Choice(["text", "json"]), show_default=True)
def paper(samples: int, seed: int, out: str, resume: bool, format_: str) -> int:
    """Re-derive Eqs. 12, 15, 19 and 21 of the 1994 paper, and measure them and Eq. 16 beside its printed figures.

    Every definition of eps under every protocol and at the settings of the figures; what comes closest to each printed
    figure, and the one measure that serves them all best; gamma in every regime of this machine.

    \b
    ratfit paper                        about four minutes; writes paper.html, paper.md, paper.json to ./ratfit-paper
    ratfit paper --samples 100000       a little sooner, less precise
    ratfit paper --resume               after an interruption
    """
    from ratfit.report.paper import Asked, run_paper

    return run_paper(Asked(samples, seed, Path(out), format_, resume))
