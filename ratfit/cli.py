"""The command line: parse, call, print; no mathematics."""

from __future__ import annotations

import gc
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

import ratfit
from ratfit._derive import derive as derive_fit
from ratfit._fit import Fit
from ratfit._inline import Words, problem_of_words, settings_of, target_of_words
from ratfit._parse import RatfitError, nearest
from ratfit._problem import Problem
from ratfit._problem_file import problem_of
from ratfit._problem_text import at_parameters, to_tables
from ratfit._target import Target, exact
from ratfit.gallery import Card, card, find_problem, is_card, is_known
from ratfit.report.progress import waiting

EXPRESSION_HELP = """PROBLEM is looked up as a gallery name (`ratfit gallery`), then as a problem file
(it ends in .toml or exists), then read as an expression that --on, --form and conditions complete."""

TARGET_HELP = """TARGET is looked up as a gallery name (`ratfit gallery`), then as a problem file (it ends in .toml or
exists), then read as an expression that --on completes."""


def main(arguments: list[str] | None = None) -> None:
    """Runs the command line. Exit 0: done; 1: an honest no; 2: bad input, one line; 130: interrupted."""
    gc.freeze()  # what the imports made stays: collecting garbage among it costs a tenth of a short command
    try:
        status = cli.main(arguments, prog_name="ratfit", standalone_mode=False)
    except RatfitError as error:
        _fail(str(error))
    except click.UsageError as error:
        _fail(error.format_message())
    except (KeyboardInterrupt, click.Abort):
        kept = "; rows that were written are kept, --resume goes on" if "bench" in sys.argv[1:2] else ""
        print(f"\nratfit: interrupted{kept}", file=sys.stderr)
        sys.exit(130)
    except BrokenPipeError:  # the reader, `head` say, has seen enough
        sys.stderr.close()
        sys.exit(0)
    sys.exit(status if isinstance(status, int) else 0)


def _fail(message: str) -> None:
    print("ratfit: " + " ".join(message.split()), file=sys.stderr)
    sys.exit(2)


@click.group(context_settings={"help_option_names": ["--help"]}, no_args_is_help=False, invoke_without_command=True)
@click.version_option(ratfit.__version__, prog_name="ratfit")
@click.pass_context
def cli(context: click.Context) -> None:
    """Say what must stay exact; get the cheapest formula that keeps it.

    \b
    ratfit paper                      the four approximations of the 1994 paper, re-derived and measured
    ratfit derive eq19                one of them
    ratfit derive "sin(x)" --on 0 pi/2 --form 2/1 --value 0 --derivative 0 --value pi/2 --derivative pi/2
    ratfit bench eq12                 its error and its speed
    ratfit study "tanh(x)" --on 0 oo  what is exact about a function, as conditions for derive
    ratfit gallery                    every problem that comes with ratfit
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help())


Option = Callable[[Any], Any]


def _together(*options: Option) -> Option:
    def decorate(function: Any) -> Any:
        for option in reversed(options):
            function = option(function)
        return function

    return decorate


# Words may begin with a minus: what is no option of ours stays among the words and is looked at in `_one_word`.
WORDS: dict[str, Any] = {"ignore_unknown_options": True}

problem_options = _together(
    click.argument("problem", nargs=-1, type=click.UNPROCESSED),
    click.option("--on", nargs=2, metavar="LOW HIGH", help="The domain of an expression."),
    click.option("--form", metavar="N/M", help="Degrees of the fraction, or an expression with --unknowns."),
    click.option("--unknowns", metavar="a,b", help="The unknowns of a form that is an expression."),
    click.option("--power", metavar="BASE", help="The form A + B*BASE**n; ';exponent=p' names the exponent."),
    click.option("--value", multiple=True, metavar="AT", help="Keep the value there; ';equals=...' states it."),
    click.option("--derivative", multiple=True, metavar="AT", help="Keep the slope there; ';order=2;equals=1/4'."),
    click.option("--limit", multiple=True, metavar="AT", help="Keep the limit there: 'oo;equals=1;scale=x;minus=x/2'."),
    click.option(
        "--integral", multiple=True, metavar="WEIGHT", help="Keep an integral: 'weight=2*t;over=0,1;equals=1'."
    ),
    click.option(
        "--equation", multiple=True, metavar="RESIDUAL", help="A differential equation: \"y'' + y;at=0;order=2\"."
    ),
    click.option("--variable", metavar="NAME", help="The variable, where the expression leaves it open."),
    click.option("--parameter", multiple=True, metavar="m=LOW:HIGH", help="A symbol that stays in the answer."),
    click.option("--let", multiple=True, metavar="h=EXPR", help="An abbreviation."),
    click.option("--factor", metavar="EXPR", help="Multiplies the fraction."),
    click.option("--of", metavar="EXPR", help="The inner variable that the fraction is written in."),
    click.option("--parity", metavar="odd|even", help="Parity of the whole fraction."),
    click.option("--support", nargs=2, metavar="LOW HIGH", help="Where the fit lives; it is 0 elsewhere."),
    click.option("--degree", type=int, metavar="N", help="Degree of a card that takes one (pade-exp)."),
    click.option(
        "--set",
        "settings",
        multiple=True,
        metavar="n=5",
        help="A value for a free coefficient, or for a parameter.",
    ),
    click.option("--route", default="auto", metavar="auto|linear|polynomial|power|nonlinear", help="Force a route."),
    click.option(
        "--timeout", type=float, default=60.0, show_default=True, metavar="SECONDS", help="Give up after that."
    ),
    click.option("--seed", type=int, default=0, show_default=True, help="Seed of random samples and starts."),
    click.option("--out", type=click.Path(), metavar="FILE", help="Write the result there; bench appends its rows."),
)


def _read(problem: tuple[str, ...], degree: int | None, words: dict[str, Any]) -> tuple[Problem, Card | None]:
    """The problem that the words of a command name, and its card where it is one of the gallery."""
    text = _one_word(problem)
    stated = Words(**{k: words[k] for k in Words.__dataclass_fields__ if k in words})
    if is_known(text):
        if stated.given():
            raise RatfitError(f"--{stated.given()[0]} completes an expression; {text} is a whole problem, leave it out")
        found = card(text) if is_card(text) else None
        if degree is not None:
            if found is None:
                raise RatfitError(f"--degree goes with a gallery card that takes one, not with the file {text}")
            found = found.with_degree(degree)
        return (found.problem, found) if found else (find_problem(text), None)
    if degree is not None:
        raise RatfitError("--degree goes with a gallery card that takes one (pade-exp)")
    if not stated.given() and text.replace("-", "").replace("_", "").isalnum():
        return card(text).problem, None  # a lone word that is no name: the error offers the nearest names
    return problem_of_words(text, stated), None


def _one_word(problem: tuple[str, ...]) -> str:
    """The one problem among the words; RatfitError for none, for several and for misspelt options."""
    options = [o for p in derive.params + bench.params + study.params for o in p.opts if o.startswith("--")]
    for word in problem:
        if word.startswith("--") and len(word) > 2:
            raise RatfitError(
                f"there is no option {word.split('=')[0]}{nearest(word.split('=')[0], options)}; see --help"
            )
    if not problem or problem == ("",):
        raise RatfitError("which problem? give a gallery name, a file or an expression, as in `ratfit derive eq19`")
    if len(problem) > 1:
        raise RatfitError(f"one problem at a time: {problem[1]!r} is one too many; put an expression in quotes")
    return problem[0]


@cli.command(short_help="Derive a fit from its kernel conditions.", context_settings=WORDS, epilog=EXPRESSION_HELP)
@problem_options
@click.option("--unique", is_flag=True, help="Take a family with free coefficients for a no.")
@click.option("--format", "format_", default="text", type=click.Choice(["text", "json", "latex"]), show_default=True)
def derive(problem: tuple[str, ...], degree: int | None, settings: tuple[str, ...], **options: Any) -> int:
    """Derive the fit of PROBLEM from its kernel conditions.

    \b
    ratfit derive eq19
    ratfit derive eq12 --route polynomial      the paper's own system, with its spurious root
    ratfit derive eq15 --set n=3               another choice of the free exponent
    ratfit derive eq19 --set m=0.3             at one value of the parameter
    ratfit derive my.toml --format json
    ratfit derive "t**n" --parameter n=1:1000 --on 0 1 --form 1/1 --value 0 --value 1 --derivative 1
    """
    found, shown = _read(problem, degree, options)
    there = _with_settings(found, settings_of(settings))
    if there.parameters != found.parameters:
        shown = None  # what is published has the parameters as symbols
    fit = _derived(there, options)
    if options["unique"] and fit.status in ("family", "several"):
        fit = _refused(fit)
    _write(_rendered(fit, shown, options["format_"]), options["out"])
    for line in fit.advice:
        print(f"ratfit: {line}", file=sys.stderr)
    return 0 if fit.expression is not None else 1


def _with_settings(problem: Problem, settings: dict[str, str]) -> Problem:
    """The problem with choices recorded, and at the values of parameters that are set."""
    values = {}
    for parameter in (p for p in problem.parameters if p.name in settings):
        values[parameter.name] = settings[parameter.name]
        value = exact(settings[parameter.name], f"--set {parameter}")
        if not value.is_number or not parameter.low <= value <= parameter.high:
            raise RatfitError(f"--set {parameter}={value}: it must be a number in [{parameter.low}, {parameter.high}]")
    there = problem_of(at_parameters(to_tables(problem), values)) if values else problem
    return there.with_choice({n: v for n, v in settings.items() if n not in values})


def _derived(problem: Problem, options: dict[str, Any]) -> Fit:
    seconds = _positive(options["timeout"])
    with waiting(f"deriving {problem.name}, for at most {seconds:g} s (Ctrl-C stops)"):
        return derive_fit(problem, route=options["route"], timeout=seconds, seed=options["seed"])


def _refused(fit: Fit) -> Fit:
    names = ", ".join(map(str, fit.free)) or "a choice among several answers"
    reason = f"--unique: the conditions leave {names} open; add a condition"
    return Fit(fit.problem, fit.status, fit.route, (), fit.rejected, (reason,), fit.equations)


def _positive(seconds: float) -> float:
    if not 0 < seconds < float("inf"):
        raise RatfitError(f"--timeout must be a positive number of seconds, not {seconds:g}")
    return seconds


def _rendered(fit: Fit, shown: Card | None, format_: str) -> str:
    if format_ == "json":
        return json.dumps(fit.to_json_object(), indent=2, ensure_ascii=False)
    if format_ == "latex":
        import sympy as sp

        if fit.expression is None:
            print("ratfit: " + "; ".join(fit.reasons), file=sys.stderr)
            return ""
        return sp.latex(fit.formula)
    from ratfit.report.text import fit_text

    return fit_text(fit, shown, unicode=_speaks_unicode())


def _speaks_unicode() -> bool:
    return "utf" in (sys.stdout.encoding or "").lower()


def _write(text: str, out: str | None) -> None:
    """Results to standard output, or whole to a file."""
    if out is None:
        print(text)
        return
    from ratfit._record import write_text

    write_text(Path(out), text + "\n")


PICTURES = ("svg", "pdf", "png")


@cli.command(short_help="Say what is exact about a function.", context_settings=WORDS, epilog=TARGET_HELP)
@click.argument("target", nargs=-1, type=click.UNPROCESSED)
@click.option("--on", nargs=2, metavar="LOW HIGH", help="The domain of an expression; oo and -oo are ends too.")
@click.option("--variable", metavar="NAME", help="The variable, where the expression leaves it open.")
@click.option("--parameter", multiple=True, metavar="m=LOW:HIGH", help="A symbol that stays in the answer.")
@click.option("--let", multiple=True, metavar="h=EXPR", help="An abbreviation.")
@click.option("--plot", metavar="FILE", help="A picture with the conditions marked: .svg, .pdf or .png.")
@click.option("--format", "format_", default="text", type=click.Choice(["text", "json", "toml"]), show_default=True)
@click.option("--out", type=click.Path(), metavar="FILE", help="Write the result there.")
@click.option("--timeout", type=float, default=30.0, show_default=True, metavar="SECONDS", help="Stop after that.")
def study(target: tuple[str, ...], **options: Any) -> int:
    """Say what is exact about TARGET, and print every fact as a kernel condition that `ratfit derive` takes.

    \b
    ratfit study eq19
    ratfit study "sin(x)" --on 0 pi/2
    ratfit study "tanh(x)" --on 0 oo --plot tanh.svg
    ratfit study "exp(-k*x)" --on 0 oo --parameter k=1/2:2 --format toml > my.toml
    """
    from ratfit._study import study as study_target
    from ratfit.report.study import study_json, study_text, study_toml

    picture = _picture_format(options["plot"])
    studied, seconds = _read_target(target, options), _positive(options["timeout"])
    with waiting(f"studying {studied.expression}, for at most {seconds:g} s (Ctrl-C stops)"):
        found = study_target(studied, timeout=seconds)
    if picture:
        _write_picture(found, options["plot"], picture)
    written = {"text": study_text, "json": study_json, "toml": study_toml}[options["format_"]](found)
    _write(written.rstrip("\n"), options["out"])
    return 0


def _read_target(words: tuple[str, ...], options: dict[str, Any]) -> Target:
    """The target that the words of `study` name: of a card, of a file, or an expression with its domain."""
    from ratfit._study.study import target_of

    text = _one_word(words)
    stated = Words(**{k: options[k] for k in ("on", "variable", "parameter", "let")})
    if is_known(text) and stated.given():
        raise RatfitError(f"--{stated.given()[0]} completes an expression; {text} is a whole problem, leave it out")
    if is_known(text):
        return target_of(find_problem(text))
    if not stated.given() and text.replace("-", "").replace("_", "").isalnum():
        return target_of(card(text).problem)  # a lone word that is no name: the error offers the nearest names
    return target_of_words(text, stated)


def _picture_format(file: str | None) -> str:
    """The format that the suffix of a picture asks for, before any work is done for it."""
    if file is None:
        return ""
    suffix = Path(file).suffix.lower().removeprefix(".")
    if suffix not in PICTURES:
        raise RatfitError(f"--plot {file}: name the picture something.svg, something.pdf or something.png")
    return suffix


def _write_picture(found: Any, file: str, format_: str) -> None:
    from io import BytesIO

    from ratfit._record import write_bytes
    from ratfit.plot import plot_study

    drawn = BytesIO()
    plot_study(found).figure.savefig(drawn, format=format_, dpi=200)  # type: ignore[union-attr]  # a Figure of its own
    write_bytes(file, drawn.getvalue())


@cli.command(short_help="List the problems of the gallery.")
@click.argument("name", required=False)
@click.option("--format", "format_", default="text", type=click.Choice(["text", "json", "toml"]), show_default=True)
def gallery(name: str | None, format_: str) -> None:
    """List the problems that come with ratfit, or show one.

    \b
    ratfit gallery
    ratfit gallery eq19 --format toml > my.toml     a problem file to start from
    """
    from ratfit._problem_text import to_tables, write_toml
    from ratfit.gallery import cards
    from ratfit.report.text import card_text, gallery_text

    shown = cards() if name is None else (card(name),)
    if format_ == "toml" and name is None:
        raise RatfitError("--format toml shows one problem; name it, as in `ratfit gallery eq19 --format toml`")
    if format_ == "toml":
        print(write_toml(to_tables(shown[0].problem)), end="")
    elif format_ == "json":
        print(json.dumps([c.to_json_object() for c in shown], indent=2, ensure_ascii=False))
    else:
        print(gallery_text(shown) if name is None else card_text(shown[0]))


measure_options = _together(
    click.option("--samples", type=int, default=1_000_000, show_default=True, metavar="N", help="Number of samples."),
    click.option("--sampling", default="uniform", show_default=True, metavar="NAME", help="Sampling protocol."),
    click.option("--dtype", default="float32", show_default=True, metavar="float32|float64", help="Type under test."),
    click.option("--backend", default="jax-cpu", show_default=True, metavar="jax-cpu|jax-gpu", help="Where it runs."),
)


@cli.command(short_help="Measure the error and speed of a fit.", context_settings=WORDS, epilog=EXPRESSION_HELP)
@problem_options
@measure_options
@click.option("--resume", is_flag=True, help="Go on from the rows that --out FILE holds.")
@click.option("--format", "format_", default="text", type=click.Choice(["text", "json"]), show_default=True)
def bench(problem: tuple[str, ...], degree: int | None, settings: tuple[str, ...], **options: Any) -> int:
    """Measure eps and gamma of the fit of PROBLEM, against its target and its references.

    \b
    ratfit bench eq12
    ratfit bench eq19 --set m=0.2 --dtype float64
    ratfit bench eq21 --format json --out rows.jsonl
    ratfit bench "exp(x)" --on 0 1 --form 2/2 --value 0 --derivative 0 --derivative "0;order=2" --value 1 --derivative 1
    """
    from ratfit._bench import Measuring
    from ratfit.report.bench import run_bench

    found, shown = _read(problem, degree, options)
    values = settings_of(settings)
    names = [p.name for p in found.parameters]
    found = found.with_choice({n: v for n, v in values.items() if n not in names})
    fit = _derived(found, options)
    if fit.expression is None:
        print(_rendered(fit, shown, options["format_"]))
        return 1
    how = Measuring(options["samples"], options["seed"], options["sampling"], options["dtype"], options["backend"])
    if options["resume"] and options["out"] is None:
        raise RatfitError("--resume needs the file to go on from: --out FILE")
    parameters = {n: v for n, v in values.items() if n in names}
    print(run_bench(fit, shown, parameters, how, options["out"], options["resume"], options["format_"]))
    return 0


@cli.command(short_help="The 1994 paper, derived and measured.")
@click.option("--samples", type=int, default=1_000_000, show_default=True, metavar="N", help="Number of samples.")
@click.option("--seed", type=int, default=0, show_default=True, help="Seed of the samples.")
@click.option(
    "--out",
    type=click.Path(),
    default="ratfit-paper",
    show_default=True,
    metavar="FOLDER",
    help="Where page and record go.",
)
@click.option("--format", "format_", default="text", type=click.Choice(["text", "json"]), show_default=True)
def paper(samples: int, seed: int, out: str, format_: str) -> int:
    """Re-derive Eqs. 12, 15, 19 and 21 of the 1994 paper, and measure each beside its printed figures.

    \b
    ratfit paper                        prints the tables; writes paper.md and paper.json to ./ratfit-paper
    ratfit paper --samples 100000       sooner, less precise
    """
    from ratfit.report.paper import run_paper

    return run_paper(samples, seed, Path(out), format_)


@cli.command(short_help="Write a problem file to start from.")
@click.argument("file", type=click.Path())
def init(file: str) -> None:
    """Write a commented problem file to start from; a file that exists is left alone.

    \b
    ratfit init my.toml && ratfit check my.toml && ratfit derive my.toml
    """
    from importlib.resources import files

    from ratfit._record import write_text

    if Path(file).exists():
        raise RatfitError(f"{file} exists and is left alone; give another name")
    write_text(Path(file), (files("ratfit.gallery") / "template.txt").read_text("utf-8"))
    print(f"wrote {file}; next: ratfit check {file}", file=sys.stderr)


@cli.command(short_help="Say what a problem means.")
@click.argument("file", metavar="PROBLEM", type=click.Path())
def check(file: str) -> None:
    """Say what a problem file, or a gallery name, was understood to mean.

    \b
    ratfit check my.toml
    """
    from ratfit.report.text import problem_text

    print(problem_text(find_problem(file)))
