"""The choice: the cheapest arrangement that is faithful."""

from __future__ import annotations

import functools
from collections.abc import Iterator

import sympy as sp

from ratfit._schedule.arrangements import arrangements
from ratfit._schedule.context import Context, Plan, attempt
from ratfit._schedule.cost import cost
from ratfit._schedule.faithful import is_faithful, trial_of
from ratfit._schedule.fraction import read
from ratfit._schedule.program import Program
from ratfit._schedule.structure import as_given, by_parts, write_shared
from ratfit._schedule.tape import Tape


def plan(context: Context, expression: sp.Expr) -> Plan:
    """The cheapest arrangement of an expression, remembered."""
    if expression == context.variable or not context.varies(expression):
        return lambda tape: tape.leaf(expression)
    if expression not in context.plans:
        context.plans[expression] = _cheapest(context, expression)
    return context.plans[expression]


def _cheapest(context: Context, expression: sp.Expr) -> Plan:
    tried = [(plan, attempt(functools.partial(compiled, context, plan))) for plan in _candidates(context, expression)]
    plans = [(plan, program) for plan, program in tried if program is not None]
    given = plans[0][1]
    trial = trial_of(context, expression)
    # sorted() keeps the order of equal weights, so that the arrangement closest to the input wins a tie.
    ranked = sorted(plans, key=lambda entry: cost(entry[1]).weight)
    return next(plan for plan, program in ranked if program is given or is_faithful(trial, program, given))


def _candidates(context: Context, expression: sp.Expr) -> Iterator[Plan]:
    yield functools.partial(as_given, context, expression)
    readings = (attempt(functools.partial(read, context, expression, coarse)) for coarse in (False, True))
    form = next((reading for reading in readings if reading is not None), None)
    if form is not None:
        yield from arrangements(context, form)
    if form is None or len(form.generators) > 1:
        yield functools.partial(by_parts, context, expression)
    # A name may stand for a part of anything but a condition or the limits of an integral.
    if not expression.has(sp.Piecewise) and all(
        isinstance(node, sp.Expr) for node in sp.preorder_traversal(expression)
    ):
        yield functools.partial(write_shared, context, sp.cse(expression))


def compiled(context: Context, plan: Plan) -> Program:
    tape = Tape(context.variable)
    return tape.finish(plan(tape))
