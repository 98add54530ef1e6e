"""Claim: a statement of a source that a computation decides. Decision: what it decided. Read these first."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from types import FunctionType
from typing import Any

from ratfit.claims._agreement import agrees, shown

DOCUMENTS: Mapping[str, str] = {
    "S": "Schlick, An Inexpensive BRDF Model for Physically-based Rendering (schlick1994)",
    "DP": "Micro-facet BRDF lighting, lecture slides (microfacet)",
    "PM": "Computer Graphics: BRDF models, lecture slides (polimi2024)",
    "SM": "Smoothie: an empirical BRDF, article (smoothie)",
}

VERDICTS: Mapping[str, str] = {
    "reproduced": "it holds as it stands",
    "reading": (
        'it holds when it is read as stated; so does a word that names no number ("much", "similar") when it is taken '
        'as the bound that the column "claimed" shows before it: the bound is chosen here, no author states it'
    ),
    "wrong": (
        "it does not hold; what holds instead is stated. A word that is taken as a bound and fails under it is wrong "
        "by that bound alone: the found number says by how much"
    ),
    "undecided": "what is known does not decide it, for the reason stated",
}


@dataclass(frozen=True)
class Reading:
    """One way to read a statement: in words, and the function that computes what the formulas give when read so.

    `claimed` is what the statement comes to when it is read so, where that is another value than the claim's: a bound
    in place of "small", say.
    """

    words: str
    found: Callable[[], Any]
    claimed: Any = None


@dataclass(frozen=True)
class Claim:
    """A statement of a source, what it says is so, and the computations that decide it.

    `claim` is the statement in our own words, `claimed` the value that it gives: a number or formula, a `Rounded`,
    `AtMost`, `Above` and their like, counts, True for a law, or a function that makes it, for a formula that takes
    long. `found` computes the same as the statement says it; None where the statement leaves open what is meant, which
    `open` then says. `how` says in words how it is computed. `readings` are tried in their order where `found` does
    not agree; `instead` is what is right where no reading agrees either, with a function that is True when it is.
    `measured` are readings that take the time of machines. `word` is the word of the statement that names no number,
    and `claimed` the bound that it is taken as: what agrees with that is a reading, never reproduced.
    """

    id: str
    place: str
    claim: str
    claimed: Any
    found: Callable[[], Any] | None
    how: str = ""
    readings: tuple[Reading, ...] = ()
    instead: Reading | None = None
    open: str = ""
    measured: tuple[Reading, ...] = ()
    word: str = ""

    @property
    def document(self) -> str:
        return self.id.split("-")[0]

    @cached_property
    def value(self) -> Any:
        """What is claimed, made if it is not yet."""
        return self.claimed() if isinstance(self.claimed, FunctionType) else self.claimed

    @property
    def stated(self) -> Any:
        """What is claimed as it is shown: a bound that stands for a word goes with the word."""
        return f'{shown(self.value)} for "{self.word}"' if self.word else shown(self.value)


@dataclass(frozen=True)
class Decision:
    """A claim with its verdict, the value found, and the reading: how it was found, or what is right, or why not."""

    claim: Claim
    verdict: str
    found: Any
    reading: str

    def to_json_object(self) -> dict[str, Any]:
        claim = self.claim
        return {
            "id": claim.id,
            "document": claim.document,
            "place": claim.place,
            "claim": claim.claim,
            "verdict": self.verdict,
            "claimed": claim.stated,
            "found": shown(self.found),
            "reading": self.reading,
        }


def decide(claim: Claim, *, measure: bool = False) -> Decision:
    """The verdict on a claim, by its computations and by nothing else.

    **Arguments:** the claim; `measure`, whether readings are tried that time this machine.
    **Returns** a `Decision`. A statement in place of a wrong one is shown only where its own computation confirms it.
    """
    found = claim.found() if claim.found else None
    if claim.found and agrees(found, claim.value):
        return Decision(claim, "reading" if claim.word else "reproduced", found, claim.how)
    nearest = found
    for reading in (*claim.readings, *(claim.measured if measure else ())):
        value = reading.found()
        if agrees(value, claim.value if reading.claimed is None else reading.claimed):
            return Decision(claim, "reading", value, reading.words)
        nearest = value if nearest is None else nearest
    if claim.found is None:
        return Decision(claim, "undecided", nearest, claim.open)
    return Decision(claim, "wrong", found, _instead(claim.instead))


def _instead(right: Reading | None) -> str:
    if right is None:
        return ""
    return right.words if right.found() is True else f"not confirmed here: {right.words}"
