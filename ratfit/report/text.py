"""A fit as text that a person likes to read."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Any

import sympy as sp

from ratfit._condition import describe
from ratfit._field import is_zero
from ratfit._fit import Fit
from ratfit._parse import shortened
from ratfit._problem import Problem
from ratfit._problem_text import form_table
from ratfit._solver import Table
from ratfit.gallery import Card
from ratfit.report.unicode import lines as formula_lines

WIDTH = 110
DRAWN = 10
"""Digits of a decimal in a drawn formula and in a table; the fit itself has all that are known."""


def fit_text(fit: Fit, card: Card | None = None, *, unicode: bool = True) -> str:
    """The whole fit: formula, conditions ticked off, what was rejected and why, the cost, the published formula."""
    lines = [f"{fit.problem.name}: {_headline(fit)}", ""]
    if fit.problem.target is not None:
        lines += [f"  target      {fit.problem.target.expression}"]
    lines += [f"  domain      {fit.problem.variable} in [{fit.problem.domain[0]}, {fit.problem.domain[1]}]"]
    if fit.problem.parameters:
        ranges = ", ".join(f"{p} in [{p.low}, {p.high}]" for p in fit.problem.parameters)
        lines += [f"  parameters  {ranges}"]
    if fit.equations:
        lines += ["", "  equations", *(f"    {e}" for e in fit.equations)]
    if fit.expression is not None:
        lines += _formula_lines(fit, unicode)
    lines += _candidate_lines(fit)
    if fit.conditions:
        lines += ["", "  conditions", *(f"    {c.line(unicode=unicode, width=28)}" for c in fit.conditions)]
    if fit.rejected:
        lines += [
            "",
            "  rejected",
            *(f"    {shortened(str(c.expression), 400)}\n      {c.reason}" for c in fit.rejected),
        ]
    if fit.reasons and not fit.candidates:
        lines += ["", "  why", *(f"    {reason}" for reason in fit.reasons)]
    if fit.expression is not None:
        lines += ["", f"  cost        {_cost_text(fit)}"]
    if card is not None:
        lines += _card_lines(fit, card)
    return "\n".join(lines)


def _headline(fit: Fit) -> str:
    if fit.status == "rejected" and not fit.rejected:
        return f"no answer ({fit.route} route)"
    if fit.expression is None and fit.status in ("family", "several"):
        return f"not unique ({fit.route} route)"
    if fit.route == "nonlinear" and fit.expression is not None:
        found = "one answer" if fit.status == "unique" else f"{len(fit.candidates)} answers"
        return f"{found} found (nonlinear route: all found, which need not be all there are)"
    words = {
        "unique": "one answer",
        "family": f"a family, {', '.join(map(str, fit.free))} free",
        "several": f"{len(fit.candidates)} answers",
        "inconsistent": "no answer, the conditions clash",
        "rejected": "no answer, every candidate was rejected",
        "timeout": "no answer in time",
    }
    return f"{words[fit.status]} ({fit.route} route)"


def _formula_lines(fit: Fit, unicode: bool) -> list[str]:
    assert fit.expression is not None
    drawn = [f"    {line}" for line in formula_lines(rounded(fit.expression))] if unicode else []
    if any(len(line) > WIDTH for line in drawn):
        drawn = []  # a terminal would break the lines and leave no fraction to see
    table = fit.candidates[0].table
    text = str(fit.expression)
    if table is not None:
        names = ", ".join(u.name for u in table.unknowns)
        lines = ["", f"  fit         {fit.problem.form.factor * table.numerator / table.denominator}"]
        text = f"the same in numbers, {names} interpolated: --format json ({len(text)} characters)"
        lines += [f"              {text}"]
    else:
        lines = ["", *drawn, *([""] if drawn else []), f"  fit         {text}"]
    if fit.candidates[0].certificate:
        lines += [f"  proof       {fit.candidates[0].certificate}"]
    if fit.problem.form.support is not None:
        low, high = fit.problem.form.support
        lines.append(f"  support     [{low}, {high}], {fit.problem.form.outside} outside")
    for symbol, (low, high) in fit.free.items():
        lines.append(f"  free        {symbol}, {low} < {symbol} < {high}")
    for symbol, value in fit.choice.items():
        lines.append(f"  choice      {symbol} = {value}: {fit.chosen}")
    return lines


def rounded(expression: sp.Expr) -> sp.Expr:
    """The expression with its decimals cut to DRAWN digits, for the eye."""
    return expression.xreplace({f: sp.Float(f, DRAWN) for f in expression.atoms(sp.Float)})


def _candidate_lines(fit: Fit) -> list[str]:
    lines = [] if fit.expression is not None else [f"  found       {c.expression}" for c in fit.candidates[:1]]
    for candidate in fit.candidates[1:]:
        lines.append(f"  or          {candidate.expression}")
        lines += [f"              {candidate.certificate}"] if candidate.certificate else []
    return lines + [line for c in fit.candidates if c.table is not None for line in _table_lines(c.table)]


def _table_lines(table: Table) -> list[str]:
    """Coefficients at the nodes of the parameters, rounded for the eye."""
    head = [*(p.name for p in table.parameters), *(u.name for u in table.unknowns)]
    rows = [[sp.sstr(sp.N(v, DRAWN)) for v in (*node, *row)] for node, row in zip(table.nodes, table.rows, strict=True)]
    return ["", "  table", *(f"    {line}" for line in aligned([head, *rows]))]


def _cost_text(fit: Fit) -> str:
    counted = [f"{count} {name}" for name, count in fit.cost.as_dict().items() if count]
    return f"{', '.join(counted) or 'nothing'} a sample (work on parameters alone not counted)"


def _card_lines(fit: Fit, card: Card) -> list[str]:
    compared = agreement(fit, card) if card.printed and fit.expression is not None else ""
    lines = _published(card, compared) if card.printed or card.note else []
    return ["", *(f"  {line}" for line in lines)] if lines else []


def _published(card: Card, compared: str = "") -> list[str]:
    """What was published of a card, where, how it compares, and what is to be noted."""
    where = f"{card.source}, {card.place}"
    told = [f"published   {card.printed}", f"{'':12}{where}"] if card.printed else [f"source      {where}"]
    told += [f"{'':12}{compared}"] if compared else []
    noted = textwrap.wrap(card.note, 100)
    return told + [f"{'note' if k == 0 else '':12}{line}" for k, line in enumerate(noted)]


def agreement(fit: Fit, card: Card) -> str:
    """Whether the derived expression equals the published one, symbolically."""
    return "symbolically equal" if equals_published(fit, card) else "NOT equal to what was derived"


def recorded(fit: Fit) -> dict[str, Any]:
    """A fit as a row has it: the object of `derive --format json`, its conditions with `words` to each."""
    made = fit.to_json_object()
    pairs = zip(made["conditions"], fit.conditions, strict=True)
    return made | {"conditions": [each | {"words": describe(checked.condition)} for each, checked in pairs]}


def published_object(fit: Fit, card: Card | None) -> dict[str, Any] | None:
    """What was published of a problem, and whether the fit is that, as a record holds it."""
    if card is None or not card.printed:
        return None
    about = {"place": card.place, "source": card.source, "expression": card.printed}
    return {**about, "equal": equals_published(fit, card), "epsilon": card.epsilon, "gamma": card.gamma}


def equals_published(fit: Fit, card: Card) -> bool:
    """Whether some accepted candidate is the published formula, as functions of variable, parameters and free names."""
    if card.published is None:
        return False
    for candidate in fit.candidates:
        by_name = {s.name: s for s in candidate.expression.free_symbols}
        published = card.published.xreplace({s: by_name.get(s.name, s) for s in card.published.free_symbols})
        if is_zero(candidate.expression - published):
            return True
    return False


def gallery_text(shown: Sequence[Card]) -> str:
    """The list of problems, a line each."""
    rows = [(c.name, " ".join(c.aliases), c.title, f"{c.source}, {c.place}") for c in shown]
    return "\n".join(aligned(rows))


def aligned(table: Sequence[Sequence[str]]) -> list[str]:
    """The rows of a table as lines with columns below each other."""
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    return ["  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True)).rstrip() for row in table]


def card_text(card: Card) -> str:
    """One card: the problem as it is understood, and what was published."""
    return "\n".join([f"{card.name}: {card.title}", "", problem_text(card.problem), "", *_published(card)])


def problem_text(problem: Problem) -> str:
    """A problem as it was understood."""
    x = problem.variable
    lines = [f"target      {problem.target.expression if problem.target else 'none: every condition states equals'}"]
    lines += [f"domain      {x} in [{problem.domain[0]}, {problem.domain[1]}]"]
    lines += [f"parameter   {p} in [{p.low}, {p.high}]" for p in problem.parameters]
    lines += [f"form        {', '.join(f'{k} = {v}' for k, v in form_table(problem.form).items())}"]
    for condition in problem.conditions:
        own = "what the target does" if condition.needs_target else 0
        demand = own if condition.equals is None else condition.equals
        lines.append(f"condition   {describe(condition)} = {demand}")
    lines += [f"choice      {name} = {value}" for name, value in problem.choice.items()]
    lines += [f"reference   {r.name} = {r.expression}" for r in problem.references]
    return "\n".join(lines)
