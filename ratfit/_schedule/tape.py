"""Operations written down, each once: the program while it grows."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Callable, Iterable

import sympy as sp

from ratfit._schedule.program import Operation, Program, Value


class Tape:
    """Writes operations down, each once. This is the one thing in the package that changes."""

    def __init__(self, variable: sp.Symbol) -> None:
        self.variable = Value(variable)
        self.operations: dict[sp.Expr, Operation] = {}
        self._names: dict[Operation, sp.Expr] = {}
        self._powers: dict[sp.Expr, dict[int, Value]] = {}
        self.best: dict[sp.Expr, Value] = {}  # subexpressions written down in their best arrangement

    def is_constant(self, atom: sp.Expr) -> bool:
        return atom not in self.operations and atom != self.variable.atom

    def constant(self, expression: sp.Expr) -> Value:
        # One of c and -c stands for both, so that steps which differ by a sign are found to be one.
        negative = expression.could_extract_minus_sign()
        return Value(-expression if negative else expression, negative)

    def leaf(self, expression: sp.Expr) -> Value:
        return self.variable if expression == self.variable.atom else self.constant(expression)

    def _step(self, kind: str, *operands: sp.Expr, head: Callable[..., sp.Expr] | None = None) -> sp.Expr:
        operation = Operation(kind, operands, head)
        if operation not in self._names:
            self._names[operation] = sp.Dummy()
            self.operations[self._names[operation]] = operation
        return self._names[operation]

    def _ordered(self, a: sp.Expr, b: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """The operands of a sum or product: a constant first, then the variable, then steps by age."""
        rank = {self.variable.atom: -1}
        a_rank, b_rank = (x.dummy_index if x in self.operations else rank.get(x, -2) for x in (a, b))
        return (b, a) if b_rank < a_rank else (a, b)

    def add(self, a: Value, b: Value) -> Value:
        if self.is_constant(a.atom) and self.is_constant(b.atom):
            return self.constant(a.signed + b.signed)
        if sp.S.Zero in (a.atom, b.atom):
            return b if a.atom == 0 else a
        if a.atom == b.atom:
            return self.mul(Value(sp.Integer(2)), a) if a.negative == b.negative else Value(sp.S.Zero)
        if a.negative == b.negative:
            return Value(self._step("add", *self._ordered(a.atom, b.atom)), a.negative)
        if a.negative:
            a, b = b, a
        if Operation("sub", (b.atom, a.atom)) in self._names:
            return Value(self._step("sub", b.atom, a.atom), True)
        return Value(self._step("sub", a.atom, b.atom))

    def sub(self, a: Value, b: Value) -> Value:
        return self.add(a, Value(b.atom, not b.negative))

    def sum(self, values: Iterable[Value]) -> Value:
        """Constants last, all in one."""
        terms: dict[bool, list[Value]] = {False: [], True: []}
        for value in values:
            terms[self.is_constant(value.atom)].append(value)
        constant = [functools.reduce(self.add, terms[True])] if terms[True] else []
        return functools.reduce(self.add, terms[False] + constant)

    def mul(self, a: Value, b: Value) -> Value:
        negative = a.negative != b.negative
        first, second = self._ordered(a.atom, b.atom)
        if self.is_constant(second):
            return self.constant(a.signed * b.signed)
        if first in (sp.S.Zero, sp.S.One):
            return Value(second, negative) if first == 1 else Value(first)
        definition = self.operations.get(second)
        if definition and definition.head is sp.Pow and first == second and definition.operands[1] == sp.S.Half:
            return Value(definition.operands[0], negative)
        if definition and definition.kind == "mul" and self.is_constant(first):
            inner, rest = definition.operands
            if self.is_constant(inner):
                return self.mul(self.constant(-first * inner if negative else first * inner), Value(rest))
        return Value(self._step("mul", first, second), negative)

    def div(self, a: Value, b: Value) -> Value:
        if self.is_constant(b.atom):
            return self.mul(a, self.constant(1 / b.signed))
        if a.atom in (sp.S.Zero, b.atom):
            return Value(sp.S.One if a.atom == b.atom else sp.S.Zero, a.negative != b.negative)
        return Value(self._step("div", a.atom, b.atom), a.negative != b.negative)

    def power(self, base: Value, exponent: int) -> Value:
        """A positive integer power, through the powers already there or a shortest addition chain."""
        if self.is_constant(base.atom):
            return self.constant(base.signed**exponent)
        known = self._powers.setdefault(base.atom, {1: Value(base.atom)})
        near = [part for part in known if exponent - part in known]
        for power, part in ((exponent, near[0]),) if near else _chain(exponent):
            if power not in known:
                known[power] = self.mul(known[power - part], known[part])
        return Value(known[exponent].atom, known[exponent].negative != (base.negative and exponent % 2 == 1))

    def call(self, head: Callable[..., sp.Expr], *arguments: Value) -> Value:
        return Value(self._step("call", *map(self.settled, arguments), head=head))

    def settled(self, value: Value) -> sp.Expr:
        """The value without a sign: one that is left over goes where it is free, or costs a product with -1."""
        if not value.negative:
            return value.atom
        flipped = self._flipped(value.atom)
        return flipped if flipped is not None else self._step("mul", sp.S.NegativeOne, value.atom)

    def _flipped(self, atom: sp.Expr) -> sp.Expr | None:
        if self.is_constant(atom):
            return -atom
        match self.operations.get(atom):
            case Operation("sub", (a, b)):
                return self._step("sub", b, a)
            case Operation("add", (a, b)) if self.is_constant(a):
                return self._step("sub", -a, b)
            case Operation("mul" | "div" as kind, (a, b)) if a != b:
                for part in sorted((a, b), key=self._reluctance):
                    if (flipped := self._flipped(part)) is not None:
                        return self._step(kind, *(flipped if operand == part else operand for operand in (a, b)))
        return None

    def _reluctance(self, atom: sp.Expr) -> int:
        """Constants take a sign best, then differences."""
        if self.is_constant(atom):
            return 0
        return 1 if atom in self.operations and self.operations[atom].kind == "sub" else 2

    def finish(self, value: Value) -> Program:
        """The operations that the value needs, in order."""
        result = self.settled(value)
        needed = {result}
        for name, operation in reversed(self.operations.items()):
            if name in needed:
                needed.update(operation.operands)
        return Program({name: step for name, step in self.operations.items() if name in needed}, result)


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
