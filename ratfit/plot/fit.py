"""The picture of a fit: exact function and fit, its kernel conditions marked, and the error beneath."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ratfit._fit import Fit
from ratfit._parse import RatfitError, shortened
from ratfit.plot.conditions import Page, draw_conditions
from ratfit.plot.curves import ERRORS, FitCurves, Parameters, curves_of, other_formulas
from ratfit.plot.entries import letter, rejection, said
from ratfit.plot.error import (
    PERCENT,
    ROUNDING,
    Unit,
    draw_error,
    draw_error_curve,
    is_rounding,
    worst_text,
    write_worst,
)
from ratfit.plot.labels import exact_text, title_of, x_label
from ratfit.plot.marks import Window
from ratfit.plot.picture import Picture
from ratfit.plot.style import BLACK, BLUE, GREEN, GREY, PURPLE, RED, SERIES, axes_width, dress, legend_below, settings
from ratfit.plot.text import plain, text_depth
from ratfit.plot.view import span

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MANY_TIMES = 8
"""Where the peaks of a family differ more than this, each curve is drawn in parts of its own peak."""

OTHERS = 3
"""Other candidates that are drawn at most."""

_WIDE: dict[str, Any] = {"linewidth": 5.5, "alpha": 0.25, "zorder": 2}


def plot_fit(
    fit: Fit,
    axes: Axes | Sequence[Axes] | None = None,
    *,
    parameters: Parameters | None = None,
    reference: str | None = None,
    error: str = "peak",
) -> Picture:
    """Draws a fit over the domain: the exact function wide and pale, the fit thin, the conditions marked, the error.

    **Arguments:**

    - `axes`: matplotlib's, a pair for curves and error, or one for the curves alone; left out, a new figure. The legend
      stands below them: a constrained layout makes room for it.
    - `parameters`: the value of each by name, or for one of them a list of values, a family of curves. What is left out
      has the middle of its range, which the picture says; where all are, a gallery problem has its card's settings.
    - `reference`: the name of one of the problem's references, which is then the exact function.
    - `error`: the error strip shows `"peak"`, the error in parts of the largest |exact| that is drawn, `"relative"`, in
      parts of |exact|, or the `"absolute"` error. An exact function with a pole has no peak: its strip is relative.

    **Returns** the axes of the curves and of the error, the latter None where there is none, as a pair that is a
    picture in a notebook. Nothing else shows it; `picture.curves.figure.savefig(...)` writes it.

    **Fails** with `RatfitError` where there is no fit, a coefficient is still free, or for a parameter or reference
    that the problem does not have.
    """
    if error not in ERRORS:
        raise RatfitError(f"error={error!r}: a picture shows {', '.join(ERRORS)}")
    curves = curves_of(fit, parameters, reference)
    definition = "relative" if error == "peak" and any(c.has_pole for c in curves) else error
    with settings(axes is None):
        above, below = _axes(axes, has_strip=curves[0].exact is not None)
        notes = _draw_strip(below, fit, curves, definition) if below is not None else []
        handles = _draw_curves(above, fit, curves, reference, notes)
        if below is not None:
            below.set_xlim(above.get_xlim())
        lowest = above if below is None else below
        lowest.set_xlabel(x_label(fit, curves, parameters, axes_width(lowest)))
        legend_below(lowest, handles, is_ours=axes is None)
    return Picture(above, below)


def _axes(given: Axes | Sequence[Axes] | None, has_strip: bool) -> tuple[Axes, Axes | None]:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    if given is None and has_strip:
        above, below = Figure(figsize=(6.6, 4.9), layout="constrained").subplots(2, sharex=True, height_ratios=(5, 2))
        return above, below
    if given is None:
        return Figure(figsize=(6.6, 3.6), layout="constrained").subplots(), None
    if isinstance(given, Axes):
        return given, None
    above, below = _pair(given)
    if not has_strip:
        below.set_axis_off()  # there is nothing exact, and so no error to draw there
    return above, below if has_strip else None


def _pair(given: Any) -> tuple[Axes, Axes]:
    """Two axes that a caller has given. RatfitError for anything else, a file's name above all."""
    from matplotlib.axes import Axes

    if isinstance(given, str | Path):
        keep = f"fit.plot().curves.figure.savefig({str(given)!r})"
        raise RatfitError(f"axes: {str(given)!r} is none of matplotlib's axes; to keep a picture write {keep}")
    found = list(given) if isinstance(given, Iterable) else [given]
    if len(found) != 2 or not all(isinstance(each, Axes) for each in found):
        what = f"{len(found)} of them" if isinstance(given, Iterable) else shortened(repr(given), 60)
        raise RatfitError(f"axes: give matplotlib's, one or a pair for curves and error, not {what}; or leave them out")
    return found[0], found[1]


def _draw_curves(
    axes: Axes, fit: Fit, curves: Sequence[FitCurves], reference: str | None, notes: Sequence[str]
) -> list[Any]:
    """The curves with their conditions; returns the entries of the legend."""
    is_scaled = _is_scaled(curves)
    scales = [1 / curve.peak if is_scaled else 1.0 for curve in curves]
    window = _window(curves, scales)
    axes.set_xlim(window.left, window.right)
    axes.set_ylim(window.bottom, window.top)
    exact = exact_text(fit.problem, reference)
    handles = _draw_lines(axes, curves, scales, exact, notes)
    others = _draw_others(axes, fit, curves[0]) if len(curves) == 1 else []
    handles += [*others, *draw_conditions(Page(axes, window, curves, scales), fit)]
    if curves[0].exact is None:
        handles.append(said(exact))
    axes.set_xlim(window.left, window.right)
    axes.set_ylim(window.bottom, window.top)
    axes.set_ylabel(
        plain(f"{letter(fit.problem)}({fit.problem.variable})" + (", in parts of its peak" if is_scaled else ""))
    )
    title = title_of(fit, 0.95 * axes_width(axes))
    axes.set_title(title, pad=6 + text_depth(title, 11))
    dress(axes)
    return handles


def _is_scaled(curves: Sequence[FitCurves]) -> bool:
    peaks = [curve.peak for curve in curves]
    return min(peaks) > 0 and max(peaks) > MANY_TIMES * min(peaks) and not any(c.has_pole for c in curves)


def _window(curves: Sequence[FitCurves], scales: Sequence[float]) -> Window:
    """The domain with a margin, and the heights of what is known; a fit that leaves them by far is cut."""
    low, high = min(c.places[0] for c in curves), max(c.places[-1] for c in curves)
    heights = [h * scale for curve, scale in zip(curves, scales, strict=True) for h in curve.known.tolist()]
    bottom, top = span(heights, [], any(curve.has_pole for curve in curves))
    fits = [h * scale for curve, scale in zip(curves, scales, strict=True) for h in curve.fit.tolist()]
    reach = 0.25 * (top - bottom)
    finite = [h for h in fits if math.isfinite(h)] or [bottom]
    room = 0.04 * (top - bottom)
    bottom, top = max(min(bottom, min(finite) - room), bottom - reach), min(max(top, max(finite) + room), top + reach)
    margin = 0.03 * (high - low)
    return Window(low - margin, high + margin, bottom, top)


def _draw_lines(
    axes: Axes, curves: Sequence[FitCurves], scales: Sequence[float], exact: str, notes: Sequence[str]
) -> list[Any]:
    from matplotlib.lines import Line2D

    is_single = len(curves) == 1
    fits = []
    for place, (curve, scale) in enumerate(zip(curves, scales, strict=True)):
        colour, dashes = (BLUE, "-") if is_single else _look(place)
        if curve.exact is not None:
            pale = BLACK if is_single else colour
            axes.plot(
                curve.places, curve.exact * scale, color=pale, linewidth=5.5, alpha=0.25, zorder=2, label="_exact"
            )
        note = f": {notes[place]}" if place < len(notes) else ""
        (line,) = axes.plot(curve.places, curve.fit * scale, color=colour, linestyle=dashes, linewidth=1.6, zorder=3)
        line.set_label(plain("fit" if is_single else f"{curve.label}{note}"))
        fits.append(line)
    if curves[0].exact is None:
        return fits
    return [Line2D([], [], color=BLACK, label=exact, **_WIDE), *fits]


def _look(place: int) -> tuple[str, Any]:
    """Colour and dashes of a curve of a family; beyond the sixth the dashes come in another order."""
    count = len(SERIES)
    return SERIES[place % count][0], SERIES[(place + place // count) % count][1]


def _draw_others(axes: Axes, fit: Fit, curve: FitCurves) -> list[Any]:
    """Other candidates thin, rejected ones dotted, each with why."""
    handles = []
    for place, (candidate, formula) in enumerate(other_formulas(fit)[:OTHERS]):
        heights = curve.drawn(formula, curve.places)
        colour, dashes = ((RED, PURPLE, GREEN)[place], ":") if candidate.reason else (GREY, ("-", "--", "-.")[place])
        (line,) = axes.plot(curve.places, heights, color=colour, linestyle=dashes, linewidth=1.2, zorder=2.5)
        another = plain(f"another answer: {shortened(str(candidate.expression), 50)}")
        line.set_label(rejection(candidate, fit.problem) if candidate.reason else another)
        handles.append(line)
    return handles


def _draw_strip(axes: Axes, fit: Fit, curves: Sequence[FitCurves], definition: str) -> list[str]:
    """The errors; returns for each curve of a family what its worst is, for one is written at its point."""
    variable = fit.problem.variable.name
    axes.set_ylabel(ERRORS[definition])
    dress(axes)
    if len(curves) == 1:
        (curve,) = curves
        unit = _unit(definition, curve)
        draw_error(axes, curve.places, curve.errors(definition), variable=plain(variable), unit=unit)
        return []
    notes, is_flat = [], True
    for place, curve in enumerate(curves):
        (colour, dashes), unit = _look(place), _unit(definition, curve)
        worst = draw_error_curve(axes, curve.places, curve.errors(definition), colour=colour, dashes=dashes, unit=unit)
        notes.append(worst_text(worst, variable=variable, unit=unit))
        is_flat = is_flat and is_rounding(worst, unit)
    if is_flat:
        low, high = min(c.places[0] for c in curves), max(c.places[-1] for c in curves)
        write_worst(axes, max(notes, key=len), ((low + high) / 2, 0.0), 0.5)
    return notes


def _unit(definition: str, curve: FitCurves) -> Unit:
    """Percent of what the error is a part of; a difference is rounding beside the peak of its curve."""
    return Unit(1, "", ROUNDING * curve.peak) if definition == "absolute" else PERCENT
