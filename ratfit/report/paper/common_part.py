"""The one measure that serves all printed figures best, and what it does not reproduce."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ratfit.report.document import Block, Cell, Column, Details, Paragraph, Section, Table
from ratfit.report.measured import number
from ratfit.report.paper.closest import Common, rounds_to

POOLED = """\
One definition and one protocol for all equations; the settings of each are drawn at random or averaged over those of \
the figures. No direction stands behind the sine: it is uniform throughout. A way is as far off as the one of its \
numbers that differs by the greatest factor from what was printed."""

BEST = 10
"""Ways of measuring that the page lists."""


def common_part(every: Sequence[Common], without: Sequence[Common], printed: Mapping[str, float]) -> Section:
    """The best way for all figures, and for the equations alone.

    Arguments: the ways for all of the `printed` figures, best first; those for all but the footnote's.
    """
    blocks: list[Block] = [Paragraph(POOLED)]
    for ways in filter(None, (every, without)):
        folded = Details(f"The best {len(ways[:BEST])} ways", (_ways_table(ways[:BEST]),))
        blocks += [Paragraph(common_sentence(ways, printed)), _table(ways[0], printed), folded]
    if not every and not without:
        blocks.append(Paragraph("No way of measuring gives a number for each of the figures."))
    return Section("One measure for all", tuple(blocks))


def common_sentence(ways: Sequence[Common], printed: Mapping[str, float]) -> str:
    """The best of some ways, and which printed figures it reproduces."""
    best = ways[0]
    kept = [place for place, value in best.values.items() if rounds_to(value, printed[place])]
    missed = [f"{place} ({best.distances[place]:.3g})" for place in best.values if place not in kept]
    said = f"Best of {len(ways)} ways for {_listed(list(best.values))}: {_words(best)}."
    right = f"To the printed digits it gives {_listed(kept) if kept else 'none of them'}"
    return f"{said} {right}; it is off, by these factors, for {_listed(missed)}." if missed else f"{said} {right}."


def _words(way: Common) -> str:
    """A way of measuring in words."""
    pooled = "parameters at random" if way.is_random else "the mean over the figures' settings"
    return f"{way.definition}, {way.protocol}, {pooled}"


def _listed(words: Sequence[str]) -> str:
    return ", ".join(words[:-1]) + " and " + words[-1] if len(words) > 1 else "".join(words)


def _table(way: Common, printed: Mapping[str, float]) -> Table:
    """The numbers of a way beside the printed ones."""
    head = (Column("equation"), Column("printed", True), Column("measured", True), Column("factor", True))
    rows = tuple(
        (
            Cell(place),
            Cell(f"{printed[place]:g}", printed[place]),
            Cell(number(value), value),
            Cell(number(way.distances[place]), way.distances[place]),
        )
        for place, value in way.values.items()
    )
    return Table(head, rows)


def _ways_table(ways: Sequence[Common]) -> Table:
    """Ways of measuring with the factor by which each equation is off."""
    places = tuple(ways[0].distances)
    head = (Column("way"), Column("greatest factor", True), *(Column(place, True) for place in places))
    rows = []
    for way in ways:
        factors = (way.distance, *(way.distances[place] for place in places))
        rows.append((Cell(_words(way)), *(Cell(number(factor), factor) for factor in factors)))
    return Table(head, tuple(rows))
