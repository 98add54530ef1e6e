"""A time limit around work that nobody can bound beforehand."""

from __future__ import annotations

import ctypes
import threading
from types import TracebackType

AGAIN = 0.1
"""Seconds after which a limit that had no effect is raised again."""

FLUSH = 20
"""Turns of an empty loop: an interpreter delivers a pending exception within the first."""


class OutOfTime(BaseException):
    """A time limit has passed. Not an Exception: a broad handler inside a library must not swallow it."""


_STARTING = threading.Lock()
"""Held while a watching thread starts: until it runs, Python knows it by the number of the thread that starts it, and
what is raised in that one would strike the newborn, which then never says that it has started."""


class TimeLimit:
    """`with TimeLimit(seconds) as limit: ...` leaves the block once the time has passed; `limit.passed` says so.

    None means no limit. Pure Python is stopped between two bytecodes, in any thread and on any system (a signal would
    serve the main thread of POSIX alone); one long call into compiled code ends first. Limits nest: each ends its own
    block, and lets through what an outer one has raised.
    """

    def __init__(self, seconds: float | None) -> None:
        self.seconds = seconds
        self.passed = False
        self._lock = threading.Lock()
        self._done = threading.Event()
        self._raised: type[OutOfTime] = type("OutOfTime", (OutOfTime,), {})  # its own, so that limits can nest

    def __enter__(self) -> TimeLimit:
        if self.seconds is not None:
            try:
                with _STARTING:
                    threading.Thread(target=self._watch, args=[threading.get_ident()], daemon=True).start()
            except BaseException:  # an outer limit's, say: the block is not entered, so nobody will leave it
                self._done.set()
                raise
        return self

    def _watch(self, thread: int) -> None:
        """Raises in the thread once the time has passed, again and again: what strikes a finaliser is lost there."""
        pause = self.seconds
        while not self._done.wait(pause):
            # The lock keeps a limit that passes at the very end of the block from striking whatever runs after it.
            with _STARTING, self._lock:
                if not self._done.is_set():
                    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), ctypes.py_object(self._raised))
            pause = AGAIN

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        try:
            while not self._done.is_set():
                try:
                    with self._lock:
                        self._done.set()
                    for _ in range(FLUSH):
                        pass  # what was raised just before is delivered here
                except self._raised:
                    kind = self._raised
        finally:
            self._done.set()  # also where an outer limit struck in here
        self.passed = kind is self._raised
        return self.passed
