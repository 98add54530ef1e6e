"""All claims, in the order of the documents, and the choice among them by words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ratfit._parse import RatfitError, nearest
from ratfit.claims import (
    background,
    colours,
    costs,
    course,
    distributions,
    distributions_slides,
    fresnel,
    fresnel_ranges,
    fresnel_slides,
    highlights,
    masking,
    masking_slides,
    method,
    published_errors,
    sampling,
    schlick_factors,
    schlick_model,
    schlick_weights,
    smith,
    smoothie,
    smoothie_fresnel,
    smoothie_shape,
    toon,
    vectors,
    whole_errors,
    whole_models,
)
from ratfit.claims._claim import DOCUMENTS, Claim

_THEMES = (
    course,
    colours,
    highlights,
    toon,
    vectors,
    smoothie,
    smoothie_shape,
    costs,
    background,
    method,
    fresnel,
    fresnel_ranges,
    masking,
    smith,
    distributions,
    published_errors,
    whole_errors,
    schlick_factors,
    schlick_model,
    schlick_weights,
    sampling,
    whole_models,
    fresnel_slides,
    distributions_slides,
    masking_slides,
    smoothie_fresnel,
)


def claims() -> tuple[Claim, ...]:
    """Every claim of the ledger: document by document, in each by theme."""
    everything = [claim for theme in _THEMES for claim in theme.CLAIMS]
    return tuple(claim for document in DOCUMENTS for claim in everything if claim.document == document)


def selected(words: Sequence[str]) -> tuple[Claim, ...]:
    """The claims that the words name, in the ledger's order; all of them for no words.

    A word is an id (`S-28-A`), how ids begin (`S-4.2`), or a document by its letters (`PM`) or its name, with the year
    or without (`polimi2024`); capitals do not matter. **Fails** with `RatfitError`, offering the nearest, for a word
    that names nothing.
    """
    ledger = claims()
    chosen = {claim.id for word in words for claim in _named(word, ledger)}
    return tuple(claim for claim in ledger if not words or claim.id in chosen)


def _named(word: str, ledger: Sequence[Claim]) -> Iterator[Claim]:
    letters = _letters()
    wanted = letters.get(word.casefold(), word).casefold()
    found = [c for c in ledger if c.id.casefold() == wanted or c.id.casefold().startswith(f"{wanted}-")]
    if not found:
        known = [*DOCUMENTS, *letters, *(claim.id for claim in ledger)]
        remedy = nearest(word, known) or "; `ratfit claims` lists all, `ratfit claims PM` those of one source"
        raise RatfitError(f"no claim {word!r}{remedy}")
    yield from found


def _letters() -> dict[str, str]:
    """The letters of every document by its name, with the year and without: the names end the titles."""
    names = {title.rpartition("(")[2].rstrip(")"): letters for letters, title in DOCUMENTS.items()}
    return {name.rstrip("0123456789"): letters for name, letters in names.items()} | names
