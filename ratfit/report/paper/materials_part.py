"""The optical constants that the Fresnel factor is measured with, and where they come from."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from ratfit.gallery import card
from ratfit.report.document import Cell, Column, Paragraph, Section, Table
from ratfit.report.measured import number

SOURCES: Mapping[str, str] = {
    "schlick1994": "the usual index: the paper names the material and gives no constants",
    "johnson1972": "Johnson and Christy 1972, the row at 0.5821 micrometres (johnson1972)",
}
"""What the key of a reference's source stands for here."""


def materials_part() -> Section:
    """Index, extinction and normal reflectance of each material, with the source."""
    head = (Column("material"), Column("n", True), Column("k", True), Column("f", True), Column("source"))
    rows = []
    for reference in card("eq15").problem.references:
        given = {symbol.name: value for symbol, value in reference.parameters.items()}
        values = [float(sp.N(given[name].subs(reference.parameters))) for name in ("eta", "kappa", "f")]
        cells = (Cell(number(value, 4), value) for value in values)
        rows.append((Cell(reference.name), *cells, Cell(SOURCES.get(reference.source, reference.source))))
    said = Paragraph("The paper names the four materials of its Fig. 5 and gives no constants. f is F at u = 1.")
    return Section("Optical constants", (said, Table(head, tuple(rows))))
