"""What the functions cost in scalar C, in additions: the weights of the cost model (`ratfit/_speed/cost_model.py`).

The unit is taken from the same runs: eight divisions with their sums and additions, of which the model says what they
weigh. A function's weight is its time above the copy floor in that unit. Its arguments are drawn from [1/10, 4], or
from [1/10, 9/10] where it has no real value beyond 1.
"""

import sympy as sp

import ratfit as rf

x = sp.Symbol("x")
LOW = sp.Rational(1, 10)
FUNCTIONS = {
    "exp": sp.exp(x), "log": sp.log(x), "power": x ** sp.Rational(17, 10), "cbrt": x ** sp.Rational(1, 3),
    "sin": sp.sin(x), "cos": sp.cos(x), "tan": sp.tan(x), "arcsin": sp.asin(x), "arccos": sp.acos(x),
    "arctan": sp.atan(x), "arctan2": sp.atan2(x, sp.Rational(1, 2)), "sinh": sp.sinh(x), "cosh": sp.cosh(x),
    "tanh": sp.tanh(x), "arcsinh": sp.asinh(x), "arccosh": sp.acosh(1 + x), "arctanh": sp.atanh(x),
    "erf": sp.erf(x), "erfc": sp.erfc(x), "gamma": sp.gamma(x), "loggamma": sp.loggamma(x),
}  # fmt: skip
TO_ONE = ("arcsin", "arccos", "arctanh")
DIVISIONS = 8
FRACTIONS = sp.Add(*(1 / (x + number) for number in range(1, DIVISIONS + 1)))
WEIGHT = {"float32": 6, "float64": 8}  # of one division; two additions go with each


def main() -> None:
    print("function   float32   float64   (additions)")
    units = {
        dtype: above_floor(FRACTIONS, dtype, sp.S.One) / (DIVISIONS * (weight + 2)) for dtype, weight in WEIGHT.items()
    }
    for name, expression in FUNCTIONS.items():
        high = sp.Rational(9, 10) if name in TO_ONE else sp.Integer(4)
        costs = (above_floor(expression, dtype, high) / unit for dtype, unit in units.items())
        print(name.ljust(9), *(f"{cost:9.1f}" for cost in costs))


def above_floor(expression: sp.Expr, dtype: str, high: sp.Expr) -> float:
    """The seconds of a function above the floor, each the least of its rounds: what disturbs a round only adds."""
    target, start = rf.Target(expression, x, (LOW, high)), rf.Value(LOW)
    fit = rf.derive(rf.Problem(target=target, conditions=[start], form=rf.Rational(0, 0)))
    timed = rf.measure_speed(fit, backend="c-scalar", samples=100_000, dtype=dtype, repeats=60)
    return min(timed.exact_times) - min(timed.floor_times)


if __name__ == "__main__":
    main()
