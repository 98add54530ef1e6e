"""An expression arranged for evaluation: Horner, shared parts, hoisted constants; operation counts.

`schedule` writes an expression down in a handful of arrangements, each a straight-line program in which no operation
occurs twice, counts the operations and keeps the cheapest. The arrangements: as given; numerator and denominator in
factors or multiplied out, each by Horner's rule; about another centre (a root, or the point about which a factor loses
its second term); with factors made monic, or the constant in front drawn into one of them; the denominator in terms
of the numerator; even and odd parts shared between `N(x)` and `D(x) = N(-x)`; polynomial part plus proper fraction;
repeated parts taken out.

The file goes from the records over the program, the arrangements that follow the input's structure, the fraction
and its constants, to the arrangements that follow the algebra and the choice among them. All algebra is rational
arithmetic over a field in which each parameter, radical and irrational number is one opaque generator, and bounded
in size: what grows too large is written down as it was given.
"""

from __future__ import annotations

import functools
import itertools
import math
import operator
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple, TypeVar

import mpmath
import sympy as sp
from sympy import QQ
from sympy.polys.fields import FracField
from sympy.polys.rings import PolyRing

from ratfit._parse import RatfitError

_MOST_TERMS = 100  # of a polynomial
_MOST_DEGREE = 64
_MOST_MOVED = 16  # degree of a polynomial that is moved to another centre, or divided
_MOST_GENERATORS = 40
_MOST_VOLUME = 300  # monomials up to a polynomial's degrees: the time of gcd and factorisation grows with them
_MOST_CENTRES = 3
_LOSS = 64  # how many times worse than the input an arrangement may round

Ranges = Mapping[sp.Symbol, tuple[sp.Expr, sp.Expr]]


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


def schedule(expression: sp.Expr, variable: sp.Symbol, ranges: Ranges | None = None) -> Schedule:
    """The cheapest arrangement found of an expression, by the weight of its operations on each sample.

    **Arguments:**

    - `expression`: any expression; all its symbols but `variable` are parameters. A decimal number is read as what
        its shortest form says: 0.1 is 1/10.
    - `variable`: what changes from sample to sample.
    - `ranges`: `symbol -> (low, high)` for the variable and the parameters, as far as they are known; the ends of the
        variable's range may name parameters. They decide signs, next to the symbols' own assumptions, and say where
        the rounding is looked at; a symbol without a range is looked at on [0, 1].

    **Returns:** a `Schedule`, always the same one for the same arguments. On equal weights the arrangement closest to
    the input wins, and factors (whose zeros stay exact) win against sums.

    **Guaranteed:** the arrangement equals the input as a function of the variable and the parameters, wherever the
    input is finite. No division by a parameter expression is brought in that may be zero, and no root of one that may
    be negative: where a sign is not known, the arrangements that need it are left out.

    **Not guaranteed:** that no cheaper arrangement exists; nor a rounding error. Five points of the ranges are tried
    in 24-bit arithmetic, and an arrangement whose worst error there, against the peak, is more than 64 times that of
    the input as given is passed over. This catches a shift that cancels; it bounds nothing between the points, nor
    the relative error next to a zero.

    **Raises:** `RatfitError` when the expression is infinite or not a number.
    """
    expression = _exact(sp.sympify(expression))
    if expression.has(sp.nan, sp.zoo, sp.oo, -sp.oo):
        raise RatfitError(f"{expression} is not finite: take the limit first, then schedule what it gives")
    context = _Context(variable, dict(ranges or {}))
    return _written(_compiled(context, _plan(context, expression)), variable, expression.free_symbols | {variable})


def _exact(expression: sp.Expr) -> sp.Expr:
    """Floating-point numbers become the rationals that they stand for."""
    return expression.xreplace({number: sp.Rational(repr(float(number))) for number in expression.atoms(sp.Float)})


# --- The program ---------------------------------------------------------------------------------------------------


class _Value(NamedTuple):
    """A step, the variable or a parameter expression, up to its sign.

    Signs ride along because nearly every operation takes one for nothing: `a + (-b)` is a subtraction.
    """

    atom: sp.Expr
    negative: bool = False

    @property
    def signed(self) -> sp.Expr:
        return -self.atom if self.negative else self.atom


@dataclass(frozen=True)
class _Operation:
    kind: str  # add, sub, mul, div, call
    operands: tuple[sp.Expr, ...]
    head: Callable[..., sp.Expr] | None = None


class _Program(NamedTuple):
    operations: dict[sp.Expr, _Operation]
    result: sp.Expr


@dataclass(frozen=True)
class _Select:
    """A `Piecewise` that waits for the values of its branches."""

    conditions: tuple[Any, ...]

    def __call__(self, *values: sp.Expr) -> sp.Expr:
        return sp.Piecewise(*zip(values, self.conditions, strict=True))


@dataclass(frozen=True)
class _Whole:
    """Something that is not taken apart, such as an integral."""

    node: sp.Expr

    def __call__(self) -> sp.Expr:
        return self.node


_CLAMPS = (sp.Min, sp.Max, sp.Abs)
_ONE = _Value(sp.S.One)


class _Tape:
    """Writes operations down, each once. This is the one thing in the file that changes."""

    def __init__(self, variable: sp.Symbol) -> None:
        self.variable = _Value(variable)
        self.operations: dict[sp.Expr, _Operation] = {}
        self._names: dict[_Operation, sp.Expr] = {}
        self._powers: dict[sp.Expr, dict[int, _Value]] = {}
        self.best: dict[sp.Expr, _Value] = {}  # subexpressions written down in their best arrangement

    def is_constant(self, atom: sp.Expr) -> bool:
        return atom not in self.operations and atom != self.variable.atom

    def constant(self, expression: sp.Expr) -> _Value:
        # One of c and -c stands for both, so that steps which differ by a sign are found to be one.
        negative = expression.could_extract_minus_sign()
        return _Value(-expression if negative else expression, negative)

    def leaf(self, expression: sp.Expr) -> _Value:
        return self.variable if expression == self.variable.atom else self.constant(expression)

    def _step(self, kind: str, *operands: sp.Expr, head: Callable[..., sp.Expr] | None = None) -> sp.Expr:
        operation = _Operation(kind, operands, head)
        if operation not in self._names:
            self._names[operation] = sp.Dummy()
            self.operations[self._names[operation]] = operation
        return self._names[operation]

    def _ordered(self, a: sp.Expr, b: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """The operands of a sum or product: a constant first, then the variable, then steps by age."""
        rank = {self.variable.atom: -1}
        a_rank, b_rank = (x.dummy_index if x in self.operations else rank.get(x, -2) for x in (a, b))
        return (b, a) if b_rank < a_rank else (a, b)

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
        terms: dict[bool, list[_Value]] = {False: [], True: []}
        for value in values:
            terms[self.is_constant(value.atom)].append(value)
        constant = [functools.reduce(self.add, terms[True])] if terms[True] else []
        return functools.reduce(self.add, terms[False] + constant)

    def mul(self, a: _Value, b: _Value) -> _Value:
        negative = a.negative != b.negative
        first, second = self._ordered(a.atom, b.atom)
        if self.is_constant(second):
            return self.constant(a.signed * b.signed)
        if first in (sp.S.Zero, sp.S.One):
            return _Value(second, negative) if first == 1 else _Value(first)
        definition = self.operations.get(second)
        if definition and definition.head is sp.Pow and first == second and definition.operands[1] == sp.S.Half:
            return _Value(definition.operands[0], negative)
        if definition and definition.kind == "mul" and self.is_constant(first):
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
        for power, part in ((exponent, near[0]),) if near else _chain(exponent):
            if power not in known:
                known[power] = self.mul(known[power - part], known[part])
        return _Value(known[exponent].atom, known[exponent].negative != (base.negative and exponent % 2 == 1))

    def call(self, head: Callable[..., sp.Expr], *arguments: _Value) -> _Value:
        return _Value(self._step("call", *map(self.settled, arguments), head=head))

    def settled(self, value: _Value) -> sp.Expr:
        """The value without a sign: one that is left over goes where it is free, or costs a product with -1."""
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
                for part in sorted((a, b), key=self._reluctance):
                    if (flipped := self._flipped(part)) is not None:
                        return self._step(kind, *(flipped if operand == part else operand for operand in (a, b)))
        return None

    def _reluctance(self, atom: sp.Expr) -> int:
        """Constants take a sign best, then differences."""
        if self.is_constant(atom):
            return 0
        return 1 if atom in self.operations and self.operations[atom].kind == "sub" else 2

    def finish(self, value: _Value) -> _Program:
        """The operations that the value needs, in order."""
        result = self.settled(value)
        needed = {result}
        for name, operation in reversed(self.operations.items()):
            if name in needed:
                needed.update(operation.operands)
        return _Program({name: step for name, step in self.operations.items() if name in needed}, result)


@functools.lru_cache
def _chain(exponent: int) -> tuple[tuple[int, int], ...]:
    """`(power, part)`: each power as the product of the powers `power - part` and `part` before it.

    Knuth's power tree (The Art of Computer Programming 2, 4.6.3), shortest up to 76; halving above.
    """
    if exponent > 76:
        half = exponent // 2
        return _chain(half) + ((2 * half, half),) + (((exponent, 1),) if exponent % 2 else ())
    paths: dict[int, tuple[int, ...]] = {1: (1,)}
    level = [1]
    while exponent not in paths:
        grown = []
        for path in [paths[node] for node in level]:
            for power in [path[-1] + part for part in path]:
                if power not in paths:
                    paths[power] = (*path, power)
                    grown.append(power)
        level = grown
    return tuple((high, high - low) for low, high in itertools.pairwise(paths[exponent]))


def _cost(program: _Program) -> Cost:
    steps = program.operations.values()
    kinds = [step.kind for step in steps]
    clamps = sum(step.head in _CLAMPS or isinstance(step.head, _Select) for step in steps)
    other = kinds.count("call") - clamps
    return Cost(kinds.count("add") + kinds.count("sub"), kinds.count("mul"), kinds.count("div"), other)


def _written(program: _Program, variable: sp.Symbol, taken: Iterable[sp.Symbol]) -> Schedule:
    """The program with names that a reader can follow: k0, k1, ... for constants and s0, s1, ... for steps."""
    reserved = {symbol.name for symbol in taken}
    k, s = _fresh("k", reserved), _fresh("s", reserved)
    names: dict[sp.Expr, sp.Symbol] = {}
    constants: list[tuple[sp.Symbol, sp.Expr]] = []

    def named(atom: sp.Expr, operation: _Operation) -> sp.Expr:
        # Fractions get a name too, but for an exponent: printed in place, x/2 would read as a division.
        bare = atom.is_Symbol or atom.is_Integer or (atom.is_Rational and operation.head is sp.Pow)
        if atom not in names and not bare:
            names[atom] = next(k)
            constants.append((names[atom], atom))
        return names.get(atom, atom)

    steps = []
    for name, operation in program.operations.items():
        formula = _formula(operation, [named(atom, operation) for atom in operation.operands])
        names[name] = next(s)
        steps.append((names[name], formula))
    return Schedule(variable, tuple(constants), tuple(steps), names.get(program.result, program.result), _cost(program))


def _fresh(letter: str, reserved: set[str]) -> Iterator[sp.Symbol]:
    return (sp.Symbol(name) for name in map(f"{letter}{{}}".format, itertools.count()) if name not in reserved)


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


class _Refused(Exception):
    """An arrangement that must not be used: it grows too large, or divides by what may be zero."""


_T = TypeVar("_T")


def _attempt(action: Callable[[], _T]) -> _T | None:
    try:
        return action()
    except _Refused:
        return None


@dataclass(frozen=True)
class _Context:
    """What is known beforehand, and the plans already made for subexpressions."""

    variable: sp.Symbol
    ranges: Ranges
    plans: dict[sp.Expr, _Plan] = field(default_factory=dict)
    varying: dict[sp.Expr, bool] = field(default_factory=dict)

    def varies(self, expression: sp.Expr) -> bool:
        if expression not in self.varying:
            self.varying[expression] = self.variable in expression.free_symbols
        return self.varying[expression]

    def sign(self, expression: sp.Expr) -> int | None:
        """1 or -1 where a parameter expression is known to have that sign for all values of the parameters."""
        signed = {}
        for symbol in expression.free_symbols & set(self.ranges):
            low, high = map(sp.sympify, self.ranges[symbol])
            if low.is_positive or high.is_negative:
                signed[symbol] = sp.Dummy(positive=low.is_positive, negative=high.is_negative)
        known = expression.xreplace(signed)
        return 1 if known.is_positive else -1 if known.is_negative else None


def _as_given(context: _Context, expression: sp.Expr, tape: _Tape) -> _Value:
    @functools.cache
    def visit(part: sp.Expr) -> _Value:
        if part == context.variable or not context.varies(part):
            return tape.leaf(part)
        return _node(tape, part, visit, functools.partial(_best, context, tape))

    return visit(expression)


def _by_parts(context: _Context, expression: sp.Expr, tape: _Tape) -> _Value:
    """The input's own outermost operation, on the best arrangement of each operand."""
    best = functools.partial(_best, context, tape)
    return _node(tape, expression, best, best)


def _best(context: _Context, tape: _Tape, expression: sp.Expr) -> _Value:
    if expression not in tape.best:
        tape.best[expression] = _plan(context, expression)(tape)
    return tape.best[expression]


_Shared = tuple[list[tuple[sp.Symbol, sp.Expr]], list[sp.Expr]]


def _write_shared(context: _Context, shared: _Shared, tape: _Tape) -> _Value:
    """An expression from which sympy's `cse` has taken the common parts, some operands of a sum or product included."""
    hoisted: dict[sp.Expr, sp.Expr] = {}
    known: dict[sp.Expr, _Value] = {context.variable: tape.variable}

    def visit(part: sp.Expr) -> _Value:
        if part in known:
            return known[part]
        if known.keys().isdisjoint(part.free_symbols):
            return tape.constant(part.xreplace(hoisted))
        return _node(tape, part, visit, visit)

    replacements, (reduced,) = shared
    for name, part in replacements:
        if known.keys().isdisjoint(part.free_symbols):
            hoisted[name] = part.xreplace(hoisted)
        else:
            known[name] = visit(part)
    return visit(reduced)


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
    constant = _ONE
    groups: dict[int, list[_Value]] = {}
    for value, exponent in factors:
        if tape.is_constant(value.atom):
            constant = tape.mul(constant, tape.constant(value.signed**exponent))
        else:
            groups.setdefault(exponent, []).append(value)
    common = math.gcd(*groups)
    if common > 1 and min(groups) < 0 < max(groups):
        root = _quotient(tape, _ONE, {exponent // common: group for exponent, group in groups.items()})
        return tape.mul(constant, tape.power(root, common))
    return _quotient(tape, constant, groups)


def _quotient(tape: _Tape, constant: _Value, groups: dict[int, list[_Value]]) -> _Value:
    def multiplied(sign: int) -> _Value:
        powers = [
            tape.power(functools.reduce(tape.mul, group), sign * exponent)
            for exponent, group in sorted(groups.items(), reverse=True)
            if sign * exponent > 0
        ]
        return functools.reduce(tape.mul, powers, _ONE)

    return tape.div(tape.mul(constant, multiplied(1)), multiplied(-1))


# --- The expression as a fraction over a field of constants --------------------------------------------------------

_Factors = list[tuple[Any, int]]  # polynomials and their exponents


@dataclass(frozen=True, eq=False)
class _Form:
    """`numerator/denominator`, polynomials in the generators that vary over the field of those that do not.

    `constant*product(over)/product(under)` is the same in factors; `granted` are the constants' factors by which the
    input divides; `numbers` remembers coefficients as expressions, None for those that must not be used.
    """

    numerator: Any
    denominator: Any
    constant: Any
    over: _Factors
    under: _Factors
    generators: tuple[sp.Expr, ...]
    constants: tuple[sp.Expr, ...]
    granted: frozenset[Any]
    numbers: dict[Any, sp.Expr | None] = field(default_factory=dict)

    @property
    def one(self) -> Any:
        return self.numerator.ring.domain.one


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


def _unit(key: _Key, multiples: list[sp.Rational]) -> sp.Rational:
    """The largest number of which all the exponents are multiples: the generator is the power of it."""
    unit = abs(functools.reduce(sp.Rational.gcd, multiples))
    # exp(-x) is a better generator than 1/exp(-x); for x**(-1/2) it is the other way round.
    return -unit if key[1] != 1 and all(multiple < 0 for multiple in multiples) else unit


def _read(context: _Context, expression: sp.Expr, coarse: bool) -> _Form:
    return _Reader(context, expression, coarse).form(expression)


class _Reader:
    """Reads an expression as a fraction. With `coarse`, each coefficient is one generator, whatever is in it.

    The polynomials here are over QQ in all generators, those that vary first: gcd and factors are fastest there.
    """

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
        # A field needs a generator: where there is no constant, 1 stands in.
        self.constants = tuple(generators[key] for key in still) or (sp.S.One,)
        symbols = [sp.Dummy() for _ in self.generators + self.constants]
        self.flat = PolyRing(symbols, QQ)
        self.ring = PolyRing(symbols[: len(moving)], FracField(symbols[len(moving) :], QQ).to_domain())
        self.places = dict(zip(moving + still, self.flat.gens, strict=False))
        self.granted: set[Any] = set()

    def _collect(self, expression: sp.Expr, powers: dict[_Key, list[sp.Rational]]) -> None:
        if leaf := self._leaf(expression):
            powers.setdefault(leaf[0], []).append(leaf[1])
        elif expression.is_Add or expression.is_Mul:
            for part in self._parts(expression):
                self._collect(part, powers)
        elif not expression.is_Rational:
            self._collect(expression.as_base_exp()[0], powers)

    def _leaf(self, expression: sp.Expr) -> tuple[_Key, sp.Rational] | None:
        if self.coarse and not expression.is_Rational and not self.context.varies(expression):
            return (expression, sp.S.One), sp.S.One
        return _leaf(expression)

    def _parts(self, expression: sp.Expr) -> Iterable[sp.Expr]:
        if not self.coarse:
            return expression.args
        if expression.is_Mul:
            constant, rest = expression.as_independent(self.context.variable)
            return (constant, *sp.Mul.make_args(rest))
        collected: dict[sp.Expr, list[sp.Expr]] = {}
        for term in expression.args:
            constant, rest = term.as_independent(self.context.variable, as_Add=False)
            collected.setdefault(rest, []).append(constant)
        return [sp.Mul(sp.Add(*constants), rest) for rest, constants in collected.items()]

    def form(self, expression: sp.Expr) -> _Form:
        above, below = map(self._reduced, self._ratio(expression))
        if not above or not below:
            raise _Refused
        if max(_volume(above), _volume(below)) <= _MOST_VOLUME:
            above, below = above.cancel(below)
        (constant, over), (divisor, under) = self._factored(above), self._factored(below)
        sides = self._nested(above), self._nested(below)
        return _Form(*sides, constant / divisor, over, under, self.generators, self.constants, frozenset(self.granted))

    def _reduced(self, polynomial: Any) -> Any:
        """`sqrt(2)**2` is 2: powers of roots of numbers taken down."""
        roots = [(key, unit) for key, unit in self.units.items() if key[0].is_Rational and key[1] == 1]
        relations = [self.places[key] ** int(unit.q) - QQ(key[0].p, key[0].q) ** int(unit.p) for key, unit in roots]
        return polynomial.rem(relations) if relations else polynomial

    def _ratio(self, expression: sp.Expr) -> tuple[Any, Any]:
        if expression.is_Rational:
            return self.flat(QQ(expression.p, expression.q)), self.flat(1)
        if leaf := self._leaf(expression):
            return self._power((self.places[leaf[0]], self.flat(1)), int(leaf[1] / self.units[leaf[0]]))
        if expression.is_Add or expression.is_Mul:
            combined = _added if expression.is_Add else _multiplied
            return functools.reduce(combined, map(self._ratio, self._parts(expression)))
        base, exponent = expression.as_base_exp()
        return self._power(self._ratio(base), int(exponent))

    def _power(self, ratio: tuple[Any, Any], exponent: int) -> tuple[Any, Any]:
        above, below = ratio if exponent > 0 else ratio[::-1]
        if exponent < 0:
            self.granted.update(self._constant_factors(below))
        return _raised(above, abs(exponent)), _raised(below, abs(exponent))

    def _constant_factors(self, polynomial: Any) -> list[Any]:
        nested = self._nested(polynomial)
        if not nested.is_ground or _volume(polynomial) > _MOST_VOLUME:
            return []
        return [factor.monic() for factor, _ in nested.LC.numer.factor_list()[1]]

    def _factored(self, polynomial: Any) -> tuple[Any, _Factors]:
        """`(constant, factors)`; a polynomial too large to be factored is its own factor."""
        large = _volume(polynomial) > _MOST_VOLUME
        number, factors = (QQ(1), [(polynomial, 1)]) if large else polynomial.factor_list()
        nested = [(self._nested(factor), exponent) for factor, exponent in factors]
        constants = [factor.LC**exponent for factor, exponent in nested if factor.is_ground]
        return math.prod(constants, start=self.ring.domain(number)), [pair for pair in nested if not pair[0].is_ground]

    def _nested(self, polynomial: Any) -> Any:
        """The same polynomial over the field of constants."""
        count, base = len(self.generators), self.ring.domain.field
        grouped: dict[tuple[int, ...], dict[tuple[int, ...], Any]] = {}
        for exponents, number in polynomial.terms():
            grouped.setdefault(exponents[:count], {})[exponents[count:]] = number
        return self.ring.from_dict({outer: base(base.ring.from_dict(inner)) for outer, inner in grouped.items()})


def _volume(polynomial: Any) -> int:
    return math.prod(max(degree, 0) + 1 for degree in polynomial.degrees())


def _short(polynomial: Any) -> Any:
    if len(polynomial) > _MOST_TERMS:
        raise _Refused
    return polynomial


def _times(a: Any, b: Any) -> Any:
    if len(a) * len(b) > 4 * _MOST_TERMS:
        raise _Refused
    return _short(a * b)


def _raised(a: Any, exponent: int) -> Any:
    if exponent * max(map(sum, a.monoms()), default=0) > _MOST_DEGREE:
        raise _Refused
    return functools.reduce(_times, [a] * exponent, a.ring(1))


def _added(a: tuple[Any, Any], b: tuple[Any, Any]) -> tuple[Any, Any]:
    if a[1] == b[1]:
        return _short(a[0] + b[0]), a[1]
    if max(_volume(a[1]), _volume(b[1])) > _MOST_VOLUME:
        raise _Refused
    _, left, right = a[1].cofactors(b[1])
    return _short(_times(a[0], right) + _times(b[0], left)), _times(a[1], right)


def _multiplied(a: tuple[Any, Any], b: tuple[Any, Any]) -> tuple[Any, Any]:
    return _times(a[0], b[0]), _times(a[1], b[1])


# --- Constants: what may be divided by, and drawn a root of --------------------------------------------------------


def _number(context: _Context, form: _Form, coefficient: Any) -> sp.Expr:
    """A coefficient as an expression, unless it divides by what may be zero."""
    if coefficient not in form.numbers:
        factors = [factor for factor, _ in coefficient.denom.factor_list()[1] if factor.monic() not in form.granted]
        known = all(context.sign(factor.as_expr(*form.constants)) for factor in factors)
        form.numbers[coefficient] = coefficient.as_expr(*form.constants) if known else None
    number = form.numbers[coefficient]
    if number is None:
        raise _Refused
    return number


def _root(context: _Context, form: _Form, coefficient: Any, degree: int) -> tuple[int, sp.Expr]:
    """`(sign, root)` with `sign*root**degree` equal to the coefficient and the root positive."""
    sign, root = 1, sp.S.One
    for polynomial, side in ((coefficient.numer, 1), (coefficient.denom, -1)):
        content, factors = polynomial.factor_list()
        pieces = [(sp.Rational(int(content.numerator), int(content.denominator)), 1)]
        pieces += [(factor.as_expr(*form.constants), exponent) for factor, exponent in factors]
        for piece, exponent in pieces:
            known = context.sign(piece)
            if known is None:
                raise _Refused
            sign *= known**exponent
            root *= (known * piece) ** sp.Rational(side * exponent, degree)
    return sign, root


# --- Arrangements that follow the algebra --------------------------------------------------------------------------


@dataclass(frozen=True)
class _Part:
    """`(scale*polynomial(z - centre))**exponent`; with more generators than one there is no centre."""

    polynomial: Any
    exponent: int = 1
    centre: Any = None
    scale: sp.Expr = sp.S.One

    @property
    def lead(self) -> Any:
        return self.polynomial.LC

    @property
    def degree(self) -> int:
        return self.polynomial.degree()

    def times(self, factor: Any) -> _Part:
        return replace(self, polynomial=self.polynomial.mul_ground(factor))


class _Product(NamedTuple):
    """A coefficient times parts."""

    coefficient: Any
    parts: tuple[_Part, ...]

    def lead(self) -> Any:
        return math.prod((part.lead**part.exponent for part in self.parts), start=self.coefficient)

    def side(self, sign: int) -> _Product:
        """The parts of the numerator or of the denominator alone."""
        return _Product(self.coefficient**0, tuple(part for part in self.parts if part.exponent * sign > 0))


def _arrangements(context: _Context, form: _Form) -> Iterator[_Plan]:
    """The algebraic arrangements, the ones closest to a factored fraction first."""
    products = [
        _Product(form.constant, tuple(_Part(polynomial, exponent) for polynomial, exponent in over + _inverted(under)))
        for over, under in itertools.product(_merged(form.over), _merged(form.under))
    ]
    for product in products:
        for moved in _about_centres(form, product):
            yield from (functools.partial(_write, context, form, scaled) for scaled in _scaled(context, form, moved))
    if len(form.generators) == 1:
        yield from _by_numerator(context, form, products)
        yield from _by_parity(context, form)
        yield from _by_division(context, form, products)


def _inverted(factors: _Factors) -> _Factors:
    return [(polynomial, -exponent) for polynomial, exponent in factors]


def _merged(factors: _Factors) -> list[_Factors]:
    """The factors, and the factors with those of one exponent multiplied out."""
    groups: dict[int, list[Any]] = {}
    for polynomial, exponent in factors:
        groups.setdefault(exponent, []).append(polynomial)
    merged = [(math.prod(group[1:], start=group[0]), exponent) for exponent, group in groups.items()]
    return [factors, merged] if len(merged) < len(factors) else [factors]


def _write(context: _Context, form: _Form, product: _Product, tape: _Tape) -> _Value:
    coefficient = tape.constant(_number(context, form, product.coefficient))
    factors = [(_write_part(context, form, part, tape), part.exponent) for part in product.parts]
    return _product(tape, [(coefficient, 1), *factors])


def _write_part(context: _Context, form: _Form, part: _Part, tape: _Tape) -> _Value:
    values = [_as_given(context, generator, tape) for generator in form.generators]
    if part.centre is not None:
        values = [tape.sub(values[0], tape.constant(_number(context, form, part.centre)))]

    def number(coefficient: Any) -> _Value:
        return tape.constant(part.scale * _number(context, form, coefficient))

    return _horner(tape, part.polynomial.terms(), values, number)


def _horner(tape: _Tape, terms: list[Any], values: list[_Value], number: Callable[[Any], _Value]) -> _Value:
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
    total = _horner(tape, coefficients[degrees[0]], values, number)
    for high, low in itertools.pairwise([*degrees, 0] if degrees[-1] else degrees):
        total = tape.mul(total, tape.power(values[main], high - low))
        if low in coefficients:
            total = tape.add(total, _horner(tape, coefficients[low], values, number))
    return total


def _about_centres(form: _Form, product: _Product) -> Iterator[_Product]:
    """The product as it is, then about each centre that rids a part of degree two or more of a term."""
    yield product
    if len(form.generators) > 1 or not all(part.degree <= _MOST_MOVED for part in product.parts):
        return
    centres = [_centre(part) for part in product.parts if part.degree]
    for centre in list(dict.fromkeys(centre for centre in centres if centre))[:_MOST_CENTRES]:
        moved = [_about(part, centre) for part in product.parts]
        if any(new is not old and old.degree > 1 for new, old in zip(moved, product.parts, strict=True)):
            yield _Product(product.coefficient, tuple(moved))


def _centre(part: _Part) -> Any:
    """Where the term after the leading one vanishes: a linear factor's root, a polynomial's Tschirnhaus shift."""
    second = part.polynomial.get((part.degree - 1,), part.polynomial.ring.domain.zero)
    return -second / (part.degree * part.lead)


def _about(part: _Part, centre: Any) -> _Part:
    """The part about a centre, if that leaves it with fewer terms."""
    polynomial, degree = part.polynomial, part.degree
    if _growth(polynomial, [centre], degree) > _MOST_VOLUME:
        return part
    coefficients = [polynomial.get((i,), polynomial.ring.domain.zero) for i in range(degree + 1)]
    for done in range(degree):
        for i in reversed(range(done, degree)):
            coefficients[i] += centre * coefficients[i + 1]
    moved = polynomial.ring.from_dict({(i,): coefficient for i, coefficient in enumerate(coefficients) if coefficient})
    return replace(part, polynomial=moved, centre=centre) if len(moved) < len(polynomial) else part


def _growth(polynomial: Any, factors: Iterable[Any], times: int) -> int:
    """A bound on the volume of the coefficients after they have been multiplied by the factors so many times."""
    start, grown = _degrees(polynomial.coeffs()), _degrees(factors)
    return math.prod(a + times * b + 1 for a, b in zip(start, grown, strict=True))


def _degrees(coefficients: Iterable[Any]) -> list[int]:
    sides = [side.degrees() for c in coefficients for side in (c.numer, c.denom)]
    return [max(0, *degrees) for degrees in zip(*sides, strict=True)]


def _scaled(context: _Context, form: _Form, product: _Product) -> Iterator[_Product]:
    """The coefficient in front or inside a part, the parts as they are or monic."""
    for variant in dict.fromkeys((product, _monic(context, form, product))):
        yield variant
        for i, part in enumerate(variant.parts):
            absorbed = _attempt(functools.partial(_absorbed, context, form, variant.coefficient, part))
            if absorbed is not None and len(part.polynomial) > 1 and variant.coefficient != 1:
                yield _Product(absorbed[0], (*variant.parts[:i], absorbed[1], *variant.parts[i + 1 :]))


def _monic(context: _Context, form: _Form, product: _Product) -> _Product:
    """Leading coefficients taken out, where they are known not to vanish."""
    coefficient, parts = product.coefficient, []
    for part in product.parts:
        divisible = _attempt(functools.partial(_number, context, form, 1 / part.lead)) is not None
        coefficient *= part.lead**part.exponent if divisible else 1
        parts.append(part.times(1 / part.lead) if divisible else part)
    return _Product(coefficient, tuple(parts))


def _absorbed(context: _Context, form: _Form, coefficient: Any, part: _Part) -> tuple[Any, _Part]:
    """`coefficient*part` with what can be of the coefficient inside the part; what is left is 1 or -1."""
    if abs(part.exponent) == 1:
        return form.one, part.times(coefficient**part.exponent)
    sign, root = _root(context, form, coefficient, part.exponent)
    return form.one * sign, replace(part, scale=root)


def _by_numerator(context: _Context, form: _Form, products: list[_Product]) -> Iterator[_Plan]:
    """Where the denominator is `q*numerator + r`: `w/(q*w + r)`, with the numerator w in its factors."""
    over, under = form.numerator, form.denominator
    if over.degree() != under.degree() or over.degree() < 2:
        return
    slope = under.LC / over.LC
    rest = under - over.mul_ground(slope)
    if rest.degree() > 0:
        return
    for numerator in dict.fromkeys(product.side(1) for product in products):
        # over = constant*w, and the denominator is divided by the constant along with it
        line = _Part(over.ring.gens[0].mul_ground(slope) + rest.mul_ground(numerator.lead() / over.LC))
        for moved in _about_centres(form, numerator):
            yield functools.partial(_write_by_numerator, context, form, moved, line)


def _write_by_numerator(context: _Context, form: _Form, numerator: _Product, line: _Part, tape: _Tape) -> _Value:
    value = _write(context, form, numerator, tape)
    terms = line.polynomial.terms()
    return tape.div(value, _horner(tape, terms, [value], lambda c: tape.constant(_number(context, form, c))))


def _by_parity(context: _Context, form: _Form) -> Iterator[_Plan]:
    """Where `N(-z) = ratio*D(z)`: `ratio*(E + O)/(E - O)`, E and O the even and odd parts of N."""
    over, under = form.numerator, form.denominator
    halves = [over.ring.from_dict({e: c for e, c in over.terms() if e[0] % 2 == parity}) for parity in (0, 1)]
    mirrored = halves[0] - halves[1]
    ratio = mirrored.LC / under.LC
    if mirrored != under.mul_ground(ratio) or not all(halves):
        return
    for scale in dict.fromkeys((form.one, 1 / halves[0].LC, 1 / halves[1].LC)):
        even, odd = (_Part(half).times(scale) for half in halves)
        yield functools.partial(_write_by_parity, context, form, ratio, even, odd)


def _write_by_parity(context: _Context, form: _Form, ratio: Any, even: _Part, odd: _Part, tape: _Tape) -> _Value:
    a, b = (_write_part(context, form, part, tape) for part in (even, odd))
    return tape.mul(tape.constant(_number(context, form, ratio)), tape.div(tape.add(a, b), tape.sub(a, b)))


def _by_division(context: _Context, form: _Form, products: list[_Product]) -> Iterator[_Plan]:
    """Polynomial part plus proper fraction. Last, for it is the one that cancels near a zero."""
    over, under = form.numerator, form.denominator
    steps = over.degree() - under.degree() + 1
    if not under.degree() > 0 or steps < 1 or over.degree() > _MOST_MOVED:
        return
    if _growth(over, under.coeffs(), steps) > _MOST_VOLUME:
        return
    quotient, remainder = over.div(under)
    if not remainder:
        return
    for denominator in dict.fromkeys(product.side(-1) for product in products):
        constant = 1 / (under.LC * denominator.lead())
        parts = (_Part(quotient), _Part(remainder), *denominator.parts)
        for moved in _about_centres(form, _Product(constant, parts)):
            polynomial, top, *bottom = moved.parts
            # a remainder of degree 0 belongs to the coefficient
            proper = _Product(constant, (top, *bottom)) if top.degree else _Product(constant * top.lead, tuple(bottom))
            for scaled in _scaled(context, form, proper):
                yield functools.partial(_write_by_division, context, form, polynomial, scaled)


def _write_by_division(context: _Context, form: _Form, polynomial: _Part, proper: _Product, tape: _Tape) -> _Value:
    return tape.add(_write_part(context, form, polynomial, tape), _write(context, form, proper, tape))


# --- The choice ----------------------------------------------------------------------------------------------------


def _plan(context: _Context, expression: sp.Expr) -> _Plan:
    """The cheapest arrangement of an expression, remembered."""
    if expression == context.variable or not context.varies(expression):
        return lambda tape: tape.leaf(expression)
    if expression not in context.plans:
        context.plans[expression] = _cheapest(context, expression)
    return context.plans[expression]


def _cheapest(context: _Context, expression: sp.Expr) -> _Plan:
    tried = [(plan, _attempt(functools.partial(_compiled, context, plan))) for plan in _candidates(context, expression)]
    plans = [(plan, program) for plan, program in tried if program is not None]
    given = plans[0][1]
    trial = _trial(context, expression)
    # sorted() keeps the order of equal weights, so that the arrangement closest to the input wins a tie.
    ranked = sorted(plans, key=lambda entry: _cost(entry[1]).weight)
    return next(plan for plan, program in ranked if program is given or _is_faithful(trial, program, given))


def _candidates(context: _Context, expression: sp.Expr) -> Iterator[_Plan]:
    yield functools.partial(_as_given, context, expression)
    readings = (_attempt(functools.partial(_read, context, expression, coarse)) for coarse in (False, True))
    form = next((reading for reading in readings if reading is not None), None)
    if form is not None:
        yield from _arrangements(context, form)
    if form is None or len(form.generators) > 1:
        yield functools.partial(_by_parts, context, expression)
    # A name may stand for a part of anything but a condition or the limits of an integral.
    if not expression.has(sp.Piecewise) and all(
        isinstance(node, sp.Expr) for node in sp.preorder_traversal(expression)
    ):
        yield functools.partial(_write_shared, context, sp.cse(expression))


def _compiled(context: _Context, plan: _Plan) -> _Program:
    tape = _Tape(context.variable)
    return tape.finish(plan(tape))


_DIGITS = 40
# The places in its range where the variable is tried. None is dyadic: so the input's own rounding takes part, and an
# ill-conditioned place does not count against an arrangement.
_PLACES = tuple(sp.Rational(i, 61) for i in (1, 16, 29, 46, 60))

_Point = dict[sp.Expr, sp.Expr]


def _trial(context: _Context, expression: sp.Expr) -> list[tuple[_Point, Any]]:
    """Points of the ranges, and the expression's values there as far as they are real numbers."""
    points = [_point(context, expression, i) for i in range(len(_PLACES))]
    pairs = [(point, expression.xreplace(point).evalf(_DIGITS)) for point in points]
    return [(point, mpmath.mpmathify(sp.Float(value, _DIGITS))) for point, value in pairs if _is_number(value)]


def _is_number(value: sp.Expr) -> bool:
    return bool(value.is_Rational or value.is_Float)


def _point(context: _Context, expression: sp.Expr, i: int) -> _Point:
    """The i-th trial point; the variable last, for the ends of its range may name parameters."""
    ends = sp.Tuple(*context.ranges.get(context.variable, ()))
    parameters = sorted((expression.free_symbols | ends.free_symbols) - {context.variable}, key=lambda s: s.name)
    point: _Point = {}
    for j, symbol in enumerate([*parameters, context.variable]):
        low, high = (end.xreplace(point) for end in sp.Tuple(*context.ranges.get(symbol, (0, 1))))
        if low.is_infinite:
            low = high - 8 if not high.is_infinite else sp.Integer(-4)
        if high.is_infinite:
            high = low + 8
        # Over another prime, and from another place each: no two symbols are equal by accident, nor all of them large.
        step = _PLACES[i] if symbol == context.variable else sp.Rational((14 * i + 23 * j + 15) % 66 + 1, 67)
        # A Float, for an exact number to a high power would not fit into memory.
        point[symbol] = (low + step * (high - low)).evalf(_DIGITS)
    return point


def _is_faithful(trial: list[tuple[_Point, Any]], program: _Program, given: _Program) -> bool:
    """Whether an arrangement has the value of the input, and rounds not much worse than the input as given.

    The first is a guard, not a proof: the algebra is exact, but does not see that `sqrt(2)*sqrt(3)` and `sqrt(6)` are
    one number, and could divide by their difference.
    """
    peak = max((abs(value) for _, value in trial), default=mpmath.mpf(0))
    if _error(trial, program, bits=120) > peak * mpmath.mpf(2) ** -60:
        return False
    return _error(trial, program, bits=24) <= _LOSS * max(_error(trial, given, bits=24), peak * mpmath.mpf(2) ** -24)


def _error(trial: list[tuple[_Point, Any]], program: _Program, bits: int) -> Any:
    """The worst absolute error over the trial's points, in arithmetic of so many bits."""
    try:
        return max((abs(_run(program, point, bits) - value) for point, value in trial), default=mpmath.mpf(0))
    except ZeroDivisionError:
        return mpmath.inf


def _run(program: _Program, point: _Point, bits: int) -> Any:
    known: dict[sp.Expr, Any] = {}

    def value(atom: sp.Expr) -> Any:
        if atom not in known:
            known[atom] = _rounded(atom.xreplace(point))
        return known[atom]

    with mpmath.workprec(bits):
        for name, operation in program.operations.items():
            known[name] = _performed(operation, [value(atom) for atom in operation.operands], point)
        return value(program.result)


_ARITHMETIC = {"add": operator.add, "sub": operator.sub, "mul": operator.mul, "div": operator.truediv}


def _performed(operation: _Operation, operands: list[Any], point: _Point) -> Any:
    if operation.head is None:
        return _ARITHMETIC[operation.kind](*operands)
    return _rounded(operation.head(*(sp.Float(operand, _DIGITS) for operand in operands)).xreplace(point))


def _rounded(expression: sp.Expr) -> Any:
    """A number at the working precision; infinite where it is not a real one, so that no comparison passes."""
    value = expression.evalf(_DIGITS)
    return +mpmath.mpmathify(sp.Float(value, _DIGITS)) if _is_number(value) else mpmath.inf
