"""Remedies for what the grammar refuses."""

from __future__ import annotations

import keyword
import re
import unicodedata
from collections.abc import Collection
from typing import TYPE_CHECKING

from ratfit._parse.functions import FUNCTIONS, NOT_REAL
from ratfit._parse.limits import MAX_NAME
from ratfit._parse.reading import current_reading

if TYPE_CHECKING:
    from lark import Token

NOT_FINITE = "not a finite real number; keep to where the function is real"
NO_PYTHON = "a word of Python; write one formula"
ELSEWHERE = {
    "ln": "log(x)",
    "log2": "log(x)/log(2)",
    "log10": "log(x)/log(10)",
    "log1p": "log(1 + x)",
    "expm1": "exp(x) - 1",
    "pow": "x**y",
    "abs": "Abs(x)",
    "max": "Max(x, y)",
    "min": "Min(x, y)",
    "ceil": "ceiling(x)",
    "round": "floor(x + 1/2)",
    "sec": "1/cos(x)",
    "csc": "1/sin(x)",
    "cot": "1/tan(x)",
    "arcsin": "asin(x)",
    "arccos": "acos(x)",
    "arctan": "atan(x)",
    "arctan2": "atan2(y, x)",
    "lgamma": "loggamma(x)",
}
_SIGNS = {
    "^": "write ** for powers",
    ".": "write numbers as 0.5; there is no attribute access",
    "=": "write one formula; there are no comparisons, assignments or keyword arguments",
    ",": "write 0.5 with a point; commas stand between the arguments of a call alone",
    "π": "write pi",
    "∞": "write oo",
    "√": "write sqrt(...)",
    **dict.fromkeys("<>!≤≥≠", "write one formula; there are no comparisons"),
    **dict.fromkeys("[]{}", "write parentheses; there are no subscripts or lists"),
    **dict.fromkeys("'\"`‘’“”", "write names without quotes"),
    **dict.fromkeys("−–—‐", "write an ASCII minus, -"),
    **dict.fromkeys("×·∙⋅", "write *"),
    **dict.fromkeys("÷∕", "write /"),
    **dict.fromkeys("²³", "write **2 or **3 for powers"),
}


def character_remedy(character: str) -> str:
    if character in _SIGNS:
        return _SIGNS[character]
    if character.isascii():
        return "this character has no place in a formula; leave it out"
    if character.isspace():
        return "write an ordinary space"
    greek = re.fullmatch(r"GREEK \w+ LETTER (\w+)", unicodedata.name(character, ""))
    return f"write the letter's name, {greek[1].lower()}" if greek else "write ASCII letters, digits and signs"


def argument_remedy(name: str, argument: str = "...") -> str:
    """What to do about the name of a function without parentheses."""
    return f"a function needs its argument in parentheses; write {name}({argument})"


def token_remedy(before: str, token: Token, after: str, expected: Collection[str]) -> str:
    """What to do about a token between two texts; `expected` are the kinds that the grammar allows there."""
    word = re.search(r"\w*$", before)[0]  # type: ignore[index]
    if keyword.iskeyword(token) or keyword.iskeyword(word):
        return NO_PYTHON
    if "NUMBER" in expected:
        return "an operand is missing; write a number, a name or a parenthesis here"
    if token.type == "$END":
        return "a closing parenthesis is missing"
    if token.type in ("NAME", "NUMBER", "LPAR"):
        return _uncalled(before, token, after) or _juxtaposed(before, token)
    return _SIGNS[","] if token == "," else "no parenthesis is open here; leave it out"


def _uncalled(before: str, token: Token, after: str) -> str:
    """What to do about `sin x`; nothing where no function stands before the token."""
    name = re.search(r"\w*$", before)[0]  # type: ignore[index]
    if name in FUNCTIONS:
        # how far the argument of sin 2*x goes, nobody knows
        is_argument = not after.strip() and token not in FUNCTIONS and len(token) <= MAX_NAME
        return argument_remedy(name, token if is_argument and 1 in FUNCTIONS[name][1] else "...")
    if name.lower() in ELSEWHERE and name not in current_reading.get().names:
        return f"there is no such function; write {ELSEWHERE[name.lower()]}"
    return ""


def _juxtaposed(before: str, token: Token) -> str:
    number = re.search(r"(?<![\w.])[0-9.]+$", before)
    if number and token.startswith("_"):
        return "write the digits without underscores"
    if number and token.lower() in ("i", "j"):
        return NOT_REAL["I"]
    if number and number[0] == "0" and token[0].lower() in "xob":
        return "write the number in decimal digits"
    left = re.search(r"[\w.]+$|.$", before)[0]  # type: ignore[index]
    return f"write {left[-12:]}*{token[:12]}{'(...)' if token in FUNCTIONS else ''} for a product"
