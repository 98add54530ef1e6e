"""Optical constants of metals, and of a few transparent materials, from the tables cited in `metals.toml`."""

from __future__ import annotations

import tomllib
from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from numbers import Real

from sympy import Expr, Rational, S, sqrt

from ratfit._parse import RatfitError, nearest

YELLOW = Rational("0.589")
"""Wavelength of sodium light in micrometres, at which an index given without a wavelength is understood."""


@dataclass(frozen=True)
class Material:
    """Refraction index and extinction coefficient of a material by wavelength, as exact numbers.

    `rows` are (wavelength, eta, kappa) with wavelengths in micrometres, ascending; or there are none, and `terms` are
    the pairs (B, C) of eta**2 = 1 + sum of B x**2/(x**2 - C**2) at the wavelength x. `range` is the first and last
    wavelength, `source` a key of docs/refs.bib, `table` the file of the refractiveindex.info database.
    """

    name: str
    source: str
    table: str
    range: tuple[Rational, Rational]
    rows: tuple[tuple[Rational, Rational, Rational], ...] = ()
    terms: tuple[tuple[Rational, Rational], ...] = ()

    def at(self, wavelength: Expr = YELLOW) -> tuple[Expr, Expr]:
        """eta and kappa at a wavelength in micrometres: the straight line between two rows, or the formula.

        Fails with `RatfitError` outside `range`, and for what is no number.
        """
        _check_number(wavelength)
        first, last = map(float, self.range)
        if not first <= float(wavelength) <= last:
            raise RatfitError(f"{self.name} is known from {first} to {last} micrometres, not at {wavelength}")
        if self.terms:
            x2 = wavelength**2
            return sqrt(1 + sum(b * x2 / (x2 - c**2) for b, c in self.terms)), S.Zero
        above = min(bisect_right(self.rows, wavelength, key=lambda row: row[0]), len(self.rows) - 1)
        (x0, *low), (x1, *high) = self.rows[above - 1], self.rows[above]
        part = (wavelength - x0) / (x1 - x0)
        eta, kappa = (before + part * (after - before) for before, after in zip(low, high, strict=True))
        return eta, kappa


def _check_number(wavelength: object) -> None:
    is_kind = isinstance(wavelength, Expr | Real) and not isinstance(wavelength, bool)
    if not (is_kind and S(wavelength).is_number and S(wavelength).is_extended_real is not False):
        raise RatfitError(f"{wavelength!r} is no wavelength: give a number of micrometres, as sympy.Rational('0.55')")


def names() -> tuple[str, ...]:
    """The names that `material` knows."""
    return tuple(_tables())


def material(name: str) -> Material:
    """The material of a name; fails with `RatfitError` for a name that is none of `names()`."""
    if name not in _tables():
        remedy = nearest(name, names()) or f"; known are {', '.join(names())}"
        raise RatfitError(f"no material {name!r}{remedy}")
    table = _tables()[name]
    about = (name, table["source"], table["table"])
    if "strength" in table:
        first, last = table["range"]
        return Material(*about, (first, last), terms=tuple(zip(table["strength"], table["resonance"], strict=True)))
    rows = tuple(zip(table["wavelength"], table["eta"], table["kappa"], strict=True))
    return Material(*about, (rows[0][0], rows[-1][0]), rows=rows)


@cache
def _tables() -> Mapping[str, dict]:
    text = files("ratfit.brdf").joinpath("metals.toml").read_text(encoding="utf-8")
    return tomllib.loads(text, parse_float=Rational)
