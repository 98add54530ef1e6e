"""Formulas of a record, drawn where ratfit's own grammar reads them."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

from ratfit._parse import RatfitError, parse_expression
from ratfit.report.document import Formula
from ratfit.report.text import rounded

LONGEST = 600
"""Letters of a formula that a picture of it still makes clearer."""


def formula(text: str, names: Iterable[str]) -> Formula:
    """A formula with its picture in MathML; the text alone where it is long, or no text of the grammar.

    Arguments: `text`; `names`, those of the variable, the parameters and the free coefficients.
    """
    from sympy.printing.mathml import mathml

    if len(text) > LONGEST:
        return Formula(text)
    try:
        expression = parse_expression(text, {name: sp.Symbol(name, real=True) for name in names})
    except RatfitError:
        return Formula(text)  # a record of another version may hold what this one does not read
    drawn = mathml(rounded(expression), printer="presentation")
    return Formula(text, drawn.replace("<mo>-</mo>", "<mo>−</mo>"))
