"""Named problems, one card a file, data only: `card("eq19")`, `cards()`, `find_problem("eq19" or a file)`."""

from ratfit.gallery._card import Card as Card
from ratfit.gallery._card import card as card
from ratfit.gallery._card import cards as cards
from ratfit.gallery._card import find_problem as find_problem
from ratfit.gallery._card import is_card as is_card
from ratfit.gallery._card import is_known as is_known
from ratfit.gallery._card import names as names
