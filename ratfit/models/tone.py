"""From light of any strength to colours that a screen can show, between 0 and 1.

polimi2024 prints the clamp and asks of what else is used that it map light >= 0 into [0, 1]; the two curves are
reinhard2002's. Each takes an array of floats, NumPy or JAX, and returns one of the same shape and dtype; light below 0
counts as 0, infinite light is white, nan stays nan. Where a curve is cut, its gradient is 0.
"""

from __future__ import annotations

import math
from typing import Any

from ratfit._parse import RatfitError
from ratfit.models.directions import as_floats, library

FAINTEST = 1e-30
"""The least light that may be shown as white; float32 still holds it with all its digits."""


def clamp(light: Any) -> Any:
    """0 below 0, 1 above 1, the light itself between (polimi2024, Color range)."""
    light = as_floats(light, "light")
    _, numpy = library(light)
    return numpy.where(light > 1, 1, numpy.where(light < 0, 0, light)).astype(light.dtype)


def reinhard(light: Any) -> Any:
    """light/(1 + light), white for infinite light alone (reinhard2002, Eq. 3)."""
    return reinhard_white(light, math.inf)


def reinhard_white(light: Any, white: float) -> Any:
    """light (1 + light/white^2)/(1 + light), and 1 from the light `white` on (reinhard2002, Eq. 4).

    For `white` 1 it is the clamp, for infinity `reinhard`. **Fails** with `RatfitError` for a `white` below `FAINTEST`.
    """
    if not white >= FAINTEST:
        raise RatfitError(f"white = {white}: give the light that is to be shown as white, {FAINTEST} or more")
    light = as_floats(light, "light")
    _, numpy = library(light)
    held = numpy.where((light < 0) | (light >= white), 0, light).astype(light.dtype)
    share = held / white
    return numpy.where(light >= white, 1, (held + share * share) / (1 + held)).astype(light.dtype)
