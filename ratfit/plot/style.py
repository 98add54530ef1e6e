"""What pictures share: colours, a figure of their own, a legend that covers no data, and how texts are set."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import sympy as sp

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Okabe and Ito's colours, which the colour-blind tell apart; shapes and dashes differ too, so that grey print serves.
BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, RED, PURPLE, GREY = "#0072B2", "#D55E00", "#CC79A7", "#666666"

SERIES: Sequence[tuple[str, Any]] = (
    (BLUE, "-"),
    (RED, (0, (6, 1.6))),
    (GREEN, (0, (6, 1.6, 1.2, 1.6))),
    (PURPLE, (0, (2.4, 1.2))),
    (ORANGE, (0, (9, 1.6, 1.2, 1.6, 1.2, 1.6))),
    (SKY, (0, (1.2, 1.2))),
)
"""Colour and dashes of the curves of a family, in order."""

SETTINGS = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 10,
    "axes.titlesize": 11,
    "axes.labelsize": 10,
    "xtick.labelsize": 9,
    "ytick.labelsize": 9,
    "legend.fontsize": 9,
    "mathtext.fontset": "dejavusans",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "svg.fonttype": "path",  # the same picture wherever it is opened, whatever fonts there are
    "svg.hashsalt": "ratfit",
    "pdf.fonttype": 42,
}
"""matplotlib's settings for figures of our own; on axes that are given, their owner's hold."""

LETTERS = 62
"""Letters of an entry below a picture."""


@contextmanager
def settings(are_ours: bool = True) -> Iterator[None]:
    """SETTINGS while a figure of our own is drawn or written; afterwards all is as it was."""
    import matplotlib

    with matplotlib.rc_context(SETTINGS if are_ours else {}):  # type: ignore[arg-type]
        yield


def dress(axes: Axes) -> None:
    """What all our axes wear: a light grid, and no box."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(alpha=0.25, linewidth=0.6)


def legend_below(axes: Axes, handles: Sequence[Any]) -> None:
    """A legend below the axes and their label, where no data are; a constrained layout makes room for it."""
    from matplotlib.transforms import ScaledTranslation

    if not handles:
        return
    down = ScaledTranslation(0, -38 / 72, axes.figure.dpi_scale_trans)
    axes.legend(
        handles=list(handles),
        loc="upper center",
        bbox_to_anchor=(0.5, 0),
        bbox_transform=axes.transAxes + down,
        ncols=1 if any(text_width(str(h.get_label()), 9) > 225 for h in handles) else 2,
        frameon=False,
        borderaxespad=0,
    )


def shortened(text: str, letters: int) -> str:
    """The text, or of a long one its beginning."""
    return text if len(text) <= letters else text[: letters - 2].rstrip(" ,") + " …"


def plain(text: str) -> str:
    """A text in which matplotlib sees no mathematics."""
    return text.replace("$", r"\$")


def mathematics(expression: sp.Expr) -> str | None:
    """An expression as matplotlib sets mathematics, without its dollars; None for what it cannot set."""
    return _settable(sp.latex(rounded(expression)).replace(r"\frac", r"\dfrac"))


def on_a_line(expression: sp.Expr) -> str | None:
    """The same with a fraction written as pi/2 is, for a line of text: set upright it would need smaller type."""
    above, below = sp.fraction(rounded(expression))
    if below == 1:
        return mathematics(expression)
    bracketed = [_bracketed(above, above.is_Add), _bracketed(below, below.is_Add or below.is_Mul)]
    return _settable("/".join(bracketed).replace(r"\frac", r"\dfrac"))


def _bracketed(expression: sp.Expr, is_needed: bool) -> str:
    written = sp.latex(expression)
    return rf"\left({written}\right)" if is_needed else written


def _settable(written: str) -> str | None:
    from matplotlib.mathtext import MathTextParser

    try:
        MathTextParser("path").parse(f"${written}$")
    except ValueError:  # cases, and other environments of LaTeX
        return None
    return written


def rounded(expression: sp.Expr) -> sp.Expr:
    """The expression with its decimals cut to four digits, for the eye."""
    return expression.xreplace({number: sp.Float(number, 4) for number in expression.atoms(sp.Float)})


def text_width(text: str, size: float) -> float:
    """The width in points of a text at a size in points, mathematics between dollars set as such."""
    return _measured(text, size).width


def text_depth(text: str, size: float) -> float:
    """How far below its line a text reaches, in points."""
    return _measured(text, size).depth


def _measured(text: str, size: float) -> Any:
    from matplotlib.font_manager import FontProperties
    from matplotlib.mathtext import MathTextParser

    return MathTextParser("path").parse(text, 72, FontProperties(family="DejaVu Sans", size=size))


def significant(number: float, digits: int) -> str:
    """A number to so many digits: "1.9", "120", "3.1e-7", with a true minus."""
    short = float(f"{number:.{digits - 1}e}")
    text = f"{short:.{digits}g}" if not 1e-4 <= abs(short) < 1e5 else f"{short:g}"
    mantissa, _, power = text.partition("e")
    return (mantissa + (f"e{int(power)}" if power else "")).replace("-", "−")
