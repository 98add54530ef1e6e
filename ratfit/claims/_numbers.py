"""Numbers of formulas: values on grids, integrals, mean errors; NumPy in float64, the same on every machine."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Any

import sympy as sp

from ratfit._lower import lower

Values = Mapping[sp.Symbol, Any]

POINTS = 20_000
"""Midpoints of a mean over one variable: what they leave out is far below the digits that are shown."""


def values(expression: sp.Expr, at: Values) -> Any:
    """A formula at values of its symbols, numbers or arrays that broadcast."""
    import numpy as np

    return lower(expression, tuple(at), "numpy")(*(np.asarray(each, float) for each in at.values()))


def midpoints(low: float = 0.0, high: float = 1.0, count: int = POINTS) -> Any:
    """The middles of equal parts of an interval: a mean over them is a mean over the interval."""
    import numpy as np

    return low + (high - low) * (np.arange(count) + 0.5) / count


def integral(expression: sp.Expr, x: sp.Symbol, low: float, high: float, at: Values | None = None) -> float:
    """The integral of a formula over one variable at values of the others: Gauss-Legendre on parts that shrink
    towards both ends, where integrands here have their peaks and roots."""
    nodes, weights = _rule()
    inside = low + (high - low) * nodes
    return float((values(expression, {x: inside, **(at or {})}) * weights).sum() * (high - low))


@functools.cache
def _rule() -> tuple[Any, Any]:
    """Nodes and weights on [0, 1]: 24 points on each of the parts [1/2^k+1, 1/2^k], and their mirror images."""
    import numpy as np

    own, weight = np.polynomial.legendre.leggauss(24)
    edges = np.concatenate([[0.0], 0.5 ** np.arange(45, 0, -1)])
    left, width = edges[:-1, None], np.diff(edges)[:, None]
    nodes, weights = (left + width * (own + 1) / 2).ravel(), (width * weight / 2).ravel()
    return np.concatenate([nodes, 1 - nodes[::-1]]), np.concatenate([weights, weights[::-1]])


def peak_mean(found: Any, exact: Any) -> float:
    """The definition `peak_mean` of eps: the mean of |found - exact| over the peak of |exact|, of arrays."""
    import numpy as np

    return float(np.mean(np.abs(found - exact)) / np.max(np.abs(exact)))


def relative_mean(found: Any, exact: Any) -> float:
    """The definition `relative_mean`: the mean of |found - exact|/|exact| where exact is not 0."""
    import numpy as np

    known = exact != 0
    return float(np.mean(np.abs(found - exact)[known] / np.abs(exact)[known]))


def largest(expression: sp.Expr, at: Values) -> float:
    """The greatest size of a formula on a grid."""
    import numpy as np

    return float(np.nanmax(np.abs(values(expression, at))))
