"""Toon shading in the slides on reflectance for scan-line rendering (polimi2024)."""

from __future__ import annotations

from typing import Any

from ratfit.claims._agreement import AtLeast, AtMost
from ratfit.claims._claim import Claim
from ratfit.claims._directions import over_pairs
from ratfit.claims._models import V_PRIME, named

THRESHOLDS, TABLES = ("toon", "toon-blinn"), ("toon-table", "toon-table-blinn")


def tones(name: str) -> Any:
    """The slides' f, the cosine included, of a model at its defaults, over pairs of directions."""
    model = named(name)
    known = {p.name: float(model.defaults[p.name]) for p in model.parameters}
    return over_pairs(model.reflectance * V_PRIME, **known)


def count_of_tones(name: str) -> int:
    """How many different values there are, but for rounding."""
    import numpy as np

    return len(np.unique(np.round(tones(name), 9)))


def between_tones(name: str) -> int:
    return count_of_tones(name) - count_of_tones(THRESHOLDS[0])


CLAIMS = (
    Claim(
        "PM-toon-tones",
        "Toon",
        "toon shading has discrete values alone: with one threshold for each part, four at most",
        (AtMost(4), AtMost(4)),
        lambda: tuple(map(count_of_tones, THRESHOLDS)),
        how="different values over pairs of directions, Phong's and Blinn's version",
    ),
    Claim(
        "PM-toon-table",
        "Toon",
        "colours from a table over the cosine add gradients between the tones",
        (AtLeast(100), AtLeast(100)),
        lambda: tuple(map(between_tones, TABLES)),
        how="how many more values there are over pairs of directions than with thresholds",
        word="gradients",
    ),
    Claim(
        "PM-toon-speed",
        "Toon",
        "looking a texture up is more efficient in general than branching",
        "more efficient",
        None,
        open="no hardware is named; on processors a comparison and a choice cost less than a table",
    ),
)
