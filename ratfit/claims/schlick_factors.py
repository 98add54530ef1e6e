"""Section 5.1 of schlick1994: the factors Z and A of its model, and what r and p mean."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy as sp

from ratfit.brdf import roughness
from ratfit.claims._agreement import ZERO, Rounded, same
from ratfit.claims._claim import Claim, Reading
from ratfit.claims._models import T, W
from ratfit.claims._numbers import integral, values
from ratfit.claims.schlick_model import A_PRINTED, PHI, A, M, P, R, Z, is_share_of_ward, mean_azimuth, of_ward


def share_within(factor: sp.Expr, p: float, degrees: float) -> float:
    """The part of the azimuths' total 1 that a factor has within some degrees of the direction across."""
    low = float(sp.pi / 2) * (1 - degrees / 90)
    return integral(factor.subs(W, sp.cos(PHI)), PHI, low, float(sp.pi / 2), {P: p}) * 2 / float(sp.pi)


def zenith_total(r: float, high: float = 1.0) -> float:
    return integral(2 * T * Z, T, 0.0, high, {R: r})


def total_of_product(zenith: sp.Expr, azimuth: sp.Expr) -> sp.Expr | None:
    """The integral of Eq. 5 for a product of factors, over both angles; None where they break Eq. 26."""
    alpha = sp.Symbol("alpha", positive=True)
    facing = zenith.subs(T, sp.cos(alpha)) * sp.cos(alpha) * sp.sin(alpha)
    around = azimuth.subs(W, sp.cos(PHI))
    if (
        sp.integrate(facing, (alpha, 0, sp.pi / 2)) != sp.S.Half
        or sp.integrate(around, (PHI, 0, 2 * sp.pi)) != 2 * sp.pi
    ):
        return None
    inner = sp.integrate(sp.expand(facing * around), (PHI, 0, 2 * sp.pi))
    return sp.simplify(sp.integrate(inner, (alpha, 0, sp.pi / 2)))


def off_conic(radius: Callable[[Any], Any]) -> float:
    """How far a closed curve in polar coordinates is from every conic: 0 for an ellipse.

    The least singular value of the six monomials of x and y at 24 points, over the greatest.
    """
    import numpy as np

    angle = 2 * np.pi * (np.arange(24) + 0.3) / 24
    x, y = radius(angle) * np.cos(angle), radius(angle) * np.sin(angle)
    x, y = x / np.abs(x).max(), y / np.abs(y).max()
    sizes = np.linalg.svd(np.stack([x * x, x * y, y * y, x, y, np.ones_like(x)], 1), compute_uv=False)
    return float(sizes[-1] / sizes[0])


def zenith_at(angle: Any) -> Any:
    """Z for r = 1/5 at an angle to the normal, mirrored below the horizon."""
    import numpy as np

    return values(Z, {T: np.abs(np.cos(angle)), R: 0.2})


def azimuth_at(angle: Any) -> Any:
    import numpy as np

    return values(A_PRINTED, {W: np.abs(np.cos(angle)), P: 0.2})


def slopes_ratio(factor: sp.Expr, p: float) -> float:
    """The RMS slope along the scratch over that across, of Z A: the factor's mean cos^2 and sin^2."""
    along, across = (mean_azimuth(factor * weight, p) for weight in (W**2, 1 - W**2))
    return (along / across) ** 0.5


def ward_ratio(p: float) -> float | None:
    """p as the share of Ward's azimuths along the scratches, if A is that share at all azimuths."""
    return of_ward(1.0, p) if is_share_of_ward(A, p) else None


def root_at_double_angle(angle: Any) -> Any:
    """The root of Z for r = 1/5, at twice the angle to the normal."""
    import numpy as np

    return np.sqrt(values(Z, {T: np.abs(np.cos(angle / 2)), R: 0.2}))


CLAIMS = (
    Claim(
        "S-5-p",
        "Section 5",
        "p is the ratio m/n of the RMS slopes along and across the scratches",
        0.2,
        lambda: slopes_ratio(A_PRINTED, 0.2),
        how="RMS slopes of the distribution Z A for p = 1/5",
        readings=(
            Reading(
                "p is the m/n of a Ward distribution whose share of the azimuths is A without the root of Eq. 28; the "
                "RMS slopes of Z A itself have the ratio sqrt(p) with that A",
                lambda: ward_ratio(0.2) if abs(slopes_ratio(A, 0.2) ** 2 - 0.2) < 1e-9 else None,
            ),
        ),
    ),
    Claim(
        "S-5-r",
        "Section 5",
        "one law relates r to the RMS slope m, in Z (Eq. 28, by Eq. 20) and in G (Eq. 31, by Eq. 19)",
        True,
        lambda: same(roughness.r_by_zenith(M), roughness.r_by_masking(M)),
        instead=Reading(
            "two laws: r = 2 m^2 by Z and r = sqrt(2/pi) m by G, m along one axis; they agree at m = 1/sqrt(2 pi)",
            lambda: bool(
                sp.solve(roughness.r_by_zenith(M) - roughness.r_by_masking(M), M)[-1] == 1 / sp.sqrt(2 * sp.pi)
            ),
        ),
    ),
    Claim(
        "S-26",
        "Eq. 26",
        "with the integral of Z cos sin = 1/2 and that of A over the circle = 2 pi, the product keeps Eq. 5",
        (sp.pi,) * 2,
        lambda: (total_of_product(sp.S.One, sp.S.One), total_of_product(2 * T**2, 2 * (1 - W**2))),
        how="the double integral for Z = A = 1, and for Z = 2 cos^2(alpha), A = 2 sin^2(phi)",
    ),
    Claim(
        "S-27-weight",
        "Eqs. 26, 27",
        "in the cosine w the condition on A has the weight 1/sqrt(1 - w^2)",
        lambda: tuple(sp.integrate(sp.cos(PHI) ** power, (PHI, 0, sp.pi / 2)) for power in (0, 1, 2)),
        lambda: tuple(sp.integrate(W**power / sp.sqrt(1 - W**2), (W, 0, 1)) for power in (0, 1, 2)),
        how="both integrals of 1, w and w^2",
    ),
    Claim(
        "S-28-Z",
        "Eqs. 27, 28",
        "Z keeps its condition of Eq. 27",
        1,
        lambda: max((zenith_total(r) for r in (0.01, 0.05, 0.2, 0.5, 1.0)), key=lambda found: abs(found - 1)),
        how="quadrature at the r of Figure 8",
    ),
    Claim(
        "S-28-A",
        "Eqs. 27, 28",
        "A keeps its condition of Eq. 27: its mean over the azimuth is 1",
        1,
        lambda: mean_azimuth(A_PRINTED, 0.2),
        how="at p = 1/5",
        instead=Reading(
            "its square p/(p^2 - p^2 w^2 + w^2) keeps it for every p; the found mean is the printed A's at p = 1/5",
            lambda: all(abs(mean_azimuth(A, p) - 1) < 1e-9 for p in (0.01, 0.05, 0.2, 0.5, 1.0)),
        ),
    ),
    Claim(
        "S-28-ellipse-Z",
        "Eq. 28",
        "Z is the polar equation of an ellipse with the pole in a focus",
        ZERO,
        lambda: off_conic(zenith_at),
        how="distance from every conic at r = 1/5",
        instead=Reading(
            "the root of Z is one, in twice the angle to the normal; Z itself lies on no conic",
            lambda: off_conic(root_at_double_angle) < 1e-9,
        ),
    ),
    Claim(
        "S-28-ellipse-A",
        "Eq. 28",
        "A is the polar equation of an ellipse with the pole in its middle",
        ZERO,
        lambda: off_conic(azimuth_at),
        how="distance from every conic at p = 1/5; so it is as printed, with the root that breaks Eq. 27",
    ),
    Claim(
        "S-28-r1",
        "Section 5.1",
        "for r = 1, Z is constant",
        sp.S.One,
        lambda: Z.subs(R, 1),
        how="at seven angles",
    ),
    Claim(
        "S-28-r0",
        "Section 5.1",
        "for r = 0, Z becomes a Dirac function",
        Rounded(0, 2e-4),
        lambda: zenith_total(1e-8, float(sp.cos(sp.pi / 180))),
        how="the share of facets steeper than one degree at r = 1e-8; the total stays 1",
    ),
    Claim(
        "S-28-p1",
        "Section 5.1",
        "for p = 1, A is constant",
        sp.S.One,
        lambda: A_PRINTED.subs(P, 1),
        how="at seven azimuths",
    ),
    Claim(
        "S-28-p0",
        "Section 5.1",
        "for p = 0, A becomes a Dirac function: its total 1 comes to lie across the scratches",
        Rounded(1, 0.002),
        lambda: share_within(A_PRINTED, 1e-6, 2.0),
        how="its integral within two degrees at p = 1e-6",
        readings=(
            Reading("of A without the root; as printed its total goes to 0 with p", lambda: share_within(A, 1e-6, 2.0)),
        ),
    ),
)
