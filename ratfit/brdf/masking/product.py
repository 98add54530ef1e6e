"""Seen and lit, from a function of one direction."""

from collections.abc import Callable

from sympy import Expr


def separable(one_sided: Callable[[Expr, Expr], Expr], v: Expr, v_prime: Expr, roughness: Expr) -> Expr:
    """G = G1(v) G1(v'): seen and lit as if the two had nothing to do with each other.

    Arguments: one_sided, a function of this module with the arguments cosine and roughness; the two cosines; roughness.
    Source: schlick1994 Eq. 17; microfacet ("Smith form"); polimi2024 (GGX).
    """
    return one_sided(v, roughness) * one_sided(v_prime, roughness)
