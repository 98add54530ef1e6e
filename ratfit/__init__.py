"""ratfit: say what must stay exact; get the cheapest formula that keeps it."""

import importlib
from typing import Any

from ratfit._condition import AbstractCondition as AbstractCondition
from ratfit._condition import Derivative as Derivative
from ratfit._condition import Equation as Equation
from ratfit._condition import Integral as Integral
from ratfit._condition import Limit as Limit
from ratfit._condition import Value as Value
from ratfit._derive import derive as derive
from ratfit._fit import Candidate as Candidate
from ratfit._fit import Checked as Checked
from ratfit._fit import Fit as Fit
from ratfit._form import Form as Form
from ratfit._form import Power as Power
from ratfit._form import Rational as Rational
from ratfit._parse import RatfitError as RatfitError
from ratfit._problem import Problem as Problem
from ratfit._problem import Reference as Reference
from ratfit._problem_file import read_problem as read_problem
from ratfit._target import Parameter as Parameter
from ratfit._target import Target as Target
from ratfit._target import parameter as parameter

__version__ = "0.1.0"

# What needs JAX, or is long and not always needed, is loaded on first use: `import ratfit` stays as light as sympy.
_LATER = {
    "BACKENDS": "ratfit._speed",
    "DEFINITIONS": "ratfit._error",
    "Watch": "ratfit._error",
    "lower": "ratfit._lower",
    "measure_error": "ratfit._error",
    "measure_speed": "ratfit._speed",
    "peers": "ratfit.baselines",
    "schedule": "ratfit._schedule",
    "study": "ratfit._study",
}


def __dir__() -> list[str]:
    return sorted([*(name for name in globals() if name not in ("Any", "importlib")), *_LATER])


def __getattr__(name: str) -> Any:
    if name in _LATER:
        return getattr(importlib.import_module(_LATER[name]), name)
    raise AttributeError(f"module 'ratfit' has no attribute {name!r}")
