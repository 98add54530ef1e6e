"""Whether a file can be written in a place: told before the work and after a failure, in words that are true."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path


def unwritable(path: str | os.PathLike[str]) -> str:
    """Why no file can be written there, and what helps; nothing where one can, as far as that can be told.

    The folder is tried with a file of no name; nothing is left there.
    """
    try:
        return _refusal(Path(path))
    except OSError as refused:  # a name that is too long, say
        return f"{refused.strerror or refused}; choose another place"
    except ValueError as refused:  # a name that holds a zero
        return f"{refused}; choose another name"


def _refusal(file: Path) -> str:
    if file.is_dir():
        return "that is a folder; name a file in it"
    if file.exists():
        return ""  # it is replaced or added to; or it is /dev/stdout, say
    folder = where_links_lead(file).parent
    if not folder.is_dir():
        above = next((each for each in (folder, *folder.parents) if each.exists()), None)
        if above is None or above.is_dir():
            return f"there is no folder {folder}; make it first"
        return f"{above} is a file and no folder; choose another place"
    try:
        with tempfile.TemporaryFile(dir=folder):
            return ""
    except PermissionError:
        return f"no permission to write in the folder {folder}; choose another place"
    except FileNotFoundError:  # of a file system that makes its files itself, as /proc
        return f"the folder {folder} takes no files; choose another place"


def where_links_lead(file: Path) -> Path:
    """The file that is written in the place of a link, be it there or not; of what is no link, that itself.

    **Fails** with `OSError` for links that lead in a circle, where `Path.resolve` has an error of another kind.
    """
    if not file.is_symlink():
        return file
    with contextlib.suppress(FileNotFoundError):
        file.stat()
    return file.resolve()
