"""Smith's function three ways: as schlick1994 prints it, as smith1967 has it, and as walter2007 uses it today."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ratfit.report.document import Cell, Column, Paragraph, Section, Table
from ratfit.report.measured import number
from ratfit.report.paper.closest import Finding


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
