"""A problem from words on the command line: the tables of a problem file, written as options."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from ratfit._parse import RESERVED, RatfitError, nearest
from ratfit._problem import Problem
from ratfit._problem_file import problem_of
from ratfit._target import Target

_NAME = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
"""A name in an expression; the e of 1e3 is none."""

UNNAMED = "expression"
"""The name of every problem that the words of a command state."""


@dataclass(frozen=True)
class Words:
    """The options of `ratfit derive` that state a problem, as typed."""

    on: tuple[str, str] | None = None
    form: str | None = None
    unknowns: str | None = None
    power: str | None = None
    value: Sequence[str] = ()
    derivative: Sequence[str] = ()
    limit: Sequence[str] = ()
    integral: Sequence[str] = ()
    equation: Sequence[str] = ()
    variable: str | None = None
    parameter: Sequence[str] = ()
    let: Sequence[str] = ()
    factor: str | None = None
    of: str | None = None
    parity: str | None = None
    support: tuple[str, str] | None = None

    def given(self) -> list[str]:
        """The names of the options that were used."""
        return [name for name, value in vars(self).items() if value]


def problem_of_words(target: str, words: Words) -> Problem:
    """The problem that an expression and options state. Raises RatfitError with the remedy."""
    if words.on is None:
        raise RatfitError(f"{target!r} is read as an expression: give its domain, as in --on 0 pi/2")
    parameters = dict(_parameter(text) for text in words.parameter)
    lets = dict(_pair(text, "--let", "h=v**2") for text in words.let)
    tables: dict[str, Any] = {
        "name": UNNAMED,
        "target": target,
        "variable": words.variable or _variable(target, {*parameters, *lets}),
        "domain": list(words.on),
        "let": lets,
        "parameters": parameters,
        "form": _form(words),
        "condition": [
            *(_condition("value", text) for text in words.value),
            *(_condition("derivative", text) for text in words.derivative),
            *(_condition("limit", text) for text in words.limit),
            *(_condition("integral", text) for text in words.integral),
            *(_condition("equation", text) for text in words.equation),
        ],
    }
    return problem_of(tables, UNNAMED)


def target_of_words(target: str, words: Words) -> Target:
    """The target alone: a problem wants a form and a condition, and a constant with its own integral is always one."""
    problem = problem_of_words(target, replace(words, form="0", integral=("weight=1",)))
    assert problem.target is not None
    return problem.target


def _variable(target: str, declared: set[str]) -> str:
    """The one name in the expression that nobody declared; x where there is none."""
    if re.search(r"[^\w\s+\-*/().,]|__|\.\s*[A-Za-z_]", target):
        return "x"  # no formula: the grammar says what is wrong with it
    names = set(re.findall(r"[A-Za-z_]\w*", target[:2000])) - RESERVED - declared
    if len(names) > 1 and "x" not in names:
        raise RatfitError(f"which of {', '.join(sorted(names))} is the variable? say so, as in --variable {min(names)}")
    return names.pop() if len(names) == 1 else "x"


def _form(words: Words) -> dict[str, Any]:
    form: dict[str, Any] = {k: v for k in ("factor", "of", "parity") if (v := getattr(words, k)) is not None}
    if words.support:
        form["support"] = list(words.support)
    if (words.form is None) == (words.power is None):
        raise RatfitError("give the form: --form 2/1 (degrees), --form EXPRESSION --unknowns a,b, or --power '1 - u'")
    if words.power is not None:
        place, settings = _settings(words.power, "--power", ("exponent",))
        return form | {"power": place} | settings
    if words.unknowns is not None:
        return form | {"expression": words.form, "unknowns": [u.strip() for u in words.unknowns.split(",")]}
    match = re.fullmatch(r"(\d{1,4})(?:/(\d{1,4}))?", words.form.strip())  # type: ignore[union-attr]
    if match is None:
        raise RatfitError(
            f"--form {words.form}: write degrees as 2/1 or 3, or an expression together with --unknowns a,b"
        )
    return form | {"numerator": int(match[1]), "denominator": int(match[2] or 0)}


_SETTINGS = {
    "value": ("equals",),
    "derivative": ("order", "equals"),
    "limit": ("scale", "minus", "equals"),
    "integral": ("weight", "over", "equals"),
    "equation": ("at", "order"),
}


def _condition(kind: str, text: str) -> dict[str, Any]:
    if kind == "equation" and re.search(r"=\s*0\s*(;|$)", text.partition(";")[0]):
        raise RatfitError(f"--equation {text}: write the residual alone, without = 0; it is what vanishes")
    place, settings = _settings(text, f"--{kind}", _SETTINGS[kind])
    table: dict[str, Any] = {"kind": kind, **settings}
    if kind == "equation":
        table["residual"] = place
    elif kind != "integral":
        table["at"] = place
    elif place:
        table.setdefault("weight", place)
    if "over" in table:
        table["over"] = table["over"].split(",")
    if "order" in table:
        if not re.fullmatch(r"\d{1,4}", table["order"].strip()):
            raise RatfitError(f"--{kind} {text}: the order must be a whole number >= 0, not {table['order']!r}")
        table["order"] = int(table["order"])
    return table


def _settings(text: str, option: str, allowed: Sequence[str]) -> tuple[str, dict[str, str]]:
    """A place and its settings, from "0;order=2;equals=1/4"."""
    first, *rest = text.split(";")
    if "=" in first:
        first, rest = "", [first, *rest]
    found: dict[str, str] = {}
    for piece in rest:
        key, _, value = piece.partition("=")
        if key.strip() not in allowed or not value.strip():
            raise RatfitError(
                f"{option} {text}: {piece!r} is not of the form {' or '.join(f'{a}=...' for a in allowed)}"
            )
        found[key.strip()] = value.strip()
    return first.strip(), found


def _pair(text: str, option: str, example: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals or not name.strip() or not value.strip():
        raise RatfitError(f"{option} {text}: write it as {example}")
    return name.strip(), value.strip()


def _parameter(text: str) -> tuple[str, list[str]]:
    name, range_ = _pair(text, "--parameter", "m=1/100:1/2")
    low, colon, high = range_.partition(":")
    if not colon:
        raise RatfitError(f"--parameter {text}: write its range too, as in {name}=1/100:1/2")
    return name, [low.strip(), high.strip()]


def settings_of(texts: Sequence[str], *words: str) -> dict[str, str]:
    """Names and values from --set options, as in n=1/3; `words` may stand in place of a number.

    **Fails** with `RatfitError` for a value that holds other names, and for a name that is set twice.
    """
    found: dict[str, str] = {}
    for text in texts:
        name, value = _pair(text, "--set", f"{text.strip() if text.strip().isidentifier() else 'n'}=1/3")
        if name in found:
            raise RatfitError(f"--set {text}: {name} is set twice; leave one out")
        if value not in words and (unknown := set(_NAME.findall(value)) - RESERVED):
            other = f" (a parameter's value may also be {' or '.join(words)})" if words else ""
            example = f"as in {name}=1/3 or {name}=sqrt(2)/2{other}"
            raise RatfitError(
                f"--set {text}: a number is needed, {example}; {min(unknown)} is none{nearest(value, words)}"
            )
        found[name] = value
    return found
