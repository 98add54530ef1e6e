"""`python -m paper_figures`: all figures, or some, as SVG, PDF and PNG; captions on standard output."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from paper_figures import style
from paper_figures.figures import FIGURES, drawn, named
from paper_figures.write import FORMATS, write_figure
from ratfit._parse import RatfitError

MADE = Path(__file__).parent / "made"


def main(arguments: list[str] | None = None) -> None:
    """Runs the command. Exit 0: done; 2: bad input, one line; 130: interrupted, nothing half-written."""
    try:
        figures.main(arguments, prog_name="python -m paper_figures", standalone_mode=False)
    except (RatfitError, click.UsageError) as error:
        text = error.format_message() if isinstance(error, click.UsageError) else str(error)
        print("paper_figures: " + " ".join(text.split()), file=sys.stderr)
        sys.exit(2)
    except (KeyboardInterrupt, click.Abort):
        print("\npaper_figures: interrupted; the files already written are whole", file=sys.stderr)
        sys.exit(130)


@click.command(context_settings={"help_option_names": ["--help"]})
@click.argument("names", nargs=-1)
@click.option("--out", type=click.Path(path_type=Path), default=MADE, help="Folder; made where it is missing.")
@click.option("--format", "formats", multiple=True, type=click.Choice(FORMATS), help="Repeatable; all three left out.")
@click.option(
    "--width",
    type=click.IntRange(style.LEAST, style.MOST),
    default=int(style.PAGE),
    help="In mm: 170 a page, 85 a column.",
)
def figures(names: tuple[str, ...], out: Path, formats: tuple[str, ...], width: int) -> None:
    """Draws Figures 4 to 8 of the 1994 paper and README's picture, and prints their captions.

    NAMES are names of figures or their beginnings; all are drawn where none is given.

    \b
    python -m paper_figures                             all figures, into paper_figures/made
    python -m paper_figures figure6 --width 85          one, for a column of a paper
    python -m paper_figures --out docs/figures --format svg
    """
    chosen = [named(name) for name in names] or list(FIGURES)
    _make_folder(out)
    for number, name in enumerate(chosen, 1):
        print(f"{name} ({number} of {len(chosen)})", file=sys.stderr)
        figure, caption = drawn(name, width)
        for written in write_figure(figure, caption, out / name, formats or FORMATS):
            print(f"  {written}", file=sys.stderr)
        print(f"{name}: {caption}\n")


def _make_folder(out: Path) -> None:
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as refused:
        raise RatfitError(f"--out {out}: {refused.strerror}; name a folder that can be written to") from None


if __name__ == "__main__":
    main()
