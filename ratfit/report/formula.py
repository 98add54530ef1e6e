"""Formulas of a record, drawn where ratfit's own grammar reads them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy as sp

from ratfit._parse import RatfitError, parse_expression
from ratfit.report.document import Formula
from ratfit.report.text import rounded

LONGEST = 600
"""Letters of a formula that a picture of it still makes clearer."""


def formula(text: str, fit: Mapping[str, Any]) -> Formula:
    """A formula with its picture in MathML; the text alone where it is long, or no text of the grammar.

    Arguments: `text`; `fit`, as `derive --format json` prints it, which names the variable, the parameters and the
    free coefficients that the text may hold.
    """
    from sympy.printing.mathml import mathml

    if len(text) > LONGEST:
        return Formula(text)
    try:
        drawn = mathml(rounded(parse_expression(text, _symbols(fit))), printer="presentation")
    except RatfitError:
        return Formula(text)  # a record of another version may hold what this one does not read
    return Formula(text, drawn.replace("<mo>-<", "<mo>−<").replace("<mn>-", "<mn>−"))


def _symbols(fit: Mapping[str, Any]) -> dict[str, sp.Symbol]:
    """The names of a fit, with the signs that their ranges give: the root of a square is then drawn without bars."""
    lows = {name: ends[0] for name, ends in fit["parameters"].items() if ends}
    lows |= {free["name"]: free["range"][0] for free in fit["free"]}
    parameters = {name: sp.Symbol(name, real=True, nonnegative=_sign(low)) for name, low in lows.items()}
    return {**parameters, fit["variable"]: sp.Symbol(fit["variable"], real=True)}


def _sign(low: str) -> bool | None:
    """True where a range begins at 0 or above; None where that is not known."""
    return parse_expression(low, {}).is_nonnegative or None
