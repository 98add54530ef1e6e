"""`ratfit claims`."""

from __future__ import annotations

import click

from ratfit.cli.options import check_places, write
from ratfit.report.progress import waiting

CLAIMS_HELP = """WORDS are ids (S-28-A), how ids begin (S-4.2), or documents by their letters or names: S (schlick1994),
DP (microfacet), PM (polimi2024), SM (smoothie); without any, all claims."""


@click.command(short_help="Decide what the sources claim.", epilog=CLAIMS_HELP)
@click.argument("words", nargs=-1)
@click.option("--format", "format_", default="text", type=click.Choice(["text", "json", "markdown"]), show_default=True)
@click.option("--measure", is_flag=True, help="Time this machine for the claims on speed; some minutes.")
@click.option("--out", type=click.Path(), metavar="FILE", help="Write the result there.")
def claims(words: tuple[str, ...], format_: str, measure: bool, out: str | None) -> int:
    """Decide the statements of the sources by computing them: reproduced, under a reading, wrong, or undecided.

    \b
    ratfit claims                     all of them, in a minute or so
    ratfit claims S-28-A S-4.2-F2     two of them
    ratfit claims PM --format json    those of one source
    """
    from ratfit.claims import decide, selected
    from ratfit.report.claims import claims_json, claims_markdown, claims_text

    check_places(out)
    chosen = selected(words)
    decisions = []
    for number, claim in enumerate(chosen, 1):
        with waiting(f"{number}/{len(chosen)}: deciding {claim.id} (Ctrl-C stops)"):
            decisions.append(decide(claim, measure=measure))
    written = {"text": claims_text, "json": claims_json, "markdown": claims_markdown}[format_](decisions)
    write(written, out)
    return 0
