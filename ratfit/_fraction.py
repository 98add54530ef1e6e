"""A fraction in its shortest form: common factors cancelled in the exact field, constants cleared for the eye."""

from __future__ import annotations

from typing import Any

import mpmath
import sympy as sp

from ratfit._field import Field
from ratfit._generators import DIGITS, far_turns
from ratfit._poles import polynomial_roots
from ratfit._target import sample_values


def reduced(numerator: sp.Expr, denominator: sp.Expr, x: sp.Symbol) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Numerator and denominator without their common factor, and that factor (1 where there is none).

    Coprime at one place of the parameters is coprime: the exact greatest common divisor is taken only if a
    numerical one hints at it.
    """
    if not (numerator.is_polynomial(x) and denominator.is_polynomial(x)):
        return numerator, denominator, sp.S.One
    above, below = sp.Poly(numerator, x), sp.Poly(denominator, x)
    if above.is_zero or below.is_ground or below.is_zero or not _share_a_root(above, below):
        return numerator, denominator, sp.S.One
    field = Field([*above.all_coeffs(), *below.all_coeffs()])
    common = _gcd(field, _coefficients(field, above), _coefficients(field, below))
    if len(common) == 1:
        return numerator, denominator, sp.S.One
    quotients = [_divide(field, _coefficients(field, p), common)[0] for p in (above, below)]
    flat = field.simplest([*quotients[0], *quotients[1]])
    split = len(quotients[0])
    shown = [sp.Poly([field.decode(c) for c in cs], x).as_expr() for cs in (flat[:split], flat[split:])]
    factor = sp.Poly([field.decode(c) for c in field.simplest(common)], x).as_expr()
    return shown[0], shown[1], factor


def _share_a_root(above: sp.Poly, below: sp.Poly) -> bool:
    """Whether the resultant is numerically zero at a sampled place of all other symbols."""
    symbols = (above.free_symbols | below.free_symbols) - set(above.gens)
    values = sample_values(symbols, ("2/7",))[0]
    with mpmath.workdps(DIGITS):
        roots = [polynomial_roots(p.as_expr().xreplace(values), above.gens[0]) for p in (above, below)]
        return any(abs(a - b) < mpmath.mpf("1e-12") * (1 + abs(a)) for a in roots[0] for b in roots[1])


def _coefficients(field: Field, polynomial: sp.Poly) -> list[Any]:
    return _trimmed([field.encode(c) for c in polynomial.all_coeffs()])


def _trimmed(polynomial: list[Any]) -> list[Any]:
    while polynomial and not polynomial[0]:
        polynomial = polynomial[1:]
    return polynomial


def _divide(field: Field, a: list[Any], b: list[Any]) -> tuple[list[Any], list[Any]]:
    """Quotient and remainder of polynomials with coefficients in the exact field, leading coefficient first."""
    inverse, quotient = field.inverse(b[0]), []
    while len(a) >= len(b):
        lead = field.multiply(a[0], inverse)
        quotient.append(lead)
        padded = b + [field.zero] * (len(a) - len(b))
        a = [u - field.multiply(lead, v) for u, v in zip(a, padded, strict=True)][1:]
    return quotient, _trimmed(a)


def _gcd(field: Field, a: list[Any], b: list[Any]) -> list[Any]:
    while b:
        a, b = b, _divide(field, a, b)[1]
    return a


def presentable(factor: sp.Expr, numerator: sp.Expr, denominator: sp.Expr, x: sp.Symbol, inside: sp.Expr) -> sp.Expr:
    """The fraction as it is shown: each sum without common constants, positive in the middle of the support.

    The constants taken out are gathered into one; inner variables stay unexpanded.
    """
    constant = sp.S.One
    shown = []
    for part, sign in ((numerator, 1), (denominator, -1)):
        for piece in sp.Mul.make_args(part):
            base, exponent = piece.as_base_exp()
            if not base.has(x) or not base.is_Add or not exponent.is_Integer:
                shown.append(piece**sign)
                continue
            scale, plain = _without_scale(base, x, inside)
            constant *= scale ** (exponent * sign)
            shown.append(plain ** (exponent * sign))
    field = Field([constant], far_turns([constant]))
    above, below = sp.fraction(sp.together(field.decode(field.encode(constant))))
    return factor * above * sp.Mul(*shown) / below


def _without_scale(base: sp.Expr, x: sp.Symbol, inside: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """A sum as (constant, sum with the shortest coefficients)."""
    pairs = [term.as_independent(x, as_Add=False) for term in sp.Add.make_args(base)]
    collected: dict[sp.Expr, sp.Expr] = {}
    for coefficient, dependent in pairs:
        collected[dependent] = collected.get(dependent, sp.S.Zero) + coefficient
    field = Field(collected.values(), far_turns(collected.values()))
    elements = [field.encode(c) for c in collected.values()]
    short = field.simplest(elements)
    place = next(i for i, e in enumerate(elements) if e)
    scale = field.decode(field.multiply(elements[place], field.inverse(short[place])))
    plain = sp.Add(*(field.decode(s) * d for s, d in zip(short, collected, strict=True)))
    values = sample_values(plain.free_symbols | inside.free_symbols - {x}, ("3/7",))[0]
    values.pop(x, None)
    if sp.N(plain.xreplace(values).subs(x, inside.xreplace(values))).is_negative:
        return -scale, -plain
    return scale, plain
