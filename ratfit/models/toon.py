"""Toon shading: few tones, by the cosines to the light and to the mirror direction or of the half vector."""

from collections.abc import Sequence

import sympy as sp

from ratfit._lower import Entries, Lookup
from ratfit._target import parameter
from ratfit.models import _scanline
from ratfit.models._model import Model
from ratfit.models.directions import R_DOT_V, V_PRIME, T

LIT, DARK, DIFFUSE_THRESHOLD = (parameter(f"diffuse_{word}", 0, 1) for word in ("lit", "dark", "threshold"))
SHINING, DULL, SPECULAR_THRESHOLD = (parameter(f"specular_{word}", 0, 1) for word in ("lit", "dark", "threshold"))

DIFFUSE_TONES = (0.2,) * 3 + (0.6,) * 4 + (1.0,) * 4
SPECULAR_TONES = (0.0,) * 27 + (0.5,) * 3 + (1.0,) * 3
NOTE = f"{_scanline.NOTE} Below the horizon it is 0, not the dark tone."


def two_tones(name: str, title: str, cosine: sp.Expr) -> Model:
    """A lit and a dark tone on either side of a threshold, for the diffuse and for the specular part.

    **Arguments:** the model's name and title; the cosine of the highlight, `R_DOT_V` (Phong's) or `T` (Blinn's).
    """

    def formula() -> sp.Expr:
        diffuse = sp.Piecewise((LIT, V_PRIME >= DIFFUSE_THRESHOLD), (DARK, True))
        specular = sp.Piecewise((SHINING, cosine >= SPECULAR_THRESHOLD), (DULL, True))
        return _scanline.without_cosine(diffuse + specular)

    return Model(
        name,
        title,
        formula,
        (LIT, DARK, DIFFUSE_THRESHOLD, SHINING, DULL, SPECULAR_THRESHOLD),
        "polimi2024, Toon shading",
        {
            "diffuse_lit": 0.6, "diffuse_dark": 0.2, "diffuse_threshold": 0.4,
            "specular_lit": 0.4, "specular_dark": 0.0, "specular_threshold": 0.9,
        },
        note=NOTE,
    )  # fmt: skip


def tabled(name: str, title: str, cosine: sp.Expr, diffuse: Sequence[float], specular: Sequence[float]) -> Model:
    """Tones from two tables, each over its cosine from 0 to 1, first and last entry at the ends, linear between.

    **Arguments:** the model's name and title; the cosine of the highlight, `R_DOT_V` or `T`; the entries of the two
    tables, two or more finite numbers each. The model's parameters are the colours that the entries multiply.
    """

    def formula() -> sp.Expr:
        tones = _scanline.DIFFUSE * _tone(V_PRIME, diffuse) + _scanline.SPECULAR * _tone(cosine, specular)
        return _scanline.without_cosine(tones)

    return Model(
        name,
        title,
        formula,
        (_scanline.DIFFUSE, _scanline.SPECULAR),
        "polimi2024, Toon shading",
        {"diffuse": 0.6, "specular": 0.4},
        note=NOTE,
    )


def _tone(cosine: sp.Expr, tones: Sequence[float]) -> sp.Expr:
    return Lookup(cosine * (len(tones) - 1), Entries(tones))


TOON = two_tones("toon", "Toon shading in two tones, Phong's highlight", R_DOT_V)
TOON_BLINN = two_tones("toon-blinn", "Toon shading in two tones, Blinn's highlight", T)
TOON_TABLE = tabled("toon-table", "Toon shading by tables, Phong's highlight", R_DOT_V, DIFFUSE_TONES, SPECULAR_TONES)
TOON_TABLE_BLINN = tabled(
    "toon-table-blinn", "Toon shading by tables, Blinn's highlight", T, DIFFUSE_TONES, SPECULAR_TONES
)
