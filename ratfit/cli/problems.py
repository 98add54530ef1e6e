"""`ratfit gallery`, `init` and `check`: problems to look at and to begin with."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click

from ratfit._parse import RatfitError
from ratfit.cli.place import check_place
from ratfit.gallery import card, find_problem


@click.command(short_help="List the problems of the gallery.")
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


@click.command(short_help="Write a problem file to start from.")
@click.argument("file", type=click.Path())
def init(file: str) -> None:
    """Write a commented problem file to start from; a file that exists is left alone.

    \b
    ratfit init my.toml && ratfit check my.toml && ratfit derive my.toml
    """
    from importlib.resources import files

    from ratfit._record import write_text

    check_place("init", file)
    if Path(file).exists():
        raise RatfitError(f"{file} exists and is left alone; give another name")
    write_text(Path(file), (files("ratfit.gallery") / "template.txt").read_text("utf-8"))
    print(f"wrote {file}; next: ratfit check {file}", file=sys.stderr)


@click.command(short_help="Say what a problem means.")
@click.argument("file", metavar="PROBLEM", type=click.Path())
def check(file: str) -> None:
    """Say what a problem file, or a gallery name, was understood to mean.

    \b
    ratfit check my.toml
    """
    from ratfit.report.text import problem_text

    print(problem_text(find_problem(file)))
