"""Masking on a GGX surface."""

from sympy import Expr, Min, Or, Piecewise, oo, sqrt

from ratfit.brdf._arguments import FROM_ZERO, takes
from ratfit.brdf._limits import instead
from ratfit.brdf.masking._cosines import above, both_above, held


@takes(alpha=FROM_ZERO)
def ggx_lambda(v: Expr, alpha: Expr) -> Expr:
    """Lambda of GGX: (sqrt(1 + 1/a**2) - 1)/2, written without the difference.

    Arguments: v in [-1, 1], alpha GGX's roughness.
    Limits: infinite for v <= 0, 0 from v = 1 on.
    Source: heitz2014 Eq. 72.
    """
    p, excess, root = _parts(v, alpha)
    return Piecewise((oo, v <= 0), (excess / (2 * p * (p + root)), True))


@takes(alpha=FROM_ZERO)
def ggx(v: Expr, alpha: Expr) -> Expr:
    """G1 of GGX: 2/(1 + sqrt(1 + alpha**2 tan(theta)**2)).

    Arguments: v in [-1, 1], alpha GGX's roughness.
    Source: walter2007 Eq. 34; microfacet and polimi2024 print this one function in two ways, see `ggx_as_printed`.
    """
    p, _, root = _parts(v, alpha)
    return above(v, 2 * p / (p + root))


@takes(alpha=FROM_ZERO)
def ggx_as_printed(v: Expr, alpha: Expr) -> Expr:
    """The same without the condition on v: as large below the horizon as above, and without a value at v = 0.

    Source: polimi2024 (g_GGX); microfacet's, with tan(theta) = sqrt(1 - v**2)/v put in, is this one.
    """
    return 2 / (1 + sqrt(1 + alpha**2 * (1 - v**2) / v**2))


@takes(alpha=FROM_ZERO)
def ggx_correlated(v: Expr, v_prime: Expr, alpha: Expr) -> Expr:
    """G of GGX, seen and lit at the same height: 1/(1 + Lambda(v) + Lambda(v')).

    Arguments: v, v_prime in [-1, 1], alpha GGX's roughness.
    Source: heitz2014 Eqs. 72 and 99.
    """
    p, _, root = _parts(v, alpha)
    q, _, root_prime = _parts(v_prime, alpha)
    return both_above(v, v_prime, 2 / (root / p + root_prime / q))


def _parts(v: Expr, alpha: Expr) -> tuple[Expr, Expr, Expr]:
    """v, alpha**2 (1 - v**2) and sqrt(v**2 + alpha**2 (1 - v**2)), by powers of the greater one of v and alpha.

    So no square underflows that matters: without it GGX at alpha = 0 would be 2 instead of 1 for very small v. The
    minima with 1 change nothing: sympy would write the square of a quotient as a quotient of squares.
    """
    cosine, smooth = held(v), Or(v <= 0, alpha <= v)
    p = Min(1, Piecewise((1, smooth), (cosine / instead(alpha, 1, smooth), True)))
    q = Min(1, Piecewise((alpha / cosine, smooth), (1, True)))
    excess = q**2 * (1 - cosine) * (1 + cosine)
    return p, excess, sqrt(p**2 + excess)
