"""Text to sympy expression, by a closed grammar.

Problem files and the command line carry formulas as text from anywhere. Nothing here hands text to `eval`, `sympify` or
`parse_expr`: lark reads it by the grammar below, and every construction is checked *before* sympy sees it, because
sympy evaluates on sight and some short texts (`9**9**9**9`, the sign of a sum that happens to be zero) would keep it
busy for ever. What makes the time bounded:

- every number that is not rational has a value at two precisions; where the two disagree, or leave the range of a
  double, the text is refused, so that no later question about its sign can be hard;
- powers of rationals are bounded in bits, powers of everything else in exponent;
- `Abs`, `sign`, `Min`, `Max`, `floor`, `ceiling` and `Heaviside` of numbers are decided here, from those values;
- a function of a long argument stays as written, and the whole is bounded in length, depth and size.
"""

from __future__ import annotations

import functools
import keyword
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple

import sympy as sp
from mpmath.ctx_mp import MPContext
from sympy.core.function import Application

if TYPE_CHECKING:
    from lark import Lark

MAX_LENGTH = 2000
MAX_DEPTH = 50
MAX_SIZE = 3000
MAX_DIGITS = 60
MAX_DECIMAL_EXPONENT = 300
MAX_EXPONENT = 1000
MAX_BITS = 4096
MAX_NAME = 32
LONG = 12

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


_ANALYTIC = (
    "sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh exp log erf erfc gamma loggamma".split()
)
_ROOTS = {"sqrt": sp.Rational(1, 2), "cbrt": sp.Rational(1, 3)}
_STEPS = ("Abs", "sign", "floor", "ceiling", "Heaviside")

FUNCTIONS: dict[str, tuple[Callable[..., sp.Expr], Sequence[int]]] = {
    **{name: (getattr(sp, name), (1,)) for name in (*_ANALYTIC, *_ROOTS, *_STEPS)},
    "atan2": (sp.atan2, (2,)),
    "Min": (sp.Min, range(1, 9)),
    "Max": (sp.Max, range(1, 9)),
    "clamp": (clamp, (3,)),
}
"""Every function of the grammar: name -> (sympy function, allowed argument counts)."""

_CONSTANTS = {"pi": sp.pi, "E": sp.E, "oo": sp.oo}
_UNREAL = {
    "I": "expressions are real, there is no imaginary unit",
    "nan": "write a number or a declared name",
    "zoo": "write oo for infinity",
    "inf": "write oo for infinity",
}

RESERVED = frozenset([*FUNCTIONS, *_CONSTANTS, *_UNREAL, *keyword.kwlist])
"""Names that no symbol, parameter or `let` may take."""


def nearest(word: str, known: Iterable[str]) -> str:
    """`"; did you mean 'smith'?"`, with up to three of the known names, or `""` where none is near."""
    by_lower = {name.lower(): name for name in sorted(known, reverse=True)}
    found = [repr(by_lower[near]) for near in get_close_matches(word.lower()[:MAX_NAME], by_lower, n=3)]
    if not found:
        return ""
    return f"; did you mean {' or '.join(filter(None, [', '.join(found[:-1]), found[-1]]))}?"


def check_name(name: str, what: str) -> str:
    """The name itself, where a symbol may bear it.

    **Raises:** `RatfitError` when it is no ASCII identifier, starts with an underscore, is longer than 32 characters
    or is reserved.
    """
    if not (name.isascii() and name.isidentifier()) or name.startswith("_"):
        raise RatfitError(f"{what} {_quoted(name)}: a name is a letter, then letters, digits or underscores (ASCII)")
    if len(name) > MAX_NAME:
        raise RatfitError(f"{what} {_quoted(name)}: a name has at most {MAX_NAME} characters; shorten it")
    if name in RESERVED:
        raise RatfitError(f"{what} {_quoted(name)}: this name is reserved; take another, such as '{name}_'")
    return name


def parse_expression(text: str, names: Mapping[str, sp.Expr], what: str = "expression") -> sp.Expr:
    """The expression that a text means.

    **Arguments:**

    - `text`: numbers (exact: `0.1` is 1/10), declared names, `pi`, `E`, `oo`, the operators `+ - * / **` with Python's
      precedence, parentheses, and calls of `FUNCTIONS`.
    - `names`: the declared names, each with its symbol or with the expression to put in.
    - `what`: what the text is, for messages (`"condition 2, at"`).

    **Returns:** a real sympy expression without `nan`, `zoo` or `I`; `oo` and `-oo` stand alone.

    **Raises:** `ParseError`, within a second on any text.
    """
    try:
        _check_text(text)
        expr = _read(text, names)
        _check_whole(expr)
    except _Refusal as refusal:
        raise ParseError(refusal.message(text, what)) from None
    return expr


# Refusals


class _Refusal(Exception):
    """Why a piece of the text is refused; the place is filled in where it is known."""

    def __init__(self, reason: str, start: int | None = None, end: int | None = None):
        super().__init__(reason)
        self.reason, self.start, self.end = reason, start, end

    def message(self, text: str, what: str) -> str:
        if self.start is None:
            return f"{what}: {self.reason}"
        return f"{what}, column {self.start + 1}, {_quoted(text[self.start : self.end])}: {self.reason}"


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


# Reading: what differs from call to call travels in a context variable, so that the parser is built once


@dataclass(frozen=True)
class _Reading:
    """What one call knows: the names, the values of numbers, and the symbols that stand for long parts."""

    names: Mapping[str, sp.Expr]
    values: dict[sp.Expr, _Value] = field(default_factory=dict)
    symbols: dict[sp.Expr, sp.Dummy] = field(default_factory=dict)
    meanings: dict[sp.Expr, sp.Expr] = field(default_factory=dict)


_reading: ContextVar[_Reading] = ContextVar("_reading")


@dataclass(frozen=True, slots=True)
class _Node:
    """A piece of the text read so far. A leading minus waits in `negative`: `-(x + 1)/y` is one product, as sympy
    prints it, and would not come back if the minus were multiplied into the sum first."""

    expr: sp.Expr
    start: int
    end: int
    depth: int = 0
    size: int = 1
    negative: bool = False


@functools.cache
def _parser() -> Lark:
    # Loaded on the first text: reading the grammar costs more than reading all the formulas of a problem.
    from lark import Lark

    return Lark(_GRAMMAR, parser="lalr", lexer="basic", transformer=_Builder())


def _read(text: str, names: Mapping[str, sp.Expr]) -> sp.Expr:
    from lark.exceptions import UnexpectedCharacters, UnexpectedToken

    parser = _parser()
    token = _reading.set(_Reading(names))
    try:
        node = parser.parse(text)
        return _unveiled(node.expr, {})  # type: ignore[return-value]
    except UnexpectedCharacters as error:
        at = error.pos_in_stream
        raise _Refusal(_character_remedy(text[at]), at, at + 1) from None
    except UnexpectedToken as error:
        at = len(text.rstrip()) if error.token.type == "$END" else error.token.start_pos
        raise _Refusal(_token_remedy(text, error.token, error.expected), at, at + len(error.token)) from None
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
        with _placed(token.start_pos, token.end_pos):
            expr = _named(str(token))
            size = _size(expr)
            node = _bounded(_Node(expr, token.start_pos, token.end_pos, size=size))
            return node if size == 1 else replace(node, expr=_veiled_throughout(expr))

    def group(self, children: list[Any]) -> _Node:
        left, node, right = children
        return _bounded(replace(node, start=left.start_pos, end=right.end_pos, depth=node.depth + 1))

    def call(self, children: list[Any]) -> _Node:
        name, _, *arguments, right = children
        nodes = [node for node in arguments if node is not None]
        with _placed(name.start_pos, right.end_pos):
            _check_call(str(name), len(nodes))
            expr = _call(str(name), [_finite(node) for node in nodes])
            return _joined(expr, nodes, name.start_pos, right.end_pos, 1)

    def power(self, children: list[Any]) -> _Node:
        base, exponent = children
        with _placed(base.start, exponent.end):
            expr = _power(_finite(base), _finite(exponent))
            return _joined(expr, children, base.start, exponent.end, 1)

    def signed(self, children: list[Any]) -> _Node:
        sign, node = children
        negative = node.negative ^ (sign == "-")
        return _bounded(replace(node, start=sign.start_pos, depth=node.depth + 1, negative=negative))

    def product(self, children: list[Any]) -> _Node:
        nodes = children[::2]
        if len(nodes) == 1 and not nodes[0].negative:
            return nodes[0]
        with _placed(nodes[0].start, nodes[-1].end):
            if len(nodes) == 1 and nodes[0].expr.is_infinite:
                return replace(nodes[0], expr=-nodes[0].expr, negative=False)
            sign = sp.Integer((-1) ** sum(node.negative for node in nodes))
            factors = [_factor(node, operator) for operator, node in zip(["*", *children[1::2]], nodes, strict=True)]
            return _joined(_product([sign, *factors]), nodes, nodes[0].start, nodes[-1].end, 0)

    def sum(self, children: list[Any]) -> _Node:
        nodes = children[::2]
        if len(nodes) == 1:
            return nodes[0]
        with _placed(nodes[0].start, nodes[-1].end):
            terms = zip(["+", *children[1::2]], map(_finite, nodes), strict=True)
            expr = _sum([-term if sign == "-" else term for sign, term in terms])
            return _joined(expr, nodes, nodes[0].start, nodes[-1].end, 0)


def _factor(node: _Node, operator: str) -> sp.Expr:
    expr = _finite(replace(node, negative=False))
    if operator == "*":
        return expr
    with _placed(node.start, node.end):
        return _power(expr, sp.S.NegativeOne)


def _joined(expr: sp.Expr, nodes: Sequence[_Node], start: int, end: int, deeper: int) -> _Node:
    _check_result(expr)
    depth = deeper + max(node.depth for node in nodes)
    return _bounded(_Node(expr, start, end, depth, 1 + sum(node.size for node in nodes)))


def _bounded(node: _Node) -> _Node:
    if node.depth > MAX_DEPTH:
        raise _Refusal(f"nested deeper than {MAX_DEPTH}; give the inner part a name", node.start, node.end)
    if node.size > MAX_SIZE:
        raise _Refusal(f"more than {MAX_SIZE} parts once the names are put in; shorten it", node.start, node.end)
    return node


def _finite(node: _Node) -> sp.Expr:
    with _placed(node.start, node.end):
        if node.expr in (sp.oo, -sp.oo):
            raise _Refusal("infinity stands alone, as oo or -oo; there is no arithmetic with it")
    return -node.expr if node.negative else node.expr


def _size(expr: sp.Expr) -> int:
    # Names put in may share parts, so that the tree is exponentially larger than the object: the count stops early.
    return sum(1 for _ in islice(sp.preorder_traversal(expr), MAX_SIZE + 1))


# Leaves


def _number(text: str) -> sp.Rational:
    mantissa, _, exponent = text.lower().partition("e")
    whole, _, decimals = mantissa.partition(".")
    if len(whole + decimals) > MAX_DIGITS:
        raise _Refusal(f"more than {MAX_DIGITS} digits; round the number")
    # The digits are counted before int() sees them: it is quadratic in their number.
    if len(exponent) > 5 or abs(int(exponent or 0)) > MAX_DECIMAL_EXPONENT:
        raise _Refusal(f"decimal exponent beyond {MAX_DECIMAL_EXPONENT}; rescale the number")
    power = int(exponent or 0) - len(decimals)
    digits = int(whole + decimals)
    return sp.Rational(digits * 10 ** max(power, 0), 10 ** max(-power, 0))


def _named(name: str) -> sp.Expr:
    names = _reading.get().names
    if name in _CONSTANTS:
        return _CONSTANTS[name]
    if name in _UNREAL:
        raise _Refusal(_UNREAL[name])
    if name in FUNCTIONS:
        raise _Refusal(f"a function needs its argument in parentheses; write {name}(...)")
    if name in names:
        return names[name]
    raise _Refusal(_undeclared(name, names))


def _undeclared(name: str, names: Mapping[str, sp.Expr]) -> str:
    if keyword.iskeyword(name):
        return "a word of Python, not of an expression; write one formula"
    near = nearest(name, [*names, *FUNCTIONS, *_CONSTANTS])
    if near:
        return f"this name is not declared{near}"
    declared = ", ".join(name[:MAX_NAME] for name in islice(names, 5)) + (", ..." if len(names) > 5 else "")
    return f"this name is not declared; declared: {declared}" if declared else "this name is not declared; none is"


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
    return _unveiled_sums(sp.Mul(*[_veiled(factor) if factor.is_Add else factor for factor in factors]))


def _power(base: sp.Expr, exponent: sp.Expr) -> sp.Expr:
    if base.is_zero and exponent.is_Rational and exponent < 0:
        raise _Refusal("division by zero; take the zero out of the denominator")
    if _is_number(base) and _is_number(exponent) and base and exponent:
        _evaluated("power", [base, exponent])
    if exponent is sp.S.One:
        return base
    _bound_power(base, exponent)
    if base is sp.E:
        return sp.exp(_veiled(exponent))
    if exponent.is_Integer and base.is_Mul:
        factors = [_veiled(factor) if factor.is_Add else factor for factor in base.args]
        return _unveiled_sums(sp.Mul(*[sp.Pow(factor, exponent) for factor in factors]))
    return _unveiled_sums(sp.Pow(_veiled(base), _veiled(exponent)))


def _bound_power(base: sp.Expr, exponent: sp.Expr) -> None:
    """Refuse what sympy would multiply out for long: it splits powers of products and of powers."""
    for factor in sp.Mul.make_args(base):
        inner, outer = factor.as_base_exp()
        total = outer * exponent
        if inner is sp.E:
            _bound_exponential(total)
        elif not total.is_Rational:
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
            raise _Refusal(f"this name is no function; write {name}*(...) for a product")
        raise _Refusal(f"there is no such function{nearest(name, FUNCTIONS)}")
    counts = FUNCTIONS[name][1]
    if count not in counts:
        wanted = f"{min(counts)} to {max(counts)} arguments" if len(counts) > 1 else f"{counts[0]} argument(s)"
        raise _Refusal(f"{name} takes {wanted}, not {count}")


def _call(name: str, arguments: list[sp.Expr]) -> sp.Expr:
    if name in _ROOTS:
        return _power(arguments[0], _ROOTS[name])
    if name == "exp":
        return _power(sp.E, arguments[0])
    if name == "clamp":
        return _extreme("Min", [_extreme("Max", arguments[:2]), arguments[2]])
    if name in ("Min", "Max"):
        return _extreme(name, arguments)
    numbers = all(_is_number(argument) for argument in arguments)
    if name in _STEPS:
        return _step(name, arguments[0]) if numbers else _applied(name, arguments, arguments[0].is_Symbol)
    if numbers:
        _evaluated(name, arguments)
    # sympy makes log(gamma(n)) of loggamma(n), and gamma(n) a number of any length
    long = name == "loggamma" and numbers and arguments[0] > 170
    return _applied(name, arguments, not long and all(map(_is_short, arguments)))


def _applied(name: str, arguments: Sequence[sp.Expr], short: bool) -> sp.Expr:
    function = FUNCTIONS[name][0]
    if short:
        result = function(*arguments)
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
    doubt = abs(low - high) * 2**20 + abs(high) * 2.0**-200
    if not below + doubt < high < below + 1 - doubt:
        raise _Refusal("too close to an integer to tell; write the integer")
    return below


def _extreme(name: str, arguments: Sequence[sp.Expr]) -> sp.Expr:
    function = FUNCTIONS[name][0]
    parts = [part for argument in arguments for part in _operands(argument, function)]
    numbers = [part for part in parts if _is_number(part)]
    rest = [part for part in parts if not _is_number(part)]
    if numbers:
        rest.append(functools.reduce(lambda a, b: a if (_sign(a - b) >= 0) == (name == "Max") else b, numbers))
    if len(set(rest)) == 1:
        return rest[0]
    return _applied(name, rest, len(rest) <= 3 and all(part.is_Symbol or part.is_Rational for part in rest))


def _operands(expr: sp.Expr, function: Any) -> Sequence[sp.Expr]:
    meaning = _reading.get().meanings.get(expr, expr)
    return meaning.args if isinstance(meaning, function) else [expr]


# Veils: a long part is a symbol of its own while the rest is built. sympy answers questions about signs by walking
# through everything below, exponentially often in the depth; behind a veil there is nothing to walk through.


def _is_short(expr: sp.Expr) -> bool:
    meanings = _reading.get().meanings
    if expr in meanings:
        return False
    parts = list(islice(sp.preorder_traversal(expr), LONG + 1))
    return len(parts) <= LONG and not any(part in meanings for part in parts) and _layers(expr) <= 2


def _layers(expr: sp.Expr) -> int:
    below = max(map(_layers, expr.args), default=0)
    return below if not expr.args or expr.is_Add or expr.is_Mul else below + 1


def _veiled(expr: sp.Expr) -> sp.Expr:
    """The expression itself where it is short or a power of a symbol, or else a symbol that means it."""
    base, exponent = expr.as_base_exp()
    if base.is_Symbol and exponent.is_Rational or _is_short(expr):
        return expr
    reading = _reading.get()
    if expr not in reading.symbols:
        value = _value(expr) if _is_number(expr) else None
        symbol = sp.Dummy() if value is None else sp.Dummy(positive=value.high > 0, negative=value.high < 0)
        reading.symbols[expr], reading.meanings[symbol] = symbol, expr
        if value is not None:
            reading.values[symbol] = value
    return reading.symbols[expr]


def _unveiled_sums(expr: sp.Expr) -> sp.Expr:
    """A sum stands behind a veil only under a power: as a factor it has to take part in what sympy does with sums."""
    meanings = _reading.get().meanings
    factors = sp.Mul.make_args(expr)
    shown = [meanings[factor] if factor in meanings and not meanings[factor].is_Function else factor for factor in factors]
    return expr if shown == list(factors) else sp.Mul(*shown)


def _veiled_throughout(expr: sp.Expr) -> sp.Expr:
    """An expression from outside, brought into the form that the others have."""
    if not expr.args or _is_short(expr):
        return expr
    args = [_veiled_throughout(arg) for arg in expr.args]
    if expr.is_Add:
        return _sum(args)
    if expr.is_Mul:
        return _product(args)
    return _power(*args) if expr.is_Pow else _veiled(expr.func(*args, evaluate=False))


def _unveiled(expr: sp.Expr, done: dict[sp.Expr, sp.Expr]) -> sp.Expr:
    """The expression with every symbol replaced by what it means, and nothing evaluated anew."""
    meanings = _reading.get().meanings
    if expr not in done:
        if expr in meanings:
            done[expr] = _unveiled(meanings[expr], done)
        elif expr.free_symbols.isdisjoint(meanings):
            done[expr] = expr
        else:
            args = [_unveiled(arg, done) for arg in expr.args]
            if expr.is_Add or expr.is_Mul:
                args = sorted(
                    [part for arg in args for part in expr.make_args(arg)],
                    key=lambda arg: (not arg.is_Rational, _order(arg)),
                )
            done[expr] = expr.func(*args, evaluate=False)
    return done[expr]


_order = functools.cmp_to_key(sp.Basic.compare)


# Values of numbers, at two precisions: what cancels shows as a disagreement


class _Value(NamedTuple):
    low: Any
    high: Any


@functools.cache
def _contexts() -> tuple[MPContext, MPContext]:
    # Own contexts: mpmath's global precision belongs to the user.
    low, high = MPContext(), MPContext()
    low.prec, high.prec = 256, 384
    return low, high


def _value(number: sp.Expr) -> _Value:
    """The value of a number that this grammar can make; it tells the number from zero."""
    values = _reading.get().values
    if number not in values:
        values[number] = _settled(number, _computed(number))
    return values[number]


def _computed(number: sp.Expr) -> _Value:
    if number.is_Rational:
        return _in_range(_Value(*[context.mpf(number.p) / number.q for context in _contexts()]))
    if number in (sp.pi, sp.E):
        return _Value(*[+(context.pi if number is sp.pi else context.e) for context in _contexts()])
    operation = {sp.Add: "fsum", sp.Mul: "fprod", sp.Pow: "power"}.get(number.func, number.func.__name__)
    if operation not in ("fsum", "fprod", "power", "atan2", *_ANALYTIC):
        raise _Refusal("this number cannot be evaluated; write it with the functions of the grammar")
    return _evaluated(operation, number.args)


def _evaluated(operation: str, arguments: Sequence[sp.Expr]) -> _Value:
    values = [_value(argument) for argument in arguments]
    results = []
    for context, inputs in zip(_contexts(), zip(*values, strict=True), strict=True):
        try:
            function = getattr(context, operation)
            results.append(function(inputs) if operation in ("fsum", "fprod") else function(*inputs))
        except (ValueError, ZeroDivisionError, OverflowError):
            raise _Refusal("not a finite real number; keep to where the function is real") from None
    return _in_range(_Value(*results))


def _in_range(value: _Value) -> _Value:
    for context, part in zip(_contexts(), value, strict=True):
        if not isinstance(part, context.mpf) or not context.isfinite(part):
            raise _Refusal("not a finite real number; keep to where the function is real")
        if part and not 1e-308 < abs(part) < 1e308:
            raise _Refusal("too large or too small for a number; rescale")
    return value


def _is_number(expr: sp.Expr) -> bool:
    values = _reading.get().values
    return all(symbol in values for symbol in expr.free_symbols)


def _settled(number: sp.Expr, value: _Value) -> _Value:
    low, high = value
    if not number.is_Rational and (not high or abs(low - high) > abs(high) * 2.0**-40):
        raise _Refusal("this number cannot be told from zero; simplify it by hand")
    return value


# Checks of results


def _check_result(expr: sp.Expr) -> None:
    _check_real(sp.Add.make_args(expr))
    if _is_number(expr):
        _value(expr)
    for factor in sp.Mul.make_args(expr):
        if factor.is_Rational and _bits(factor) > MAX_BITS:
            raise _Refusal("this number has too many digits; round it")
        if factor.is_Pow:
            _bound_power(factor, sp.S.One)


def _check_real(terms: Iterable[sp.Expr]) -> None:
    for term in terms:
        for factor in sp.Mul.make_args(term):
            _check_part(factor)


def _check_part(part: sp.Expr) -> None:
    if part in (sp.nan, sp.zoo, sp.oo, -sp.oo):
        raise _Refusal("not a finite number; keep to where the expression is defined")
    root = part.is_Pow and part.args[0].is_Rational and part.args[0] < 0 and not part.args[1].is_integer
    if part is sp.I or root:
        raise _Refusal("not real; keep to where the expression is real")


def _check_whole(expr: sp.Expr) -> None:
    if expr in (sp.oo, -sp.oo):
        return
    for part in sp.preorder_traversal(expr):
        _check_part(part)


# Remedies for what the grammar refuses


def _check_text(text: str) -> None:
    if not text.strip():
        raise _Refusal("empty; write a formula or a number")
    if len(text) > MAX_LENGTH:
        raise _Refusal(f"longer than {MAX_LENGTH} characters; give its parts names")


_SIGNS = {
    "^": "write ** for powers",
    ".": "write numbers as 0.5; there is no attribute access",
    "=": "write one formula; there are no comparisons, assignments or keyword arguments",
    "π": "write pi",
    "∞": "write oo",
    "√": "write sqrt(...)",
    **dict.fromkeys("<>!", "write one formula; there are no comparisons"),
    **dict.fromkeys("[]{}", "write parentheses; there are no subscripts or lists"),
    **dict.fromkeys("'\"`‘’“”", "write names without quotes"),
    **dict.fromkeys("−–—‐", "write an ASCII minus, -"),
    **dict.fromkeys("×·∙⋅", "write *"),
    **dict.fromkeys("÷∕", "write /"),
    **dict.fromkeys("²³", "write **2 or **3 for powers"),
}


def _character_remedy(character: str) -> str:
    if character in _SIGNS:
        return _SIGNS[character]
    if character.isascii():
        return "this character has no place in a formula; leave it out"
    if character.isspace():
        return "write an ordinary space"
    name = unicodedata.name(character, "").split()
    if name[:3:2] == ["GREEK", "LETTER"]:
        return f"write the letter's name in ASCII, such as {name[3].lower()}"
    return "write ASCII letters, digits and signs alone"


def _token_remedy(text: str, token: Any, expected: set[str]) -> str:
    before = text[: token.start_pos].rstrip() if token.type != "$END" else text.rstrip()
    if token.type == "$END":
        return "a closing parenthesis is missing" if "SIGN" not in expected or "RPAR" in expected else "an operand is missing"
    return "xx"
