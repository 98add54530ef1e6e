"""The letters that reflectances are written in, and the models by their names.

All models are made when the first of them is asked for, which takes a second that most claims can do without. So what
needs them imports them late, and the letters are made here once more: symbols of one name and range are one symbol.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import sympy as sp

from ratfit._target import parameter

if TYPE_CHECKING:
    from ratfit.models import Model

T, U, V, V_PRIME, W = (parameter(name, 0, 1) for name in ("t", "u", "v", "v_prime", "w"))
LETTERS = (T, U, V, V_PRIME, W)
"""Those of `ratfit.models.directions`."""


@functools.cache
def made(formula: Callable[..., sp.Expr], *arguments: Any) -> sp.Expr:
    """A formula of `ratfit.brdf` of those arguments, made once: some take sympy a tenth of a second."""
    return formula(*arguments)


def named(name: str) -> Model:
    """A model by its name, as `ratfit.models.named`."""
    from ratfit.models import named as model

    return model(name)


def cosines(view: Any, light: Any) -> tuple[Any, ...]:
    """The letters' values for pairs of directions, the first of those of `ratfit.models.directions.cosines`."""
    from ratfit.models.directions import cosines as letters

    return tuple(letters(view, light)[: len(LETTERS)])
