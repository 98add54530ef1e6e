"""Curve: a target and its derivatives as numbers, at the middle of the ranges of its parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import product
from typing import Any

import mpmath
import sympy as sp

from ratfit._multiprecise import endpoint, multiprecise
from ratfit._parse import RatfitError
from ratfit._target import Target, at_values, sample_values

DIGITS = 50
"""Digits of every number that a fact states or is confirmed with."""

FINE = 8 * DIGITS
"""Digits of work on the way to a place: at 10**-40 from it 1/x**4 alone takes away 160."""

SHOWN = 30
"""Digits of a number that is found by numbers alone and printed."""

POINTS = 800
"""Places of the scan inside the domain; closer to a finite end others follow at a tenth of the distance each."""

# A fraction of a step: no grid of ours falls on the round numbers at which zeros and poles like to lie.
OFFSET = mpmath.mpf("0.3819660112501051518")

Number = Callable[[mpmath.mpf], "mpmath.mpf | None"]

_STEPS = (sp.sign, sp.floor, sp.ceiling, sp.Heaviside)


def differentiated(expression: sp.Expr, x: sp.Symbol, order: int) -> sp.Expr:
    """The derivative away from jumps: that of a step function is zero there, and no DiracDelta is left over."""
    for _ in range(order):
        steps = {atom: sp.Dummy() for atom in expression.atoms(*_STEPS)}
        expression = sp.diff(expression.xreplace(steps), x)
        back = {dummy: atom for atom, dummy in steps.items()}
        while expression.free_symbols & set(back):
            expression = expression.xreplace(back)
    return expression


def _bounded_exp(power: mpmath.mpf) -> mpmath.mpf:
    """exp, but not of what an exp far out has made: mpmath would fill the memory with its digits."""
    if mpmath.mag(power) < 300:
        return mpmath.exp(power)
    if mpmath.re(power) > 0:
        raise OverflowError("exp of a number beyond 10**90")
    return mpmath.mpf(0)


def numbers_of(expression: sp.Expr, x: sp.Symbol) -> Number:
    """The expression as a function of x at mpmath's working precision; None where it is no finite real number."""
    function = sp.lambdify([x], expression, [{"exp": _bounded_exp}, "mpmath"], cse=True)

    def number(place: mpmath.mpf) -> mpmath.mpf | None:
        try:
            value = mpmath.mpmathify(function(place))
        except (ArithmeticError, ValueError, TypeError, NameError, mpmath.libmp.NoConvergence):
            return None
        if isinstance(value, mpmath.mpc):
            if abs(value.imag) > abs(value.real) * mpmath.mpf(10) ** (5 - mpmath.mp.dps):
                return None
            value = value.real
        return value if mpmath.isfinite(value) else None

    return number


@dataclass(frozen=True)
class Curve:
    """A target at the values that its parameters have in the middle of their ranges."""

    target: Target

    @property
    def x(self) -> sp.Symbol:
        return self.target.variable

    @cached_property
    def parameters(self) -> list[sp.Symbol]:
        """The target's parameters, by name."""
        low, high = self.target.domain
        symbols = self.target.expression.free_symbols | low.free_symbols | high.free_symbols
        return sorted(symbols - {self.x}, key=lambda s: s.name)

    @cached_property
    def middle(self) -> dict[sp.Symbol, sp.Expr]:
        """The values of the parameters at which numbers are taken."""
        return sample_values(set(self.parameters), ("1/2",))[0]

    @property
    def label(self) -> str:
        """The words " at m = 51/200" that belong to a number of a target with parameters."""
        return at_values(self.middle)

    def samples(self) -> list[dict[sp.Symbol, sp.Expr]]:
        """Values of the parameters inside their ranges."""
        return sample_values(set(self.parameters), ("1/2", "1/9", "8/9"))

    def all_samples(self) -> list[dict[sp.Symbol, sp.Expr]]:
        """The same and the ends of the ranges, where exceptions like to lie: the slope of t**n at n = 1."""
        return (
            self.samples()
            + [
                dict(zip(self.parameters, ends, strict=True))
                for ends in product(*((getattr(s, "low", 0), getattr(s, "high", 1)) for s in self.parameters))
                if all(sp.S(end).is_finite for end in ends)
            ][:4]
        )

    def expression(self, order: int) -> sp.Expr:
        """The derivative of that order, with the parameters as symbols."""
        return _derived(self.target.expression, self.x, order)

    def number(self, order: int) -> Number:
        """The derivative of that order as a function of numbers."""
        return _numbers(self.expression(order).xreplace(self.middle), self.x)

    @cached_property
    def ends(self) -> tuple[mpmath.mpf, mpmath.mpf]:
        """The ends of the domain as numbers."""
        with mpmath.workdps(FINE):
            low, high = (endpoint(end.xreplace(self.middle)) for end in self.target.domain)
            return low, high

    @cached_property
    def nodes(self) -> tuple[mpmath.mpf, ...]:
        """The places of the scan, in order."""
        low, high = self.ends
        with mpmath.workdps(DIGITS):
            inner = [(k + OFFSET) / POINTS for k in range(POINTS)]
            close = [OFFSET * mpmath.mpf(10) ** -k for k in range(4, 10)]
            shares = sorted([*close, *inner, *(1 - share for share in close)])
            return tuple(_placed(share, low, high) for share in shares)


@lru_cache(maxsize=50)
def _derived(expression: sp.Expr, x: sp.Symbol, order: int) -> sp.Expr:
    return differentiated(expression, x, order)


@lru_cache(maxsize=50)
def _numbers(expression: sp.Expr, x: sp.Symbol) -> Number:
    return numbers_of(expression, x)


def _placed(share: mpmath.mpf, low: mpmath.mpf, high: mpmath.mpf) -> mpmath.mpf:
    """The place at a share of the domain; an infinite end is drawn near by t/(1 - t)."""
    if mpmath.isinf(low) and mpmath.isinf(high):
        return (2 * share - 1) / (share * (1 - share))
    if mpmath.isinf(high):
        return low + share / (1 - share)
    if mpmath.isinf(low):
        return high - (1 - share) / share
    return low + share * (high - low)


def exponent_of(number: Number, place: mpmath.mpf, side: int) -> mpmath.mpf | None:
    """The exponent p of |number| ~ C*distance**p on the way to a place; None where it follows no power.

    At an infinite place the distance is that from 0, so that x**2 has the exponent 2 there.
    """
    far = mpmath.isinf(place)
    with mpmath.workdps(FINE):
        steps = [mpmath.mpf(10) ** (k if far else -k) for k in (10, 20, 30)]
        values: list[Any] = [number(side * step if far else place + side * step) for step in steps]
        if any(value is None or value == 0 for value in values):
            return None
        first, second = (
            mpmath.log(abs(values[k + 1] / values[k])) / mpmath.log(steps[k + 1] / steps[k]) for k in (0, 1)
        )
        return second if abs(first - second) < mpmath.mpf("1e-6") * (1 + abs(second)) else None


def growth(number: Number, place: mpmath.mpf, side: int) -> sp.Rational | None:
    """The same exponent as a fraction, None where it is no simple one."""
    exponent = exponent_of(number, place, side)
    return None if exponent is None else simple_fraction(exponent, 6, mpmath.mpf("1e-6"))


def simple_fraction(number: mpmath.mpf, largest: int, tolerance: mpmath.mpf) -> sp.Rational | None:
    """The fraction with a denominator up to `largest` that lies within the tolerance."""
    if abs(number) > 10**6:
        return None
    for below in range(1, largest + 1):
        above = int(mpmath.nint(number * below))
        if abs(number - mpmath.mpf(above) / below) <= tolerance:
            return sp.Rational(above, below)
    return None


def tends_to(number: Number, place: mpmath.mpf, side: int, value: mpmath.mpf) -> bool:
    """Whether numbers at 400 digits come ever nearer to a value on the way to a place."""
    far = mpmath.isinf(place)
    with mpmath.workdps(FINE):
        steps = [mpmath.mpf(10) ** (k if far else -k) for k in (8, 40)]
        found = [number(side * step if far else place + side * step) for step in steps]
        if found[1] is None:
            return False
        off = abs(found[1] - value)
        if off <= mpmath.mpf("1e-12") * (1 + abs(value)):
            return True
        return found[0] is not None and off < 0.5 * abs(found[0] - value)


def agrees(curve: Curve, expression: sp.Expr, place: sp.Expr, side: int, value: sp.Expr) -> bool:
    """Whether an expression tends to a value at a place by numbers, for three values of each parameter."""
    for values in curve.samples():
        number = numbers_of(expression.xreplace(values), curve.x)
        with mpmath.workdps(FINE):
            try:
                at, claimed = endpoint(place.xreplace(values)), multiprecise(value.xreplace(values))
            except RatfitError:  # it is no real number there
                return False
            if not tends_to(number, abs(at) if mpmath.isinf(at) else at, side, claimed):
                return False
    return True


def shown(number: mpmath.mpf, digits: int = 12) -> str:
    """A number for a text: a whole one without its point."""
    return "0" if number == 0 else mpmath.nstr(number, digits).removesuffix(".0")


def decimal(number: mpmath.mpf, digits: int = SHOWN) -> sp.Rational:
    """A number rounded to so many digits, as the exact fraction that its text stands for."""
    with mpmath.workdps(digits + 10):
        return sp.Rational(mpmath.nstr(number, digits, strip_zeros=True))
