"""Random fractions P/Q and conditions read off them exactly, of every kind and mix: the answers are known beforehand.

Nothing here asks ratfit for a number: demands come from Laurent series over Q or Q(m), and from partial fractions.
"""

from __future__ import annotations

import functools
import itertools
import random
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np
import sympy as sp

import ratfit as rf

R = sp.Rational
x = sp.Symbol("x", real=True)
y = sp.Function("y")(x)
m = rf.parameter("m", R(1, 2), 2)
z = sp.Symbol("z", positive=True)
"""An irrational place while series are computed; a number is put in at the end."""

MIDDLE = {m: R(6, 5), z: R(707, 500)}
"""Where the symbols are looked at: independence of conditions is generic."""

SEED = "ratfit"
"""Another word makes 200 other problems."""

INDEPENDENT = 1e-5
"""A condition is taken if its row, of length 1, lies so far from those before: no problem is nearly singular."""


# --- polynomials and series over a field, the lowest power first


def times(a: list, b: list) -> list:
    found = [0 * a[0]] * (len(a) + len(b) - 1)
    for i, p in enumerate(a):
        for j, q in enumerate(b):
            found[i + j] += p * q
    return found


def plus(a: list, b: list) -> list:
    return [p + q for p, q in itertools.zip_longest(a, b, fillvalue=0)]


def divided(a: list, b: list) -> tuple[list, list]:
    """Quotient and remainder; b's last coefficient is not 0."""
    rest, quotient = list(a), []
    while len(rest) >= len(b):
        top = rest[-1] / b[-1]
        quotient.insert(0, top)
        for k in range(len(b)):
            rest[len(rest) - len(b) + k] -= top * b[k]
        rest.pop()
    return quotient or [0 * a[0]], rest


def value(a: list, at):
    return functools.reduce(lambda total, c: total * at + c, reversed(a))


def shifted(a: list, at) -> list:
    """a(at + t)."""
    found = [a[-1]]
    for c in reversed(a[:-1]):
        found = times(found, [at, 1 + 0 * at])
        found[0] += c
    return found


@dataclass(frozen=True)
class Series:
    """Coefficients of the distance from a place, or of 1/x at infinity, from the power `lowest` on."""

    lowest: int
    coefficients: list

    def at(self, power: int):
        inside = 0 <= power - self.lowest < len(self.coefficients)
        return self.coefficients[power - self.lowest] if inside else 0


def series(above: list, below: list, at, top: int) -> Series:
    """The Laurent series of a fraction up to the power `top`; `at` is None for infinity."""
    if at is None:
        lowest, above, below = len(below) - len(above), above[::-1], below[::-1]
    else:
        lowest, above, below = 0, shifted(above, at), shifted(below, at)
    while below[0] == 0:
        lowest, below = lowest - 1, below[1:]
    found: list = []
    for k in range(max(top - lowest + 1, 1)):
        c = above[k] if k < len(above) else 0 * below[0]
        c -= sum((found[k - j] * below[j] for j in range(1, min(k, len(below) - 1) + 1)), 0 * below[0])
        found.append(c / below[0])
    return Series(lowest, found)


# --- the fractions


@dataclass(frozen=True)
class Place:
    """A number of the field: as it is computed with, and in the middle of the parameter's range."""

    exact: object
    middle: object


@dataclass
class Fraction:
    """factor*P/Q over Q, Q(m) or Q(m, z); Q = lead * product of (x - root) * ((x - h)**2 + s), all known."""

    field: object
    above: list
    roots: list
    quadratic: tuple | None
    factor: tuple[list, list]
    domain: tuple[sp.Expr, sp.Expr]
    degrees: tuple[tuple[int, ...], tuple[int, ...]]
    irrational: sp.Expr = sp.S.Zero

    @functools.cached_property
    def below(self) -> list:
        found = [self.field.one]
        for root in self.roots:
            found = times(found, [-root, self.field.one])
        if self.quadratic is not None:
            h, s = self.quadratic
            found = times(found, [h * h + s, -2 * h, self.field.one])
        return found

    def over(self, evaluate: Callable) -> tuple[list, list]:
        """Numerator and denominator with the factor's, each coefficient evaluated."""
        above, below = (times(a, b) for a, b in zip((self.above, self.below), self.factor, strict=True))
        return [evaluate(c) for c in above], [evaluate(c) for c in below]

    @property
    def parts(self) -> tuple[list, list]:
        return self.over(lambda c: c)

    def written(self, number) -> sp.Expr:
        return self.field.to_sympy(self.field.convert(number)).subs(z, self.irrational)

    def polynomial(self, coefficients: list) -> sp.Expr:
        return sp.Add(*(self.written(c) * x**k for k, c in enumerate(coefficients)))

    @property
    def expression(self) -> sp.Expr:
        above, below = self.parts
        return self.polynomial(above) / self.polynomial(below)

    def middle(self, number):
        """The number in the middle of the parameter's range, a rational."""
        if self.field == sp.QQ:
            return sp.QQ.convert(number)
        number = self.field.convert(number)
        values = [sp.QQ.from_sympy(MIDDLE[s]) for s in self.field.symbols]
        return number.numer(*values) / number.denom(*values)

    @functools.cached_property
    def changes(self) -> list[tuple[list, list]]:
        """How the fraction changes with each coefficient, in the middle: fractions again."""
        above, below = ([self.middle(c) for c in part] for part in (self.above, self.below))
        top, bottom = ([self.middle(c) for c in part] for part in self.factor)
        one, nothing = sp.QQ.one, sp.QQ.zero
        found = [([*[nothing] * e, *top], times(below, bottom)) for e in self.degrees[0]]
        squared = times(times(below, below), bottom)
        return found + [([*[nothing] * e, *(-one * c for c in times(above, top))], squared) for e in self.degrees[1]]


# --- conditions, each with the rows of its linearised equations


@dataclass(frozen=True)
class Read:
    """A condition read off a fraction, and how what it asks for changes with the coefficients."""

    condition: rf.AbstractCondition
    rows: list[list[float]]
    words: str


def read_derivative(f: Fraction, at, order: int) -> Read:
    whole = sp.QQ.convert(int(sp.factorial(order)))
    demand = f.written(whole * series(*f.parts, at, order).at(order))
    place = f.written(at)
    condition = rf.Derivative(place, order, demand) if order else rf.Value(place, demand)
    row = [float(series(*change, f.middle(at), order).at(order)) for change in f.changes]
    return Read(condition, [row], "derivative" if order else "value")


def read_limit(f: Fraction, at, further: int, side: int = 1) -> Read | None:
    """The coefficient `further` beyond the first of the series at a place, None for infinity, as a limit."""
    far = at is None
    first = series(*f.parts, at, 0).lowest
    first = min(first, 0) if not far else first
    power = first + further
    found = series(*f.parts, at, power)
    base = 1 / x if far else x - f.written(at)
    minus = sp.Add(*(f.written(found.at(k)) * base**k for k in range(first, power)))
    if minus.has(x) and sp.Poly(sp.expand(sp.fraction(sp.together(minus))[0]), x).is_zero:
        minus = R(0)
    condition = rf.Limit(
        (sp.oo if side > 0 else -sp.oo) if far else f.written(at),
        scale=base**-power,
        minus=minus,
        equals=f.written(found.at(power)),
    )
    middle = None if far else f.middle(at)
    changes = [series(*change, middle, power) for change in f.changes]
    lowest = min(change.lowest for change in changes)
    rows = [[float(change.at(k)) for change in changes] for k in range(lowest, power + 1)]
    return Read(condition, rows, "limit at infinity" if far else "pole" if first < 0 else "limit at a place")


def read_integral(f: Fraction, weight: list, over: tuple[sp.Expr, sp.Expr]) -> Read:
    """The integral of weight*f in closed form, by partial fractions: the poles are known and simple."""
    above, below = f.parts
    assert f.factor[1] == [f.field.one]
    whole, rest = divided(times([f.field.convert(c) for c in weight], above), below)
    antiderivative = _antiderivative(f, whole, rest)
    demand = sp.expand(antiderivative(over[1]) - antiderivative(over[0]))
    whole_domain = over == f.domain
    condition = rf.Integral(f.polynomial(weight), None if whole_domain else over, demand)
    places, measure = _quadrature(over)
    w = measure * _at(weight, places)
    row = [float(np.sum(w * _at(a, places) / _at(b, places))) for a, b in f.changes]
    return Read(condition, [row], "integral")


def _at(polynomial: Sequence, places: np.ndarray) -> np.ndarray:
    return np.polynomial.polynomial.polyval(places, [float(c) for c in polynomial])


def _quadrature(over: tuple[sp.Expr, sp.Expr]) -> tuple[np.ndarray, np.ndarray]:
    t, w = np.polynomial.legendre.leggauss(80)
    low, high = over
    if low == -sp.oo and high == sp.oo:
        return np.tan(np.pi / 2 * t), w * np.pi / 2 / np.cos(np.pi / 2 * t) ** 2
    if high == sp.oo:
        return float(low) + (1 + t) / (1 - t), w * 2 / (1 - t) ** 2
    if low == -sp.oo:
        return float(high) - (1 + t) / (1 - t), w * 2 / (1 - t) ** 2
    low, high = float(low), float(high)
    return (low + high) / 2 + (high - low) / 2 * t, w * (high - low) / 2


def _antiderivative(f: Fraction, whole: list, rest: list) -> Callable[[sp.Expr], sp.Expr]:
    """Of whole + rest/Q. At infinity its logarithms cancel, as they must where the integral is finite."""
    one = f.field.one
    residues, left = [], list(rest)
    for root in f.roots:
        others, _ = divided(f.below, [-root, one])
        residues.append(value(rest, root) / value(others, root))
        left = plus(left, [-residues[-1] * c for c in others])
    for root in f.roots:
        left, _ = divided(left, [-root, one])
    poles = [(f.written(c), f.written(root)) for c, root in zip(residues, f.roots, strict=True)]
    h, s, level, slope = R(0), R(1), R(0), R(0)
    if f.quadratic is not None:
        h, s = (f.written(c) for c in f.quadratic)
        level, slope = (f.written(left[k]) if k < len(left) else R(0) for k in (0, 1))
    turn = (level + slope * h) / sp.sqrt(s)

    def antiderivative(at: sp.Expr) -> sp.Expr:
        if at.is_infinite:
            return turn * sp.pi / 2 * (1 if at is sp.oo else -1)
        polynomial = sp.Add(*(f.written(c) * at ** (k + 1) / (k + 1) for k, c in enumerate(whole)))
        logarithms = [c * sp.log(_positive(at - root)) for c, root in poles]
        return (
            polynomial
            + sp.Add(*logarithms)
            + slope * sp.log((at - h) ** 2 + s) / 2
            + turn * sp.atan((at - h) / sp.sqrt(s))
        )

    return antiderivative


def _positive(e: sp.Expr) -> sp.Expr:
    return e if e.subs(MIDDLE) > 0 else sp.expand(-e)


# A residual of y, y', y'' as a function of x: on series (for what it is) and for people (what is stated).
RESIDUALS: dict[str, Callable] = {
    "y' - 2*y": lambda t, y0, y1, y2: y1 - 2 * y0,
    "y' + y**2": lambda t, y0, y1, y2: y1 + y0 * y0,
    "y'' + y/3": lambda t, y0, y1, y2: y2 + y0 / 3,
    "(1 + x**2)*y' + x*y": lambda t, y0, y1, y2: (1 + t * t) * y1 + t * y0,
    "y'' - y*y'": lambda t, y0, y1, y2: y2 - y0 * y1,
    "y*y'": lambda t, y0, y1, y2: y0 * y1,
    "y'**2 - y": lambda t, y0, y1, y2: y1 * y1 - y0,
}


class Jet:
    """A power series that multiplies, cut at its length."""

    def __init__(self, coefficients: list) -> None:
        self.c = coefficients

    def _with(self, other, combine: Callable) -> Jet:
        other = other.c if isinstance(other, Jet) else [other] + [0] * (len(self.c) - 1)
        return Jet([combine(a, b) for a, b in zip(self.c, other, strict=False)])

    def __add__(self, other) -> Jet:
        return self._with(other, lambda a, b: a + b)

    __radd__ = __add__

    def __sub__(self, other) -> Jet:
        return self._with(other, lambda a, b: a - b)

    def __mul__(self, other) -> Jet:
        if not isinstance(other, Jet):
            return Jet([c * other for c in self.c])
        size = min(len(self.c), len(other.c))
        return Jet([sum((self.c[j] * other.c[k - j] for j in range(k + 1)), 0 * self.c[0]) for k in range(size)])

    __rmul__ = __mul__

    def __truediv__(self, number: int) -> Jet:
        return Jet([c / number for c in self.c])


def _residual_series(name: str, coefficients: list, at, order: int) -> list:
    derivatives = [coefficients]
    for _ in range(2):
        derivatives.append([(k + 1) * c for k, c in enumerate(derivatives[-1][1:])])
    size = order + 1
    t = Jet([at, 1 + 0 * at, *[0 * at] * size][:size])
    return RESIDUALS[name](t, *(Jet(d[:size]) for d in derivatives)).c


def read_equation(f: Fraction, name: str, at, order: int) -> Read:
    """A residual of which the Taylor polynomial at the place is taken away, so that it vanishes there to the order."""
    size = order + 3

    def jet(above, below, place):
        found = series(above, below, place, size)
        return [found.at(k) for k in range(size + 1)]

    base = [f.middle(c) for c in jet(*f.parts, at)]
    changes = [jet(*change, f.middle(at)) for change in f.changes]
    shift = [f.written(c) for c in _residual_series(name, jet(*f.parts, at), at, order)]
    polynomial = sp.expand(sp.Add(*(c * (x - f.written(at)) ** k for k, c in enumerate(shift))))
    stated = RESIDUALS[name](x, y, y.diff(x), y.diff(x, 2)) - polynomial
    rows: list[list[float]] = [[] for _ in range(order + 1)]
    for change in changes:
        # The residuals are of degree 2 at most in y: this difference is twice their derivative along the change.
        plus_, minus = (
            _residual_series(name, [a + sign * b for a, b in zip(base, change, strict=True)], f.middle(at), order)
            for sign in (1, -1)
        )
        for k in range(order + 1):
            rows[k].append(float(plus_[k] - minus[k]) / 2)
    return Read(rf.Equation(stated, f.written(at), order), rows, "equation")


# --- a problem and its answer


@dataclass(frozen=True)
class Recovery:
    """A problem, the fraction that it was made from, and what is asked of the answer.

    `exact`: the system is linear or of the u'/u**p kind, so the answer must be exact. `missing`: conditions fewer than
    coefficients, the answer is a family. `kinds`: the kinds of conditions in words.
    """

    number: int
    recipe: str
    problem: rf.Problem
    original: sp.Expr
    exact: bool
    kinds: frozenset[str]
    missing: int = 0
    tags: frozenset[str] = field(default_factory=frozenset)

    @property
    def parameters(self) -> set[sp.Symbol]:
        return set(self.problem.parameters)

    def __str__(self) -> str:
        form = self.problem.form
        shape = form.expression if isinstance(form, rf.Form) else f"{form.numerator}/{form.denominator}"
        return f"{self.number} {self.recipe} [{shape}] {self.original} on {self.problem.domain}: " + "; ".join(
            map(str, self.problem.conditions)
        )


DOMAINS = {
    "finite": [(R(0), R(1)), (R(-1), R(2)), (R(1, 2), R(3)), (R(-2), R(-1, 2)), (R(-1), R(1))],
    "half": [(R(0), sp.oo), (R(1), sp.oo), (-sp.oo, R(0))],
    "line": [(-sp.oo, sp.oo)],
}


class Draw:
    """The choices for one problem."""

    def __init__(self, number: int, parameter: bool, irrational: sp.Expr | None = None) -> None:
        self.random = random.Random(f"{SEED} {number}")
        self.parameter = parameter
        self.irrational = irrational
        symbols = [m] * parameter + [z] * (irrational is not None)
        self.field = sp.QQ.frac_field(*symbols) if symbols else sp.QQ

    def number(self, e) -> object:
        return self.field.from_sympy(sp.sympify(e))

    def rational(self, most: int = 4) -> sp.Rational:
        return R(self.random.choice([-1, 1]) * self.random.randint(1, most), self.random.choice([1, 1, 1, 2, 3]))

    def coefficient(self) -> sp.Expr:
        """A rational, or one in four times a small polynomial of the parameter."""
        if self.parameter and self.random.random() < 0.4:
            polynomial = self.random.choice([m, 1 + m, m**2, 2 - m / 3, R(1, 2) * m + 1])
            return polynomial * self.random.choice([1, -1, R(1, 2)])
        return self.rational()

    def place(self, domain: tuple[sp.Expr, sp.Expr]) -> sp.Rational:
        low, high = inner(domain)
        return low + (high - low) * R(self.random.randint(0, 12), 12)

    def domain(self, kind: str | None = None) -> tuple[sp.Expr, sp.Expr]:
        kind = kind or self.random.choice(["finite", "finite", "finite", "half", "line"])
        return self.random.choice(DOMAINS[kind])

    def outside(self, domain: tuple[sp.Expr, sp.Expr]) -> sp.Expr | None:
        """A place for a pole off the domain, for every value of the parameter; None on the whole line."""
        low, high = domain
        away = self.random.choice([R(1, 2), R(1), R(4, 3), R(2)])
        if self.parameter and self.random.random() < 0.5:
            away = away + m / self.random.choice([1, 2])
        sides = [e for e in (low, high) if e.is_finite]
        if not sides:
            return None
        side = self.random.choice(sides)
        return side - away if side == low else side + away


def inner(domain: tuple[sp.Expr, sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
    """A finite part of the domain, for nodes."""
    low, high = domain
    if low == -sp.oo:
        return (R(-2), R(2)) if high == sp.oo else (high - 3, high)
    return (low, low + 3) if high == sp.oo else (low, high)


def random_fraction(
    draw: Draw,
    degrees: tuple[int, int],
    domain: tuple[sp.Expr, sp.Expr],
    *,
    parity: str | None = None,
    factor: tuple[list, list] = ([1], [1]),
    pole: sp.Expr | None = None,
    raised: tuple[int, int] = (0, 0),
) -> Fraction:
    """P/Q without common factors and with all poles off the domain but `pole`; the form is larger by `raised`."""
    while True:
        roots, quadratic, left = ([] if pole is None else [pole]), None, degrees[1] - (pole is not None)
        if parity is not None:
            roots = [R(0)] if degrees[1] % 2 else []
            quadratic = (R(0), draw.random.choice([R(1), R(4), R(2), R(1, 4)])) if degrees[1] > 1 else None
            if quadratic and draw.parameter and draw.random.random() < 0.5:
                quadratic = (R(0), 1 + m)
            left = 0
        while left:
            if left >= 2 and quadratic is None and (domain == DOMAINS["line"][0] or draw.random.random() < 0.5):
                s = draw.random.choice([R(1), R(1, 4), R(4), R(2), R(3)])
                s = m**2 if draw.parameter and draw.random.random() < 0.3 else s
                quadratic = (draw.random.choice([R(0), R(1), R(-1), R(1, 2)]), s)
                left -= 2
                continue
            root = draw.outside(domain)
            assert root is not None, "on the whole line a denominator of odd degree has a pole"
            if root not in roots:
                roots.append(root)
                left -= 1
        top = range(degrees[0] + 1)
        odd_above = parity == "odd" and not (degrees[0] % 2 == 0 and degrees[1] % 2)
        odd_below = parity == "odd" and degrees[0] % 2 == 0 and degrees[1] % 2 == 1
        above = [R(0) if parity and k % 2 != odd_above else draw.coefficient() for k in top]
        if parity is None and degrees[0] and draw.random.random() < 0.3:
            above[draw.random.randrange(degrees[0])] = R(0)
        if parity == "even" and degrees[1] % 2:
            raise ValueError("an even fraction has an even denominator here")
        whole = tuple(d + e for d, e in zip(degrees, raised, strict=True))
        form = (
            tuple(k for k in range(whole[0] + 1) if parity is None or k % 2 == odd_above),
            tuple(k for k in range(whole[1] + 1) if parity is None or k % 2 == odd_below),
        )
        found = Fraction(
            draw.field,
            [draw.number(c) for c in above],
            [draw.number(r) for r in roots],
            None if quadratic is None else tuple(draw.number(c) for c in quadratic),
            tuple([draw.number(c) for c in part] for part in factor),
            domain,
            form,
            draw.irrational or R(0),
        )
        if _without_common_factors(found):
            return found


def _without_common_factors(f: Fraction) -> bool:
    """For every value of the parameter: the numerator keeps its sign at the poles."""
    for root in f.roots:
        expression = f.written(value(times(f.above, f.factor[0]), root))
        signs = {sp.sign(expression.subs(m, c)) for c in (R(1, 2), R(3, 4), R(1), R(3, 2), R(2))}
        if len(signs) > 1 or 0 in signs:
            return False
    if f.quadratic is not None:
        h, s = f.quadratic
        _, rest = divided(times(f.above, f.factor[0]), [h * h + s, -2 * h, f.field.one])
        if not any(rest):
            return False
    return any(f.above)


class Collected:
    """Conditions until there are as many independent ones as coefficients."""

    def __init__(self, f: Fraction, wanted: int | None = None) -> None:
        self.f = f
        self.wanted = len(f.changes) - bool(f.degrees[1]) if wanted is None else wanted
        self.reads: list[Read] = []
        self.basis: list[np.ndarray] = []

    @property
    def full(self) -> bool:
        return len(self.basis) >= self.wanted

    def add(self, read: Read | None, anyway: bool = False) -> bool:
        """Takes a condition that says something new, or `anyway` one that does not."""
        if read is None or self.has(read.condition):
            return False
        fresh = list(self.basis)
        for row in read.rows:
            size = np.linalg.norm(row)
            if size == 0:
                continue
            left = np.array(row) / size
            for e in [*fresh, *fresh]:
                left = left - e * (e @ left)
            if np.linalg.norm(left) > INDEPENDENT:
                fresh.append(left / np.linalg.norm(left))
        if len(fresh) > self.wanted or (len(fresh) == len(self.basis) and not anyway):
            return False
        self.basis = fresh
        self.reads.append(read)
        return True

    def has(self, condition: rf.AbstractCondition) -> bool:
        def key(c):
            return (type(c), getattr(c, "at", None), getattr(c, "order", None), getattr(c, "scale", None))

        if isinstance(condition, rf.Integral):
            return any(isinstance(r.condition, rf.Integral) and r.condition == condition for r in self.reads)
        return any(key(r.condition) == key(condition) for r in self.reads)

    @property
    def nodes(self) -> dict[sp.Expr, int]:
        """Places with the number of derivatives stated in full."""
        found: dict[sp.Expr, int] = {}
        for r in self.reads:
            if isinstance(r.condition, (rf.Value, rf.Derivative)):
                found[r.condition.at] = max(found.get(r.condition.at, 0), r.condition.order + 1)
        return found


def fill(collected: Collected, draw: Draw, tries: int = 400) -> None:
    """Values and derivatives, complete from order 0 at each node, until nothing is open."""
    f = collected.f
    for _ in range(tries):
        if collected.full:
            return
        nodes = {at: k for at, k in collected.nodes.items() if k < 4}
        if nodes and draw.random.random() < 0.45:
            at, order = draw.random.choice(sorted(nodes.items(), key=str))
            number = draw.number(at) if not at.has(sp.pi, sp.sqrt(2)) and at.is_number else None
            if number is None:
                continue
            collected.add(read_derivative(f, number, order))
        else:
            collected.add(read_derivative(f, draw.number(free_place(collected, draw)), 0))
    if not collected.full:
        raise NoProblem(f"{len(collected.basis)} of {collected.wanted} conditions found")


class NoProblem(Exception):
    """This draw leads nowhere; draw again."""


def free_place(collected: Collected, draw: Draw) -> sp.Rational:
    """A place in the domain away from the poles, the zeros of the factor, and the places taken."""
    f = collected.f
    for _ in range(200):
        at = draw.place(f.domain)
        number = draw.number(at)
        taken = {getattr(r.condition, "at", None) for r in collected.reads}
        if at not in taken and value(f.parts[1], number) != 0 and value(f.factor[0], number) != 0:
            return at
    raise NoProblem("no free place")


def rational_form(f: Fraction, parity: str | None = None, **stated) -> rf.Rational:
    return rf.Rational(max(f.degrees[0]), max(f.degrees[1]), parity=parity, **stated)


def recovery(
    number: int, recipe: str, collected: Collected, form, *, exact: bool, missing: int = 0, tags: Sequence[str] = ()
) -> Recovery:
    f = collected.f
    problem = rf.Problem(
        conditions=[r.condition for r in collected.reads],
        form=form,
        variable=x,
        domain=f.domain,
        parameters={m: (m.low, m.high)} if m in getattr(f.field, "symbols", ()) else {},
        name=f"{recipe} {number}",
    )
    kinds = frozenset(r.words for r in collected.reads)
    tags = {*tags, "parameter" if problem.parameters else "numbers", domain_kind(f.domain)}
    return Recovery(number, recipe, problem, f.expression, exact, kinds, missing, frozenset(tags))


def domain_kind(domain: tuple[sp.Expr, sp.Expr]) -> str:
    return {0: "finite", 1: "half-infinite", 2: "whole line"}[sum(bool(e.is_infinite) for e in domain)]


def degrees(draw: Draw, domain: tuple[sp.Expr, sp.Expr], most: int = 5, least: int = 0) -> tuple[int, int]:
    """Of numerator and denominator: with a parameter, and on the whole line, fewer."""
    while True:
        above, below = draw.random.randint(0, 4), draw.random.randint(least, 3)
        if above + below > most - draw.parameter or above + below < 1:
            continue
        if domain == DOMAINS["line"][0] and below % 2:
            continue
        return above, below


# --- recipes: each makes one problem


def hermite(draw: Draw, number: int) -> Recovery:
    domain = draw.domain()
    f = random_fraction(draw, degrees(draw, domain, 6), domain)
    found = Collected(f)
    fill(found, draw)
    tags = redundant(found, draw)
    return recovery(number, "hermite", found, rational_form(f), exact=True, tags=tags)


def redundant(found: Collected, draw: Draw) -> list[str]:
    """One condition more, one time in four: it agrees with the others."""
    if draw.random.random() < 0.25:
        found.add(read_derivative(found.f, draw.number(free_place(found, draw)), 0), anyway=True)
        return ["redundant"]
    return []


def irrational(draw: Draw, number: int) -> Recovery:
    domain = draw.domain("finite")
    f = random_fraction(draw, degrees(draw, domain, 3), domain)
    low, _ = domain
    places = [z / 2 if draw.irrational == sp.sqrt(2) else z / 4]
    found = Collected(f)
    at = draw.number(low + places[0])
    found.add(read_derivative(f, at, 0))
    if draw.random.random() < 0.5:
        found.add(read_derivative(f, at, 1))
    fill(found, draw)
    return recovery(number, "irrational", found, rational_form(f), exact=True)


def moving(draw: Draw, number: int) -> Recovery:
    """Nodes that move with the parameter."""
    domain = draw.random.choice([(R(0), R(2)), (R(0), m), (R(0), sp.oo)])
    middle = (R(0), R(2)) if domain[1] == m else domain
    f = random_fraction(draw, degrees(draw, middle, 3), middle)
    f.domain = domain
    found = Collected(f)
    found.add(read_derivative(f, draw.number(m), 0))
    if draw.random.random() < 0.5:
        found.add(read_derivative(f, draw.number(m), 1))
    found.add(read_derivative(f, draw.number(m / 2), 0))
    found.add(read_derivative(f, draw.number(R(0)), 0))
    for order in range(1, 6):
        found.add(read_derivative(f, draw.number(R(0)), order))
    if not found.full:
        raise NoProblem
    return recovery(number, "moving", found, rational_form(f), exact=True)


def parity(draw: Draw, number: int) -> Recovery:
    kind = draw.random.choice(["odd", "even"])
    domain = draw.random.choice([(R(0), R(1)), (R(-1), R(1)), (R(0), sp.oo), (-sp.oo, sp.oo)])
    shapes = {"odd": [(1, 2), (3, 2), (3, 0), (2, 1), (4, 3), (2, 3)], "even": [(2, 2), (4, 2), (0, 2), (4, 0), (2, 0)]}
    shape = draw.random.choice(shapes[kind])
    f = random_fraction(draw, shape, domain, parity=kind)
    found = Collected(f)
    if shape[1] % 2:
        found.add(read_limit(f, draw.number(0), 0))
    elif draw.random.random() < 0.5:
        found.add(read_derivative(f, draw.number(0), 1 if kind == "odd" else 0))
    if draw.random.random() < 0.5:
        found.add(read_limit(f, None, 0))
    fill(found, draw)
    return recovery(number, "parity", found, rational_form(f, kind), exact=True, tags=[kind])


FACTORS = [
    ([0, 1], [1], x), ([1, -1], [1], 1 - x), ([1], [1, 0, 1], 1 / (1 + x**2)),
    ([0, 0, 1], [4, 0, 1], x**2 / (4 + x**2)), ([-1, 0, 1], [1], x**2 - 1), ([0, 1], [9, 0, 0, 0, 1], x / (9 + x**4)),
]  # fmt: skip


def factor(draw: Draw, number: int) -> Recovery:
    domain = draw.domain()
    above, below, written = draw.random.choice(FACTORS)
    f = random_fraction(draw, degrees(draw, domain, 4), domain, factor=(above, below))
    found = Collected(f)
    if draw.random.random() < 0.3:
        found.add(read_limit(f, None, 0))
    fill(found, draw)
    return recovery(number, "factor", found, rational_form(f, factor=written), exact=True, tags=["factor"])


def smooth_factor(draw: Draw, number: int) -> Recovery:
    """A factor that is no fraction: exp, a square root."""
    domain = draw.random.choice([(R(0), R(1)), (R(0), R(2)), (R(0), sp.oo)])
    f = random_fraction(draw, degrees(draw, domain, 3), domain)
    g = draw.random.choice([sp.exp(-x), sp.sqrt(1 + x), sp.exp(-(x**2)), sp.cos(x / 4)])
    found = Collected(f)
    fill(found, draw)
    expression = g * f.expression
    conditions = [
        type(r.condition)(**{"at": r.condition.at} | ({"order": r.condition.order} if r.condition.order else {}),
                          equals=sp.expand(sp.diff(expression, x, r.condition.order).subs(x, r.condition.at)))
        for r in found.reads
    ]  # fmt: skip
    found.reads = [Read(c, r.rows, r.words) for c, r in zip(conditions, found.reads, strict=True)]
    made = recovery(number, "smooth factor", found, rational_form(f, factor=g), exact=True, tags=["factor"])
    return Recovery(number, made.recipe, made.problem, expression, True, made.kinds, 0, made.tags)


def asymptote(draw: Draw, number: int) -> Recovery:
    domain = draw.domain(draw.random.choice(["finite", "half", "line"]))
    f = random_fraction(draw, degrees(draw, domain, 6), domain)
    found = Collected(f)
    further = draw.random.choice([0, 0, 1, 2])
    side = -1 if domain[0] == -sp.oo and draw.random.random() < 0.6 else 1
    found.add(read_limit(f, None, further, side))
    if draw.random.random() < 0.3:
        found.add(read_limit(f, None, further + 1, side))
    fill(found, draw)
    return recovery(number, "asymptote", found, rational_form(f), exact=True, tags=redundant(found, draw))


def residue(draw: Draw, number: int) -> Recovery:
    """A pole on the domain, inside or at an end, of order 1 or 2: asked for by a limit."""
    domain = draw.domain(draw.random.choice(["finite", "half", "line"]))
    low, high = inner(domain)
    pole = draw.random.choice([low, high, (low + high) / 2, (2 * low + high) / 3])
    if draw.parameter and draw.random.random() < 0.4 and domain[1] == sp.oo and domain[0].is_finite:
        pole = low + m
    while True:
        shape = degrees(draw, domain if domain != DOMAINS["line"][0] else (R(0), R(1)), 4, least=1)
        if domain == DOMAINS["line"][0] and shape[1] % 2 == 0:
            continue
        break
    f = random_fraction(draw, shape, domain, pole=pole)
    found = Collected(f)
    found.add(read_limit(f, draw.number(pole), draw.random.choice([0, 0, 0, 1])))
    if draw.random.random() < 0.3:
        found.add(read_limit(f, None, 0))
    fill(found, draw)
    return recovery(number, "residue", found, rational_form(f), exact=True, tags=["pole on the domain"])


def place_limit(draw: Draw, number: int) -> Recovery:
    """Limits that state values and slopes: (f - f(p))/(x - p)."""
    domain = draw.domain()
    f = random_fraction(draw, degrees(draw, domain, 4), domain)
    found = Collected(f)
    at = draw.number(free_place(found, draw))
    found.add(read_limit(f, at, draw.random.choice([0, 1, 1, 2])))
    fill(found, draw)
    return recovery(number, "limit at a place", found, rational_form(f), exact=True)


def weight(draw: Draw, most: int = 2) -> list:
    return [sp.QQ(draw.random.randint(0, 3)) for _ in range(draw.random.randint(0, most))] + [sp.QQ(1)]


def subrange(draw: Draw, domain: tuple[sp.Expr, sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
    low, high = inner(domain)
    choices = [(low, high), (low, (low + high) / 2), ((2 * low + high) / 3, high)]
    return draw.random.choice(choices)


def moments(draw: Draw, number: int) -> Recovery:
    """Integrals of polynomials: linear."""
    domain = draw.domain("finite")
    f = random_fraction(draw, (draw.random.randint(1, 4), 0), domain)
    f.degrees = (f.degrees[0], ())
    found = Collected(f)
    for _ in range(draw.random.randint(1, 3)):
        found.add(read_integral(f, weight(draw), subrange(draw, domain)))
    if draw.random.random() < 0.3:
        found.add(read_derivative(f, draw.number(draw.place(domain)), 2))
    if draw.random.random() < 0.3:
        found.add(read_equation(f, "y' - 2*y", draw.number(draw.place(domain)), 0))
    fill(found, draw)
    form = rf.Rational(max(f.degrees[0]))
    return recovery(number, "moments", found, form, exact=True)


def laguerre(draw: Draw, number: int) -> Recovery:
    """Moments of a polynomial times exp(-x) on the half line: factorials."""
    n = draw.random.randint(1, 3)
    coefficients = [draw.coefficient() for _ in range(n + 1)]
    expression = sp.exp(-x) * sp.Add(*(c * x**k for k, c in enumerate(coefficients)))
    demands = (sp.Add(*(c * sp.factorial(k + j) for k, c in enumerate(coefficients))) for j in range(n))
    problem = rf.Problem(
        conditions=[*(rf.Integral(x**j, None, d) for j, d in enumerate(demands)), rf.Value(0, coefficients[0])],
        form=rf.Rational(n, factor=sp.exp(-x)),
        variable=x,
        domain=(0, sp.oo),
        name=f"moments {number}",
    )
    tags = {"half-infinite", "parameter" if problem.parameters else "numbers", "factor"}
    return Recovery(number, "moments", problem, expression, True, frozenset({"integral", "value"}), 0, frozenset(tags))


def fixed_denominator(draw: Draw, number: int) -> Recovery:
    """A form whose denominator is given: its integrals are linear, logarithms and arcs and all."""
    domain = draw.domain("finite")
    n, below = draw.random.randint(1, 2), draw.random.randint(1, 2)
    f = random_fraction(draw, (n, below), domain)
    f.degrees = (f.degrees[0], ())
    found = Collected(f)
    for _ in range(draw.random.randint(1, 2)):
        found.add(read_integral(f, weight(draw, 1), subrange(draw, domain)))
    fill(found, draw)
    letters = [sp.Symbol(c, real=True) for c in "pqr"[: n + 1]]
    form = rf.Form(sp.Add(*(c * x**k for k, c in enumerate(letters))) / f.polynomial(f.below), tuple(letters))
    return recovery(number, "fixed denominator", found, form, exact=True)


def linear_equation(draw: Draw, number: int) -> Recovery:
    """Differential equations that give the derivatives of a node whose value is stated."""
    domain = draw.domain()
    f = random_fraction(draw, degrees(draw, domain, 5, least=0), domain)
    found = Collected(f)
    name = draw.random.choice(["y' - 2*y", "y' + y**2", "(1 + x**2)*y' + x*y", "y'' + y/3", "y'' - y*y'", "y*y'"])
    at = draw.number(free_place(found, draw))
    if name == "y*y'" and f.middle(value(f.parts[0], at)) == 0:
        raise NoProblem
    found.add(read_derivative(f, at, 0))
    if "''" in name:
        found.add(read_derivative(f, at, 1))
    if not found.add(read_equation(f, name, at, draw.random.choice([0, 0, 1] if draw.parameter else [0, 1, 2, 3]))):
        raise NoProblem
    fill(found, draw)
    return recovery(number, "linear equation", found, rational_form(f), exact=True, tags=redundant(found, draw))


def raised(draw: Draw, number: int) -> Recovery:
    """A form larger than the fraction: with n + m + 1 conditions it is the only answer all the same."""
    domain = draw.domain("finite")
    small = degrees(draw, domain, 3)
    more = draw.random.choice([(1, 0), (0, 1), (1, 1)])
    f = random_fraction(draw, small, domain, raised=more)
    found = Collected(f, wanted=10**6)
    taken: set = set()
    while len(found.reads) < sum(small) + sum(more) + 1:
        at = free_place(found, draw)
        if at not in taken:
            taken.add(at)
            found.reads.append(read_derivative(f, draw.number(at), 0))
            if draw.random.random() < 0.3 and len(found.reads) < sum(small) + sum(more) + 1:
                found.reads.append(read_derivative(f, draw.number(at), 1))
    return recovery(number, "raised", found, rational_form(f), exact=True)


def family(draw: Draw, number: int) -> Recovery:
    """One condition too few."""
    domain = draw.domain()
    f = random_fraction(draw, degrees(draw, domain, 5), domain)
    found = Collected(f)
    found.wanted -= 1
    if draw.random.random() < 0.4:
        found.add(read_limit(f, None, 0))
    fill(found, draw)
    return recovery(number, "family", found, rational_form(f), exact=True, missing=1)


def linear_mix(draw: Draw, number: int) -> Recovery:
    """Values, slopes, limits and equations together."""
    domain = draw.domain()
    pole = None
    if draw.random.random() < 0.4 and domain != DOMAINS["line"][0]:
        pole = inner(domain)[0]
    f = random_fraction(draw, degrees(draw, domain, 5, least=1), domain, pole=pole)
    found = Collected(f)
    if pole is not None:
        found.add(read_limit(f, draw.number(pole), 0))
    found.add(read_limit(f, None, draw.random.choice([0, 1])))
    at = draw.number(free_place(found, draw))
    found.add(read_derivative(f, at, 0))
    found.add(read_equation(f, draw.random.choice(["y' - 2*y", "y' + y**2"]), at, draw.random.choice([0, 1])))
    fill(found, draw)
    return recovery(number, "linear mix", found, rational_form(f), exact=True)


def incomplete(draw: Draw, number: int) -> Recovery:
    """A derivative without those below it."""
    domain = draw.domain("finite" if draw.parameter else None)
    f = random_fraction(draw, degrees(draw, domain, 3 if draw.parameter else 4, least=1), domain)
    found = Collected(f)
    for _ in range(1 if draw.parameter else draw.random.choice([1, 1, 2])):
        at = draw.number(free_place(found, draw))
        orders = draw.random.choice([[1], [1], [2], [0, 2], [1, 2]])
        for order in orders:
            found.add(read_derivative(f, at, order))
    if not any(k > 1 for k in found.nodes.values()) or not found.reads:
        raise NoProblem
    open_nodes = set(found.nodes)
    for _ in range(200):  # values elsewhere: what is missing must stay missing
        if found.full:
            break
        at = free_place(found, draw)
        if at not in open_nodes:
            found.add(read_derivative(f, draw.number(at), 0))
    if not found.full:
        raise NoProblem
    return recovery(number, "incomplete", found, rational_form(f), exact=False)


def transcendental(draw: Draw, number: int) -> Recovery:
    """One or two integrals of a general fraction, the rest linear."""
    domain = draw.random.choice([*DOMAINS["finite"], (R(0), sp.oo), (-sp.oo, sp.oo)])
    while True:
        shape = degrees(draw, domain, 3, least=1)
        if shape != (0, 0) and not (domain == DOMAINS["line"][0] and shape[1] != 2):
            break
    f = random_fraction(draw, shape, domain)
    found = Collected(f)
    for _ in range(1 if draw.parameter else draw.random.choice([1, 1, 2])):
        whole = shape[0] <= shape[1] - 2 and domain_kind(domain) != "finite"
        over = domain if whole else subrange(draw, domain)
        found.add(read_integral(f, [sp.QQ(1)] if whole else weight(draw, 1), over))
    fill(found, draw)
    return recovery(number, "transcendental", found, rational_form(f), exact=False)


def nonlinear_equation(draw: Draw, number: int) -> Recovery:
    """Differential equations at nodes without a value: polynomial in what nobody stated."""
    domain = draw.domain("finite" if draw.parameter else None)
    f = random_fraction(draw, degrees(draw, domain, 3, least=1), domain)
    found = Collected(f)
    name = draw.random.choice(["y' - 2*y", "y' + y**2", "y'**2 - y", "y*y'", "y'' - y*y'"])
    at = free_place(found, draw)
    if not found.add(read_equation(f, name, draw.number(at), draw.random.choice([0, 0, 1]))):
        raise NoProblem
    fill(found, draw)
    return recovery(number, "nonlinear equation", found, rational_form(f), exact=False)


def everything(draw: Draw, number: int) -> Recovery:
    """An integral, a limit, a slope alone or an equation, and values: no two linear in the same way."""
    domain = draw.random.choice([*DOMAINS["finite"], (R(0), sp.oo)])
    f = random_fraction(draw, degrees(draw, domain, 4, least=1), domain)
    found = Collected(f)
    found.add(read_integral(f, weight(draw, 1), subrange(draw, domain)))
    found.add(read_limit(f, None, draw.random.choice([0, 1])))
    at = draw.number(free_place(found, draw))
    extra = draw.random.choice(["slope", "equation", "value and equation"])
    if extra == "slope":
        found.add(read_derivative(f, at, 1))
    else:
        if extra == "value and equation":
            found.add(read_derivative(f, at, 0))
        found.add(read_equation(f, draw.random.choice(["y' - 2*y", "y' + y**2"]), at, 0))
    fill(found, draw)
    return recovery(number, "everything", found, rational_form(f), exact=False)


# u, the power p and v with u' = v * a number: a*v/u**p has the integral a*u**(1 - p)/..., of weight w a*v/(w*u**p).
a, b = sp.symbols("a b", real=True)
POWERS = [
    (a * x / (b * x**2 + 1) ** 2, b * x**2 + 1, 2, 1), (a / (b * x + 1) ** 2, b * x + 1, 2, 1),
    (a / (b * x**2 + 1) ** 2, b * x**2 + 1, 2, x), (a * x / (b * x**2 + 1) ** 3, b * x**2 + 1, 3, 1),
    (a * x**2 / (b * x**3 + 1) ** 2, b * x**3 + 1, 2, 1), (a / (b * x + 1) ** 3, b * x + 1, 3, 1),
    (a * x / (x**2 + b) ** 2, x**2 + b, 2, 1), (x / (b * x**2 + a) ** 2, b * x**2 + a, 2, 1),
]  # fmt: skip


def powers(draw: Draw, number: int) -> Recovery:
    """Forms whose integral is that of u'/u**p: polynomial equations."""
    form, u, p, w = draw.random.choice(POWERS)
    domain = draw.random.choice([(R(0), R(1)), (R(0), R(2)), (R(1, 2), R(3)), (R(0), sp.oo)])

    def size() -> sp.Expr:
        return draw.random.choice([m, 1 + m, m**2 + R(1, 2)]) if draw.parameter else abs(draw.rational())

    values = {a: size(), b: abs(draw.rational()) if draw.random.random() < 0.5 else size()}
    if values[a].is_number and draw.random.random() < 0.3 and form.subs(a, -a) != form and u.subs(a, 0) == u:
        values[a] = -values[a]
    fits = form.subs(values)

    def integral(over: tuple[sp.Expr, sp.Expr]) -> tuple[Callable, sp.Expr]:
        primitive = sp.cancel(w * form * u**p / sp.diff(u, x)) * u ** (1 - p) / (1 - p)
        ends = [R(0) if e.is_infinite else primitive.subs(x, e) for e in over]
        where = None if over == domain else over
        return lambda demand: rf.Integral(sp.sympify(w), where, demand), ends[1] - ends[0]

    def point(order: int, at: sp.Expr) -> tuple[Callable, sp.Expr]:
        stated = (lambda demand: rf.Derivative(at, order, demand)) if order else (lambda demand: rf.Value(at, demand))
        return stated, sp.diff(form, x, order).subs(x, at)

    low, high = inner(domain)
    choices = [
        lambda: point(0, high), lambda: point(0, (low + high) / 2), lambda: point(1, low), lambda: point(1, high),
        lambda: integral((low, (low + high) / 2)),
    ]  # fmt: skip
    read = [integral(domain), draw.random.choice(choices)()]
    middle = {s: v.subs(MIDDLE) for s, v in values.items()}
    jacobian = sp.Matrix([[sp.diff(g, s).subs(middle) for s in (a, b)] for _, g in read])
    if abs(jacobian.det()) < INDEPENDENT:
        raise NoProblem
    conditions = [stated(sp.cancel(general.subs(values))) for stated, general in read]
    problem = rf.Problem(
        conditions=conditions,
        form=rf.Form(form, (a, b)),
        variable=x,
        domain=domain,
        name=f"u'/u**p {number}",
    )
    kinds = {condition.kind for condition in conditions}
    tags = {domain_kind(domain), "parameter" if problem.parameters else "numbers"}
    return Recovery(number, "u'/u**p", problem, fits, True, frozenset(kinds), 0, frozenset(tags))


RECIPES: list[tuple[Callable[[Draw, int], Recovery], int]] = [
    (hermite, 20), (irrational, 6), (moving, 6), (parity, 12), (factor, 10), (smooth_factor, 6), (asymptote, 16),
    (residue, 14), (place_limit, 6), (moments, 10), (laguerre, 4), (fixed_denominator, 8), (linear_equation, 12),
    (raised, 6), (family, 6), (linear_mix, 10), (incomplete, 12), (powers, 14), (transcendental, 12),
    (nonlinear_equation, 6), (everything, 4),
]  # fmt: skip
ALL = [recipe for recipe, count in RECIPES for _ in range(count)]


@functools.cache
def random_problem(number: int) -> Recovery:
    """The problem of that number: the same in every run."""
    recipe = ALL[number]
    first = ALL.index(recipe)
    parameter = recipe is moving or (number - first) % 3 == 2
    constant = [sp.sqrt(2), sp.pi][number % 2] if recipe is irrational else None
    for attempt in range(50):
        with suppress(NoProblem):
            return recipe(Draw(number + 1000 * attempt, parameter and recipe is not irrational, constant), number)
    raise NoProblem(f"{recipe.__name__} {number}: 50 draws lead nowhere")
