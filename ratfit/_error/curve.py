"""The error over the domain, for pictures: an even grid, the same whatever the samples are."""

from __future__ import annotations

from typing import Any

from ratfit._error.chunk import exact_program
from ratfit._kernel import hoist
from ratfit._setting import Setting

INTERVALS, POINTS = 256, 16
"""Intervals of the domain, and points in each."""

VALUES = 33
"""Values of a parameter that is drawn at random; the other random ones stand in the middle of their ranges."""


def error_curve(place: Setting, dtype: str) -> dict[str, Any] | None:
    """The error in each of 256 equal intervals of the domain, from 16 points in each, as JSON holds it.

    Keys: `variable`, the `edges` of the intervals, `exact` and `fit` in their middles, `bias` (the mean signed error)
    and `absolute_max` in each, None where nothing is finite; and `parameters`: for each parameter that is drawn at
    random its `values` and the greatest error over the domain at each, `absolute_max`. None of a whole model, which
    has no one variable.
    """
    import numpy as np

    if place.whole:
        return None

    middle = {symbol: (low + high) / 2 for symbol, (low, high) in place.ranges.items()}
    edges = np.linspace(place.low, place.high, INTERVALS + 1)
    inside = (np.arange(POINTS) + 0.5) / POINTS
    points = (edges[:-1, None] + np.diff(edges)[:, None] * inside).astype(dtype)
    fit, exact = values_at(place, points, dtype, middle)
    error = _difference(fit, exact)
    centre_fit, centre_exact = values_at(place, points[:, POINTS // 2], dtype, middle)
    moving = {
        symbol.name: _over(place, points, dtype, middle, symbol, np.linspace(low, high, VALUES))
        for symbol, (low, high) in place.ranges.items()
    }
    return {
        "variable": place.variable.name,
        "edges": edges.tolist(),
        "exact": _plain(_finite(centre_exact)),
        "fit": _plain(_finite(centre_fit.astype(float))),
        "bias": _plain(POINTS * np.ma.mean(error / POINTS, axis=1)),  # no sum is beyond the numbers where no error is
        "absolute_max": _plain(np.ma.max(abs(error), axis=1)),
        "parameters": moving,
    }


def _over(place: Setting, points: Any, dtype: str, middle: Any, symbol: Any, values: Any) -> dict[str, Any]:
    import numpy as np

    worst = []
    for value in values:
        fit, exact = values_at(place, points, dtype, {**middle, symbol: value})
        most = np.ma.max(abs(_difference(fit, exact)))
        worst.append(None if most is np.ma.masked else float(most))
    return {"values": values.tolist(), "absolute_max": worst}


def values_at(place: Setting, points: Any, dtype: str, drawn: Any) -> tuple[Any, Any]:
    """The fit in `dtype` and the exact function in float64 at some points, on NumPy."""
    import numpy as np

    found = []
    for program, kind in ((place.program, dtype), (exact_program(place), "float64")):
        hoisted = hoist(program, (place.variable,))
        with np.errstate(all="ignore"):
            values = hoisted.values({**place.values, **drawn})
        found.append(hoisted.on_arrays(values, kind)(points.astype(kind)))
    return found[0], found[1]


def _difference(fit: Any, exact: Any) -> Any:
    import numpy as np

    with np.errstate(over="ignore", invalid="ignore"):
        return _finite(fit.astype(float) - exact)


def _finite(values: Any) -> Any:
    import numpy as np

    return np.ma.masked_invalid(values)


def _plain(values: Any) -> list[float | None]:
    return [None if value is None else float(value) for value in values.tolist()]
