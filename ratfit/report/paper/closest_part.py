"""What comes closest to each printed eps, in a sentence and in a table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ratfit.report.document import Cell, Code, Column, Paragraph, Section, Table
from ratfit.report.measured import number
from ratfit.report.paper.closest import Finding, Match, closest
from ratfit.report.paper.measurements import CHECK

CHANCE = """\
For each printed eps the nearest of all definitions, protocols and settings that were measured. Among so many \
something comes near by chance: a match explains a figure only where few others round to it as well. Of those that \
round to it a mean error is named before others."""


def closest_part(findings: Sequence[Finding], printed: Mapping[str, float]) -> Section:
    """All printed figures, by place, each with what comes closest to it."""
    return Section("What comes closest", (Paragraph(CHANCE), closest_table(findings, printed)))


def percent(value: float) -> str:
    """A printed figure as a fraction and as it was printed: "0.014 (1.4 %)"."""
    return f"{value:g} ({100 * value:g} %)"


def searched(findings: Sequence[Finding]) -> list[Finding]:
    """The findings that a figure is looked for in: those of the paper's own functions, and no check on a protocol."""
    return [finding for finding in findings if finding.protocol != CHECK and not finding.against]


def closest_sentence(findings: Sequence[Finding], printed: float) -> str:
    """What comes closest to a printed figure, among how many."""
    found = closest(findings, printed)
    if found is None:
        return f"Nothing that was measured can be the printed {percent(printed)}."
    best = found.match
    factor = "" if found.rounding else f", off by a factor of {best.distance:.4g}"
    number_of = f"{len(found.rounding) or 'none'} round{'s' if len(found.rounding) < 2 else ''} to what was printed"
    others = f": {'; '.join(map(_words, found.rounding))}" if 1 < len(found.rounding) <= FEW else ""
    return (
        f"Closest to the printed {percent(printed)}: {number(best.value, 4)}, {_words(best)}{factor}. "
        f"Of {found.tried} combinations of definition, protocol and setting {number_of}{others}."
    )


FEW = 5
"""So many combinations that round to a figure are named; of more it is said how many they are."""


def _words(match: Match) -> str:
    return ", ".join(filter(None, (match.definition, match.finding.protocol, match.finding.setting)))


def closest_table(findings: Sequence[Finding], printed: Mapping[str, float]) -> Table:
    """For each equation the combination that comes closest, of how many."""
    head = (
        Column("equation"), Column("printed", True), Column("closest", True), Column("factor", True),
        Column("definition"), Column("samples"), Column("at"), Column("tried", True), Column("round to it", True),
    )  # fmt: skip
    return Table(head, tuple(_closest_rows(findings, printed)))


def _closest_rows(findings: Sequence[Finding], printed: Mapping[str, float]) -> Iterator[tuple[Cell, ...]]:
    for place, figure in printed.items():
        found = closest([finding for finding in searched(findings) if finding.place == place], figure)
        if found is not None:
            match = found.match
            yield (
                Cell(place), Cell(f"{figure:g}", figure), Cell(number(match.value, 4), match.value),
                Cell(number(match.distance, 4), match.distance), Cell(Code(match.definition)),
                Cell(match.finding.protocol), Cell(match.finding.setting or "–"), Cell(str(found.tried), found.tried),
                Cell(str(len(found.rounding)), len(found.rounding)),
            )  # fmt: skip
