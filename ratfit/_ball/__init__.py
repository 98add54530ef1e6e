"""Balls: expressions and integrals evaluated with rigorous bounds on every rounding, by python-flint.

A ball is a number with a radius; a function of balls returns one that contains every value the true function takes on
them. Where no such ball is known it is not finite, which proves nothing: failing is always honest here. `function.py`
walks an expression into a tape, `integral.py` integrates tapes, `ends.py` maps infinite ranges and singular ends to 0.
"""

from ratfit._ball.function import ball_function as ball_function
from ratfit._ball.integral import ball_integral as ball_integral
