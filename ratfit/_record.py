"""One measured row: what it holds, and how it is written so that an interruption costs nothing that was measured.

A file of rows is JSON lines, one object a row, appended as soon as it is measured. A whole file is written beside its
place and then moved there, so a reader finds the old one or the new one, never a part.
"""

from __future__ import annotations

import contextlib
import json
import math
import numbers
import os
import platform
import secrets
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from importlib import metadata
from pathlib import Path
from typing import Any, BinaryIO

from ratfit._parse import RatfitError

Row = dict[str, Any]


@dataclass(frozen=True)
class Record:
    """The errors and the speed of one fit, at one setting of its parameters, on one backend.

    The fields are the keys of a row, in their order. `epsilon` is definition -> fraction, `worst` is
    `{definition, at}`, times are in seconds for one call on all samples; None is what was not measured or not finite.
    """

    name: str
    parameters: Mapping[str, float]
    samples: int
    seed: int
    sampling: str
    dtype: str
    backend: str
    regime: str
    flags: str
    epsilon: Mapping[str, float | None]
    nonfinite: int | None
    worst: Mapping[str, Any]
    exact_s: float | None
    fit_s: float | None
    floor_s: float | None
    gamma: float | None
    gamma_low: float | None
    gamma_high: float | None
    note: str

    def to_json_object(self) -> Row:
        """The row that JSON can hold: plain numbers, and None for nan and for the infinite."""
        return {key: _plain(getattr(self, key)) for key in KEYS}


KEYS = tuple(field.name for field in fields(Record))


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(part) for key, part in value.items()}
    if value is None or isinstance(value, (str, bool)):
        return value
    if isinstance(value, numbers.Integral):
        return int(value)
    return float(value) if math.isfinite(value) else None


def machine() -> dict[str, Any]:
    """Where the rows were measured: processor, cores that this process may use, JAX's devices, versions."""
    packages = {name: _version(name) for name in ("numpy", "jax", "sympy", "ratfit")}
    return {
        "processor": _processor(),
        "cores": len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count(),
        "devices": _devices(),
        "versions": {"python": platform.python_version(), **packages},
    }


def _version(package: str) -> str | None:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def _processor() -> str:
    with contextlib.suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()


def _devices() -> list[str]:
    """The devices of a JAX that is loaded already; what measured nothing with JAX does not wait for it."""
    jax = sys.modules.get("jax")
    return [f"{device.platform}: {device.device_kind}" for device in jax.devices()] if jax else []


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write a text file whole or not at all; a pipe or a device is written to directly.

    **Fails** with `RatfitError` for a folder that is missing or may not be written to, and for a path that is a folder.
    """
    write_bytes(path, text.encode())


def write_bytes(path: str | os.PathLike[str], data: bytes) -> None:
    """The same for a file that is no text, a picture say."""
    with _explained(path):
        file = Path(path)
        if file.exists() and not file.is_file():
            file.write_bytes(data)  # /dev/stdout, say: nothing may be moved into its place
        else:
            _replace(file.resolve(), data)  # of a link its target is replaced, not the link


def _replace(path: Path, data: bytes) -> None:
    beside = path.with_name(f".{secrets.token_hex(8)}.tmp")
    try:
        with beside.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


@contextlib.contextmanager
def _explained(path: str | os.PathLike[str]) -> Iterator[None]:
    """Turns what the operating system refuses into one line that says the remedy."""
    try:
        yield
    except FileNotFoundError:
        raise RatfitError(f"{path}: there is no folder {Path(path).parent}; make it first") from None
    except IsADirectoryError:
        raise RatfitError(f"{path} is a folder: name a file in it") from None
    except PermissionError:
        raise RatfitError(f"{path}: no permission to write there; choose another place") from None
    except OSError as refused:
        raise RatfitError(f"{path}: {refused.strerror or refused}; choose another place") from None


def append_row(path: str | os.PathLike[str], record: Record) -> None:
    """Append a row to a file of rows, and see it on the disk before returning.

    A last line that an interruption tore is dropped first. **Fails** with `RatfitError` for a file that holds something
    else, which stays as it is, and where nothing can be written.
    """
    line = json.dumps(record.to_json_object(), allow_nan=False) + "\n"
    with _explained(path), Path(path).open("a+b") as file:
        _mend(path, file)
        file.write(line.encode())
        file.flush()
        os.fsync(file.fileno())


_BEGIN = b'{"name": '
_TAIL = 2**16  # bytes at the end of a file of rows that hold its last lines: a row has some 1000


def _mend(path: str | os.PathLike[str], file: BinaryIO) -> None:
    """Brings a file of rows to the end of its last whole line; raises RatfitError if it is no such file."""
    size = file.seek(0, os.SEEK_END)
    file.seek(max(0, size - _TAIL))
    *lines, last = file.read().split(b"\n")
    if lines and _row(lines[-1]) is None:
        raise RatfitError(f"{path} holds something else than measured rows: choose another file")
    if _row(last) is not None:
        file.write(b"\n")
    elif last:
        _check_torn(path, last)
        file.truncate(size - len(last))


def _row(line: bytes) -> Row | None:
    """The row that a line holds, or None."""
    try:
        row = json.loads(line, parse_constant=_refuse)
    except (ValueError, RecursionError):
        return None
    return row if isinstance(row, dict) and row.keys() == set(KEYS) else None


def _refuse(constant: str) -> None:
    raise ValueError(f"{constant} is not JSON")


def _check_torn(path: str | os.PathLike[str], line: bytes) -> None:
    """A line without an end may be dropped only if it is what an interruption leaves of a row."""
    if not (line.startswith(_BEGIN) or _BEGIN.startswith(line)):
        raise RatfitError(f"{path} holds something else than measured rows: choose another file")


def read_rows(path: str | os.PathLike[str]) -> list[Row]:
    """The rows of a file, in order; of a file that is not there yet, none. A last line that was torn is no row.

    **Fails** with `RatfitError`, which names the line, for a file that holds anything else.
    """
    with _explained(path):
        if not Path(path).exists():
            return []
        *lines, last = Path(path).read_bytes().split(b"\n")
    rows = []
    for number, line in enumerate(lines, 1):
        row = _row(line)
        if row is None:
            raise RatfitError(f"{path}, line {number}, is no measured row: name a file that bench --out has written")
        rows.append(row)
    row = _row(last)
    if row is None:
        _check_torn(path, last)
    return rows if row is None else [*rows, row]


def same_measurement(
    row: Row,
    *,
    name: str,
    parameters: Mapping[str, float],
    samples: int,
    seed: int,
    sampling: str,
    dtype: str,
    backend: str,
) -> bool:
    """Whether a row is the result of this very measurement: what has one need not be measured again."""
    asked = {
        "name": name, "parameters": dict(parameters), "samples": samples, "seed": seed, "sampling": sampling,
        "dtype": dtype, "backend": backend,
    }  # fmt: skip
    return all(row[key] == value for key, value in asked.items())
