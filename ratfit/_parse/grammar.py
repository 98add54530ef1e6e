"""The grammar, and lark reading a text by it."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import sympy as sp

from ratfit._parse.builder import Builder
from ratfit._parse.errors import Refusal
from ratfit._parse.reading import Reading, current_reading
from ratfit._parse.remedies import character_remedy, token_remedy
from ratfit._parse.veil import unveiled

if TYPE_CHECKING:
    from lark import Lark

_GRAMMAR = r"""
?start: sum
sum: product (SIGN product)*
product: factor (TIMES factor)*
?factor: power | SIGN factor -> signed
?power: atom | atom "**" factor -> power
?atom: NUMBER -> number
     | NAME -> name
     | LPAR sum RPAR -> group
     | NAME LPAR [sum ("," sum)*] RPAR -> call
SIGN: "+" | "-"
TIMES: "*" | "/"
LPAR: "("
RPAR: ")"
NUMBER: /([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?/
NAME: /[A-Za-z_][A-Za-z0-9_]*'*/
%ignore /[ \t\r\n]+/
"""


@functools.cache
def _parser() -> Lark:
    # Loaded on the first text: to import lark and to read the grammar takes longer than all the formulas of a problem.
    from lark import Lark

    return Lark(_GRAMMAR, parser="lalr", lexer="basic", transformer=Builder())


def read(text: str, names: Mapping[str, sp.Expr]) -> sp.Expr:
    parser = _parser()
    from lark.exceptions import UnexpectedCharacters, UnexpectedToken

    token = current_reading.set(Reading(names))
    try:
        node: Any = parser.parse(text)
        return unveiled(node.expr, {})
    except UnexpectedCharacters as error:
        at = error.pos_in_stream or 0
        raise Refusal(character_remedy(text[at]), at, at + 1) from None
    except UnexpectedToken as error:
        at = len(text.rstrip()) if error.token.type == "$END" else error.token.start_pos
        end = at + len(error.token)
        raise Refusal(token_remedy(text[:at].rstrip(), error.token, text[end:], error.expected), at, end) from None
    finally:
        current_reading.reset(token)
