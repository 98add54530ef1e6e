"""Ball functions: an expression, walked once into a tape, encloses its value on balls."""

from __future__ import annotations

import functools
import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import flint
import sympy as sp
from flint import acb, acb_poly, arb, fmpq, fmpz_poly

from ratfit._ball.ends import Bounded, Vanishing, bounded, vanishing
from ratfit._ball.operations import (
    BRANCHED,
    MEROMORPHIC,
    UNDEFINED,
    Operation,
    integer_power,
    power,
    root,
    square_root,
)
from ratfit._parse import RatfitError

_CONSTANTS: Mapping[Any, Callable[[], arb]] = {
    sp.pi: arb.pi, sp.E: arb.const_e, sp.EulerGamma: arb.const_euler, sp.Catalan: arb.const_catalan,
    sp.GoldenRatio: lambda: (1 + arb(5).sqrt()) / 2,
}  # fmt: skip


def ball_function(expression: sp.Expr, symbols: Sequence[sp.Symbol]) -> Callable[[Sequence[Any]], Any]:
    """The expression as a function of balls, at flint's working precision of the moment of the call.

    **Arguments:**

    - `expression`: of the symbols; functions are their principal branches.
    - `symbols`: whose values the function takes, as one list of `flint.arb` or `flint.acb` in this order.

    **Returns:** a function whose ball contains every value that the expression takes on the given balls: an `arb` of
    `arb`s, then not finite where a value might not be real, and an `acb` otherwise.

    **Fails** with `RatfitError` for a symbol without a value or a function that has no ball arithmetic: all that jump.

    Source: F. Johansson, "Arb: efficient arbitrary-precision midpoint-radius interval arithmetic", IEEE Transactions
    on Computers 66 (2017).
    """
    tape = compiled(expression, tuple(symbols))
    return lambda values: tape.play(values)


@functools.lru_cache(maxsize=512)
def compiled(expression: sp.Expr, symbols: tuple[sp.Symbol, ...], variable: sp.Symbol | None = None) -> Tape:
    tape = Tape(symbols, variable)
    tape.result = tape.place(expression)
    return tape


@dataclass(frozen=True)
class _Step:
    """An operation on earlier entries; a branched one is told first whether it must be analytic."""

    apply: Operation
    operands: tuple[int, ...]
    branched: bool


@dataclass
class Tape:
    """Steps that compute an expression of the symbols and, if there is one, the variable of an integral.

    The entries come in the order: symbols, variable, steps. Steps that do not depend on the variable are played once
    for all the places at which an integrand is asked for; sums that are polynomials in it become one evaluation.
    """

    symbols: tuple[sp.Symbol, ...]
    variable: sp.Symbol | None
    steps: list[_Step] = field(default_factory=list)
    inner: list[bool] = field(default_factory=list)
    entries: dict[Any, int] = field(default_factory=dict)
    result: int = -1

    def __post_init__(self) -> None:
        for symbol in self.symbols:
            self.entries[symbol] = len(self.inner)
            self.inner.append(False)
        if self.variable is not None:
            self.entries[self.variable] = len(self.inner)
        self.inner.append(True)

    def play(self, values: Sequence[Any]) -> Any:
        """The value of an expression without a variable."""
        return self.integrand(values)(None, False)

    def integrand(self, values: Sequence[Any]) -> Callable[[Any, bool], Any]:
        """The function of the variable, and of whether it must be analytic, at these values of the symbols."""
        entries: list[Any] = [*values, None, *[None] * len(self.steps)]
        first = len(self.symbols) + 1
        later, last = [], self.result
        for place, step in enumerate(self.steps, first):
            if self.inner[place]:
                later.append((place, step.apply, step.operands, step.branched))
            else:
                operands = [entries[operand] for operand in step.operands]
                entries[place] = step.apply(False, *operands) if step.branched else step.apply(*operands)

        def function(at: Any, analytic: bool) -> Any:
            entries[first - 1] = at
            for place, apply, operands, branched in later:
                if branched:
                    entries[place] = apply(analytic, *[entries[operand] for operand in operands])
                elif len(operands) == 2:  # nearly all of them, and this loop is what an integral costs
                    entries[place] = apply(entries[operands[0]], entries[operands[1]])
                else:
                    entries[place] = apply(*[entries[operand] for operand in operands])
            return entries[last]

        constant = self.variable is not None and not self.inner[last]
        return (lambda at, analytic: acb(entries[last])) if constant else function

    def place(self, node: sp.Expr) -> int:
        """The entry that holds the value of an expression: equal subexpressions share one."""
        if node not in self.entries:
            self.entries[node] = self._compose(node)
        return self.entries[node]

    def _step(self, apply: Operation, *operands: int, branched: bool = False) -> int:
        self.steps.append(_Step(apply, operands, branched))
        self.inner.append(any(self.inner[operand] for operand in operands))
        return len(self.inner) - 1

    def _compose(self, node: sp.Expr) -> int:
        if isinstance(node, sp.Symbol):
            raise RatfitError(f"{node} has no value: ball arithmetic takes numbers for every parameter")
        if node.is_Number or node.is_NumberSymbol or isinstance(node, sp.CRootOf):
            return self._step(_number(node))
        if isinstance(node, sp.AlgebraicNumber):
            return self.place(node.as_expr())
        if isinstance(node, sp.Add):
            return self._sum(node)
        if isinstance(node, sp.Mul):
            return self._product(node)
        if isinstance(node, sp.Pow):
            return self._power(node.base, node.exp)
        return self._function(node)

    def _fold(self, apply: Operation, operands: Sequence[int]) -> int:
        return functools.reduce(lambda first, second: self._step(apply, first, second), operands)

    def _sum(self, node: sp.Add) -> int:
        if self.variable is not None and node.has(self.variable) and node.is_polynomial(self.variable):
            coefficients = [self.place(c) for c in _coefficients(node, self.variable)]
            polynomial = self._step(lambda *given: acb_poly(list(given)), *coefficients)
            return self._step(lambda given, at: given(at), polynomial, self.place(self.variable))
        return self._fold(operator.add, [self.place(term) for term in node.args])

    def _product(self, node: sp.Mul) -> int:
        """One division at most: a quotient of products keeps its balls narrow."""
        below = [f for f in node.args if isinstance(f, sp.Pow) and f.exp.is_Rational and f.exp.is_negative]
        above = [self.place(factor) for factor in node.args if factor not in below]
        denominator = [self.place(1 / factor) for factor in below]
        if not above:
            above = [self.place(sp.S.One)]
        product = self._fold(operator.mul, above)
        return self._step(operator.truediv, product, self._fold(operator.mul, denominator)) if below else product

    def _power(self, base: sp.Expr, exponent: sp.Expr) -> int:
        if not exponent.is_Rational:
            return self._step(power, self.place(base), self.place(exponent), branched=True)
        if exponent.is_negative:
            return self._step(operator.truediv, self.place(sp.S.One), self.place(sp.Pow(base, -exponent)))
        value, degree = self.place(base), int(exponent.q)
        if degree > 1:
            value = self._step(square_root if degree == 2 else root(degree), value, branched=True)
        return self._step(integer_power(int(exponent.p)), value) if exponent.p > 1 else value

    def _function(self, node: Any) -> int:
        if isinstance(node, sp.atan2):
            return self.place(_half_angle(*node.args))
        if isinstance(node, Vanishing):
            return self._step(vanishing(*map(int, node.args[2:])), *map(self.place, node.args[:2]), branched=True)
        operands = [self.place(part) for part in node.args]
        if isinstance(node, Bounded):
            return self._step(bounded, *operands, branched=True)
        if node.func in MEROMORPHIC:
            return self._step(MEROMORPHIC[node.func], *operands)
        if node.func in BRANCHED:
            return self._step(BRANCHED[node.func], *operands, branched=True)
        raise RatfitError(f"no ball arithmetic for {node.func.__name__}, as in {node}")


@functools.lru_cache(maxsize=512)
def _coefficients(polynomial: sp.Expr, variable: sp.Symbol) -> tuple[sp.Expr, ...]:
    """From the constant one upwards."""
    collected = sp.collect(sp.expand(polynomial), variable, evaluate=False)
    found = {int(sp.degree(monomial, variable)) if monomial != 1 else 0: c for monomial, c in collected.items()}
    return tuple(found.get(k, sp.S.Zero) for k in range(max(found) + 1))


def _half_angle(y: sp.Expr, x: sp.Expr) -> sp.Expr:
    """atan2 off its cut; on it, where y = 0 > x, this divides by 0 and gives no ball."""
    return 2 * sp.atan(y / (sp.sqrt(x**2 + y**2) + x))


def _number(node: sp.Expr) -> Operation:
    """A constant at the working precision: computed once for each."""
    make, kept = _maker(node), {}

    def apply() -> arb:
        bits = flint.ctx.prec
        if bits not in kept:
            kept[bits] = make()
        return kept[bits]

    return apply


def _maker(node: sp.Expr) -> Callable[[], arb]:
    if node.is_Rational:
        ratio = fmpq(int(node.p), int(node.q))
        return lambda: arb(ratio)
    if node.is_Float and node.is_finite:
        sign, mantissa, exponent, _ = node._mpf_
        return lambda: arb((-int(mantissa) if sign else int(mantissa), int(exponent)))
    if isinstance(node, sp.CRootOf):
        return _algebraic(node)
    if node in _CONSTANTS:
        return _CONSTANTS[node]
    raise RatfitError(f"no ball arithmetic for {node}")


def _algebraic(node: Any) -> Callable[[], arb]:
    """A real root of an integer polynomial by its number: flint gives the real ones first, as sympy counts them."""
    if not node.is_real:
        raise RatfitError(f"no ball arithmetic for {node}, which is not real")
    polynomial = fmpz_poly([int(c) for c in reversed(node.poly.all_coeffs())])
    place = int(node.index)

    def order(one: arb, other: arb) -> int:
        return -1 if one < other else 1  # disjoint balls: of any two one is certainly the smaller

    def make() -> arb:
        found: Any = polynomial.complex_roots()
        roots = [value.real for value, _ in found if value.imag.is_zero()]
        return sorted(roots, key=functools.cmp_to_key(order))[place]

    return make


def real_part(value: Any) -> arb:
    """The real part of a value that may be real; one that is not gives no ball."""
    if isinstance(value, arb):
        return value
    return value.real if value.imag.contains(0) else UNDEFINED.real
