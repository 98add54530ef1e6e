"""A formula in one or three lines of Unicode; sympy's pretty printer loads its physics, a quarter of a cold start."""

from __future__ import annotations

import sympy as sp
from sympy.printing.precedence import PRECEDENCE
from sympy.printing.str import StrPrinter

_RAISED = str.maketrans("0123456789-n", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻ⁿ")
_GREEK = {"pi": "π", "alpha": "α", "beta": "β", "eta": "η", "kappa": "κ", "theta": "θ", "lambda_": "λ"}


class _Line(StrPrinter):
    """sympy's text with signs in place of words: √, π, ·, raised whole exponents."""

    def _print_Pow(self, expr: sp.Pow, rational: bool = False) -> str:
        if expr.exp == sp.Rational(1, 2):
            return f"√{self._boxed(expr.base)}"
        if expr.exp == sp.Rational(-1, 2):
            return f"1/√{self._boxed(expr.base)}"
        raised = str(expr.exp)
        if expr.exp.is_negative and expr.exp.is_Integer:
            inverse = (
                self._print_Pow(sp.Pow(expr.base, -expr.exp, evaluate=False))
                if expr.exp != -1
                else self._boxed(expr.base)
            )
            return f"1/{inverse}"
        if raised.translate(_RAISED) != raised and all(c in "0123456789n" for c in raised):
            return f"{self._boxed(expr.base)}{raised.translate(_RAISED)}"
        return f"{self._boxed(expr.base)}^{self._boxed(expr.exp)}"

    def _boxed(self, expr: sp.Expr) -> str:
        return self.parenthesize(expr, PRECEDENCE["Pow"], strict=False)

    def _print_Mul(self, expr: sp.Mul) -> str:
        return super()._print_Mul(expr).replace("*", "·")

    def _print_Pi(self, expr: sp.Expr) -> str:
        return "π"

    def _print_Symbol(self, expr: sp.Symbol) -> str:
        return _GREEK.get(expr.name, expr.name)


def lines(expression: sp.Expr) -> list[str]:
    """The formula: over a fraction bar in three lines where it is a quotient, else in one."""
    above, below = (_Line().doprint(part).replace(" - ", " − ") for part in sp.fraction(expression))
    if below == "1":
        return [above]
    width = max(len(above), len(below)) + 2
    return [above.center(width).rstrip(), "─" * width, below.center(width).rstrip()]
