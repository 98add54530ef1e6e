"""The error strip: how far a fit is off over its domain, with the worst point marked and its value beside it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ratfit.plot.style import BLUE, GREY
from ratfit.plot.text import significant

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ROUNDING = 1e-14
"""Relative errors below this are float64's own rounding, and say nothing of the fit."""


@dataclass(frozen=True)
class Unit:
    """How an error is written, and what is no error but rounding: `rounding` is in the errors' own measure."""

    factor: float
    suffix: str
    rounding: float

    def written(self, error: float, digits: int) -> str:
        return f"{significant(self.factor * error, digits)}{self.suffix}"


PERCENT, PLAIN = Unit(100, " %", ROUNDING), Unit(1, "", 0.0)
"""Units of an error: a part of something, shown in percent, or a difference as it is."""

NEAR = 5e-5
"""Nearer to an end than this, in parts of the range, a place is called that end's."""

_NEEDED = 22
"""Points of height that the text at the worst point takes, with its distances."""


@dataclass(frozen=True)
class Worst:
    """The place of the largest finite error between two ends, and that error, signed; nan where none is finite."""

    place: float
    error: float
    ends: tuple[float, float]

    @property
    def where(self) -> str:
        """The words "at", or "near" beside an end, and a number with as many digits as tell it from the ends."""
        low, high = self.ends
        for end in self.ends:
            if 0 < abs(self.place - end) < NEAR * (high - low):
                return f"near {{}}{significant(end, 3)}"
        digits = next(d for d in range(2, 18) if d == 17 or self._differs(float(f"{self.place:.{d - 1}e}")))
        return f"at {{}}{significant(self.place, digits)}"

    def _differs(self, rounded: float) -> bool:
        return self.place in self.ends or rounded not in self.ends


def worst_of(places: Sequence[float], errors: Sequence[float]) -> Worst:
    known = [(abs(e), p, e) for p, e in zip(places, errors, strict=True) if math.isfinite(e)]
    if not known:
        return Worst(math.nan, math.nan, (math.nan, math.nan))
    _, place, error = max(known, key=lambda found: found[0])
    return Worst(float(place), float(error), (float(min(places)), float(max(places))))


def worst_text(worst: Worst, *, variable: str = "", unit: Unit = PERCENT) -> str:
    """The words "worst 1.9 % at v = 0.31"; two digits of the error, for it is known at drawn points alone."""
    if not math.isfinite(worst.error):
        return "no finite error"
    if is_rounding(worst, unit):
        return "no error beyond float64's rounding" if worst.error else "no error"
    return f"worst {unit.written(worst.error, 2)} {worst.where.format(f'{variable} = ' if variable else '')}"


def is_rounding(worst: Worst, unit: Unit) -> bool:
    """Whether the largest error is none, or float64's rounding alone: its curve would be noise."""
    return worst.error == 0 or abs(worst.error) < unit.rounding


def draw_error(
    axes: Axes,
    places: Sequence[float],
    errors: Sequence[float],
    *,
    colour: str = BLUE,
    label: str = "",
    dashes: Any = "-",
    width: float = 1.4,
    mark: float = 5.0,
    variable: str = "",
    unit: Unit = PERCENT,
) -> None:
    """Draws an error curve over a zero line, marks its worst point, and writes the value beside it, clear of the curve.

    Arguments: `axes`, those of the strip; `places` and signed `errors`, nan for a gap; `label`, the curve's in a
    legend; `width` of the line and size of the `mark`, in points; `variable`, the name in the text; `unit`, PERCENT
    where the errors are parts (0.019 is written 1.9 %), PLAIN where they are differences. Errors that are rounding
    alone are a flat line, and the text says so. For several curves in one strip see `draw_error_curve`: their texts
    would meet.
    """
    worst = draw_error_curve(
        axes, places, errors, colour=colour, label=label, dashes=dashes, width=width, mark=mark, unit=unit
    )
    if not math.isfinite(worst.error):
        return
    low, high = min(places), max(places)
    text = worst_text(worst, variable=variable, unit=unit)
    if is_rounding(worst, unit):
        write_worst(axes, text, ((low + high) / 2, 0.0), 0.5)
    else:
        write_worst(axes, text, (worst.place, worst.error), (worst.place - low) / (high - low or 1))


def write_worst(axes: Axes, text: str, point: tuple[float, float], share: float) -> None:
    """A text beside a point that lies at a share of the strip's width, above what is positive and below what is not."""
    error = point[1]
    axes.annotate(
        text,
        point,
        xytext=(0, 6 if error >= 0 else -6),
        textcoords="offset points",
        ha="left" if share < 0.25 else "right" if share > 0.75 else "center",
        va="bottom" if error >= 0 else "top",
        fontsize="small",
        annotation_clip=False,
    )
    _make_room(axes)


def draw_error_curve(
    axes: Axes,
    places: Sequence[float],
    errors: Sequence[float],
    *,
    colour: str = BLUE,
    label: str = "",
    dashes: Any = "-",
    width: float = 1.4,
    mark: float = 5.0,
    unit: Unit = PERCENT,
) -> Worst:
    """The same without the text: returns the worst point, for `worst_text` in a legend."""
    worst = worst_of(places, errors)
    is_noise = is_rounding(worst, unit)
    heights = [0.0 if math.isfinite(e) else math.nan for e in errors] if is_noise else errors
    axes.axhline(0, color=GREY, linewidth=0.8, zorder=1)
    axes.plot(places, heights, color=colour, linestyle=dashes, linewidth=width, label=label or "_error", zorder=2)
    if math.isfinite(worst.error) and not is_noise:
        axes.plot([worst.place], [worst.error], "o", color=colour, markersize=mark, clip_on=False, zorder=4)
    _set_ticks(axes, unit)
    _make_room(axes)
    return worst


def _set_ticks(axes: Axes, unit: Unit) -> None:
    from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator

    several = MaxNLocator(nbins=4, steps=[1, 2, 2.5, 5, 10], min_n_ticks=3)
    axes.yaxis.set_major_locator(FixedLocator([0]) if _is_flat(axes) else several)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: unit.written(value, 3)))


def _is_flat(axes: Axes) -> bool:
    """Whether all lines are zero: there is no scale then. matplotlib's own limits are off by a rounding."""
    return not any(height for line in axes.lines for height in line.get_ydata() if math.isfinite(height))  # type: ignore[arg-type,union-attr]


def _make_room(axes: Axes) -> None:
    """Heights that hold all curves, and beyond the worst points the texts written there."""
    low, high = (-1.0, 1.0) if _is_flat(axes) else axes.dataLim.intervaly
    points = 72 * axes.get_window_extent().height / axes.figure.dpi
    sides = {text.xy[1] >= 0 for text in axes.texts}  # type: ignore[attr-defined]  # annotations, ours
    share = min(_NEEDED / points, 0.4)
    above, below = (share if side in sides else 0.07 for side in (True, False))
    unit = (high - low) / (1 - above - below)
    axes.set_ylim(low - below * unit, high + above * unit)
