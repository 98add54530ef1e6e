"""The command line: parse, call, print; no mathematics. One file for each command or group of kindred ones."""

from __future__ import annotations

import gc
import sys

import click

import ratfit
from ratfit._parse import RatfitError
from ratfit.cli.claims import claims
from ratfit.cli.derive import derive
from ratfit.cli.measure import bench, paper, report
from ratfit.cli.model import check_model
from ratfit.cli.problems import check, gallery, init
from ratfit.cli.study import study


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
        kept = "; rows that were written are kept, --resume goes on" if sys.argv[1:2] in (["bench"], ["paper"]) else ""
        print(f"\nratfit: interrupted{kept}", file=sys.stderr)
        sys.exit(130)
    except (BrokenPipeError, SystemExit):  # the reader, `head` say, has seen enough; click ends by itself then, with 1
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
    ratfit check-model schlick-24-30  the laws of a whole reflectance model
    ratfit claims S                   what the 1994 paper states, decided
    ratfit gallery                    every problem that comes with ratfit
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help())


for _command in (derive, study, bench, paper, report, gallery, init, check, claims, check_model):
    cli.add_command(_command)
