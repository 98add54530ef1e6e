"""Twelve mixed exact conditions: derive (verification included) against sympy.solve on the same cleared equations.

Values, slopes, higher derivatives, a differential equation and the second term of an asymptote (which implies the
first), read off random [6/6] fractions with rational coefficients. Then the time of every gallery card, derived for
the first time in this process.
"""

import random
import time

import sympy as sp

import ratfit as rf
from ratfit.gallery import cards

x = sp.Symbol("x", nonnegative=True)
DATA = [(0, 4), (sp.Rational(1, 2), 1), (1, 2), (2, 1), (3, 2)]  # node, how many derivatives from the value on


def fraction(seed: int) -> sp.Expr:
    """A [6/6] with positive denominator coefficients: no pole on [0, oo)."""
    draw = random.Random(seed)
    above = sum(sp.Rational(draw.randint(-9, 9), draw.randint(1, 5)) * x**k for k in range(6)) + x**6
    below = 1 + sum(sp.Rational(draw.randint(1, 9), draw.randint(1, 5)) * x**k for k in range(1, 7))
    return above / below


def conditions(f: sp.Expr) -> list:
    asymptote = sp.limit(f, x, sp.oo)
    second = sp.limit((f - asymptote) * x, x, sp.oo)
    found = [
        rf.Derivative(at, order, equals=sp.diff(f, x, order).subs(x, at))
        for at, count in DATA
        for order in range(count)
    ]
    y = sp.Function("y")(x)
    growth = (sp.diff(f, x) / f).subs(x, 2)
    return [*found, rf.Equation(y.diff(x) - growth * y, 2), rf.Limit(sp.oo, scale=x, minus=asymptote, equals=second)]


def by_sympy(stated: list) -> list:
    """sympy.solve on P - f*Q, differentiated at the nodes, and the two leading coefficients."""
    a, b = sp.symbols("a0:7"), sp.symbols("b0:7")
    above, below = (sum(c * x**k for k, c in enumerate(cs)) for cs in (a, b))
    equations = [b[0] - 1]
    for at, count in DATA:
        data = [c.equals for c in stated if isinstance(c, rf.Derivative) and c.at == at]
        taylor = sum(d * (x - at) ** k / sp.factorial(k) for k, d in enumerate(data))
        equations += [sp.diff(above - taylor * below, x, k).subs(x, at) for k in range(count)]
    growth, limit = stated[-2].residual, stated[-1]
    value = next(c.equals for c in stated if isinstance(c, rf.Derivative) and c.at == 2)
    slope = -growth.xreplace({jet(1): 0, jet(0): value})
    equations.append(sp.diff(above - (value + slope * (x - 2)) * below, x).subs(x, 2))
    equations += [a[6] - limit.minus * b[6], a[5] - limit.minus * b[5] - limit.equals * b[6]]
    return sp.solve(equations, [*a, *b], dict=True)


def jet(order: int) -> sp.Symbol:
    """y or y' as a residual holds them."""
    return sp.Symbol("y" + "'" * order, real=True)


def timed(work):
    sp.core.cache.clear_cache()
    start = time.perf_counter()
    return work(), time.perf_counter() - start


def main() -> None:
    print("twelve mixed conditions, [6/6]      derive     sympy.solve   derive / solve")
    for seed in range(4):
        f = fraction(seed)
        stated = conditions(f)
        problem = rf.Problem(variable=x, domain=(0, sp.oo), conditions=stated, form=rf.Rational(6, 6))
        fit, ours = timed(lambda problem=problem: rf.derive(problem))
        _, theirs = timed(lambda stated=stated: by_sympy(stated))
        assert fit.status == "unique" and sp.cancel(fit.expression - f) == 0
        head = f"  seed {seed}: {len(stated)} conditions"
        print(f"{head:33} {ours:6.2f} s      {theirs:6.2f} s      {ours / theirs:6.2f}")
    print("\ncard                  derive   route")
    for card in cards():
        fit, seconds = timed(lambda card=card: rf.derive(card.problem))
        print(f"{card.name:20} {seconds:6.2f} s   {fit.route} ({fit.status})")


if __name__ == "__main__":
    main()
