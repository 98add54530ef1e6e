"""How much faster a fit is than the exact function: gamma, in one of several regimes, because one ratio lies.

The files go from what runs (the contest), over the backends that run it (arrays of JAX and NumPy, compiled C), the
rounds in which it is timed and the check of what it gave, to the notes that say how to read gamma and the verb. The
cost model runs nothing and weighs operations.
"""

from ratfit._speed.backends import BACKENDS as BACKENDS
from ratfit._speed.backends import available as available
from ratfit._speed.measure import SpeedMeasurement as SpeedMeasurement
from ratfit._speed.measure import measure_speed as measure_speed
from ratfit._speed.rounds import ratio_interval as ratio_interval
