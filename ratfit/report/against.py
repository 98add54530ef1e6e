"""Measured rows against those of another day or another machine: what got worse, worst first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from ratfit._record import Change
from ratfit.report.text import aligned

SHOWN = 6
"""So many names in a line of what was not compared; of more, their number."""

_ASIDE = {"incomparable": "not compared", "gone": "gone", "added": "added"}
"""Verdicts that are none, and how the text calls them."""


def got_worse(changes: Iterable[Change]) -> bool:
    """Whether any quantity got worse beyond noise."""
    return any(change.verdict == "worse" for change in changes)


def against_text(changes: Sequence[Change]) -> str:
    """The changes as text: a headline, a table of what changed beyond noise, worst first, and what was not compared."""
    changed = [change for verdict in ("worse", "better") for change in _sorted(changes, verdict)]
    blocks = [[_headline(changes)], aligned([_HEAD, *map(_cells, changed)]) if changed else []]
    blocks += [list(_aside(changes, verdict)) for verdict in _ASIDE]
    return "\n\n".join("\n".join(block) for block in blocks if block)


def _headline(changes: Sequence[Change]) -> str:
    counts = Counter(change.verdict for change in changes)
    aside = ", ".join(f"{counts[verdict]} {called}" for verdict, called in _ASIDE.items() if counts[verdict])
    if not counts["worse"] + counts["better"] + counts["same"]:
        return f"nothing could be compared{aside and ': '}{aside}"
    told = f"{counts['worse']} worse, {counts['better']} better, {counts['same']} the same within noise"
    return f"{told}{aside and '; '}{aside}"


def _sorted(changes: Iterable[Change], verdict: str) -> list[Change]:
    """The changes of a verdict, the greatest first; what lost or gained its value comes before all."""
    return sorted((change for change in changes if change.verdict == verdict), key=_greatness, reverse=True)


def _greatness(change: Change) -> float:
    return float("inf") if change.old is None or change.new is None else abs(change.by)


_HEAD = (
    "",
    "problem",
    "parameters",
    "samples",
    "protocol",
    "dtype",
    "backend",
    "quantity",
    "old",
    "new",
    "change",
    "why",
)


def _cells(change: Change) -> tuple[str, ...]:
    row = change.row
    return (
        change.verdict, row["name"], parameters(row), f"{row['samples']:,}", row["sampling"], row["dtype"],
        row["backend"] or "-", change.quantity, *_told_apart(change.old, change.new), _share(change), change.why,
    )  # fmt: skip


def parameters(row: Mapping[str, Any]) -> str:
    """The values of a row's parameters, as in "m=0.2"; of one that is drawn at random, its range: "m=[0.1, 0.5]"."""
    return " ".join(f"{name}={_value(value)}" for name, value in row["parameters"].items())


def _value(value: float | Sequence[float]) -> str:
    if isinstance(value, (int, float)):
        return f"{value:.6g}"
    return f"[{', '.join(f'{end:.6g}' for end in value)}]"


def _told_apart(old: float | None, new: float | None) -> tuple[str, str]:
    """Both numbers with as many digits as it takes to see that they differ, at least four."""
    for digits in (4, 6, 9, 12):
        texts = _number(old, digits), _number(new, digits)
        if texts[0] != texts[1]:
            return texts
    return _number(old, 17), _number(new, 17)


def _number(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}g}"


def _share(change: Change) -> str:
    if not change.old or change.new is None:
        return "-"
    return f"{100 * change.by:+.3g} %"


def _aside(changes: Sequence[Change], verdict: str) -> Iterator[str]:
    """What has no verdict, a line for each reason: the quantities and in how many rows, or the rows themselves."""
    found = [change for change in changes if change.verdict == verdict]
    if found:
        yield _ASIDE[verdict]
    for why in dict.fromkeys(change.why for change in found):
        alike = [change for change in found if change.why == why]
        whole = [_label(change.row) for change in alike if change.quantity == "row"]
        parts = dict.fromkeys(change.quantity for change in alike if change.quantity != "row")
        if whole:
            yield f"  {why}: {_some(whole)}"
        if parts:
            rows = len({_label(change.row) for change in alike})
            yield f"  {why}: {_some(list(parts))} ({rows} row{'s' * (rows > 1)})"


def _label(row: Mapping[str, Any]) -> str:
    values = parameters(row)
    how = [row["dtype"], row["backend"], f"{row['samples']:,} samples"]  # no backend: nothing was timed
    return f"{row['name']}{values and ' '}{values} ({', '.join(filter(None, how))})"


def _some(names: Sequence[str]) -> str:
    more = len(names) - SHOWN
    return ", ".join(names[:SHOWN]) + (f" and {more} more" if more > 0 else "")
