"""Poles: the real zeros of a denominator on an interval, at sampled values of the parameters."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import mpmath
import sympy as sp

from ratfit._generators import DIGITS
from ratfit._multiprecise import endpoint, function_of, multiprecise
from ratfit._target import sample_values

SCAN = 2001
"""Points at which a denominator that is no polynomial is looked at for changes of sign."""

SETTINGS, PLACES = 61, 32
"""Values of each parameter, and places on the support, of the scan for changes of sign."""

NEAR = mpmath.mpf("1e-15")
"""How far from the real axis, or from an end of the interval, a computed root may lie and still count as on it."""


def poles(
    denominator: sp.Expr, x: sp.Symbol, support: tuple[sp.Expr, sp.Expr]
) -> list[tuple[mpmath.mpf, dict[sp.Symbol, sp.Expr]]]:
    """Real zeros of a denominator on the closed support, each with the values of the parameters that it occurs at.

    Every parameter takes four values of its range, the ends included, and those at which a scan of floats over range
    and support sees the denominator change its sign: what both miss goes unseen.
    """
    if not denominator.has(x):
        return []
    found = []
    symbols = set[sp.Symbol]().union(denominator.free_symbols - {x}, *(end.free_symbols for end in support))
    places = sample_values(symbols, ("0", "1/7", "4/7", "1"))
    for values in places + _suspects(denominator, x, support):
        with mpmath.workdps(DIGITS):
            ends = [endpoint(end.xreplace(values)) for end in support]
            found += [(root, values) for root in _real_zeros(denominator.xreplace(values), x, ends)]
    return found


def _suspects(denominator: sp.Expr, x: sp.Symbol, support: tuple[sp.Expr, sp.Expr]) -> list[dict[sp.Symbol, sp.Expr]]:
    """One setting of the parameters at which the denominator changes its sign on the support, if floats see one."""
    symbols = sorted((denominator.free_symbols - {x}).union(*(e.free_symbols for e in support)), key=lambda s: s.name)
    if not symbols or any(end.is_infinite for end in support):
        return []
    function = sp.lambdify([x, *symbols], denominator, "math", cse=False)
    moving = any(end.free_symbols for end in support)
    fixed = (0.0, 0.0) if moving else tuple(float(end) for end in support)
    for values in sample_values(set(symbols), tuple(f"{k}/{SETTINGS}" for k in range(1, SETTINGS))):
        low, high = (float(end.xreplace(values)) for end in support) if moving else fixed
        given = [float(values[s]) for s in symbols]
        try:
            found = [function(low + (high - low) * k / PLACES, *given) for k in range(PLACES + 1)]
        except (ValueError, ZeroDivisionError, OverflowError):
            continue
        if min(found) < 0 < max(found):
            return [values]
    return []


def _real_zeros(denominator: sp.Expr, x: sp.Symbol, ends: Sequence[mpmath.mpf]) -> list[mpmath.mpf]:
    found = []
    for base in (factor.as_base_exp()[0] for factor in sp.Mul.make_args(denominator)):
        roots = polynomial_roots(base, x) if base.is_polynomial(x) else _scanned_roots(base, x, ends)
        real = (r.real for r in roots if abs(r.imag) < NEAR * (1 + abs(r)))
        found += [r for r in real if ends[0] - NEAR <= r <= ends[1] + NEAR]
    return found


@lru_cache(maxsize=100)
def polynomial_roots(polynomial: sp.Expr, x: sp.Symbol) -> list[mpmath.mpc]:
    """The complex roots at DIGITS digits, kept because coprimality and poles both ask for them."""
    poly = sp.Poly(polynomial, x)
    if all(c.is_Rational for c in poly.all_coeffs()) and poly.degree() > 1:
        parts = poly.sqf_list()[1]  # exact: multiple roots converge slowly and lose half their digits
        return [root for part, times in parts for root in _simple_roots(part) * times]
    return _simple_roots(poly)


def _simple_roots(poly: sp.Poly) -> list[mpmath.mpc]:
    coefficients = [multiprecise(c) for c in poly.all_coeffs()]
    size = max(map(abs, coefficients))
    while coefficients and abs(coefficients[0]) < mpmath.mpf("1e-45") * size:
        coefficients = coefficients[1:]
    if len(coefficients) < 2:
        return []
    try:
        return [mpmath.mpc(r) for r in mpmath.polyroots(coefficients, maxsteps=200, extraprec=mpmath.mp.prec)]
    except mpmath.libmp.NoConvergence:
        # Multiple roots converge slowly; the accuracy left is still far below the tolerance of the search.
        return [
            mpmath.mpc(r)
            for r in mpmath.polyroots(coefficients, maxsteps=2000, extraprec=20 * mpmath.mp.prec, error=False)
        ]


def _real(value: mpmath.mpf | mpmath.mpc) -> mpmath.mpf:
    """A real value; nan, which has no sign, for one that is not."""
    if not isinstance(value, mpmath.mpc):
        return value
    return value.real if value.imag == 0 else mpmath.nan


def _scanned_roots(base: sp.Expr, x: sp.Symbol, ends: Sequence[mpmath.mpf]) -> list[mpmath.mpc]:
    """Changes of sign of something that is no polynomial; an infinite end is cut at a distance of 1000."""
    if not base.has(x):
        return []
    low, high = max(ends[0], mpmath.mpf(-1000)), min(ends[1], mpmath.mpf(1000))
    function = function_of(base, x, {})
    points = [low + (high - low) * i / (SCAN - 1) for i in range(SCAN - 1)] + [high]  # no rounding beyond the end
    values = [_real(function(p)) for p in points]
    found = [p for p, v in zip(points, values, strict=True) if v == 0]
    for i in range(SCAN - 1):
        if mpmath.sign(values[i]) * mpmath.sign(values[i + 1]) < 0:
            found.append(mpmath.findroot(function, (points[i], points[i + 1]), solver="anderson"))
    return [mpmath.mpc(f) for f in found]
