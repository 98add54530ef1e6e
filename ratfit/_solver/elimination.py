"""All solutions of polynomial equations, by factors, linear unknowns, roots in closed form and a Groebner basis."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import sympy as sp

from ratfit._field import Field
from ratfit._generators import sampled_inside
from ratfit._parse import RatfitError
from ratfit._solver.solution import Undecided
from ratfit._solver.squares import normal

Assignment = dict[sp.Symbol, sp.Expr]


class _Free(Exception):
    """An unknown that the equations, brought to a basis, leave open."""

    def __init__(self, unknown: sp.Symbol, equations: Sequence[sp.Expr]) -> None:
        self.unknown, self.equations = unknown, equations


def solutions(equations: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol]) -> Iterator[Assignment]:
    """All solutions of polynomial equations; an unknown that is missing from an assignment is free in it.

    Factors split the problem, unknowns that occur linearly are put in, and a Groebner basis gives an equation in one
    unknown where nothing simpler is left.
    """
    polynomials = _polynomials(equations)
    if any(not p.has(*unknowns) for p in polynomials):
        return
    if not polynomials:
        yield {}
        return
    split = _first_split(polynomials, unknowns)
    if split is not None:
        yield from _branches(polynomials, *split, unknowns)
        return
    split = _conditional(polynomials, unknowns)
    if split is not None:
        yield from _with_and_without(polynomials, *split, unknowns)
        return
    try:
        found = list(_eliminations(polynomials, unknowns))
    except _Free as free:
        yield from solutions(free.equations, [u for u in unknowns if u != free.unknown])
        return
    for symbol, value, rest in found:
        if not value.has(*unknowns) and is_complex(value):
            yield {symbol: value}  # named, so that it can be rejected by name; nothing real follows from it
            continue
        others = [u for u in unknowns if u != symbol]
        for assignment in solutions([e.subs(symbol, value) for e in rest], others):
            yield {**assignment, symbol: normal(value.subs(assignment))}


def _polynomials(equations: Sequence[sp.Expr]) -> list[sp.Expr]:
    """The equations with denominators cleared and what is exactly zero left out."""
    cleared = [sp.fraction(sp.together(e))[0] for e in equations]
    field = Field(cleared)
    return [e for e in cleared if not field.is_zero(e)]


def _first_split(polynomials: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol]) -> tuple[int, list[sp.Expr]] | None:
    """The first equation that is a product of several factors, or a power, with its factors."""
    for i, polynomial in enumerate(polynomials):
        factors = [f for f, _ in _factors(polynomial) if f.has(*unknowns)]
        if len(factors) > 1 or (
            factors and sp.expand(factors[0] - polynomial) != 0 and _degree_drops(factors[0], polynomial, unknowns)
        ):
            return i, factors
    return None


def _degree_drops(factor: sp.Expr, polynomial: sp.Expr, unknowns: Sequence[sp.Symbol]) -> bool:
    return sp.Poly(factor, *unknowns).total_degree() < sp.Poly(polynomial, *unknowns).total_degree()


def _factors(polynomial: sp.Expr) -> list[tuple[sp.Expr, int]]:
    """Irreducible factors over the rational functions of the constants, taken as the symbols of the exact field."""
    constants = {c: sp.Dummy() for c in sorted(_constants(polynomial), key=str)}
    _, factors = sp.factor_list(polynomial.xreplace(constants))
    back = {d: c for c, d in constants.items()}
    return [(f.xreplace(back), k) for f, k in factors]


def _constants(expression: sp.Expr) -> set[sp.Expr]:
    """The numbers in an expression that are not rational: pi, sqrt(2), exp(1), sqrt(m), ..."""
    if expression.is_Rational or expression.is_Symbol:
        return set()
    if expression.is_Add or expression.is_Mul or (expression.is_Pow and expression.exp.is_Integer):
        return set().union(*(_constants(a) for a in expression.args))
    return {expression}


def _branches(polynomials, place, factors, unknowns) -> Iterator[Assignment]:
    seen: list[Assignment] = []
    for factor in factors:
        rest = [*polynomials[:place], factor, *polynomials[place + 1 :]]
        for assignment in solutions(rest, unknowns):
            if assignment not in seen:
                seen.append(assignment)
                yield assignment


def _eliminations(polynomials, unknowns) -> Iterator[tuple[sp.Symbol, sp.Expr, list[sp.Expr]]]:
    """Ways to put one unknown in: (unknown, its value, what is left), all of which together lose no solution."""
    linear = _linear_in(polynomials, unknowns)
    if linear is not None:
        place, symbol, slope, rest = linear
        others = [*polynomials[:place], *polynomials[place + 1 :]]
        yield symbol, -rest / slope, others
        return
    single = next(
        ((i, next(iter(s))) for i, p in enumerate(polynomials) if len(s := p.free_symbols & set(unknowns)) == 1), None
    )
    if single is not None:
        place, symbol = single
        others = [*polynomials[:place], *polynomials[place + 1 :]]
        for root in _roots(polynomials[place], symbol):
            yield symbol, root, others
        return
    yield from _by_groebner(polynomials, unknowns)


def _conditional(polynomials, unknowns) -> tuple[int, sp.Symbol] | None:
    """An equation of several unknowns that is linear in one of them, where no unknown has a constant coefficient."""
    if _linear_in(polynomials, unknowns) is not None:
        return None
    for place, polynomial in enumerate(polynomials):
        several = polynomial.free_symbols & set(unknowns)
        for symbol in reversed(unknowns):
            if len(several) > 1 and symbol in several and sp.degree(polynomial, symbol) == 1:
                return place, symbol
    return None


def _with_and_without(polynomials, place, symbol, unknowns) -> Iterator[Assignment]:
    """slope*u + rest = 0: u = -rest/slope, or slope = rest = 0; the two together lose nothing."""
    slope, rest = sp.Poly(polynomials[place], symbol).all_coeffs()
    others = [*polynomials[:place], *polynomials[place + 1 :]]
    value = -rest / slope
    remaining = [u for u in unknowns if u != symbol]
    for assignment in solutions([e.subs(symbol, value) for e in others], remaining):
        if not _vanishes(slope.subs(assignment)):
            yield {**assignment, symbol: normal(value.subs(assignment))}
    yield from solutions([*others, slope, rest], unknowns)


def _vanishes(value: sp.Expr) -> bool:
    """Whether a value is zero; one that is not real, or not for all parameters, belongs to a branch of its own."""
    try:
        return Field([value]).is_zero(value)
    except RatfitError:
        return False


def _linear_in(polynomials, unknowns):
    """An equation in which an unknown occurs linearly, with a coefficient free of unknowns, preferring short ones."""
    found = []
    for place, polynomial in enumerate(polynomials):
        for symbol in unknowns:
            if polynomial.has(symbol) and sp.degree(polynomial, symbol) == 1:
                slope, rest = sp.Poly(polynomial, symbol).all_coeffs()
                if not slope.has(*unknowns):
                    found.append((sp.count_ops(rest), place, symbol, slope, rest))
    if not found:
        return None
    _, place, symbol, slope, rest = min(found, key=lambda f: (f[0], f[1]))
    return place, symbol, slope, rest


def _roots(polynomial: sp.Expr, symbol: sp.Symbol) -> list[sp.Expr]:
    """All roots of an irreducible polynomial in closed form, complex ones included."""
    coefficients = sp.Poly(polynomial, symbol).all_coeffs()
    degree = len(coefficients) - 1
    if degree == 2:
        a, b, c = coefficients
        root = sp.sqrt(sp.factor(sp.expand(b**2 - 4 * a * c)))
        return [normal((-b + sign * root) / (2 * a)) for sign in (1, -1)]
    if all(c.is_Rational for c in coefficients):
        _, factors = sp.Poly(polynomial, symbol).factor_list()
        if len(factors) > 1:
            return [root for factor, _ in factors for root in _roots(factor.as_expr(), symbol)]
        return [-coefficients[1] / coefficients[0]] if degree == 1 else factors[0][0].all_roots(radicals=False)
    roots = sp.roots(sp.Poly(polynomial, symbol))
    if sum(roots.values()) == degree:
        return list(roots)
    raise Undecided(f"{symbol} is a root of a polynomial of degree {degree} that has no closed form")


def is_complex(value: sp.Expr) -> bool:
    """Whether a value is not real all over the ranges of its parameters."""
    try:
        sampled_inside(value)
    except RatfitError:
        return True
    return False


def _by_groebner(polynomials, unknowns) -> Iterator[tuple[sp.Symbol, sp.Expr, list[sp.Expr]]]:
    """A lexicographic basis: its last equation is in one unknown, or else that unknown is free."""
    constants = {c: sp.Dummy(positive=True) for p in polynomials for c in sorted(_constants(p), key=str)}
    back = {d: c for c, d in constants.items()}
    domain_symbols = sorted(
        {s for p in polynomials for s in p.xreplace(constants).free_symbols} - set(unknowns), key=str
    )
    used = [u for u in unknowns if any(p.has(u) for p in polynomials)]
    domain = sp.QQ.frac_field(*domain_symbols) if domain_symbols else sp.QQ
    basis = sp.groebner([p.xreplace(constants) for p in polynomials], *used, order="lex", domain=domain)
    equations = [e.xreplace(back) for e in basis.exprs]
    if all(e.is_number for e in equations):
        return
    last = equations[-1]
    symbols = last.free_symbols & set(used)
    if len(symbols) == 1:
        symbol = symbols.pop()
        for root in _roots(last, symbol):
            yield symbol, root, equations[:-1]
        return
    # Nothing is said about the last unknown alone: it is free, a constant for what follows.
    raise _Free(used[-1], equations)
