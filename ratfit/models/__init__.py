"""Whole reflectance models: formulas of the cosines of a pair of directions, evaluated on arrays of directions."""

from collections.abc import Mapping
from types import MappingProxyType

from ratfit._parse import RatfitError, nearest
from ratfit.models._model import Model as Model
from ratfit.models.directions import LETTERS as LETTERS
from ratfit.models.lambert import LAMBERT

MODELS: Mapping[str, Model] = MappingProxyType(
    {
        model.name: model
        for model in (
            LAMBERT,
        )
    }
)  # fmt: skip
"""Every model by its name."""


def named(name: str) -> Model:
    """The model of that name. **Fails** with `RatfitError`, which says the nearest name."""
    if name not in MODELS:
        raise RatfitError(f"no model {name!r}{nearest(name, MODELS)}; there are: {', '.join(MODELS)}")
    return MODELS[name]
