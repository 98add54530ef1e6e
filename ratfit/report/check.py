"""What a page needs to find in a row: what is not the same in every file of rows is checked once, here."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import Any

from ratfit._parse import RatfitError
from ratfit._record import Row

Test = Callable[[Any], bool]


def check_row(row: Row) -> None:
    """**Fails** with `RatfitError` where a row's fit, curve or published formula is not as ratfit writes it."""
    for key, shape in _SHAPES.items():
        value = row.get(key)
        if value is not None and not _has_shape(value, shape):
            raise RatfitError(
                f"a row of {row['name']!r} has a {key} that no ratfit writes: measure it again with bench"
            )
    curve = row.get("curve")
    if curve is not None and not _is_in_bins(curve):
        raise RatfitError(f"a row of {row['name']!r} has a curve without order: measure it again with bench")


def _has_shape(value: Any, shape: Mapping[str, Test]) -> bool:
    return isinstance(value, dict) and all(key in value and test(value[key]) for key, test in shape.items())


def _is_in_bins(curve: Mapping[str, Any]) -> bool:
    edges, bins = curve["edges"], len(curve["edges"]) - 1
    rising = all(low < high for low, high in pairwise(edges))
    return bins > 0 and rising and all(len(curve[key]) == bins for key in ("exact", "fit", "bias", "absolute_max"))


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


def _is_text_or_none(value: Any) -> bool:
    return value is None or isinstance(value, str)


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float))


def _is_number_or_none(value: Any) -> bool:
    return value is None or _is_number(value)


def _is_verdict(value: Any) -> bool:
    return value is None or isinstance(value, bool)


def _list_of(test: Test) -> Test:
    return lambda value: isinstance(value, list) and all(map(test, value))


def _table_of(test: Test) -> Test:
    return lambda value: isinstance(value, dict) and all(map(test, value.values()))


def _objects(shape: Mapping[str, Test]) -> Test:
    return _list_of(lambda value: _has_shape(value, shape))


_CONDITION: Mapping[str, Test] = {
    "kind": _is_text, "at": _is_text, "equals": _is_text, "holds": _is_verdict, "residual": _is_number_or_none,
}  # fmt: skip


def _is_condition(value: Any) -> bool:
    return _has_shape(value, _CONDITION) and _is_text(value.get("words", ""))


_FIT: Mapping[str, Test] = {
    "name": _is_text,
    "status": _is_text,
    "target": _is_text_or_none,
    "variable": _is_text,
    "domain": _list_of(_is_text),
    "parameters": _table_of(_list_of(_is_text)),
    "form": lambda value: isinstance(value, dict),
    "expression": _is_text_or_none,
    "candidates": _list_of(_is_text),
    "free": _objects({"name": _is_text, "range": lambda value: _list_of(_is_text)(value) and len(value) == 2}),
    "choice": _table_of(_is_text),
    "route": _is_text,
    "conditions": _list_of(_is_condition),
    "rejected": _objects({"expression": _is_text_or_none, "reason": _is_text}),
    "cost": lambda value: value is None or _table_of(_is_number)(value),
}
_BINS = _list_of(_is_number_or_none)
_CURVE: Mapping[str, Test] = {
    "variable": _is_text, "edges": _list_of(_is_number), "exact": _BINS, "fit": _BINS, "bias": _BINS,
    "absolute_max": _BINS,
}  # fmt: skip
_PUBLISHED: Mapping[str, Test] = {
    "place": _is_text, "expression": _is_text, "equal": _is_verdict, "epsilon": _is_number_or_none,
    "gamma": _is_number_or_none, "source": _is_text,
}  # fmt: skip
_SHAPES: Mapping[str, Mapping[str, Test]] = {"fit": _FIT, "curve": _CURVE, "published": _PUBLISHED}
