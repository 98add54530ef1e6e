"""The picture of a checked model: its albedo over the angle of the view, against what a surface can reflect."""

from __future__ import annotations

from collections.abc import Mapping
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np

from ratfit._parse import shortened
from ratfit.models.albedo import Albedo
from ratfit.models.check import Check
from ratfit.plot.style import BLACK, BLUE, LETTERS, RED, dress, legend_below, settings
from ratfit.plot.text import plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TOP = 1.6
"""The greatest albedo that is drawn, but for a curve that is above it everywhere: some grow beyond all bounds."""

NO_BREAK = "\N{NO-BREAK SPACE}"


def plot_albedo(check: Check, axes: Axes | None = None) -> Axes:
    """Draws the albedo of a checked model over the angle of the view.

    **Arguments:** `check`; `axes`, matplotlib's, on a figure of their own where left out. Returns the axes; nothing is
    shown. The line is the quadrature at the setting shown, dots with bars the samples and two standard deviations, the
    dashed line the brightest setting that was found. Above 1 the ground is shaded: no surface gets there. What is above
    the picture is cut, and said on the axis.
    """
    is_ours = axes is None
    with settings(is_ours):
        axes = axes if axes is not None else _new_axes()
        _draw(axes, check, is_ours)
    return axes


def _new_axes() -> Axes:
    from matplotlib.figure import Figure

    return Figure(figsize=(6.6, 4.2), layout="constrained").subplots()


def _draw(axes: Axes, check: Check, is_ours: bool) -> None:
    bright = check.brightest
    greatest = max(map(_greatest, _both(check)))
    least = max(float(np.min(each.values, initial=np.inf, where=each.values >= 0)) for each in _both(check))
    top = 1.05 * min(max(1.0, greatest), max(TOP, 1.5 * least if np.isfinite(least) else 0)) + 0.02
    axes.axhspan(1, max(top, 1.1), color=RED, alpha=0.08, linewidth=0)
    axes.axhline(1, color=RED, linewidth=0.8)
    (worst,) = axes.plot(*_curve(bright.albedo), color=BLUE, linestyle=(0, (6, 1.6)), linewidth=1.4)
    worst.set_label(_label("brightest found", bright.setting, bright.azimuth))
    (line,) = axes.plot(*_curve(check.albedo), color=BLACK, linewidth=1.6)
    line.set_label(_label("albedo", check.setting))
    seen = np.isfinite(check.samples.values) & np.isfinite(check.samples.errors) & (check.samples.values < top)
    dots = axes.errorbar(
        _degrees(check.samples)[seen],
        check.samples.values[seen],
        2 * check.samples.errors[seen],
        fmt="o",
        color=BLACK,
        markersize=4,
        markerfacecolor="white",
        linewidth=1,
        capsize=2,
        label="by samples, two standard deviations",
    )
    cut = f"   (cut: up to {greatest:.3g})" if greatest > top else ""
    axes.set_xlim(0, 90)
    axes.set_ylim(0, max(top, 1.1))
    axes.set_xticks(range(0, 91, 15))
    axes.set_xlabel("angle of the view to the normal, degrees")
    axes.set_ylabel(f"directional albedo{cut}")
    axes.set_title(plain(shortened(check.model.name, 80)))
    dress(axes)
    legend_below(axes, [line, worst, dots], is_ours)


def _both(check: Check) -> tuple[Albedo, Albedo]:
    return check.albedo, check.brightest.albedo


def _curve(albedo: Albedo) -> tuple[Any, Any]:
    return _degrees(albedo), np.where(np.isfinite(albedo.values), albedo.values, np.nan)


def _degrees(albedo: Albedo) -> Any:
    return np.degrees(np.arccos(np.clip(albedo.cosines, -1, 1)))


def _greatest(albedo: Albedo) -> float:
    return float(np.max(albedo.values, initial=0.0, where=~np.isnan(albedo.values)))


def _label(what: str, setting: Mapping[str, float], azimuth: float = 0.0) -> str:
    """What a curve is and at which setting, in as many lines as it takes; between lines no value is torn."""
    angle = [f"view's azimuth {np.degrees(azimuth):.3g} degrees"] if azimuth else []
    said = [*angle, *(f"{name} = {value:.3g}" for name, value in setting.items())]
    values = ", ".join(each.replace(" ", NO_BREAK) for each in said)
    lines = wrap(f"{what}: {values}" if values else what, LETTERS, break_on_hyphens=False)
    return plain("\n".join(lines).replace(NO_BREAK, " "))
