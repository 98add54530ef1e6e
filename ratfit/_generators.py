"""Generators: constants and parameters written in a basis without hidden relations.

* powers of pi, of a parameter or of any other transcendental atom: powers of one root of it;
* roots of integers: roots of primes; roots of polynomials in the parameters: roots of their irreducible factors;
* exp, and powers with symbolic exponents: one exponential for each monomial of the exponent (with logarithms of
  integers reduced to those of primes), independent by Lindemann and Weierstrass where the monomials are algebraic;
* sin, cos, tan of multiples of one monomial: its cosine c, and its sine s with s**2 = 1 - c**2; where a sine stands
  under a root or there are several, the tangent of half the angle in place of both.

What is left (erf(1), atan(2), ...) is taken for independent. That can be false, so whoever draws a conclusion from
a rank compares it with the numerical one (`numerical_rank`).
"""

from __future__ import annotations

from collections.abc import Iterable
from collections.abc import Set as AbstractSet
from math import lcm

import mpmath
import sympy as sp

from ratfit._parse import RatfitError
from ratfit._target import INSIDE, sample_values

_TURNING = (sp.sin, sp.cos, sp.tan, sp.cot, sp.sec, sp.csc)

DIGITS = 50
"""Decimal digits of every numerical check of the algebra."""


def sampled(expression: sp.Expr) -> list[mpmath.mpf]:
    """The expression at three exact places inside the ranges of its parameters, to DIGITS digits."""
    return [numerical(expression.xreplace(v)) for v in sample_values(expression.free_symbols, ("1/7", "4/7", "9/11"))]


def sampled_inside(expression: sp.Expr) -> list[mpmath.mpf]:
    """The expression all over the ranges of its parameters; RatfitError where it is not real."""
    return [numerical(expression.xreplace(v)) for v in sample_values(expression.free_symbols, INSIDE)]


def numerical(expression: sp.Expr, digits: int = DIGITS) -> mpmath.mpf:
    """A constant expression to so many digits; one that sympy cannot tell from zero is zero."""
    value = sp.N(expression, digits, maxn=2 * digits)
    if not value.is_number or value.has(sp.nan, sp.zoo, sp.oo) or value.is_real is False:
        raise RatfitError(f"{expression} is not a real number")
    with mpmath.workdps(digits):
        return mpmath.mpf(sp.Float(value, digits)._mpf_)


MOST_TURNS = 2
"""How many times an angle's part may be turned: the sine of 17 parts is a polynomial of degree 17."""


def far_turns(expressions: Iterable[sp.Expr]) -> frozenset[sp.Expr]:
    """The sines and cosines of angles with a part that is to be turned more than MOST_TURNS times for one of them.

    None where one stands under a root: that of 1 - cos(5) is a sine, which nobody knows who takes them apart.
    """
    expressions = list(expressions)
    calls = {call for e in expressions for call in e.atoms(sp.sin, sp.cos)}
    powers = {power for e in expressions for power in e.atoms(sp.Pow) if not power.exp.is_Integer}
    if any(power.has(sp.sin, sp.cos) for power in powers):
        return frozenset()
    parts = Generators()
    parts.register_angles(calls)
    far = {monomial for call in calls for monomial, turns in parts.turns(call.args[0]) if turns > MOST_TURNS}
    return frozenset(call for call in calls if any(monomial in far for monomial, _ in parts.turns(call.args[0])))


class Generators:
    """The generators, and how an expression is written in them.

    `atoms` are transcendental: symbol -> the expression whose `degree`-th root it is. `relations` are algebraic:
    symbol -> its monic relation. `originals` gives each its expression in the constants as they were given.
    """

    def __init__(self, half_angles: bool = False, apart: AbstractSet[sp.Expr] = frozenset()) -> None:
        self._half_angles = half_angles
        self._apart = apart  # sines and cosines that are taken for independent of all others, only to write something
        self._dummies: dict[sp.Expr, sp.Symbol] = {}
        self._meaning: dict[sp.Symbol, sp.Expr] = {}
        self._angles: dict[sp.Expr, int] = {}
        self._degrees: dict[sp.Expr, int] = {}
        self._roots: dict[sp.Expr, sp.Symbol] = {}
        self._flat: dict[sp.Expr, sp.Expr] = {}
        self.relations: dict[sp.Symbol, sp.Expr] = {}

    @property
    def atoms(self) -> list[sp.Symbol]:
        return list(self._meaning)

    @property
    def originals(self) -> dict[sp.Symbol, sp.Expr]:
        found = {d: e ** sp.Rational(1, self._degrees.get(d, 1)) for d, e in self._meaning.items()}
        for base, root in self._roots.items():
            found[root] = self.meaning(base) ** sp.Rational(1, self._degrees[base])
        return found | self._sines

    @property
    def _sines(self) -> dict[sp.Symbol, sp.Expr]:
        return {d: e for e, d in self._dummies.items() if d in self.relations}

    def meaning(self, flat: sp.Expr) -> sp.Expr:
        """A flattened expression in the constants as they were given."""
        return flat.xreplace(self._meaning | self._sines)

    def _atom(self, expression: sp.Expr) -> sp.Symbol:
        if expression not in self._dummies:
            dummy = sp.Dummy(f"t{len(self._dummies)}", positive=True)
            self._dummies[expression] = dummy
            self._meaning[dummy] = expression
        return self._dummies[expression]

    def register_angles(self, expressions: Iterable[sp.Expr]) -> None:
        """Finds, for each monomial inside a sine or cosine, the largest part that all its angles are multiples of."""
        for expression in expressions:
            for call in expression.atoms(*_TURNING) - self._apart:
                scale = 2 if self._half_angles and isinstance(call, sp.tan) else 1
                for monomial, coefficient in _monomials(call.args[0]):
                    q = int((scale * coefficient).q)
                    self._angles[monomial] = lcm(self._angles.get(monomial, 1), q)

    def turns(self, angle: sp.Expr) -> list[tuple[sp.Expr, int]]:
        """The monomials of an angle, pi aside, each with the number of its parts that the angle holds."""
        pairs = [(monomial, coefficient) for monomial, coefficient in _monomials(angle) if monomial is not sp.pi]
        return [(monomial, abs(int(coefficient * self._angles[monomial]))) for monomial, coefficient in pairs]

    def flatten(self, expression: sp.Expr) -> sp.Expr:
        """The expression in atoms with sums, products and rational powers alone."""
        if expression not in self._flat:
            self._flat[expression] = self._flattened(expression)
        return self._flat[expression]

    def _flattened(self, e: sp.Expr) -> sp.Expr:
        if e.is_Rational:
            return e
        if e.is_Add or e.is_Mul:
            return e.func(*(self.flatten(a) for a in e.args))
        if e.is_Pow and e.exp.is_Rational:
            return self._root(e) if e.exp.q == 2 and e.base.is_number else self.flatten(e.base) ** e.exp
        if isinstance(e, sp.CRootOf):
            return self._algebraic(e)
        if isinstance(e, sp.exp) or e is sp.E or e.is_Pow:
            return self._exponential(e)
        if e in self._apart:
            return self._atom(e)
        if isinstance(e, (sp.sin, sp.cos)):
            cosine, sine = self._turn(e.args[0])
            return sine if isinstance(e, sp.sin) else cosine
        if isinstance(e, sp.log):
            return self._logarithm(e)
        if isinstance(e, sp.tan) and self._half_angles:
            (c, s), _ = self._direction(e.args[0], 1)
            return s / c
        rewritten = _rewritten(e)
        if rewritten != e:
            return self.flatten(rewritten)
        if not e.args and e.is_real is False:
            raise RatfitError("a number of the problem is not real; keep places and domain to where the target is real")
        return self._atom(e)

    def _root(self, e: sp.Pow) -> sp.Expr:
        """A square root of a + b*sqrt(c): denested where it can be, and with b > 0 otherwise.

        The roots of a + b*sqrt(c) and of a - b*sqrt(c), as sympy has them for sin(pi/5) and sin(2*pi/5), have a
        product in the field below: two generators for them would be related.
        """
        a, b, c = _quadratic(e.base)
        if b == 0:
            return self.flatten(e.base) ** e.exp
        norm = a**2 - b**2 * c
        if b < 0 and norm > 0:
            return self.flatten((sp.sqrt(norm) / sp.sqrt(a - b * sp.sqrt(c))) ** (2 * e.exp))
        plain = sp.sqrtdenest(sp.sqrt(e.base))
        if plain != sp.sqrt(e.base):
            return self.flatten(plain) ** (2 * e.exp)
        content = sp.gcd(a, b)
        whole = a / content + b / content * sp.sqrt(c)
        return self.flatten(content) ** e.exp * self.flatten(whole) ** e.exp

    def _algebraic(self, e: sp.CRootOf) -> sp.Symbol:
        if e not in self._dummies:
            dummy = sp.Dummy("root", real=True)
            self._dummies[e] = dummy
            self.relations[dummy] = e.poly.monic().as_expr().xreplace({e.poly.gen: dummy})
        return self._dummies[e]

    def _exponential(self, e: sp.Expr) -> sp.Expr:
        base, exponent = (sp.E, sp.S.One) if e is sp.E else e.as_base_exp()
        argument = exponent if base is sp.E else exponent * sp.expand_log(sp.log(base), force=bool(base.is_positive))
        product = sp.S.One
        for monomial, coefficient in _monomials(argument):
            if isinstance(monomial, sp.log):
                product *= self.flatten(monomial.args[0]) ** coefficient
            else:
                product *= self._atom(sp.exp(monomial)) ** coefficient
        return product

    def _logarithm(self, e: sp.Expr) -> sp.Expr:
        argument = e.args[0]
        if argument.is_Rational and argument > 0:
            return sp.Add(*(k * self._atom(sp.log(p)) for p, k in sp.factorrat(argument).items()))
        factors = self._log_factors(argument)
        if factors is not None:
            return sp.Add(*(k * self.flatten(sp.log(f)) for f, k in factors))
        expanded = sp.expand_log(e, force=bool(argument.is_positive))
        return self._atom(e) if isinstance(expanded, sp.log) else self.flatten(expanded)

    def _log_factors(self, argument: sp.Expr) -> list[tuple[sp.Expr, int]] | None:
        """A rational function as powers of positive irreducible factors: log(2*m + 1) and log(m + 1/2) are related."""
        if not argument.free_symbols or not argument.is_rational_function(*argument.free_symbols):
            return None
        if any(
            not number.is_Rational
            for number in argument.atoms(sp.NumberSymbol, sp.Function, sp.Pow)
            if number.is_number
        ):
            return None
        above, below = sp.fraction(sp.together(argument))
        (n, tops), (d, bottoms) = sp.factor_list(above), sp.factor_list(below)
        if len(tops) + len(bottoms) == 1 and n / d == 1 and (tops or bottoms)[0][1] == 1 and tops:
            return None
        found: list[tuple[sp.Expr, int]] = []
        for factor, k in [*((f, k) for f, k in tops), *((f, -k) for f, k in bottoms)]:
            sign = self._sign(factor)
            n *= sign**k
            found.append((sp.expand(sign * factor), k))
        if n / d < 0:
            return None
        return [(sp.Rational(n) / d, 1), *found] if n / d != 1 else found

    def _turn(self, angle: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """Cosine and sine of an angle, by the addition theorem from those of the monomials' parts."""
        if self._half_angles:
            (c, s), size = self._direction(angle, 2)
            return c / size, s / size
        c, s = sp.S.One, sp.S.Zero
        for monomial, coefficient in _monomials(angle):
            if monomial is sp.pi:
                c, s = _multiplied((c, s), self._rational_turn(coefficient))
                continue
            unit = monomial / self._part(monomial, coefficient)
            turns, cos = int(coefficient * self._angles[monomial]), self._atom(sp.cos(unit))
            s1 = sp.sign(turns) * self._sine(unit) * sp.chebyshevu(abs(turns) - 1, cos)
            c, s = _multiplied((c, s), (sp.chebyshevt(abs(turns), cos), s1))
        return c, s

    def _part(self, monomial: sp.Expr, coefficient: sp.Rational) -> int:
        part = self._angles.setdefault(monomial, int(coefficient.q))
        if part % coefficient.q:
            raise RatfitError(f"{coefficient * monomial} has no place in the exact field of this problem")
        return part

    def _direction(self, angle: sp.Expr, scale: int) -> tuple[tuple[sp.Expr, sp.Expr], sp.Expr]:
        """A vector in the direction of an angle, and its length, in tangents t of half the monomials' parts.

        The vector is the product of powers of 1 + i*t: free of relations, though longer to read. `scale` is 2 for an
        angle that is a multiple of the parts, 1 for one that is a multiple of their halves; the length is sure in the
        former case.
        """
        vector, size = (sp.S.One, sp.S.Zero), sp.S.One
        for monomial, coefficient in _monomials(angle):
            if monomial is sp.pi:
                vector = _multiplied(vector, self._rational_turn(coefficient))
                continue
            part = self._part(monomial, coefficient * 2 / scale)
            t, turns = self._atom(sp.tan(monomial / part / 2)), int(2 * coefficient * part)
            for _ in range(abs(turns)):
                vector = _multiplied(vector, (sp.S.One, sp.sign(turns) * t))
            size *= (1 + t**2) ** (sp.Integer(abs(turns)) / 2)
        return (sp.expand(vector[0]), sp.expand(vector[1])), size

    def prefers_half_angles(self, expressions: Iterable[sp.Expr], flat: Iterable[sp.Expr]) -> bool:
        """Whether a sine stands under a root, or several relations would make the algebra slow.

        sqrt(1 - s)*sqrt(1 + s) is c, which no generator would know. Tangents are what half angles leave behind.
        """
        sines = set(self.relations)
        under_root = (p.base for e in flat for p in e.atoms(sp.Pow) if not p.exp.is_Integer)
        return (
            len(sines) > 1 or any(e.has(sp.tan) for e in expressions) or any(b.free_symbols & sines for b in under_root)
        )

    def _sine(self, unit: sp.Expr) -> sp.Symbol:
        key = sp.sin(unit)
        if key not in self._dummies:
            dummy = sp.Dummy(f"s{len(self._dummies)}", real=True)
            self._dummies[key] = dummy
            self.relations[dummy] = dummy**2 - 1 + self._atom(sp.cos(unit)) ** 2
        return self._dummies[key]

    def _rational_turn(self, coefficient: sp.Rational) -> tuple[sp.Expr, sp.Expr]:
        """Cosine and sine of a rational multiple of pi, from cos(pi/N), an algebraic number."""
        n = 2 * self._angles[sp.pi]  # one cosine for all angles: cos(pi/7) lies in the field of cos(pi/14)
        key = sp.cos(sp.pi / n)
        if not isinstance(key, sp.cos):
            return self.flatten(sp.cos(coefficient * sp.pi)), self.flatten(sp.sin(coefficient * sp.pi))
        if key not in self._dummies:
            dummy = sp.Dummy(f"c{n}", real=True)
            self._dummies[key] = dummy
            self.relations[dummy] = sp.Poly(sp.minimal_polynomial(key, dummy), dummy).monic().as_expr()
        c = self._dummies[key]
        k = int(coefficient * n)
        return sp.chebyshevt(abs(k), c), sp.chebyshevt(abs(n // 2 - k), c)

    def register_roots(self, expression: sp.Expr) -> None:
        """Finds which roots occur, and of what degree, so that one generator serves all of them."""
        for power in sorted(expression.atoms(sp.Pow), key=sp.count_ops):
            if power.exp.is_Integer:
                continue
            for base, _ in self._split_base(power.base):
                self._degrees[base] = lcm(self._degrees.get(base, 1), int(power.exp.q))
                if base not in self._meaning and base not in self._roots:
                    self._roots[base] = sp.Dummy(f"r{len(self._roots)}", positive=True)
        for base, root in self._roots.items():
            self.relations[root] = root ** self._degrees[base] - base

    def _split_base(self, base: sp.Expr) -> list[tuple[sp.Expr, sp.Integer]]:
        """A radicand as a product of atoms, primes and irreducible polynomials, all positive."""
        if base.is_Rational:
            numbers, factors = base, []
        elif any(not p.exp.is_Integer for p in base.atoms(sp.Pow)):
            numbers, factors = sp.S.One, [(base, sp.S.One)]  # a nested radical; the numerical rank guards it
        else:
            numerator, denominator = sp.fraction(sp.together(base))
            (n, above), (d, below) = sp.factor_list(numerator), sp.factor_list(denominator)
            numbers = n / d
            factors = [(f, sp.Integer(k)) for f, k in above] + [(f, sp.Integer(-k)) for f, k in below]
        found = []
        for factor, k in factors:
            sign = self._sign(factor)
            found.append((sp.expand(sign * factor), k))
            numbers *= sign**k
        if numbers < 0:
            raise RatfitError(f"the root of {self.meaning(base)} is not real")
        return [(sp.Integer(p), sp.Integer(k)) for p, k in sp.factorrat(numbers).items() if p != 1] + found

    def _sign(self, factor: sp.Expr) -> int:
        if factor.is_positive:
            return 1
        signs = {mpmath.sign(value) for value in sampled_inside(self.meaning(factor))}
        if len(signs) > 1:
            raise RatfitError(f"the sign of {self.meaning(factor)} changes with the parameters; narrow their ranges")
        return int(signs.pop())

    def rooted(self, flat: sp.Expr) -> sp.Expr:
        """A flattened expression with every fractional power written as a whole power of a generator."""
        if flat in self._meaning:
            return flat ** self._degrees.get(flat, 1)
        if flat.is_Pow and not flat.exp.is_Integer:
            product = sp.S.One
            for base, k in self._split_base(flat.base):
                if base not in self._meaning and base not in self._roots:
                    raise RatfitError(f"{self.meaning(flat)} has no place in the exact field of this problem")
                exponent = k * flat.exp * self._degrees[base]
                product *= (base if base in self._meaning else self._roots[base]) ** exponent
            return product
        if flat.is_Add or flat.is_Mul or flat.is_Pow:
            return flat.func(*(self.rooted(a) for a in flat.args))
        return flat


def _multiplied(a: tuple[sp.Expr, sp.Expr], b: tuple[sp.Expr, sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
    """The product of two complex numbers."""
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def _quadratic(number: sp.Expr) -> tuple[sp.Rational, sp.Rational, sp.Rational]:
    """A number as a + b*sqrt(c) with rational a, b, c > 0; b is 0 where it is not of that kind."""
    roots = [p for p in number.atoms(sp.Pow) if not p.exp.is_Integer]
    if len(roots) == 1 and roots[0].exp == sp.S.Half and roots[0].base.is_Rational:
        expanded = sp.expand(number)
        b = expanded.coeff(roots[0])
        a = sp.expand(expanded - b * roots[0])
        if a.is_Rational and b.is_Rational and roots[0].base > 0:
            return a, b, roots[0].base
    return number, sp.S.Zero, sp.S.One


def _monomials(argument: sp.Expr) -> list[tuple[sp.Expr, sp.Rational]]:
    """A sum as monomials with rational coefficients."""
    pairs = (term.as_coeff_Mul() for term in sp.Add.make_args(sp.expand(argument)))
    return [(monomial, coefficient) for coefficient, monomial in pairs if coefficient != 0]


def _rewritten(e: sp.Expr) -> sp.Expr:
    """Functions that are rational in others: hyperbolic in exp, tan in sin and cos, erfc in erf, acos in asin."""
    if isinstance(e, (sp.sinh, sp.cosh, sp.tanh, sp.coth, sp.sech, sp.csch)):
        return e.rewrite(sp.exp)
    if isinstance(e, (sp.tan, sp.cot, sp.sec, sp.csc)):
        return (
            e.rewrite(sp.cos) if isinstance(e, sp.sec) else e.rewrite(sp.sin) if isinstance(e, sp.csc) else _tangent(e)
        )
    if isinstance(e, sp.erfc):
        return 1 - sp.erf(e.args[0])
    if isinstance(e, sp.acos):
        return sp.pi / 2 - sp.asin(e.args[0])
    return e


def _tangent(e: sp.Expr) -> sp.Expr:
    angle = e.args[0]
    return sp.sin(angle) / sp.cos(angle) if isinstance(e, sp.tan) else sp.cos(angle) / sp.sin(angle)
