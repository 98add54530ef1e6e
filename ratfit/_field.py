"""The exact field that the constants and parameters of a problem live in, and its linear algebra.

sympy's inferred domains take sqrt(pi) and pi, or sin(1) and sin(2), for unrelated symbols, and then report a wrong
rank without a word. Here every constant is first written in independent generators (`_generators.py`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet
from functools import cached_property
from math import lcm
from typing import Any

import mpmath
import sympy as sp
from sympy.polys.matrices import DomainMatrix
from sympy.polys.matrices.exceptions import DMNonInvertibleMatrixError
from sympy.polys.rings import ring

from ratfit._generators import DIGITS, Generators, numerical, sampled
from ratfit._parse import RatfitError
from ratfit._target import sample_values


class Related(RatfitError):
    """Constants taken for independent are not: what would follow from the algebra cannot be trusted."""


Element = Any  # an element of sympy's fraction field, or of a polynomial ring over it


class Field:
    """Q(t1, ..., tk)[a1, ..., ar] modulo one monic relation for each a; every symbol that occurs is a generator.

    Arguments: `expressions` that must have a place in it, made of constants, parameters and open coefficients;
    `apart`, sines and cosines that are generators of their own, whatever relations they have: an identity that holds
    so holds, but nothing follows from one that does not.
    Raises RatfitError for an expression that is not a real number there.
    """

    def __init__(self, expressions: Iterable[sp.Expr], apart: AbstractSet[sp.Expr] = frozenset()) -> None:
        expressions = [sp.sympify(e) for e in expressions]  # Python integers to sympy's; never text
        self._basis, flat = _flattened(expressions, False, apart)
        if self._basis.prefers_half_angles(expressions, flat):
            self._basis, flat = _flattened(expressions, True, apart)
        for expression in flat:
            self._basis.register_roots(expression)
        atoms = list(self._basis.atoms)
        # Later roots may lie over earlier ones: largest first, so that each relation leads with its own root.
        roots = list(reversed(self._basis.relations))
        self._base = sp.ZZ.frac_field(*atoms) if atoms else sp.QQ
        self._ring = ring(roots, self._base)[0] if roots else None
        self._images = {a: self._in_ring(g) for a, g in zip(atoms, self._base.gens if atoms else (), strict=True)}
        if self._ring is not None:
            self._images |= dict(zip(roots, self._ring.gens, strict=True))
        self.zero, self.one = self._in_ring(self._base.zero), self._in_ring(self._base.one)
        self._relations: list[Element] = []
        for root in roots:
            self._relations.append(self._evaluate(self._basis.rooted(self._basis.relations[root])))

    def _in_ring(self, element: Element) -> Element:
        return element if self._ring is None else self._ring.ground_new(element)

    def encode(self, expression: sp.Expr) -> Element:
        """The element that an expression stands for; RatfitError if it holds what the field was not built for."""
        return self._evaluate(self._basis.rooted(self._basis.flatten(expression)))

    def _evaluate(self, expression: sp.Expr) -> Element:
        if expression in self._images:
            return self._images[expression]
        if expression.is_Rational:
            return self._in_ring(self._base.from_sympy(expression))
        if expression.is_Add or expression.is_Mul:
            parts = [self._evaluate(part) for part in expression.args]
            total = parts[0]
            for part in parts[1:]:
                total = total + part if expression.is_Add else self.multiply(total, part)
            return total
        if expression.is_Pow and expression.exp.is_Integer:
            base = self._evaluate(expression.base)
            return self.power(base if expression.exp > 0 else self.inverse(base), abs(int(expression.exp)))
        raise RatfitError(f"{expression} has no place in the exact field of this problem")

    def decode(self, element: Element) -> sp.Expr:
        """The expression of an element, in the constants as they were given."""
        return sp.sympify(element.as_expr() if hasattr(element, "as_expr") else self._base.to_sympy(element)).xreplace(
            self._basis.originals
        )

    def multiply(self, a: Element, b: Element) -> Element:
        return self._reduced(a * b)

    def power(self, a: Element, exponent: int) -> Element:
        result = self.one
        for _ in range(exponent):
            result = self.multiply(result, a)
        return result

    def _reduced(self, element: Element) -> Element:
        return element.rem(self._relations) if self._relations else element

    def inverse(self, element: Element) -> Element:
        """1/element; RatfitError for zero."""
        if not element:
            raise RatfitError("division by an expression that is exactly zero")
        if self._ring is None:
            return self._base.one / element
        if element.is_ground:
            return self._ring.ground_new(self._base.one / element.coeff(1))
        if len(self._relations) < self._ring.ngens:
            raise Related("some roots of the solution lie over others in a way that the exact field does not hold")
        unit = DomainMatrix([[self._base.one]] + [[self._base.zero]] * (self.degree - 1), (self.degree, 1), self._base)
        blocks = DomainMatrix(self._block(element), (self.degree, self.degree), self._base)
        try:
            return self._joined([row[0] for row in blocks.lu_solve(unit).to_list()])
        except DMNonInvertibleMatrixError:
            raise Related(
                f"{self.decode(element)} divides zero: its roots are related in a way not known here"
            ) from None

    @cached_property
    def _monomials(self) -> list[tuple[int, ...]]:
        """The basis over Q(t1, ..., tk): all products of roots below their relations' degrees."""
        found: list[tuple[int, ...]] = [()]
        for relation, generator in zip(self._relations, self._ring.gens if self._ring else (), strict=True):
            found = [(*m, e) for m in found for e in range(relation.degree(generator))]
        return found

    @cached_property
    def degree(self) -> int:
        """Dimension over Q(t1, ..., tk)."""
        return len(self._monomials)

    def _split(self, element: Element) -> list[Element]:
        if self._ring is None:
            return [element]
        return [element.get(m, self._base.zero) for m in self._monomials]

    def _joined(self, parts: Sequence[Element]) -> Element:
        if self._ring is None:
            return parts[0]
        return self._ring.from_dict({m: p for m, p in zip(self._monomials, parts, strict=True) if p})

    def _block(self, element: Element) -> list[list[Element]]:
        """The matrix of multiplication by an element."""
        if self._ring is None:
            return [[element]]
        columns = [
            self._split(self.multiply(element, self._ring.from_dict({m: self._base.one}))) for m in self._monomials
        ]
        return [list(row) for row in zip(*columns, strict=True)]

    def null_space(self, rows: Sequence[Sequence[Element]], width: int) -> list[list[Element]]:
        """A basis of the vectors that every row sends to zero; `width` is the number of columns.

        Over the extension the matrix is written in blocks over Q(t1, ..., tk). The null space is stable under the
        extension, so its free columns fill whole blocks, and one vector a block is a basis over the extension.
        """
        d = self.degree
        wide = [
            [x for block in blocks for x in block[i]]
            for row in rows
            for blocks in [[self._block(e) for e in row]]
            for i in range(d)
        ]
        matrix = DomainMatrix(wide, (len(wide), width * d), self._base).to_field()
        basis = matrix.nullspace().to_list() if wide else DomainMatrix.eye(width * d, self._base).to_list()
        vectors = basis[::d]
        return [self.simplest([self._joined(v[i * d : (i + 1) * d]) for i in range(width)]) for v in vectors]

    def determinant(self, matrix: Sequence[Sequence[Element]]) -> Element:
        """By Bird's algorithm, which never divides: a root's relation may hide a divisor of zero."""
        n = len(matrix)
        power = [list(row) for row in matrix]
        for _ in range(n - 1):
            power = self._product(self._bird(power), matrix)
        return power[0][0] if n % 2 else -power[0][0]

    def _bird(self, m: list[list[Element]]) -> list[list[Element]]:
        """The upper triangle of a matrix, with minus the trace of what follows in each place of the diagonal."""
        n = len(m)
        traces = [sum((m[j][j] for j in range(i + 1, n)), self.zero) for i in range(n)]
        return [[self.zero] * i + [-traces[i], *m[i][i + 1 :]] for i in range(n)]

    def product(self, a: Sequence[Element], b: Sequence[Element]) -> Element:
        """The scalar product of two vectors."""
        return sum((self.multiply(x, y) for x, y in zip(a, b, strict=True) if x and y), self.zero)

    def _product(self, a: Sequence[Sequence[Element]], b: Sequence[Sequence[Element]]) -> list[list[Element]]:
        columns = list(zip(*b, strict=True))
        return [[self.product(row, column) for column in columns] for row in a]

    def simplest(self, vector: Sequence[Element]) -> list[Element]:
        """The multiple of a vector that is shortest to write: no denominators, no common factor."""
        choices = [self._cleared(vector)]
        if self._ring is not None and len(vector) <= 8:
            for pivot in vector:
                if pivot and not pivot.is_ground:
                    inverse = self.inverse(pivot)
                    choices.append(self._cleared([self.multiply(e, inverse) for e in vector]))
        return min(choices, key=lambda v: sum(self._length(e) for e in v))

    def _length(self, element: Element) -> int:
        return sum(
            len(p.numer) if hasattr(p, "numer") and hasattr(p.numer, "terms") else bool(p) for p in self._split(element)
        )

    def _cleared(self, vector: Sequence[Element]) -> list[Element]:
        parts = [p for e in vector for p in self._split(e) if p]
        if not parts:
            return list(vector)
        if self._base is sp.QQ:
            numerators = [int(p.numerator) for p in parts]
            factor = sp.QQ(lcm(*(int(p.denominator) for p in parts)), sp.igcd(*numerators, 0))
        else:
            polynomials = self._base.field.ring
            common, shared = polynomials.one, polynomials.zero
            for p in parts:
                common = common.lcm(p.denom)
            for p in parts:
                shared = shared.gcd(p.numer * common.exquo(p.denom))
            factor = self._base.field.new(common, shared)
        return [e * factor if self._ring is None else e.mul_ground(factor) for e in vector]

    def is_zero(self, expression: sp.Expr) -> bool:
        """Whether an expression of this field is exactly zero."""
        return not self.encode(expression)


def _flattened(
    expressions: Sequence[sp.Expr], half_angles: bool, apart: AbstractSet[sp.Expr]
) -> tuple[Generators, list[sp.Expr]]:
    basis = Generators(half_angles, apart)
    basis.register_angles(expressions)
    return basis, [basis.flatten(e) for e in expressions]


def is_zero(expression: sp.Expr) -> bool | None:
    """Whether an expression of constants and symbols is exactly zero; None when algebra and numerics disagree."""
    if expression.is_Rational:
        return expression == 0
    try:
        exact = Field([expression]).is_zero(expression)
    except Related:
        return None
    numerical = all(abs(value) < mpmath.mpf(10) ** (10 - DIGITS) for value in sampled(expression))
    return exact if exact == numerical else None


def ranks_agree(rows: Sequence[Sequence[sp.Expr]], rank: int) -> bool:
    """Whether a matrix of expressions has that rank numerically, at DIGITS digits or, badly conditioned, at more."""
    return any(numerical_rank(rows, digits) == rank for digits in (DIGITS, 5 * DIGITS))


def numerical_rank(rows: Sequence[Sequence[sp.Expr]], digits: int = DIGITS) -> int:
    """The rank of a matrix of expressions at so many digits, the largest over sampled values of its symbols."""
    symbols = {s for row in rows for e in row for s in e.free_symbols}
    ranks = []
    for values in sample_values(symbols, ("1/7", "4/7")):
        with mpmath.workdps(digits):
            ranks.append(_rank([[numerical(e.xreplace(values), digits) for e in row] for row in rows], digits))
    return max(ranks, default=0)


def _rank(rows: list[list[mpmath.mpf]], digits: int) -> int:
    """Gaussian elimination with complete pivoting on rows scaled to size 1."""
    rows = [[e / size for e in row] for row in rows if (size := max(map(abs, row), default=0))]
    rank = 0
    while rows:
        i, j = max(((i, j) for i, row in enumerate(rows) for j in range(len(row))), key=lambda p: abs(rows[p[0]][p[1]]))
        pivot = rows.pop(i)
        if abs(pivot[j]) < mpmath.mpf(10) ** (-(2 * digits) // 3):
            break
        rank += 1
        rows = [[e - row[j] / pivot[j] * p for e, p in zip(row, pivot, strict=True)] for row in rows]
    return rank
