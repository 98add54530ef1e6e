"""What is done of one row: a file beside the rows, from which a row of many samples goes on after an interruption."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ratfit._parse import RatfitError
from ratfit._record.files import explained, write_text

_BEGIN = b'{"key": '


def write_checkpoint(out: str | os.PathLike[str], key: Mapping[str, Any], state: Mapping[str, Any]) -> None:
    """Keep the state of the row that is being measured for the file of rows `out`, in place of an older state.

    **Arguments:**

    - `key`: says of which measurement; it is given back to none but the same.
    - `state`: whole numbers, floats, texts, lists and objects of them. It comes back as it was to the last bit, nan and
      the infinite too, which this file may hold: it is nobody's but ratfit's, and Python writes and reads their names.

    **Fails** with `RatfitError` where nothing can be written, and if the place is taken by somebody else's file.
    """
    _check_own(out)
    write_text(_place(out), json.dumps({"key": key, "state": state}))


def read_checkpoint(out: str | os.PathLike[str], key: Mapping[str, Any]) -> dict[str, Any] | None:
    """The state of that measurement; None where there is none, where it is torn or belongs to another measurement."""
    with explained(_place(out)):
        if not _place(out).exists():
            return None
        held = _parsed(_place(out).read_bytes())
    asked = json.loads(json.dumps(key))  # pairs become lists, as they did in the file
    return held["state"] if held is not None and held["key"] == asked else None


def drop_checkpoint(out: str | os.PathLike[str]) -> None:
    """Remove the state: its row is written. Where there is none, or somebody else's file, nothing happens."""
    with explained(_place(out)):
        if _is_own(out):
            _place(out).unlink(missing_ok=True)


def no_checkpoint(out: str | os.PathLike[str]) -> str:
    """Why the file in the place of a state holds none; nothing where it holds one, and where there is no file."""
    place = _place(out)
    with explained(place):
        if not place.exists() or _parsed(place.read_bytes()) is not None:
            return ""
        if _is_own(out):
            return f"{place} is torn: the row whose state it was is begun again"
        return f"{place} is a file of something else, no state to go on from: move it, or name another --out file"


def _place(out: str | os.PathLike[str]) -> Path:
    return Path(f"{os.fspath(out)}.part")


def _parsed(content: bytes) -> dict[str, Any] | None:
    try:
        held = json.loads(content)
    except (ValueError, RecursionError):
        return None
    is_whole = isinstance(held, dict) and held.keys() == {"key", "state"} and isinstance(held["state"], dict)
    return held if is_whole else None


def _check_own(out: str | os.PathLike[str]) -> None:
    with explained(_place(out)):
        if not _is_own(out):
            raise RatfitError(
                f"{_place(out)} is in the way, a file of something else: move it, or name another --out file"
            )


def _is_own(out: str | os.PathLike[str]) -> bool:
    """Whether the place is free or holds a checkpoint, be it torn."""
    if not _place(out).exists():
        return True
    with _place(out).open("rb") as file:
        begin = file.read(len(_BEGIN))
    return _BEGIN.startswith(begin)
