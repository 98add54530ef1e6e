"""Whole files: written beside their place and then moved there, so a reader finds the old or the new, never a part."""

from __future__ import annotations

import contextlib
import hashlib
import os
import platform
import secrets
import sys
from collections.abc import Iterator
from pathlib import Path

from ratfit._parse import RatfitError
from ratfit._record.place import unwritable, where_links_lead


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write a text file whole or not at all; a pipe or a device is written to directly.

    **Fails** with `RatfitError` for a folder that is missing or may not be written to, and for a path that is a folder.
    """
    write_bytes(path, text.encode())


def write_bytes(path: str | os.PathLike[str], data: bytes) -> None:
    """The same for a file that is no text, a picture say."""
    with explained(path):
        file = Path(path)
        if file.exists() and not file.is_file():
            file.write_bytes(data)  # /dev/stdout, say: nothing may be moved into its place
        else:
            _replace(where_links_lead(file), data)  # of a link its target is replaced, not the link


def _replace(path: Path, data: bytes) -> None:
    kin = _kin(path)
    _sweep(path.parent, kin)
    beside = path.with_name(f"{kin}-{os.getpid()}-{secrets.token_hex(4)}.tmp")
    try:
        with beside.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)
    sync_folder(path.parent)


def _kin(path: Path) -> str:
    """How the names begin of all that this machine writes beside a file; short, whatever the file is called."""
    return f".{hashlib.sha256(f'{platform.node()} {path.name}'.encode()).hexdigest()[:12]}"


def _sweep(folder: Path, kin: str) -> None:
    """Removes what processes that were killed while they wrote this file left beside it."""
    for left in folder.glob(f"{kin}-*-*.tmp"):
        process = left.name.split("-")[1]
        if process.isdecimal() and not _is_running(int(process)):
            left.unlink(missing_ok=True)


def _is_running(process: int) -> bool:
    if sys.platform == "win32":
        return True  # there signal 0 is no question but an interruption
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):  # somebody else's process; no number of a process
        return True
    return True


def sync_folder(folder: Path) -> None:
    """Sees the names in a folder on the disk: a file that is new there is not safe before."""
    if sys.platform == "win32":
        return
    with contextlib.suppress(OSError):  # a folder that may not be read; a file system that has no such thing
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


@contextlib.contextmanager
def explained(path: str | os.PathLike[str]) -> Iterator[None]:
    """Turns what the operating system refuses into one line that says the remedy."""
    try:
        yield
    except OSError as refused:
        raise RatfitError(f"{path}: {unwritable(path) or _told(refused)}") from None


def _told(refused: OSError) -> str:
    """What to say of a place that seems to take files: a file there that may not be touched, a disk that is full."""
    if isinstance(refused, PermissionError):
        return "no permission to do that there; choose another place"
    return f"{refused.strerror or refused}; choose another place"
