"""The polynomial of equal cost: what the fit's operations buy without a division."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from ratfit._fit import Fit
from ratfit.baselines.original import NODES, Original
from ratfit.baselines.peer import Peer, peer, stablest
from ratfit.baselines.written import Polynomial, about, horner, plus, rational, times

MOST = 40
"""The highest degree tried: beyond it the coefficients themselves are lost in float32."""


def polynomial(fit: Fit, original: Original) -> Peer:
    """The least-squares polynomial at Chebyshev's nodes whose Horner form weighs no more than the fit.

    Horner's rule takes a sum and a product for each degree. In the distance from the middle of the domain it takes one
    sum more, which may leave one degree less, and rounds far better: of the two, the one with the smaller error in
    float32 is the peer. None of the fit's kernel conditions is kept.
    """
    weight = fit.cost.weight
    far, near = (min(weight // 2, MOST), min(max(weight - 1, 0) // 2, MOST))
    x, middle = original.variable, original.middle
    known = {
        horner(about(-middle, least_squares(original, far)), x): far,
        horner(least_squares(original, near), x - middle): near,
    }
    formula = stablest(list(known), original)
    degree = known[formula]
    return peer("polynomial", fit, original, formula, f"degree {degree}, least squares at {NODES} Chebyshev nodes")


def least_squares(original: Original, degree: int) -> Polynomial:
    """The least-squares polynomial at the nodes, in the distance from the middle of the domain.

    Chebyshev's polynomials are orthogonal on their nodes, so that each coefficient is a mean.
    """
    low, high = map(rational, original.ends)
    scaled = [Fraction(0), 2 / (high - low)]
    previous, current = [Fraction(1)], scaled
    total = [Fraction(float(np.mean(original.at_nodes)))]
    for k in range(1, degree + 1):
        mean = Fraction(float(2 * np.mean(original.at_nodes * np.cos(k * original.angles))))
        total = plus(total, [mean * c for c in current])
        previous, current = current, plus([2 * c for c in times(scaled, current)], [-c for c in previous])
    return total
