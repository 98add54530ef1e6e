"""Reading of problem files: TOML text -> Problem, every key of the contract and no other."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import sympy as sp

from ratfit._condition import JET_NAMES, AbstractCondition, Derivative, Equation, Integral, Limit, Value
from ratfit._form import AbstractForm, Form, Power, Rational
from ratfit._parse import RatfitError, check_name, nearest, parse_expression
from ratfit._problem import Problem, Reference
from ratfit._target import Parameter, Target, check_domain, parameter

MAX_BYTES = 1 << 20

CONDITIONS: Mapping[str, type[AbstractCondition]] = {c.kind: c for c in (Value, Derivative, Limit, Integral, Equation)}

KEYS = {
    "problem": (
        "name",
        "target",
        "variable",
        "domain",
        "let",
        "parameters",
        "form",
        "choice",
        "reference",
        "condition",
    ),
    "form": (
        *("numerator", "denominator", "parity", "expression", "unknowns", "power", "exponent"),
        *("factor", "of", "support", "outside"),
    ),
    "reference": ("name", "target", "source", "parameters"),
    "value": ("kind", "at", "equals"),
    "derivative": ("kind", "at", "order", "equals"),
    "limit": ("kind", "at", "scale", "minus", "equals"),
    "integral": ("kind", "weight", "over", "equals"),
    "equation": ("kind", "residual", "at", "order"),
}


def read_problem(path: str | Path) -> Problem:
    """Reads a problem file. Raises RatfitError, with the remedy, for a file or a content that cannot be used."""
    tables = read_toml(Path(path))
    try:
        return problem_of(tables, Path(path).stem)
    except RatfitError as error:
        raise RatfitError(f"{path}: {error}") from None


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a TOML file of at most 1 MiB; RatfitError names the line that is malformed."""
    if not path.exists():
        raise RatfitError(f"{path}: there is no such file")
    if not path.is_file():
        raise RatfitError(
            f"{path}: this is a directory, not a problem file" if path.is_dir() else f"{path}: not a file"
        )
    try:
        with path.open("rb") as stream:
            data = stream.read(MAX_BYTES + 1)
    except OSError as error:
        raise RatfitError(f"{path}: cannot be read: {error.strerror}") from None
    if len(data) > MAX_BYTES:
        raise RatfitError(f"{path}: larger than 1 MiB; a problem file is a page of text")
    try:
        return toml_tables(data.decode("utf-8"), str(path))
    except UnicodeDecodeError:
        raise RatfitError(f"{path}: not a text in UTF-8") from None


def toml_tables(text: str, what: str) -> dict[str, Any]:
    """Parses TOML text; RatfitError shows the malformed line."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        number = _line_number(str(error))
        shown = (
            f": {text.splitlines()[number - 1].strip()[:60]!r}" if 0 < number <= text.count("\n") + 1 and text else ""
        )
        raise RatfitError(f"{what}: malformed TOML: {error}{shown}") from None
    except RecursionError:
        raise RatfitError(f"{what}: malformed TOML: nested too deeply") from None


def _line_number(message: str) -> int:
    _, _, tail = message.partition("line ")
    digits = tail.split(",")[0].rstrip(")")
    return int(digits) if digits.isdigit() else 0


def problem_of(tables: Mapping[str, Any], name: str = "problem") -> Problem:
    """The problem that the tables of a problem file state."""
    _check_keys(tables, "problem", "the file")
    for key in ("variable", "domain", "form", "condition"):
        if key not in tables:
            raise RatfitError(f"the key {key!r} is missing; `ratfit init FILE` writes a file to start from")
    parameters = _parameters_of(_table(tables, "parameters"))
    names: dict[str, sp.Expr] = {p.name: p for p in parameters}
    domain = check_domain(_pair(tables["domain"], "domain", names))
    variable = _variable_of(tables["variable"], domain)
    _add_name(names, variable.name, variable)
    reference_tables = _tables(tables, "reference")
    own = _reference_names(reference_tables, names)
    for let, text in _table(tables, "let").items():
        _add_name(names, check_name(let, "let"), _expression(text, names | own, f"let {let}"))
    target = None
    if "target" in tables:
        target = Target(_expression(tables["target"], names, "target"), variable, domain)
    return Problem(
        name=_string(tables.get("name", name), "name"),
        target=target,
        variable=variable,
        domain=domain,
        parameters={p: (p.low, p.high) for p in parameters},
        form=_form_of(_table(tables, "form"), names),
        conditions=tuple(
            condition_of(t, names, f"condition {i}") for i, t in enumerate(_tables(tables, "condition"), 1)
        ),
        choice={
            n: _expression(v, {p.name: p for p in parameters}, f"choice {n}")
            for n, v in _table(tables, "choice").items()
        },
        references=tuple(_reference_of(t, names, own) for t in reference_tables),
    )


def condition_of(table: Mapping[str, Any], names: Mapping[str, sp.Expr], what: str) -> AbstractCondition:
    """One kernel condition from its table, as in {kind = "derivative", at = "0", order = 2}."""
    if "kind" not in table:
        raise RatfitError(f"{what}: the key kind is missing; known kinds: {', '.join(CONDITIONS)}")
    kind = str(table["kind"])
    if kind not in CONDITIONS:
        known = ", ".join(CONDITIONS)
        raise RatfitError(f"{what}: unknown kind {kind!r}{nearest(kind, CONDITIONS)}; known: {known}")
    _check_keys(table, kind, what)
    what = f"{what} ({kind})"
    arguments: dict[str, Any] = {}
    for key in ("at", "equals", "weight", "scale", "minus"):
        if key in table:
            arguments[key] = _expression(table[key], names, f"{what}, {key}")
    if "over" in table:
        arguments["over"] = _pair(table["over"], f"{what}, over", names)
    if "order" in table:
        arguments["order"] = table["order"]
    if kind == "equation":
        arguments["residual"] = _residual(table, names, what)
    if kind != "integral" and "at" not in arguments:
        raise RatfitError(f'{what}: the key "at" is missing, the place of the condition')
    return CONDITIONS[kind](**arguments)


def _residual(table: Mapping[str, Any], names: Mapping[str, sp.Expr], what: str) -> sp.Expr:
    """The residual of a differential equation, written in y, y', y'', ... and the names of the problem."""
    if "residual" not in table:
        raise RatfitError(f'{what}: the key "residual" is missing, as in residual = "y\'\' + y"')
    if "y" in names:
        raise RatfitError(f"{what}: y is the unknown function in a residual; rename what is called y in the problem")
    return _expression(table["residual"], {**names, **JET_NAMES}, f"{what}, residual")


def _form_of(table: Mapping[str, Any], names: Mapping[str, sp.Expr]) -> AbstractForm:
    _check_keys(table, "form", "form")
    common: dict[str, Any] = {
        k: _expression(table[k], names, f"form, {k}") for k in ("factor", "of", "outside") if k in table
    }
    if "support" in table:
        common["support"] = _pair(table["support"], "form, support", names)
    shapes = [k for k in ("numerator", "expression", "power") if k in table]
    if len(shapes) != 1:
        raise RatfitError(
            "form: write one of numerator (with denominator), expression (with unknowns) or power (with exponent)"
        )
    mates = {"numerator": ("denominator", "parity"), "expression": ("unknowns",), "power": ("exponent",)}
    for key in table:
        if any(key in keys for shape, keys in mates.items() if shape != shapes[0]):
            raise RatfitError(f"form: {key} does not go with {shapes[0]}; leave it out")
    if "numerator" in table:
        return Rational(table["numerator"], table.get("denominator", 0), parity=table.get("parity"), **common)
    if "power" in table:
        base = _expression(table["power"], names, "form, power")
        return Power(base, _string(table.get("exponent", "n"), "form, exponent"), **common)
    unknowns = table.get("unknowns", [])
    if not isinstance(unknowns, list) or not all(isinstance(u, str) for u in unknowns):
        raise RatfitError('form: unknowns must be a list of names, as in ["a", "b"]')
    symbols = {check_name(u, "form, unknowns"): sp.Symbol(u, real=True) for u in unknowns}
    for name in symbols:
        if name in names:
            raise RatfitError(f"form: the unknown {name} is already the name of something else; rename it")
    return Form(
        _expression(table["expression"], {**names, **symbols}, "form, expression"), tuple(symbols.values()), **common
    )


def _variable_of(name: Any, domain: tuple[sp.Expr, sp.Expr]) -> sp.Symbol:
    """The variable; on a domain without negative numbers its square's root is itself, which keeps formulas short."""
    name = check_name(_string(name, "variable"), "variable")
    return sp.Symbol(name, nonnegative=True) if domain[0].is_nonnegative else sp.Symbol(name, real=True)


def _parameters_of(table: Mapping[str, Any]) -> tuple[Parameter, ...]:
    for name, range_ in table.items():
        if not isinstance(range_, list) or len(range_) != 2:
            raise RatfitError(f'parameter {name}: write its range as ["low", "high"]')
    return tuple(
        parameter(n, *(_expression(end, {}, f"parameter {n}, range") for end in range_)) for n, range_ in table.items()
    )


def _reference_names(tables: Iterable[Mapping[str, Any]], names: Mapping[str, sp.Expr]) -> dict[str, sp.Symbol]:
    """The symbols that references declare for themselves by giving them values."""
    given = {n for t in tables for n in _table(t, "parameters")}
    return {n: sp.Symbol(check_name(n, "reference, parameters"), real=True) for n in sorted(given - set(names))}


def _reference_of(table: Mapping[str, Any], names: Mapping[str, sp.Expr], own: Mapping[str, sp.Symbol]) -> Reference:
    _check_keys(table, "reference", "reference")
    if "name" not in table or "target" not in table:
        raise RatfitError("reference: the keys name and target are needed")
    name = _string(table["name"], "reference, name")
    everything = {**own, **names}
    values = {
        everything[n]: _expression(v, {}, f"reference {name}, {n}") for n, v in _table(table, "parameters").items()
    }
    for symbol, value in values.items():
        if isinstance(symbol, Parameter) and not symbol.low <= value <= symbol.high:
            raise RatfitError(
                f"reference {name}: {symbol} = {value} is outside its range [{symbol.low}, {symbol.high}]"
            )
    expression = _expression(table["target"], everything, f"reference {name}, target")
    return Reference(name, expression, _string(table.get("source", ""), f"reference {name}, source"), values)


def _check_keys(table: Mapping[str, Any], of: str, what: str) -> None:
    for key in table:
        if key not in KEYS[of]:
            raise RatfitError(f"{what}: unknown key {key!r}{nearest(key, KEYS[of])}; known: {', '.join(KEYS[of])}")


def _add_name(names: dict[str, sp.Expr], name: str, expression: sp.Expr) -> None:
    if name in names:
        raise RatfitError(f"the name {name} stands for two things; rename one")
    names[name] = expression


def _table(tables: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    value = tables.get(key, {})
    if not isinstance(value, dict):
        raise RatfitError(f"{key}: write it as a table, [{key}]")
    return value


def _tables(tables: Mapping[str, Any], key: str) -> list[Mapping[str, Any]]:
    value = tables.get(key, [])
    if not isinstance(value, list) or not all(isinstance(t, dict) for t in value):
        raise RatfitError(f"{key}: write each as a table of its own, [[{key}]]")
    return value


def _string(value: Any, what: str) -> str:
    if not isinstance(value, str):
        raise RatfitError(f"{what}: a text in quotes is needed, not {value!r}")
    return value


def _expression(value: Any, names: Mapping[str, sp.Expr], what: str) -> sp.Expr:
    if isinstance(value, bool) or not isinstance(value, (str, int, float)):
        raise RatfitError(f'{what}: an expression in quotes is needed, as in "pi/2", not {value!r}')
    return parse_expression(str(value), names, what)


def _pair(value: Any, what: str, names: Mapping[str, sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
    if not isinstance(value, list) or len(value) != 2:
        raise RatfitError(f'{what}: write two ends, as in ["0", "1"]')
    return _expression(value[0], names, f"{what}, low"), _expression(value[1], names, f"{what}, high")
