"""A tape as C: one function a tape, with a loop that reads arrays and writes one.

The tape is the only source of the text: operations come from the tables here, numbers are written as hexadecimal
constants, and no name that a user gave enters it. Every operation means what it means in `_lower` on NumPy, nan
included, as far as the flags of the compiler honour nan.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from ratfit._lower import Step, repeated_product
from ratfit._speed.contest import Unsupported

_INFIX: Mapping[str, str] = {
    "add": "+", "subtract": "-", "multiply": "*", "divide": "/",
    "less": "<", "less_equal": "<=", "greater": ">", "greater_equal": ">=", "equal": "==", "not_equal": "!=",
    "logical_and": "&&", "logical_or": "||",
}  # fmt: skip
_PREFIX: Mapping[str, str] = {"negative": "-", "logical_not": "!"}
_CONDITIONS = frozenset(
    ("less", "less_equal", "greater", "greater_equal", "equal", "not_equal", "logical_and", "logical_or", "logical_not")
)
_LIBRARY: Mapping[str, str] = {
    "exp": "exp", "log": "log", "absolute": "fabs", "floor": "floor", "ceil": "ceil", "sqrt": "sqrt", "power": "pow",
    "sin": "sin", "cos": "cos", "tan": "tan", "arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctan2": "atan2",
    "sinh": "sinh", "cosh": "cosh", "tanh": "tanh", "arcsinh": "asinh", "arccosh": "acosh", "arctanh": "atanh",
    "erf": "erf", "erfc": "erfc", "gamma": "tgamma",
}  # fmt: skip
"""The tape's operation -> the function of math.h, which ends in f for float."""
_OWN: Mapping[str, str] = {
    "sign": "sign", "heaviside": "heaviside", "minimum": "lesser", "maximum": "greater", "cbrt": "principal_cbrt",
    "loggamma": "log_gamma",
}  # fmt: skip

_HEADER = """\
#include <math.h>
#include <stddef.h>

typedef {real} real;

/* A program that is linked with -ffast-math starts by having denormal numbers flushed to zero, some of them a hundred
   times as slow as others. Here that holds for the time of a call, and the process keeps its own arithmetic. */
#if defined(__FAST_MATH__) && defined(__SSE__)
#include <xmmintrin.h>
#define BEGIN const unsigned kept = _mm_getcsr(); _mm_setcsr(kept | 0x8040);
#define END _mm_setcsr(kept);
#else
#define BEGIN
#define END
#endif

static inline real sign(real x) {{ return x > 0 ? 1 : x < 0 ? -1 : x == 0 ? 0 : x; }}
static inline real heaviside(real x, real at_zero) {{ return x > 0 ? 1 : x < 0 ? 0 : x == 0 ? at_zero : x; }}
static inline real lesser(real x, real y) {{ return x < y || x != x ? x : y; }}
static inline real greater(real x, real y) {{ return x > y || x != x ? x : y; }}
static inline real principal_cbrt(real x) {{ return x >= 0 ? cbrt{f}(x) : NAN; }}
static inline real log_gamma(real x) {{ return x < 0 ? NAN : lgamma{f}(x); }}

/* -ffast-math takes it for granted that there is no nan, and might leave out a comparison with one. So it is the
   whole number that is held below a last place, which no compiler can know: no nan leads out of the entries. */
static inline real interpolated(const real *entries, unsigned last, real greatest, real position)
{{
    const real held = lesser(greater(position, 0), greatest);
    const real below = floor{f}(held);
    const unsigned found = (unsigned) (int) below;
    const unsigned place = found < last ? found : last; /* so written that gcc vectorises it */
    return entries[place] + (held - below) * (entries[place + 1] - entries[place]);
}}
"""
_TYPES: Mapping[str, Mapping[str, str]] = {
    "float32": {"real": "float", "f": "f"},
    "float64": {"real": "double", "f": ""},
}


def c_source(tapes: Mapping[str, Sequence[Step]], varying: int, dtype: str) -> str:
    """The text of a C file with a function for each tape, by its name.

    **Arguments:** `tapes` by the names that their functions are to have; the first `varying` arguments of each are
    arrays, the others constants; `dtype`.

    **Returns:** functions `void name(size_t count, const real *const *samples, const real *constants, real *out)`. The
    constants are arguments, so that no compiler computes with them beforehand.

    **Fails** with `Unsupported` for an operation or a dtype that C does not have.
    """
    if dtype not in _TYPES:
        raise Unsupported(f"C computes in {' or '.join(_TYPES)}: time {dtype} with a backend of arrays")
    functions = [_function(name, steps, varying, dtype) for name, steps in tapes.items()]
    return "\n".join((_HEADER.format(**_TYPES[dtype]), *functions))


def _function(name: str, steps: Sequence[Step], varying: int, dtype: str) -> str:
    places = {int(step.number) for step in steps if step.operation == "argument"}
    arrays = [f"    const real *restrict x{p} = samples[{p}];" for p in sorted(places) if p < varying]
    constants = [f"    const real c{p} = constants[{p - varying}];" for p in sorted(places) if p >= varying]
    tables = [_table(place, step, dtype) for place, step in enumerate(steps) if step.operation == "table"]
    entries: list[str] = []
    lines: list[str] = []
    for place, step in enumerate(steps):
        text = _value(step, place, entries, varying, dtype)
        if step.operation == "number" or (step.operation == "argument" and step.number >= varying):
            entries.append(text)
            continue
        kind = "int" if step.operation in _CONDITIONS else "real"
        lines.append(f"        const {kind} v{place} = {text};")
        entries.append(f"v{place}")
    return "\n".join(
        (
            f"void {name}(size_t count, const real *const *samples, const real *constants, real *restrict out)",
            "{",
            *tables,
            *arrays,
            *constants,
            "    BEGIN",
            "    for (size_t i = 0; i < count; i++) {",
            *lines,
            f"        out[i] = {entries[-1]};",
            "    }",
            "    END",
            "}",
            "",
        )
    )


def _table(place: int, step: Step, dtype: str) -> str:
    entries = ", ".join(_number(value, dtype) for value in step.table)
    return (
        f"    static const real t{place}[{len(step.table)}] = {{{entries}}};\n"
        f"    const volatile unsigned last{place} = {len(step.table) - 2};\n"
        f"    const unsigned l{place} = last{place};"
    )


def _value(step: Step, place: int, entries: Sequence[str], varying: int, dtype: str) -> str:
    """The C expression of one step."""
    operands = [entries[operand] for operand in step.operands]
    if step.operation == "number":
        return _number(step.number, dtype)
    if step.operation == "argument":
        return f"x{int(step.number)}[i]" if step.number < varying else f"c{int(step.number)}"
    if step.operation == "integer_power":
        return str(repeated_product(_Product(operands[0]), int(step.number)))
    if step.operation == "select":
        return "{} ? {} : {}".format(*operands)
    if step.operation == "table":
        return f"interpolated(t{place}, l{place}, {len(step.table) - 2}, {operands[0]})"
    if step.operation in _INFIX:
        return f" {_INFIX[step.operation]} ".join(operands)
    if step.operation in _PREFIX:
        return f"{_PREFIX[step.operation]}{operands[0]}"
    if step.operation in _LIBRARY:
        return f"{_LIBRARY[step.operation]}{_TYPES[dtype]['f']}({', '.join(operands)})"
    if step.operation in _OWN:
        return f"{_OWN[step.operation]}({', '.join(operands)})"
    raise Unsupported(f"C has no {step.operation}: measure this function with a backend of arrays")


class _Product(str):
    """The text of a product, for `repeated_product` to multiply: C then rounds as NumPy does."""

    __slots__ = ()

    def __mul__(self, other: object) -> _Product:
        return _Product(f"({self} * {other})")


def _number(number: float, dtype: str) -> str:
    """A number to the bit: rounded to the dtype as NumPy rounds a Python float that meets an array."""
    import numpy as np

    with np.errstate(over="ignore"):
        value = float(np.dtype(dtype).type(number))
    if math.isnan(value):
        return "NAN"
    if math.isinf(value):
        return "INFINITY" if value > 0 else "(-INFINITY)"
    return f"({value.hex()}{_TYPES[dtype]['f']})"
