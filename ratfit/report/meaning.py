"""What eps and gamma mean, for the end of every page that shows them."""

from __future__ import annotations

from collections.abc import Iterable

from ratfit._error import DEFINITIONS
from ratfit.report.document import Cell, Code, Column, Details, Paragraph, Section, Table

EPS = """\
eps says how far a fit is from the exact function: a fraction (0.0136, not 1.36 %), and never alone, for it depends on \
its definition, on how the samples are drawn, and on the type that the fit is computed in. The exact function is \
computed with more precision than the fit, at the very samples. Samples where either is not finite are left out and \
counted."""
GAMMA = """\
gamma is the exact function's time over the fit's (31.8, not 3180 %), measured in turn in one run, with its 95 % \
interval. The floor is the time of copying the samples; it is not subtracted. A fit that runs at the floor is limited \
by memory, and its gamma is a lower bound. On the backend cost-model nothing is timed: gamma is a ratio of counted \
operations, each with a weight."""


def meaning(definitions: Iterable[str] = DEFINITIONS) -> Section:
    """The section: both words, and the formulas of these definitions, as far as they are known."""
    known = [name for name in definitions if name in DEFINITIONS]
    head = (Column("definition"), Column("formula"))
    lines = tuple((Cell(Code(name)), Cell(Code(DEFINITIONS[name]))) for name in known)
    formulas = (Details("Definitions of eps", (Table(head, lines),)),) if lines else ()
    return Section("What the numbers mean", (Paragraph(EPS), Paragraph(GAMMA), *formulas))
