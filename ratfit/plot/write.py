"""A figure as a file: SVG, PDF or PNG by its suffix, whole or not at all, and the same bytes for the same figure."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ratfit._parse import RatfitError
from ratfit._record import write_bytes
from ratfit.plot.style import settings

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# What a file would say of the moment it was made in: two runs are then the same to the last byte.
_UNSAID: dict[str, dict[str, Any]] = {
    "svg": {"Date": None},
    "pdf": {"CreationDate": None},
    "png": {},
}

DOTS = 200
"""Dots an inch of a PNG."""


def picture_format(file: str | Path) -> str:
    """The format that a picture's suffix asks for: a command asks before it does any work. RatfitError for others."""
    suffix = Path(file).suffix.lower().removeprefix(".")
    if suffix not in _UNSAID:
        raise RatfitError(f"{file or 'no name'}: name the picture something.svg, something.pdf or something.png")
    return suffix


def write_picture(figure: Figure, file: str | Path) -> None:
    """Writes a figure as its file's suffix says; RatfitError for another suffix and for a place that takes no file."""
    write_bytes(file, drawn(figure, picture_format(file), DOTS))


def drawn(figure: Figure, format_: str, dots: float) -> bytes:
    """A figure as the bytes of a file of a format, with so many dots an inch where it has dots."""
    written = BytesIO()
    with settings(), quiet_fonts():
        figure.savefig(written, format=format_, dpi=dots, metadata=_UNSAID[format_])
    return written.getvalue()


@contextmanager
def quiet_fonts() -> Iterator[None]:
    """fontTools complains of the dates in matplotlib's own fonts, which nobody who writes a PDF can mend."""
    logger = logging.getLogger("fontTools.ttLib.tables._h_e_a_d")
    before = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(before)
