"""Whole reflectance models: formulas of the cosines of a pair of directions, evaluated on arrays of directions."""

from collections.abc import Mapping
from types import MappingProxyType

from ratfit._parse import named_in
from ratfit.models._model import Model as Model
from ratfit.models.blinn import BLINN, BLINN_AS_PRINTED
from ratfit.models.conserving import CONSERVING
from ratfit.models.cook_torrance import COOK_TORRANCE
from ratfit.models.directions import LETTERS as LETTERS
from ratfit.models.he import HE
from ratfit.models.lambert import LAMBERT
from ratfit.models.oren_nayar import OREN_NAYAR, OREN_NAYAR_AS_PRINTED, OREN_NAYAR_TABLED
from ratfit.models.phong import PHONG, PHONG_AS_PRINTED
from ratfit.models.schlick import SCHLICK
from ratfit.models.smoothie import (
    SMOOTHIE,
    SMOOTHIE_APPROXIMATE,
    SMOOTHIE_APPROXIMATE_AS_PRINTED,
    SMOOTHIE_AS_PRINTED,
    SMOOTHIE_CODE_AS_PRINTED,
)
from ratfit.models.toon import TOON, TOON_BLINN, TOON_TABLE, TOON_TABLE_BLINN
from ratfit.models.ward import (
    WARD,
    WARD_AS_PRINTED,
    WARD_BOUNDED,
    WARD_ISOTROPIC,
    WARD_ISOTROPIC_AS_PRINTED,
    WARD_THIRD_FORM_AS_PRINTED,
)

MODELS: Mapping[str, Model] = MappingProxyType(
    {
        model.name: model
        for model in (
            LAMBERT,
            OREN_NAYAR, OREN_NAYAR_TABLED, OREN_NAYAR_AS_PRINTED,
            PHONG, PHONG_AS_PRINTED,
            BLINN, BLINN_AS_PRINTED,
            WARD, WARD_BOUNDED, WARD_ISOTROPIC,
            WARD_AS_PRINTED, WARD_ISOTROPIC_AS_PRINTED, WARD_THIRD_FORM_AS_PRINTED,
            SMOOTHIE, SMOOTHIE_APPROXIMATE,
            SMOOTHIE_AS_PRINTED, SMOOTHIE_CODE_AS_PRINTED, SMOOTHIE_APPROXIMATE_AS_PRINTED,
            *COOK_TORRANCE, *HE,
            *SCHLICK, *CONSERVING,
            TOON, TOON_BLINN, TOON_TABLE, TOON_TABLE_BLINN,
        )
    }
)  # fmt: skip
"""Every model by its name."""


def named(model: str | Model) -> Model:
    """The model of that name; a model is itself. **Fails** with `RatfitError`, which says the nearest names."""
    return model if isinstance(model, Model) else named_in(MODELS, model, "model", "`ratfit check-model`")
