"""An expression arranged for evaluation: Horner, shared parts, hoisted constants; operation counts.

`schedule` compiles an expression in a handful of arrangements into straight-line programs with value numbering, counts
the operations of each and keeps the cheapest. The arrangements: as given; the numerator and the denominator factored,
or multiplied out, each by Horner's rule; about a shifted centre (the root of a linear factor, or the point about which
a factor loses its second term); with factors made monic, or with the constant in front drawn into one of them; the
denominator in terms of the numerator; polynomial part plus proper fraction; even and odd parts shared between
`N(x)` and `D(x) = N(-x)`; repeated parts taken out.

The algebra is rational arithmetic over a field in which every parameter, radical and irrational number is one opaque
generator. It is bounded in size: an expression that grows too large is compiled as it was given.
"""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple, TypeVar

import mpmath
import sympy as sp
from sympy import QQ, lex
from sympy.polys.fields import FracField
from sympy.polys.rings import PolyRing

_CLAMPS = (sp.Min, sp.Max, sp.Abs)
_MOST_TERMS = 60  # of a polynomial
_MOST_VOLUME = 300  # monomials up to the degrees of a polynomial that is worth factoring
_MOST_COEFFICIENT = 100  # the same for a coefficient
_MOST_MOVED = 16  # degree of a polynomial that is moved to a centre, or divided
_MOST_GENERATORS = 9
_MOST_DEGREE = 64
_MOST_CENTRES = 3
_LOSS = 64  # how many times worse than the input an arrangement may round


class _Refused(Exception):
    """An arrangement that must not be used: it grows too large, or divides by what may be zero."""


@dataclass(frozen=True)
class Cost:
    """Operations for each sample; subtractions are additions, and what depends on parameters alone is free.

    `other` counts functions: roots, powers with an exponent that is no integer, exponentials and the like.
    """

    add: int = 0
    mul: int = 0
    div: int = 0
    other: int = 0

    @property
    def weight(self) -> int:
        """One number to compare by: a division is worth about 4 multiplications, a function about 20."""
        return self.add + self.mul + 4 * self.div + 20 * self.other

    def as_dict(self) -> dict[str, int]:
        return {"add": self.add, "mul": self.mul, "div": self.div, "other": self.other}


@dataclass(frozen=True)
class Schedule:
    """A straight-line program for one expression in one variable.

    `constants` depend on parameters alone and are computed once. Each of `steps` is one operation on the variable,
    parameters, integers and earlier names: a sum `a + b` or `a - b`, a product `a*b` (a square is an unevaluated
    `Mul(a, a)`), a quotient `a/b`, or a function call. A clamp (`Min`, `Max`, `Abs`, `Piecewise`) is a step that
    costs nothing; the conditions of a `Piecewise` stay in the variable and the parameters.
    """

    variable: sp.Symbol
    constants: tuple[tuple[sp.Symbol, sp.Expr], ...]
    steps: tuple[tuple[sp.Symbol, sp.Expr], ...]
    result: sp.Expr
    cost: Cost

    def expression(self) -> sp.Expr:
        """The program put together again: equal to the expression that was scheduled, in another arrangement."""
        known: dict[sp.Expr, sp.Expr] = {}
        for name, formula in self.constants + self.steps:
            known[name] = formula.xreplace(known)
        return self.result.xreplace(known)


Ranges = Mapping[sp.Symbol, tuple[sp.Expr, sp.Expr]]


def schedule(expression: sp.Expr, variable: sp.Symbol, ranges: Ranges | None = None) -> Schedule:
    """The cheapest arrangement found of an expression, by the weight of its operations on each sample.

    **Arguments:**

    - `expression`: any expression; all its symbols but `variable` are parameters. A decimal number is read as what
        its shortest form says: 0.1 is 1/10.
    - `variable`: what changes from sample to sample.
    - `ranges`: `symbol -> (low, high)` for the variable and the parameters, as far as they are known; the ends of the
        variable's range may name parameters. They decide signs, next to the symbols' own assumptions, and
        say where the rounding is looked at; a symbol without a range is looked at on [0, 1].

    **Returns:** a `Schedule`; the same one for the same arguments, and on equal weights the arrangement that
    is closest to the input.

    **Guaranteed:** the arrangement equals the input as a function of the variable and the parameters, wherever
    the input is finite. No division by a parameter expression is brought in that may be zero, and no root of one that
    may be negative: where signs are not known, the arrangements that need them are left out.

    **Not guaranteed:** that no cheaper arrangement exists; or a rounding error. Five points of the ranges are tried in
    24-bit arithmetic, and an arrangement whose worst error there, against the peak, is more than 64 times that of
    the input as given is passed over. This catches a shift that cancels; it bounds nothing between the points, nor
    the relative error next to a zero.

    **Raises:** `ValueError` when the expression is infinite or not a number.
    """
    expression = _exact(sp.sympify(expression))
    if expression.has(sp.nan, sp.zoo, sp.oo, -sp.oo):
        raise ValueError(f"{expression} is not finite: take the limit first, then schedule what it gives")
    context = _Context(variable, ranges or {})
    return _written(_compiled(context, _plan(context, expression)), variable, expression.free_symbols | {variable})


def _exact(expression: sp.Expr) -> sp.Expr:
    """Floating-point numbers become the rationals that they stand for."""
    floats = {number: sp.Rational(repr(float(number))) for number in expression.atoms(sp.Float)}
    return expression.xreplace(floats)


@dataclass(frozen=True)
class _Context:
    """What is known beforehand, and the plans already made for subexpressions."""

    variable: sp.Symbol
    ranges: Ranges
    plans: dict[sp.Expr, _Plan] = field(default_factory=dict)

    def varies(self, expression: sp.Basic) -> bool:
        return self.variable in expression.free_symbols


# --- The program: straight-line, with value numbering -------------------------------------------------------------


@dataclass(frozen=True)
class _Select:
    """A `Piecewise` waiting for the values of its branches."""

    conditions: tuple[Any, ...]

    def __call__(self, *values: sp.Expr) -> sp.Expr:
        return sp.Piecewise(*zip(values, self.conditions, strict=True))


@dataclass(frozen=True)
class _Whole:
    """Something that is not taken apart, such as an integral."""

    node: sp.Expr

    def __call__(self) -> sp.Expr:
        return self.node


@dataclass(frozen=True)
class _Operation:
    kind: str  # add, sub, mul, div, call
    operands: tuple[sp.Expr, ...]
    head: Callable[..., sp.Expr] | None = None


class _Value(NamedTuple):
    """A step, the variable or a parameter expression, up to its sign.

    Signs ride along because nearly every operation takes one for nothing: `a + (-b)` is a subtraction.
    """

    atom: sp.Expr
    negative: bool = False

    @property
    def signed(self) -> sp.Expr:
        return -self.atom if self.negative else self.atom


class _Program(NamedTuple):
    operations: dict[sp.Expr, _Operation]
    result: sp.Expr


class _Tape:
    """Writes operations down, each once; the one thing in this file that changes."""

    def __init__(self, variable: sp.Symbol) -> None:
        self.variable = _Value(variable)
        self.operations: dict[sp.Expr, _Operation] = {}
        self._names: dict[_Operation, sp.Expr] = {}
        self._powers: dict[sp.Expr, dict[int, _Value]] = {}

    def is_constant(self, atom: sp.Expr) -> bool:
        return atom not in self.operations and atom != self.variable.atom

    def constant(self, expression: sp.Expr) -> _Value:
        # One of c and -c stands for both, so that steps which differ by a sign are found to be equal.
        negative = expression.could_extract_minus_sign()
        return _Value(-expression if negative else expression, negative)

    def _step(self, kind: str, *operands: sp.Expr, head: Callable[..., sp.Expr] | None = None) -> sp.Expr:
        operation = _Operation(kind, operands, head)
        if operation not in self._names:
            self._names[operation] = sp.Dummy()
            self.operations[self._names[operation]] = operation
        return self._names[operation]

    def _ordered(self, a: sp.Expr, b: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """The two operands of a sum or product in one order: constant, variable, steps as they were written."""
        return (b, a) if self._rank(b) < self._rank(a) else (a, b)

    def _rank(self, atom: sp.Expr) -> int:
        if atom in self.operations:
            return atom.dummy_index
        return -1 if atom == self.variable.atom else -2

    def add(self, a: _Value, b: _Value) -> _Value:
        if self.is_constant(a.atom) and self.is_constant(b.atom):
            return self.constant(a.signed + b.signed)
        if sp.S.Zero in (a.atom, b.atom):
            return b if a.atom == 0 else a
        if a.atom == b.atom:
            return self.mul(_Value(sp.Integer(2)), a) if a.negative == b.negative else _Value(sp.S.Zero)
        if a.negative == b.negative:
            return _Value(self._step("add", *self._ordered(a.atom, b.atom)), a.negative)
        if a.negative:
            a, b = b, a
        if _Operation("sub", (b.atom, a.atom)) in self._names:
            return _Value(self._step("sub", b.atom, a.atom), True)
        return _Value(self._step("sub", a.atom, b.atom))

    def sub(self, a: _Value, b: _Value) -> _Value:
        return self.add(a, _Value(b.atom, not b.negative))

    def sum(self, values: Iterable[_Value]) -> _Value:
        """Constants last, all in one."""
        terms = sorted(values, key=lambda value: self.is_constant(value.atom))
        constants = [term for term in terms if self.is_constant(term.atom)]
        rest = terms[: len(terms) - len(constants)]
        if constants:
            rest.append(functools.reduce(self.add, constants))
        return functools.reduce(self.add, rest)

    def mul(self, a: _Value, b: _Value) -> _Value:
        negative = a.negative != b.negative
        first, second = self._ordered(a.atom, b.atom)
        if self.is_constant(second):
            return self.constant(a.signed * b.signed)
        if first == sp.S.Zero:
            return _Value(sp.S.Zero)
        if first == sp.S.One:
            return _Value(second, negative)
        definition = self.operations.get(second)
        if first == second and definition and definition.head is sp.Pow and definition.operands[1] == sp.S.Half:
            return _Value(definition.operands[0])
        if self.is_constant(first) and definition and definition.kind == "mul":
            inner, rest = definition.operands
            if self.is_constant(inner):
                return self.mul(self.constant(-first * inner if negative else first * inner), _Value(rest))
        return _Value(self._step("mul", first, second), negative)

    def div(self, a: _Value, b: _Value) -> _Value:
        if self.is_constant(b.atom):
            return self.mul(a, self.constant(1 / b.signed))
        if a.atom in (sp.S.Zero, b.atom):
            return _Value(sp.S.One if a.atom == b.atom else sp.S.Zero, a.negative != b.negative)
        return _Value(self._step("div", a.atom, b.atom), a.negative != b.negative)

    def power(self, base: _Value, exponent: int) -> _Value:
        """A positive integer power, through the powers already there or a shortest addition chain."""
        if self.is_constant(base.atom):
            return self.constant(base.signed**exponent)
        known = self._powers.setdefault(base.atom, {1: _Value(base.atom)})
        near = [part for part in known if exponent - part in known]
        chain = ((exponent, near[0]),) if near else _chain(exponent)
        for power, part in chain:
            if power not in known:
                known[power] = self.mul(known[power - part], known[part])
        return _Value(known[exponent].atom, known[exponent].negative != (base.negative and exponent % 2 == 1))

    def call(self, head: Callable[..., sp.Expr], *arguments: _Value) -> _Value:
        return _Value(self._step("call", *map(self.positive, arguments), head=head))

    def positive(self, value: _Value) -> sp.Expr:
        """The value as an atom: a sign that is left over goes where it is free, or costs a product with -1."""
        if not value.negative:
            return value.atom
        flipped = self._flipped(value.atom)
        return flipped if flipped is not None else self._step("mul", sp.S.NegativeOne, value.atom)

    def _flipped(self, atom: sp.Expr) -> sp.Expr | None:
        if self.is_constant(atom):
            return -atom
        match self.operations.get(atom):
            case _Operation("sub", (a, b)):
                return self._step("sub", b, a)
            case _Operation("add", (a, b)) if self.is_constant(a):
                return self._step("sub", -a, b)
            case _Operation("mul" | "div" as kind, (a, b)) if a != b:
                if (flipped := self._flipped(a)) is not None:
                    return self._step(kind, flipped, b)
                if (flipped := self._flipped(b)) is not None:
                    return self._step(kind, a, flipped)
        return None

    def finish(self, value: _Value) -> _Program:
        """The operations that the value needs, in order."""
        result = self.positive(value)
        needed = {result}
        for name, operation in reversed(self.operations.items()):
            if name in needed:
                needed.update(operation.operands)
        return _Program({name: step for name, step in self.operations.items() if name in needed}, result)


@functools.lru_cache
def _chain(exponent: int) -> tuple[tuple[int, int], ...]:
    """`(power, part)`: each power from the ones before it, as `power - part` and `part`; the last is the exponent.

    Knuth's power tree (The Art of Computer Programming 2, 4.6.3), shortest up to 76; halving above.
    """
    if exponent > 76:
        half = exponent // 2
        return _chain(half) + ((2 * half, half),) + (((exponent, 1),) if exponent % 2 else ())
    paths: dict[int, tuple[int, ...]] = {1: (1,)}
    level = [1]
    while exponent not in paths:
        grown = []
        for node, part in [(node, part) for node in level for part in paths[node]]:
            if node + part not in paths:
                paths[node + part] = (*paths[node], node + part)
                grown.append(node + part)
        level = grown
    return tuple((high, high - low) for low, high in itertools.pairwise(paths[exponent]))


def _cost(program: _Program) -> Cost:
    steps = program.operations.values()
    kinds = [step.kind for step in steps]
    clamps = sum(step.head in _CLAMPS or isinstance(step.head, _Select) for step in steps)
    return Cost(
        add=kinds.count("add") + kinds.count("sub"),
        mul=kinds.count("mul"),
        div=kinds.count("div"),
        other=kinds.count("call") - clamps,
    )


def _written(program: _Program, variable: sp.Symbol, taken: Iterable[sp.Symbol]) -> Schedule:
    """The program with names that a reader can follow: k0, k1, ... for constants and s0, s1, ... for steps."""
    reserved = {symbol.name for symbol in taken}
    fresh = {kind: _names(kind, reserved) for kind in "ks"}
    names: dict[sp.Expr, sp.Expr] = {variable: variable}
    constants: list[tuple[sp.Symbol, sp.Expr]] = []

    def named(atom: sp.Expr) -> sp.Expr:
        # A fraction is given a name too: printed in place, x/2 would read as a division.
        if atom not in names and not (atom.is_Symbol or atom.is_Integer):
            names[atom] = next(fresh["k"])
            constants.append((names[atom], atom))
        return names.get(atom, atom)

    steps = []
    for name, operation in program.operations.items():
        formula = _formula(operation, [named(atom) for atom in operation.operands])
        names[name] = next(fresh["s"])
        steps.append((names[name], formula))
    result = names.get(program.result, program.result)
    return Schedule(variable, tuple(constants), tuple(steps), result, _cost(program))


def _names(kind: str, reserved: set[str]) -> Iterator[sp.Symbol]:
    return (sp.Symbol(name) for i in itertools.count() if (name := f"{kind}{i}") not in reserved)


def _formula(operation: _Operation, operands: Sequence[sp.Expr]) -> sp.Expr:
    match operation.kind:
        case "add":
            return sp.Add(*operands)
        case "sub":
            return sp.Add(operands[0], -operands[1])
        case "mul":
            return sp.Mul(*operands, evaluate=operands[0] != operands[1])
        case "div":
            return sp.Mul(operands[0], sp.Pow(operands[1], -1))
    assert operation.head is not None
    return operation.head(*operands)


# --- Arrangements that follow the structure of the input -----------------------------------------------------------

_Plan = Callable[[_Tape], _Value]
_Visit = Callable[[sp.Expr], _Value]


def _as_given(context: _Context, expression: sp.Expr, tape: _Tape) -> _Value:
    def visit(part: sp.Expr) -> _Value:
        if part == context.variable or not context.varies(part):
            return _leaf_value(tape, part)
        return _node(tape, part, visit, lambda argument: _plan(context, argument)(tape))

    return visit(expression)


def _by_parts(context: _Context, expression: sp.Expr, tape: _Tape) -> _Value:
    """The input's own outermost operation, on the best arrangement of each operand."""

    def visit(part: sp.Expr) -> _Value:
        return _plan(context, part)(tape)

    return _node(tape, expression, visit, visit)


def _shared(expression: sp.Expr, context: _Context, tape: _Tape) -> _Value:
    """Common subexpressions taken out, sums and products of more than two operands included."""
    if not all(_is_plain(node) for node in sp.preorder_traversal(expression)):
        raise _Refused
    replacements, (reduced,) = sp.cse(expression)
    hoisted: dict[sp.Expr, sp.Expr] = {}
    known: dict[sp.Expr, _Value] = {context.variable: tape.variable}

    def visit(part: sp.Expr) -> _Value:
        if part in known:
            return known[part]
        if known.keys().isdisjoint(part.free_symbols):
            return tape.constant(part.xreplace(hoisted))
        return _node(tape, part, visit, visit)

    for name, part in replacements:
        if known.keys().isdisjoint(part.free_symbols):
            hoisted[name] = part.xreplace(hoisted)
        else:
            known[name] = visit(part)
    return visit(reduced)


def _is_plain(node: sp.Basic) -> bool:
    """Whether a node is its operands put together, so that a name may stand for any of them."""
    return isinstance(node, sp.Expr) and not isinstance(node, sp.Piecewise | sp.Lambda | sp.Subs | sp.Integral)


def _leaf_value(tape: _Tape, part: sp.Expr) -> _Value:
    return tape.variable if part == tape.variable.atom else tape.constant(part)


def _node(tape: _Tape, node: sp.Expr, visit: _Visit, argument: _Visit) -> _Value:
    """One node; `visit` writes down the operands of arithmetic, `argument` those of everything else."""
    if node.is_Add:
        return tape.sum(map(visit, node.args))
    factors = [_integer_power(factor) for factor in sp.Mul.make_args(node)]
    if factors != [(node, 1)]:
        return _product(tape, [(visit(base), exponent) for base, exponent in factors])
    if isinstance(node, sp.Piecewise):
        conditions = tuple(condition for _, condition in node.args)
        return tape.call(_Select(conditions), *(argument(value) for value, _ in node.args))
    if node.args and all(isinstance(part, sp.Expr) for part in node.args):
        return tape.call(node.func, *map(argument, node.args))
    return tape.call(_Whole(node))


def _integer_power(factor: sp.Expr) -> tuple[sp.Expr, int]:
    """A factor as `base**integer`: halves become powers of a square root, which is cheaper than a general power."""
    if factor.is_Pow and factor.exp.is_Integer:
        return factor.base, int(factor.exp)
    if factor.is_Pow and factor.exp.is_Rational and factor.exp.q == 2:
        return sp.sqrt(factor.base), int(factor.exp.p)
    return factor, 1


def _product(tape: _Tape, factors: Iterable[tuple[_Value, int]]) -> _Value:
    """Powers multiplied: constants in one, one division at most, `x**2*y**2` as `(x*y)**2`."""
    constant = _Value(sp.S.One)
    groups: dict[int, list[_Value]] = {}
    for value, exponent in factors:
        if tape.is_constant(value.atom):
            constant = tape.mul(constant, tape.constant(value.signed**exponent))
        else:
            groups.setdefault(exponent, []).append(value)
    common = math.gcd(*groups)
    if common > 1 and min(groups) < 0 < max(groups):
        root = _quotient(tape, _Value(sp.S.One), {exponent // common: group for exponent, group in groups.items()})
        return tape.mul(constant, tape.power(root, common))
    return _quotient(tape, constant, groups)


def _quotient(tape: _Tape, constant: _Value, groups: dict[int, list[_Value]]) -> _Value:
    def multiplied(sign: int) -> _Value | None:
        powers = [
            tape.power(functools.reduce(tape.mul, group), sign * exponent)
            for exponent, group in sorted(groups.items(), reverse=True)
            if sign * exponent > 0
        ]
        return functools.reduce(tape.mul, powers) if powers else None

    over, under = multiplied(1), multiplied(-1)
    numerator = constant if over is None else tape.mul(constant, over)
    return numerator if under is None else tape.div(numerator, under)


# --- The expression as a fraction over a field of constants --------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Fraction:
    """`numerator/denominator`: polynomials over QQ, in the generators that vary and then in the constant ones.

    `field` is QQ(constants), where the coefficients live; `granted` holds the factors by which the input divides.
    """

    numerator: Any
    denominator: Any
    generators: tuple[sp.Expr, ...]
    constants: tuple[sp.Expr, ...]
    field: Any
    granted: frozenset[Any]
    numbers: dict[Any, sp.Expr | None] = field(default_factory=dict)


_Key = tuple[sp.Expr, sp.Expr]


def _leaf(expression: sp.Expr) -> tuple[_Key, sp.Rational] | None:
    """`base**(multiple*rest)` as `(base, rest), multiple`; None for what arithmetic takes apart further."""
    if expression.is_Rational or expression.is_Add or expression.is_Mul:
        return None
    base, exponent = expression.as_base_exp()
    if exponent.is_Integer and base != expression:
        return None
    multiple, rest = exponent.as_coeff_Mul()
    return (base, rest), multiple


class _Reader:
    """Reads an expression as a fraction. With `coarse`, each coefficient is one generator, whatever is in it."""

    def __init__(self, context: _Context, expression: sp.Expr, coarse: bool) -> None:
        self.context, self.coarse = context, coarse
        powers: dict[_Key, list[sp.Rational]] = {}
        self._collect(expression, powers)
        self.units = {key: _unit(key, multiples) for key, multiples in powers.items()}
        generators = {key: key[0] ** (unit * key[1]) for key, unit in self.units.items()}
        moving = [key for key in generators if context.varies(generators[key])]
        still = [key for key in generators if key not in moving]
        if len(generators) > _MOST_GENERATORS or not moving:
            raise _Refused
        self.generators = tuple(generators[key] for key in moving)
        # A field needs a generator: without a constant one, 1 stands in.
        self.constants = tuple(generators[key] for key in still) or (sp.S.One,)
        symbols = [sp.Dummy() for _ in self.generators + self.constants]
        self.ring = PolyRing(symbols, QQ, lex)
        self.field = FracField(symbols[len(moving) :], QQ, lex)
        self.places = dict(zip(moving + still, self.ring.gens, strict=False))
        self.granted: set[Any] = set()

    def _parts(self, expression: sp.Expr) -> tuple[sp.Expr, ...]:
        if not self.coarse:
            return expression.args
        constant, rest = expression.as_independent(self.context.variable, as_Add=expression.is_Add)
        return tuple(part for part in (constant, *type(expression).make_args(rest)) if part != expression.identity)

    def _leaf(self, expression: sp.Expr) -> tuple[_Key, sp.Rational] | None:
        if self.coarse and not expression.is_Rational and not self.context.varies(expression):
            return (expression, sp.S.One), sp.S.One
        return _leaf(expression)

    def _collect(self, expression: sp.Expr, powers: dict[_Key, list[sp.Rational]]) -> None:
        if leaf := self._leaf(expression):
            powers.setdefault(leaf[0], []).append(leaf[1])
        elif expression.is_Add or expression.is_Mul:
            for part in self._parts(expression):
                self._collect(part, powers)
        elif not expression.is_Rational:
            self._collect(expression.as_base_exp()[0], powers)

    def fraction(self, expression: sp.Expr) -> _Fraction:
        relations = [
            self.places[key] ** int(unit.q) - QQ(key[0].p, key[0].q) ** int(unit.p)
            for key, unit in self.units.items()
            if key[0].is_Rational and key[1] == 1
        ]
        above, below = self._ratio(expression)
        if relations:
            above, below = above.rem(relations), below.rem(relations)
        if not above or not below:
            raise _Refused
        if max(_volume(above), _volume(below)) <= _MOST_VOLUME:
            above, below = above.cancel(below)
        granted = frozenset(self.granted)
        return _Fraction(above, below, self.generators, self.constants, self.field, granted)

    def _ratio(self, expression: sp.Expr) -> tuple[Any, Any]:
        if expression.is_Rational:
            return self.ring(QQ(expression.p, expression.q)), self.ring(1)
        if leaf := self._leaf(expression):
            exponent = int(leaf[1] / self.units[leaf[0]])
            return self._power(self.places[leaf[0]], self.ring(1), exponent)
        if expression.is_Add:
            return functools.reduce(_added, map(self._ratio, self._parts(expression)))
        if expression.is_Mul:
            return functools.reduce(_multiplied, map(self._ratio, self._parts(expression)))
        base, exponent = expression.as_base_exp()
        return self._power(*self._ratio(base), int(exponent))

    def _power(self, above: Any, below: Any, exponent: int) -> tuple[Any, Any]:
        if exponent < 0:
            above, below, exponent = below, above, -exponent
            self.granted.update(_constant_factors(below, len(self.generators), self.field))
        return _raised(above, exponent), _raised(below, exponent)


def _unit(key: _Key, multiples: list[sp.Rational]) -> sp.Rational:
    """The largest number of which all the exponents are multiples; the generator is raised to it."""
    unit = abs(functools.reduce(lambda a, b: a.gcd(b), multiples))
    # exp(-x) is better a generator than 1/exp(x); for x**(-1/2) it is the other way round.
    return -unit if key[1] != 1 and all(multiple < 0 for multiple in multiples) else unit


def _times(a: Any, b: Any) -> Any:
    if len(a) * len(b) > 4 * _MOST_TERMS:
        raise _Refused
    return _short(a * b)


def _short(polynomial: Any) -> Any:
    if len(polynomial) > _MOST_TERMS:
        raise _Refused
    return polynomial


def _raised(a: Any, exponent: int) -> Any:
    if exponent * max(map(sum, a.monoms()), default=0) > _MOST_DEGREE:
        raise _Refused
    return functools.reduce(_times, [a] * exponent, a.ring(1))


def _volume(polynomial: Any) -> int:
    """How many monomials there are up to its degrees: what the time of gcd and factorisation grows with."""
    return math.prod(max(degree, 0) + 1 for degree in polynomial.degrees())


def _added(a: tuple[Any, Any], b: tuple[Any, Any]) -> tuple[Any, Any]:
    if max(_volume(a[1]), _volume(b[1])) > _MOST_VOLUME:
        raise _Refused
    _, left, right = a[1].cofactors(b[1])
    return _short(_times(a[0], right) + _times(b[0], left)), _times(a[1], right)


def _multiplied(a: tuple[Any, Any], b: tuple[Any, Any]) -> tuple[Any, Any]:
    return _times(a[0], b[0]), _times(a[1], b[1])


def _terms(polynomial: Any, count: int, field: Any) -> _Terms:
    """The polynomial in its first `count` generators, coefficients in the field; highest first."""
    grouped: dict[tuple[int, ...], dict[tuple[int, ...], Any]] = {}
    for exponents, number in polynomial.terms():
        grouped.setdefault(exponents[:count], {})[exponents[count:]] = number
    return tuple(
        (exponents, field(field.ring.from_dict(grouped[exponents]))) for exponents in sorted(grouped, reverse=True)
    )


def _constant_factors(polynomial: Any, count: int, field: Any) -> list[Any]:
    """The irreducible factors of a polynomial that is free of the first `count` generators; none otherwise."""
    terms = _terms(polynomial, count, field)
    if len(terms) != 1 or any(terms[0][0]) or _volume(polynomial) > _MOST_VOLUME:
        return []
    return [factor.monic() for factor, _ in terms[0][1].numer.factor_list()[1]]


# --- Constants: what may be divided by, and drawn a root of --------------------------------------------------------


def _number(context: _Context, form: _Fraction, coefficient: Any) -> sp.Expr:
    """A coefficient as an expression, unless it divides by what may be zero."""
    if coefficient not in form.numbers:
        factors = [factor for factor, _ in coefficient.denom.factor_list()[1] if factor.monic() not in form.granted]
        known = all(_sign(context, factor.as_expr(*form.constants)) for factor in factors)
        form.numbers[coefficient] = coefficient.as_expr(*form.constants) if known else None
    if form.numbers[coefficient] is None:
        raise _Refused
    return form.numbers[coefficient]


def _root(context: _Context, form: _Fraction, coefficient: Any, degree: int) -> tuple[int, sp.Expr]:
    """`(sign, root)` with `sign*root**degree` equal to the coefficient and the root positive."""
    sign, root = 1, sp.S.One
    for polynomial, side in ((coefficient.numer, 1), (coefficient.denom, -1)):
        content, factors = polynomial.factor_list()
        pieces = [(sp.Rational(int(content.numerator), int(content.denominator)), 1)]
        pieces += [(factor.as_expr(*form.constants), exponent) for factor, exponent in factors]
        for piece, exponent in pieces:
            known = _sign(context, piece)
            if known is None:
                raise _Refused
            sign *= known**exponent
            root *= (known * piece) ** sp.Rational(side * exponent, degree)
    return sign, root


def _sign(context: _Context, expression: sp.Expr) -> int | None:
    """1 or -1 where a parameter expression has that sign for all values of the parameters, ends included."""
    if expression.is_positive or expression.is_negative:
        return 1 if expression.is_positive else -1
    bounds = _interval(context, expression)
    if bounds is None or bounds.a <= 0 <= bounds.b:
        return None
    return 1 if bounds.a > 0 else -1


def _interval(context: _Context, expression: sp.Expr) -> Any:
    """Rigorous bounds by interval arithmetic; None where a range is missing, infinite or of no use."""
    if expression.is_Rational:
        return mpmath.iv.mpf(int(expression.p)) / int(expression.q)
    if expression == sp.pi:
        return mpmath.iv.pi
    if expression in context.ranges:
        low, high = (_interval(context, sp.sympify(end)) for end in context.ranges[expression])
        return None if low is None or high is None else mpmath.iv.mpf([low.a, high.b])
    if expression.is_Pow and expression.exp.is_Integer and expression.exp > 0:
        base = _interval(context, expression.base)
        return None if base is None else base ** int(expression.exp)
    if not (expression.is_Add or expression.is_Mul):
        return None
    parts = [_interval(context, part) for part in expression.args]
    if any(part is None for part in parts):
        return None
    return functools.reduce(lambda a, b: a + b if expression.is_Add else a * b, parts)


# --- Arrangements that follow the algebra --------------------------------------------------------------------------

_T = TypeVar("_T")
_Terms = tuple[tuple[tuple[int, ...], Any], ...]


@dataclass(frozen=True)
class _Part:
    """`(scale*P(z - centre))**exponent`; with several generators the centre is 0."""

    terms: _Terms
    exponent: int = 1
    centre: Any = None
    scale: sp.Expr = sp.S.One

    @property
    def lead(self) -> Any:
        return self.terms[0][1]

    @property
    def degree(self) -> int:
        return self.terms[0][0][0]


class _Product(NamedTuple):
    """A coefficient times parts."""

    coefficient: Any
    parts: tuple[_Part, ...]


def _arrangements(context: _Context, form: _Fraction) -> Iterator[_Plan]:
    """The algebraic arrangements, the ones closest to a factored fraction first."""
    products = _products(form)
    for product in products:
        for moved in _about_centres(form, product):
            yield from (functools.partial(_write, context, form, scaled) for scaled in _scaled(context, form, moved))
    if len(form.generators) == 1:
        yield from _allowed(_by_numerator(context, form, products))
        yield from _allowed(_by_parity(context, form))
        yield from _allowed(_by_division(context, form, products))


def _allowed(found: Iterator[_T]) -> Iterator[_T]:
    """What is found before the coefficients grow too large."""
    try:
        yield from found
    except _Refused:
        return


def _write(context: _Context, form: _Fraction, product: _Product, tape: _Tape) -> _Value:
    coefficient = tape.constant(_number(context, form, product.coefficient))
    factors = [(_write_part(context, form, part, tape), part.exponent) for part in product.parts]
    return _product(tape, [(coefficient, 1), *factors])


def _write_part(context: _Context, form: _Fraction, part: _Part, tape: _Tape) -> _Value:
    values = [_as_given(context, generator, tape) for generator in form.generators]
    if part.centre is not None:
        values = [tape.sub(values[0], tape.constant(_number(context, form, part.centre)))]

    def number(coefficient: Any) -> _Value:
        return tape.constant(part.scale * _number(context, form, coefficient))

    return _horner(tape, part.terms, values, number)


def _horner(tape: _Tape, terms: _Terms, values: list[_Value], number: Callable[[Any], _Value]) -> _Value:
    """Horner's rule in the generator that most terms have, its coefficients by Horner's rule in the others."""
    counts = [sum(exponents[i] > 0 for exponents, _ in terms) for i in range(len(values))]
    if not any(counts):
        return number(terms[0][1])
    main = counts.index(max(counts))
    coefficients: dict[int, list[Any]] = {}
    for exponents, coefficient in terms:
        rest = (*exponents[:main], 0, *exponents[main + 1 :])
        coefficients.setdefault(exponents[main], []).append((rest, coefficient))
    degrees = sorted(coefficients, reverse=True)
    total = _horner(tape, tuple(coefficients[degrees[0]]), values, number)
    for high, low in itertools.pairwise([*degrees, 0] if degrees[-1] else degrees):
        total = tape.mul(total, tape.power(values[main], high - low))
        if low in coefficients:
            total = tape.add(total, _horner(tape, tuple(coefficients[low]), values, number))
    return total


def _products(form: _Fraction) -> list[_Product]:
    """Numerator over denominator, each in its factors and with factors of equal multiplicity multiplied out."""
    above, over = _factored(form, form.numerator)
    below, under = _factored(form, form.denominator)
    return [
        _Product(
            above / below,
            tuple(_Part(_form_terms(form, factor), exponent) for factor, exponent in numerator)
            + tuple(_Part(_form_terms(form, factor), -exponent) for factor, exponent in denominator),
        )
        for numerator, denominator in itertools.product(_merged(over), _merged(under))
    ]


def _form_terms(form: _Fraction, polynomial: Any) -> _Terms:
    return _terms(polynomial, len(form.generators), form.field)


def _factored(form: _Fraction, polynomial: Any) -> tuple[Any, list[tuple[Any, int]]]:
    """`(constant, factors)`; a polynomial too large to factor is its own factor."""
    if _volume(polynomial) > _MOST_VOLUME:
        return form.field(1), [(polynomial, 1)]
    number, factors = polynomial.factor_list()
    constant = form.field(number)
    moving = []
    for factor, exponent in factors:
        terms = _form_terms(form, factor)
        if any(terms[0][0]):
            moving.append((factor, exponent))
        else:
            constant *= terms[0][1] ** exponent
    return constant, moving


def _merged(factors: list[tuple[Any, int]]) -> list[list[tuple[Any, int]]]:
    groups: dict[int, list[Any]] = {}
    for factor, exponent in factors:
        groups.setdefault(exponent, []).append(factor)
    merged = [(math.prod(group[1:], start=group[0]), exponent) for exponent, group in groups.items()]
    return [factors, merged] if len(merged) < len(factors) else [factors]


def _about_centres(form: _Fraction, product: _Product) -> Iterator[_Product]:
    """The product as it is, then about each centre that rids a part of degree two or more of a term."""
    yield product
    if len(form.generators) == 1 and max((part.degree for part in product.parts), default=0) <= _MOST_MOVED:
        yield from _allowed(_moved(form, product))


def _moved(form: _Fraction, product: _Product) -> Iterator[_Product]:
    centres = [_centre(part, form.field) for part in product.parts if part.degree]
    for centre in list(dict.fromkeys(centre for centre in centres if centre))[:_MOST_CENTRES]:
        moved = [_about(part, centre, form.field) for part in product.parts]
        if any(new is not old and old.degree > 1 for new, old in zip(moved, product.parts, strict=True)):
            yield _Product(product.coefficient, tuple(moved))


def _centre(part: _Part, field: Any) -> Any:
    """Where the term after the leading one vanishes: a linear factor's root, a polynomial's Tschirnhaus shift."""
    second = dict(part.terms).get((part.degree - 1,), field(0))
    return -second / (part.degree * part.lead)


def _about(part: _Part, centre: Any, field: Any) -> _Part:
    """The part about a centre, if that leaves it with fewer terms."""
    coefficients = _dense(part.terms, field)
    for done in range(len(coefficients)):
        for i in reversed(range(done, len(coefficients) - 1)):
            coefficients[i] = _bounded(coefficients[i] + _bounded(centre * coefficients[i + 1]))
    terms = _sparse(coefficients)
    return replace(part, terms=terms, centre=centre) if len(terms) < len(part.terms) else part


def _bounded(coefficient: Any) -> Any:
    if max(_volume(coefficient.numer), _volume(coefficient.denom)) > _MOST_COEFFICIENT:
        raise _Refused
    return coefficient


def _dense(terms: _Terms, field: Any) -> list[Any]:
    """Coefficients in one generator, from degree 0 up."""
    known = {exponents[0]: coefficient for exponents, coefficient in terms}
    return [known.get(i, field(0)) for i in range(max(known) + 1)]


def _sparse(coefficients: Sequence[Any]) -> _Terms:
    return tuple(((i,), coefficients[i]) for i in reversed(range(len(coefficients))) if coefficients[i])


def _scaled(context: _Context, form: _Fraction, product: _Product) -> Iterator[_Product]:
    """The coefficient in front or inside a part, the parts as they are or monic."""
    for variant in dict.fromkeys((product, _monic(context, form, product))):
        yield variant
        for i, part in enumerate(variant.parts):
            if len(part.terms) > 1 and variant.coefficient != 1:
                try:
                    coefficient, absorbed = _absorbed(context, form, variant.coefficient, part)
                except _Refused:
                    continue
                yield _Product(coefficient, (*variant.parts[:i], absorbed, *variant.parts[i + 1 :]))


def _monic(context: _Context, form: _Fraction, product: _Product) -> _Product:
    """Leading coefficients taken out, where they are known not to vanish."""
    coefficient, parts = product
    monic = []
    for part in parts:
        try:
            _number(context, form, 1 / part.lead)
        except _Refused:
            monic.append(part)
            continue
        coefficient *= part.lead**part.exponent
        monic.append(replace(part, terms=tuple((exponents, number / part.lead) for exponents, number in part.terms)))
    return _Product(coefficient, tuple(monic))


def _absorbed(context: _Context, form: _Fraction, coefficient: Any, part: _Part) -> tuple[Any, _Part]:
    """`coefficient*part` with what can be of the coefficient inside the part; what is left is 1 or -1."""
    if abs(part.exponent) == 1:
        factor = coefficient**part.exponent
        return form.field(1), replace(part, terms=tuple((exponents, factor * number) for exponents, number in part.terms))
    sign, root = _root(context, form, coefficient, part.exponent)
    return form.field(sign), replace(part, scale=root)


def _by_numerator(context: _Context, form: _Fraction, products: list[_Product]) -> Iterator[_Plan]:
    """Where the denominator is `q*numerator + r`: `w/(q*w + r)`, with the numerator w in its factors."""
    over, under = (_dense(_form_terms(form, side), form.field) for side in (form.numerator, form.denominator))
    if len(over) != len(under) or len(over) < 3:
        return
    quotient, remainder = _divided(under, over, form.field)
    if len(remainder) != 1:
        return
    for product in products:
        parts = tuple(part for part in product.parts if part.exponent > 0)
        lead = math.prod((part.lead**part.exponent for part in parts), start=form.field(1))
        # numerator = c*w; the denominator is divided by c along with it
        constant = over[-1] / lead
        for moved in _about_centres(form, _Product(form.field(1), parts)):
            slope, rest = (_Part((((0,), number),)) for number in (quotient[0], remainder[0] / constant))
            yield functools.partial(_write_by_numerator, context, form, moved, (slope, rest))


def _write_by_numerator(
    context: _Context, form: _Fraction, numerator: _Product, line: tuple[_Part, _Part], tape: _Tape
) -> _Value:
    value = _write(context, form, numerator, tape)
    slope, rest = (_write_part(context, form, part, tape) for part in line)
    return tape.div(value, tape.add(tape.mul(slope, value), rest))


def _by_parity(context: _Context, form: _Fraction) -> Iterator[_Plan]:
    """Where `N(-z) = ratio*D(z)`: `ratio*(E + O)/(E - O)`, E and O the even and odd parts of N."""
    over, under = (_dense(_form_terms(form, side), form.field) for side in (form.numerator, form.denominator))
    mirrored = [(-1) ** i * number for i, number in enumerate(over)]
    ratio = mirrored[-1] / under[-1]
    even, odd = (_sparse([number if i % 2 == k else form.field(0) for i, number in enumerate(over)]) for k in (0, 1))
    if len(over) != len(under) or mirrored != [ratio * number for number in under] or not even or not odd:
        return
    for scale in dict.fromkeys((form.field(1), 1 / even[0][1], 1 / odd[0][1])):
        halves = [_Part(tuple((exponents, scale * number) for exponents, number in terms)) for terms in (even, odd)]
        yield functools.partial(_write_by_parity, context, form, ratio, halves)


def _write_by_parity(context: _Context, form: _Fraction, ratio: Any, halves: list[_Part], tape: _Tape) -> _Value:
    even, odd = (_write_part(context, form, part, tape) for part in halves)
    factor = tape.constant(_number(context, form, ratio))
    return tape.mul(factor, tape.div(tape.add(even, odd), tape.sub(even, odd)))


def _by_division(context: _Context, form: _Fraction, products: list[_Product]) -> Iterator[_Plan]:
    """Polynomial part plus proper fraction. Last: it is the one that cancels near a zero."""
    over, under = (_dense(_form_terms(form, side), form.field) for side in (form.numerator, form.denominator))
    if not len(over) >= len(under) > 1:
        return
    quotient, remainder = _divided(over, under, form.field)
    if not remainder:
        return
    for product in products:
        parts = tuple(part for part in product.parts if part.exponent < 0)
        lead = math.prod((part.lead**-part.exponent for part in parts), start=form.field(1))
        whole = _Product(lead / under[-1], (_Part(_sparse(quotient)), _Part(_sparse(remainder)), *parts))
        for moved in _about_centres(form, whole):
            polynomial, *proper = moved.parts
            for scaled in _scaled(context, form, _constants_out(_Product(moved.coefficient, tuple(proper)))):
                yield functools.partial(_write_by_division, context, form, polynomial, scaled)


def _constants_out(product: _Product) -> _Product:
    """Parts of degree 0 belong to the coefficient."""
    still = [part for part in product.parts if not part.degree]
    coefficient = math.prod((part.lead**part.exponent for part in still), start=product.coefficient)
    return _Product(coefficient, tuple(part for part in product.parts if part.degree))


def _write_by_division(
    context: _Context, form: _Fraction, polynomial: _Part, proper: _Product, tape: _Tape
) -> _Value:
    return tape.add(_write_part(context, form, polynomial, tape), _write(context, form, proper, tape))


def _divided(a: list[Any], b: list[Any], field: Any) -> tuple[list[Any], list[Any]]:
    """Quotient and remainder, from degree 0 up."""
    if len(a) > _MOST_MOVED:
        raise _Refused
    quotient = [field(0)] * (len(a) - len(b) + 1)
    rest = list(a)
    for i in reversed(range(len(quotient))):
        quotient[i] = _bounded(rest[i + len(b) - 1] / b[-1])
        for j, number in enumerate(b):
            rest[i + j] = _bounded(rest[i + j] - _bounded(quotient[i] * number))
    while rest and not rest[-1]:
        rest.pop()
    return quotient, rest


# --- The choice ----------------------------------------------------------------------------------------------------


def _plan(context: _Context, expression: sp.Expr) -> _Plan:
    """The cheapest arrangement of an expression, remembered."""
    if expression == context.variable or not context.varies(expression):
        return lambda tape: _leaf_value(tape, expression)
    if expression not in context.plans:
        context.plans[expression] = _cheapest(context, expression)
    return context.plans[expression]


def _cheapest(context: _Context, expression: sp.Expr) -> _Plan:
    plans: list[tuple[_Plan, _Program]] = []
    for plan in _candidates(context, expression):
        try:
            plans.append((plan, _compiled(context, plan)))
        except _Refused:
            continue
    given, as_given = plans[0]
    trial = _trial(context, expression)
    # sorted() keeps the order of equal weights, so the arrangement closest to the input wins a tie.
    for plan, program in sorted(plans, key=lambda entry: _cost(entry[1]).weight):
        if program is as_given or _is_faithful(trial, program, as_given):
            return plan
    return given


def _candidates(context: _Context, expression: sp.Expr) -> Iterator[_Plan]:
    yield functools.partial(_as_given, context, expression)
    form = _read(context, expression)
    if form is not None:
        yield from _arrangements(context, form)
    if form is None or len(form.generators) > 1:
        yield functools.partial(_by_parts, context, expression)
    yield functools.partial(_shared, expression, context)


def _read(context: _Context, expression: sp.Expr) -> _Fraction | None:
    for coarse in (False, True):
        try:
            return _Reader(context, expression, coarse).fraction(expression)
        except _Refused:
            continue
    return None


def _compiled(context: _Context, plan: _Plan) -> _Program:
    tape = _Tape(context.variable)
    return tape.finish(plan(tape))


_FRACTIONS = tuple(sp.Rational(*pair) for pair in ((1, 64), (1, 4), (9, 16), (13, 16), (63, 64)))


class _Trial(NamedTuple):
    """Points of the ranges, and the expression's values there."""

    variable: sp.Symbol
    points: tuple[dict[sp.Expr, sp.Expr], ...]
    values: tuple[Any, ...]


def _trial(context: _Context, expression: sp.Expr) -> _Trial:
    found = []
    for i in range(len(_FRACTIONS)):
        point = _point(context, expression, i)
        value = expression.xreplace(point).evalf(40)
        if value.is_Rational or value.is_Float:
            found.append((point, mpmath.mpmathify(sp.Float(value, 40))))
    points, values = zip(*found, strict=True) if found else ((), ())
    return _Trial(context.variable, points, values)


def _point(context: _Context, expression: sp.Expr, i: int) -> dict[sp.Expr, sp.Expr]:
    """The i-th trial point; the variable last, for the ends of its range may name parameters."""
    parameters = sorted(expression.free_symbols - {context.variable}, key=lambda symbol: symbol.name)
    point: dict[sp.Expr, sp.Expr] = {}
    for j, symbol in enumerate([*parameters, context.variable]):
        ends = context.ranges.get(symbol, (sp.S.Zero, sp.S.One))
        low, high = (sp.sympify(end).xreplace(point) for end in ends)
        low, high = _finite(low, high)
        # Each symbol walks through the fractions at its own pace, else all would be small and large together.
        step = _FRACTIONS[i] if symbol == context.variable else _FRACTIONS[(2 * i + j + 1) % len(_FRACTIONS)]
        point[symbol] = low + step * (high - low)
    return point


def _finite(low: sp.Expr, high: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    if low.is_infinite and high.is_infinite:
        return sp.Integer(-4), sp.Integer(4)
    return (high - 8 if low.is_infinite else low), (low + 8 if high.is_infinite else high)


def _is_faithful(trial: _Trial, program: _Program, given: _Program) -> bool:
    """Whether an arrangement has the value of the input, and rounds not much worse than the input as given.

    The first is a guard, not a proof: the algebra is exact, but it does not see that `sqrt(2)*sqrt(3)` and `sqrt(6)`
    are one number, and could divide by their difference.
    """
    if not trial.points:
        return True
    unit = mpmath.mpf(2) ** -24
    peak = max(map(abs, trial.values))
    if _error(trial, program, bits=120) > peak * mpmath.mpf(2) ** -60:
        return False
    return _error(trial, program, bits=24) <= _LOSS * max(_error(trial, given, bits=24), unit * peak)


def _error(trial: _Trial, program: _Program, bits: int) -> Any:
    """The worst absolute error over the trial's points, in arithmetic of so many bits."""
    worst = mpmath.mpf(0)
    for point, value in zip(trial.points, trial.values, strict=True):
        try:
            worst = max(worst, abs(_run(program, point, bits) - value))
        except ZeroDivisionError:
            return mpmath.inf
    return worst


def _run(program: _Program, point: Mapping[sp.Expr, sp.Expr], bits: int) -> Any:
    with mpmath.workprec(bits):
        known: dict[sp.Expr, Any] = {}

        def value(atom: sp.Expr) -> Any:
            if atom not in known:
                known[atom] = _rounded(atom.xreplace(point))
            return known[atom]

        for name, operation in program.operations.items():
            known[name] = _performed(operation, [value(atom) for atom in operation.operands], point)
        return value(program.result)


def _performed(operation: _Operation, operands: list[Any], point: Mapping[sp.Expr, sp.Expr]) -> Any:
    match operation.kind:
        case "add":
            return operands[0] + operands[1]
        case "sub":
            return operands[0] - operands[1]
        case "mul":
            return operands[0] * operands[1]
        case "div":
            return operands[0] / operands[1]
    assert operation.head is not None
    return _rounded(operation.head(*(sp.Float(operand, 40) for operand in operands)).xreplace(point))


def _rounded(expression: sp.Expr) -> Any:
    """A number at the working precision; infinite where it is not a real one, so that no comparison passes."""
    number = expression.evalf(40)
    return +mpmath.mpmathify(sp.Float(number, 40)) if number.is_Rational or number.is_Float else mpmath.inf
