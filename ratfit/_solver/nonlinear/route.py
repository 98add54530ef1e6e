"""The nonlinear route: many starts, each root polished to 60 digits and, where balls can, proved near a true one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

import sympy as sp

from ratfit._parse import RatfitError
from ratfit._solver.nonlinear.assembly import Assembly, assembled
from ratfit._solver.solution import Numbers, Solution, Undecided
from ratfit._system import System

MOST = 24
"""Roots that are looked at: equations like sin(a) = 1/2 have ever more."""

SIMPLE, ROUGH = 100, 1e-5
"""Largest denominator of a number that a multiple root may stand for, and how near it must be."""

SAME = 1e-7
"""Roots nearer than this, relative to their size, are one."""


def solve_nonlinear(system: System, seed: int = 0) -> Iterator[Solution]:
    """Every solution that many starts find, as soon as it is found: "all found", never "all there are".

    What is linear is solved exactly first. Raises Undecided where a condition has no residual here, or where the
    conditions are too few to single out coefficients.
    """
    assembly = assembled(system)
    if assembly is None:
        raise Undecided(
            "the conditions that are linear in the coefficients clash among themselves (values, slopes, limits): "
            "drop one of them or raise a degree"
        )
    residuals = assembly.residuals
    if not residuals.unknowns or (residuals.homogeneous and len(residuals.unknowns) == 1):
        only = dict.fromkeys(residuals.unknowns, sp.S.One)
        yield Solution(assembly.numerator.subs(only), assembly.denominator.subs(only))
        return
    if parameters := _parameters(assembly):
        from ratfit._solver.nonlinear.tabulated import tabulated

        yield from tabulated(assembly, parameters, seed)
        return
    yield from _single(assembly, seed)


def _parameters(assembly: Assembly) -> list[sp.Symbol]:
    residuals = assembly.residuals
    everything = (*residuals.expressions, assembly.numerator, assembly.denominator)
    symbols = set[sp.Symbol]().union(*(e.free_symbols for e in everything))
    return sorted(symbols - set(residuals.unknowns) - {residuals.variable}, key=lambda s: s.name)


def _single(assembly: Assembly, seed: int) -> Iterator[Solution]:
    from ratfit._solver.nonlinear.search import search_chunks

    done: list = []
    for found in search_chunks(assembly.residuals, seed=seed):
        for root in sorted(found, key=lambda root: abs(root).max()):
            if len(done) == MOST:
                return
            if any(_near(root, other, assembly.residuals.homogeneous) for other in done):
                continue
            done.append(root)
            solution = _polished_solution(assembly, root)
            if solution is not None:
                yield solution


def _near(a, b, homogeneous: bool) -> bool:
    """Whether two roots, arrays of one shape, are the same answer."""
    signs = (1, -1) if homogeneous else (1,)
    return any(abs(a - sign * b).max() < SAME * (1 + abs(a).max()) for sign in signs)


def _polished_solution(assembly: Assembly, root) -> Solution | None:
    """The solution at a root, or None where it was none: a float's residual can be small where no root is."""
    from ratfit._solver.nonlinear.certified import certified_root

    found = certified_root(assembly.residuals, root)
    if found is None:
        return _multiple_root(assembly, root)
    values = dict(zip(assembly.residuals.unknowns, found.numbers, strict=True))
    numbers = Numbers(assembly.numerical, found.words, _guess(assembly, found.numbers))
    return Solution(assembly.numerator.subs(values), assembly.denominator.subs(values), numbers=numbers)


def _multiple_root(assembly: Assembly, root) -> Solution | None:
    """Newton's method does not polish a multiple root, of which floats know half the digits: fractions that are so
    simple that they may be meant are put in its place, for the caller to verify.
    """
    scale = max(root, key=abs) if assembly.residuals.homogeneous else 1.0
    numbers = [float(value / scale) for value in root]
    simple = [Fraction(number).limit_denominator(SIMPLE) for number in numbers]
    if any(abs(float(s) - n) > ROUGH * (1 + abs(n)) for s, n in zip(simple, numbers, strict=True)):
        return None
    exact = [sp.Rational(s.numerator, s.denominator) for s in simple]
    found = dict(zip(assembly.residuals.unknowns, exact, strict=True))
    return Solution(assembly.numerator.subs(found), assembly.denominator.subs(found))


def _guess(assembly: Assembly, numbers: Sequence[sp.Rational]) -> Solution | None:
    """A closed form that looks like the numbers, for the caller to verify."""
    from ratfit._solver.nonlinear.recognise import recognised

    homogeneous = assembly.residuals.homogeneous
    scale = max(numbers, key=abs) if homogeneous else sp.S.One
    guesses = recognised([number / scale for number in numbers], _constants(assembly))
    if guesses is None:
        return None
    found = dict(zip(assembly.residuals.unknowns, guesses, strict=True))
    try:
        return Solution(assembly.numerator.subs(found), assembly.denominator.subs(found))
    except RatfitError:
        return None


def _constants(assembly: Assembly) -> list[sp.Expr]:
    """The irrational numbers that occur in the residuals, the plainest few."""
    found = set().union(*(e.atoms(sp.NumberSymbol, sp.Function, sp.Pow) for e in assembly.residuals.expressions))
    irrational = (c for c in found if c.is_number and c.is_real and not c.is_Rational and 1 / c not in found)
    return sorted(irrational, key=lambda c: (sp.count_ops(c), str(c)))[:3]
