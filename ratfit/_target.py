"""Target: the exact formula, its variable and its domain; parameters and their ranges."""

from __future__ import annotations

import numbers
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

import mpmath
import sympy as sp

from ratfit._deadline import TimeLimit
from ratfit._parse import FUNCTIONS, RatfitError, check_name, parse_expression

Exact: TypeAlias = sp.Expr | int | float | Fraction | str

INTEGRAL_SECONDS = 5.0
"""How long sympy may look for the closed form of an integral of the target before the person is asked to state it."""

INSIDE = ("1/1000", "1/8", "1/4", "3/8", "1/2", "5/8", "3/4", "7/8", "999/1000")
"""Fractions of a parameter's range at which signs are looked at: near both ends, and between."""

_STAIRS = (sp.floor, sp.ceiling)
_JUMPING = (sp.sign, *_STAIRS, sp.Heaviside, sp.Piecewise)
_KINKED = (*_JUMPING, sp.Abs, sp.Min, sp.Max)


def exact(value: Exact, what: str = "value") -> sp.Expr:
    """Reads a number or an expression exactly: text by the closed grammar, the float 0.1 as 1/10.

    Raises RatfitError for what is neither.
    """
    if isinstance(value, sp.Expr):
        decimals = {number: sp.Rational(str(number)) for number in value.atoms(sp.Float)}
        return value.xreplace(decimals)
    if isinstance(value, str):
        return parse_expression(value, {}, what)
    if isinstance(value, numbers.Rational) and not isinstance(value, bool):
        return sp.Rational(int(value.numerator), int(value.denominator))
    if isinstance(value, numbers.Real) and not isinstance(value, bool):
        return parse_expression(repr(float(value)), {}, what)
    raise RatfitError(f"{what}: {value!r} is not a real number, a text or a sympy expression")


class Parameter(sp.Symbol):
    """A real symbol that stays in the answer, with the closed range [low, high] that its values come from."""

    __slots__ = ("high", "low")
    low: sp.Expr
    high: sp.Expr

    def __new__(cls, name: str, low: sp.Expr, high: sp.Expr) -> Parameter:
        symbol = sp.Symbol.__xnew__(cls, name, real=True, **_sign(low, high))
        symbol.low, symbol.high = low, high
        return symbol

    def __getnewargs_ex__(self):
        return (self.name, self.low, self.high), {}

    def __getstate__(self):
        return None

    def _hashable_content(self):
        # Two parameters of one name and different ranges are different symbols, also in sympy's caches.
        return sp.Symbol._hashable_content(self) + (self.low, self.high)


def _sign(low: sp.Expr, high: sp.Expr) -> dict[str, bool]:
    if low > 0:
        return {"positive": True}
    if low == 0:
        return {"nonnegative": True}
    if high < 0:
        return {"negative": True}
    return {"nonpositive": True} if high == 0 else {}


def parameter(name: str, low: Exact, high: Exact) -> Parameter:
    """A parameter by name with its range, as in `rf.parameter("m", "1/100", "1/2")`.

    Raises RatfitError for a reserved name, a range that is not made of numbers, is empty or is reversed.
    """
    check_name(name, "parameter")
    ends = [exact(low, f"parameter {name}, low"), exact(high, f"parameter {name}, high")]
    if any(end.free_symbols for end in ends):
        raise RatfitError(f"parameter {name}: the range [{ends[0]}, {ends[1]}] must be made of numbers")
    if not ends[0] < ends[1]:
        raise RatfitError(f"parameter {name}: the range [{ends[0]}, {ends[1]}] is empty; write [low, high], low < high")
    return Parameter(name, *ends)


@dataclass(frozen=True)
class Target:
    """The exact function `expression` of `variable` on the closed `domain` (low, high).

    Arguments: `expression` and the two ends are sympy expressions, numbers or text without names; the ends may
    contain parameters. Raises RatfitError for an empty or reversed domain.
    """

    expression: sp.Expr
    variable: sp.Symbol
    domain: tuple[sp.Expr, sp.Expr]

    def __post_init__(self) -> None:
        object.__setattr__(self, "expression", exact(self.expression, "target"))
        object.__setattr__(self, "domain", check_domain(self.domain))

    def derivative(self, at: sp.Expr, order: int) -> sp.Expr:
        """The derivative of that order at a place, the one-sided limit from inside the domain where it needs one.

        Raises RatfitError where it is infinite, does not exist, or is not found.
        """
        if order == 0 and not self.expression.has(*_JUMPING):
            value = self.expression.xreplace({self.variable: at})  # continuous where finite
            if _is_finite(value):
                return value
        low, high = self.domain
        sides = [-1] if at == high else [1] if at == low else [1, -1]
        if len(sides) == 2 and order and self.expression.has(*_KINKED):
            self.derivative(at, order - 1)  # sign(x) has the slope 0 on both sides of 0, and no slope there
        found = [_one_sided(self.expression, self.variable, at, side, order) for side in sides]
        if len(found) == 2 and not _numerically_equal(*found):
            raise RatfitError(
                f"{_derivative_at(order, self.variable, at)} is {found[1]} from the left and {found[0]} from the "
                "right; state it with equals"
            )
        return found[0]

    def limit(self, at: sp.Expr, scale: sp.Expr, minus: sp.Expr) -> sp.Expr:
        """The limit of (target - minus)*scale at a place of the domain, or at oo or -oo, inside it or beyond.

        Raises RatfitError where it is infinite, does not exist, or is not found.
        """
        function, x = (self.expression - minus) * scale, self.variable
        where = f"the limit of {'the target' if function == self.expression else function} at {x} = {at}"
        if at.is_infinite:
            far = function.xreplace({x: (1 if at is sp.oo else -1) / _DISTANCE})
            return _confirmed_limit(far, where)
        low, high = self.domain
        sides = [-1] if at == high else [1] if at == low else [1, -1]
        found = [_confirmed_limit(_moved(function, x, at, side, 0), where) for side in sides]
        if len(found) == 2 and not _numerically_equal(*found):
            raise RatfitError(
                f"{where} is {found[1]} from the left and {found[0]} from the right; state it with equals"
            )
        return found[0]

    def integral(self, weight: sp.Expr, over: tuple[sp.Expr, sp.Expr]) -> sp.Expr:
        """The integral of weight times the target; raises RatfitError when no closed form is found in time."""
        from ratfit._pieces import smooth_pieces

        advice = "; state its value with equals"
        pieces = smooth_pieces(weight * self.expression, self.variable, over)
        with TimeLimit(INTEGRAL_SECONDS) as limit:
            value = sp.Add(*(self._piece(integrand, between) for integrand, between in pieces))
        if limit.passed:
            raise RatfitError(f"no closed form of the target's integral within {INTEGRAL_SECONDS:g} s{advice}")
        if not value.is_finite and (value.is_infinite or value.has(sp.nan, sp.zoo, sp.oo)):
            raise RatfitError("the target's integral diverges; choose a weight or range for which it is finite")
        if value.has(sp.Integral, sp.Piecewise) or not is_written(value):
            about = "" if value.free_symbols or not value.is_number else f", about {sp.N(value, 20)}"
            raise RatfitError(f"no closed form of the target's integral in ratfit's functions{about}{advice}")
        return value

    def _piece(self, integrand: sp.Expr, over: tuple[sp.Expr, sp.Expr]) -> sp.Expr:
        value = sp.integrate(integrand, (self.variable, *over))
        unfinished = value.has(sp.Integral, sp.nan, sp.zoo, sp.oo)
        return value if unfinished else self._confirmed_integral(integrand, over, value)

    def _confirmed_integral(self, integrand: sp.Expr, over: tuple[sp.Expr, sp.Expr], value: sp.Expr) -> sp.Expr:
        """sympy's value, or our own for a fraction, where numbers confirm it; RatfitError otherwise."""
        if is_confirmed_integral(integrand, self.variable, over, value):
            return value
        if integrand.is_rational_function(self.variable):
            from ratfit._rational_integral import rational_integral

            return rational_integral(integrand, self.variable, over)
        raise RatfitError(f"sympy's integral of the target, {value}, is not confirmed by numbers; state it with equals")


def is_written(value: sp.Expr) -> bool:
    """Whether an expression holds functions of ratfit's grammar alone: a Fresnel integral it could not read back."""
    known = tuple(function for function, _ in FUNCTIONS.values() if isinstance(function, type))
    return all(isinstance(call, known) for call in value.atoms(sp.Function))


def is_confirmed_integral(integrand: sp.Expr, x: sp.Symbol, over: tuple[sp.Expr, sp.Expr], value: sp.Expr) -> bool:
    """Whether quadrature agrees with the closed form of an integral, as far as its own error estimate goes.

    sympy's integrals have been wrong: terms with logarithms are lost where a symbol is real.
    """
    symbols = sorted(
        (integrand.free_symbols | value.free_symbols | over[0].free_symbols | over[1].free_symbols) - {x}, key=str
    )
    for values in sample_values(set(symbols), ("2/7", "5/9")):
        function = sp.lambdify(x, integrand.xreplace(values), "mpmath")
        claimed = sp.N(value.xreplace(values), 20)
        ends = [_mpmath_end(end.xreplace(values)) for end in over]
        try:
            with mpmath.workdps(20):
                found, error = mpmath.quad(function, ends, error=True)
        except (ZeroDivisionError, ValueError, TypeError, NameError):
            return claimed.is_real is True  # nothing to hold against it
        if not claimed.is_real or not abs(found - mpmath.mpf(str(claimed))) <= 100 * error + 1e-9 * (1 + abs(found)):
            return False
    return True


def _mpmath_end(end: sp.Expr) -> mpmath.mpf:
    return mpmath.mpf("inf" if end > 0 else "-inf") if end.is_infinite else mpmath.mpf(str(sp.N(end, 25)))


def check_domain(domain: tuple[Exact, Exact]) -> tuple[sp.Expr, sp.Expr]:
    """The two ends as expressions; raises RatfitError unless low < high for every value of the parameters tried."""
    if not isinstance(domain, (tuple, list)) or len(domain) != 2:
        raise RatfitError(f"domain: two ends are needed, low and high, not {domain!r}")
    low, high = exact(domain[0], "domain, low"), exact(domain[1], "domain, high")
    if low.has(sp.I) or high.has(sp.I):
        raise RatfitError(f"domain: [{low}, {high}] must be made of real numbers")
    for values in sample_values(low.free_symbols | high.free_symbols):
        if not low.xreplace(values) < high.xreplace(values):
            raise RatfitError(f"domain: [{low}, {high}] is empty or reversed{at_values(values)}; low must be < high")
    return low, high


def sample_values(symbols: set[sp.Symbol], fractions: tuple[str, ...] = ("0", "3/7", "1")) -> list[dict]:
    """Exact values for the parameters among `symbols`, at the given fractions of their ranges.

    Different parameters are given different fractions (rotated), so that no accidental equality hides a mistake.
    Symbols that are no parameters (unknowns, free coefficients) get small unrelated rationals. An infinite end is
    replaced by a finite one. Always at least one (perhaps empty) mapping.
    """
    ordered = sorted(symbols, key=lambda s: s.name)
    if not ordered:
        return [{}]
    shares = [sp.Rational(f) for f in fractions]
    return [
        {s: _value_at(s, shares[(i + j) % len(shares)], j) for j, s in enumerate(ordered)} for i in range(len(shares))
    ]


def _value_at(symbol: sp.Symbol, share: sp.Rational, place: int) -> sp.Expr:
    if not isinstance(symbol, Parameter):
        return share + sp.Rational(7 + 4 * place, 5 + 2 * place)
    low, high = symbol.low, symbol.high
    if low == -sp.oo:
        low = high - 10 if high != sp.oo else sp.Integer(-5)
    if high == sp.oo:
        high = low + 10
    return low + share * (high - low)


def at_values(values: Mapping[sp.Symbol, sp.Expr]) -> str:
    """The words " at m = 1/100" for a message, or nothing where there is no parameter."""
    return " at " + ", ".join(f"{name} = {value}" for name, value in values.items()) if values else ""


_DISTANCE = sp.Dummy("distance", positive=True)
"""The distance from a place: positive, so that sympy knows sqrt(distance**2) to be the distance."""


def _numerically_equal(a: sp.Expr, b: sp.Expr) -> bool:
    """Whether two numbers agree to 15 digits at a sampled place of their symbols."""
    if a == b:
        return True
    values = sample_values(a.free_symbols | b.free_symbols, ("2/7",))[0]
    left, right = (sp.N(e.xreplace(values), 20) for e in (a, b))
    return bool(abs(left - right) <= sp.Float("1e-15") * (1 + abs(left)))


def _moved(expression: sp.Expr, variable: sp.Symbol, at: sp.Expr, side: int, order: int) -> sp.Expr:
    """The derivative as a function of the distance from `at`, to the one side or the other."""
    # xreplace where subs would do as well: for a symbol they agree, and it asks no assumptions on the way.
    moved = expression.xreplace({variable: sp.expand(at + side * _DISTANCE)})
    steps = {call: sp.Dummy() for call in moved.atoms(*_STAIRS)}  # of which sympy has no derivative
    derivative = sp.diff(moved.xreplace(steps), _DISTANCE, order) * side**order
    return derivative.xreplace({constant: _step_beside(call) for call, constant in steps.items()})


def _step_beside(call: sp.Expr) -> sp.Expr:
    """What a floor or a ceiling is next to the place; the call itself where that depends on a parameter.

    **Fails** with `RatfitError` where it has one value after the other on the way to the place.
    """
    near, nearer = (call.xreplace({_DISTANCE: sp.Rational(1, 10**digits)}) for digits in (20, 40))
    if not near.is_number:
        return call
    if near != nearer:
        raise RatfitError("the target has ever more steps on the way to a place of a condition; state it with equals")
    return near


def _substituted(derivative: sp.Expr) -> sp.Expr | None:
    value = derivative.xreplace({_DISTANCE: sp.S.Zero})
    return value if _is_finite(value) else None


def _is_finite(value: sp.Expr) -> bool:
    return not value.has(sp.nan, sp.zoo, sp.oo, -sp.oo, sp.AccumBounds)


def _one_sided(expression: sp.Expr, variable: sp.Symbol, at: sp.Expr, side: int, order: int) -> sp.Expr:
    derivative = _moved(expression, variable, at, side, order)
    value = _substituted(derivative)
    if value is not None:
        return value
    return _confirmed_limit(derivative, _derivative_at(order, variable, at))


def _derivative_at(order: int, variable: sp.Symbol, at: sp.Expr) -> str:
    what = f"the target's derivative of order {order}" if order else "the target's value"
    return f"{what} at {variable} = {at}"


def _confirmed_limit(function: sp.Expr, where: str) -> sp.Expr:
    """The limit of a function of the distance as that vanishes, confirmed by numbers."""
    try:
        value = sp.limit(function, _DISTANCE, 0, "+")
    except (NotImplementedError, ValueError, RecursionError):
        raise RatfitError(f"{where} is not found; state it with equals") from None
    if value.has(sp.AccumBounds):
        raise RatfitError(f"{where} does not exist; state another condition there")
    if value.is_infinite or not _is_finite(value) or value.has(sp.Limit):
        raise RatfitError(f"{where} is not finite; state another condition there")
    _check_limit(function, value, where)
    return value


def _check_limit(derivative: sp.Expr, value: sp.Expr, where: str) -> None:
    """sympy's limits have been wrong before: the function a little way inside must lie close to what it found."""
    for values in sample_values(value.free_symbols | derivative.free_symbols - {_DISTANCE}, ("2/7",)):
        near, far = (
            sp.N(derivative.xreplace({**values, _DISTANCE: step}), 30, maxn=200)
            for step in (sp.Rational(1, 10**12), sp.Rational(1, 10**6))
        )
        claimed = sp.N(value.xreplace(values), 30)
        if not (near.is_number and abs(near - claimed) <= mpmath.mpf("1e-3") * (1 + abs(claimed)) + abs(far - claimed)):
            raise RatfitError(f"{where}: the limit {value} is not confirmed numerically{at_values(values)}; use equals")
