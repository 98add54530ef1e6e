"""`ratfit check-model`."""

from __future__ import annotations

from typing import Any

import click

from ratfit._inline import settings_of
from ratfit._parse import RatfitError
from ratfit.cli.options import Number, check_places, numbers, write, write_plot
from ratfit.report.progress import waiting


@click.command("check-model", short_help="Measure whether a reflectance model keeps the laws.")
@click.argument("model", required=False)
@click.option("--set", "fixed", multiple=True, metavar="r=0.3", help="Keep a parameter at a value; the others vary.")
@click.option("--plot", metavar="FILE", help="A picture of the albedo: .svg, .pdf or .png.")
@click.option("--format", "format_", default="text", type=click.Choice(["text", "json"]), show_default=True)
@click.option("--seed", type=Number(), default=0, show_default=True, help="Seed of random directions and settings.")
@click.option("--out", type=click.Path(), metavar="FILE", help="Write the result there.")
def check_model(model: str | None, **options: Any) -> int:
    """Measure the laws of a reflectance model: reciprocity, energy, normalisation, sampling, limits, float32.

    \b
    ratfit check-model                                  the models there are
    ratfit check-model schlick-conserving
    ratfit check-model schlick-24-30 --set r=0.3        more light at grazing angles than it receives
    ratfit check-model ward --set m=0.1 --set n=0.4 --plot albedo.svg
    ratfit check-model cook-torrance --format json

    A law is searched over the ranges of the parameters, those of --set kept: one that holds was not seen to fail.
    Exit status: 0 all laws hold, 1 one fails or is left undecided, 2 bad input.
    """
    from ratfit.models import MODELS, named
    from ratfit.report.model_check import check_json, check_text, models_json, models_text

    check_places(options["out"], options["plot"])
    if options["seed"] < 0:
        raise RatfitError(f"--seed {options['seed']}: give a whole number from 0 on")
    if model is None:
        _only_listed(options)
        write(models_json(MODELS) if options["format_"] == "json" else models_text(MODELS), options["out"])
        return 0
    found, fixed = named(model), numbers(settings_of(options["fixed"]))
    with waiting(f"measuring {model}, for half a minute or so (Ctrl-C stops)"):
        from ratfit.models.check import check

        checked = check(found, fixed, seed=options["seed"])
    if options["plot"] is not None:
        from ratfit.plot.albedo import plot_albedo

        write_plot(plot_albedo(checked).figure, options["plot"])
    write((check_json if options["format_"] == "json" else check_text)(checked), options["out"])
    return 0 if checked.holds else 1


def _only_listed(options: dict[str, Any]) -> None:
    for name, given in (("--set", options["fixed"]), ("--plot", options["plot"])):
        if given:
            raise RatfitError(f"{name} goes with a model: name one, as in `ratfit check-model schlick`")
