"""Entries of a legend: the kernel conditions of a problem as mathematics, and the candidates that break them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp

from ratfit._condition import AbstractPointCondition, Equation, Integral, Limit
from ratfit._fit import Candidate, Checked
from ratfit._parse import shortened
from ratfit._problem import Problem
from ratfit.plot.style import LETTERS
from ratfit.plot.text import on_a_line, plain, text_width

WIDEST = 340
"""Points that an entry may take: no more than the axes above it."""

ARROW = r"\to"


def letter(problem: Problem) -> str:
    """What the function is called in a picture: f, but where a parameter has that name."""
    taken = {symbol.name for symbol in (problem.variable, *problem.parameters)}
    return next(name for name in "fFgGhyY" if name not in taken)


def said(text: str) -> Any:
    """An entry of the legend that stands for nothing drawn."""
    from matplotlib.lines import Line2D

    return Line2D([], [], linestyle="none", label=text)


def condition_text(checked: Checked, problem: Problem) -> str:
    """A condition as mathematics between dollars, or in plain words where that would be too wide."""
    written = _mathematics(checked, problem)
    return written if text_width(written, 9) <= WIDEST - 50 else plain(checked.stated)


def _mathematics(checked: Checked, problem: Problem) -> str:
    condition, x, f = checked.condition, problem.variable, letter(problem)
    if isinstance(condition, AbstractPointCondition):
        primes = "'" * condition.order if condition.order < 4 else f"^{{({condition.order})}}"
        return _equation(f"{f}{primes}({_math(condition.at)})", checked.demand)
    if isinstance(condition, Limit):
        return _limit_text(condition, checked.demand, x, f)
    if isinstance(condition, Integral):
        low, high = (_math(end) for end in condition.range(problem.domain))
        return _equation(rf"\int_{{{low}}}^{{{high}}} {_weighted(condition.weight, f)}\,d{_math(x)}", checked.demand)
    assert isinstance(condition, Equation)
    more = f", with {condition.order} derivatives" if condition.order else ""
    return f"{_dollars(_math(condition.residual), '= 0')} at {_dollars(_math(x), '=', _math(condition.at))}{more}"


def _weighted(weight: sp.Expr, f: str) -> str:
    above, below = sp.fraction(weight)
    written = f if above == 1 else rf"{_product(above)}\,{f}"
    divisor = rf"\left({_math(below)}\right)" if below.is_Add or below.is_Mul else _math(below)
    return written if below == 1 else f"{written}/{divisor}"


def _limit_text(condition: Limit, demand: sp.Expr, x: sp.Symbol, f: str) -> str:
    to = f"{_math(x)} {ARROW} {_math(condition.at)}"
    difference = f if condition.minus == 0 else rf"\left({f} - {_product(condition.minus)}\right)"
    if condition.scale == 1 and condition.minus != 0:
        difference = f"{f} - {_product(condition.minus)}"
    scale = "" if condition.scale == 1 else _product(condition.scale)
    return f"{_dollars(difference, scale, ARROW, _math(demand))} as {_dollars(to)}"


def _equation(left: str, demand: sp.Expr) -> str:
    return _dollars(left, "=", _math(demand))


def _dollars(*parts: str) -> str:
    return f"${' '.join(parts)}$"


def _product(expression: sp.Expr) -> str:
    written = _math(expression)
    return rf"\left({written}\right)" if expression.is_Add else written


def _math(expression: sp.Expr) -> str:
    written = on_a_line(expression)
    return written if written is not None else rf"\mathrm{{{plain(str(expression))}}}"


def entry(head: str, texts: Sequence[str]) -> str:
    """What an entry is about, and as many of the texts as fit on its line."""
    text = f"{head} {texts[0] if '$' in texts[0] else shortened(texts[0], LETTERS - 10)}"
    for more in dict.fromkeys(texts[1:]):
        longer = f"{text}, {more}"
        if text_width(longer, 9) > WIDEST:
            return f"{text}, …"
        text = longer
    return text


def rejection(candidate: Candidate, problem: Problem) -> str:
    """What was rejected and the conditions that it breaks, or why else."""
    what = shortened(str(candidate.expression), 25)
    broken = [checked for checked in candidate.conditions if checked.holds is False]
    if not broken:
        return plain(shortened(f"rejected: {what}, {candidate.reason}", LETTERS))
    texts = [condition_text(checked, problem) for checked in broken]
    head = plain(f"rejected: {what}, breaks")
    return entry(head if text_width(f"{head} {texts[0]}", 9) <= WIDEST else "rejected, breaks", texts)
