"""`ratfit paper`: what schlick1994 prints, derived again and measured beside its figures.

The files go from what is measured (measurements, and Eq. 16 of footnote 3 in footnote) and the rows that come of it
(rows), over the search for the measure that a printed figure may be (closest), to the parts that page and terminal
share, each in a file of its name, and what becomes of them (text, page, results) by the verb (run).
"""

from ratfit.report.paper.run import Asked as Asked
from ratfit.report.paper.run import run_paper as run_paper
