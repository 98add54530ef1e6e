"""A condition in a few words."""

from __future__ import annotations

from ratfit._condition.abstract import AbstractCondition
from ratfit._condition.equation import Equation
from ratfit._condition.limit import Limit
from ratfit._condition.point import AbstractPointCondition


def describe(condition: AbstractCondition) -> str:
    """A condition in a few words: "value at 0", "derivative of order 2 at pi/2", "limit at oo of f - x", ..."""
    if isinstance(condition, AbstractPointCondition):
        if condition.order > 1:
            return f"derivative of order {condition.order} at {condition.place}"
        return f"{'derivative' if condition.order else 'value'} at {condition.place}"
    if isinstance(condition, Limit):
        return f"limit at {condition.place}" + (f" of {condition.what}" if condition.what != "f" else "")
    if isinstance(condition, Equation):
        order = f" to order {condition.order}" if condition.order else ""
        return f"equation {condition.residual} at {condition.place}{order}"
    return f"{condition.kind} with {condition.place}"
