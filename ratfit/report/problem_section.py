"""One problem's part of the page, in the order in which a reader asks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

from ratfit._record import Row
from ratfit.report.document import (
    Block,
    Cell,
    Code,
    Column,
    Details,
    Facts,
    Figure,
    Formula,
    Headline,
    Headlines,
    Items,
    Paragraph,
    Section,
    Table,
    Text,
    Verbatim,
)
from ratfit.report.figures import ErrorCurve, Point, cost_figure, error_figure
from ratfit.report.formula import formula
from ratfit.report.measured import (
    circumstances,
    count,
    epsilon_range,
    error_remarks,
    gamma,
    gamma_range,
    leading,
    name_of,
    number,
    parameters,
    speed_remarks,
)
from ratfit.report.tables import definitions_table, rows_table

STATUS = {
    "unique": "one answer",
    "family": "a family: the conditions leave coefficients free",
    "several": "several answers",
    "inconsistent": "no answer: the conditions clash",
    "rejected": "no answer: every candidate was rejected",
    "timeout": "no answer in time",
}
HOLDS = {True: "✓ holds", False: "✗ fails", None: "? undecided"}


@dataclass(frozen=True)
class Measured:
    """The rows of one problem, `number` its place on the page and `title` its name there."""

    number: int
    title: str
    rows: tuple[Row, ...]

    @property
    def fit(self) -> dict[str, Any] | None:
        """The fit as `derive --format json` prints it; None where no row has one."""
        own = (row for row in self.rows if row.get("fit") and not name_of(row).peer)
        return next((row["fit"] for row in own), None)

    @property
    def main(self) -> tuple[Row, ...]:
        """The rows that the problem is about: the fit's, against the target where it was measured against it."""
        own = tuple(row for row in self.rows if not name_of(row).peer) or self.rows
        return tuple(row for row in own if not name_of(row).reference) or own

    @property
    def has_target(self) -> bool:
        """Whether some row is against the target, so that rows against references tell of something else."""
        return any(not name_of(row).reference for row in self.rows)

    @property
    def compared(self) -> tuple[Row, ...]:
        """The main rows, and those of the peers against the same exact functions."""
        return tuple(row for row in self.rows if not (self.has_target and name_of(row).reference))

    @property
    def leading(self) -> str:
        """The definition of eps that stands at the top."""
        return leading(self.main)

    def with_errors(self) -> tuple[Row, ...]:
        """The main rows under the dtype and sampling of the first that has an eps."""
        return _like_first(self.main, lambda row: row["epsilon"].get(self.leading), lambda row: circumstances(row)[1:])

    def with_times(self) -> tuple[Row, ...]:
        """The main rows under the circumstances of the first that has a gamma."""
        return _like_first(self.main, lambda row: row["gamma"], circumstances)


def _like_first(rows: Sequence[Row], value: Callable[[Row], Any], key: Callable[[Row], Any]) -> tuple[Row, ...]:
    first = next((row for row in rows if value(row) is not None), None)
    return () if first is None else tuple(row for row in rows if key(row) == key(first) and value(row) is not None)


def problem_section(measured: Measured) -> Section:
    """Headlines, specification, error over the domain, accuracy and cost, fit, alternatives, published, command."""
    parts: list[tuple[str, Iterable[Block]]] = [
        ("Specification", _specification(measured)),
        ("Error over the domain", _errors(measured)),
        ("Accuracy and cost", _costs(measured)),
        ("The fit", _fit(measured)),
        ("Alternatives", _alternatives(measured)),
        ("Published", _published(measured)),
        ("To reproduce", _commands(measured)),
    ]
    sections = [Section(title, blocks) for title, each in parts if (blocks := tuple(each))]
    return Section(measured.title, (headlines(measured), *sections))


def headlines(measured: Measured) -> Headlines:
    """The numbers at the top, each with what qualifies it."""
    errors, times, fit = measured.with_errors(), measured.with_times(), measured.fit
    items = [
        Headline(
            epsilon_range(errors, measured.leading),
            _error_label(errors, measured.leading),
            _said(errors, error_remarks),
        ),
        Headline(gamma_range(times), _speed_label(times), _said(times, speed_remarks)),
    ]
    if fit and fit["cost"]:
        items.append(Headline(counts(fit["cost"]), "operations a sample"))
    if fit and fit["conditions"]:
        items.append(_kept(fit["conditions"]))
    left_out = sum(row["nonfinite"] or 0 for row in errors)
    if left_out:
        items.append(Headline(count(left_out), "samples not finite", "left out of eps"))
    return Headlines(tuple(items))


def _error_label(rows: Sequence[Row], definition: str) -> Text:
    if not rows:
        return "eps"
    samples = " or ".join(dict.fromkeys(count(row["samples"]) for row in rows))
    _, dtype, sampling = circumstances(rows[0])
    return ("eps ", Code(definition), f", {dtype}, {sampling}, {samples} samples{_settings(rows)}")


def _speed_label(rows: Sequence[Row]) -> Text:
    if not rows:
        return "gamma"
    backend, dtype, _ = circumstances(rows[0])
    return f"gamma on {backend}, {dtype}{_settings(rows)}"


def _settings(rows: Sequence[Row]) -> str:
    settings = list(dict.fromkeys(_label(row) for row in rows))
    if len(settings) > 1:
        return f", over {len(settings)} settings"
    return f", {settings[0]}" if settings[0] else ""


def _said(rows: Sequence[Row], remarks: Callable[[Row], tuple[str, ...]]) -> str:
    """Each remark once, with the number of rows that it is on where that is not all of them."""
    found: dict[str, int] = {}
    for row in rows:
        for remark in remarks(row):
            found[remark] = found.get(remark, 0) + 1
    return "; ".join(text if n == len(rows) else f"{text} ({n} of {len(rows)})" for text, n in found.items())


def _kept(conditions: Sequence[dict[str, Any]]) -> Headline:
    kept = sum(condition["holds"] is True for condition in conditions)
    remark = "" if kept == len(conditions) else "see the table of conditions"
    return Headline(f"{kept} of {len(conditions)}", "conditions kept exactly", remark)


def counts(cost: dict[str, int]) -> str:
    """Operations in words: "1 add, 1 mul, 1 div"."""
    return ", ".join(f"{n} {kind}" for kind, n in cost.items() if n) or "none"


def _specification(measured: Measured) -> Iterator[Block]:
    fit = measured.fit
    if fit is None:
        yield Paragraph("The record holds no derivation of this row.")
        return
    if fit["target"]:
        yield _drawn(fit, fit["target"])
    pairs: list[tuple[str, Text]] = [("domain", f"{fit['variable']} in [{', '.join(fit['domain'])}]")]
    pairs += [("parameter", f"{name} in [{', '.join(ends)}]") for name, ends in fit["parameters"].items()]
    pairs += [("form", _form(fit["form"]))]
    if not fit["target"]:
        pairs.insert(0, ("target", "none: every condition states what it equals"))
    yield Facts(tuple(pairs))
    if fit["conditions"]:
        yield _conditions(fit["conditions"])


def _form(form: dict[str, Any]) -> Text:
    said: list[Any] = []
    for key, value in form.items():
        shown = ", ".join(map(str, value)) if isinstance(value, list) else str(value)
        said += [", " if said else "", f"{key} ", Code(shown)]
    return tuple(said)


def _conditions(conditions: Sequence[dict[str, Any]]) -> Table:
    head = (Column("condition"), Column("at"), Column("equals"), Column("holds"), Column("residual", numeric=True))
    rows = tuple(
        (
            Cell(c["kind"]),
            Cell(Code(c["at"])),
            Cell(Code(c["equals"])),
            Cell(HOLDS[c["holds"]]),
            _residual(c["residual"]),
        )
        for c in conditions
    )
    return Table(head, rows)


def _residual(residual: float | None) -> Cell:
    return Cell(number(residual, 2), residual)


def _drawn(fit: dict[str, Any], text: str) -> Formula:
    return formula(text, (fit["variable"], *fit["parameters"], *(free["name"] for free in fit["free"])))


def _errors(measured: Measured) -> Iterator[Block]:
    """The leading rows' curves; those of peers, of references and under other protocols folded."""
    groups: dict[tuple[str, ...], list[Row]] = {}
    lead = _curve_key(measured, (measured.with_errors() or measured.main)[0])
    for row in measured.rows:
        if row.get("curve"):
            groups.setdefault(_curve_key(measured, row), []).append(row)
    figures = []
    for number_, (key, rows) in enumerate(sorted(groups.items(), key=lambda item: item[0] != lead), 1):
        curves = list({_label(row): _curve(row) for row in reversed(rows)}.values())[::-1]
        figures.append((key, error_figure(f"{measured.number}-error-{number_}", curves, _exact(rows))))
    shown: list[Block] = [figure for key, figure in figures if key == lead]
    folded: list[Block] = [_titled(" · ".join(filter(None, key)), figure) for key, figure in figures if key != lead]
    yield from shown
    if folded:
        yield Details("Of peers, against other exact functions, and under other protocols", tuple(folded))


def _curve_key(measured: Measured, row: Row) -> tuple[str, ...]:
    name = name_of(row)
    return name.method, name.against if measured.has_target else "", row["dtype"], row["sampling"]


def _titled(title: str, figure: Figure) -> Section:
    return Section(title, (figure,))


def _exact(rows: Sequence[Row]) -> str:
    names = list(dict.fromkeys(name_of(row).against for row in rows))
    return names[0] if len(names) == 1 else "each exact function"


def _label(row: Row) -> str:
    return ", ".join(filter(None, (name_of(row).reference, parameters(row))))


def _curve(row: Row) -> ErrorCurve:
    return ErrorCurve(label=_label(row), **row["curve"])


def _costs(measured: Measured) -> Iterator[Block]:
    times = measured.with_times()
    lead = circumstances(times[0]) if times else None
    figures: list[tuple[bool, Figure]] = []
    compared = sorted(measured.compared, key=circumstances)
    for key, rows in groupby(compared, circumstances):
        points = [_point(row, measured.leading) for row in rows if _is_point(row, measured.leading)]
        figure = cost_figure(f"{measured.number}-cost-{len(figures) + 1}", points, measured.leading, _where(key))
        if figure is not None:
            figures.append((key == lead, figure))
    yield from (figure for is_lead, figure in figures if is_lead)
    folded = tuple(figure for is_lead, figure in figures if not is_lead)
    if folded:
        yield Details("On other backends and under other protocols", folded)
    yield rows_table(measured.rows)
    definitions = definitions_table(measured.rows)
    if definitions is not None:
        yield definitions


def _where(key: tuple[str, str, str]) -> str:
    return ", ".join(key)


def _is_point(row: Row, definition: str) -> bool:
    return bool(row["gamma"]) and row["epsilon"].get(definition) is not None


def _point(row: Row, definition: str) -> Point:
    name, epsilon = name_of(row), row["epsilon"][definition]
    said = [
        ", ".join(filter(None, (name.method, _label(row)))),
        f"gamma {gamma(row)}",
        f"{definition} {number(epsilon)}",
    ]
    label = "\n".join([*said, *error_remarks(row), *speed_remarks(row)])
    return Point(name.method, label, row["gamma"], row["gamma_low"], row["gamma_high"], epsilon)


def _fit(measured: Measured) -> Iterator[Block]:
    fit = measured.fit
    if fit is None:
        return
    if fit["expression"] is None:
        yield Paragraph(("No formula: ", STATUS.get(fit["status"], fit["status"]), "."))
    else:
        yield _drawn(fit, fit["expression"])
    yield Details("How it was derived", tuple(_derivation(fit)))


def _derivation(fit: dict[str, Any]) -> Iterator[Block]:
    pairs: list[tuple[str, Text]] = [("status", STATUS.get(fit["status"], fit["status"])), ("route", fit["route"])]
    if "support" in fit["form"]:
        pairs.append(("support", f"[{', '.join(fit['form']['support'])}], {fit['form'].get('outside', '0')} outside"))
    pairs += [("free", f"{' < '.join((f['range'][0], f['name'], f['range'][1]))}") for f in fit["free"]]
    pairs += [("choice", f"{name} = {value}") for name, value in fit["choice"].items()]
    if fit["cost"]:
        pairs.append(("cost", f"{counts(fit['cost'])} a sample, without the work on parameters alone"))
    yield Facts(tuple(pairs))
    if fit["candidates"][1:]:
        yield Paragraph("Other answers to the same conditions:")
        yield Items(tuple(Code(text) for text in fit["candidates"][1:]))
    if fit["rejected"]:
        yield _rejected(fit["rejected"])


def _rejected(rejected: Sequence[dict[str, Any]]) -> Table:
    head = (Column("rejected"), Column("reason"))
    return Table(head, tuple((Cell(Code(each["expression"] or "")), Cell(each["reason"])) for each in rejected))


def _alternatives(measured: Measured) -> Iterator[Block]:
    peers = [row for row in measured.rows if name_of(row).peer]
    if not peers:
        return
    lead = circumstances((measured.with_times() or measured.main)[0])
    rows = [row for row in measured.compared if circumstances(row) == lead]
    yield rows_table(rows, (measured.leading, measured.leading.partition("_")[0] + "_max"))
    formulas = {name_of(row).peer: row["fit"]["expression"] for row in peers if row.get("fit")}
    own = (measured.fit or {}).get("expression")
    pairs = tuple((peer, Code(text)) for peer, text in formulas.items() if text and text != own)
    if pairs:
        yield Details("Their formulas", (Facts(pairs),))


def _published(measured: Measured) -> Iterator[Block]:
    published = next((row["published"] for row in measured.rows if row.get("published")), None)
    if published is None:
        return
    fit = measured.fit
    yield _drawn(fit, published["expression"]) if fit else Formula(published["expression"])
    equal = {True: "equal to the fit, symbolically", False: "NOT equal to the fit", None: "not compared with the fit"}
    pairs: list[tuple[str, Text]] = [
        ("source", f"{published['source']}, {published['place']}"),
        ("formula", equal[published["equal"]]),
        ("printed eps", f"{number(published['epsilon'])}; measured: {_measured_epsilon(measured)}"),
        ("printed gamma", f"{number(published['gamma'])}; measured: {gamma_range(measured.with_times())}"),
    ]
    yield Facts(tuple(pairs))


def _measured_epsilon(measured: Measured) -> str:
    return f"{epsilon_range(measured.with_errors(), measured.leading)} ({measured.leading})"


def _commands(measured: Measured) -> Iterator[Block]:
    commands = dict.fromkeys(row["command"] for row in measured.rows if row.get("command"))
    if commands:
        yield Verbatim("\n".join(commands))
