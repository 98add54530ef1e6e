"""Section 5.1 of schlick1994: the weights of Eq. 33, what Eqs. 22 and 25 come to, and how many models there are."""

from __future__ import annotations

import sympy as sp

from ratfit.brdf import fresnel
from ratfit.claims._agreement import Above
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._models import V_PRIME, T, U, V, W, named
from ratfit.claims.schlick_model import C_SECOND, C, R

HALF = sp.Rational(1, 2)

ROUGHNESSES = tuple(sp.Rational(k, 20) for k in range(21))

SMOOTH, ROUGH = (
    sp.Tuple(0, 4 * R * (1 - R), 1 - 4 * R * (1 - R)),
    sp.Tuple(1 - 4 * R * (1 - R), 4 * R * (1 - R), 0),
)
"""a, b and c of Eq. 33 for r below 1/2, and from there on."""


def weights(r: sp.Expr) -> tuple[sp.Expr, ...]:
    """a, b and c of Eq. 33."""
    return tuple((SMOOTH if r < HALF else ROUGH).subs(R, r))


def degree_of_weights() -> int:
    """The greatest degree of the weights in r."""
    return max(int(sp.degree(each, R)) for rule in (SMOOTH, ROUGH) for each in rule if each != 0)


def variants(*, of_eq_32: bool) -> int:
    """How many reflectances the spectral and the directional factors make; of Eq. 32 with both its B, or with one."""
    from ratfit.models.schlick import DIRECTIONAL, SPECTRAL, schlick

    chosen = [name for name in DIRECTIONAL if of_eq_32 or name != "continuum-of-facets"]
    return len({schlick(spectral, directional).reflectance for spectral in SPECTRAL for directional in chosen})


def growth() -> sp.Expr:
    """How many times its value at v = v' = 1 Eq. 25 has at v = v' = 1/4, both mirror directions, for any Z and A."""
    zenith, azimuth = sp.Function("Z", positive=True)(T), sp.Function("A", positive=True)(W)
    eq_25 = zenith * azimuth / (4 * sp.pi * V * V_PRIME)
    return sp.simplify(eq_25.subs({V: HALF**2, V_PRIME: HALF**2}) / eq_25.subs({V: 1, V_PRIME: 1}))


def shares(spectral: sp.Expr, second: sp.Expr) -> str:
    """Whether the shares S and (1 - S) S' of the two layers of Eq. 22 depend on the angle of incidence."""
    depend = {each.has(U) for each in (spectral, (1 - spectral) * second)}
    return {(False,): "constant", (True,): "varying"}.get(tuple(depend), "mixed")


CLAIMS = (
    Claim(
        "S-5-parameters",
        "Section 5",
        "a SINGLE material has three parameters, C, r and p, a DOUBLE one two such sets",
        (3, 6),
        lambda: (len(named("schlick").parameters), len(named("schlick-double").parameters)),
        how="the number of the parameters of the two models",
    ),
    Claim(
        "S-22-weights",
        "Section 5.2",
        "with Eq. 23 the two layers have constant weights, with Eq. 24 they change with the angle of incidence",
        ("constant", "varying"),
        lambda: (shares(C, C_SECOND), shares(fresnel.schlick(U, C), fresnel.schlick(U, C_SECOND))),
        how="whether S and (1 - S) S' depend on u, for both",
    ),
    Claim(
        "S-25-lambert",
        "Section 5.1",
        "no facets make Eq. 25 Lambert's model, even with constant Z, because of v v' in its denominator",
        Above(1.0),
        growth,
        how="its value at v = v' = 1/4 over that at v = v' = 1, between mirror directions, so t = 1, for any Z and A; "
        "a constant would give 1",
    ),
    Claim(
        "S-33-sum",
        "Eqs. 32, 33",
        "the weights a, b and c add up to 1 and are none below 0",
        (True, True),
        lambda: (
            all(sum(weights(r)) == 1 for r in ROUGHNESSES),
            all(min(weights(r)) >= 0 for r in ROUGHNESSES),
        ),
        how="exact, for r from 0 to 1 in steps of 1/20",
    ),
    Claim(
        "S-33-ends",
        "Eq. 33",
        "r = 0 is a mirror, r = 1 Lambert's model: the weights (a, b, c) there",
        (0, 0, 1, 1, 0, 0),
        lambda: (*weights(sp.S.Zero), *weights(sp.S.One)),
        how="exact",
    ),
    Claim(
        "S-33-continuous",
        "Eq. 33",
        "the three behaviours go over into one another: at r = 1/2 both rules give the microfacets alone",
        (0, 1, 0, 0, 1, 0),
        lambda: tuple(sp.limit(each, R, HALF) for rule in (SMOOTH, ROUGH) for each in rule),
        how="the limits (a, b, c) of both rules",
    ),
    Claim(
        "S-33-quadratic",
        "Eq. 33",
        "the weights are quadratic in the roughness",
        2,
        degree_of_weights,
        how="their degree in r",
    ),
    Claim(
        "S-5-six",
        "Section 5.1",
        "Eqs. 23, 24, 25, 30 and 32 combine to six models",
        6,
        lambda: variants(of_eq_32=True),
        how="different reflectances of two spectral factors with Eqs. 25 and 30, alone and inside Eq. 32",
        readings=(Reading("with Eq. 32 counted once, whichever B stands in it", lambda: variants(of_eq_32=False)),),
    ),
)
