"""What is exact about a function: facts, each ready as a kernel condition. One kind of fact a file."""

from ratfit._study.fact import Fact as Fact
from ratfit._study.fact import Study as Study
from ratfit._study.study import study as study
