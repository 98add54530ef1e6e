"""What a fit's picture is made of; it shows itself in a notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ratfit.plot.write import drawn

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Picture(NamedTuple):
    """The axes of a fit's picture: of the curves, and of the error beneath them, None where there is none."""

    curves: Axes
    strip: Axes | None

    def _repr_png_(self) -> bytes | None:
        """The whole figure for a notebook; nothing for one of pyplot's, which the notebook shows by itself."""
        canvas = self.curves.figure.canvas  # of the whole figure, also where the axes stand in a part of it
        if canvas.manager is not None:
            return None
        return drawn(canvas.figure, "png", canvas.figure.dpi)
