"""One model in the place of another: what the instrument measures like a fit, over pairs of directions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

import sympy as sp

from ratfit._parse import RatfitError, nearest
from ratfit._setting import RANDOM, Value
from ratfit._target import Parameter
from ratfit.brdf import fresnel
from ratfit.models import named
from ratfit.models._mixture import SHARE
from ratfit.models._model import Model
from ratfit.models.cook_torrance import ETA, F_NORMAL, KAPPA, cook_torrance
from ratfit.models.directions import LETTERS, T


@dataclass(frozen=True)
class Exactly:
    """The exact formula of a measurement."""

    expression: sp.Expr


@dataclass(frozen=True)
class Pairs:
    """What a model is measured on: the exact model as the target, on pairs of directions; read as a `Problem` is."""

    name: str
    target: Exactly
    parameters: Mapping[Parameter, tuple[sp.Expr, sp.Expr]]
    variable: sp.Symbol = T
    domain: tuple[sp.Expr, sp.Expr] = (sp.S.Zero, sp.S.One)
    references: tuple[()] = ()


@dataclass(frozen=True)
class StandIn:
    """A model that stands for another. `given` says its parameters in those of the other, where it has its own."""

    model: Model
    exact: Model
    given: Mapping[Parameter, sp.Expr] = field(default_factory=dict)

    @property
    def name(self) -> str:
        return f"{self.exact.name}~{self.model.name}"

    @property
    def formula(self) -> sp.Expr:
        """The stand-in in the cosines of a pair and the parameters of the exact model."""
        return self.model.reflectance.xreplace(dict(self.given))

    @property
    def problem(self) -> Pairs:
        symbols = (*LETTERS[1:], *self.exact.parameters)
        return Pairs(self.name, Exactly(self.exact.reflectance), {p: (p.low, p.high) for p in symbols})

    def settings(self, asked: Mapping[str, Value]) -> dict[str, Value]:
        """The parameters of a measurement: those asked for, the others at the exact model's defaults.

        Where nothing is said of the share of the facets it is all: a diffuse share would hide their error. **Fails**
        with `RatfitError` for a name that is no parameter.
        """
        self.exact.check_names(asked)
        share = {SHARE.name: 1.0} if SHARE in self.exact.parameters else {}
        cosines = {letter.name: RANDOM for letter in LETTERS[1:]}
        return {**cosines, **self.exact.defaults, **share, **asked}


_NORMAL = {F_NORMAL: fresnel.normal(ETA, KAPPA)}
_GROOVES = cook_torrance(
    "beckmann", "conductor", "torrance-sparrow",
    name="cook-torrance-grooves", title="Cook-Torrance by the true formulas, with its first masking",
)  # fmt: skip

STAND_INS: Mapping[str, StandIn] = MappingProxyType(
    {
        each.model.name: each
        for each in (
            StandIn(named("cook-torrance-optimised"), named("cook-torrance"), _NORMAL),
            StandIn(named("cook-torrance-optimised-as-printed"), named("cook-torrance-as-printed"), _NORMAL),
            StandIn(_GROOVES, named("cook-torrance-as-printed")),
        )
    }
)
"""Every stand-in by the name of its model (schlick1994, end of section 4, and its footnote 3)."""


def stand_ins(name: str) -> list[StandIn]:
    """What stands for the model of that name, or the stand-in of that name.

    **Fails** with `RatfitError` for a model that is neither.
    """
    found = [each for each in STAND_INS.values() if name in (each.model.name, each.exact.name)]
    if not found:
        known = list(dict.fromkeys(n for each in STAND_INS.values() for n in (each.exact.name, each.model.name)))
        raise RatfitError(f"nothing stands for a model {name!r}{nearest(name, known)}; there are: {', '.join(known)}")
    return found
