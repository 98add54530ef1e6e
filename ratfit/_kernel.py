"""A lowered expression as one compiled JAX kernel, with the work that depends on parameters alone done once."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp
from sympy.functions.elementary.piecewise import ExprCondPair

from ratfit._lower import lower


@dataclass(frozen=True)
class Hoisted:
    """An expression in two: the `body` to compute for every sample, the `constants` to compute once."""

    body: sp.Expr  # in the variable and the symbols of `constants`
    constants: tuple[tuple[sp.Symbol, sp.Expr], ...]  # each an expression in the parameters alone

    def values(self, parameters: Mapping[sp.Symbol, float]) -> tuple[float, ...]:
        """The constants at these values of the parameters, computed in float64, in the order of `constants`."""
        return tuple(lower(part, tuple(parameters))(*parameters.values()) for _, part in self.constants)


def hoist(expression: sp.Expr, variable: sp.Symbol) -> Hoisted:
    """Take all that depends on parameters alone out of an expression.

    The constants enter a kernel as scalars at run time: a sample then costs only what depends on the sample, and one
    compiled kernel serves every setting of the parameters.
    """
    names: dict[sp.Expr, sp.Symbol] = {}

    def constant(part: sp.Expr) -> sp.Expr:
        if not part.free_symbols:
            return part  # the lowering makes one exactly rounded number of it
        return names.setdefault(part, sp.Dummy(f"c{len(names)}", real=True))

    def body(node: sp.Basic) -> sp.Basic:
        if isinstance(node, sp.Expr) and variable not in node.free_symbols:
            return constant(node)
        if isinstance(node, (sp.Add, sp.Mul)):
            alone, rest = node.as_independent(variable, as_Add=isinstance(node, sp.Add))
            fixed = [] if alone == node.identity else [constant(alone)]
            return node.func(*fixed, *map(body, node.func.make_args(rest)), evaluate=False)
        # Rebuilt as it stands: evaluation may be slow, and it may undo how the formula was arranged.
        rebuild = node.func if isinstance(node, ExprCondPair) else functools.partial(node.func, evaluate=False)
        return rebuild(*map(body, node.args)) if node.args else node

    return Hoisted(body(sp.sympify(expression, strict=True)), tuple((symbol, part) for part, symbol in names.items()))


@dataclass(frozen=True)
class Kernel:
    """An expression as one compiled JAX kernel of the samples and the constants; to be run in the scope `precision`."""

    hoisted: Hoisted
    jitted: Callable[..., Any]  # (samples, *constants) -> array

    def at(self, parameters: Mapping[sp.Symbol, float], dtype: str, device: Any = None) -> Callable[[Any], Any]:
        """The kernel of the samples alone, at these values of the parameters, with the constants in `dtype`."""
        import jax
        import numpy as np

        with np.errstate(all="ignore"):
            constants = [np.asarray(value).astype(dtype) for value in self.hoisted.values(parameters)]
        with precision(dtype):
            on_device = jax.device_put(constants, device)  # here, once: else every call sends them
        return lambda samples: self.jitted(samples, *on_device)


@functools.lru_cache(maxsize=64)
def kernel(expression: sp.Expr, variable: sp.Symbol) -> Kernel:
    """The kernel of an expression: compiled once for each dtype and size, whatever values the parameters have."""
    import jax

    hoisted = hoist(expression, variable)
    symbols = (variable, *(symbol for symbol, _ in hoisted.constants))
    return Kernel(hoisted, jax.jit(lower(hoisted.body, symbols, "jax")))


def precision(dtype: str) -> contextlib.AbstractContextManager[Any]:
    """The scope in which JAX computes in `dtype` and nothing wider; the user's own setting stays as it is."""
    import jax

    return jax.enable_x64(dtype == "float64")
