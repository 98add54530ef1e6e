"""Form: the shape of the answer, any expression with named unknowns; Rational and Power as helpers."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from dataclasses import KW_ONLY, dataclass
from typing import ClassVar

import sympy as sp

from ratfit._parse import RatfitError, check_name
from ratfit._target import Parameter, exact

MAX_DEGREE = 60
"""Largest degree of numerator or denominator: exact null spaces beyond it take minutes."""


@dataclass(frozen=True)
class Shape:
    """What a form becomes once the variable is known: factor * numerator/denominator, unknowns still open.

    `numerator` and `denominator` are written in the outer variable. `homogeneous` says that all unknowns may be
    multiplied by one number without changing the fraction. `power` is None, or (base, exponent) of a Power form.
    """

    numerator: sp.Expr
    denominator: sp.Expr
    factor: sp.Expr
    unknowns: tuple[sp.Symbol, ...]
    homogeneous: bool
    power: tuple[sp.Expr, sp.Symbol] | None = None

    @property
    def expression(self) -> sp.Expr:
        return self.factor * self.numerator / self.denominator


@dataclass(frozen=True)
class AbstractForm(ABC):
    """What all forms share.

    `factor` multiplies and is written in the outer variable; `of` is the inner variable that fraction or expression
    are written in; `support` (low, high) is where the fit lives, with the value `outside` elsewhere on the domain.
    """

    _: KW_ONLY
    factor: sp.Expr = sp.S.One
    of: sp.Expr | None = None
    support: tuple[sp.Expr, sp.Expr] | None = None
    outside: sp.Expr = sp.S.Zero

    def __post_init__(self) -> None:
        object.__setattr__(self, "factor", exact(self.factor, "form, factor"))
        object.__setattr__(self, "outside", exact(self.outside, "form, outside"))
        if self.factor == 0:
            raise RatfitError("form: a factor of zero leaves nothing to fit")
        if self.of is not None:
            object.__setattr__(self, "of", exact(self.of, "form, of"))
        if self.support is not None:
            ends = tuple(exact(end, "form, support") for end in self.support)
            if len(ends) != 2:
                raise RatfitError(f"form: support needs two ends, not {len(ends)}")
            object.__setattr__(self, "support", ends)
        self.check()

    @abstractmethod
    def check(self) -> None:
        """Raises RatfitError for arguments that make no sense together."""

    @property
    def written(self) -> sp.Expr | None:
        """The expression that the form itself is written as, where it is."""
        return None

    @property
    def named(self) -> tuple[sp.Symbol, ...]:
        """The unknowns that a person gave names to."""
        return ()

    @property
    def names(self) -> tuple[str, ...]:
        """Every name that it brings into the problem."""
        return tuple(u.name for u in self.named)

    @abstractmethod
    def shape(self, variable: sp.Symbol, taken: Iterable[str]) -> Shape:
        """The form with its variable; its own unknowns get names that are not among those `taken`."""

    def expressions(self) -> tuple[sp.Expr, ...]:
        """Every expression it holds, for the search for undeclared symbols."""
        parts = (self.factor, self.of, *(self.support or ()), self.outside, self.written)
        return tuple(e for e in parts if e is not None)

    def inner(self, variable: sp.Symbol) -> sp.Expr:
        """The inner variable as an expression of the outer one."""
        return variable if self.of is None else self.of


@dataclass(frozen=True)
class Rational(AbstractForm):
    """A fraction of two polynomials of the given degrees in the inner variable.

    `parity`, "odd" or "even", is that of the whole fraction. An odd fraction is an odd polynomial over an even one;
    only where an even numerator degree meets an odd denominator degree, as in [2/1], it is even over odd, which has
    a pole at 0. The scale of numerator against denominator is free, no coefficient is taken to be 1.
    """

    numerator: int
    denominator: int = 0
    _: KW_ONLY
    parity: str | None = None

    def check(self) -> None:
        for name, degree in (("numerator", self.numerator), ("denominator", self.denominator)):
            if isinstance(degree, bool) or not isinstance(degree, int) or not 0 <= degree <= MAX_DEGREE:
                raise RatfitError(
                    f"form: the {name}'s degree must be a whole number from 0 to {MAX_DEGREE}, not {degree!r}"
                )
        if self.parity not in (None, "odd", "even"):
            raise RatfitError(f"form: parity must be odd or even, not {self.parity!r}")
        if self.parity == "odd" and self.numerator == 0 and self.denominator == 0:
            raise RatfitError("form: a constant cannot be odd; raise the numerator's degree")

    def exponents(self) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """The powers of the inner variable that numerator and denominator may hold."""
        above, below = range(self.numerator + 1), range(self.denominator + 1)
        if self.parity is None:
            return tuple(above), tuple(below)
        flipped = self.numerator % 2 == 0 and self.denominator % 2 == 1
        odd_above = self.parity == "odd" and not flipped
        odd_below = self.parity == "odd" and flipped
        return tuple(e for e in above if e % 2 == odd_above), tuple(e for e in below if e % 2 == odd_below)

    def shape(self, variable: sp.Symbol, taken: Iterable[str]) -> Shape:
        """The fraction with its unknown coefficients, named a0, a1, ... and b0, b1, ... unless such names are taken."""
        above, below = self.exponents()
        y = self.inner(variable)
        a, b = (letters_of(letter, taken) for letter in ("a", "b"))
        unknowns_above = tuple(sp.Symbol(f"{a}{e}", real=True) for e in above)
        unknowns_below = tuple(sp.Symbol(f"{b}{e}", real=True) for e in below)
        return Shape(
            numerator=sp.Add(*(u * y**e for u, e in zip(unknowns_above, above, strict=True))),
            denominator=sp.Add(*(u * y**e for u, e in zip(unknowns_below, below, strict=True))),
            factor=self.factor,
            unknowns=unknowns_above + unknowns_below,
            homogeneous=True,
        )


@dataclass(frozen=True)
class Form(AbstractForm):
    """Any expression with named unknowns; in it the problem's variable stands for the inner variable `of`."""

    expression: sp.Expr
    unknowns: tuple[sp.Symbol, ...]

    @property
    def written(self) -> sp.Expr:
        return self.expression

    @property
    def named(self) -> tuple[sp.Symbol, ...]:
        return self.unknowns

    def check(self) -> None:
        object.__setattr__(self, "expression", exact(self.expression, "form, expression"))
        object.__setattr__(self, "unknowns", tuple(self.unknowns))
        if not self.unknowns:
            raise RatfitError("form: an expression needs unknowns, the names of its open coefficients")
        for unknown in self.unknowns:
            if unknown not in self.expression.free_symbols:
                raise RatfitError(f"form: the unknown {unknown} does not occur in the expression {self.expression}")

    def shape(self, variable: sp.Symbol, taken: Iterable[str]) -> Shape:
        numerator, denominator = self.expression.as_numer_denom()
        y = self.inner(variable)
        return Shape(
            numerator=numerator.subs(variable, y),
            denominator=denominator.subs(variable, y),
            factor=self.factor,
            unknowns=self.unknowns,
            homogeneous=False,
        )


@dataclass(frozen=True)
class Power(AbstractForm):
    """A + B*base**exponent with a free real exponent; the base must be a polynomial of degree 1 in the variable.

    `exponent` is the name of the exponent, or a symbol of that name; A and B are found from the conditions.
    """

    base: sp.Expr
    exponent: str | sp.Symbol = "n"
    letters: ClassVar[tuple[str, str]] = ("A", "B")

    @property
    def written(self) -> sp.Expr:
        return self.base

    @property
    def names(self) -> tuple[str, ...]:
        return (self.exponent,)

    def check(self) -> None:
        object.__setattr__(self, "base", exact(self.base, "form, power"))
        object.__setattr__(self, "exponent", _name_of(self.exponent))

    def shape(self, variable: sp.Symbol, taken: Iterable[str]) -> Shape:
        base = self.base.subs(variable, self.inner(variable))
        if not base.is_polynomial(variable) or sp.degree(base, variable) != 1:
            raise RatfitError(
                f"form: the power's base must be of degree 1 in {variable}, as in 1 - {variable}, not {base}"
            )
        names = [letters_of(letter, taken) for letter in self.letters]
        a, b = (sp.Symbol(name, real=True) for name in names)
        n = sp.Symbol(self.exponent, real=True)
        return Shape(a + b * base**n, sp.S.One, self.factor, (a, b, n), homogeneous=False, power=(base, n))


def _name_of(exponent: str | sp.Symbol) -> str:
    if isinstance(exponent, Parameter) or not isinstance(exponent, str | sp.Symbol):
        raise RatfitError(
            f"form, exponent {exponent!r}: it is open here and finds its own range, so give a name such as 'n'; "
            "an exponent that is known stands in Form(A + B*base**exponent, (A, B))"
        )
    return check_name(str(exponent), "form, exponent")


def letters_of(letter: str, taken: Iterable[str]) -> str:
    """The letter, doubled until no name of the problem begins with it: an unknown must not shadow a parameter."""
    while any(name.startswith(letter) for name in taken):
        letter += letter[0]
    return letter
