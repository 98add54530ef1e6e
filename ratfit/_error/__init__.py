"""How far a fit is from the exact function: every definition of eps, at the same points, in one pass.

The files go from one chunk of samples on a device (chunk), over the exact totals of many (totals) and the stream of
them through all devices (stream), to the definitions of eps, the curve for pictures and the verb, `measure_error`.
"""

from ratfit._error.definitions import DEFINITIONS as DEFINITIONS
from ratfit._error.measure import ErrorMeasurement as ErrorMeasurement
from ratfit._error.measure import measure_error as measure_error
from ratfit._error.stream import Watch as Watch
