"""Section 4 and 4.1 of schlick1994: kernel conditions, the systems that they give, and the sine as the example."""

from __future__ import annotations

import functools

import sympy as sp

from ratfit._derive import derive
from ratfit._fit import Fit
from ratfit.claims._agreement import AtLeast
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._numbers import integral, midpoints, values
from ratfit.gallery import card

X = sp.Symbol("x", real=True)
A, B, C, D = sp.symbols("a b c d", real=True)

FRACTION = (X**2 + A * X + B) / (C * X + D)
"""Eq. 11."""

TAYLOR_AND_PADE = (sp.exp(X), sp.log(1 + X), sp.atan(X), sp.tanh(X), sp.tan(X / 2), sp.sqrt(1 + X), 1 / (1 + X))


@functools.cache
def derived(name: str, route: str = "auto") -> Fit:
    """The fit of a gallery problem: derived once."""
    return derive(card(name).problem, route=route)


def independent(form: sp.Expr, unknowns: tuple[sp.Symbol, ...]) -> int:
    """How many of the unknowns change a form independently: the rank of its derivatives by them, as functions of x."""
    at = {unknown: sp.Rational(3 + 2 * i, 7 + i) for i, unknown in enumerate(unknowns)}
    places = [sp.Rational(k, 11) for k in range(1, len(unknowns) + 4)]
    slopes = [sp.diff(form, unknown).subs(at) for unknown in unknowns]
    return int(sp.Matrix([[slope.subs(X, place) for slope in slopes] for place in places]).rank())


def condition(order: int, place: sp.Expr, demand: int, known: dict[sp.Symbol, sp.Expr]) -> sp.Expr:
    """A condition on Eq. 11, what is known already put in: the numerator that has to vanish."""
    slope = sp.diff(FRACTION, X, order).subs(X, place).subs(known)
    return sp.expand(sp.numer(sp.together(slope - demand)))


def is_equation(printed: sp.Expr, stated: sp.Expr) -> bool:
    """Whether a printed equation is a condition's: the printed polynomial divides the other, up to a form of c, d."""
    quotient, rest = sp.div(stated, printed, *sorted(printed.free_symbols | {A, C}, key=str))
    return rest == 0 and quotient != 0 and not quotient.has(B)


def is_kept(fit: sp.Expr, order: int, place: sp.Expr, demand: sp.Expr) -> bool:
    """Whether a formula in x has that derivative there."""
    return bool(sp.simplify(sp.diff(fit, X, order).subs(X, place) - demand) == 0)


def roots_of_printed_system() -> int:
    """How many real solutions (a, b, c, d) the four printed equations have, a = 0 left out: there c = d = 0."""
    solutions = sp.solve([A + sp.pi / 2 - C - 2 * A / sp.pi, C * sp.pi**2 + 4 * sp.pi * A + 4 * A**2], [A, C])
    return sum(1 for a, c in solutions if not (a == 0 and c == 0))


def roots_that_keep_the_conditions() -> int:
    return len(derived("eq12", "polynomial").candidates)


def are_unique(*names: str) -> bool:
    """Whether the conditions of each of these equations have one solution that keeps them, and no family."""
    return all(derived(name).status == "unique" for name in names)


def pade_is_better(functions: tuple[sp.Expr, ...] = TAYLOR_AND_PADE) -> float:
    """The share of functions to which, on [0, 1], Pade [2/2] is twice as near as the Taylor polynomial of degree 4."""
    better = [2 * _worst(f, _pade(f)) < _worst(f, _taylor(f)) for f in functions]
    return sum(better) / len(better)


@functools.cache
def _taylor(f: sp.Expr) -> sp.Expr:
    """To degree 4."""
    return sp.series(f, X, 0, 5).removeO()


def growth_of_taylor_error() -> float:
    """How many times its worst error on [0, 1/2] the Taylor polynomial has on [1/2, 1], the least of the functions."""
    return min(_worst(f, _taylor(f), 0.5, 1.0) / _worst(f, _taylor(f), 0.0, 0.5) for f in TAYLOR_AND_PADE)


@functools.cache
def _pade(f: sp.Expr) -> sp.Expr:
    b1, b2 = sp.symbols("b1 b2")
    product = sp.expand(_taylor(f) * (1 + b1 * X + b2 * X**2))
    below = sp.solve([product.coeff(X, 3), product.coeff(X, 4)], [b1, b2], dict=True)[0]
    below = {symbol: below.get(symbol, sp.S.Zero).subs({b1: 0, b2: 0}) for symbol in (b1, b2)}
    above = sum(product.coeff(X, k).subs(below) * X**k for k in range(3))
    return above / (1 + b1 * X + b2 * X**2).subs(below)


def _worst(f: sp.Expr, approximant: sp.Expr, low: float = 0.0, high: float = 1.0) -> float:
    import numpy as np

    at = {X: midpoints(low, high, count=500)}
    return float(np.max(np.abs(values(f, at) - values(approximant, at))))


def totals_from_taylor_data() -> tuple[float, ...]:
    """The integrals over [0, 1] of the densities of exp(-x) and tan(x/2), by Pade [2/2] and by Taylor to degree 4."""
    densities = [f / sp.integrate(f, (X, 0, 1)) for f in (sp.exp(-X), sp.tan(X / 2))]
    return tuple(integral(each(f), X, 0.0, 1.0) for f in densities for each in (_pade, _taylor))


@functools.cache
def cubic() -> sp.Expr:
    """The polynomial with four coefficients that keeps the four conditions of the sine."""
    unknowns = sp.symbols("a0:4")
    formula = sum(a * X**power for power, a in enumerate(unknowns))
    known = sp.solve([sp.diff(formula, X, order).subs(X, at) - demand for order, at, demand in FOUR], unknowns)
    return formula.subs(known)


def mean_of_cubic() -> float:
    """The mean error of that cubic over that of Eq. 12."""
    import numpy as np

    at = {X: midpoints(0, float(QUARTER))}
    own, printed = (np.abs(values(each - sp.sin(X), at)).mean() for each in (cubic(), _printed()))
    return float(own / printed)


def is_cubic_better() -> bool:
    """Whether the cubic keeps the conditions, and has a smaller mean and a smaller greatest error than Eq. 12."""
    high = float(QUARTER)
    kept = all(is_kept(cubic(), order, at, sp.Integer(demand)) for order, at, demand in FOUR)
    sine = sp.sin(X)
    return kept and mean_of_cubic() < 1 and _worst(sine, cubic(), 0.0, high) < _worst(sine, _printed(), 0.0, high)


QUARTER = sp.pi / 2
FOUR = ((0, sp.S.Zero, 0), (1, sp.S.Zero, 1), (0, QUARTER, 1), (1, QUARTER, 0))


def _sine() -> sp.Expr:
    return derived("eq12").chosen


def _printed() -> sp.Expr:
    published = card("eq12").published
    assert published is not None
    return published.subs(card("eq12").problem.variable, X)


CLAIMS = (
    Claim(
        "S-4-pade",
        "Section 4",
        "away from the origin a Pade approximant is usually much more accurate than a polynomial from the same data",
        "usually",
        None,
        readings=(
            Reading(
                "for most of seven functions (exp, log, atan, tanh, tan, root, reciprocal), by the worst error on "
                "[0, 1]: the share of them for which [2/2] has less than half the error of degree 4",
                pade_is_better,
                AtLeast(0.5),
            ),
        ),
        open="usually and much mean no number",
    ),
    Claim(
        "S-4-taylor",
        "Section 4",
        "a Taylor expansion is accurate only near its origin",
        AtLeast(10.0),
        growth_of_taylor_error,
        how="its worst error on [1/2, 1] over that on [0, 1/2], to degree 4: the least of seven functions",
        word="only near",
    ),
    Claim(
        "S-4-integral",
        "Section 4",
        "an approximant from Taylor data does not keep the total 1 of a probability density",
        True,
        lambda: all(abs(each - 1) > 1e-9 for each in totals_from_taylor_data()),
        how="for two densities on [0, 1], with the Pade approximant [2/2] and with the Taylor polynomial of degree 4",
    ),
    Claim(
        "S-11-parameters",
        "Eq. 11",
        "the fraction of degrees 2 and 1 with leading coefficient 1 has four independent coefficients",
        4,
        lambda: independent(FRACTION, (A, B, C, D)),
        how="rank of its derivatives by the coefficients",
    ),
    Claim(
        "S-fn2",
        "footnote 2",
        "(a x + b)/(c x + d) has fewer than four independent coefficients: one can be divided out",
        3,
        lambda: independent((A * X + B) / (C * X + D), (A, B, C, D)),
        how="rank of its derivatives by the coefficients",
    ),
    Claim(
        "S-4.1-conditions",
        "Section 4.1",
        "the sine has the values 0 and 1 and the slopes 1 and 0 at the two ends of [0, pi/2]",
        (True, True, True, True),
        lambda: tuple(is_kept(sp.sin(X), order, at, sp.Integer(demand)) for order, at, demand in FOUR),
        how="symbolic",
    ),
    Claim(
        "S-4.1-system",
        "Section 4.1",
        "the four conditions on Eq. 11 are b = 0, a = d, a + pi/2 = c + 2a/pi and c pi^2 + 4 pi a + 4 a^2 = 0",
        (True, True, True, True),
        lambda: (
            is_equation(B, condition(*FOUR[0], {})),
            is_equation(A - D, condition(*FOUR[1], {B: sp.S.Zero})),
            is_equation(A + QUARTER - C - 2 * A / sp.pi, condition(*FOUR[2], {B: sp.S.Zero, D: A})),
            is_equation(C * sp.pi**2 + 4 * sp.pi * A + 4 * A**2, condition(*FOUR[3], {B: sp.S.Zero, D: A})),
        ),
        how="each printed equation divides the numerator of its condition, the earlier ones put in",
    ),
    Claim(
        "S-4.1-one-solution",
        "Section 4.1",
        "the printed system has one solution",
        1,
        roots_of_printed_system,
        readings=(
            Reading(
                "one that keeps the conditions as stated: the second root of the cleared system, a = -pi/2, is the "
                "fraction that cancels to x, with the slope 1 at pi/2",
                roots_that_keep_the_conditions,
            ),
        ),
    ),
    Claim(
        "S-12",
        "Eq. 12",
        "the fraction that keeps the four conditions is x (u + x)/(u + v x) with u = -pi^2/4 and v = pi + u",
        lambda: card("eq12").published,
        _sine,
        how="derived anew from the conditions",
    ),
    Claim(
        "S-12-keeps",
        "Eq. 12",
        "Eq. 12 keeps the two values and the two slopes of the sine",
        (True, True, True, True),
        lambda: tuple(is_kept(_printed(), order, at, sp.Integer(demand)) for order, at, demand in FOUR),
        how="symbolic",
    ),
    Claim(
        "S-12-fraction",
        "Section 4.1",
        "(implied by its choice) for the four conditions of the sine a fraction is the form to take",
        AtLeast(1.0),
        mean_of_cubic,
        how="mean error of the cubic that keeps them, over that of Eq. 12",
        instead=Reading(
            "the cubic that keeps the same four conditions is nearer to the sine, in the mean and at worst, and has no "
            "division; the found number is its mean error over that of Eq. 12",
            is_cubic_better,
        ),
    ),
    Claim(
        "S-4.1-n-equations",
        "Section 4.1",
        "as many conditions as unknowns determine the approximation, in Eqs. 12, 15, 19 and 21",
        True,
        lambda: are_unique("eq12", "eq15", "eq19", "eq21"),
        readings=(
            Reading(
                "in Eqs. 12, 19 and 21; the four conditions of Eq. 15 leave the exponent open",
                lambda: are_unique("eq12", "eq19", "eq21"),
            ),
        ),
    ),
)
