"""How texts are set in pictures: formulas as mathematics, numbers without needless digits, and their size."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import sympy as sp
from sympy.printing.latex import LatexPrinter


def plain(text: str) -> str:
    """A text in which matplotlib sees no mathematics."""
    return text.replace("$", r"\$")


LONGEST = 80
"""Operations of a formula that may still fit on a line."""


def mathematics(expression: sp.Expr) -> str | None:
    """An expression as matplotlib sets mathematics, without its dollars; None for a long one and what it cannot set."""
    if expression.count_ops() > LONGEST:
        return None
    return _settable(sp.latex(rounded(expression)).replace(r"\frac", r"\dfrac"))


def on_a_line(expression: sp.Expr) -> str | None:
    """The same with fractions written as pi/2 is, for a line of text: set upright they would need smaller type."""
    if expression.count_ops() > LONGEST:
        return None
    return _settable(_OnALine().doprint(rounded(expression)))


class _OnALine(LatexPrinter):
    """LaTeX without upright fractions. The methods are sympy's hooks, named as its printers need them."""

    def _print_Mul(self, expr: sp.Expr) -> str:
        above, below = sp.fraction(expr, exact=True)
        if below == 1:
            return super()._print_Mul(expr)
        return f"{self._bracketed(above, above.is_Add)}/{self._bracketed(below, below.is_Add or below.is_Mul)}"

    def _print_Rational(self, expr: sp.Rational) -> str:
        return f"{expr.p}/{expr.q}" if expr.q != 1 else str(expr.p)

    def _bracketed(self, expression: sp.Expr, is_needed: bool) -> str:
        written = self._print(expression)
        return rf"\left({written}\right)" if is_needed else written


def _settable(written: str) -> str | None:
    written = written.replace(r"\left|", "|").replace(r"\right|", "|")  # matplotlib's growing bars are too small
    try:
        _measured(f"${written}$", 10)
    except ValueError:  # cases, and other environments of LaTeX
        return None
    return written


def rounded(expression: sp.Expr) -> sp.Expr:
    """The expression with its decimals cut to four digits, for the eye."""
    return expression.xreplace({number: sp.Float(number, 4) for number in expression.atoms(sp.Float)})


def text_width(text: str, size: float) -> float:
    """The width in points of a text at a size in points, mathematics between dollars set as such."""
    return _measured(text, size).width


def text_depth(text: str, size: float) -> float:
    """How far below its line a text reaches, in points."""
    return _measured(text, size).depth


def _measured(text: str, size: float) -> Any:
    from matplotlib.font_manager import FontProperties

    return _parser().parse(text, 72, FontProperties(family="DejaVu Sans", size=size))


@lru_cache(maxsize=1)
def _parser() -> Any:
    """matplotlib's parser of mathematics: it remembers what it has set, and takes long over what it has not."""
    from matplotlib.mathtext import MathTextParser

    return MathTextParser("path")


def significant(number: float, digits: int) -> str:
    """A number to so many digits: "1.9", "120", "3.1e-7", with a true minus."""
    short = float(f"{number:.{digits - 1}e}")
    text = f"{short:.{digits}g}" if not 1e-4 <= abs(short) < 1e5 else f"{short:g}"
    mantissa, _, power = text.partition("e")
    return (mantissa + (f"e{int(power)}" if power else "")).replace("-", "−")
