"""Writing of problem files: Problem -> tables -> TOML text."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from ratfit._condition import AbstractCondition, Derivative, Equation, Integral, Limit
from ratfit._form import AbstractForm, Form, Power, Rational
from ratfit._problem import Problem, Reference


def to_tables(problem: Problem) -> dict[str, Any]:
    """The problem as the tables of a problem file, `let` put in; expressions are strings."""
    tables: dict[str, Any] = {"name": problem.name}
    if problem.target is not None:
        tables["target"] = str(problem.target.expression)
    tables |= {"variable": str(problem.variable), "domain": [str(end) for end in problem.domain]}
    if problem.parameters:
        tables["parameters"] = {p.name: [str(p.low), str(p.high)] for p in problem.parameters}
    tables["form"] = form_table(problem.form)
    if problem.choice:
        tables["choice"] = {n: str(v) for n, v in problem.choice.items()}
    if problem.references:
        tables["reference"] = [_reference_table(r) for r in problem.references]
    tables["condition"] = [condition_table(c) for c in problem.conditions]
    return tables


def at_parameters(tables: dict[str, Any], values: Mapping[str, str]) -> dict[str, Any]:
    """The tables with numbers for some parameters: these become abbreviations."""
    ranges = {name: range_ for name, range_ in tables.get("parameters", {}).items() if name not in values}
    return {**tables, "parameters": ranges, "let": {**tables.get("let", {}), **values}}


def form_table(form: AbstractForm) -> dict[str, Any]:
    """The [form] table of a form, without the keys that it leaves at their defaults."""
    table: dict[str, Any]
    if isinstance(form, Rational):
        table = {"numerator": form.numerator, "denominator": form.denominator}
        table |= {"parity": form.parity} if form.parity else {}
    elif isinstance(form, Power):
        table = {"power": str(form.base), "exponent": form.exponent}
    elif isinstance(form, Form):
        table = {"expression": str(form.expression), "unknowns": [str(u) for u in form.unknowns]}
    else:
        raise TypeError(f"{type(form).__name__} has no table of its own")
    table |= {"factor": str(form.factor)} if form.factor != 1 else {}
    table |= {"of": str(form.of)} if form.of is not None else {}
    if form.support is not None:
        table |= {"support": [str(end) for end in form.support], "outside": str(form.outside)}
    return table


def _reference_table(reference: Reference) -> dict[str, Any]:
    table: dict[str, Any] = {"name": reference.name, "target": str(reference.expression), "source": reference.source}
    return table | (
        {"parameters": {str(s): str(v) for s, v in reference.parameters.items()}} if reference.parameters else {}
    )


def condition_table(condition: AbstractCondition) -> dict[str, Any]:
    """The [[condition]] table of a condition, without the keys that it leaves at their defaults."""
    table: dict[str, Any] = {"kind": condition.kind}
    if isinstance(condition, Integral):
        table["weight"] = str(condition.weight)
        table |= {"over": [str(end) for end in condition.over]} if condition.over else {}
    else:
        table["at"] = condition.place
    if isinstance(condition, Limit):
        table |= {"scale": str(condition.scale)} if condition.scale != 1 else {}
        table |= {"minus": str(condition.minus)} if condition.minus != 0 else {}
    if isinstance(condition, Equation):
        table["residual"] = str(condition.residual)
    if isinstance(condition, (Derivative, Equation)):
        table["order"] = condition.order
    return table | ({"equals": str(condition.equals)} if condition.equals is not None else {})


def write_toml(tables: Mapping[str, Any]) -> str:
    """The text of a problem file. The standard library reads TOML only; ours holds strings, whole numbers and lists."""
    plain = {k: v for k, v in tables.items() if not _is_table(v)}
    lines = [f"{key} = {json.dumps(value)}" for key, value in plain.items()]
    for key, value in tables.items():
        if isinstance(value, dict):
            lines += ["", f"[{key}]", *(f"{k} = {json.dumps(v)}" for k, v in value.items())]
        elif _is_table(value):
            for table in value:
                lines += ["", f"[[{key}]]", *(f"{k} = {_inline(v)}" for k, v in table.items())]
    return "\n".join(lines) + "\n"


def _is_table(value: Any) -> bool:
    return isinstance(value, dict) or (isinstance(value, list) and bool(value) and isinstance(value[0], dict))


def _inline(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k} = {json.dumps(v)}" for k, v in value.items()) + "}"
    return json.dumps(value)
