"""Going on from a file of rows: what of it need not be measured again, and which files are not to be gone on from."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

from ratfit._parse import RatfitError
from ratfit._record.machine import ratfit_version
from ratfit._record.row import PROTOCOL, Row, plain

_ASKED = ("sampling", "seed", "samples", "dtype")


def same_measurement(
    row: Row,
    *,
    name: str,
    parameters: Mapping[str, float | Sequence[float]],
    samples: int,
    seed: int,
    sampling: str,
    dtype: str,
    backend: str,
    formula: str = "",
) -> bool:
    """Whether a row is the result of this very measurement: what has one need not be measured again.

    A row of another formula, of another ratfit or of another meaning of its numbers is not.
    """
    asked = {
        "name": name, "parameters": plain(parameters), "samples": samples, "seed": seed, "sampling": sampling,
        "dtype": dtype, "backend": backend, "formula": formula, "protocol": PROTOCOL,
    }  # fmt: skip
    return all(row[key] == value for key, value in asked.items()) and _version(row) == ratfit_version()


def _version(row: Row) -> Any:
    return row["machine"]["versions"].get("ratfit")


def check_resumable(
    rows: Sequence[Row], asked: Sequence[Mapping[str, Any]], out: str | os.PathLike[str] = "the file"
) -> None:
    """See that a run can go on from these rows, so that the file does not end up with a mixture.

    **Arguments:**

    - `rows`: what the file `out` holds.
    - `asked`: all measurements of the run, each with the keys that `same_measurement` takes.

    **Fails** with `RatfitError` for rows of another ratfit or another protocol, and for a row of a problem, parameters
    and backend that are asked for, but never with its sampling, seed, samples and type.
    """
    for row in rows:
        _check_version(row, out)
        near = [each for each in asked if _is_near(row, each)]
        if near and not any(_differences(row, each) == [] for each in near):
            _refuse(row, min((_differences(row, each) for each in near), key=len), out)


def _check_version(row: Row, out: str | os.PathLike[str]) -> None:
    if row["protocol"] != PROTOCOL:
        raise RatfitError(
            f"{out} holds rows of measuring protocol {row['protocol']}, and now it is {PROTOCOL}: their numbers do not "
            f"mean the same; name another --out file, or go on with ratfit {_version(row)}"
        )
    if _version(row) != ratfit_version():
        raise RatfitError(
            f"{out} holds rows of ratfit {_version(row)}, and this is {ratfit_version()}: name another --out file, or "
            "go on with the old version"
        )


def _is_near(row: Row, asked: Mapping[str, Any]) -> bool:
    same = ("name", "backend")
    return row["parameters"] == plain(asked["parameters"]) and all(row[key] == asked[key] for key in same)


def _differences(row: Row, asked: Mapping[str, Any]) -> list[tuple[str, Any, Any]]:
    return [(key, row[key], asked[key]) for key in _ASKED if row[key] != asked[key]]


def _refuse(row: Row, differences: Sequence[tuple[str, Any, Any]], out: str | os.PathLike[str]) -> None:
    was = ", ".join(f"{key} {old}" for key, old, _ in differences)
    now = ", ".join(f"{key} {new}" for key, _, new in differences)
    raise RatfitError(
        f"{out} holds {row['name']} measured with {was}, and {now} is asked for: name another --out file, or ask for "
        f"{was} again"
    )
