"""Where a fit is measured: at which values of its parameters, on which interval, at which points.

The points are counter-based: point i is a function of the seed and of i alone, defined in this file to the bit. So the
first n of N points are the n points, whoever asks for them, in chunks, on 1 device or on 64, now or in ten years.
"""

from __future__ import annotations

import functools
import math
import numbers
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import sympy as sp

from ratfit._lower import lower
from ratfit._parse import RatfitError, nearest

if TYPE_CHECKING:
    from jaxtyping import Array, Float, Float64

    Doubles = Float64[Array, " samples"]
    Points = Float[Array, " size"]

DTYPES = ("float32", "float64")


@dataclass(frozen=True)
class Setting:
    """An approximant and the exact function that it stands for, at values of the parameters that may be measured."""

    exact: sp.Expr
    formula: sp.Expr
    variable: sp.Symbol
    values: Mapping[sp.Symbol, float]  # of every parameter, and of the symbols that the reference has of its own
    low: float
    high: float

    @property
    def parameters(self) -> dict[str, float]:
        """The values by name, in the order of the names: what a record says."""
        return {symbol.name: self.values[symbol] for symbol in sorted(self.values, key=lambda symbol: symbol.name)}


def setting(fit: Any, parameters: Mapping[str, float] | None = None, reference: str | None = None) -> Setting:
    """What is measured when this fit is, at these parameter values.

    **Arguments:**

    - `fit`: a `Fit`; its formula may hold the variable and the parameters, but no coefficient that is still free.
    - `parameters`: the value of each parameter by name; a value that the reference gives may be left out.
    - `reference`: the name of one of the problem's references; without one the target is the exact function.

    **Fails** with `RatfitError` where there is nothing exact to compare with, and for a value that is missing, unknown,
    outside its range or in contradiction with the reference.
    """
    problem = fit.problem
    exact, given = _exact(problem, reference)
    values = _values(problem, parameters or {}, given)
    _check_free(fit, values)
    low, high = (_number(end, values, "the domain") for end in problem.domain)
    if not -math.inf < low < high < math.inf:
        raise RatfitError(f"the domain [{low}, {high}] cannot be sampled: measure on finite ends, low < high")
    return Setting(exact, fit.formula, problem.variable, values, low, high)


def _exact(problem: Any, reference: str | None) -> tuple[sp.Expr, Mapping[sp.Symbol, sp.Expr]]:
    known = {each.name: each for each in problem.references}
    names = ", ".join(known) or "none"
    if reference is not None:
        if reference not in known:
            raise RatfitError(f"no reference {reference!r}, there is: {names}{nearest(reference, known)}")
        return known[reference].expression, known[reference].parameters
    if problem.target is None:
        raise RatfitError(f"this problem has no target, so eps and gamma need a reference; it has: {names}")
    return problem.target.expression, {}


def _values(problem: Any, asked: Mapping[str, float], given: Mapping[sp.Symbol, sp.Expr]) -> dict[sp.Symbol, float]:
    symbols = {symbol.name: symbol for symbol in (*problem.parameters, *given)}
    known = ", ".join(symbols) or "none"
    for name, value in asked.items():
        if name not in symbols:
            raise RatfitError(f"no parameter {name!r}, there is: {known}{nearest(name, symbols)}")
        if not (isinstance(value, numbers.Real) or (isinstance(value, sp.Expr) and value.is_extended_real)):
            raise RatfitError(f"{name} = {value!r}: a number is needed")
    values = {symbols[name]: float(value) for name, value in asked.items()}
    for symbol, expression in given.items():
        # A reference may write one of its values in terms of others, its reflectance f in terms of its index n.
        value = _number(expression.subs(given), values, f"{symbol.name} under this reference")
        if values.setdefault(symbol, value) != value:
            raise RatfitError(f"the reference says {symbol.name} = {value}: leave {symbol.name} = {values[symbol]} out")
    for parameter in problem.parameters:
        _check_range(parameter, values)
    return values


def _check_range(parameter: Any, values: Mapping[sp.Symbol, float]) -> None:
    low, high = float(parameter.low), float(parameter.high)
    if parameter not in values:
        raise RatfitError(f"the parameter {parameter.name} has no value: give it one in [{low}, {high}]")
    if not low <= values[parameter] <= high:
        raise RatfitError(f"{parameter.name} = {values[parameter]} is outside its range [{low}, {high}]")


def _check_free(fit: Any, values: Mapping[sp.Symbol, float]) -> None:
    free = sorted(symbol.name for symbol in fit.formula.free_symbols - {fit.problem.variable, *values})
    if free:
        raise RatfitError(f"still free: {', '.join(free)}; choose a value, in [choice] or with --set {free[0]}=...")


def _number(expression: sp.Expr, values: Mapping[sp.Symbol, float], what: str) -> float:
    missing = sorted(symbol.name for symbol in expression.free_symbols - set(values))
    if missing:
        raise RatfitError(f"{what} needs a value of {', '.join(missing)}: add it to the parameters")
    return lower(expression, tuple(values))(*values.values())


def sample(sampling: str, low: float, high: float, samples: int, seed: int) -> Doubles:
    """The points of a sampling protocol, inside the open interval (low, high), in the order of their counters.

    **Fails** with `RatfitError` for an unknown protocol, fewer than one sample, or a seed that is no 64-bit number.
    """
    check_protocol(sampling, samples, seed)
    return draw(sampling, low, high, seed, 0, samples)


def draw(sampling: str, low: float, high: float, seed: int, start: int, size: int, dtype: str = "float64") -> Points:
    """The points `start` to `start + size` of a protocol, drawn in float64 and then rounded to `dtype`.

    A point that rounding carries out of the open interval goes to the last number inside it: nothing is measured at an
    end of its domain, where it may be 0/0, or beyond.
    """
    import jax
    import numpy as np

    first, last = _inside(low, high, dtype)
    with jax.enable_x64(True):
        return _drawing(sampling, size, dtype)(np.uint64(seed), np.uint64(start), low, high, first, last)


def check_protocol(sampling: str, samples: int, seed: int, dtype: str = "float64") -> None:
    """Fails with `RatfitError` for what no measurement can be made of."""
    if sampling not in PROTOCOLS:
        raise RatfitError(f"no sampling {sampling!r}, there is: {', '.join(PROTOCOLS)}{nearest(sampling, PROTOCOLS)}")
    if not isinstance(samples, int) or samples < 1:
        raise RatfitError(f"samples = {samples}: a whole number from 1 upwards is needed")
    if not isinstance(seed, int) or not 0 <= seed < 2**64:
        raise RatfitError(f"seed = {seed}: a whole number from 0 to 2**64 - 1 is needed")
    if dtype not in DTYPES:
        raise RatfitError(f"no dtype {dtype!r}: measure in {' or '.join(DTYPES)}")


def _uniform(fraction: Any, low: Any, high: Any) -> Any:
    return low + (high - low) * fraction


# Each protocol carries a fraction of (0, 1) to a point between the ends.
PROTOCOLS: Mapping[str, Callable[[Any, Any, Any], Any]] = {"uniform": _uniform}


@functools.cache
def _drawing(sampling: str, size: int, dtype: str) -> Callable[..., Any]:
    import jax
    import jax.numpy as jnp

    def points(seed: Any, start: Any, low: Any, high: Any, first: Any, last: Any) -> Any:
        counters = start + jnp.arange(size, dtype=jnp.uint64)
        exact = PROTOCOLS[sampling](_fractions(seed, counters), low, high)
        return jnp.clip(exact.astype(dtype), first, last)

    return jax.jit(points)


def _fractions(seed: Any, counters: Any) -> Any:
    """One number of (0, 1) for each counter: SplitMix64 (splitmix2014), whose state is a counter by construction.

    The seed is mixed first, so that the streams of neighbouring seeds are no shifted copies of one another.
    """
    import jax.numpy as jnp

    golden = jnp.uint64(0x9E3779B97F4A7C15)
    bits = _mixed(_mixed(seed + golden) + (counters + 1) * golden)
    # 52 bits and a half: with 53 the greatest fraction would round to 1.
    return ((bits >> 12).astype(jnp.float64) + 0.5) * 2.0**-52


def _mixed(bits: Any) -> Any:
    import jax.numpy as jnp

    bits = (bits ^ (bits >> 30)) * jnp.uint64(0xBF58476D1CE4E5B9)
    bits = (bits ^ (bits >> 27)) * jnp.uint64(0x94D049BB133111EB)
    return bits ^ (bits >> 31)


def _inside(low: float, high: float, dtype: str) -> tuple[Any, Any]:
    """The least and the greatest number of a dtype strictly between the ends."""
    import numpy as np

    kind = np.dtype(dtype).type
    first, last = kind(low), kind(high)
    first = first if first > low else np.nextafter(first, kind(np.inf))
    last = last if last < high else np.nextafter(last, kind(-np.inf))
    if not first <= last:
        raise RatfitError(f"no {dtype} number lies between {low} and {high}: measure in float64 or widen the domain")
    return first, last
