"""What commands share: how a problem is named, its options, and where results go."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

import click

from ratfit._derive import derive as derive_fit
from ratfit._fit import Fit
from ratfit._inline import Words, problem_of_words
from ratfit._parse import RatfitError, nearest
from ratfit._problem import Problem
from ratfit._target import exact
from ratfit.cli.place import check_place
from ratfit.gallery import Card, card, find_problem, is_card, is_known
from ratfit.plot.write import picture_format
from ratfit.report.progress import waiting

EXPRESSION_HELP = """PROBLEM is looked up as a gallery name (`ratfit gallery`), then as a problem file
(it ends in .toml or exists), then read as an expression that --on, --form and conditions complete."""


Option = Callable[[Any], Any]


def together(*options: Option) -> Option:
    def decorate(function: Any) -> Any:
        for option in reversed(options):
            function = option(function)
        return function

    return decorate


class Number(click.ParamType):
    """A whole number, which may be written as 1e9 or 1_000_000."""

    name = "number"

    def convert(self, value: Any, parameter: click.Parameter | None, context: click.Context | None) -> int:
        """The number; a usage error for a fraction and for what is no number."""
        if isinstance(value, int):
            return value
        written = re.fullmatch(r"([+-]?[0-9_]+)(\.[0-9]+)?(?:e([0-9]{1,2}))?", value.lower())
        try:
            whole, part, power = written.groups() if written and len(value) < 30 else ("", "", "")
            number = Fraction(whole + (part or "")) * 10 ** int(power or 0)
        except ValueError:
            number = Fraction(1, 2)
        if number.denominator != 1:
            self.fail(f"{value} is not a whole number, as 1000000 or 1e9 is", parameter, context)
        return int(number)


# Words may begin with a minus: what is no option of ours stays among the words and is looked at in `_one_word`.
WORDS: dict[str, Any] = {"ignore_unknown_options": True}

problem_options = together(
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
    click.option("--seed", type=Number(), default=0, show_default=True, help="Seed of random samples and starts."),
    click.option("--out", type=click.Path(), metavar="FILE", help="Write the result there; bench appends its rows."),
)


def read_problem(problem: tuple[str, ...], degree: int | None, words: dict[str, Any]) -> tuple[Problem, Card | None]:
    """The problem that the words of a command name, and its card where it is one of the gallery."""
    stated = stated_words(words)
    for option in ("on", "support", "within"):
        check_pair(option, words.get(option))
    text = one_word(problem)
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


def check_pair(option: str, ends: tuple[str, str] | None) -> None:
    """Two ends in one word, as 0,1, take the next option for the second: RatfitError says how they are written."""
    if ends and ends[1].startswith("--"):
        raise RatfitError(f"--{option} takes two words, the ends, as in --{option} 0 pi/2; there is {ends[0]!r} alone")


def stated_words(options: dict[str, Any]) -> Words:
    """What the options say of a problem that is an expression."""
    return Words(**{k: options[k] for k in Words.__dataclass_fields__ if k in options})


def one_word(problem: tuple[str, ...]) -> str:
    """The one problem among the words; RatfitError for none, for several and for misspelt options."""
    options = [o for command in _commands() for p in command.params for o in p.opts if o.startswith("--")]
    for word in problem:
        if word.startswith("--") and len(word) > 2:
            raise RatfitError(
                f"there is no option {word.split('=')[0]}{nearest(word.split('=')[0], options)}; see --help"
            )
    if not problem or problem == ("",):
        command = click.get_current_context().info_name
        raise RatfitError(f"which problem? give a gallery name, a file or an expression, as in `ratfit {command} eq19`")
    if len(problem) > 1:
        raise RatfitError(f"one problem at a time: {problem[1]!r} is one too many; put an expression in quotes")
    return problem[0]


def _commands() -> list[click.Command]:
    """Every command: an option that is misspelt may be another command's."""
    group = click.get_current_context().find_root().command
    return list(group.commands.values()) if isinstance(group, click.Group) else []


def derived(problem: Problem, options: dict[str, Any]) -> Fit:
    seconds = positive(options["timeout"])
    with waiting(f"deriving {problem.name}, for at most {seconds:g} s (Ctrl-C stops)"):
        return derive_fit(problem, route=options["route"], timeout=seconds, seed=options["seed"])


def numbers(given: Mapping[str, str], *words: str) -> dict[str, Any]:
    """The values of --set as numbers; `words` that stand in place of one are left as they are.

    **Fails** with `RatfitError` for what is no finite real number.
    """
    return {name: text if text in words else finite(text, f"--set {name}") for name, text in given.items()}


def finite(text: str, option: str) -> float:
    """A finite real number from text, as 0.3 or pi/4; `RatfitError`, which names the option, for anything else."""
    value = exact(text, option)
    if not (value.is_number and value.is_real and value.is_finite):
        raise RatfitError(f"{option}: {text} is no finite number; give one, as 0.3 or 1/3")
    return float(value)


def check_places(out: str | None, plot: str | None = None) -> None:
    """Before any work: whether the result and the picture can be written where they are asked to."""
    check_place("--out", out)
    if plot is not None:
        picture_format(plot)
        check_place("--plot", plot)


def write_plot(figure: Any, file: str) -> None:
    """A picture to its file, said on standard error: standard output is the result's."""
    from ratfit.plot.write import write_picture

    write_picture(figure, file)
    print(f"wrote {file}", file=sys.stderr)


def positive(seconds: float) -> float:
    if not 0 < seconds < float("inf"):
        raise RatfitError(f"--timeout must be a positive number of seconds, not {seconds:g}")
    return seconds


def write(text: str, out: str | None) -> None:
    """Results to standard output, or whole to a file."""
    if out is None:
        print(text)
        return
    from ratfit._record import write_text

    write_text(Path(out), text + "\n")
