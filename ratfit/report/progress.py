"""Progress on standard error: one line that overwrites itself, and nothing where nobody looks."""

from __future__ import annotations

import shutil
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

PATIENCE = 2.0
"""Seconds that a person waits without asking what goes on."""

WIDTH = 20
"""Characters of the bar."""


def progress(text: str) -> None:
    """Shows a line in place of the last one; an empty text takes it away."""
    if sys.stderr.isatty():
        columns = shutil.get_terminal_size().columns - 1  # a line that wraps cannot be overwritten
        print(f"\r\x1b[K{text[:columns]}", end="", file=sys.stderr, flush=True)


@contextmanager
def waiting(text: str) -> Iterator[None]:
    """Shows a line while the block runs, if it runs for long."""
    timer = threading.Timer(PATIENCE, progress, [text])
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        progress("")


class Meter:
    """How far a piece of work is: a bar, and the time left once that can be told."""

    def __init__(self, title: str) -> None:
        self.title = title
        self.begun = time.monotonic()
        self.first: tuple[float, int] | None = None
        progress(title)

    def say(self, text: str) -> None:
        """Shows what goes on, beside the title."""
        progress(f"{self.title}: {text}" if text else self.title)

    def at(self, done: int, of: int) -> None:
        """Shows how much is done; the time left is reckoned from the second report on: before it, code is compiled."""
        now = time.monotonic()
        bar = ("#" * round(WIDTH * done / of)).ljust(WIDTH, ".")
        left = ""
        if self.first is None:
            self.first = (now, done)
        elif done > self.first[1]:
            left = f", {duration((now - self.first[0]) / (done - self.first[1]) * (of - done))} left"
        self.say(f"[{bar}] {100 * done / of:.0f} % of {of:.3g} samples{left}")


def duration(seconds: float) -> str:
    """Seconds for a person: 42 s, 3 min 10 s, 2 h 5 min."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"
