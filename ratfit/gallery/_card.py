"""Card: a problem with what was published about it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import sympy as sp

from ratfit._condition import Derivative
from ratfit._form import Rational
from ratfit._parse import RatfitError, nearest, parse_expression
from ratfit._problem import Problem
from ratfit._problem_file import problem_of, read_problem, toml_tables
from ratfit._problem_text import to_tables

MAX_DEGREE = 20
"""Largest --degree of a card that takes one: 2*20 + 1 conditions."""


@dataclass(frozen=True)
class Card:
    """A problem, the formula that was published for it, and where.

    `published` is the printed formula as an expression of the problem's variable, parameters and choices, None where
    there is none; `printed` its text. `settings` are the parameter values to measure with, as the source's figures
    have them. `epsilon` and `gamma` are the source's figures as numbers (0.014, 2.3), None where it gives none;
    `operations` its count. `degree` is None, or the degree of a card that takes `--degree`: a Pade table at the
    place of its first condition.
    """

    problem: Problem
    title: str
    source: str
    place: str
    printed: str
    published: sp.Expr | None
    aliases: tuple[str, ...] = ()
    note: str = ""
    settings: tuple[Mapping[str, sp.Expr], ...] = ()
    epsilon: float | None = None
    gamma: float | None = None
    operations: Mapping[str, int] | None = None
    degree: int | None = None

    @property
    def name(self) -> str:
        return self.problem.name

    def to_json_object(self) -> dict[str, Any]:
        """The card as JSON holds it: the tables of its problem file, and what was published."""
        about = {k: getattr(self, k) for k in ("title", "aliases", "source", "place", "note", "epsilon", "gamma")}
        return {**to_tables(self.problem), **about, "published": self.printed, "operations": self.operations}

    def with_degree(self, degree: int) -> Card:
        """The card at another degree n: form [n/n], derivatives 0 to 2n. Raises RatfitError where it takes none."""
        if self.degree is None:
            raise RatfitError(f"{self.name} takes no degree; the gallery's pade-exp does")
        if not 1 <= degree <= MAX_DEGREE:
            raise RatfitError(f"--degree must be from 1 to {MAX_DEGREE}, not {degree}")
        if degree == self.degree:
            return self
        at = self.problem.conditions[0].at  # type: ignore[attr-defined]
        conditions = tuple(Derivative(at, order) for order in range(2 * degree + 1))
        problem = replace(self.problem, conditions=conditions, form=Rational(degree, degree))
        return replace(self, problem=problem, degree=degree, printed="")  # what is printed is the card's own degree


_KEYS = (
    *("title", "aliases", "source", "place", "published", "note", "settings", "epsilon", "gamma", "operations"),
    "degree",
)


@cache
def cards() -> tuple[Card, ...]:
    """Every card, in the order of their names."""
    return tuple(card(name) for name in names())


@cache
def names() -> list[str]:
    """The names of all cards."""
    return sorted(
        entry.name.removesuffix(".toml") for entry in files(__package__).iterdir() if entry.name.endswith(".toml")
    )


def card(name: str) -> Card:
    """The card of that name, or of that alias ("eq12"). Raises RatfitError, offering the nearest names."""
    if name not in names():
        name = _aliases().get(name, name)
    if name not in names():
        known = names() + list(_aliases())
        raise RatfitError(f"unknown problem {name!r}{nearest(name, known)}; `ratfit gallery` lists them")
    return _read(name)


@cache
def _read(name: str) -> Card:
    tables = dict(_tables(name))
    about: dict[str, Any] = dict(tables.pop("card"))
    unknown = set(about) - set(_KEYS)
    if unknown:
        raise RatfitError(f"card {name}: unknown keys {sorted(unknown)}")
    problem = problem_of(tables, name)
    symbols: dict[str, sp.Expr] = {s.name: s for s in (problem.variable, *problem.parameters)}
    symbols |= {n: sp.Symbol(n, real=True) for n in problem.choice}
    printed = about.pop("published", "")
    settings = tuple(
        {n: parse_expression(v, {}, f"card {name}") for n, v in s.items()} for s in about.pop("settings", [])
    )
    return Card(
        problem=problem,
        printed=printed,
        published=parse_expression(printed, symbols, f"card {name}, published") if printed else None,
        settings=settings,
        aliases=tuple(about.pop("aliases", ())),
        **about,
    )


@cache
def _tables(name: str) -> dict[str, Any]:
    return toml_tables((files(__package__) / f"{name}.toml").read_text("utf-8"), name)


@cache
def _aliases() -> dict[str, str]:
    """Alias -> name. Only the TOML is read: parsing the formulas of every card to find one would cost a cold start."""
    found: dict[str, str] = {}
    for name in names():
        found |= dict.fromkeys(_tables(name)["card"].get("aliases", ()), name)
    return found


def find_problem(text: str) -> Problem:
    """A problem by gallery name or alias, or else from a file. Raises RatfitError when it is neither."""
    return read_problem(text) if is_file_name(text) and not is_card(text) else card(text).problem


def is_card(text: str) -> bool:
    """Whether a text is the name or an alias of a card."""
    return text in names() or text in _aliases()


def is_known(text: str) -> bool:
    """Whether a text names a whole problem: a card, an alias or a file."""
    return is_card(text) or is_file_name(text)


def is_file_name(text: str) -> bool:
    """Whether a problem's name is to be read as a file: it ends in .toml or exists."""
    try:
        return text.endswith(".toml") or Path(text).exists()
    except (OSError, ValueError):  # too long for a path, or a NUL inside
        return False
