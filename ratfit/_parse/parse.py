"""The verb: text to sympy expression, or one line that says what to do."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from ratfit._parse.checks import check_whole
from ratfit._parse.errors import ParseError, Refusal
from ratfit._parse.grammar import read
from ratfit._parse.limits import MAX_LENGTH


def parse_expression(text: str, names: Mapping[str, sp.Expr], what: str = "expression") -> sp.Expr:
    """The expression that a text means.

    **Arguments:**

    - `text`: numbers (exact: `0.1` is 1/10), declared names, `pi`, `E`, `oo`, the operators `+ - * / **` with Python's
      precedence, parentheses, and calls of `FUNCTIONS`.
    - `names`: the declared names, each with its symbol or with the expression to put in.
    - `what`: what the text is, for messages (`"condition 2, at"`).

    **Returns:** a real sympy expression without `nan`, `zoo` or `I`; `oo` and `-oo` stand alone. What sympy prints
    comes back as it was. `Min`, `Max`, and functions and roots of sums and of long arguments are not simplified.

    **Raises:** `ParseError`, within a second on any text.
    """
    try:
        _check_text(text)
        expr = read(text, names)
        check_whole(expr)
    except Refusal as refusal:
        raise ParseError(refusal.message(text, what)) from None
    return expr


def _check_text(text: str) -> None:
    if not text.strip():
        raise Refusal("empty; write a formula or a number")
    if len(text) > MAX_LENGTH:
        raise Refusal(f"longer than {MAX_LENGTH} characters; give its parts names")
