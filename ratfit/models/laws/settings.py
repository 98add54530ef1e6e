"""The parameters that laws are measured at: the ends of the ranges, the defaults, and places between."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Any

import numpy as np

from ratfit._target import Parameter
from ratfit.models._model import Model

Setting = Mapping[str, Any]

CORNERS = 32
"""All corners of the ranges are taken where there are no more than that."""


def settings(model: Model, fixed: Setting, count: int, seed: int) -> list[Setting]:
    """Up to `count` settings: the defaults, each parameter at its ends, corners, then random ones between and at ends.

    `fixed` parameters stay. **Fails** with `RatfitError` for one that is unknown or outside its range.
    """
    default = {name: float(value) for name, value in model.settings(fixed).items()}
    free = [p for p in model.parameters if p.name not in fixed]
    found: list[Setting] = [default]
    found += [{**default, p.name: end} for p in free for end in ends(p)]
    if 2 ** len(free) <= CORNERS:
        corners = itertools.product(*map(ends, free))
        found += [{**default, **dict(zip((p.name for p in free), corner, strict=True))} for corner in corners]
    random = np.random.default_rng(seed)
    while free and len(found) < 2 * count:
        found.append({**default, **{p.name: _drawn(p, random) for p in free}})
    unique = {tuple(each.values()): each for each in found}
    return list(unique.values())[:count]


def ends(parameter: Parameter) -> tuple[float, float]:
    return float(parameter.low), float(parameter.high)


def between(parameter: Parameter, share: float) -> float:
    """The value at a share of the range, by ratio where the range begins above 0, else denser toward its beginning."""
    low, high = ends(parameter)
    if share in (0, 1):
        return high if share else low
    return low * (high / low) ** share if low > 0 else low + (high - low) * share**3


def _drawn(parameter: Parameter, random: Any) -> float:
    choice, share = random.integers(4), float(random.random())
    return ends(parameter)[choice] if choice < 2 else between(parameter, share)
