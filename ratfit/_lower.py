"""The one boundary between sympy and arrays: an expression becomes a function of NumPy or JAX arrays.

The expression is walked once into a tape of array operations, in which equal subexpressions share one entry; calling
the function plays the tape. No text is printed, so none is executed, and an expression means the same on both
backends. Numbers are Python floats, which have no dtype of their own: that of the arrays rules, float32 stays float32.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import sympy as sp

from ratfit._parse import RatfitError

# sympy's function -> the array operation. A function means its real branch on real numbers; where it has none, nan.
_FUNCTIONS: Mapping[Any, str] = {
    sp.exp: "exp", sp.log: "log", sp.Abs: "absolute", sp.sign: "sign", sp.floor: "floor", sp.ceiling: "ceil",
    sp.sin: "sin", sp.cos: "cos", sp.tan: "tan", sp.asin: "arcsin", sp.acos: "arccos", sp.atan: "arctan",
    sp.sinh: "sinh", sp.cosh: "cosh", sp.tanh: "tanh", sp.asinh: "arcsinh", sp.acosh: "arccosh", sp.atanh: "arctanh",
    sp.atan2: "arctan2", sp.Heaviside: "heaviside", sp.Min: "minimum", sp.Max: "maximum",
    sp.Lt: "less", sp.Le: "less_equal", sp.Gt: "greater", sp.Ge: "greater_equal", sp.Eq: "equal", sp.Ne: "not_equal",
    sp.And: "logical_and", sp.Or: "logical_or", sp.Not: "logical_not",
    sp.erf: "erf", sp.erfc: "erfc", sp.gamma: "gamma", sp.loggamma: "loggamma",
}  # fmt: skip
_RECIPROCALS: Mapping[Any, Any] = {
    sp.sec: sp.cos, sp.csc: sp.sin, sp.cot: sp.tan, sp.sech: sp.cosh, sp.csch: sp.sinh, sp.coth: sp.tanh,
}  # fmt: skip
_SPECIAL = frozenset({"erf", "erfc", "gamma", "loggamma"})
_ARITHMETIC = frozenset({"add", "subtract", "multiply", "divide", "negative", "power", "sqrt"})
_NAMED_ALIKE = (frozenset(_FUNCTIONS.values()) | _ARITHMETIC) - _SPECIAL  # the same name in numpy and jax.numpy

Operations = Mapping[str, Callable[..., Any]]


Named = tuple[tuple[sp.Symbol, sp.Expr], ...]
"""Names, each with its formula in the arguments and earlier names."""


class Entries(sp.Atom):
    """The numbers of a look-up table: one object of an expression, however many they are."""

    __slots__ = ("values",)
    values: tuple[float, ...]

    def __new__(cls, values: Sequence[float]) -> Entries:
        kept = tuple(map(float, values))
        if len(kept) < 2 or not all(map(math.isfinite, kept)):
            raise RatfitError("a table needs two entries or more, each a finite number")
        entries = super().__new__(cls)
        entries.values = kept
        return entries

    def _hashable_content(self) -> tuple[float, ...]:
        return self.values

    def __getnewargs__(self) -> tuple[tuple[float, ...]]:
        return (self.values,)

    def _sympystr(self, printer: Any) -> str:
        return f"<{len(self.values)} entries>"


class Lookup(sp.Function):
    """`Lookup(position, Entries(values))`: linear interpolation in a table, the position counted in entries from 0.

    Before the first entry it is the first, after the last the last. It is made for arrays: it has no derivative.
    """

    nargs = 2

    def _eval_evalf(self, prec: int) -> sp.Expr | None:
        position, values = self.args[0]._eval_evalf(prec), self.args[1].values
        if not (isinstance(position, sp.Number) and position.is_finite):
            return None
        position = sp.Min(sp.Max(position, 0), len(values) - 1)
        below = min(int(position), len(values) - 2)
        first, second = (sp.Float(value, precision=prec) for value in values[below : below + 2])
        return first + (position - below) * (second - first)

    def _eval_derivative(self, s: sp.Symbol) -> sp.Expr:
        raise RatfitError(f"{self} is a table, which has no derivative: take that of the function in it")


def lower(
    expression: sp.Expr, arguments: Sequence[sp.Symbol], backend: str = "numpy", steps: Named = ()
) -> Callable[..., Any]:
    """Turn an expression into a function of arrays.

    **Arguments:**

    - `expression`: real for real arguments; where it is not, the function gives nan. Its numbers are rounded once.
    - `arguments`: the symbols whose values the function takes, by position.
    - `backend`: `"numpy"` or `"jax"`; JAX is imported for the latter alone.
    - `steps`: names that the expression uses beside the arguments, each with its formula: a program, computed in the
        order in which it is written down.

    **Returns:** a function of scalars and arrays that broadcast together. It gives an array of their shape and common
    dtype (integers count as the backend's default float); from Python numbers alone, a Python float on NumPy. Division
    by zero is inf or nan, without a warning. On JAX it may be jitted, differentiated and mapped.

    **Fails** with `RatfitError` for a symbol that is no argument, a function that arrays do not have, an expression or
    arguments that are not sympy's.
    """
    play = {"numpy": _play_numpy, "jax": _play_jax}.get(backend)
    if play is None:
        raise RatfitError(f"no array library {backend!r}: lower to 'numpy' or 'jax'")
    _check_arguments(arguments)
    played = tape(_sympified(expression), tuple(arguments), steps)

    def function(*values: Any) -> Any:
        if len(values) != len(arguments):
            raise TypeError(f"{len(values)} values for the {len(arguments)} arguments {', '.join(map(str, arguments))}")
        return play(played, values)

    return function


def _check_arguments(arguments: object) -> None:
    if not isinstance(arguments, Sequence) or isinstance(arguments, str):
        raise RatfitError(f"the arguments are {arguments!r}: give a tuple of symbols, as (x,)")
    for argument in arguments:
        if not isinstance(argument, sp.Symbol):
            raise RatfitError(f"the argument {argument!r} has the type {type(argument).__name__}: give a sympy.Symbol")


def _sympified(expression: object) -> sp.Expr:
    try:
        return sp.sympify(expression, strict=True)
    except sp.SympifyError as no_expression:
        kind = type(expression).__name__
        raise RatfitError(f"the expression has the type {kind}: give sympy's, made of sympy.Symbol") from no_expression


@functools.lru_cache(maxsize=256)
def tape(expression: sp.Expr, arguments: tuple[sp.Symbol, ...], steps: Named = ()) -> tuple[Step, ...]:
    """The operations of an expression in order, the last its value: what every player of arrays or code goes by."""
    made = _Tape({symbol: place for place, symbol in enumerate(arguments)})
    for name, formula in steps:
        made.entries[name] = made.place(formula)
    result = made.place(expression)
    return tuple(made.steps[: result + 1])


@dataclass(frozen=True)
class Step:
    """One entry of a tape: an operation on earlier entries, an argument, or a number."""

    operation: str
    operands: tuple[int, ...] = ()
    number: float = math.nan  # the value of a "number", the place of an "argument", the exponent of an "integer_power"
    table: tuple[float, ...] = ()  # the entries of a "table", the last one twice: so there is one above any position


@dataclass
class _Tape:
    """The steps so far, and the entry of every expression placed: this memo shares the common parts."""

    arguments: Mapping[sp.Symbol, int]
    steps: list[Step] = field(default_factory=list)
    entries: dict[Any, int] = field(default_factory=dict)

    def place(self, node: Any) -> int:
        """The entry that holds the value of an expression or condition."""
        if node not in self.entries:
            self.entries[node] = self._compose(node)
        return self.entries[node]

    def _step(self, operation: str, *operands: int, number: float = math.nan, table: tuple[float, ...] = ()) -> int:
        step = Step(operation, operands, number, table)
        if step not in self.entries:
            self.steps.append(step)
            self.entries[step] = len(self.steps) - 1
        return self.entries[step]

    def _fold(self, operation: str, operands: Sequence[int]) -> int:
        return functools.reduce(lambda first, second: self._step(operation, first, second), operands)

    def _compose(self, node: Any) -> int:
        if isinstance(node, sp.Symbol):
            return self._argument(node)
        if isinstance(node, sp.Expr) and not node.free_symbols:
            return self._step("number", number=rounded(node))
        if isinstance(node, sp.Add):
            return self._sum(node)
        if isinstance(node, sp.Mul):
            return self._product(*_parted(node))
        if isinstance(node, sp.Pow):
            return self._product((), (node,)) if _is_negative(node.exp) else self._power(node.base, node.exp)
        if isinstance(node, sp.Piecewise):
            return self._piecewise(node)
        return self._function(node)

    def _argument(self, symbol: sp.Symbol) -> int:
        if symbol not in self.arguments:
            known = ", ".join(map(str, self.arguments)) or "nothing"
            raise RatfitError(f"{symbol} has no value: give it one, or put it among the arguments ({known})")
        return self._step("argument", number=self.arguments[symbol])

    def _sum(self, node: sp.Add) -> int:
        """Added terms first, then the taken ones: a difference is one operation, a sum with a negation two."""
        numbers, terms = _parted(node)
        taken = [-term for term in (*terms, *numbers) if _is_negative(term)]
        added = [term for term in (*terms, *numbers) if not _is_negative(term)]
        if not added:
            return self._step("negative", self.place(sp.Add(*taken)))
        return self._fold("subtract", [self._fold("add", [*map(self.place, added)]), *map(self.place, taken)])

    def _product(self, numbers: tuple[sp.Expr, ...], factors: tuple[sp.Expr, ...]) -> int:
        """One division at most, however many factors stand below the line."""
        below = [factor for factor in factors if isinstance(factor, sp.Pow) and _is_negative(factor.exp)]
        above = [self.place(factor) for factor in factors if factor not in below]
        number = numbers[0] if numbers else sp.S.One
        negated = bool(above) and number == -1
        if not above or number not in (1, -1):
            above.insert(0, self.place(number))
        value = self._fold("multiply", above)
        value = self._step("negative", value) if negated else value
        if not below:
            return value
        return self._step("divide", value, self._fold("multiply", [self._power(f.base, -f.exp) for f in below]))

    def _power(self, base: sp.Expr, exponent: sp.Expr) -> int:
        """A power by its cheapest operations; an exponent that is a number is positive here."""
        root = self.place(base)
        exponent = sp.Rational(exponent) if exponent.is_Float else exponent
        if exponent == 0:
            return self.place(sp.S.One)
        if exponent == sp.Rational(1, 3):
            return self._step("cbrt", root)
        if not (exponent.is_Rational and exponent.q <= 2):
            return self._step("power", root, self.place(exponent))
        whole, half = divmod(exponent.p, exponent.q)
        factors = [self._step("integer_power", root, number=whole) if whole > 1 else root] if whole else []
        return self._fold("multiply", [*factors, self._step("sqrt", root)] if half else factors)

    def _piecewise(self, node: sp.Piecewise) -> int:
        """Every branch is computed and the first condition that holds selects, as on a GPU; where none holds, nan."""
        value = self._step("number")
        for branch, condition in reversed(node.args):
            chosen = self.place(branch)
            value = chosen if condition == sp.true else self._step("select", self.place(condition), chosen, value)
        return value

    def _function(self, node: Any) -> int:
        if isinstance(node, sp.ITE):  # what sympy makes of a condition on a piece
            condition, chosen, other = node.args
            return self.place(sp.Or(sp.And(condition, chosen), sp.And(sp.Not(condition), other)))
        if node.func in _RECIPROCALS:
            return self._step("divide", self.place(sp.S.One), self.place(_RECIPROCALS[node.func](*node.args)))
        if isinstance(node, Lookup):
            position, entries = node.args
            return self._step("table", self.place(position), table=(*entries.values, entries.values[-1]))
        if node.func not in _FUNCTIONS:
            raise RatfitError(f"arrays have no {node.func.__name__}, as in {node}: write it in other functions")
        operation, operands = _FUNCTIONS[node.func], [self.place(part) for part in node.args]
        folds = isinstance(node, (sp.Min, sp.Max, sp.And, sp.Or))
        return self._fold(operation, operands) if folds else self._step(operation, *operands)


def rounded(number: sp.Expr) -> float:
    """The double nearest to an exact real number; one complex by rounding alone (casus irreducibilis) is real."""
    if number is sp.nan:
        return math.nan
    real, imaginary = parts = number.evalf(30).as_real_imag()
    decided = all(isinstance(part, sp.Number) and part is not sp.nan for part in parts)
    if not (decided and abs(imaginary) <= abs(real) * 1e-20):
        raise RatfitError(f"{number} is not a real number: what is computed on arrays must be real")
    return float(real)


def _is_negative(part: sp.Expr) -> bool:
    """Whether a term or an exponent carries a minus sign; of -k that is the sign written, not that of the value."""
    return bool(part.is_negative if part.is_number else part.as_coeff_Mul()[0].is_negative)


def _parted(node: sp.Expr) -> tuple[tuple[sp.Expr, ...], tuple[sp.Expr, ...]]:
    """The numbers among the arguments of a sum or product, made one, and the other arguments."""
    numbers = [part for part in node.args if not part.free_symbols]
    return (node.func(*numbers),) if numbers else (), tuple(part for part in node.args if part.free_symbols)


def _play(steps: Sequence[Step], values: Sequence[Any], operations: Operations) -> Any:
    entries: list[Any] = []
    for step in steps:
        operands = [entries[operand] for operand in step.operands]
        if step.operation == "number":
            entries.append(step.number)
        elif step.operation == "argument":
            entries.append(values[int(step.number)])
        elif step.operation == "integer_power":
            entries.append(operations["integer_power"](*operands, int(step.number)))
        elif step.operation == "table":
            entries.append(operations["table"](*operands, step.table))
        else:
            entries.append(operations[step.operation](*operands))
    return entries[-1]


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, Fraction, sp.Expr))


def _play_numpy(steps: Sequence[Step], values: Sequence[Any]) -> Any:
    import numpy as np

    values = [float(value) if _is_number(value) else _numpy_floating(value) for value in values]
    arrays = [value for value in values if not isinstance(value, float)]
    dtype = np.result_type(*arrays) if arrays else np.dtype(float)
    with np.errstate(all="ignore"):
        result = _play(steps, values, _numpy_operations(dtype))
    if not arrays:
        return result
    shape = np.broadcast_shapes(*(array.shape for array in arrays))
    result = np.array(result, dtype, copy=any(result is array for array in arrays) or None)
    return result[()] if result.shape == shape else np.full(shape, result)


def _numpy_floating(value: Any) -> Any:
    import numpy as np

    array = np.asarray(value)
    return array if np.issubdtype(array.dtype, np.floating) else array.astype(float)


@functools.cache
def _numpy_operations(dtype: Any) -> Operations:
    import numpy as np
    import scipy.special

    def select(condition: Any, chosen: Any, other: Any) -> Any:
        if isinstance(condition, float):
            return chosen if condition else other
        # `where` is no ufunc: two Python floats would make it float64, whatever the dtype of the arrays.
        return np.where(condition, *(dtype.type(part) if isinstance(part, float) else part for part in (chosen, other)))

    def table(position: Any, values: tuple[float, ...]) -> Any:
        floor, part = _split(position, len(values) - 2, np)
        entries = np.asarray(values, dtype)
        index = np.clip(floor.astype(np.intp), 0, len(values) - 2)  # of a nan too, whose integer is any
        found = entries[index] + part * (entries[index + 1] - entries[index])
        return float(found) if isinstance(position, float) else found

    operations = {name: getattr(np, name) for name in _NAMED_ALIKE}
    operations |= {name: getattr(scipy.special, name) for name in _SPECIAL}
    operations |= {"select": select, "integer_power": repeated_product, "cbrt": _principal(np.cbrt, select)}
    return {name: _unboxed(operation) for name, operation in operations.items()} | {"table": table}


def _unboxed(operation: Callable[..., Any]) -> Callable[..., Any]:
    """Of Python numbers, a Python float: a NumPy scalar is float64, which would rule over arrays of float32."""

    def unboxed(*operands: Any) -> Any:
        result = operation(*operands)
        return float(result) if all(isinstance(operand, (int, float)) for operand in operands) else result

    return unboxed


def repeated_product(base: Any, exponent: int) -> Any:
    """A positive integer power in the least squarings: `numpy.power` takes ten times as long and rounds otherwise."""
    power = None
    while exponent:
        if exponent % 2:
            power = base if power is None else power * base
        exponent //= 2
        base = base * base if exponent else base
    return power


def _split(position: Any, last: int, numpy: Any) -> tuple[Any, Any]:
    """A position in a table, held between the first entry and the last, as a whole number and what is left."""
    held = numpy.minimum(numpy.maximum(position, 0), last)
    floor = numpy.floor(held)
    return floor, held - floor


def _principal(cbrt: Callable[..., Any], select: Callable[..., Any]) -> Callable[..., Any]:
    """The cube root as `x**(1/3)` means it: of a negative number it is complex, hence nan on real arrays."""
    return lambda base: select(base >= 0, cbrt(base), math.nan)


def _play_jax(steps: Sequence[Step], values: Sequence[Any]) -> Any:
    import jax.numpy as jnp

    values = [float(value) if _is_number(value) else _jax_floating(value) for value in values]
    arrays = [value for value in values if not isinstance(value, float)]
    result = _play(steps, values, _jax_operations())
    if not arrays:
        return jnp.asarray(result)
    shape = jnp.broadcast_shapes(*(array.shape for array in arrays))
    return jnp.broadcast_to(jnp.asarray(result, jnp.result_type(*arrays)), shape)


def _jax_floating(value: Any) -> Any:
    import jax.numpy as jnp

    array = jnp.asarray(value)
    return array if jnp.issubdtype(array.dtype, jnp.floating) else array.astype(float)


@functools.cache
def _jax_operations() -> Operations:
    import jax
    import jax.numpy as jnp

    def loggamma(x: Any) -> Any:
        return jnp.where(x < 0, math.nan, jax.scipy.special.gammaln(x))

    def table(position: Any, values: tuple[float, ...]) -> Any:
        floor, part = _split(position, len(values) - 2, jnp)
        entries = jnp.asarray(values, floor.dtype)
        index = jnp.clip(floor.astype(int), 0, len(values) - 2)
        return entries[index] + part * (entries[index + 1] - entries[index])

    operations = {name: getattr(jnp, name) for name in _NAMED_ALIKE}
    operations |= {name: getattr(jax.scipy.special, name) for name in _SPECIAL - {"loggamma"}} | {"loggamma": loggamma}
    return operations | {
        "select": jnp.where, "integer_power": jax.lax.integer_pow, "cbrt": _principal(jnp.cbrt, jnp.where),
        "table": table,
    }  # fmt: skip
