"""Systems -> candidate coefficients: one route a file, `solve` picks."""

from ratfit._solver.auto import ROUTES as ROUTES
from ratfit._solver.auto import pick as pick
from ratfit._solver.auto import solve as solve
from ratfit._solver.naming import Meaning as Meaning
from ratfit._solver.naming import named as named
from ratfit._solver.solution import Numbers as Numbers
from ratfit._solver.solution import Solution as Solution
from ratfit._solver.solution import Table as Table
from ratfit._solver.solution import Undecided as Undecided
from ratfit._solver.squares import normal as normal
from ratfit._solver.squares import plain as plain
