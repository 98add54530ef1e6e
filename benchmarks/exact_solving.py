"""exp [n/n] exactly: ratfit's derive (verification included) against sympy.solve and mpmath's Pade on the same data."""

import time
from collections.abc import Callable
from math import factorial

import mpmath
import sympy as sp

import ratfit as rf
from ratfit.gallery import card

DEGREES = (2, 4, 6, 10)


def by_sympy(degree: int) -> dict:
    """sympy.solve on the same linear equations, the constant denominator coefficient set to 1."""
    x = sp.Symbol("x")
    a, b = sp.symbols(f"a0:{degree + 1}"), sp.symbols(f"b1:{degree + 1}")
    numerator = sum(c * x**k for k, c in enumerate(a))
    denominator = 1 + sum(c * x**k for k, c in enumerate(b, 1))
    series = sum(x**k / sp.factorial(k) for k in range(2 * degree + 1))
    product = sp.Poly(sp.expand(numerator - series * denominator), x)
    return sp.solve([product.coeff_monomial(x**k) for k in range(2 * degree + 1)], [*a, *b], dict=True)[0]


def by_sympy_nonlinear(degree: int) -> list:
    """sympy.solve on the conditions as they stand: derivatives of the quotient."""
    x = sp.Symbol("x")
    a, b = sp.symbols(f"a0:{degree + 1}"), sp.symbols(f"b1:{degree + 1}")
    quotient = sum(c * x**k for k, c in enumerate(a)) / (1 + sum(c * x**k for k, c in enumerate(b, 1)))
    return sp.solve([sp.diff(quotient, x, k).subs(x, 0) - 1 for k in range(2 * degree + 1)], [*a, *b], dict=True)


def by_mpmath(degree: int) -> tuple:
    """mpmath's Pade: the same coefficients at 50 digits, not exact, nothing verified."""
    with mpmath.workdps(50):
        return mpmath.pade([mpmath.mpf(1) / factorial(k) for k in range(2 * degree + 1)], degree, degree)


def seconds(work: Callable[[], object], rounds: int = 3) -> float:
    found = []
    for _ in range(rounds):
        sp.core.cache.clear_cache()
        start = time.perf_counter()
        work()
        found.append(time.perf_counter() - start)
    return min(found)


def main() -> None:
    print(f"{'exp':8} {'ratfit':>10} {'sympy.solve':>12} {'as stated':>12} {'mpmath':>10}   ratfit / solve, / mpmath")
    for degree in DEGREES:
        problem = card("pade-exp").with_degree(degree).problem
        assert rf.derive(problem).status == "unique"
        ours = seconds(lambda problem=problem: rf.derive(problem))
        theirs = seconds(lambda degree=degree: by_sympy(degree))
        stated = seconds(lambda degree=degree: by_sympy_nonlinear(degree), 1) if degree <= 2 else None
        digits = seconds(lambda degree=degree: by_mpmath(degree))
        shown = f"{stated:10.3f} s" if stated is not None else "not asked"
        print(
            f"[{degree}/{degree}]".ljust(8),
            f"{ours:8.3f} s {theirs:10.3f} s {shown:>12} {digits:8.4f} s   {ours / theirs:.2f}, {ours / digits:.0f}",
        )


if __name__ == "__main__":
    main()
