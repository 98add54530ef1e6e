"""Which measure of error a printed figure may be: the search through all of them, and what such a search is worth.

Among hundreds of combinations of definition, protocol and setting some lie near any figure by chance. So the number of
combinations that were looked through, and of those that round to the figure, goes with every answer.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal

from ratfit.report.measured import LEADING

SAME_DRAW: Mapping[tuple[str, str], str] = {
    **{("Eq. 12", protocol): "uniform" for protocol in ("angle", "cosine", "in-plane", "hemisphere")},
    ("Eq. 19", "in-plane"): "angle",
    ("Eq. 19", "hemisphere"): "uniform",
    ("Eq. 16", "uniform"): "hemisphere",
    ("Eq. 16", "angle"): "in-plane",
}
"""What an equation is measured under where all are to be drawn alike, and it has no such protocol.

No direction stands behind the sine. Of directions over the hemisphere the cosines to the normal are uniform, of those
in a plane the angles are.
"""


@dataclass(frozen=True)
class Finding:
    """The errors of an equation, measured once: by which protocol, at which setting, against which exact function."""

    place: str
    protocol: str
    setting: str
    is_random: bool  # every sample draws its own parameters
    against: str  # empty: the function that the paper approximates
    epsilon: Mapping[str, float | None]


@dataclass(frozen=True)
class Match:
    """One number that may be what was printed."""

    finding: Finding
    definition: str
    value: float
    distance: float


@dataclass(frozen=True)
class Closest:
    """The best match for a printed figure, of how many, and those that round to the figure, the best one first."""

    match: Match
    tried: int
    rounding: tuple[Match, ...]


@dataclass(frozen=True)
class Common:
    """One definition and protocol for all equations: what each is under it, and the greatest distance of any."""

    definition: str
    protocol: str
    is_random: bool  # settings pooled by drawing them at random; else the mean over those of the figures
    values: Mapping[str, float]
    distances: Mapping[str, float]

    @property
    def distance(self) -> float:
        return max(self.distances.values())


def distance(found: float | None, printed: float) -> float:
    """By which factor two figures differ, 1 or more; infinite for what is no such figure: 0, a negative mean, none."""
    if found is None or not 0 < found < math.inf:
        return math.inf
    return max(found / printed, printed / found)


def rounds_to(found: float, printed: float) -> bool:
    """Whether a number, rounded to the digits that were printed, is what was printed: 0.0136 is 0.014."""
    figure = Decimal(str(printed))
    unit = Decimal(1).scaleb(int(figure.as_tuple().exponent))
    return abs(Decimal(found) - figure) <= unit / 2


def is_fraction(definition: str) -> bool:
    """Whether an eps under this definition could be printed in percent: one in units in the last place could not."""
    return not definition.startswith("ulp_")


def closest(findings: Sequence[Finding], printed: float) -> Closest | None:
    """The number nearest to a printed figure, of all definitions of all findings; None where there is none.

    Those that round to the figure are equally near, for the print tells no more: of them a mean error goes before
    others, in the order of LEADING, and one over the peak before the rest. Otherwise the lesser distance decides.
    """
    tried = [
        Match(finding, definition, value, distance(value, printed))
        for finding in findings
        for definition, value in finding.epsilon.items()
        if is_fraction(definition) and value is not None
    ]
    near = sorted((match for match in tried if match.distance < math.inf), key=lambda match: match.distance)
    if not near:
        return None
    rounding = sorted((match for match in near if rounds_to(match.value, printed)), key=_rank)
    return Closest([*rounding, *near][0], len(tried), tuple(rounding))


def _rank(match: Match) -> int:
    if match.definition in LEADING:
        return LEADING.index(match.definition)
    return len(LEADING) + (not match.definition.startswith("peak_"))


def common(findings: Sequence[Finding], printed: Mapping[str, float], protocols: Sequence[str]) -> list[Common]:
    """Every way to measure all equations alike, the one with the least greatest distance first.

    **Arguments:** the findings, those of corrected functions not counted; the `printed` figure of each place; the
    `protocols` to go through. A way that some equation has no number for is left out.
    """
    own = [finding for finding in findings if not finding.against and finding.place in printed]
    definitions = dict.fromkeys(name for finding in own for name in finding.epsilon if is_fraction(name))
    found = []
    for protocol in protocols:
        for is_random in (False, True):
            pools = {place: _pool(own, place, protocol, is_random) for place in printed}
            for definition in definitions:
                values = {place: _pooled(pool, definition) for place, pool in pools.items()}
                distances = {place: distance(values[place], printed[place]) for place in printed}
                known = {place: value for place, value in values.items() if value is not None}
                if max(distances.values()) < math.inf:
                    found.append(Common(definition, protocol, is_random, known, distances))
    return sorted(found, key=lambda way: way.distance)


def _pool(findings: Sequence[Finding], place: str, protocol: str, is_random: bool) -> list[Finding]:
    """The findings of a place that one number is made of; a material cannot be drawn at random."""
    drawn = SAME_DRAW.get((place, protocol), protocol)
    here = [finding for finding in findings if finding.place == place and finding.protocol == drawn]
    chosen = [finding for finding in here if finding.is_random == is_random]
    return chosen or ([] if any(finding.is_random for finding in here) else here)


def _pooled(pool: Sequence[Finding], definition: str) -> float | None:
    values = [value for finding in pool if (value := finding.epsilon.get(definition)) is not None]
    return math.fsum(values) / len(values) if pool and len(values) == len(pool) else None
