"""Whole reflectance models: formulas of the cosines of a pair of directions, evaluated on arrays of directions."""

from ratfit.models._model import Model as Model
from ratfit.models.directions import LETTERS as LETTERS
