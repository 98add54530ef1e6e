"""A lowered program as one compiled JAX kernel, with the work that depends on fixed parameters alone done once."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp
from sympy.functions.elementary.piecewise import ExprCondPair

from ratfit._lower import Named, lower


@dataclass(frozen=True)
class Program:
    """An expression and the named steps that it is written in; without steps, the expression alone."""

    result: sp.Expr
    steps: Named = ()

    @property
    def free_symbols(self) -> set[sp.Symbol]:
        """The symbols that are given from outside."""
        named = {name for name, _ in self.steps}
        return set().union(self.result.free_symbols, *(part.free_symbols for _, part in self.steps)) - named


@dataclass(frozen=True)
class Hoisted:
    """A program in two: what to compute for every sample, and the `constants` to compute once."""

    result: sp.Expr  # in the varying symbols and the names of `constants` and `steps`
    steps: Named
    constants: Named  # each an expression in the fixed parameters and earlier constants
    varying: tuple[sp.Symbol, ...]

    @property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        """What its function takes: what varies, then the constants."""
        return (*self.varying, *(symbol for symbol, _ in self.constants))

    def values(self, parameters: Mapping[sp.Symbol, float]) -> tuple[float, ...]:
        """The constants at these values of the parameters, computed in float64, in the order of `constants`."""
        known = dict(parameters)
        for name, part in self.constants:
            known[name] = lower(part, tuple(known))(*known.values())
        return tuple(known[name] for name, _ in self.constants)

    def on_arrays(self, values: tuple[float, ...], dtype: str) -> Callable[..., Any]:
        """The function of the samples alone on NumPy, with these values of the constants in `dtype`."""
        function, constants = lower(self.result, self.symbols, "numpy", self.steps), in_dtype(values, dtype)
        return lambda *samples: function(*samples, *constants)


def hoist(program: Program, varying: tuple[sp.Symbol, ...]) -> Hoisted:
    """Take all that does not depend on the varying symbols out of a program.

    The constants enter a kernel as scalars at run time: a sample then costs only what depends on the sample, and one
    compiled kernel serves every setting of the parameters.
    """
    constants: dict[sp.Expr, sp.Symbol] = {}
    moving, steps = set(varying), []

    def constant(part: sp.Expr) -> sp.Expr:
        if not part.free_symbols:
            return part  # the lowering makes one exactly rounded number of it
        return constants.setdefault(part, sp.Dummy(f"c{len(constants)}", real=True))

    def body(node: sp.Basic) -> sp.Basic:
        if isinstance(node, sp.Expr) and not moving & node.free_symbols:
            return constant(node)
        if isinstance(node, (sp.Add, sp.Mul)):
            alone, rest = node.as_independent(*moving, as_Add=isinstance(node, sp.Add))
            fixed = [] if alone == node.identity else [constant(alone)]
            return node.func(*fixed, *map(body, node.func.make_args(rest)), evaluate=False)
        # Rebuilt as it stands: evaluation may be slow, and it may undo how the formula was arranged.
        rebuild = node.func if isinstance(node, ExprCondPair) else functools.partial(node.func, evaluate=False)
        return rebuild(*map(body, node.args)) if node.args else node

    fixed: dict[sp.Symbol, sp.Expr] = {}
    for name, formula in program.steps:
        written = formula.xreplace(fixed)
        if moving & written.free_symbols:
            steps.append((name, body(written)))
            moving.add(name)
        else:
            fixed[name] = constant(written)
    result = body(program.result.xreplace(fixed))
    return Hoisted(result, tuple(steps), tuple((symbol, part) for part, symbol in constants.items()), varying)


def in_dtype(values: tuple[float, ...], dtype: str) -> Any:
    """Numbers as one NumPy array of a dtype; what is beyond it is infinite."""
    import numpy as np

    with np.errstate(all="ignore"):
        return np.asarray(values, float).astype(dtype)


@dataclass(frozen=True)
class Kernel:
    """A program as one compiled JAX kernel of the samples and the constants; to be run in the scope `precision`."""

    hoisted: Hoisted
    function: Callable[..., Any]  # (*samples, *constants) -> array, to be traced within a larger kernel
    jitted: Callable[..., Any]  # the same, compiled

    def constants(self, parameters: Mapping[sp.Symbol, float], dtype: str) -> list[Any]:
        """The constants at these values of the fixed parameters, as NumPy scalars of `dtype`."""
        return list(in_dtype(self.hoisted.values(parameters), dtype))

    def at(self, parameters: Mapping[sp.Symbol, float], dtype: str, device: Any = None) -> Callable[..., Any]:
        """The compiled kernel of the samples alone, at these values of the parameters, with constants in `dtype`."""
        import jax

        with precision(dtype):
            on_device = jax.device_put(self.constants(parameters, dtype), device)  # once: else every call sends them
        return lambda *samples: self.jitted(*samples, *on_device)


@functools.lru_cache(maxsize=64)
def kernel(program: Program, varying: tuple[sp.Symbol, ...]) -> Kernel:
    """The kernel of a program: compiled once for each dtype and size, whatever values the fixed parameters have.

    **Arguments:** the `program`, and the `varying` symbols, of which every sample has a value of its own: the variable
    first, then the parameters that are drawn at random.
    """
    import jax

    hoisted = hoist(program, varying)
    function = lower(hoisted.result, hoisted.symbols, "jax", hoisted.steps)
    return Kernel(hoisted, function, jax.jit(function))


def precision(dtype: str) -> contextlib.AbstractContextManager[Any]:
    """The scope in which JAX computes in `dtype` and nothing wider; the user's own setting stays as it is."""
    import jax

    return jax.enable_x64(dtype == "float64")
