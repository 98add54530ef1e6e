"""The third player of the tape: an expression in double-double on NumPy arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import sympy as sp

from ratfit._double_double import circular, exponential, gaussian, logarithm
from ratfit._double_double.arithmetic import (
    Array,
    DoubleDouble,
    absolute,
    cube_root,
    equal,
    floor,
    less,
    select,
    square_root,
    whole,
)
from ratfit._double_double.cancellation import without_cancellation
from ratfit._lower import Step, lower, repeated_product, rounded, tape
from ratfit._parse import RatfitError

BLOCK = 2**13
"""Points at a time: the intermediate arrays stay in the cache."""


def double_double(expression: sp.Expr, arguments: Sequence[sp.Symbol]) -> Callable[..., tuple[Array, Array]]:
    """Turn an expression into a function of float64 arrays that gives its values as double-doubles.

    **Arguments:**

    - `expression`: real for real arguments; where it is not, the function gives nan. Its numbers are taken to 106
        bits, so that pi is no float64.
    - `arguments`: the symbols whose values the function takes, by position.

    **Returns:** a function of float64 scalars and arrays that broadcast together, whose values are taken as exact. It
    gives `(high, low)`, float64 arrays of their shape: the value is `high + low`, `high` the float64 nearest to it.
    A function has a relative error below 1e-31 (8 u**2, u = 2**-53: measured at places made to be hard, not proved),
    a power up to 1e-29 where it nears the ends of float64. The error of an argument is magnified as in float64, from
    1e-32 instead of 1e-16: by terms that cancel, but for those that `cancellation` knows, and by exp of large numbers.
    Where a value or an intermediate one is below 1e-290 the accuracy goes down to float64's; infinite values and nan
    are float64's, with `low` 0, without a warning.

    **Fails** with `RatfitError` for a symbol that is no argument, and for a function without a double-double form.
    """
    named, numbers = _with_numbers_named(without_cancellation(expression))
    _refuse_unknown(tape(expression, tuple(arguments)), expression)  # in the words of the expression as written
    steps = tape(named, (*arguments, *numbers))
    constants = [_constant(number) for number in numbers.values()]

    def function(*values: Any) -> tuple[Array, Array]:
        if len(values) != len(arguments):
            raise TypeError(f"{len(values)} values for the {len(arguments)} arguments {', '.join(map(str, arguments))}")
        arrays = [np.asarray(value, np.float64) for value in values]
        shape = np.broadcast_shapes(*(array.shape for array in arrays))
        high, low = np.empty(shape), np.empty(shape)
        for place, block in _blocks(arrays, shape):
            value = _play(steps, [*map(whole, block), *constants])
            high.reshape(-1)[place], low.reshape(-1)[place] = value.high, value.low
        return high, low

    return function


def reference_error(expression: sp.Expr, arguments: Sequence[sp.Symbol], points: Sequence[Array]) -> Array:
    """How far the plain float64 evaluation is from the double-double one, in units in the last place of float64.

    **Arguments:**

    - `points`: the values of each argument, scalars or arrays of float64.

    **Returns:** the absolute difference over the last place of the double-double value, which for a zero is the least
    positive float64; 0 where both are the same infinity or both nan, infinite where only one is finite.

    **Fails** as `double_double` does.
    """
    plain = np.asarray(lower(expression, arguments, "numpy")(*(np.asarray(point, np.float64) for point in points)))
    high, low = double_double(expression, arguments)(*points)
    with np.errstate(all="ignore"):
        error = np.abs((plain - high) - low) / np.spacing(np.abs(high))
        same = (plain == high) | (np.isnan(plain) & np.isnan(high))
        both_finite = np.isfinite(plain) & np.isfinite(high)
        return np.where(both_finite, error, np.where(same, 0.0, np.inf))


def _blocks(arrays: Sequence[Array], shape: tuple[int, ...]) -> Iterator[tuple[slice, list[Array]]]:
    """The arrays in flat pieces of one length; one value for all points stays one."""
    count = int(np.prod(shape))
    flat = [a.reshape(1) if a.size == 1 else np.broadcast_to(a, shape).reshape(-1) for a in arrays]
    for start in range(0, count, BLOCK):
        place = slice(start, min(start + BLOCK, count))
        yield place, [array if array.size == 1 else array[place] for array in flat]


def _with_numbers_named(expression: sp.Expr) -> tuple[sp.Expr, dict[sp.Symbol, sp.Expr]]:
    """The expression with a symbol for each number that float64 does not hold: the tape keeps only float64.

    Exponents that the tape turns into products and roots stay.
    """
    names: dict[sp.Expr, sp.Symbol] = {}

    def named(node: sp.Basic) -> sp.Basic:
        if isinstance(node, sp.Expr) and not node.free_symbols:
            return node if _is_held(node) else names.setdefault(node, sp.Dummy(f"number{len(names)}", real=True))
        if isinstance(node, sp.Pow) and _is_of_roots(node.exp):
            return sp.Pow(named(node.base), node.exp)
        return node.func(*map(named, node.args)) if node.args else node

    return named(expression), {symbol: number for number, symbol in names.items()}


def _is_of_roots(exponent: sp.Expr) -> bool:
    return bool(exponent.is_Rational) and (exponent.q <= 2 or abs(exponent) == sp.Rational(1, 3))


def _is_held(number: sp.Expr) -> bool:
    """Whether float64 holds the number; what is infinite or undefined is float64's own business."""
    if number.is_Rational or number.is_Float:
        return sp.Rational(rounded(number)) == sp.Rational(number)
    return bool(number.is_infinite) or number is sp.nan


def _constant(number: sp.Expr) -> DoubleDouble:
    high = rounded(number)
    if not np.isfinite(high):
        return whole(np.array([high]))
    low = number.evalf(60).as_real_imag()[0] - sp.Rational(high)
    return DoubleDouble(np.array([high]), np.array([float(low)]))


def _refuse_unknown(steps: Sequence[Step], expression: sp.Expr) -> None:
    known = {*_OPERATIONS, "number", "argument", "integer_power", "table"}
    for step in steps:
        if step.operation not in known:
            raise RatfitError(f"{step.operation} has no double-double form, as in {expression}: compare in float64")


def _play(steps: Sequence[Step], values: Sequence[DoubleDouble]) -> DoubleDouble:
    entries: list[Any] = []
    with np.errstate(all="ignore"):
        for step in steps:
            operands = [entries[operand] for operand in step.operands]
            if step.operation == "number":
                entries.append(whole(np.array([step.number])))
            elif step.operation == "argument":
                entries.append(values[int(step.number)])
            elif step.operation == "integer_power":
                entries.append(repeated_product(operands[0], int(step.number)))
            elif step.operation == "table":
                entries.append(_looked_up(operands[0], step.table))
            else:
                entries.append(_OPERATIONS[step.operation](*operands))
    return entries[-1]


def _looked_up(position: DoubleDouble, table: Sequence[float]) -> DoubleDouble:
    """Linear interpolation, the position held between the table's ends."""
    held = _minimum(_maximum(position, whole(np.zeros(1))), whole(np.array([len(table) - 2.0])))
    below = floor(held)
    entries = np.array(table)
    index = np.nan_to_num(below.high).astype(np.int64)
    first, second = whole(entries[index]), whole(entries[index + 1])
    return first + (held - below) * (second - first)


def _minimum(x: DoubleDouble, y: DoubleDouble) -> DoubleDouble:
    return select(less(x, y) | np.isnan(x.high), x, y)


def _maximum(x: DoubleDouble, y: DoubleDouble) -> DoubleDouble:
    return select(less(y, x) | np.isnan(x.high), x, y)


_OPERATIONS: Mapping[str, Callable[..., Any]] = {
    "add": DoubleDouble.__add__, "subtract": DoubleDouble.__sub__, "multiply": DoubleDouble.__mul__,
    "divide": DoubleDouble.__truediv__, "negative": DoubleDouble.__neg__, "sqrt": square_root, "cbrt": cube_root,
    "power": logarithm.power, "exp": exponential.exp, "log": logarithm.log,
    "sinh": exponential.sinh, "cosh": exponential.cosh, "tanh": exponential.tanh,
    "arcsinh": logarithm.asinh, "arccosh": logarithm.acosh, "arctanh": logarithm.atanh,
    "sin": circular.sin, "cos": circular.cos, "tan": circular.tan,
    "arcsin": circular.asin, "arccos": circular.acos, "arctan": circular.atan, "arctan2": circular.atan2,
    "erf": gaussian.erf, "erfc": gaussian.erfc,
    "absolute": absolute, "floor": floor, "ceil": lambda x: -floor(-x),
    "sign": lambda x: whole(np.sign(x.high)),
    "heaviside": lambda x, half: select(x.high == 0, half, whole(np.heaviside(x.high, np.nan))),
    "minimum": _minimum, "maximum": _maximum, "select": select,
    "less": less, "greater": lambda x, y: less(y, x), "equal": equal, "not_equal": lambda x, y: ~equal(x, y),
    "less_equal": lambda x, y: less(x, y) | equal(x, y), "greater_equal": lambda x, y: less(y, x) | equal(x, y),
    "logical_and": np.logical_and, "logical_or": np.logical_or, "logical_not": np.logical_not,
}  # fmt: skip
