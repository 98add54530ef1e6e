"""An expression arranged for evaluation: Horner, shared parts, hoisted constants; operation counts.

`schedule` writes an expression down in a handful of arrangements, each a straight-line program in which no operation
occurs twice, counts the operations and keeps the cheapest. The arrangements: as given; numerator and denominator in
factors or multiplied out, each by Horner's rule; about another centre (a root, or the point about which a factor loses
its second term); with factors made monic, or the constant in front drawn into one of them; the denominator in terms
of the numerator; even and odd parts shared between `N(x)` and `D(x) = N(-x)`; polynomial part plus proper fraction;
repeated parts taken out.

The files go from the program and its tape, over the arrangements that follow the input's structure, the fraction and
its constants, to the arrangements that follow the algebra, the choice among them and the verb. All algebra is rational
arithmetic over a field in which each parameter, radical and irrational number is one opaque generator, and bounded
in size: what grows too large is written down as it was given.
"""

from ratfit._schedule.cost import Cost as Cost
from ratfit._schedule.schedule import Schedule as Schedule
from ratfit._schedule.schedule import schedule as schedule
