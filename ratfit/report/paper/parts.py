"""The parts of what `ratfit paper` says, each a section of nouns that the page and the terminal share.

Every sentence here is made of the numbers beside it: none says what was found before it was found.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ratfit.report.document import Block, Cell, Code, Column, Facts, Paragraph, Section, Table, Text
from ratfit.report.headlines import counts
from ratfit.report.measured import number
from ratfit.report.paper.closest import Closest, Common, Finding, closest
from ratfit.report.paper.measurements import CHECK, Derived
from ratfit.report.text import agreement, condition_line

SHOWN = ("peak_mean", "peak_rms", "peak_max", "relative_mean", "relative_max")
"""The definitions that a table shows; the page has all, folded."""

FAR = 1.5
"""From this factor on a figure is said not to be reproduced."""


def percent(value: float) -> str:
    """A printed figure as a fraction and as it was printed: "0.014 (1.4 %)"."""
    return f"{value:g} ({100 * value:g} %)"


def equation(derived: Derived, findings: Sequence[Finding]) -> Section:
    """Derived beside printed; eps under every protocol; what comes closest to the printed figure."""
    shown, fit = derived.card, derived.fit
    pairs: list[tuple[str, Text]] = [
        ("derived", (Code(str(fit.expression)), f" ({fit.status}, {fit.route} route)")),
        ("printed", (Code(shown.printed), f": {agreement(fit, shown)}")),
        *(("choice", f"{s} = {v} of {s} > {fit.free[s][0]}") for s, v in fit.choice.items()),
        *(("keeps", condition_line(checked)) for checked in fit.conditions),
        ("cost", f"{counts(fit.cost.as_dict())} a sample; the paper: {_operations(shown.operations)}"),
        ("the paper", f"eps {_figure(shown.epsilon)}, gamma {_figure(shown.gamma)}"),
    ]
    own = [finding for finding in findings if not finding.against]
    blocks: list[Block] = [Facts(tuple(pairs))]
    if own and shown.epsilon is not None:
        blocks += [errors_table(own), Paragraph(closest_sentence(searched(own), shown.epsilon))]
    return Section(f"{shown.place}: {shown.title}", tuple(blocks))


def searched(findings: Sequence[Finding]) -> list[Finding]:
    """The findings that a figure is looked for in: those of the paper's own functions, and no check on a protocol."""
    return [finding for finding in findings if finding.protocol != CHECK and not finding.against]


def _operations(operations: Mapping[str, int] | None) -> str:
    return counts(dict(operations)) if operations else "not stated"


def _figure(value: float | None) -> str:
    return "not stated" if value is None else percent(value)


def errors_table(findings: Sequence[Finding]) -> Table:
    """A row a protocol and pooling of settings: from the least to the greatest over the settings."""
    groups: dict[tuple[str, str, bool], list[Finding]] = {}
    for finding in findings:
        groups.setdefault((finding.against, finding.protocol, finding.is_random), []).append(finding)
    is_compared = len({against for against, _, _ in groups}) > 1
    rows = []
    for (against, protocol, _), group in groups.items():
        said = [Cell(against or "as printed")] if is_compared else []
        rows.append((*said, Cell(protocol), Cell(settings(group)), *(_range(group, name) for name in SHOWN)))
    head = [Column("against")] if is_compared else []
    head += [Column("samples"), Column("at"), *(Column(name, numeric=True) for name in SHOWN)]
    return Table(tuple(head), tuple(rows))


def settings(findings: Sequence[Finding]) -> str:
    """The settings in few words: "m = 0.01 … 0.5"."""
    names = [finding.setting for finding in findings]
    if len(names) > 2 and all(name.startswith("m = ") for name in names):
        return f"{names[0]} … {names[-1].removeprefix('m = ')}"
    return ", ".join(filter(None, names)) or "–"


def _range(findings: Sequence[Finding], definition: str) -> Cell:
    known = sorted(value for finding in findings if (value := finding.epsilon.get(definition)) is not None)
    if not known:
        return Cell(number(None))
    low, high = number(known[0]), number(known[-1])
    return Cell(low if low == high else f"{low} … {high}", known[-1])


def closest_sentence(findings: Sequence[Finding], printed: float) -> str:
    """What comes closest to a printed figure, among how many."""
    found = closest(findings, printed)
    if found is None:
        return f"Nothing that was measured can be the printed {percent(printed)}."
    return (
        f"Closest to the printed {percent(printed)}: {match_words(found)}, {_factor(found.match.distance)}. "
        f"Of {found.tried} combinations of definition, protocol and setting {found.rounding} "
        f"round{'s' if found.rounding == 1 else ''} to what was printed."
    )


def match_words(found: Closest) -> str:
    """A match in words: "0.0136, peak_mean, uniform"."""
    of = found.match.finding
    against = f"against {of.against}" if of.against else ""
    return ", ".join(
        filter(None, (number(found.match.value, 4), found.match.definition, of.protocol, of.setting, against))
    )


def _factor(distance: float) -> str:
    return f"off by a factor of {distance:.4g}" if distance > 1 else "the very number"


def common_part(every: Sequence[Common], without: Sequence[Common], printed: Mapping[str, float]) -> Section:
    """The one way of measuring that serves all printed figures best, and what it cannot reproduce.

    Arguments: the ways for all of the `printed` figures, best first; those for all but the footnote's.
    """
    blocks: list[Block] = [Paragraph(POOLED)]
    for ways in (every, without):
        if ways:
            blocks += [Paragraph(_common_sentence(ways)), common_table(ways[0], printed)]
    if not every and not without:
        blocks.append(Paragraph("No way of measuring gives a number for each of the figures."))
    return Section("One measure for all", tuple(blocks))


POOLED = """\
One definition and one protocol for all equations; the settings of each are drawn at random or averaged over those of \
the figures. No direction stands behind the sine: it is uniform throughout. A way is as far off as the one of its \
numbers that differs by the greatest factor from what was printed."""


def _common_sentence(ways: Sequence[Common]) -> str:
    best = ways[0]
    missed = [place for place, distance in best.distances.items() if distance >= FAR]
    places = list(best.distances)
    said = f"Best of {len(ways)} ways for {_listed(places)}: {way_words(best)}, within a factor of {best.distance:.3g}"
    if missed:
        return (
            f"{said}. It does not reproduce {_listed(missed)} (off by {FAR:g} or more), and no other way comes nearer."
        )
    return f"{said}: none of its numbers is off by a factor of {FAR:g}."


def way_words(way: Common) -> str:
    """A way of measuring in words."""
    pooled = "parameters at random" if way.is_random else "the mean over the figures' settings"
    return f"{way.definition}, {way.protocol}, {pooled}"


def _listed(words: Sequence[str]) -> str:
    return ", ".join(words[:-1]) + " and " + words[-1] if len(words) > 1 else "".join(words)


def common_table(way: Common, printed: Mapping[str, float]) -> Table:
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
            at = ", ".join(filter(None, (match.finding.setting, match.finding.against))) or "–"
            yield (
                Cell(place), Cell(f"{figure:g}", figure), Cell(number(match.value, 4), match.value),
                Cell(number(match.distance, 4), match.distance), Cell(Code(match.definition)),
                Cell(match.finding.protocol), Cell(at), Cell(str(found.tried), found.tried),
                Cell(str(found.rounding), found.rounding),
            )  # fmt: skip


def footnote_part(findings: Sequence[Finding], printed: float, sine: str | None) -> Section:
    """Eq. 16 in place of Smith's function; `sine` is the definition that gives the sine's figure."""
    blocks: list[Block] = [Paragraph(FOOTNOTE), errors_table(findings)]
    blocks.append(Paragraph(closest_sentence(searched(findings), printed)))
    values = [v for f in findings if sine and (v := f.epsilon.get(sine)) is not None]
    if values and sine:
        low, high = min(values), max(values)
        reach = "out of its reach" if high < printed or low > printed else "within its range"
        span = f"{number(low)} to {number(high)}"
        blocks.append(
            Paragraph(f"Under {sine}, which fits the sine best, it is {span}: {percent(printed)} is {reach}.")
        )
    return Section("Footnote 3: Eq. 16 in place of Smith's function", tuple(blocks))


FOOTNOTE = """\
min(1, 2tv/u, 2tv'/u) of a view and a light, against G(v) G(v') of Eqs. 17 and 18, and of the corrected functions: in \
a plane with the normal, both angles uniform, and over the hemisphere."""


def smith_part(findings: Sequence[Finding]) -> Section:
    """What Eq. 19 costs against the function it was made for, against Smith's own and against the one used today."""
    names = ("peak_mean", "peak_max", "relative_max")
    own = [finding for finding in findings if finding.protocol == "uniform" and not finding.is_random]
    functions = list(dict.fromkeys(finding.against for finding in own))
    head = (Column("Eq. 19 against"), Column("at"), *(Column(name, True) for name in names))
    rows = tuple(
        (Cell(f.against or "as printed"), Cell(f.setting), *(Cell(number(v), v) for v in map(f.epsilon.get, names)))
        for f in own
    )
    said = [Paragraph(line) for line in _smith_sentences(own, functions)]
    return Section("Smith three ways", (Table(head, rows), *said))


def _smith_sentences(findings: Sequence[Finding], functions: Sequence[str]) -> Iterator[str]:
    printed = {f.setting: f.epsilon.get("peak_mean") for f in findings if not f.against}
    for function in filter(None, functions):
        found = [f for f in findings if f.against == function]
        known = [v for f in found if (v := f.epsilon.get("peak_mean")) is not None]
        times = [
            v / p for f in found if (v := f.epsilon.get("peak_mean")) is not None and (p := printed.get(f.setting))
        ]
        if known and times:
            yield (
                f"Against {function} Eq. 19 is off by {number(min(known))} to {number(max(known))} (peak_mean): "
                f"{number(min(times))} to {number(max(times))} times what it is against Eq. 18, which it was made for."
            )
