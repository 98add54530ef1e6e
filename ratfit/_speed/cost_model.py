"""The regime without a clock: the operations of exact function and fit, each with the weight of a table.

Each distinct step of a tape counts once, for the exact function as for the fit, and every branch of a piecewise
function counts, as it does on arrays. The unit is an addition. Arithmetic has the reciprocal throughputs of scalar SSE
instructions on Intel's Skylake (agner2022: ADDSS and MULSS 0.5 cycles, DIVSS and SQRTSS 3, DIVSD 4, SQRTSD 4 to 6,
ROUNDSS 1), not the latencies, because samples are independent of one another and their operations overlap. The
functions have no instruction: their weights are what `benchmarks/function_costs.py` measured in scalar C with glibc,
rounded to 10. On another machine some are half as much again: the model orders formulas and predicts no time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ratfit._lower import Step

_FREE = frozenset({"number", "argument"})
_SIMPLE: Mapping[str, float] = {
    "add": 1, "subtract": 1, "multiply": 1, "negative": 1, "absolute": 1, "minimum": 1, "maximum": 1,
    "less": 1, "less_equal": 1, "greater": 1, "greater_equal": 1, "equal": 1, "not_equal": 1,
    "logical_and": 1, "logical_or": 1, "logical_not": 1, "select": 1, "floor": 2, "ceil": 2,
    "sign": 4, "heaviside": 4,  # two comparisons, two selections
    "table": 12,  # held between its ends 2, floor 2, conversion 2, two loads 2, and 4 for the line between two entries
}  # fmt: skip
_FUNCTIONS: Mapping[str, tuple[float, float]] = {
    "divide": (6, 8), "sqrt": (6, 10), "exp": (20, 30), "log": (20, 30), "power": (40, 100), "cbrt": (100, 90),
    "sin": (80, 120), "cos": (90, 150), "tan": (150, 160), "arcsin": (70, 110), "arccos": (100, 140),
    "arctan": (90, 60), "arctan2": (120, 90), "sinh": (120, 100), "cosh": (50, 50), "tanh": (120, 160),
    "arcsinh": (190, 190), "arccosh": (120, 120), "arctanh": (200, 220), "erf": (190, 180), "erfc": (190, 180),
    "gamma": (380, 360), "loggamma": (150, 140),
}  # fmt: skip
"""Weights in float32 and in float64."""


def weight(steps: Sequence[Step], dtype: str) -> float:
    """The weight of what the last step of a tape needs, in additions; a step that nothing needs costs nothing."""
    needed = {len(steps) - 1}
    for place in range(len(steps) - 1, -1, -1):
        if place in needed:
            needed.update(steps[place].operands)
    return sum(_weight(steps[place], dtype) for place in sorted(needed))


def _weight(step: Step, dtype: str) -> float:
    if step.operation in _FREE:
        return 0
    if step.operation == "integer_power":
        exponent = int(step.number)  # squarings, and a multiplication for every further binary digit that is 1
        return exponent.bit_length() + exponent.bit_count() - 2
    if step.operation in _SIMPLE:
        return _SIMPLE[step.operation]
    return _FUNCTIONS[step.operation][dtype == "float64"]
