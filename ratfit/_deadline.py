"""A time limit around work that nobody can bound beforehand."""

from __future__ import annotations

import ctypes
import threading
from types import TracebackType


class OutOfTime(BaseException):
    """A time limit has passed. Not an Exception: a broad handler inside a library must not swallow it."""


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
        self._over = False
        self._raised: type[OutOfTime] = type("OutOfTime", (OutOfTime,), {})  # its own, so that limits can nest

    def __enter__(self) -> TimeLimit:
        if self.seconds is not None:
            self._timer = threading.Timer(self.seconds, self._stop, [threading.get_ident()])
            self._timer.daemon = True
            self._timer.start()
        return self

    def _stop(self, thread: int) -> None:
        # The lock keeps a limit that passes at the very end of the block from striking whatever runs after it.
        with self._lock:
            if not self._over:
                ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), ctypes.py_object(self._raised))

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        try:
            self._end()
        except self._raised:  # it passed in this very moment, on the way out
            kind = self._raised
        self.passed = kind is self._raised
        return self.passed

    def _end(self) -> None:
        if self.seconds is not None:
            self._timer.cancel()
            with self._lock:
                self._over = True
