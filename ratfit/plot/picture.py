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

    @property
    def words(self) -> str:
        """What there is to see, for those who do not: what is drawn over what, the legend, and the worst error."""
        lowest = self.curves if self.strip is None else self.strip
        legend = lowest.get_legend()
        said = [text.get_text() for text in (legend.get_texts() if legend else ())]
        across = " ".join(lowest.get_xlabel().split())
        parts = [self.curves.get_title(), f"{self.curves.get_ylabel()} over {across}", *said]
        if self.strip is not None:
            parts.append(", ".join([f"beneath, {self.strip.get_ylabel()}", *(t.get_text() for t in self.strip.texts)]))
        return "; ".join(filter(None, (" ".join(part.replace("$", "").split()) for part in parts)))

    def _repr_png_(self) -> tuple[bytes, dict[str, str]] | None:
        """The whole figure for a notebook, with its words in place of it.

        Nothing for a figure of pyplot's, which the notebook shows by itself.
        """
        canvas = self.curves.figure.canvas  # of the whole figure, also where the axes stand in a part of it
        if canvas.manager is not None:
            return None
        return drawn(canvas.figure, "png", canvas.figure.dpi), {"alt": self.words}
