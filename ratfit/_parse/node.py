"""What a piece of the text has become, and how deep and large it may be."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from ratfit._parse.errors import Refusal
from ratfit._parse.limits import MAX_DEPTH, MAX_SIZE


@dataclass(frozen=True, slots=True)
class Node:
    """A piece of the text read so far. A leading minus waits in `negative`, and a product keeps its `factors`:
    `-(x + 1)/y` and `y/(2*(x + 1))` are one product each, as sympy prints them, and would not come back if the minus
    or the 2 were multiplied into the sum first."""

    expr: sp.Expr
    start: int
    end: int
    depth: int = 0
    size: int = 1
    negative: bool = False
    factors: tuple[sp.Expr, ...] = ()


def bounded(node: Node) -> Node:
    if node.depth > MAX_DEPTH:
        raise Refusal(f"nested deeper than {MAX_DEPTH}; give the inner part a name", node.start, node.end)
    if node.size > MAX_SIZE:
        raise Refusal(f"more than {MAX_SIZE} parts once the names are put in; shorten it", node.start, node.end)
    return node
