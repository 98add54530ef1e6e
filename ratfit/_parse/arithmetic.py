"""Sums, products and powers, with the checks that come before sympy's evaluation."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain

import sympy as sp

from ratfit._parse.bounds import are_roots_light, bound_power
from ratfit._parse.errors import Refusal
from ratfit._parse.limits import SHORT
from ratfit._parse.reading import current_reading
from ratfit._parse.values import evaluated, is_number, value_of
from ratfit._parse.veil import behind_veil, veiled


def sum_of(terms: Iterable[sp.Expr]) -> sp.Expr:
    expr = sp.Add(*terms)
    numbers = [term for term in sp.Add.make_args(expr) if is_number(term)]
    if len(numbers) > 1:
        value_of(sp.Add(*numbers))
    return expr


def product_of(factors: Sequence[sp.Expr]) -> sp.Expr:
    if sp.S.Zero in factors:
        # sympy would ask each other factor whether it is finite, which may take long.
        return sp.S.Zero
    if not are_roots_light(factors):
        raise Refusal("too many digits under the roots of a product; round its numbers")
    parts = chain.from_iterable(map(sp.Mul.make_args, factors))
    return _with_sums_shown(sp.Mul(*map(_sum_veiled, parts)))


def power_of(base: sp.Expr, exponent: sp.Expr) -> sp.Expr:
    if base is sp.S.Zero and exponent.is_Rational and exponent < 0:
        raise Refusal("division by zero; take the zero out of the denominator")
    if is_number(base) and is_number(exponent) and base != 0:
        evaluated("power", [base, exponent])
    if exponent is sp.S.One:
        return base
    bound_power(base, exponent)
    light = not exponent.is_Rational or are_roots_light(sp.Mul.make_args(base), exponent)
    exponent = veiled(exponent) if light else behind_veil(exponent)
    if base is sp.E:
        return sp.exp(exponent)
    if exponent.is_Integer and base.is_Mul:
        return _with_sums_shown(sp.Mul(*[sp.Pow(_sum_veiled(factor), exponent) for factor in base.args]))
    if exponent.is_Integer and isinstance(base, sp.exp):
        return power_of(sp.E, base.args[0] * exponent)
    return _with_sums_shown(sp.Pow(_power_veiled(base, exponent), exponent))


def _power_veiled(base: sp.Expr, exponent: sp.Expr) -> sp.Expr:
    if base.is_Mul and len(base.args) <= SHORT:
        factors = [veiled(factor) for factor in base.args]
        # A veil shows the sign of a number, and sympy would part it from the rest where it keeps them together.
        return veiled(base) if any(f.is_Symbol and is_number(f) for f in factors) else sp.Mul(*factors)
    if not base.is_Pow:
        return veiled(base)
    inner, power = base.args
    # sympy expands the inner base into real and imaginary parts to tell whether the exponents may be multiplied.
    hidden = behind_veil if inner.args and not exponent.is_Integer else veiled
    return sp.Pow(hidden(inner), veiled(power))


def _sum_veiled(factor: sp.Expr) -> sp.Expr:
    return veiled(factor) if factor.is_Add else factor


def _with_sums_shown(expr: sp.Expr) -> sp.Expr:
    """A sum or product stays behind its veil under a power; as a factor it takes part in the product."""
    factors = list(sp.Mul.make_args(expr))
    shown = list(map(_shown, factors))
    return expr if shown == factors else sp.Mul(*shown)


def _shown(factor: sp.Expr) -> sp.Expr:
    veil, exponent = factor.as_base_exp()
    meaning = current_reading.get().meanings.get(veil)
    if meaning is None or meaning.is_Function or not exponent.is_Integer:
        return factor
    return factor if meaning.is_Add and exponent != 1 else power_of(meaning, exponent)
