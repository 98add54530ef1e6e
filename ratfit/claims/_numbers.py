"""Numbers of formulas: values on grids, integrals, mean errors; NumPy in float64, the same on every machine."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
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


def mean_error(fit: sp.Expr, exact: sp.Expr, at: Values) -> float:
    """`peak_mean`: the mean of |fit - exact| over the peak of the exact function, all places weighing the same."""
    import numpy as np

    reference = values(exact, at)
    return float(np.mean(np.abs(values(fit, at) - reference)) / np.max(np.abs(reference)))


def relative_error(fit: sp.Expr, exact: sp.Expr, at: Values) -> float:
    """`relative_mean`: the mean of |fit - exact|/|exact| where the exact function is not 0."""
    import numpy as np

    reference = values(exact, at)
    known = reference != 0
    error = np.abs(values(fit, at) - reference)
    return float(np.mean(error[known] / np.abs(reference[known])))


def largest(expression: sp.Expr, at: Values) -> float:
    """The greatest size of a formula on a grid."""
    import numpy as np

    return float(np.nanmax(np.abs(values(expression, at))))


def everywhere(condition: Callable[..., Any], *grids: Any) -> bool:
    """Whether a condition on arrays holds at all places of a grid."""
    import numpy as np

    return bool(np.all(condition(*grids)))
