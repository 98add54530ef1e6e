"""Kernel conditions: the facts that a fit keeps exactly, one kind a file."""

from ratfit._condition.abstract import AbstractCondition as AbstractCondition
from ratfit._condition.describe import describe as describe
from ratfit._condition.equation import JET as JET
from ratfit._condition.equation import JET_NAMES as JET_NAMES
from ratfit._condition.equation import Equation as Equation
from ratfit._condition.integral import Integral as Integral
from ratfit._condition.limit import Limit as Limit
from ratfit._condition.point import AbstractPointCondition as AbstractPointCondition
from ratfit._condition.point import Derivative as Derivative
from ratfit._condition.point import Value as Value
