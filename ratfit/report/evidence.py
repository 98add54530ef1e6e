"""What was measured: error over the domain, accuracy against cost, alternatives."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from ratfit._record import Row
from ratfit.report.cost_figure import Point, cost_figure
from ratfit.report.document import Block, Code, Details, Facts, Figure, Section
from ratfit.report.error_figure import ErrorCurve, error_figure
from ratfit.report.measured import circumstances, error_remarks, gamma, label, name_of, number, speed_remarks
from ratfit.report.problem_rows import ProblemRows
from ratfit.report.tables import definitions_table, rows_table


def errors(problem: ProblemRows) -> Iterator[Block]:
    """The leading rows' curves; those of peers, of references and under other protocols folded."""
    groups: dict[tuple[str, ...], list[Row]] = {}
    lead = _curve_key(problem, (problem.with_errors() or problem.main)[0])
    for row in problem.rows:
        if row.get("curve"):
            groups.setdefault(_curve_key(problem, row), []).append(row)
    figures = []
    for number_, (key, rows) in enumerate(sorted(groups.items(), key=lambda item: item[0] != lead), 1):
        curves = list({label(row): _curve(row) for row in reversed(rows)}.values())[::-1]
        figures.append((key, error_figure(f"{problem.number}-error-{number_}", curves, _exact(rows))))
    shown: list[Block] = [figure for key, figure in figures if key == lead]
    folded: list[Block] = [_titled(" · ".join(filter(None, key)), figure) for key, figure in figures if key != lead]
    yield from shown
    if folded:
        yield Details("Of peers, against other exact functions, and under other protocols", tuple(folded))


def _curve_key(problem: ProblemRows, row: Row) -> tuple[str, ...]:
    name = name_of(row)
    return name.method, name.against if problem.has_target else "", row["dtype"], row["sampling"]


def _titled(title: str, figure: Figure) -> Section:
    return Section(title, (figure,))


def _exact(rows: Sequence[Row]) -> str:
    names = list(dict.fromkeys(name_of(row).against for row in rows))
    return names[0] if len(names) == 1 else "each exact function"


def _curve(row: Row) -> ErrorCurve:
    curve = row["curve"]
    bins = {key: curve[key] for key in ("variable", "edges", "exact", "fit", "bias", "absolute_max")}
    return ErrorCurve(label=label(row), **bins)


def costs(problem: ProblemRows) -> Iterator[Block]:
    times = problem.with_times()
    lead = circumstances(times[0]) if times else None
    figures: list[tuple[bool, Figure]] = []
    compared = sorted(problem.compared, key=circumstances)
    for key, rows in groupby(compared, circumstances):
        points = [_point(row, problem.leading) for row in rows if _is_point(row, problem.leading)]
        figure = cost_figure(f"{problem.number}-cost-{len(figures) + 1}", points, problem.leading, _where(key))
        if figure is not None:
            figures.append((key == lead, figure))
    yield from (figure for is_lead, figure in figures if is_lead)
    folded = tuple(figure for is_lead, figure in figures if not is_lead)
    if folded:
        yield Details("On other backends and under other protocols", folded)
    shown = times or problem.with_errors() or problem.main
    yield rows_table(shown)
    if len(shown) < len(problem.rows):
        yield Details(f"All {len(problem.rows)} rows", (rows_table(problem.rows),))
    definitions = definitions_table(problem.rows)
    if definitions is not None:
        yield definitions


def _where(key: tuple[str, str, str]) -> str:
    return ", ".join(filter(None, key))


def _is_point(row: Row, definition: str) -> bool:
    return row["gamma"] is not None and row["epsilon"].get(definition) is not None


def _point(row: Row, definition: str) -> Point:
    name, epsilon = name_of(row), row["epsilon"][definition]
    said = [
        ", ".join(filter(None, (name.method, label(row)))),
        f"gamma {gamma(row)}",
        f"{definition} {number(epsilon)}",
    ]
    told = "\n".join([*said, *error_remarks(row), *speed_remarks(row)])
    return Point(name.method, told, row["gamma"], row["gamma_low"], row["gamma_high"], epsilon)


def alternatives(problem: ProblemRows) -> Iterator[Block]:
    peers = [row for row in problem.rows if name_of(row).peer]
    if not peers:
        return
    lead = circumstances((problem.with_times() or problem.main)[0])
    rows = [row for row in problem.compared if circumstances(row) == lead]
    yield rows_table(rows, (problem.leading, problem.leading.partition("_")[0] + "_max"))
    formulas = {name_of(row).peer: row["fit"]["expression"] for row in peers if row.get("fit")}
    own = (problem.fit or {}).get("expression")
    pairs = tuple((peer, Code(text)) for peer, text in formulas.items() if text and text != own)
    if pairs:
        yield Details("Their formulas", (Facts(pairs),))
