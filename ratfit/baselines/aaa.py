"""AAA: the rational function that scipy's greedy algorithm finds from values alone."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from fractions import Fraction

import sympy as sp

from ratfit._fit import Fit
from ratfit._parse import RatfitError
from ratfit.baselines.original import NODES, Original
from ratfit.baselines.peer import Peer, degrees, peer, stablest
from ratfit.baselines.written import Polynomial, fraction, plus, times


def aaa(fit: Fit, original: Original) -> Peer:
    """AAA (nakatsukasa2018) of degree [n/n], n the larger of the fit's degrees, from values at Chebyshev's nodes.

    Its barycentric form takes a division for each support point, and there it divides 0 by 0. So it is multiplied out
    exactly, to one quotient of polynomials: in the variable, or in the distance from the middle or an end of the
    domain, whichever has the smallest error in float32. It may have poles on the domain, and keeps none of the fit's
    kernel conditions.

    **Fails** with `RatfitError` where the installed scipy has no AAA, or AAA finds nothing.
    """
    points, values, weights = _barycentric(original, max(1, *degrees(fit)))
    factors = [[-point, Fraction(1)] for point in points]
    above = _combined(factors, [weight * value for weight, value in zip(weights, values, strict=True)])
    below = _combined(factors, weights)
    centres = dict.fromkeys([sp.S.Zero, *original.centres])
    formula = stablest([fraction(above, below, original.variable, centre) for centre in centres], original)
    degree = len(points) - 1
    return peer("aaa", fit, original, formula, f"[{degree}/{degree}] from values at {NODES} Chebyshev nodes")


def _barycentric(original: Original, degree: int) -> tuple[list[Fraction], list[Fraction], list[Fraction]]:
    """Support points, values there and weights."""
    import scipy

    try:
        from scipy.interpolate import AAA
    except ImportError:
        raise RatfitError(
            f"scipy.interpolate.AAA came with scipy 1.15, installed is {scipy.__version__}: pip install 'scipy>=1.15'"
        ) from None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # that so few points do not converge is what is asked for
        found = AAA(original.nodes, original.at_nodes, max_terms=degree + 1)
    points, values, weights = (
        [Fraction(float(number)) for number in numbers]
        for numbers in (found.support_points, found.support_values, found.weights)
    )
    if not any(weights):
        raise RatfitError("AAA found no weights for this function")
    return points, values, weights


def _combined(factors: Sequence[Polynomial], weights: Sequence[Fraction]) -> Polynomial:
    """The sum over the support points of a weight and the factors of all other points."""
    total: Polynomial = [Fraction(0)]
    for k, weight in enumerate(weights):
        product: Polynomial = [weight]
        for j, factor in enumerate(factors):
            if j != k:
                product = times(product, factor)
        total = plus(total, product)
    return total
