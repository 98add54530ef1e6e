"""Reference values better than float64: expressions in double-double arithmetic on NumPy arrays."""

from ratfit._double_double.play import double_double as double_double
from ratfit._double_double.play import reference_error as reference_error
