"""What differs from call to call travels in a context variable, so that the parser is built once."""

from __future__ import annotations

from collections.abc import Mapping
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import sympy as sp

from ratfit._parse.node import Node


class Value(NamedTuple):
    low: Any
    high: Any


@dataclass(frozen=True)
class Reading:
    """What one call knows: names, nodes of names met, values of numbers, and the symbols that veil long parts."""

    names: Mapping[str, sp.Expr]
    nodes: dict[str, Node] = field(default_factory=dict)
    values: dict[sp.Expr, Value] = field(default_factory=dict)
    evaluations: dict[tuple[Any, ...], Value] = field(default_factory=dict)
    veils: dict[sp.Expr, sp.Dummy] = field(default_factory=dict)
    meanings: dict[sp.Expr, sp.Expr] = field(default_factory=dict)


current_reading: ContextVar[Reading] = ContextVar("current_reading")
