"""Names: which a symbol may bear, and which of the known ones a word may have meant."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import TypeVar

from ratfit._parse.errors import RatfitError, quote, shortened
from ratfit._parse.functions import RESERVED
from ratfit._parse.limits import MAX_NAME

Named = TypeVar("Named")


def check_name(name: str, what: str) -> str:
    """The name itself, where a symbol may bear it.

    **Raises:** `RatfitError` when it is no ASCII identifier, starts with an underscore, is longer than 32 characters
    or is reserved.
    """
    if len(name) > MAX_NAME:
        raise RatfitError(f"{what} {quote(name)}: a name has at most {MAX_NAME} characters; shorten it")
    if not (name.isascii() and name.isidentifier()) or name.startswith("_"):
        raise RatfitError(f"{what} {quote(name)}: write a name as an ASCII letter, then letters, digits, underscores")
    if name in RESERVED:
        raise RatfitError(f"{what} {quote(name)}: this name is reserved; take another, such as '{name}_1'")
    return name


def nearest(word: str, known: Iterable[str]) -> str:
    """`"; did you mean 'smith'?"`, with up to three of the known names, or `""` where none is near."""
    by_lower = {name.lower(): name for name in sorted(known, reverse=True)}
    lower = word.lower()[:MAX_NAME]
    near = [lower] if lower in by_lower else get_close_matches(lower, by_lower, n=3)
    quoted = [quote(by_lower[name]) for name in near]
    listed = " or ".join(part for part in (", ".join(quoted[:-1]), *quoted[-1:]) if part)
    return f"; did you mean {listed}?" if listed else ""


def named_in(known: Mapping[str, Named], name: object, what: str, lister: str) -> Named:
    """What bears a name among many.

    **Arguments:** `what` they are, in one word, and the `lister`, where a person finds all their names.
    **Fails** with `RatfitError`, which offers the nearest, for another name, and for what is no name.
    """
    lists = f"{lister} lists the {len(known)} {what}s"
    if not isinstance(name, str):
        raise RatfitError(f"{shortened(repr(name), 40)} is no {what}: give one, or its name; {lists}")
    if name not in known:
        raise RatfitError(f"no {what} {quote(name)}{nearest(name, known) or ';'} {lists}")
    return known[name]
