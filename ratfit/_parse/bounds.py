"""Bounds on powers of numbers: what sympy would multiply out or factor for long."""

from __future__ import annotations

import math
from collections.abc import Iterable

import sympy as sp

from ratfit._parse.errors import Refusal
from ratfit._parse.limits import MAX_BITS, MAX_EXPONENT, MAX_ORDER_BITS, MAX_ROOT_BITS


def are_roots_light(factors: Iterable[sp.Expr], exponent: sp.Expr = sp.S.One) -> bool:
    powers = [part.as_base_exp() for factor in factors for part in sp.Mul.make_args(factor)]
    roots = [(b, e * exponent) for b, e in powers if b.is_Rational and (e * exponent).is_Rational]
    roots = [(b, e) for b, e in roots if not e.is_Integer]
    bits = sum(bits_of(b) for b, _ in roots)
    return bits <= MAX_ROOT_BITS and bits * math.lcm(*[int(e.q) for _, e in roots]) <= MAX_ORDER_BITS


def bound_power(base: sp.Expr, exponent: sp.Expr) -> None:
    """Refuse what sympy would multiply out for long: it splits powers of products and of powers."""
    for factor in sp.Mul.make_args(base):
        inner, outer = factor.as_base_exp()
        total = outer * exponent
        if inner is sp.E:
            _bound_exponential(total)
        elif not total.is_Rational:
            # b**(k/log(b)) becomes E**k.
            _bound_exponential(total * sp.log(inner, evaluate=False))
        elif inner.is_Rational and bits_of(inner) * abs(total) > MAX_BITS:
            raise Refusal("this power has too many digits; use a smaller exponent")
        elif not inner.is_number and abs(total) > MAX_EXPONENT:
            raise Refusal(f"exponent beyond {MAX_EXPONENT}; use a smaller one")


def _bound_exponential(argument: sp.Expr) -> None:
    # exp(n*log(b)) becomes b**n.
    for term in sp.Add.make_args(argument):
        for factor in sp.Mul.make_args(term):
            if isinstance(factor, sp.log) and (term / factor).is_Rational:
                bound_power(factor.args[0], term / factor)


def bits_of(number: sp.Rational) -> int:
    return max(number.p.bit_length(), number.q.bit_length())
