"""Where a fit is measured: at which points, and at which values of the parameters that are drawn with them.

The points are counter-based: point i is a function of the seed and of i alone, defined in these files to the bit. So
the first n of N points are the n points, whoever asks for them, in chunks, on 1 device or on 64, now or in ten years.

`counter.py` and `sobol.py` make fractions of (0, 1) from counters; `protocols.py` and `directions.py` carry them into
the domain, by arithmetic that every device rounds alike (`portable.py`); `ends.py` knows the numbers inside a domain;
`exhaustive.py` numbers all of them; `draw.py` puts these together.
"""

from ratfit._sampling.check import DTYPES as DTYPES
from ratfit._sampling.check import check_protocol as check_protocol
from ratfit._sampling.check import protocol_at as protocol_at
from ratfit._sampling.check import resolve as resolve
from ratfit._sampling.draw import draw as draw
from ratfit._sampling.draw import drawing as drawing
from ratfit._sampling.draw import drawn as drawn
from ratfit._sampling.draw import sample as sample
from ratfit._sampling.ends import bounds as bounds
from ratfit._sampling.exhaustive import EXHAUSTIVE as EXHAUSTIVE
from ratfit._sampling.exhaustive import count as count
from ratfit._sampling.protocols import PROTOCOLS as PROTOCOLS
