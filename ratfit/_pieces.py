"""Integrands in smooth pieces: absolute values, signs, steps, maxima and floors, decided between their jumps."""

from __future__ import annotations

from itertools import combinations, pairwise

import sympy as sp

from ratfit._parse import RatfitError
from ratfit._target import INSIDE, sample_values

MOST = 200
"""Pieces that an integrand is cut into."""

_JUMPS = (sp.Abs, sp.sign, sp.Heaviside, sp.Min, sp.Max, sp.floor, sp.ceiling)

Piece = tuple[sp.Expr, tuple[sp.Expr, sp.Expr]]


def smooth_pieces(integrand: sp.Expr, x: sp.Symbol, over: tuple[sp.Expr, sp.Expr]) -> list[Piece]:
    """The integrand on the ranges between its jumps and kinks, there without the functions that make them.

    Arguments of degree 1 and 2 in x are cut at their zeros; an integrand with others comes back whole. Raises
    RatfitError where the cuts change places within the ranges of the parameters, and for more than MOST pieces.
    """
    calls = [call for call in integrand.atoms(*_JUMPS) if call.has(x)]
    if not calls:
        return [(integrand, over)]
    cuts: set[sp.Expr] = set()
    for call in calls:
        found = _cuts(call, x, over)
        if found is None:
            return [(integrand, over)]
        cuts |= found
    places = [over[0], *_ordered(cuts, over), over[1]]
    return [(_decided(integrand, calls, x, (a, b)), (a, b)) for a, b in pairwise(places)]


def _cuts(call: sp.Expr, x: sp.Symbol, over: tuple[sp.Expr, sp.Expr]) -> set[sp.Expr] | None:
    """Where a function's branch may change; None where that is not known."""
    if isinstance(call, (sp.Min, sp.Max)):
        arguments = [a - b for a, b in combinations(call.args, 2)]
    elif isinstance(call, (sp.floor, sp.ceiling)):
        whole = _whole_numbers(call.args[0], x, over)
        if whole is None:
            return None
        arguments = [call.args[0] - k for k in whole]
    else:
        arguments = [call.args[0]]
    found: set[sp.Expr] = set()
    for argument in arguments:
        if not argument.is_polynomial(x) or sp.degree(argument, x) > 2:
            return None
        found |= (
            {root for root in sp.roots(sp.Poly(argument, x)) if root.is_real is not False} if argument.has(x) else set()
        )
    return found


def _whole_numbers(argument: sp.Expr, x: sp.Symbol, over: tuple[sp.Expr, sp.Expr]) -> range | None:
    """The whole numbers that a linear argument without parameters passes on a finite range."""
    if not argument.is_polynomial(x) or sp.degree(argument, x) != 1 or argument.free_symbols != {x}:
        return None
    if any(end.is_infinite or end.free_symbols for end in over):
        return None
    low, high = sorted(argument.subs(x, end) for end in over)
    if high - low > MOST:
        raise RatfitError(f"{argument} passes more than {MOST} whole numbers on [{over[0]}, {over[1]}]; narrow it")
    return range(int(sp.floor(low)), int(sp.ceiling(high)) + 1)


def _ordered(cuts: set[sp.Expr], over: tuple[sp.Expr, sp.Expr]) -> list[sp.Expr]:
    """The cuts inside the range, from left to right, the same for all values of the parameters tried."""
    symbols = set[sp.Symbol]().union(*(e.free_symbols for e in (*cuts, *over)))
    orders = set()
    for values in sample_values(symbols, INSIDE):
        low, high = (end.xreplace(values) for end in over)
        inside = [(sp.N(here, 30), cut) for cut in cuts if low < (here := cut.xreplace(values)) < high]
        orders.add(tuple(cut for _, cut in sorted(inside, key=lambda pair: pair[0])))
    if len(orders) > 1:
        raise RatfitError("the kinks of an integrand change places within the ranges of the parameters; narrow them")
    return list(orders.pop())


def _decided(integrand: sp.Expr, calls: list[sp.Expr], x: sp.Symbol, over: tuple[sp.Expr, sp.Expr]) -> sp.Expr:
    """The integrand on one piece, each function replaced by its branch there, the innermost first."""
    values = sample_values(
        set[sp.Symbol]().union(integrand.free_symbols - {x}, *(e.free_symbols for e in over)), ("3/7",)
    )[0]
    low, high = (end.xreplace(values) for end in over)
    middle = sp.S.Zero if low.is_infinite and high.is_infinite else low + 1 if high.is_infinite else high - 1
    if not (low.is_infinite or high.is_infinite):
        middle = (3 * low + 4 * high) / 7
    for call in sorted(calls, key=sp.count_ops):
        if call in integrand.atoms(*_JUMPS):
            integrand = integrand.xreplace({call: _branch(call, {**values, x: middle})})
    return integrand


def _branch(call: sp.Expr, place: dict[sp.Symbol, sp.Expr]) -> sp.Expr:
    if isinstance(call, (sp.Min, sp.Max)):
        return (min if isinstance(call, sp.Min) else max)(call.args, key=lambda a: sp.N(a.xreplace(place), 30))
    value = sp.N(call.args[0].xreplace(place), 30)
    if isinstance(call, sp.Abs):
        return call.args[0] if value > 0 else -call.args[0]
    if isinstance(call, sp.sign):
        return sp.S.One if value > 0 else sp.S.NegativeOne
    if isinstance(call, sp.Heaviside):
        return sp.S.One if value > 0 else sp.S.Zero
    return sp.floor(value) if isinstance(call, sp.floor) else sp.ceiling(value)
