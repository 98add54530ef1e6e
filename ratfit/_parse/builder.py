"""From the rules of the grammar to nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import chain
from typing import Any

import sympy as sp

from ratfit._parse.arithmetic import power_of, product_of, sum_of
from ratfit._parse.calls import call_of, check_call
from ratfit._parse.checks import check_result
from ratfit._parse.declared import named
from ratfit._parse.errors import Refusal, placed
from ratfit._parse.functions import INFINITE
from ratfit._parse.limits import MAX_DECIMAL_EXPONENT, MAX_DIGITS
from ratfit._parse.node import Node, bounded
from ratfit._parse.reading import current_reading


class Builder:
    """What each rule of the grammar makes; lark calls these while it parses, so that no tree is built."""

    def number(self, children: list[Any]) -> Node:
        (token,) = children
        with placed(token.start_pos, token.end_pos):
            return Node(_number(token), token.start_pos, token.end_pos)

    def name(self, children: list[Any]) -> Node:
        (token,) = children
        nodes = current_reading.get().nodes
        with placed(token.start_pos, token.end_pos):
            if token.value not in nodes:
                nodes[token.value] = named(token.value)
            return replace(nodes[token.value], start=token.start_pos, end=token.end_pos)

    def group(self, children: list[Any]) -> Node:
        left, node, right = children
        return bounded(replace(node, start=left.start_pos, end=right.end_pos, depth=node.depth + 1))

    def call(self, children: list[Any]) -> Node:
        name, _, *arguments, right = children
        nodes = [node for node in arguments if node is not None]
        around = _around(nodes, name.start_pos, right.end_pos)
        with placed(around.start, around.end):
            check_call(name.value, len(nodes))
            return _finished(around, call_of(name.value, [_finite(node) for node in nodes]))

    def power(self, children: list[Any]) -> Node:
        around = _around(children, children[0].start, children[1].end)
        with placed(around.start, around.end):
            return _finished(around, power_of(*map(_finite, children)))

    def signed(self, children: list[Any]) -> Node:
        sign, node = children
        negative = node.negative ^ (sign == "-")
        return bounded(replace(node, start=sign.start_pos, depth=node.depth + 1, negative=negative))

    def product(self, children: list[Any]) -> Node:
        nodes = children[::2]
        if len(nodes) == 1 and not nodes[0].negative:
            return nodes[0]
        if len(nodes) == 1 and nodes[0].expr in INFINITE:
            return replace(nodes[0], expr=-nodes[0].expr, negative=False)
        around = _around(nodes, nodes[0].start, nodes[-1].end, deeper=0)
        sign = sp.Integer((-1) ** sum(node.negative for node in nodes))
        with placed(around.start, around.end):
            factors = (sign, *chain.from_iterable(map(_factors, nodes, ["*", *children[1::2]])))
            return replace(_finished(around, product_of(factors)), factors=factors)

    def sum(self, children: list[Any]) -> Node:
        nodes = children[::2]
        if len(nodes) == 1:
            return nodes[0]
        around = _around(nodes, nodes[0].start, nodes[-1].end, deeper=0)
        with placed(around.start, around.end):
            terms = zip(["+", *children[1::2]], map(_finite, nodes), strict=True)
            return _finished(around, sum_of([-term if sign == "-" else term for sign, term in terms]))


def _around(nodes: Sequence[Node], start: int, end: int, deeper: int = 1) -> Node:
    """The node around others, before its expression is built: what is too large is not built at all."""
    depth = max((node.depth for node in nodes), default=0)
    return bounded(Node(sp.S.Zero, start, end, depth + deeper, 1 + sum(node.size for node in nodes)))


def _finished(node: Node, expr: sp.Expr) -> Node:
    check_result(expr)
    return replace(node, expr=expr)


def _finite(node: Node) -> sp.Expr:
    if node.expr in INFINITE:
        raise Refusal("infinity stands alone, as oo or -oo; there is no arithmetic with it", node.start, node.end)
    return -node.expr if node.negative else node.expr


def _factors(node: Node, operator: str) -> Sequence[sp.Expr]:
    expr = _finite(replace(node, negative=False))
    if operator == "*":
        return [expr]
    with placed(node.start, node.end):
        return [power_of(factor, sp.S.NegativeOne) for factor in (expr != 0 and node.factors) or [expr]]


def _number(text: str) -> sp.Rational:
    mantissa, _, exponent = text.lower().partition("e")
    whole, _, decimals = mantissa.partition(".")
    if len(whole + decimals) > MAX_DIGITS:
        raise Refusal(f"more than {MAX_DIGITS} digits; round the number")
    # Counted before int() reads them: a long exponent is a longer number.
    if len(exponent) > 5 or abs(int(exponent or 0)) > MAX_DECIMAL_EXPONENT:
        raise Refusal(f"decimal exponent beyond {MAX_DECIMAL_EXPONENT}; rescale the number")
    power = int(exponent or 0) - len(decimals)
    return sp.Rational(int(whole + decimals) * 10 ** max(power, 0), 10 ** max(-power, 0))
