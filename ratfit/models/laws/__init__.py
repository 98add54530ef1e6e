"""The laws that a reflectance is to keep, each as a measurement: one law a file."""

from ratfit.models.laws.law import FAILS as FAILS
from ratfit.models.laws.law import HOLDS as HOLDS
from ratfit.models.laws.law import NOT_APPLICABLE as NOT_APPLICABLE
from ratfit.models.laws.law import UNDECIDED as UNDECIDED
from ratfit.models.laws.law import Law as Law
