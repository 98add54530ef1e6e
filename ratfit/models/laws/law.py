"""Law: what a model was measured to keep, or where it breaks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

HOLDS, FAILS, UNDECIDED, NOT_APPLICABLE = "holds", "fails", "undecided", "not applicable"


@dataclass(frozen=True)
class Law:
    """A law with its verdict, the worst number found and the bound on it.

    `measure` says what the number is; `place` where it was found, angles in degrees and parameters by name; `remark`
    what else is to be known, or why the law does not apply.
    """

    name: str
    verdict: str
    measure: str
    found: float | None = None
    bound: float | None = None
    place: Mapping[str, float] = field(default_factory=dict)
    remark: str = ""


def verdict(holds: bool) -> str:
    return HOLDS if holds else FAILS


def degrees(cosine: Any) -> float:
    """The angle of a cosine, in degrees."""
    return float(np.degrees(np.arccos(np.clip(cosine, -1, 1))))


def pair_place(view: Any, light: Any) -> dict[str, float]:
    """Where a pair of directions is: angles to the normal, and the azimuth of the view and between the two."""
    azimuths = [float(np.degrees(np.arctan2(each[1], each[0]))) for each in (view, light)]
    return {
        "view": degrees(view[2]),
        "light": degrees(light[2]),
        "view's azimuth": azimuths[0],
        "azimuth between": (azimuths[1] - azimuths[0]) % 360,
    }
