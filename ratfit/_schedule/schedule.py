"""The verb `schedule`, and the program that it returns with names that a reader can follow."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import sympy as sp

from ratfit._parse import RatfitError
from ratfit._schedule.choice import compiled, plan
from ratfit._schedule.context import Context, Ranges
from ratfit._schedule.cost import Cost, cost
from ratfit._schedule.program import Operation, Program


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
    context = Context(variable, dict(ranges or {}), plan)
    return _written(compiled(context, plan(context, expression)), variable, expression.free_symbols | {variable})


def _exact(expression: sp.Expr) -> sp.Expr:
    """Floating-point numbers become the rationals that they stand for."""
    return expression.xreplace({number: sp.Rational(repr(float(number))) for number in expression.atoms(sp.Float)})


def _written(program: Program, variable: sp.Symbol, taken: Iterable[sp.Symbol]) -> Schedule:
    """The program with names that a reader can follow: k0, k1, ... for constants and s0, s1, ... for steps."""
    reserved = {symbol.name for symbol in taken}
    k, s = _fresh("k", reserved), _fresh("s", reserved)
    names: dict[sp.Expr, sp.Symbol] = {}
    constants: list[tuple[sp.Symbol, sp.Expr]] = []

    def named(atom: sp.Expr, operation: Operation) -> sp.Expr:
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
    return Schedule(variable, tuple(constants), tuple(steps), names.get(program.result, program.result), cost(program))


def _fresh(letter: str, reserved: set[str]) -> Iterator[sp.Symbol]:
    return (sp.Symbol(name) for name in map(f"{letter}{{}}".format, itertools.count()) if name not in reserved)


def _formula(operation: Operation, operands: Sequence[sp.Expr]) -> sp.Expr:
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
