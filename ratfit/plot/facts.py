"""Facts of a study as mathematics between dollars, for the legend of its picture."""

from __future__ import annotations

import re

import sympy as sp

from ratfit._condition import Limit
from ratfit._study import Fact, Study
from ratfit._study.fact import SYMBOLIC
from ratfit.plot.entries import ARROW, WIDEST
from ratfit.plot.text import mathematics, on_a_line, plain, text_width

ROOM = WIDEST - 60
"""Points that one fact may take; a wider one is said in plain letters, which are cut."""

_DECIMALS = re.compile(r"\d+\.\d{5,}(?![\de])")
"""Decimals that a picture has no room for."""

_MARKS = re.compile(r"f('*)\(")
"""Where a text names the function at a place, with a prime for each derivative."""


def fact_text(fact: Fact, study: Study) -> str:
    """What the legend says of a fact: mathematics, or its own words where that cannot be set or is too wide."""
    written = _limit(fact, study.target.variable) if isinstance(fact.condition, Limit) else _at_place(fact)
    return written if written is not None and text_width(written, 9) <= ROOM else plain(_in_words(fact))


def title_text(study: Study, room: float) -> str | None:
    """The function as mathematics, None where it takes more than `room` points or cannot be set."""
    written = mathematics(study.target.expression)
    title = f"${written}$"
    return title if written is not None and text_width(title, 10) < room else None


def _at_place(fact: Fact) -> str | None:
    """f(0) = 1, with the primes of a derivative."""
    marks = _MARKS.search(fact.text)
    if marks is None or fact.place is None or fact.value is None:
        return None
    return _dollars((f"f{marks[1]}(", fact.place, ")"), "=", fact.value, is_exact=fact.found == SYMBOLIC)


def _limit(fact: Fact, x: sp.Symbol) -> str | None:
    """What tends to a value on the way to a place; of an oblique asymptote its line."""
    condition, value = fact.condition, fact.value
    if not isinstance(condition, Limit) or value is None:
        return None
    is_exact = fact.found == SYMBOLIC
    if fact.kind == "asymptote" and "the asymptote is" in fact.text:
        return _dollars(condition.minus + value, is_exact=is_exact)
    approach = _dollars(x, ARROW, condition.at)
    head = sp.Symbol("f") - condition.minus
    scaled: tuple[str | sp.Expr | tuple[str, sp.Expr, str], ...] = (head * condition.scale,)
    if condition.scale.is_Add:  # f(x - 1) is read as f at x - 1
        scaled = (("(", head, ")") if head.is_Add else head, r"\cdot", ("(", condition.scale, ")"))
    tends = _dollars(*scaled, ARROW, value, is_exact=is_exact)
    return None if approach is None or tends is None else f"{tends} as {approach}"


def _dollars(*parts: str | sp.Expr | tuple[str, sp.Expr, str], is_exact: bool = True) -> str | None:
    """The parts between dollars, decimals to four digits; None where one cannot be set."""
    written = []
    for part in parts:
        before, inner, after = part if isinstance(part, tuple) else ("", part, "")
        shown = inner if isinstance(inner, str) else on_a_line(inner if is_exact else _short(inner))
        if shown is None:
            return None
        written.append(f"{before}{shown}{after}")
    return f"${' '.join(written)}$"


def _short(number: sp.Expr) -> sp.Expr:
    """A number that was found by numbers, as a decimal for the eye; a whole one as it is."""
    return sp.Float(number, 5) if number.is_Rational and not number.is_Integer else number


def _in_words(fact: Fact) -> str:
    text = fact.text.removeprefix(f"{fact.kind} ").split(" in a ")[0].split(", beyond")[0].split(", of order")[0]
    return _DECIMALS.sub(lambda number: f"{float(number[0]):.5g}", text.split(": the asymptote is ")[-1])
