"""The system's C compiler: found, run in a folder of its own, its shared object loaded."""

from __future__ import annotations

import ctypes
import functools
import os
import shlex
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

from ratfit._parse import RatfitError

NAMES = ("cc", "gcc", "clang")
SECONDS = 120  # for one file of three loops: a second is long, but a compiler may wait for its licence or its disk


def compiler() -> tuple[str, ...]:
    """The command of the compiler: that of the environment's CC, else the first of cc, gcc and clang.

    **Fails** with `RatfitError` where there is none.
    """
    asked = os.environ.get("CC", "").strip()
    if asked:
        try:
            command = tuple(shlex.split(asked))
        except ValueError:  # a quotation mark without its partner
            command = ()
        if not command or shutil.which(command[0]) is None:
            raise RatfitError(f"CC = {asked!r} names no program here: set it to a C compiler, or unset it")
        return command
    for name in NAMES:
        if shutil.which(name):
            return (name,)
    raise RatfitError(f"no C compiler here ({', '.join(NAMES)}): install one, or name one in the variable CC")


def lacking() -> str:
    """What this machine lacks for compiled C; nothing when there is a compiler."""
    try:
        compiler()
    except RatfitError as missing:
        return str(missing)
    return ""


@functools.cache
def version(command: tuple[str, ...]) -> str:
    """The first line of what a compiler says about itself."""
    lines = _run((*command, "--version")).splitlines()
    return lines[0].strip() if lines else command[0]


@functools.lru_cache(maxsize=64)
def load(source: str, flags: tuple[str, ...], command: tuple[str, ...]) -> ctypes.CDLL:
    """Compile a C file and load it into this process; the same text is compiled once.

    **Fails** with `RatfitError`, which shows the first line of complaint, where the compiler does, takes longer than
    `SECONDS`, or makes what cannot be loaded.
    """
    with tempfile.TemporaryDirectory(prefix="ratfit-") as folder:
        text, compiled, shared = (Path(folder) / name for name in ("kernels.c", "kernels.o", "kernels.so"))
        text.write_text(source)
        _run((*command, *flags, "-fPIC", "-c", str(text), "-o", str(compiled)))
        # Linked without the flags: with -ffast-math gcc before 13 links in a start-up code that makes the whole
        # process flush denormals to zero, NumPy and the check of the output included.
        _run((*command, "-shared", str(compiled), "-o", str(shared), "-lm"))
        try:
            return ctypes.CDLL(str(shared))
        except OSError as refused:  # a file system that runs no programs
            raise RatfitError(f"compiled, but not loaded ({refused}): set TMPDIR to a folder for programs") from None


def _run(command: Sequence[str]) -> str:
    pipe = subprocess.PIPE
    try:
        # In a session of its own: a compiler is a driver of other programs, which have to end with it.
        process = subprocess.Popen(
            command, stdout=pipe, stderr=pipe, text=True, errors="replace", start_new_session=True
        )
    except OSError as refused:
        raise RatfitError(f"{command[0]} does not start ({refused}): name another compiler in CC") from None
    with process:
        try:
            output, complaints = process.communicate(timeout=SECONDS)
        except subprocess.TimeoutExpired:
            raise RatfitError(f"{command[0]} took longer than {SECONDS} s: name another compiler in CC") from None
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
    if process.returncode:
        raise RatfitError(f"{command[0]} failed: {_complaint(complaints)}")
    return output


def _complaint(text: str) -> str:
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    errors = [line for line in lines if "error" in line]
    return next(iter((*errors, *lines)), "it said nothing")
