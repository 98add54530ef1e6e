"""Ends: an integrand near an end at which balls fail, written in a new variable s > 0 that is 0 there.

A finite end is approached as x = end ± s**q, an infinite one as x = ±(anchor + 1/s**q - 1). The integrand, its Jacobian
included, becomes s**w * log(s)**j * exp(rho(s)/s**k) * rest(s) with a rest that is regular at 0. Where w >= 0 and there
is no logarithm and no exponential, a ball around 0 is as good as any other. Otherwise the first three factors are one
operation, which on a real ball that touches 0 bounds itself by monotonicity: that is the bound of the tail.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp
from flint import acb, arb

from ratfit._ball.operations import UNDEFINED, Operation, integer_power
from ratfit._parse import RatfitError

_S = sp.Dummy("s", positive=True)
_LOG = sp.Dummy("log_s", real=True)

_LOGARITHM_SPEED = 4
"""With a logarithm the pieces of the integral shrink to 0 one by one: s**4 for s makes four times fewer of them."""


class Vanishing(sp.Function):
    """exp(rho/s**k) * s**w * log(s)**j of the arguments s, rho, k, w, j."""


class Bounded(sp.Function):
    """Of the arguments s and f(p): a function of at most 2 in modulus on the real numbers, of a real polynomial."""


_BOUNDED = (sp.sin, sp.cos, sp.tanh, sp.erf, sp.erfc, sp.atan)


def bounded(analytic: bool, s: acb, value: Any) -> Any:
    """See Bounded. Its argument is infinite at s = 0, where only a real ball may be asked for."""
    return value if analytic or s.real > 0 or not s.imag.is_zero() else acb(arb(0, 2))


def vanishing(k: int, w: int, j: int) -> Operation:
    """See Vanishing: a bound on real balls that touch 0, the plain value elsewhere."""

    def apply(analytic: bool, s: acb, rho: acb) -> acb:
        if s.real > 0:
            decay = (rho / integer_power(k)(s)).exp() if k else acb(1)
            logarithm = integer_power(j)(s.log(analytic)) if j else acb(1)
            return decay * _signed_power(s, w) * logarithm
        if analytic or not s.imag.is_zero():
            return UNDEFINED
        return acb(_tail(s.real.upper(), rho.real.upper(), k, w, j))

    return apply


def _signed_power(base: Any, exponent: int) -> Any:
    if exponent == 0:
        return base * 0 + 1
    return integer_power(exponent)(base) if exponent > 0 else 1 / integer_power(-exponent)(base)


def _tail(end: arb, rho: arb, k: int, w: int, j: int) -> arb:
    """A ball around 0 that holds the value for all s in (0, end], where rho bounds the true one from above.

    With y = 1/s, e**(rho*y**k) * y**-w has its only maximum in y at -rho*k*y**k = -w, and s**w * |log s|**j its
    maximum below 1 at w*|log s| = j: past these they decrease towards s = 0, and the value at the end bounds them.
    """
    if not end < 1 or not end > 0:
        return UNDEFINED.real
    if k:
        steady = w - j  # |log s| <= 1/s
        decays = rho < 0 and -rho * k > -steady * integer_power(k)(end)
        bound = (rho / integer_power(k)(end)).exp() * _signed_power(end, steady)
    else:
        decays = w > 0 and -w * end.log() > j
        bound = _signed_power(end, w) * _signed_power(-end.log(), j)
    return arb(0, bound.upper()) if decays and bound.is_finite() else UNDEFINED.real


@dataclass(frozen=True)
class _Leading:
    """s**power * exp(growth) * rest; the growth is written in the old variable, the rest in s."""

    power: sp.Expr
    rest: sp.Expr
    growth: sp.Expr = sp.S.Zero


def at_end(integrand: sp.Expr, variable: sp.Symbol, end: sp.Expr, side: int, anchor: sp.Expr) -> tuple[sp.Expr, int]:
    """The integrand in s, Jacobian included, and the q of its substitution.

    Arguments: `side` is 1 where the range lies above the end and -1 below; `anchor` is where s = 1 for an infinite one.
    Returns the expression of `new_variable()`. Raises RatfitError where no bound at the end is known.
    """
    infinite = end in (sp.oo, -sp.oo)
    reader = _Reader(variable, anchor - side * (1 / _S - 1) if infinite else end + side * _S, end)
    jacobian = -2 if infinite else 0
    terms = [reader.mapped(term, jacobian) for term in _terms(integrand, variable)]
    q = math.lcm(1, *(_denominator(term) for term in terms))
    if any(term[1].has(_LOG) for term in terms):
        q *= _LOGARITHM_SPEED
    return sp.Add(*(_assembled(term, q, reader.name) for term in terms)), q


def new_variable() -> sp.Symbol:
    """The s that the mapped integrands are written in."""
    return _S


def _terms(integrand: sp.Expr, variable: sp.Symbol) -> Sequence[sp.Expr]:
    """Terms with exponentials of their own are mapped one by one; others may need each other to converge."""
    if not any(node.has(variable) for node in integrand.atoms(sp.exp)):
        return [integrand]
    return sp.Add.make_args(sp.expand_mul(integrand))


_Term = tuple[sp.Expr, sp.Expr, sp.Expr, sp.Expr]  # w, rest, k, rho


def _denominator(term: _Term) -> int:
    w, rest, k, rho = term
    exponents = [p.exp for e in (rest, rho) for p in e.atoms(sp.Pow) if p.base == _S and p.exp.is_Rational]
    return math.lcm(*(int(e.q) for e in (w, k, *exponents)))


def _assembled(term: _Term, q: int, name: str) -> sp.Expr:
    """The term for s**q in place of s, and the q of its Jacobian; s is positive, so its roots become powers."""
    w, rest, k, rho = term
    w, k = q * (w + 1) - 1, q * k
    rest, rho = (e.xreplace({_LOG: q * _LOG}).xreplace({_S: _S**q}) for e in (rest, rho))
    if not k and not rest.has(_LOG):
        if w < 0:
            raise RatfitError(f"the integral may diverge at {name}: no bound of the integrand is known there")
        return q * _S**w * rest
    parts = sp.Poly(rest, _LOG).all_terms() if rest.is_polynomial(_LOG) else None
    if parts is None or rho.has(_LOG):
        raise RatfitError(f"no bound of the integrand is known at {name}: a logarithm stands inside another function")
    if not k and w <= 0:
        raise RatfitError(f"the integral may diverge at {name}: no bound of the integrand is known there")
    return sp.Add(*(q * c * Vanishing(_S, rho, k, w, j) for (j,), c in parts if c != 0))


@dataclass(frozen=True)
class _Reader:
    """Reads off how an expression of the variable behaves at the end, as s goes to 0 in variable = place(s)."""

    variable: sp.Symbol
    at: sp.Expr
    end: sp.Expr

    @property
    def name(self) -> str:
        return f"{self.variable} = {self.end}"

    def mapped(self, term: sp.Expr, jacobian: int) -> _Term:
        leading = self.read(term)
        growth = self.read(leading.growth) if leading.growth != 0 else _Leading(sp.S.Zero, sp.S.Zero)
        if growth.power >= 0:
            return leading.power + jacobian, leading.rest * sp.exp(_S**growth.power * growth.rest), sp.S.Zero, sp.S.Zero
        return leading.power + jacobian, leading.rest, -growth.power, growth.rest

    def read(self, node: sp.Expr) -> _Leading:
        if not node.has(self.variable):
            return _Leading(sp.S.Zero, node)
        if isinstance(node, sp.Mul):
            return self._product(node.args)
        if isinstance(node, sp.Pow) and node.exp.is_Rational:
            base = self.read(node.base)
            return _Leading(base.power * node.exp, base.rest**node.exp, base.growth * node.exp)
        if isinstance(node, (sp.Symbol, sp.Add)):
            return self._rational(node) if node.is_rational_function(self.variable) else self._sum(node.args)
        return self._function(node)

    def _product(self, factors: Sequence[sp.Expr]) -> _Leading:
        read = [self.read(factor) for factor in factors]
        return _Leading(
            sp.Add(*(part.power for part in read)),
            sp.Mul(*(part.rest for part in read)),
            sp.Add(*(part.growth for part in read)),
        )

    def _rational(self, node: sp.Expr) -> _Leading:
        """Exactly: the lowest power of s in numerator and denominator goes out."""
        parts = [sp.Poly(part, _S) for part in sp.fraction(sp.together(node.xreplace({self.variable: self.at})))]
        lowest = [min(sum(monomial) for monomial in part.monoms()) for part in parts]
        above, below = (
            sp.Add(*(c * _S ** (sum(monomial) - low) for monomial, c in part.terms()))
            for part, low in zip(parts, lowest, strict=True)
        )
        return _Leading(sp.Integer(lowest[0] - lowest[1]), above / below)

    def _sum(self, terms: Sequence[sp.Expr]) -> _Leading:
        """What cancels between terms stays unseen, which can only make the integrand look worse than it is."""
        read = [self.read(term) for term in terms]
        if any(part.growth != 0 for part in read):
            raise RatfitError(f"no bound of the integrand is known at {self.name}: a sum with an exponential inside")
        power = min(part.power for part in read)
        return _Leading(power, sp.Add(*(_S ** (part.power - power) * part.rest for part in read)))

    def _function(self, node: Any) -> _Leading:
        if len(node.args) != 1:
            raise RatfitError(f"no bound of {node} is known at {self.name}")
        inside = self.read(node.args[0])
        if inside.growth != 0:
            raise RatfitError(f"no bound of {node} is known at {self.name}")
        if isinstance(node, sp.log):
            return _Leading(sp.S.Zero, inside.power * _LOG + sp.log(inside.rest))
        if isinstance(node, sp.exp) and inside.power < 0:
            return _Leading(sp.S.Zero, sp.S.One, node.args[0])
        argument = _S**inside.power * inside.rest
        if inside.power > 0 and isinstance(node, (sp.sin, sp.tan)):
            ratio = inside.rest * sp.sinc(argument)
            return _Leading(inside.power, ratio if isinstance(node, sp.sin) else ratio / sp.cos(argument))
        if inside.power >= 0:
            return _Leading(sp.S.Zero, node.func(argument))
        if node.func in _BOUNDED and node.args[0].is_polynomial(self.variable):
            return _Leading(sp.S.Zero, Bounded(_S, node.func(argument)))
        raise RatfitError(f"no bound of {node} is known at {self.name}")
