"""The functions and constants of the grammar, and the names that they reserve."""

from __future__ import annotations

import keyword
from collections.abc import Callable, Sequence

import sympy as sp

from ratfit._parse.limits import MAX_ARGUMENTS


def clamp(x: sp.Expr, low: sp.Expr, high: sp.Expr) -> sp.Expr:
    """`x` kept between `low` and `high`."""
    return sp.Min(sp.Max(x, low), high)


_CIRCULAR = ("sin", "cos", "tan", "asin", "acos", "atan")
_HYPERBOLIC = ("sinh", "cosh", "tanh", "asinh", "acosh", "atanh")
SMOOTH = (*_CIRCULAR, *_HYPERBOLIC, "exp", "log", "erf", "erfc", "gamma", "loggamma")
STEPS = ("Abs", "sign", "floor", "ceiling", "Heaviside")
ROOTS = {"sqrt": sp.Rational(1, 2), "cbrt": sp.Rational(1, 3)}

FUNCTIONS: dict[str, tuple[Callable[..., sp.Expr], Sequence[int]]] = {
    **{name: (getattr(sp, name), (1,)) for name in (*SMOOTH, *STEPS, *ROOTS)},
    "atan2": (sp.atan2, (2,)),
    "Min": (sp.Min, range(1, MAX_ARGUMENTS + 1)),
    "Max": (sp.Max, range(1, MAX_ARGUMENTS + 1)),
    "clamp": (clamp, (3,)),
}
"""Every function of the grammar: name -> (sympy function, allowed argument counts)."""

INFINITE = (sp.oo, -sp.oo)
CONSTANTS = {"pi": sp.pi, "E": sp.E, "oo": sp.oo}
NOT_REAL = {
    "I": "expressions are real; there is no imaginary unit",
    "nan": "write a number or a declared name",
    "zoo": "write oo for infinity",
    "inf": "write oo for infinity",
}

RESERVED = frozenset([*FUNCTIONS, *CONSTANTS, *NOT_REAL, *keyword.kwlist])
"""Names that no symbol, parameter or `let` may take."""
