"""A time limit around work that nobody can bound beforehand."""

from __future__ import annotations

import ctypes
import sys
import threading
import time
from collections.abc import Callable
from types import TracebackType

AGAIN = 0.1
"""Seconds after which a limit that had no effect is raised again."""

PATIENCE = 10
"""How many times its seconds a limit of processor time lasts at most: a thread that waits for others uses none."""

MOMENT = 0.005
"""The shortest pause between two looks at the time."""

FLUSH = 20
"""Turns of an empty loop: an interpreter delivers a pending exception within the first."""


class OutOfTime(BaseException):
    """A time limit has passed. Not an Exception: a broad handler inside a library must not swallow it."""


_STARTING = threading.Lock()
"""Held while a watching thread starts: until it runs, Python knows it by the number of the thread that starts it, and
what is raised in that one would strike the newborn, which then never says that it has started."""


def _processor_clock() -> Callable[[], float]:
    """The processor time of the thread that asks, readable from others; the whole process's where it has none."""
    if sys.platform != "linux":
        return time.process_time
    clock = time.pthread_getcpuclockid(threading.get_ident())

    def used() -> float:
        try:
            return time.clock_gettime(clock)
        except OSError:  # the thread has ended, and its block before it
            return float("inf")

    return used


class TimeLimit:
    """`with TimeLimit(seconds) as limit: ...` leaves the block once the time has passed; `limit.passed` says so.

    The seconds are those of the processor in this thread, so that what a limit decides does not depend on what else
    the machine does; PATIENCE times as long by the wall end the block too. `wall` counts by the wall alone, as a
    person does. None means no limit.

    Pure Python is stopped between two bytecodes, in any thread and on any system (a signal would
    serve the main thread of POSIX alone); one long call into compiled code ends first. Limits nest: each ends its own
    block, and lets through what an outer one has raised.
    """

    def __init__(self, seconds: float | None, *, wall: bool = False) -> None:
        self.seconds = seconds
        self.wall = wall
        self.passed = False
        self._lock = threading.Lock()
        self._done = threading.Event()
        self._raised: type[OutOfTime] = type("OutOfTime", (OutOfTime,), {})  # its own, so that limits can nest

    def __enter__(self) -> TimeLimit:
        if self.seconds is not None:
            try:
                with _STARTING:
                    threading.Thread(
                        target=self._watch, args=[threading.get_ident(), self._left()], daemon=True
                    ).start()
            except BaseException:  # an outer limit's, say: the block is not entered, so nobody will leave it
                self._done.set()
                raise
        return self

    def _left(self) -> Callable[[], float]:
        """From now on: how many seconds are left, 0 or less once the time has passed."""
        seconds, began = self.seconds or 0.0, time.monotonic()
        if self.wall:
            return lambda: seconds - (time.monotonic() - began)
        clock = _processor_clock()
        used = clock()
        return lambda: min(seconds - (clock() - used), PATIENCE * seconds - (time.monotonic() - began))

    def _watch(self, thread: int, left: Callable[[], float]) -> None:
        """Raises in the thread once the time has passed, again and again: what strikes a finaliser is lost there."""
        # A thread uses no processor time faster than time goes by, so what is left can be slept through.
        while (remaining := left()) > 0:
            if self._done.wait(max(remaining, MOMENT)):
                return
        while not self._done.is_set():
            # The lock keeps a limit that passes at the very end of the block from striking whatever runs after it.
            with _STARTING, self._lock:
                if not self._done.is_set():
                    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), ctypes.py_object(self._raised))
            self._done.wait(AGAIN)

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
        self.passed = kind is self._raised or self._is_behind(error)
        return self.passed

    def _is_behind(self, error: BaseException | None) -> bool:
        """Whether an error comes of this limit: compiled code makes a SystemError of what strikes its callback."""
        while isinstance(error, SystemError):
            error = error.__cause__
            if isinstance(error, self._raised):
                return True
        return False
