"""Text to sympy expression, by a closed grammar.

Problem files and the command line carry formulas as text from anywhere. Nothing here hands text to `eval`, `sympify` or
`parse_expr`: lark reads it by the grammar below, and every construction is checked *before* sympy sees it, because
sympy evaluates on sight, and short texts (`9**9**9**9`, the sign of a sum that happens to be zero) can keep it busy
for ever. What bounds the time:

- every number that is not rational has a value at two precisions; where the two disagree, or leave the range of a
  double, the text is refused, so that no later question about its sign can be hard;
- powers of rationals are bounded in bits, powers of everything else in exponent;
- step functions of numbers (`Abs`, `sign`, `floor`, ...), `Min` and `Max` are decided here, from those values;
- a function or a power of a sum, or of something long, is left as written, behind a veil (see `_veiled`);
- the whole is bounded in length, depth and size.
"""

from __future__ import annotations

import functools
import keyword
import math
import re
import unicodedata
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from itertools import chain, islice
from typing import TYPE_CHECKING, Any, NamedTuple

import sympy as sp
from mpmath.ctx_mp import MPContext
from sympy.core.function import Application

if TYPE_CHECKING:
    from lark import Lark, Token

MAX_LENGTH = 2000
"""Characters of a text."""
MAX_DEPTH = 50
"""Parentheses, calls, signs and powers within each other."""
MAX_HEIGHT = 150
"""Levels of the expression once the names are put in: sympy recurses over them, several frames a level."""
MAX_SIZE = 3000
"""Parts of the expression once the names are put in."""
MAX_DIGITS = 60
MAX_DECIMAL_EXPONENT = 300
MAX_EXPONENT = 1000
"""Of a power of anything but a rational."""
MAX_BITS = 4096
"""Of numerator and denominator of a rational."""
MAX_ROOT_BITS = 1024
"""Of the rationals under the roots of a product: sympy multiplies and factors them."""
MAX_ORDER_BITS = 1 << 15
"""These bits times the common order of the roots: it raises prime factors to the order."""
MAX_NAME = 32
MAX_ARGUMENTS = 8
SHORT = 12
"""Parts of what sympy may evaluate in its own way."""

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
NAME: /[A-Za-z_][A-Za-z0-9_]*/
%ignore /[ \t\r\n]+/
"""


class RatfitError(ValueError):
    """Bad input; the text says what is wrong and how to mend it."""


class ParseError(RatfitError):
    """Text that is no expression of the grammar; one line with the place, the piece and the remedy."""


def clamp(x: sp.Expr, low: sp.Expr, high: sp.Expr) -> sp.Expr:
    """`x` kept between `low` and `high`."""
    return sp.Min(sp.Max(x, low), high)


_CIRCULAR = ("sin", "cos", "tan", "asin", "acos", "atan")
_HYPERBOLIC = ("sinh", "cosh", "tanh", "asinh", "acosh", "atanh")
_SMOOTH = (*_CIRCULAR, *_HYPERBOLIC, "exp", "log", "erf", "erfc", "gamma", "loggamma")
_STEPS = ("Abs", "sign", "floor", "ceiling", "Heaviside")
_ROOTS = {"sqrt": sp.Rational(1, 2), "cbrt": sp.Rational(1, 3)}

FUNCTIONS: dict[str, tuple[Callable[..., sp.Expr], Sequence[int]]] = {
    **{name: (getattr(sp, name), (1,)) for name in (*_SMOOTH, *_STEPS, *_ROOTS)},
    "atan2": (sp.atan2, (2,)),
    "Min": (sp.Min, range(1, MAX_ARGUMENTS + 1)),
    "Max": (sp.Max, range(1, MAX_ARGUMENTS + 1)),
    "clamp": (clamp, (3,)),
}
"""Every function of the grammar: name -> (sympy function, allowed argument counts)."""

_INFINITE = (sp.oo, -sp.oo)
_CONSTANTS = {"pi": sp.pi, "E": sp.E, "oo": sp.oo}
_NOT_REAL = {
    "I": "expressions are real; there is no imaginary unit",
    "nan": "write a number or a declared name",
    "zoo": "write oo for infinity",
    "inf": "write oo for infinity",
}

RESERVED = frozenset([*FUNCTIONS, *_CONSTANTS, *_NOT_REAL, *keyword.kwlist])
"""Names that no symbol, parameter or `let` may take."""


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
        expr = _read(text, names)
        _check_whole(expr)
    except _Refusal as refusal:
        raise ParseError(refusal.message(text, what)) from None
    return expr


def check_name(name: str, what: str) -> str:
    """The name itself, where a symbol may bear it.

    **Raises:** `RatfitError` when it is no ASCII identifier, starts with an underscore, is longer than 32 characters
    or is reserved.
    """
    if len(name) > MAX_NAME:
        raise RatfitError(f"{what} {_quoted(name)}: a name has at most {MAX_NAME} characters; shorten it")
    if not (name.isascii() and name.isidentifier()) or name.startswith("_"):
        raise RatfitError(f"{what} {_quoted(name)}: write a name as an ASCII letter, then letters, digits, underscores")
    if name in RESERVED:
        raise RatfitError(f"{what} {_quoted(name)}: this name is reserved; take another, such as '{name}_1'")
    return name


def nearest(word: str, known: Iterable[str]) -> str:
    """`"; did you mean 'smith'?"`, with up to three of the known names, or `""` where none is near."""
    by_lower = {name.lower(): name for name in sorted(known, reverse=True)}
    lower = word.lower()[:MAX_NAME]
    near = [lower] if lower in by_lower else get_close_matches(lower, by_lower, n=3)
    quoted = [_quoted(by_lower[name]) for name in near]
    listed = " or ".join(part for part in (", ".join(quoted[:-1]), *quoted[-1:]) if part)
    return f"; did you mean {listed}?" if listed else ""


# Refusals


class _Refusal(Exception):
    """Why a piece of the text is refused; the innermost piece that is known fills in the place."""

    def __init__(self, reason: str, start: int | None = None, end: int | None = None):
        super().__init__(reason)
        self.reason, self.start, self.end = reason, start, end

    def message(self, text: str, what: str) -> str:
        if self.start is None:
            return f"{what}: {self.reason}"
        piece = f", {_quoted(text[self.start : self.end])}" if self.start < len(text) else ""
        return f"{what}, column {self.start + 1}{piece}: {self.reason}"


def _quoted(piece: str) -> str:
    shown = repr(piece)
    return shown if len(shown) <= 40 else f"{shown[:36]}...{shown[0]}"


@contextmanager
def _placed(start: int, end: int) -> Iterator[None]:
    try:
        yield
    except _Refusal as refusal:
        if refusal.start is None:
            refusal.start, refusal.end = start, end
        raise


# Reading. What differs from call to call travels in a context variable, so that the parser is built once.


@dataclass(frozen=True)
class _Reading:
    """What one call knows: names, nodes of names met, values of numbers, and the symbols that veil long parts."""

    names: Mapping[str, sp.Expr]
    nodes: dict[str, _Node] = field(default_factory=dict)
    values: dict[sp.Expr, _Value] = field(default_factory=dict)
    evaluations: dict[tuple[Any, ...], _Value] = field(default_factory=dict)
    veils: dict[sp.Expr, sp.Dummy] = field(default_factory=dict)
    meanings: dict[sp.Expr, sp.Expr] = field(default_factory=dict)


_reading: ContextVar[_Reading] = ContextVar("_reading")


@dataclass(frozen=True, slots=True)
class _Node:
    """A piece of the text read so far. A leading minus waits in `negative`, and a product keeps its `factors`:
    `-(x + 1)/y` and `y/(2*(x + 1))` are one product each, as sympy prints them, and would not come back if the minus
    or the 2 were multiplied into the sum first."""

    expr: sp.Expr
    start: int
    end: int
    depth: int = 0
    size: int = 1
    negative: bool = False
    factors: tuple[sp.Expr, ...] = ()


@functools.cache
def _parser() -> Lark:
    # Loaded on the first text: to import lark and to read the grammar takes longer than all the formulas of a problem.
    from lark import Lark

    return Lark(_GRAMMAR, parser="lalr", lexer="basic", transformer=_Builder())


def _read(text: str, names: Mapping[str, sp.Expr]) -> sp.Expr:
    parser = _parser()
    from lark.exceptions import UnexpectedCharacters, UnexpectedToken

    token = _reading.set(_Reading(names))
    try:
        node: Any = parser.parse(text)
        return _unveiled(node.expr, {})
    except UnexpectedCharacters as error:
        at = error.pos_in_stream or 0
        raise _Refusal(_character_remedy(text[at]), at, at + 1) from None
    except UnexpectedToken as error:
        at = len(text.rstrip()) if error.token.type == "$END" else error.token.start_pos
        remedy = _token_remedy(text[:at].rstrip(), error.token, error.expected)
        raise _Refusal(remedy, at, at + len(error.token)) from None
    finally:
        _reading.reset(token)


class _Builder:
    """What each rule of the grammar makes; lark calls these while it parses, so that no tree is built."""

    def number(self, children: list[Any]) -> _Node:
        (token,) = children
        with _placed(token.start_pos, token.end_pos):
            return _Node(_number(token), token.start_pos, token.end_pos)

    def name(self, children: list[Any]) -> _Node:
        (token,) = children
        nodes = _reading.get().nodes
        with _placed(token.start_pos, token.end_pos):
            if token.value not in nodes:
                nodes[token.value] = _named(token.value)
            return replace(nodes[token.value], start=token.start_pos, end=token.end_pos)

    def group(self, children: list[Any]) -> _Node:
        left, node, right = children
        return _bounded(replace(node, start=left.start_pos, end=right.end_pos, depth=node.depth + 1))

    def call(self, children: list[Any]) -> _Node:
        name, _, *arguments, right = children
        nodes = [node for node in arguments if node is not None]
        around = _around(nodes, name.start_pos, right.end_pos)
        with _placed(around.start, around.end):
            _check_call(name.value, len(nodes))
            return _finished(around, _call(name.value, [_finite(node) for node in nodes]))

    def power(self, children: list[Any]) -> _Node:
        around = _around(children, children[0].start, children[1].end)
        with _placed(around.start, around.end):
            return _finished(around, _power(*map(_finite, children)))

    def signed(self, children: list[Any]) -> _Node:
        sign, node = children
        negative = node.negative ^ (sign == "-")
        return _bounded(replace(node, start=sign.start_pos, depth=node.depth + 1, negative=negative))

    def product(self, children: list[Any]) -> _Node:
        nodes = children[::2]
        if len(nodes) == 1 and not nodes[0].negative:
            return nodes[0]
        if len(nodes) == 1 and nodes[0].expr in _INFINITE:
            return replace(nodes[0], expr=-nodes[0].expr, negative=False)
        around = _around(nodes, nodes[0].start, nodes[-1].end, deeper=0)
        sign = sp.Integer((-1) ** sum(node.negative for node in nodes))
        with _placed(around.start, around.end):
            factors = (sign, *chain.from_iterable(map(_factors, nodes, ["*", *children[1::2]])))
            return replace(_finished(around, _product(factors)), factors=factors)

    def sum(self, children: list[Any]) -> _Node:
        nodes = children[::2]
        if len(nodes) == 1:
            return nodes[0]
        around = _around(nodes, nodes[0].start, nodes[-1].end, deeper=0)
        with _placed(around.start, around.end):
            terms = zip(["+", *children[1::2]], map(_finite, nodes), strict=True)
            return _finished(around, _sum([-term if sign == "-" else term for sign, term in terms]))


def _around(nodes: Sequence[_Node], start: int, end: int, deeper: int = 1) -> _Node:
    """The node around others, before its expression is built: what is too large is not built at all."""
    depth = max((node.depth for node in nodes), default=0)
    return _bounded(_Node(sp.S.Zero, start, end, depth + deeper, 1 + sum(node.size for node in nodes)))


def _bounded(node: _Node) -> _Node:
    if node.depth > MAX_DEPTH:
        raise _Refusal(f"nested deeper than {MAX_DEPTH}; give the inner part a name", node.start, node.end)
    if node.size > MAX_SIZE:
        raise _Refusal(f"more than {MAX_SIZE} parts once the names are put in; shorten it", node.start, node.end)
    return node


def _finished(node: _Node, expr: sp.Expr) -> _Node:
    _check_result(expr)
    return replace(node, expr=expr)


def _finite(node: _Node) -> sp.Expr:
    if node.expr in _INFINITE:
        raise _Refusal("infinity stands alone, as oo or -oo; there is no arithmetic with it", node.start, node.end)
    return -node.expr if node.negative else node.expr


def _factors(node: _Node, operator: str) -> Sequence[sp.Expr]:
    expr = _finite(replace(node, negative=False))
    if operator == "*":
        return [expr]
    with _placed(node.start, node.end):
        return [_power(factor, sp.S.NegativeOne) for factor in (expr != 0 and node.factors) or [expr]]


def _number(text: str) -> sp.Rational:
    mantissa, _, exponent = text.lower().partition("e")
    whole, _, decimals = mantissa.partition(".")
    if len(whole + decimals) > MAX_DIGITS:
        raise _Refusal(f"more than {MAX_DIGITS} digits; round the number")
    # Counted before int() reads them: a long exponent is a longer number.
    if len(exponent) > 5 or abs(int(exponent or 0)) > MAX_DECIMAL_EXPONENT:
        raise _Refusal(f"decimal exponent beyond {MAX_DECIMAL_EXPONENT}; rescale the number")
    power = int(exponent or 0) - len(decimals)
    return sp.Rational(int(whole + decimals) * 10 ** max(power, 0), 10 ** max(-power, 0))


def _named(name: str) -> _Node:
    expr = _CONSTANTS.get(name) or _declared(name)
    _check_height(expr)
    # Names put in may share parts, so that the tree is exponentially larger than the object: the count stops early.
    size = sum(1 for _ in islice(sp.preorder_traversal(expr), MAX_SIZE + 1))
    node = _bounded(_Node(expr, 0, MAX_LENGTH, size=size))
    return replace(node, expr=_veiled_throughout(expr))


def _declared(name: str) -> sp.Expr:
    names = _reading.get().names
    if name in _NOT_REAL:
        raise _Refusal(_NOT_REAL[name])
    if name in FUNCTIONS:
        raise _Refusal(f"a function needs its argument in parentheses; write {name}(...)")
    if keyword.iskeyword(name):
        raise _Refusal(_NO_PYTHON)
    if name not in names:
        raise _Refusal(f"this name is not declared{nearest(name, [*names, *FUNCTIONS, *_CONSTANTS]) or _listed(names)}")
    return names[name]


def _listed(names: Collection[str]) -> str:
    listed = ", ".join(_quoted(name) for name in islice(names, 4))
    return f"; declared: {listed}{', ...' * (len(names) > 4)}" if listed else "; no names are"


# Building, with the checks that come before sympy's evaluation


def _sum(terms: Iterable[sp.Expr]) -> sp.Expr:
    expr = sp.Add(*terms)
    numbers = [term for term in sp.Add.make_args(expr) if _is_number(term)]
    if len(numbers) > 1:
        _value(sp.Add(*numbers))
    return expr


def _product(factors: Sequence[sp.Expr]) -> sp.Expr:
    if sp.S.Zero in factors:
        # sympy would ask each other factor whether it is finite, which may take long.
        return sp.S.Zero
    if not _are_roots_light(factors):
        raise _Refusal("too many digits under the roots of a product; round its numbers")
    parts = chain.from_iterable(map(sp.Mul.make_args, factors))
    return _with_sums_shown(sp.Mul(*map(_sum_veiled, parts)))


def _power(base: sp.Expr, exponent: sp.Expr) -> sp.Expr:
    if base is sp.S.Zero and exponent.is_Rational and exponent < 0:
        raise _Refusal("division by zero; take the zero out of the denominator")
    if _is_number(base) and _is_number(exponent) and base != 0:
        _evaluated("power", [base, exponent])
    if exponent is sp.S.One:
        return base
    _bound_power(base, exponent)
    light = not exponent.is_Rational or _are_roots_light(sp.Mul.make_args(base), exponent)
    exponent = _veiled(exponent) if light else _behind_veil(exponent)
    if base is sp.E:
        return sp.exp(exponent)
    if exponent.is_Integer and base.is_Mul:
        return _with_sums_shown(sp.Mul(*[sp.Pow(_sum_veiled(factor), exponent) for factor in base.args]))
    if exponent.is_Integer and isinstance(base, sp.exp):
        return _power(sp.E, base.args[0] * exponent)
    return _with_sums_shown(sp.Pow(_power_veiled(base, exponent), exponent))


def _power_veiled(base: sp.Expr, exponent: sp.Expr) -> sp.Expr:
    if base.is_Mul and len(base.args) <= SHORT:
        factors = [_veiled(factor) for factor in base.args]
        # A veil shows the sign of a number, and sympy would part it from the rest where it keeps them together.
        return _veiled(base) if any(f.is_Symbol and _is_number(f) for f in factors) else sp.Mul(*factors)
    if not base.is_Pow:
        return _veiled(base)
    inner, power = base.args
    # sympy expands the inner base into real and imaginary parts to tell whether the exponents may be multiplied.
    hidden = _behind_veil if inner.args and not exponent.is_Integer else _veiled
    return sp.Pow(hidden(inner), _veiled(power))


def _are_roots_light(factors: Iterable[sp.Expr], exponent: sp.Expr = sp.S.One) -> bool:
    powers = [part.as_base_exp() for factor in factors for part in sp.Mul.make_args(factor)]
    roots = [(b, e * exponent) for b, e in powers if b.is_Rational and (e * exponent).is_Rational]
    roots = [(b, e) for b, e in roots if not e.is_Integer]
    bits = sum(_bits(b) for b, _ in roots)
    return bits <= MAX_ROOT_BITS and bits * math.lcm(*[int(e.q) for _, e in roots]) <= MAX_ORDER_BITS


def _bound_power(base: sp.Expr, exponent: sp.Expr) -> None:
    """Refuse what sympy would multiply out for long: it splits powers of products and of powers."""
    for factor in sp.Mul.make_args(base):
        inner, outer = factor.as_base_exp()
        total = outer * exponent
        if inner is sp.E:
            _bound_exponential(total)
        elif not total.is_Rational:
            # b**(k/log(b)) becomes E**k.
            _bound_exponential(total * sp.log(inner, evaluate=False))
        elif inner.is_Rational and _bits(inner) * abs(total) > MAX_BITS:
            raise _Refusal("this power has too many digits; use a smaller exponent")
        elif not inner.is_number and abs(total) > MAX_EXPONENT:
            raise _Refusal(f"exponent beyond {MAX_EXPONENT}; use a smaller one")


def _bound_exponential(argument: sp.Expr) -> None:
    # exp(n*log(b)) becomes b**n.
    for term in sp.Add.make_args(argument):
        for factor in sp.Mul.make_args(term):
            if isinstance(factor, sp.log) and (term / factor).is_Rational:
                _bound_power(factor.args[0], term / factor)


def _bits(number: sp.Rational) -> int:
    return max(number.p.bit_length(), number.q.bit_length())


def _check_call(name: str, count: int) -> None:
    if name not in FUNCTIONS:
        if name in _reading.get().names or name in _CONSTANTS:
            raise _Refusal(f"this name is no function; write {name[:MAX_NAME]}*(...) for a product")
        elsewhere = f"; write {_ELSEWHERE[name.lower()]}" if name.lower() in _ELSEWHERE else nearest(name, FUNCTIONS)
        raise _Refusal(f"there is no such function{elsewhere}")
    counts = FUNCTIONS[name][1]
    if count not in counts:
        wanted = f"{min(counts)} to {max(counts)}" if len(counts) > 1 else f"{counts[0]}"
        raise _Refusal(f"{name} takes {wanted} argument{'s' * (max(counts) > 1)}, not {count}")


def _call(name: str, arguments: list[sp.Expr]) -> sp.Expr:
    if name in _ROOTS:
        return _power(arguments[0], _ROOTS[name])
    if name == "exp":
        return _power(sp.E, arguments[0])
    if name == "clamp":
        return _extreme(sp.Min, [_extreme(sp.Max, arguments[:2]), arguments[2]])
    if name in ("Min", "Max"):
        return _extreme(FUNCTIONS[name][0], arguments)
    numbers = all(map(_is_number, arguments))
    if name in _STEPS:
        # sympy's evaluation of these asks for signs in many ways: for a symbol alone they are all short.
        return _step(name, arguments[0]) if numbers else _applied(name, arguments, arguments[0].is_Symbol)
    if numbers:
        _evaluated(name, arguments)
    # loggamma(n) becomes log(gamma(n)), and gamma(n) a number of any length.
    large = name == "loggamma" and numbers and _value(arguments[0]).high > 100
    return _applied(name, arguments, not large and all(map(_is_short, arguments)))


def _applied(name: str, arguments: Sequence[sp.Expr], short: bool) -> sp.Expr:
    function = FUNCTIONS[name][0]
    if short:
        result = function(*arguments)
        # What becomes cot, re or another function outside the grammar stays as it was written.
        if all(part.func.__name__ in FUNCTIONS for part in result.atoms(Application)):
            return result
    return _veiled(function(*arguments, evaluate=False))


def _step(name: str, number: sp.Expr) -> sp.Expr:
    """A step function of a number, from its value: sympy's own way is a search of unknown length."""
    if name in ("floor", "ceiling"):
        return sp.Integer(_floor(number) if name == "floor" else -_floor(-number))
    sign = _sign(number)
    if name == "Heaviside":
        return sp.Rational(sign + 1, 2)
    return sp.Integer(sign) if name == "sign" else sign * number


def _sign(number: sp.Expr) -> int:
    high = _value(number).high
    return int(high > 0) - int(high < 0)


def _floor(number: sp.Expr) -> int:
    if number.is_Rational:
        return int(number.p // number.q)
    low, high = _value(number)
    below = int(_contexts()[1].floor(high))
    # No integer may lie within a generous multiple of the doubt.
    doubt = abs(low - high) * 2**20 + abs(high) * 2.0**-150
    if not below + doubt < high < below + 1 - doubt:
        raise _Refusal("too close to an integer to tell; write the integer")
    return below


def _extreme(function: Any, arguments: Sequence[sp.Expr]) -> sp.Expr:
    """`Min` or `Max`: its numbers are compared here; sympy would compare each pair of arguments at length."""
    parts = [part for argument in arguments for part in _operands(argument, function)]
    numbers = [part for part in parts if _is_number(part)]
    rest = [part for part in parts if not _is_number(part)]
    if numbers:
        wanted = 1 if function is sp.Max else -1
        rest.append(functools.reduce(lambda a, b: b if _sign(b - a) == wanted else a, numbers))
    return rest[0] if len(set(rest)) == 1 else _veiled(function(*rest, evaluate=False))


def _operands(expr: sp.Expr, function: Any) -> Sequence[sp.Expr]:
    meaning = _reading.get().meanings.get(expr, expr)
    return meaning.args if isinstance(meaning, function) else [expr]


# Veils. sympy answers questions about signs by walking through everything below, exponentially often in the depth, and
# it asks them of the base of every power. So a long part is a symbol of its own while the rest is built: behind this
# veil there is nothing to walk through. At the end each symbol gives way to its meaning, and nothing is evaluated anew.


def _is_short(expr: sp.Expr) -> bool:
    meanings = _reading.get().meanings
    parts = list(islice(sp.preorder_traversal(expr), SHORT + 1))
    # For the sign of a sum sympy looks for the roots of its derivative, or for a minimal polynomial.
    if len(parts) > SHORT or any(part in meanings or part.is_Add for part in parts):
        return False
    return all(map(_is_plain, parts)) if _is_number(expr) else _layers(expr) <= 2


def _is_plain(part: sp.Expr) -> bool:
    """Whether a part of a number keeps the number where sympy's comparisons are quick."""
    if part.is_Pow:
        return part.exp.is_Rational and part.exp.q <= 6
    return part.is_Mul or all(arg.is_Rational for arg in part.args)


def _layers(expr: sp.Expr) -> int:
    below = max(map(_layers, expr.args), default=0)
    return below + 1 if expr.args and not expr.is_Mul else below


def _veiled(expr: sp.Expr) -> sp.Expr:
    """The expression itself where it is short or a power of a symbol, or else a symbol that means it."""
    base, exponent = expr.as_base_exp()
    return expr if (base.is_Symbol and exponent.is_Rational) or _is_short(expr) else _behind_veil(expr)


def _behind_veil(expr: sp.Expr) -> sp.Dummy:
    reading = _reading.get()
    if expr not in reading.veils:
        reading.veils[expr] = _new_veil(expr)
        reading.meanings[reading.veils[expr]] = expr
    return reading.veils[expr]


def _new_veil(expr: sp.Expr) -> sp.Dummy:
    if not _is_number(expr):
        return sp.Dummy()
    value = _value(expr)
    symbol = sp.Dummy(positive=value.high > 0, negative=value.high < 0)
    _reading.get().values[symbol] = value
    return symbol


def _sum_veiled(factor: sp.Expr) -> sp.Expr:
    return _veiled(factor) if factor.is_Add else factor


def _with_sums_shown(expr: sp.Expr) -> sp.Expr:
    """A sum or product stays behind its veil under a power; as a factor it takes part in the product."""
    factors = list(sp.Mul.make_args(expr))
    shown = list(map(_shown, factors))
    return expr if shown == factors else sp.Mul(*shown)


def _shown(factor: sp.Expr) -> sp.Expr:
    veil, exponent = factor.as_base_exp()
    meaning = _reading.get().meanings.get(veil)
    if meaning is None or meaning.is_Function or not exponent.is_Integer:
        return factor
    return factor if meaning.is_Add and exponent != 1 else _power(meaning, exponent)


def _veiled_throughout(expr: sp.Expr) -> sp.Expr:
    """An expression from outside, brought into the form of those built here."""
    if not expr.args or _is_short(expr):
        return expr
    args = [_veiled_throughout(arg) for arg in expr.args]
    if expr.is_Add:
        return _sum(args)
    if expr.is_Mul:
        return _product(args)
    if expr.is_Pow:
        return _power(*args)
    return _veiled(expr.func(*args, evaluate=False) if expr.func.__name__ in FUNCTIONS else expr)


def _unveiled(expr: sp.Expr, done: dict[sp.Expr, sp.Expr]) -> sp.Expr:
    meanings = _reading.get().meanings
    if expr not in done:
        if expr in meanings:
            done[expr] = _unveiled(meanings[expr], done)
        elif expr.free_symbols.isdisjoint(meanings):
            done[expr] = expr
        else:
            done[expr] = _rebuilt(expr, [_unveiled(arg, done) for arg in expr.args])
    return done[expr]


def _rebuilt(expr: sp.Expr, args: Sequence[sp.Expr]) -> sp.Expr:
    if expr.is_Add or expr.is_Mul:
        # sympy's own order: an expression is equal to another only with its parts in the same order.
        flat = [part for arg in args for part in expr.func.make_args(arg)]
        number = expr.func(*[part for part in flat if part.is_Rational])
        rest = sorted([part for part in flat if not part.is_Rational], key=_canonical)
        args = rest if number == expr.func.identity else [number, *rest]
    return args[0] if len(args) == 1 and not expr.is_Function else expr.func(*args, evaluate=False)


_canonical = functools.cmp_to_key(sp.Basic.compare)


# Values of numbers, at two precisions: what cancels shows as a disagreement


class _Value(NamedTuple):
    low: Any
    high: Any


@functools.cache
def _contexts() -> tuple[MPContext, MPContext]:
    # Own contexts: mpmath's global precision belongs to the user.
    low, high = MPContext(), MPContext()
    low.prec, high.prec = 192, 256
    return low, high


def _is_number(expr: sp.Expr) -> bool:
    values = _reading.get().values
    return all(symbol in values for symbol in expr.free_symbols)


def _value(number: sp.Expr) -> _Value:
    """The value of a number that this grammar can make; it tells the number from zero."""
    values = _reading.get().values
    if number not in values:
        low, high = value = _computed(number)
        if not number.is_Rational and (not high or abs(low - high) > abs(high) * 2.0**-40):
            raise _Refusal("this number cannot be told from zero; simplify it by hand")
        values[number] = value
    return values[number]


def _computed(number: sp.Expr) -> _Value:
    if number.is_Rational:
        return _in_range([context.mpf(number.p) / number.q for context in _contexts()])
    if number in (sp.pi, sp.E):
        return _in_range([+(context.pi if number is sp.pi else context.e) for context in _contexts()])
    operation = {sp.Add: "fsum", sp.Mul: "fprod", sp.Pow: "power"}.get(number.func, number.func.__name__)
    if operation not in ("fsum", "fprod", "power", "atan2", *_SMOOTH):
        raise _Refusal("this number cannot be evaluated; write it with the functions of the grammar")
    return _evaluated(operation, number.args)


def _evaluated(operation: str, arguments: Sequence[sp.Expr]) -> _Value:
    # Asked for twice: before sympy builds the number, and when its value is wanted.
    evaluations, key = _reading.get().evaluations, (operation, *arguments)
    if key not in evaluations:
        inputs = map(list, zip(*map(_value, arguments), strict=True))
        evaluations[key] = _in_range([_apply(*each, operation) for each in zip(_contexts(), inputs, strict=True)])
    return evaluations[key]


def _apply(context: MPContext, parts: list[Any], operation: str) -> Any:
    function = getattr(context, operation)
    try:
        return function(parts) if operation in ("fsum", "fprod") else function(*parts)
    except (ValueError, ZeroDivisionError, OverflowError):
        raise _Refusal(_NOT_FINITE) from None


def _in_range(parts: Sequence[Any]) -> _Value:
    for context, part in zip(_contexts(), parts, strict=True):
        if not isinstance(part, context.mpf) or not context.isfinite(part):
            raise _Refusal(_NOT_FINITE)
        if part and not 1e-308 < abs(part) < 1e308:
            raise _Refusal("too large or too small for a number; rescale")
    return _Value(*parts)


# Checks of results


def _check_result(expr: sp.Expr) -> None:
    for term in sp.Add.make_args(expr):
        for factor in sp.Mul.make_args(term):
            _check_part(factor)
    if _is_number(expr):
        _value(expr)
    for factor in sp.Mul.make_args(expr):
        if factor.is_Pow:
            _bound_power(factor, sp.S.One)


def _check_part(part: sp.Expr) -> None:
    if part in (sp.nan, sp.zoo, *_INFINITE):
        raise _Refusal(_NOT_FINITE)
    if part.is_Rational and _bits(part) > MAX_BITS:
        raise _Refusal("this number has too many digits; round it")
    if part is sp.I or (part.is_Pow and part.base.is_Rational and part.base < 0 and not part.exp.is_Integer):
        raise _Refusal("not real; keep to where the expression is real")


def _check_height(expr: sp.Expr) -> None:
    level = {expr}
    for _ in range(MAX_HEIGHT):
        level = {arg for part in level for arg in part.args}
    if level:
        raise _Refusal(f"more than {MAX_HEIGHT} levels once the names are put in; simplify it")


def _check_whole(expr: sp.Expr) -> None:
    _check_height(expr)
    if expr not in _INFINITE:
        for part in sp.preorder_traversal(expr):
            _check_part(part)


# Remedies for what the grammar refuses

_NOT_FINITE = "not a finite real number; keep to where the function is real"
_NO_PYTHON = "a word of Python; write one formula"
_ELSEWHERE = {
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


def _check_text(text: str) -> None:
    if not text.strip():
        raise _Refusal("empty; write a formula or a number")
    if len(text) > MAX_LENGTH:
        raise _Refusal(f"longer than {MAX_LENGTH} characters; give its parts names")


def _character_remedy(character: str) -> str:
    if character in _SIGNS:
        return _SIGNS[character]
    if character.isascii():
        return "this character has no place in a formula; leave it out"
    if character.isspace():
        return "write an ordinary space"
    greek = re.fullmatch(r"GREEK \w+ LETTER (\w+)", unicodedata.name(character, ""))
    return f"write the letter's name, {greek[1].lower()}" if greek else "write ASCII letters, digits and signs"


def _token_remedy(before: str, token: Token, expected: Collection[str]) -> str:
    """What to do about a token after the text before it; `expected` are the kinds that the grammar allows there."""
    word = re.search(r"\w*$", before)[0]  # type: ignore[index]
    if keyword.iskeyword(token) or keyword.iskeyword(word):
        return _NO_PYTHON
    if "NUMBER" in expected:
        return "an operand is missing; write a number, a name or a parenthesis here"
    if token.type == "$END":
        return "a closing parenthesis is missing"
    if token.type in ("NAME", "NUMBER", "LPAR"):
        return _juxtaposed(before, token)
    return _SIGNS[","] if token == "," else "no parenthesis is open here; leave it out"


def _juxtaposed(before: str, token: Token) -> str:
    number = re.search(r"(?<![\w.])[0-9.]+$", before)
    if number and token.startswith("_"):
        return "write the digits without underscores"
    if number and token.lower() in ("i", "j"):
        return _NOT_REAL["I"]
    if number and number[0] == "0" and token[0].lower() in "xob":
        return "write the number in decimal digits"
    left = re.search(r"[\w.]+$|.$", before)[0]  # type: ignore[index]
    return f"write {left[-12:]}*{token[:12]} for a product"
