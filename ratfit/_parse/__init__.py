"""Text to sympy expression, by a closed grammar.

Problem files and the command line carry formulas as text from anywhere. Nothing here hands text to `eval`, `sympify` or
`parse_expr`: lark reads it by the grammar in `grammar.py`, and every construction is checked *before* sympy sees it,
because sympy evaluates on sight, and short texts (`9**9**9**9`, the sign of a sum that happens to be zero) can keep it
busy for ever. What bounds the time:

- every number that is not rational has a value at two precisions; where the two disagree, or leave the range of a
  double, the text is refused, so that no later question about its sign can be hard;
- powers of rationals are bounded in bits, powers of everything else in exponent;
- step functions of numbers (`Abs`, `sign`, `floor`, ...), `Min` and `Max` are decided here, from those values;
- a function or a power of a sum, or of something long, is left as written, behind a veil (see `veil.py`);
- the whole is bounded in length, depth and size.

The files go from the limits, errors and functions, over the values of numbers, the veil and the bounds, to sums,
products, powers and calls, their checks, the builder that the grammar calls and the verb.
"""

from ratfit._parse.errors import ParseError as ParseError
from ratfit._parse.errors import RatfitError as RatfitError
from ratfit._parse.errors import shortened as shortened
from ratfit._parse.functions import FUNCTIONS as FUNCTIONS
from ratfit._parse.functions import RESERVED as RESERVED
from ratfit._parse.limits import MAX_DEPTH as MAX_DEPTH
from ratfit._parse.limits import MAX_LENGTH as MAX_LENGTH
from ratfit._parse.names import check_name as check_name
from ratfit._parse.names import named_in as named_in
from ratfit._parse.names import nearest as nearest
from ratfit._parse.parse import parse_expression as parse_expression
