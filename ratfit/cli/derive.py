"""`ratfit derive`."""

from __future__ import annotations

import json
import sys
from typing import Any

import click

from ratfit._fit import Fit
from ratfit._inline import settings_of
from ratfit._parse import RatfitError
from ratfit._problem import Problem
from ratfit._problem_file import problem_of
from ratfit._problem_text import at_parameters, to_tables
from ratfit._target import exact
from ratfit.cli.options import (
    EXPRESSION_HELP,
    WORDS,
    check_places,
    derived,
    problem_options,
    read_problem,
    write,
    write_plot,
)
from ratfit.gallery import Card


@click.command(short_help="Derive a fit from its kernel conditions.", context_settings=WORDS, epilog=EXPRESSION_HELP)
@problem_options
@click.option("--unique", is_flag=True, help="Take a family with free coefficients for a no.")
@click.option("--plot", metavar="FILE", help="A picture of exact function, fit and error: .svg, .pdf or .png.")
@click.option("--reference", metavar="NAME", help="The problem's reference that the picture compares with.")
@click.option("--format", "format_", default="text", type=click.Choice(["text", "json", "latex"]), show_default=True)
def derive(problem: tuple[str, ...], degree: int | None, settings: tuple[str, ...], **options: Any) -> int:
    """Derive the fit of PROBLEM from its kernel conditions.

    \b
    ratfit derive eq19
    ratfit derive eq12 --route polynomial      the paper's own system, with its spurious root
    ratfit derive eq15 --set n=3               another choice of the free exponent
    ratfit derive eq19 --set m=0.3             at one value of the parameter
    ratfit derive my.toml --format json
    ratfit derive eq15 --plot gold.svg --reference gold
    ratfit derive "t**n" --parameter n=1:1000 --on 0 1 --form 1/1 --value 0 --value 1 --derivative 1
    """
    check_places(options["out"], options["plot"])
    if options["reference"] and options["plot"] is None:
        raise RatfitError("--reference says what a picture compares with: give --plot FILE too")
    values = settings_of(settings)
    found, shown = read_problem(problem, degree, options)
    _check_reference(found, options["reference"], values)
    there = _with_settings(found, values)
    if there.parameters != found.parameters:
        shown = None  # what is published has the parameters as symbols
    fit = derived(there, options)
    if options["unique"] and fit.status in ("family", "several"):
        fit = _refused(fit)
    write(rendered(fit, shown, options["format_"]), options["out"])
    if options["plot"] is not None:
        _write_picture(fit, options["plot"], options["reference"])
    for line in fit.advice:
        print(f"ratfit: {line}", file=sys.stderr)
    return 0 if fit.expression is not None else 1


def _write_picture(fit: Fit, file: str, reference: str | None) -> None:
    free = ", ".join(symbol.name for symbol in fit.free if symbol not in fit.choice)
    if fit.expression is None or free:
        why = f"{free} is still free (--set gives it a value)" if free else "there is no fit"
        print(f"ratfit: {why}, and so there is no picture in {file}", file=sys.stderr)
        return
    from ratfit.plot import plot_fit

    write_plot(plot_fit(fit, reference=reference).curves.figure, file)


def _check_reference(problem: Problem, name: str | None, values: dict[str, str]) -> None:
    """Before any work: a picture's reference is one of the problem's, and says some parameters itself."""
    if name is None:
        return
    from ratfit._setting import reference_of

    said = {symbol.name for symbol in reference_of(problem, name).parameters}
    for parameter in said & set(values):
        raise RatfitError(f"the reference {name} says {parameter} itself: leave --set {parameter} out")


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


def _refused(fit: Fit) -> Fit:
    names = ", ".join(map(str, fit.free)) or "a choice among several answers"
    reason = f"--unique: the conditions leave {names} open; add a condition"
    return Fit(fit.problem, fit.status, fit.route, (), fit.rejected, (reason,), fit.equations)


def rendered(fit: Fit, shown: Card | None, format_: str) -> str:
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
