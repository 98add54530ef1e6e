"""Pairs of directions, and the five cosines by which a reflectance depends on them; squares of two of them as well.

Directions are arrays of shape (..., 3) in the local frame of the surface: the normal N is +z, the tangent +x. In the
letters of schlick1994, H being the half vector of the view V and the light V': `t` = N.H, `u` = H.V, `v` = N.V,
`v_prime` = N.V', and `w` the cosine of the azimuth of H against the tangent, folded into the first quadrant. Further
products follow: V.V' = 2 u^2 - 1, |V + V'| = 2 u, and t = (v + v')/(2 u).

Near N a cosine says little of the angle: of 1 - t^2 below 1e-7 a float32 t has no digit. What a narrow lobe is made of
is therefore a letter too, s2 = 1 - t^2, taken from the tangential part of V + V' with all its digits; and t2 = t^2 and
w2 = w^2, which wait for no square root.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

import sympy as sp

from ratfit._parse import RatfitError
from ratfit._target import parameter

T, U, V, V_PRIME, W = (parameter(name, 0, 1) for name in ("t", "u", "v", "v_prime", "w"))
LETTERS = (T, U, V, V_PRIME, W)
"""The symbols that a model's formula is written in, beside its parameters."""

T2, SINE2, W2 = (parameter(name, 0, 1) for name in ("t2", "s2", "w2"))
"""t^2, 1 - t^2 and w^2, for formulas that are computed on arrays."""

SQUARES: Mapping[sp.Expr, sp.Expr] = {T2: T**2, SINE2: (1 - T) * (1 + T), W2: W**2}
"""What the squares are in the cosines."""

V_DOT_L = 2 * U**2 - 1
"""The cosine of the angle between the two directions."""

R_DOT_V = 2 * V * V_PRIME - V_DOT_L
"""The cosine of the angle between the view and the mirror image of the light, R = 2 (N.L) N - L; -1 to 1."""

HORIZON = sp.Rational(1, 10**14)
"""Cosines below this one count as this one where a reflectance divides by them, so that float32 does not overflow.

Gradients in float32 are finite from a cosine of 1e-5 on; nearer to the horizon they may be too great for it.
"""

SHORT = 1e-15
"""A vector no longer than this, left over where two unit ones cancel, is their rounding and has no direction."""

UNIT = 1e-3
"""How far from 1 the length of a direction may be in strict mode."""


def library(*arrays: Any) -> tuple[str, Any]:
    """The name of the array library of some values, `"numpy"` or `"jax"`, and its module."""
    jax = sys.modules.get("jax")  # a JAX array cannot come from a program that never imported JAX
    if jax is not None and any(isinstance(array, jax.Array) for array in arrays):
        return "jax", jax.numpy
    import numpy

    return "numpy", numpy


def as_floats(given: Any, what: str) -> Any:
    """An array of floats, on its own library. **Fails** with `RatfitError` for what is not made of real numbers."""
    _, numpy = library(given)
    try:
        array = numpy.asarray(given)
    except ValueError as error:  # NumPy's word for rows of different lengths
        raise RatfitError(f"{what}: rows of different lengths are no array; make them alike") from error
    if numpy.issubdtype(array.dtype, numpy.integer):
        array = array.astype(float)
    if not numpy.issubdtype(array.dtype, numpy.floating):
        raise RatfitError(f"{what} is made of {array.dtype}; give real numbers")
    return array


def as_directions(given: Any, what: str) -> Any:
    """An array of directions. **Fails** with `RatfitError` where the last axis has not the three coordinates."""
    array = as_floats(given, what)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise RatfitError(f"{what} has the shape {array.shape}: directions are arrays of shape (..., 3), normal +z")
    return array


def traced(value: Any) -> bool:
    """Whether a value is a placeholder of a JAX transformation (jit, grad, vmap), which has no number to look at."""
    jax = sys.modules.get("jax")
    return jax is not None and isinstance(value, jax.core.Tracer)


def cosines(view: Any, light: Any) -> tuple[Any, ...]:
    """t, u, v, v', w, t^2, 1 - t^2 and w^2 of pairs of unit directions, each of the shape of their leading axes.

    No cosine is above 1, whatever the rounding, and no square by more than the rounding. At N = H, where H has no
    azimuth, w is 1; at V' = -V, where there is no H, t is 0; both within `SHORT`, so that gradients stay finite in
    float32 too.
    """
    _, numpy = library(view, light)
    # Coordinate by coordinate, each function once: so XLA makes one loop of it all, which is twice as fast.
    x, y, z = (view[..., axis] + light[..., axis] for axis in range(3))
    across = x * x + y * y
    squared = across + z * z
    short = max(SHORT**2, float(numpy.finfo(squared.dtype).tiny))
    held = _at_least(numpy, short, squared)
    length, one_over = numpy.sqrt(held), 1 / held  # side by side: neither waits for the other
    above = _at_least(numpy, 0, z)
    t, t2 = above * length * one_over, above * above * one_over
    sine2 = numpy.where(squared <= short, 1, across * one_over).astype(t.dtype)
    w2 = _where_above(numpy, short, across, lambda known: x * x / known, 1)
    w = _where_above(numpy, short, across, lambda known: abs(x) / numpy.sqrt(known), 1)
    v, v_prime = numpy.broadcast_arrays(view[..., 2], light[..., 2])
    return *(_at_most_one(numpy, cosine) for cosine in (t, length / 2, v, v_prime, w)), t2, sine2, w2


def _at_least(numpy: Any, least: float, values: Any) -> Any:
    """The values, and the least one in place of those below it, which have no gradient then; nan stays."""
    return numpy.where(values < least, least, values).astype(values.dtype)


def _at_most_one(numpy: Any, cosine: Any) -> Any:
    """A cosine without what rounding has put above 1; unlike `minimum` it keeps the whole gradient at 1 itself."""
    return numpy.where(cosine > 1, 1, cosine).astype(cosine.dtype)


def _where_above(numpy: Any, least: float, values: Any, function: Any, otherwise: float) -> Any:
    """A function of those of some values that are above a least one; its gradient never sees the others."""
    below = values <= least  # not nan, which stays
    return numpy.where(below, otherwise, function(numpy.where(below, 1, values))).astype(values.dtype)


def check_directions(array: Any, what: str) -> None:
    """**Fails** with `RatfitError` for a direction that is not of unit length or not above the horizon."""
    if traced(array):
        raise RatfitError(f"{what}: strict looks at numbers; leave it out inside jit, grad and vmap")
    _, numpy = library(array)
    length = numpy.sqrt(numpy.sum(array * array, axis=-1))
    if not bool(numpy.all(numpy.abs(length - 1) <= UNIT)):
        raise RatfitError(f"{what}: a direction is not of unit length: divide by its length")
    if not bool(numpy.all(array[..., 2] > 0)):
        raise RatfitError(f"{what}: a direction is not above the horizon (z > 0): turn it into the surface's frame")
