"""What the facets of `conserving` do not reflect, from below, and what a layer without a colour of its own reflects.

Facets with a masking that knows no azimuth reflect less along their scratches than across. For a view of cosine v whose
component along the tangent is x, they leave at least `across(v) + x^2 along(v)` of the light, r/(r + ENDS) times what
is computed here. The coefficients come from linear programmes: `python -m ratfit.models.conserving_fit` prints them.
"""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

ENDS = sp.Rational(1, 10)
"""What is hidden is r/(r + ENDS) times `across` and `along`."""

STEEPNESS = 20
"""`sheen` falls as 1/(1 + STEEPNESS alpha)."""

Powers = tuple[int, int, int]


def _exact(decimals: Mapping[Powers, str]) -> Mapping[Powers, sp.Rational]:
    return {powers: sp.Rational(number) for powers, number in decimals.items()}


ACROSS = _exact({
    (0, 0, 0): "0.03653", (0, 0, 1): "-0.02045", (0, 1, 0): "-0.09755", (0, 1, 1): "-0.02228",
    (0, 2, 0): "0.52635", (0, 2, 1): "-0.04437", (1, 0, 0): "1.68190", (1, 0, 1): "-0.27478",
    (1, 1, 0): "-3.60308", (1, 1, 1): "1.15845", (1, 2, 0): "2.53867", (1, 2, 1): "-0.33136",
    (2, 0, 0): "-1.62635", (2, 0, 1): "0.26348", (2, 1, 0): "4.53579", (2, 1, 1): "-1.33413",
    (2, 2, 0): "-2.36884", (2, 2, 1): "0.50432",
})  # fmt: skip
"""Of v^i alpha^j p^k, with alpha = sqrt(r)."""

ALONG = _exact({
    (0, 0, 0): "0.03719", (0, 1, 0): "0.08752", (0, 2, 0): "0.50970", (1, 0, 0): "0.28431",
    (1, 1, 0): "1.27564", (1, 2, 0): "-1.12431", (2, 0, 0): "-0.33149", (2, 1, 0): "-0.36117",
    (2, 2, 0): "0.30420",
})  # fmt: skip
"""The same."""

SHEEN = _exact({
    (0, 0, 0): "0.12818", (0, 1, 0): "-0.08062", (3, 0, 0): "0.83167", (3, 1, 0): "-0.27957",
})  # fmt: skip
"""Of (1 - v)^i alpha^j; k is 0."""


def across(v: sp.Expr, alpha: sp.Expr, p: sp.Expr) -> sp.Expr:
    """What is left of light that comes across the scratches: a polynomial over v + r."""
    return _polynomial(ACROSS, alpha, p, [v**n for n in range(3)]) / (v + alpha**2)


def along(v: sp.Expr, alpha: sp.Expr) -> sp.Expr:
    """How much more is left where x = 1, over 1 - p: for p = 1 all azimuths are alike."""
    return _polynomial(ALONG, alpha, sp.S.One, [v**n for n in range(3)]) / (v + alpha**2)


def across_mean(alpha: sp.Expr, p: sp.Expr) -> sp.Expr:
    """The mean of `across` over the hemisphere, weighted by the cosine."""
    return 2 * _polynomial(ACROSS, alpha, p, _moments(alpha**2)[1:4])


def along_mean(alpha: sp.Expr) -> sp.Expr:
    """That of `along`."""
    return 2 * _polynomial(ALONG, alpha, sp.S.One, _moments(alpha**2)[1:4])


def along_mean_of_square(alpha: sp.Expr) -> sp.Expr:
    """That of x^2 `along`."""
    moments = _moments(alpha**2)
    squares = [moments[n] - moments[n + 2] for n in (1, 2, 3)]  # x^2 is (1 - v^2)/2 in the mean of all azimuths
    return _polynomial(ALONG, alpha, sp.S.One, squares)


def sheen(v: sp.Expr, alpha: sp.Expr) -> sp.Expr:
    """No less than what diffuser and facets of S(u) = (1 - u)^5 reflect, by their weights, over the sum of these."""
    return _polynomial(SHEEN, alpha, sp.S.One, [(1 - v) ** n for n in range(4)]) / (1 + STEEPNESS * alpha)


def _moments(r: sp.Expr) -> list[sp.Expr]:
    """The integrals of v^n/(v + r) over [0, 1]."""
    moments = [sp.log((1 + r) / r)]
    for n in range(1, 6):
        moments.append(sp.Rational(1, n) - r * moments[-1])
    return moments


def _polynomial(coefficients: Mapping[Powers, sp.Expr], alpha: sp.Expr, p: sp.Expr, of_v: list[sp.Expr]) -> sp.Expr:
    """The sum of coefficients times of_v[i] alpha^j p^k."""
    rows = [sum(c * alpha**j * p**k for (i, j, k), c in coefficients.items() if i == n) for n in range(len(of_v))]
    return sp.Add(*(row * power for row, power in zip(rows, of_v, strict=True)))
