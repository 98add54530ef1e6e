"""From light of any strength to colours that a screen can show, between 0 and 1.

polimi2024 prints the clamp and asks of what else is used that it map light >= 0 into [0, 1]; the two curves are
reinhard2002's. Each takes an array of floats, NumPy or JAX, and returns one of the same shape and dtype; light below 0
counts as 0, infinite light is white, nan stays nan.
"""

from __future__ import annotations

from typing import Any

from ratfit._parse import RatfitError
from ratfit.models.directions import library


def clamp(light: Any) -> Any:
    """0 below 0, 1 above 1, the light itself between (polimi2024, Color range); the gradient is 0 where it is cut."""
    _, numpy = library(light)
    light = _floating(numpy, light)
    return numpy.where(light > 1, 1, numpy.where(light < 0, 0, light)).astype(light.dtype)


def reinhard(light: Any) -> Any:
    """light/(1 + light), which never comes to white (reinhard2002, Eq. 3)."""
    return _curve(light, lambda known: known / (1 + known), lambda inverse: 1 / (1 + inverse))


def reinhard_white(light: Any, white: float) -> Any:
    """light (1 + light/white^2)/(1 + light), which is white from the light `white` on (reinhard2002, Eq. 4).

    **Fails** with `RatfitError` where `white` is not above 0. For 1 it is the clamp, for infinity `reinhard`; below 1
    it brightens what is dark, too.
    """
    if not white > 0:
        raise RatfitError(f"white = {white}: give the light, above 0, that is to be shown as white")
    burn = 1 / white**2
    return clamp(
        _curve(
            light,
            lambda known: known * (1 + known * burn) / (1 + known),
            lambda inverse: (1 + burn / inverse) / (1 + inverse),
        )
    )


def _curve(light: Any, dark: Any, bright: Any) -> Any:
    """A curve written in the light up to 1, and in 1/light above, where the light itself may be infinite."""
    _, numpy = library(light)
    light = _floating(numpy, light)
    above = light > 1
    held = numpy.where(above | (light < 0), 0, light)
    inverse = 1 / numpy.where(above, light, 1)
    return numpy.where(above, bright(inverse), dark(held)).astype(light.dtype)


def _floating(numpy: Any, light: Any) -> Any:
    array = numpy.asarray(light)
    return array if numpy.issubdtype(array.dtype, numpy.floating) else array.astype(float)
