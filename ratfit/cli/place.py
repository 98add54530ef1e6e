"""Whether a file can be written where a command is asked to: known before its work, and in words that are true."""

from __future__ import annotations

import tempfile
from pathlib import Path

from ratfit._parse import RatfitError


def check_place(option: str, file: str | None) -> None:
    """Tries a file's folder with a file of no name; nothing is left there.

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
    try:
        refusal = _refusal(Path(file))
    except OSError as refused:  # a name that is too long, say
        refusal = f"{refused.strerror or refused}; choose another place"
    except ValueError as refused:  # a name that holds a zero
        refusal = f"{refused}; choose another name"
    if refusal:
        raise RatfitError(f"{option} {file}: {refusal}")


def _refusal(file: Path) -> str:
    """Why no file can be written there and what helps, or nothing."""
    folder = file.resolve().parent if file.is_symlink() else file.parent  # of a link its target is written
    if file.is_dir():
        return "that is a folder; name a file in it"
    if file.exists():
        return ""  # it is replaced or added to; or it is /dev/stdout, say
    if not folder.is_dir():
        above = next(each for each in folder.parents if each.exists()) if not folder.exists() else folder
        if above.is_dir():
            return f"there is no folder {folder}; make it first"
        return f"{above} is a file and no folder; choose another place"
    try:
        with tempfile.TemporaryFile(dir=folder):
            return ""
    except PermissionError:
        return f"no permission to write in the folder {folder}; choose another place"
    except FileNotFoundError:  # of a file system that makes its files itself, as /proc
        return f"the folder {folder} takes no files; choose another place"
