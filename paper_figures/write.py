"""A figure as files, each whole or not at all, the same bytes for the same figure, its caption inside."""

from __future__ import annotations

import re
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from paper_figures import style
from ratfit._record import write_bytes
from ratfit.plot.write import quiet_fonts

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS = ("svg", "pdf", "png")

DOTS = 300
"""Dots an inch of a PNG: what is asked for in print."""

_PATH = re.compile(rb' d="[^"]*"')
_INDENTATION = re.compile(rb"\n +")
_DECIMALS = re.compile(rb"-?\d+\.\d{3,}")


def write_figure(figure: Figure, caption: str, stem: Path, formats: Sequence[str] = FORMATS) -> list[Path]:
    """Writes a figure as `stem.svg` and so on; returns the paths.

    **Fails** with `RatfitError` for a folder that is missing or may not be written to.
    """
    import matplotlib

    written = []
    for suffix in formats:
        drawn = BytesIO()
        with matplotlib.rc_context(style.settings(25.4 * figure.get_figwidth())), quiet_fonts():
            figure.savefig(drawn, format=suffix, dpi=DOTS, metadata=_metadata(suffix, stem.name, caption))
        path = stem.with_name(f"{stem.name}.{suffix}")
        write_bytes(path, _shortened(drawn.getvalue()) if suffix == "svg" else drawn.getvalue())
        written.append(path)
    return written


def _shortened(svg: bytes) -> bytes:
    """Coordinates of curves to a hundredth of a point, and no indentation: nothing that an eye sees."""
    rounded = _PATH.sub(lambda path: _DECIMALS.sub(lambda number: b"%.2f" % float(number[0]), path[0]), svg)
    return _INDENTATION.sub(b"\n", rounded)


def _metadata(suffix: str, name: str, caption: str) -> dict[str, Any]:
    """The caption under each format's key, and nothing of the moment the file was made in."""
    if suffix == "svg":
        return {"Title": name, "Description": caption, "Date": None}
    if suffix == "pdf":
        return {"Title": name, "Subject": caption, "CreationDate": None}
    return {"Title": name, "Description": caption}
