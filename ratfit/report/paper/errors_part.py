"""The part of one equation, and of footnote 3: derived beside printed, and eps under every protocol.

Every sentence in these parts is made of the numbers beside it: none says what was found before it was found.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ratfit.report.document import Block, Cell, Code, Column, Facts, Paragraph, Section, Table, Text
from ratfit.report.headlines import counts
from ratfit.report.measured import number
from ratfit.report.paper.closest import Finding
from ratfit.report.paper.closest_part import closest_sentence, percent, searched
from ratfit.report.paper.measurements import Derived
from ratfit.report.text import agreement

SHOWN = ("peak_mean", "peak_rms", "peak_max", "relative_mean", "relative_max")
"""The definitions that a table shows; the page has all, folded."""


def equation(derived: Derived, findings: Sequence[Finding]) -> Section:
    """Derived beside printed; eps under every protocol; what comes closest to the printed figure."""
    shown, fit = derived.card, derived.fit
    pairs: list[tuple[str, Text]] = [
        ("derived", (Code(str(fit.expression)), f" ({fit.status}, {fit.route} route)")),
        ("printed", (Code(shown.printed), f": {agreement(fit, shown)}")),
        *(("choice", f"{s} = {v} of {s} > {fit.free[s][0]}") for s, v in fit.choice.items()),
        *(("keeps", checked.stated) for checked in fit.conditions),
        ("cost", f"{counts(fit.cost.as_dict())} a sample; the paper: {_operations(shown.operations)}"),
        ("the paper", f"eps {_figure(shown.epsilon)}, gamma {_figure(shown.gamma)}"),
    ]
    own = [finding for finding in findings if not finding.against]
    blocks: list[Block] = [Facts(tuple(pairs))]
    if own and shown.epsilon is not None:
        blocks += [errors_table(own), Paragraph(closest_sentence(searched(own), shown.epsilon))]
    return Section(f"{shown.place}: {shown.title}", tuple(blocks))


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


def footnote_part(findings: Sequence[Finding], printed: float, sine: Sequence[str]) -> Section:
    """Eq. 16 in place of Smith's function; `sine` are the definitions that give the sine's figure as printed."""
    blocks: list[Block] = [Paragraph(FOOTNOTE), errors_table(findings)]
    blocks.append(Paragraph(closest_sentence(searched(findings), printed)))
    values = [value for f in findings for name in sine if (value := f.epsilon.get(name)) is not None]
    if values:
        low, high = min(values), max(values)
        reach = "out of their reach" if high < printed or low > printed else "within their range"
        said = f"Under the definitions that give the sine's figure ({', '.join(sine)})"
        span = f"{number(low)} to {number(high)}"
        blocks.append(Paragraph(f"{said} it is {span}: {percent(printed)} is {reach}."))
    return Section("Footnote 3: Eq. 16 in place of Smith's function", tuple(blocks))


FOOTNOTE = """\
min(1, 2tv/u, 2tv'/u) of a view and a light, against G(v) G(v') of Eqs. 17 and 18, and of the corrected functions: in \
a plane with the normal, both angles uniform, and over the hemisphere."""
