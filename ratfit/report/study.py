"""A study as text for a terminal, as JSON, and as a problem file."""

from __future__ import annotations

import json
from collections.abc import Iterable
from textwrap import wrap
from typing import Any

import sympy as sp

from ratfit._condition import AbstractCondition, Equation, Integral
from ratfit._problem_text import condition_table, form_table, write_toml
from ratfit._study import Fact, Study
from ratfit._study.curve import Curve
from ratfit._study.suggestion import offered
from ratfit.report.parts import LONG, in_parts, where

GROUPS = (
    ("ends", ("value", "slope", "curvature")),
    ("far out", ("limit", "decay", "growth", "asymptote")),
    ("zeros", ("zero",)),
    ("poles", ("pole", "singularity", "remainder")),
    ("extrema", ("maximum", "minimum")),
    ("inflections", ("inflection",)),
    ("symmetry", ("parity", "reflection")),
    ("shape", ("monotonicity", "convexity")),
    ("integrals", ("integral", "moment")),
    ("differential equation", ("equation",)),
)

WIDEST = (50, 40)
"""Letters of the first two columns: what is longer has a line of its own."""

LINE = 110

SHOWN = 12
"""Digits of a number whose closed form is a long one."""


def study_text(study: Study) -> str:
    """The facts in groups, each with its option and how it was found; notes; a command that derives a fit."""
    target = study.target
    whole, parts = in_parts(target.expression, [target.variable.name])
    lines = [f"study of {whole}", *(f"  {line}" for line in where(parts))]
    lines += ["", f"  domain      {target.variable} in {_domain(study)}"]
    lines += [f"  parameters  {', '.join(f'{p} in [{p.low}, {p.high}]' for p in parameters(study))}"] * bool(
        parameters(study)
    )
    for name, kinds in GROUPS:
        facts = study.of(*kinds)
        if facts:
            lines += ["", f"  {name}", *_columns(facts, study)]
    if study.notes:
        lines += ["", "  notes", *_notes(study)]
    return "\n".join([*lines, "", *_suggestion_lines(study)])


def _notes(study: Study) -> list[str]:
    return [
        line for note in study.notes for line in wrap(note, LINE, initial_indent=" " * 4, subsequent_indent=" " * 6)
    ]


def _domain(study: Study) -> str:
    low, high = study.target.domain
    return f"[{low}, {high}]"


def parameters(study: Study) -> list[sp.Symbol]:
    """The parameters of the target, by name."""
    low, high = study.target.domain
    symbols = study.target.expression.free_symbols | low.free_symbols | high.free_symbols
    return sorted(symbols - {study.target.variable}, key=lambda s: s.name)


def _columns(facts: Iterable[Fact], study: Study) -> list[str]:
    """The facts below each other: text, option, and how it was found; what is too wide has a line of its own."""
    rows = [(*_readable(fact, study), option_of(fact), fact.found) for fact in facts]
    texts, options = [row[0] for row in rows], [row[2] for row in rows]
    widths = [
        max((len(word) for word in column if len(word) <= widest), default=0)
        for column, widest in zip((texts, options), WIDEST, strict=True)
    ]
    lines: list[str] = []
    for text, below, option, found in rows:
        if len(text) > widths[0] or below:
            lines += [f"    {text}", *(f"      {line}" for line in below)]
            text = "" if widths[0] else "  "
        if len(option) > widths[1]:
            lines.append(f"    {text:<{widths[0]}}  {option}")
            text, option = "", ""
        second = f"  {option:<{widths[1]}}" if widths[1] else ""
        lines.append(f"    {text:<{widths[0]}}{second}  {found}")
    return lines


def _readable(fact: Fact, study: Study) -> tuple[str, list[str]]:
    """The text of a fact with a long number in named parts, and these; in digits where parts do not make it short."""
    if len(fact.text) <= LONG or fact.value is None or str(fact.value) not in fact.text:
        return fact.text, []
    whole, parts = in_parts(fact.value, [study.target.variable.name])
    if max(len(str(each)) for each in (whole, *(part for _, part in parts))) <= LONG:
        return fact.text.replace(str(fact.value), str(whole)), where(parts)
    curve = Curve(study.target)
    digits = f"{sp.N(fact.value.xreplace(curve.middle), SHOWN)}{curve.label}"
    below = [f"a closed form of {len(str(fact.value))} letters, which --format json writes out"]
    return fact.text.replace(str(fact.value), digits), below


def _suggestion_lines(study: Study) -> list[str]:
    if study.suggested is None:
        return ["  No set of these conditions was found within the time that a fraction of its size keeps."]
    return ["  try", f"    {command_of(study)}"]


def command_of(study: Study) -> str:
    """The command that derives the suggested problem, as a person would type it; empty without one."""
    problem, target = study.suggested, study.target
    if problem is None:
        return ""
    form = form_table(problem.form)
    whole, parts = in_parts(target.expression, [target.variable.name])
    words = ["ratfit", "derive", quoted(str(whole)), "--on", *(quoted(str(end)) for end in target.domain)]
    words += ["--variable", str(target.variable)]
    for name, part in parts:
        words += ["--let", quoted(f"{name}={part}")]
    for parameter in parameters(study):
        words += ["--parameter", quoted(f"{parameter}={parameter.low}:{parameter.high}")]
    words += ["--form", f"{form['numerator']}/{form['denominator']}"]
    return " ".join([*words, *(condition_option(condition) for condition in problem.conditions)])


def option_of(fact: Fact) -> str:
    """The option of `ratfit derive` that keeps a fact; empty where there is none."""
    if fact.condition is not None:
        return condition_option(fact.condition)
    return f"--{fact.form[0]} {quoted(fact.form[1])}" if fact.form else ""


def condition_option(condition: AbstractCondition) -> str:
    """A condition as an option of `ratfit derive`: --derivative "pi/2;order=2"."""
    table = _table(condition)
    settings = {key: value for key, value in table.items() if key not in ("kind", "at", "residual", "over")}
    if settings.get("order") == (0 if isinstance(condition, Equation) else 1):
        del settings["order"]
    first = [table["residual"]] if isinstance(condition, Equation) else []
    first += (
        [f"at={table['at']}"]
        if isinstance(condition, Equation)
        else []
        if isinstance(condition, Integral)
        else [table["at"]]
    )
    text = ";".join([*first, *(f"{key}={value}" for key, value in settings.items())])
    return f"--{condition.kind} {quoted(text)}"


def _table(condition: AbstractCondition) -> dict[str, Any]:
    """The table of a condition, with long decimals written as decimals: they were found by numbers."""
    table = condition_table(condition)
    for key in ("at", "equals", "scale"):
        number = getattr(condition, key, None)
        if key in table and isinstance(number, sp.Rational):
            table[key] = decimal_text(number)
    return table


def decimal_text(number: sp.Rational) -> str:
    """A fraction as text; one over a large power of ten as the decimal that it came from."""
    digits = len(str(int(number.q))) - 1
    twos_and_fives = int(number.q)
    for prime in (2, 5):
        while twos_and_fives % prime == 0:
            twos_and_fives //= prime
    if twos_and_fives != 1 or digits < 6:
        return str(number)
    places = 0
    while (number * 10**places).q != 1:
        places += 1
    whole = str(abs(int(number * 10**places))).rjust(places + 1, "0")
    return f"{'-' if number < 0 else ''}{whole[:-places]}.{whole[-places:]}"


def quoted(text: str) -> str:
    """A word for a shell, in double quotes where it needs any."""
    if text and all(letter.isalnum() or letter in "./:=+,_-" for letter in text):
        return text
    return f'"{text}"'


def study_json(study: Study) -> str:
    """The study as one JSON object."""
    low, high = study.target.domain
    found = {
        "target": str(study.target.expression),
        "variable": str(study.target.variable),
        "domain": [str(low), str(high)],
        "parameters": {p.name: [str(p.low), str(p.high)] for p in parameters(study)},
        "facts": [_fact_object(fact) for fact in study.facts],
        "notes": list(study.notes),
        "derive": command_of(study) or None,
    }
    return json.dumps(found, indent=2, ensure_ascii=False)


def _fact_object(fact: Fact) -> dict[str, Any]:
    toml = None
    if fact.condition is not None:
        toml = write_toml({"condition": [_table(fact.condition)]}).strip()
    elif fact.form is not None:
        toml = write_toml({"form": dict([fact.form])}).strip()
    return {
        "kind": fact.kind,
        "text": fact.text,
        "found": fact.found,
        "option": option_of(fact) or None,
        "toml": toml,
    }


def study_toml(study: Study) -> str:
    """A problem file of the suggested conditions, which derives as it is; all others follow as comments."""
    if study.suggested is None:
        kept, form = offered(study), None
    else:
        kept, form = study.suggested.conditions, form_table(study.suggested.form)
    tables: dict[str, Any] = {
        "name": "study",
        "target": str(study.target.expression),
        "variable": str(study.target.variable),
        "domain": [str(end) for end in study.target.domain],
        "parameters": {p.name: [str(p.low), str(p.high)] for p in parameters(study)},
        "form": form or _size(len(kept)),
        "condition": [_table(c) for c in kept],
    }
    if not tables["parameters"]:
        del tables["parameters"]
    return write_toml(tables) + _others(study, kept)


def _size(count: int) -> dict[str, int]:
    """Degrees with one coefficient more than a fraction needs to keep so many conditions."""
    below = max(0, (count - 1) // 2)
    return {"numerator": max(0, count - 1 - below), "denominator": below}


def _others(study: Study, kept: tuple[AbstractCondition, ...]) -> str:
    """The conditions that are true and not asked for: take the marks away, and raise a degree for each."""
    rest = [c for c in offered(study) if c not in kept]
    lines = ["", "# Also true; each condition more needs one degree more in [form]."] if rest else []
    for condition in rest:
        fact = next(fact for fact in study.facts if fact.condition == condition)
        text = write_toml({"condition": [_table(condition)]}).strip()
        lines += ["#", f"# {fact.text} ({fact.found})", *(f"# {line}" for line in text.splitlines())]
    return "\n".join(lines) + "\n" if lines else ""
