"""A file of rows: JSON lines, one object a row, appended as soon as it is measured, by one process or by several."""

from __future__ import annotations

import contextlib
import errno
import json
import math
import os
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, BinaryIO

from ratfit._parse import RatfitError
from ratfit._record.files import explained, sync_folder
from ratfit._record.row import KEYS, Record, Row, is_row


def append_row(path: str | os.PathLike[str], record: Record) -> None:
    """Append a row to a file of rows, and see it on the disk before returning.

    A last line that an interruption tore is dropped first. Several processes may append to one file: each waits for its
    turn. **Fails** with `RatfitError` for a file that holds something else, which stays as it is, and where nothing can
    be written; with `TypeError` for a record whose values are not of their kinds.
    """
    line = _line(record)
    with explained(path), Path(path).open("a+b") as file, _alone(path, file):
        is_new = _mend(path, file) == 0
        file.write(line)
        file.flush()
        os.fsync(file.fileno())
        if is_new:
            sync_folder(Path(path).resolve().parent)


def _line(record: Record) -> bytes:
    row = record.to_line()
    if not is_row(row):
        raise TypeError(f"a row that could not be read again: {row}")
    return json.dumps(row, allow_nan=False).encode() + b"\n"


_PATIENCE = 30.0  # seconds; a turn takes milliseconds, so by then the other process hangs


@contextlib.contextmanager
def _alone(path: str | os.PathLike[str], file: BinaryIO) -> Iterator[None]:
    """Waits until no other process writes to the file; closing it, or the end of the process, lets the next one in."""
    if sys.platform != "win32":
        end = time.monotonic() + _PATIENCE
        while not _take_lock(file):
            if time.monotonic() > end:
                raise RatfitError(
                    f"{path}: another process does not stop writing to it; end that, or name another file"
                )
            time.sleep(0.005)
    yield


def _take_lock(file: BinaryIO) -> bool:
    """Whether the file's lock is ours now; True too where the file system has no locks."""
    import fcntl

    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as refused:
        return refused.errno not in (errno.EWOULDBLOCK, errno.EINTR)
    return True


_BEGIN = b'{"name": '
_TAIL = 2**16  # bytes at the end of a file that hold its last lines, most times: a row has some 1000 to 10000


def _mend(path: str | os.PathLike[str], file: BinaryIO) -> int:
    """Brings a file of rows to the end of its last whole line and returns its size; raises if it is no such file."""
    *lines, last = _tail(file).split(b"\n")
    if lines:
        _checked(path, "its last whole line", lines[-1])
    if row_of(last) is not None:
        file.write(b"\n")
    elif last:
        _check_torn(path, last)
        file.truncate(file.seek(0, os.SEEK_END) - len(last))
    return file.seek(0, os.SEEK_END)


def _tail(file: BinaryIO) -> bytes:
    """The end of a file, with all of its last whole line and what follows that."""
    size, length = file.seek(0, os.SEEK_END), _TAIL
    while True:
        file.seek(max(0, size - length))
        tail = file.read()
        if length >= size or tail.count(b"\n") > 1:
            return tail
        length *= 4


def row_of(line: bytes) -> Row | None:
    """The row that a line holds, or None."""
    value = _value(line)
    return value if is_row(value) else None


def _value(line: bytes) -> Any:
    """What a line of JSON holds; None for anything else."""
    try:
        return json.loads(line, parse_constant=_refuse, parse_float=_finite)
    except (ValueError, RecursionError):
        return None


def _refuse(constant: str) -> None:
    raise ValueError(f"{constant} is not JSON")


def _finite(digits: str) -> float:
    """The number that the digits say; 1e999 would be the infinite."""
    value = float(digits)
    if not math.isfinite(value):
        _refuse(digits)
    return value


def _checked(path: str | os.PathLike[str], place: str, line: bytes) -> Row:
    """The row of a whole line; raises RatfitError, which tells rows of another ratfit from what is no row at all."""
    value = _value(line)
    if is_row(value):
        return value
    if isinstance(value, dict) and value.keys() >= set(KEYS):
        raise RatfitError(f"{path}, {place}, is a row of another ratfit, which this one cannot read: name another file")
    raise RatfitError(f"{path}, {place}, is no measured row: name a file that bench --out has written")


def _check_torn(path: str | os.PathLike[str], line: bytes) -> None:
    """A line without an end may be dropped only if it is what an interruption leaves of a row."""
    if not (line.startswith(_BEGIN) or _BEGIN.startswith(line)):
        raise RatfitError(f"{path} holds something else than measured rows: choose another file")


def read_rows(path: str | os.PathLike[str]) -> list[Row]:
    """The rows of a file, in order; of a file that is not there yet, none. A last line that was torn is no row.

    **Fails** with `RatfitError`, which names the line, for a file that holds anything else.
    """
    with explained(path):
        if not Path(path).exists():
            return []
        *lines, last = Path(path).read_bytes().split(b"\n")
    rows = [_checked(path, f"line {number}", line) for number, line in enumerate(lines, 1)]
    row = row_of(last)
    if row is None:
        _check_torn(path, last)
    return rows if row is None else [*rows, row]


def merge(paths: Sequence[str | os.PathLike[str]]) -> list[Row]:
    """The rows of several files, of several machines say, in order; a row that is there twice comes once.

    **Fails** with `RatfitError`, which names the file, for one that is not there or holds anything else, and for rows
    of different protocols: their numbers do not mean the same.
    """
    rows: dict[str, Row] = {}
    for path in paths:
        if not Path(path).exists():
            raise RatfitError(f"there is no file {path}: name files that bench --out has written")
        for row in read_rows(path):
            first = next(iter(rows.values()), row)
            if row["protocol"] != first["protocol"]:
                raise RatfitError(
                    f"{path} holds rows of protocol {row['protocol']}, what came before is of {first['protocol']}, "
                    "and the numbers of the two do not mean the same: leave out the files of one"
                )
            rows.setdefault(json.dumps(row, sort_keys=True), row)
    return list(rows.values())
