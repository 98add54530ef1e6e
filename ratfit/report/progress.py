"""Progress on standard error: one line that overwrites itself, and nothing where nobody looks."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

PATIENCE = 2.0
"""Seconds that a person waits without asking what goes on."""


def progress(text: str) -> None:
    """Shows a line in place of the last one; an empty text takes it away."""
    if sys.stderr.isatty():
        print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)


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
