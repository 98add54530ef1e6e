"""Errors for the user, and refusals: errors that do not know yet where in the text they are."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


class RatfitError(ValueError):
    """Bad input; the text says what is wrong and how to mend it."""


class ParseError(RatfitError):
    """Text that is no expression of the grammar; one line with the place, the piece and the remedy."""


class Refusal(Exception):
    """Why a piece of the text is refused; the innermost piece that is known fills in the place."""

    def __init__(self, reason: str, start: int | None = None, end: int | None = None):
        super().__init__(reason)
        self.reason, self.start, self.end = reason, start, end

    def message(self, text: str, what: str) -> str:
        if self.start is None:
            return f"{what}: {self.reason}"
        piece = f", {quote(text[self.start : self.end])}" if self.start < len(text) else ""
        return f"{what}, column {self.start + 1}{piece}: {self.reason}"


def quote(piece: str) -> str:
    shown = repr(piece)
    return shown if len(shown) <= 40 else f"{shown[:36]}...{shown[0]}"


def shortened(text: str, most: int = 200) -> str:
    """A text, or its beginning where it is longer than anybody reads within a sentence, or than there is room for."""
    return text if len(text) <= most else f"{text[: most - 4].rstrip(' ,')} ..."


@contextmanager
def placed(start: int, end: int) -> Iterator[None]:
    try:
        yield
    except Refusal as refusal:
        if refusal.start is None:
            refusal.start, refusal.end = start, end
        raise
