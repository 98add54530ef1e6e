"""The light above the horizon in panels that grow fine where a lobe may be narrow: by its half vectors, or by itself.

A half vector has a polar angle theta about the normal and an azimuth phi counted from the view's. The light is above
the horizon for theta below `horizon`, a smooth boundary, so an integral over the light becomes one over a rectangle.
Panels are graded: toward theta = 0, where lobes of facets have their peak; toward the horizon of the light; and toward
the azimuths across and along the view and along the axes of the surface, where boundary and elliptical lobes turn fast.
By the light's own angles, what depends on them alone has its kinks on the edges of panels (a threshold of the azimuth,
the greater of two angles), but lobes are not followed.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

PEAK, EDGE, TURN = 10.0, 5.0, 6.0
"""Powers of e between the finest step and the length of a panel: toward theta = 0, the horizon, and an azimuth."""

EVEN = 1.0
"""The same for panels of the light's own angles: hardly any grading."""


@dataclass(frozen=True)
class Panel:
    """An interval from `foot` to `foot + reach`, run through by y from 0 to 1 with steps that grow from the foot on."""

    foot: Any
    reach: Any
    folds: float

    def place(self, y: Any) -> Any:
        return self.foot + self.reach * np.sinh(self.folds * y) / math.sinh(self.folds)

    def slope(self, y: Any) -> Any:
        """How fast the place moves with y; positive, whichever way the panel goes."""
        return np.abs(self.reach) * self.folds * np.cosh(self.folds * y) / math.sinh(self.folds)

    def inverse(self, place: Any) -> Any:
        return np.arcsinh((place - self.foot) / self.reach * math.sinh(self.folds)) / self.folds


def azimuth_panels(azimuth: float, whole: bool, folds: float = TURN) -> tuple[Panel, ...]:
    """Panels of phi over the circle, or over the half of it that the plane of view bounds.

    `azimuth` is the view's against the tangent, in radians.
    """
    quarters = {k * math.pi / 2 for k in range(5)}
    axes = {(k * math.pi / 2 - azimuth) % (2 * math.pi) for k in range(4)}
    end = 2 * math.pi if whole else math.pi
    marks: list[float] = []
    for mark in sorted(quarters | axes):
        if mark <= end + 1e-9 and (not marks or mark - marks[-1] > 1e-9):
            marks.append(mark)
    return tuple(Panel(foot, (low + high) / 2 - foot, folds) for low, high in pairwise(marks) for foot in (low, high))


def polar_panels(edge: Any) -> tuple[Panel, Panel]:
    """Panels of theta from 0 to the horizon `edge`."""
    return Panel(0.0, edge / 2, PEAK), Panel(edge, -edge / 2, EDGE)


def horizon(cosine: Any, phi: Any) -> Any:
    """The theta at which the light is at the horizon, where 2 (V.H) (N.H) = N.V."""
    return np.arctan2(cosine, -np.sqrt((1 - cosine) * (1 + cosine)) * np.cos(phi)) / 2


def views(cosines: Any, azimuth: float) -> Any:
    """Unit directions with these cosines to the normal, in one plane through it."""
    cosines = np.asarray(cosines, float)
    sines = np.sqrt((1 - cosines) * (1 + cosines))
    return np.stack([sines * math.cos(azimuth), sines * math.sin(azimuth), cosines], axis=-1)


def lights(view: Any, theta: Any, phi: Any, azimuth: float) -> tuple[Any, Any]:
    """The light of each half vector, and the solid angle of light to that of (theta, phi), 4 (V.H) sin(theta)."""
    half = _direction(theta, phi + azimuth)
    u = np.sum(view * half, axis=-1)
    return 2 * u[..., None] * half - view, 4 * u * np.sin(theta)


def _direction(theta: Any, phi: Any) -> Any:
    sine = np.sin(theta)
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), np.cos(theta) + 0 * phi], axis=-1)


@dataclass(frozen=True)
class Nodes:
    """Directions of light for each view, of shape (views, nodes, 3), and their weights in steradians."""

    light: Any
    weight: Any


def facet_nodes(cosines: Any, azimuth: float, order: int, whole: bool) -> Nodes:
    """Gauss nodes of every panel of half vectors, for the views with these cosines.

    `order` nodes along the azimuth, and along theta as it needs. The weights of a view add up to 2 pi. Where not
    `whole`, the half circle counts twice: for what is the same on both sides of the plane of view.
    """
    column = np.asarray(cosines, float)[:, None, None]
    view = views(cosines, azimuth)[:, None, None, :]
    parts = []
    y_phi, w_phi = unit_gauss(order)
    for around in azimuth_panels(azimuth, whole):
        phi = around.place(y_phi)[None, :, None]
        across = (w_phi * around.slope(y_phi))[None, :, None] * (1 if whole else 2)
        for panel, count in zip(polar_panels(horizon(column, phi)), (3 * order, order), strict=True):
            y, w = unit_gauss(count)
            light, stretch = lights(view, panel.place(y), phi, azimuth)
            parts.append((light, across * w * panel.slope(y) * stretch))
    return _joined(parts)


def light_nodes(cosines: Any, azimuth: float, order: int, whole: bool) -> Nodes:
    """The same along the angles of the light, with edges at the view's own angle to the normal."""
    tilt = np.arccos(np.asarray(cosines, float))[:, None, None]
    parts = []
    y_phi, w_phi = unit_gauss(order)
    for around in azimuth_panels(azimuth, whole, EVEN):
        phi = around.place(y_phi)[None, :, None]
        across = (w_phi * around.slope(y_phi))[None, :, None] * (1 if whole else 2)
        for panel in (Panel(tilt, -tilt, EVEN), Panel(tilt, math.pi / 2 - tilt, EVEN)):
            y, w = unit_gauss(2 * order)
            theta = panel.place(y)
            light = _direction(theta, phi + azimuth)
            parts.append((light, across * w * panel.slope(y) * np.sin(theta)))
    return _joined(parts)


def _joined(parts: Sequence[tuple[Any, Any]]) -> Nodes:
    light = np.concatenate([each.reshape(len(each), -1, 3) for each, _ in parts], axis=1)
    return Nodes(light, np.concatenate([weight.reshape(len(weight), -1) for _, weight in parts], axis=1))


@functools.cache
def unit_gauss(order: int) -> tuple[Any, Any]:
    """Gauss's nodes and weights on [0, 1], not to be written to: they are kept."""
    nodes, weights = np.polynomial.legendre.leggauss(order)
    made = (nodes + 1) / 2, weights / 2
    for each in made:
        each.flags.writeable = False
    return made


def coordinates(view: Any, light: Any, azimuth: float) -> tuple[Any, Any, Any]:
    """theta, phi in [0, 2 pi) and the horizon there of pairs of directions: what `lights` came from."""
    half = view + light
    theta = np.arctan2(np.hypot(half[..., 0], half[..., 1]), half[..., 2])
    phi = (np.arctan2(half[..., 1], half[..., 0]) - azimuth) % (2 * math.pi)
    return theta, phi, horizon(view[..., 2], phi)


def panel_of(panels: Sequence[Panel], place: Any) -> Any:
    """The number of the panel that a place lies in; panels follow each other in pairs from foot to foot."""
    ends = [max(panel.foot, panel.foot + panel.reach) for panel in panels]
    return np.minimum(np.searchsorted(ends, place), len(panels) - 1)
