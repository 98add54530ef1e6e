"""Which figures there are."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING

from paper_figures import (
    figure4_sine,
    figure5_fresnel,
    figure6_smith,
    figure7_beckmann,
    figure8_zenith_and_azimuth,
    readme_picture,
)
from ratfit._parse import RatfitError, nearest

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FIGURES: dict[str, ModuleType] = {
    module.__name__.rpartition(".")[2]: module
    for module in (
        figure4_sine,
        figure5_fresnel,
        figure6_smith,
        figure7_beckmann,
        figure8_zenith_and_azimuth,
        readme_picture,
    )
}
"""Name -> the module with `data`, `draw` and `caption`; a file of that name is written."""


def drawn(name: str, width: float) -> tuple[Figure, str]:
    """A figure of this width in mm, and its caption."""
    module = FIGURES[name]
    found = module.data()
    return module.draw(found, width), module.caption(found)


def named(beginning: str) -> str:
    """The name of a figure from its beginning, "figure6" say. RatfitError where none or several begin so."""
    found = [name for name in FIGURES if name.startswith(beginning)] if beginning else []
    if len(found) == 1:
        return found[0]
    about = f"{beginning!r} is the beginning of several" if found else f"no figure {beginning!r}"
    raise RatfitError(f"{about}{'' if found else nearest(beginning, list(FIGURES))}; there are: {', '.join(FIGURES)}")
