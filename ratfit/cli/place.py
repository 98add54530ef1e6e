"""Whether a file can be written where a command is asked to: known before its work."""

from __future__ import annotations

from ratfit._parse import RatfitError
from ratfit._record import unwritable


def check_place(option: str, file: str | None) -> None:
    """Tries a file's place; nothing is left there.

    **Arguments:** the option or argument that named the file, and the file; None for standard output.
    **Fails** with `RatfitError` for no name, for a folder in the file's place, and for a folder that is missing or
    takes no new file.
    """
    if file is None:
        return
    if not file.strip():
        raise RatfitError(f"{option}: the name is empty; name a file")
    if file.endswith("/"):
        raise RatfitError(f"{option} {file}: that names a folder; name a file in it")
    refusal = unwritable(file)
    if refusal:
        raise RatfitError(f"{option} {file}: {refusal}")
