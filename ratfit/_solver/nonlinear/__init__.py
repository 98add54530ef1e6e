"""The nonlinear route: many starts, polish to 50 digits, a certificate for each root."""

from ratfit._solver.nonlinear.route import solve_nonlinear as solve_nonlinear
