"""Oren and Nayar's model of rough diffuse surfaces: facets of Lambert's kind send light back to its source."""

import math

import sympy as sp

from ratfit._lower import Entries, Lookup
from ratfit._target import parameter
from ratfit.brdf._limits import guarded
from ratfit.models import _scanline
from ratfit.models._model import Model
from ratfit.models.directions import HORIZON, V_DOT_L, V_PRIME, V

ALBEDO = parameter("albedo", 0, 1)
SIGMA = parameter("sigma", 0, sp.pi / 2)

A = 1 - SIGMA**2 / (SIGMA**2 + sp.Rational(33, 100)) / 2
B = sp.Rational(45, 100) * SIGMA**2 / (SIGMA**2 + sp.Rational(9, 100))

SIDE = 64
"""Entries of the table along each cosine."""


def direct() -> sp.Expr:
    """A + B G sin(alpha) tan(beta), where G = max(0, cos of the azimuths' difference), without an angle.

    alpha is the greater zenith angle, beta the smaller, whose cosine is the greater one. So sin(alpha) tan(beta) is
    sin(theta) sin(theta')/max(v, v'), its product with G is max(0, V.L - v v')/max(v, v'), and the azimuth, which has
    no value where one direction is N, does not appear. There the product is 0.
    """
    return A + B * sp.Max(0, V_DOT_L - V * V_PRIME) / sp.Max(V, V_PRIME, HORIZON)


def tabled() -> sp.Expr:
    """The same with sin(alpha) tan(beta) from a table of both cosines, and G from the directions' projections.

    The entries stand at 1/n, 2/n, ..., 1: at 0 the function has no limit, and at 1 it must be 0. Between them it is
    bilinear, below 1/n constant. The table in print holds B as well; it factors out, so one table serves every sigma.
    """
    return A + B * _azimuths() * _table(V, V_PRIME)


def _azimuths() -> sp.Expr:
    """G; 0 where one direction is N."""
    sines = (1 - V) * (1 + V) * (1 - V_PRIME) * (1 + V_PRIME)

    def cosine(product: sp.Expr) -> sp.Expr:
        return sp.Max(0, sp.Min(1, (V_DOT_L - V * V_PRIME) / sp.sqrt(product)))

    return guarded(cosine, sines, sp.S.Zero, sines <= 0, sp.S.One)


def _table(p: sp.Expr, q: sp.Expr) -> sp.Expr:
    """The table, its rows one after the other, at the cosines p (the row) and q."""
    cosines = [(k + 1) / SIDE for k in range(SIDE)]
    entries = Entries([_entry(first, second) for first in cosines for second in cosines])
    place = sp.Min(sp.Max(SIDE * p - 1, 0), SIDE - 1)
    row = sp.Min(sp.floor(place), SIDE - 2)
    column = sp.Min(sp.Max(SIDE * q - 1, 0), SIDE - 1)
    first, second = (Lookup(SIDE * (row + k) + column, entries) for k in (0, 1))
    return first + (place - row) * (second - first)


def _entry(p: float, q: float) -> float:
    return math.sqrt((1 - p * p) * (1 - q * q)) / max(p, q)


OREN_NAYAR = Model(
    "oren-nayar",
    "Oren and Nayar's rough diffuse reflector",
    lambda: ALBEDO / sp.pi * direct(),
    (ALBEDO, SIGMA),
    "orennayar1994; polimi2024, Oren-Nayar",
    {"albedo": 0.8, "sigma": 0.5},
    note=(
        "The short model, of single reflections. It has no bound as both directions come to the horizon together, and "
        "at grazing view it reflects albedo (A + B/2), more than it gets if the albedo is 1 and sigma below 0.326."
    ),
)

OREN_NAYAR_TABLED = Model(
    "oren-nayar-tabled",
    "Oren and Nayar's rough diffuse reflector, by a table",
    lambda: ALBEDO / sp.pi * tabled(),
    (ALBEDO, SIGMA),
    "polimi2024, Oren-Nayar, the second form",
    {"albedo": 0.8, "sigma": 0.5},
    note=f"A table of {SIDE} x {SIDE} entries; bounded at the horizon.",
)

OREN_NAYAR_AS_PRINTED = Model(
    "oren-nayar-as-printed",
    "Oren and Nayar's rough diffuse reflector as printed, without 1/pi",
    lambda: _scanline.DIFFUSE * direct(),
    (_scanline.DIFFUSE, SIGMA),
    "polimi2024, Oren-Nayar",
    {"diffuse": 0.8, "sigma": 0.5},
    note=_scanline.NOTE,
)
