"""What a formula of this room takes: symbols, expressions and numbers, and of numbers those that mean something.

The formulas are sympy's, so that arrays, text and nothing at all would end in an error of sympy's or, worse, in an
expression that looks right. They are refused where they come in.
"""

import functools
import inspect
from collections.abc import Callable
from numbers import Real
from typing import ParamSpec

from sympy import Expr, Float, S, oo

from ratfit._parse import RatfitError

Formula = ParamSpec("Formula")
Range = tuple[Expr, Expr]

FROM_ZERO: Range = (S.Zero, oo)
"""What is never below 0: roughness, an index, an exponent."""

UNIT: Range = (S.Zero, S.One)
"""What is a part of a whole: a reflectance, a number that is drawn."""


def takes(**ranges: Range) -> Callable[[Callable[Formula, Expr]], Callable[Formula, Expr]]:
    """A formula that refuses arguments which are no real numbers or expressions, and numbers that are impossible.

    **Arguments:** the closed range of each argument that has one, by its name; a cosine has none, for rounding takes
    it out of [-1, 1]. An expression with symbols in it is in every range.

    **Returns** a decorator; the name, the signature and the docstring of the formula stay. **Fails** with `RatfitError`
    when the formula is called.
    """

    def decorated(formula: Callable[Formula, Expr]) -> Callable[Formula, Expr]:
        signature = inspect.signature(formula)

        @functools.wraps(formula)
        def checked(*args: Formula.args, **kwargs: Formula.kwargs) -> Expr:
            for name, value in signature.bind(*args, **kwargs).arguments.items():
                if value is not signature.parameters[name].default:
                    _check(f"{formula.__name__}: {name}", value, ranges.get(name))
            return formula(*args, **kwargs)

        return checked

    return decorated


def _check(what: str, value: object, within: Range | None) -> None:
    if isinstance(value, bool) or not isinstance(value, Expr | Real):
        raise RatfitError(
            f"{what} has the type {type(value).__name__}: give a symbol, a sympy expression or a number; "
            "for arrays, lower the formula with ratfit.lower and give the arrays to that"
        )
    number = value if isinstance(value, Expr) else Float(float(value))
    if number.free_symbols:
        return
    if number.is_extended_real is False or number is S.NaN:
        raise RatfitError(f"{what} is {value}: give a real number")
    if within is not None and S.true in (number < within[0], number > within[1]):
        asked = f"{within[0]} or more" if within[1] is oo else f"a number from {within[0]} to {within[1]}"
        raise RatfitError(f"{what} is {value}: give {asked}")
