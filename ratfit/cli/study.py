"""`ratfit study`."""

from __future__ import annotations

from typing import Any

import click

from ratfit._inline import Words, target_of_words
from ratfit._parse import RatfitError
from ratfit._target import Target
from ratfit.cli.options import WORDS, check_pair, check_places, one_word, positive, write, write_plot
from ratfit.gallery import card, find_problem, is_known
from ratfit.report.progress import waiting

TARGET_HELP = """TARGET is looked up as a gallery name (`ratfit gallery`), then as a problem file (it ends in .toml or
exists), then read as an expression that --on completes."""


@click.command(short_help="Say what is exact about a function.", context_settings=WORDS, epilog=TARGET_HELP)
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

    check_places(options["out"], options["plot"])
    studied, seconds = _read_target(target, options), positive(options["timeout"])
    with waiting(f"studying {studied.expression}, for at most {seconds:g} s (Ctrl-C stops)"):
        found = study_target(studied, timeout=seconds)
    if options["plot"] is not None:
        from ratfit.plot import plot_study

        write_plot(plot_study(found).figure, options["plot"])
    written = {"text": study_text, "json": study_json, "toml": study_toml}[options["format_"]](found)
    write(written.rstrip("\n"), options["out"])
    return 0


def _read_target(words: tuple[str, ...], options: dict[str, Any]) -> Target:
    """The target that the words of `study` name: of a card, of a file, or an expression with its domain."""
    from ratfit._study.study import target_of

    check_pair("on", options["on"])
    text = one_word(words)
    stated = Words(**{k: options[k] for k in ("on", "variable", "parameter", "let")})
    if is_known(text) and stated.given():
        raise RatfitError(f"--{stated.given()[0]} completes an expression; {text} is a whole problem, leave it out")
    if is_known(text):
        return target_of(find_problem(text))
    if not stated.given() and text.replace("-", "").replace("_", "").isalnum():
        return target_of(card(text).problem)  # a lone word that is no name: the error offers the nearest names
    return target_of_words(text, stated)
