"""Model: a reflectance as one formula of the cosines of a pair of directions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, TypeAlias

import sympy as sp

from ratfit._lower import Named, lower
from ratfit._parse import RatfitError, nearest
from ratfit._target import Parameter
from ratfit.models.directions import (
    LETTERS,
    SQUARES,
    as_directions,
    as_floats,
    check_directions,
    cosines,
    library,
    traced,
)

Formula: TypeAlias = sp.Expr | Callable[[], sp.Expr]
"""An expression, or what makes it when it is first asked for: some take sympy long."""


@dataclass(frozen=True, eq=False)  # a model is itself alone: so JAX may take it for the name of a function
class Model:
    """A bidirectional reflectance distribution function (1/sr), without the cosine to the light.

    `formula` is written in the letters of `ratfit.models.directions`, squares included, and in `parameters`, and holds
    above the horizon; below it the reflectance is 0. `mirror` is the share that is reflected as a mirror does, in the
    single direction that is no function on arrays; `defaults` gives every parameter a value that shows the model well.
    `source` is a key of docs/refs.bib and a place there. `distribution` is the D of a model that has one, per steradian
    (its integral with the cosine t is to be 1), and `sampler` the name in `ratfit.models.samplers` of the one that
    draws light for the model's lobe, whose parameters the model has too.
    """

    name: str
    title: str
    formula: Formula
    parameters: tuple[Parameter, ...]
    source: str
    defaults: Mapping[str, float] = field(default_factory=dict)
    mirror: Formula = sp.S.Zero
    note: str = ""
    distribution: Formula | None = None
    sampler: str | None = None

    @cached_property
    def computed(self) -> sp.Expr:
        """The reflectance in all letters, as arrays compute it."""
        return _made(self.formula)

    @cached_property
    def reflectance(self) -> sp.Expr:
        """The reflectance in the five cosines."""
        return self.computed.xreplace(SQUARES)

    @cached_property
    def _program(self) -> tuple[Named, sp.Expr]:
        """What is divided by and depends on parameters alone, each with a name; the reflectance with these names."""
        divisors = {
            power: sp.Dummy()
            for power in sorted(self.computed.atoms(sp.Pow), key=str)
            if power.exp.is_negative and power.free_symbols and power.free_symbols <= set(self.parameters)
        }
        return tuple((name, power) for power, name in divisors.items()), self.computed.xreplace(divisors)

    @cached_property
    def coherent(self) -> sp.Expr:
        """The share of the mirror, in the cosine v."""
        return _made(self.mirror)

    @cached_property
    def facets(self) -> sp.Expr | None:
        """The distribution of facets in all letters, as arrays compute it."""
        return None if self.distribution is None else _made(self.distribution)

    def __call__(self, view: Any, light: Any, *, strict: bool = False, **values: Any) -> Any:
        """The reflectance of pairs of directions.

        **Arguments:** `view` and `light`, unit directions away from the surface, arrays of shape (..., 3) whose leading
        axes broadcast, NumPy or JAX, normal +z and tangent +x; `values`, parameters by name, numbers or arrays that
        broadcast against the leading axes, those left out at their `defaults`. Colours are parameters of shape (3,)
        against directions of shape (..., 1, 3). `strict` refuses directions that are not of unit length or not above
        the horizon, where otherwise the reflectance is 0; it looks at numbers, so not inside jit, grad or vmap.

        **Returns** an array of the shape that the leading axes and the parameters broadcast to, in the dtype of the
        directions: on JAX if one of them is. Inside a transformation of JAX the directions and the parameters may be
        traced; the range of a traced parameter is not checked.
        **Fails** with `RatfitError` for shapes that do not go together, and for a parameter that is unknown or outside
        its range.
        """
        view, light = as_directions(view, "view"), as_directions(light, "light")
        if strict:
            check_directions(view, "view")
            check_directions(light, "light")
        known = self.settings(values)
        backend, numpy = library(view, light, *known.values())
        try:
            letters = cosines(numpy.asarray(view), numpy.asarray(light))
            numpy.broadcast_shapes(letters[0].shape, *(numpy.shape(value) for value in known.values()))
        except (ValueError, TypeError) as error:  # NumPy's and JAX's word for shapes that do not broadcast
            shapes = ", ".join(str(numpy.shape(value)) for value in (view, light, *known.values()))
            raise RatfitError(
                f"{self.name}: shapes {shapes} do not broadcast (directions without their last)"
            ) from error
        return self._above_horizon(backend, letters, known)

    def _above_horizon(self, backend: str, letters: tuple[Any, ...], known: Mapping[str, Any]) -> Any:
        """The formula where both directions are above the horizon; elsewhere 0, and no gradient comes from there."""
        _, numpy = library(*letters, *known.values())
        _, _, v, v_prime, *_ = letters
        inside = ~((v <= 0) | (v_prime <= 0))  # nan too: it is no darkness
        harmless = (numpy.where(inside, letter, 0.5).astype(letter.dtype) for letter in letters)
        typed = (numpy.asarray(known[p.name], v.dtype) for p in self.parameters)
        steps, formula = self._program  # a division by parameters is made once, not for every pair
        value = lower(formula, [*LETTERS, *SQUARES, *self.parameters], backend, steps)(*harmless, *typed)
        return numpy.where(inside, value, 0).astype(value.dtype)

    def settings(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Every parameter with its value, checked unless traced; `RatfitError` for unknown or impossible ones."""
        self.check_names(values)
        known = {**self.defaults, **values}
        return {p.name: self._checked(p, known[p.name]) for p in self.parameters}

    def check_names(self, values: Iterable[str]) -> None:
        """**Fails** with `RatfitError` for a name that is none of the parameters'."""
        names = [p.name for p in self.parameters]
        for name in values:
            if name not in names:
                there = ", ".join(names) or "none"
                raise RatfitError(f"{self.name} has no parameter {name}{nearest(name, names)}; it has: {there}")

    def _checked(self, parameter: Parameter, value: Any) -> Any:
        """The value as an array inside the range; a traced one as it is."""
        if traced(value):
            return value
        array = as_floats(value, f"{self.name}: {parameter.name}")
        _, numpy = library(array)
        low, high = (array.dtype.type(float(end)) for end in (parameter.low, parameter.high))  # 1/100 of float32 too
        if not bool(numpy.all((array >= low) & (array <= high))):
            raise RatfitError(f"{self.name}: {parameter.name} = {value} is outside [{low:g}, {high:g}]")
        return array


def _made(formula: Formula) -> sp.Expr:
    return formula if isinstance(formula, sp.Expr) else formula()
