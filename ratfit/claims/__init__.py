"""The ledger: what the sources state, and the functions that decide it.

The files go from what a claim is and when a value agrees with it, over integrals and directions, to one file a theme.
A theme has the computations first and its claims after them.
"""

from ratfit.claims._claim import DOCUMENTS as DOCUMENTS
from ratfit.claims._claim import VERDICTS as VERDICTS
from ratfit.claims._claim import Claim as Claim
from ratfit.claims._claim import Decision as Decision
from ratfit.claims._claim import Reading as Reading
from ratfit.claims._claim import decide as decide
from ratfit.claims._ledger import claims as claims
from ratfit.claims._ledger import selected as selected
