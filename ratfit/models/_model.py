"""Model: a reflectance as one formula of the cosines of a pair of directions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import sympy as sp

from ratfit._lower import lower
from ratfit._parse import RatfitError, nearest
from ratfit._target import Parameter
from ratfit.models.directions import LETTERS, V_PRIME, V, as_directions, check_directions, cosines, library


@dataclass(frozen=True)
class Model:
    """A bidirectional reflectance distribution function (1/sr), without the cosine to the light.

    `reflectance` is written in the letters of `ratfit.models.directions` and in `parameters`, and holds above the
    horizon; below it the reflectance is 0. `coherent` is the share that is reflected as a mirror does, in the single
    direction that is no function on arrays; `defaults` gives every parameter a value that shows the model well.
    `source` is a key of docs/refs.bib and a place there.
    """

    name: str
    title: str
    reflectance: sp.Expr
    parameters: tuple[Parameter, ...]
    source: str
    defaults: Mapping[str, float] = field(default_factory=dict)
    coherent: sp.Expr = sp.S.Zero
    note: str = ""

    def __call__(self, view: Any, light: Any, *, strict: bool = False, **values: Any) -> Any:
        """The reflectance of pairs of directions.

        **Arguments:** `view` and `light`, unit directions away from the surface, arrays of shape (..., 3) whose leading
        axes broadcast, NumPy or JAX, normal +z and tangent +x; `values`, parameters by name, numbers or arrays that
        broadcast against the leading axes, those left out at their `defaults`. `strict` refuses directions that are
        not of unit length or not above the horizon, where otherwise the reflectance is 0.

        **Returns** an array of the leading shape, in the dtype of the directions. **Fails** with `RatfitError` for
        shapes that do not go together, and for a parameter that is unknown or outside its range.
        """
        view, light = as_directions(view, "view"), as_directions(light, "light")
        if strict:
            check_directions(view, "view")
            check_directions(light, "light")
        known = self.settings(values)
        backend, numpy = library(view, light)
        try:
            letters = cosines(view, light)
            numpy.broadcast_shapes(letters[0].shape, *(numpy.shape(value) for value in known.values()))
        except ValueError as error:
            shapes = ", ".join(str(numpy.shape(value)) for value in (view, light, *known.values()))
            raise RatfitError(
                f"{self.name}: shapes {shapes} do not broadcast (directions without their last)"
            ) from error
        function = lower(self.above_horizon, [*LETTERS, *self.parameters], backend)
        typed = (numpy.asarray(known[p.name], letters[0].dtype) for p in self.parameters)
        return function(*letters, *typed)

    @property
    def above_horizon(self) -> sp.Expr:
        """The reflectance for any pair of directions: 0 where one is at the horizon or below it."""
        inside = sp.And(V > 0, V_PRIME > 0)
        harmless = {letter: sp.Piecewise((letter, inside), (sp.S.Half, True)) for letter in LETTERS}
        return sp.Piecewise((self.reflectance.xreplace(harmless), inside), (0, True))

    def settings(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Every parameter with its value, checked. **Fails** with `RatfitError` for unknown or impossible ones."""
        _, numpy = library()
        names = [p.name for p in self.parameters]
        for name in values:
            if name not in names:
                there = ", ".join(names) or "none"
                raise RatfitError(f"{self.name} has no parameter {name}{nearest(name, names)}; it has: {there}")
        known = {**self.defaults, **values}
        for parameter in self.parameters:
            low, high = float(parameter.low), float(parameter.high)
            value = numpy.asarray(known[parameter.name], float)
            if not bool(numpy.all((value >= low) & (value <= high))):
                raise RatfitError(f"{self.name}: {parameter.name} = {known[parameter.name]} is outside [{low}, {high}]")
        return {name: known[name] for name in names}
