"""One row of a record in words: whose it is, under which circumstances, and its numbers with what qualifies them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from ratfit._record import Row
from ratfit.report.bench import is_of_speed

LEADING = ("peak_mean", "mean_mean", "relative_mean", "absolute_mean")
"""The definitions that may stand at the top, the first that was measured."""

NONE = "–"

_BOUNDS = {"gamma is a lower bound": "≥ ", "gamma is an upper bound": "≤ "}
_IS_COUNT = re.compile(r"exact function \S+ additions, fit \S+$")


@dataclass(frozen=True)
class Name:
    """The parts of a row's name `problem:reference~peer`; without a reference the row is against the target."""

    problem: str
    reference: str
    peer: str

    @property
    def method(self) -> str:
        """What was measured: the fit, or the peer by its name."""
        return self.peer or "fit"

    @property
    def against(self) -> str:
        """The exact function that it was measured against."""
        return self.reference or "the target"


def name_of(row: Row) -> Name:
    """The parts of a row's name; a problem's own name may hold a colon, and its fit says so."""
    name, problem = row["name"], (row.get("fit") or {}).get("name")
    if not (problem and name.startswith(problem) and name[len(problem) :][:1] in ("", ":", "~")):
        problem = re.split("[:~]", name, maxsplit=1)[0]
    reference, _, peer = name[len(problem) :].removeprefix(":").partition("~")
    return Name(problem, reference, peer)


def circumstances(row: Row) -> tuple[str, str, str]:
    """What rows must share for their numbers to stand in one picture: backend, dtype and sampling."""
    return row["backend"], row["dtype"], row["sampling"]


def parameters(row: Row) -> str:
    """The values of the parameters, as in "m = 0.25"; ranges are those that they were drawn from at random."""
    return ", ".join(f"{name} = {parameter(value)}" for name, value in row["parameters"].items())


def label(row: Row) -> str:
    """The reference and the values of the parameters: what tells the rows of one method apart."""
    return ", ".join(filter(None, (name_of(row).reference, parameters(row))))


def parameter(value: Any) -> str:
    """One parameter's value."""
    if isinstance(value, (list, tuple)):
        return f"random in [{', '.join(number(end, 6) for end in value)}]"
    return number(value, 6)


def number(value: float | None, digits: int = 3) -> str:
    """A number to so many digits, without an exponent where it needs none; a dash for none."""
    return NONE if value is None else f"{float(f'{value:.{digits}g}'):.{max(digits, 6)}g}"


def count(value: int | None) -> str:
    """A whole number with its thousands apart."""
    return NONE if value is None else f"{value:,}".replace(",", "\u202f")


def leading(rows: Iterable[Row]) -> str:
    """The definition of eps to put at the top: the first of LEADING that some row has, or any that some row has."""
    measured = [name for row in rows for name, value in row["epsilon"].items() if value is not None]
    return next((name for name in (*LEADING, *measured) if name in measured), LEADING[0])


def gamma(row: Row) -> str:
    """gamma with its 95 % interval, to the digits that this leaves: "12.3 [11.9, 12.8]"; a sign where it is a bound."""
    value, low, high = row["gamma"], row["gamma_low"], row["gamma_high"]
    if value is None:
        return NONE
    sign = _sign(row)
    if low is None or high is None:
        return sign + number(value)
    return f"{sign}{_known(value, low, high)} [{_known(low, low, high)}, {_known(high, low, high)}]"


def gamma_range(rows: Sequence[Row]) -> str:
    """gamma of several rows, from the least to the greatest."""
    known = sorted((row for row in rows if row["gamma"] is not None), key=lambda row: row["gamma"])
    if not known:
        return "not measured"
    if len(known) == 1:
        return gamma(known[0])
    return _between(*(gamma(row).partition(" [")[0] for row in (known[0], known[-1])))


def epsilon_range(rows: Sequence[Row], definition: str) -> str:
    """eps of several rows, from the least to the greatest."""
    known = [value for row in rows if (value := row["epsilon"].get(definition)) is not None]
    return _between(number(min(known)), number(max(known))) if known else "not measured"


def _between(low: str, high: str) -> str:
    return low if low == high else f"{low} to {high}"


def _known(value: float, low: float, high: float) -> str:
    """A value so that its last digit is worth no more than a quarter of the interval; four digits at most."""
    if not high > low:
        return number(value)
    place = math.floor(math.log10((high - low) / 4))
    digits = math.floor(math.log10(abs(value))) - place + 1 if value else 1
    shown = float(f"{value:.{min(max(digits, 1), 4)}g}")
    return f"{shown:.{max(0, -place)}f}" if digits <= 4 and abs(shown) < 1e6 else number(shown, 4)


def _sign(row: Row) -> str:
    """What the row's remarks make of its gamma: a bound, or nothing else than it says."""
    return next((sign for words, sign in _BOUNDS.items() if words in row["note"]), "")


def speed_remarks(row: Row) -> tuple[str, ...]:
    """The remarks that qualify times and gamma."""
    return tuple(remark for remark in _remarks(row) if is_of_speed(remark) and not _IS_COUNT.match(remark))


def error_remarks(row: Row) -> tuple[str, ...]:
    """The remarks that qualify eps."""
    return tuple(remark for remark in _remarks(row)[len(_about(row)) :] if not is_of_speed(remark))


def about_peer(row: Row) -> str:
    """What a peer is, in a line; empty for a fit."""
    return "".join(_about(row))


def _about(row: Row) -> list[str]:
    """The first remark on a peer, which says what it is."""
    return [remark for remark in _remarks(row)[:1] if name_of(row).peer and not is_of_speed(remark)]


def counted(row: Row) -> str:
    """What the cost model counted; empty where gamma was timed."""
    return "; ".join(remark for remark in _remarks(row) if _IS_COUNT.match(remark))


def _remarks(row: Row) -> list[str]:
    return [remark for remark in row["note"].split("; ") if remark]


def nonfinite(row: Row) -> str:
    """The samples that are left out of eps, with what they were."""
    kinds = [f"{count(n)} {kind.replace('_', ' in ')}" for kind, n in (row.get("counts") or {}).items() if n]
    return count(row["nonfinite"]) + (f" ({', '.join(kinds)})" if kinds else "")


def worst(row: Row) -> str:
    """The place of the worst error."""
    at = (row["worst"] or {}).get("at")
    if isinstance(at, dict):
        return ", ".join(f"{name} = {_place(value)}" for name, value in at.items())
    return _place(at)


def _place(at: Any) -> str:
    return number(at, 6) if at is None or isinstance(at, (int, float)) else str(at)


def over_floor(row: Row) -> float | None:
    """The fit's time over that of the copy floor."""
    return row["fit_s"] / row["floor_s"] if row["fit_s"] and row["floor_s"] else None
