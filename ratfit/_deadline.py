"""A time limit around work that nobody can bound beforehand: `with time_limit(seconds): ...` raises OutOfTime."""

import ctypes
import threading
from collections.abc import Iterator
from contextlib import contextmanager


class OutOfTime(BaseException):
    """The time limit has passed. Not an Exception: a broad handler inside a library must not swallow it."""


@contextmanager
def time_limit(seconds: float | None) -> Iterator[None]:
    """Raises OutOfTime in the calling thread once `seconds` have passed; None means no limit.

    Pure Python is stopped between two bytecodes, in any thread and on any system (a signal would serve the main
    thread of POSIX alone). One long call into compiled code ends first. Limits nest; the one that passes first rules.
    """
    if seconds is None:
        yield
        return
    thread = threading.get_ident()
    lock = threading.Lock()
    over = False

    def stop() -> None:
        # The lock keeps a limit that passes at the very end of the block from striking whatever runs after it.
        with lock:
            if not over:
                ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), ctypes.py_object(OutOfTime))

    timer = threading.Timer(seconds, stop)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        with lock:
            over = True
