"""What a measurement is asked at: parts of the domain and values of parameters that make no sense are refused."""

import math

import pytest
import sympy as sp

import ratfit as rf
from ratfit._setting import setting


@pytest.fixture(scope="module")
def smith():
    return rf.derive("eq19")


@pytest.mark.parametrize(
    ("options", "fragment"),
    [
        ({"within": (0,)}, "give two floats"),
        ({"within": (0, 0.5, 1)}, "give two floats"),
        ({"within": "ab"}, "within = 'ab'"),
        ({"within": ("0", "1")}, "give two floats"),
        ({"within": (0, sp.pi / 4)}, "give two floats"),
        ({"within": 3}, "within = 3"),
        ({"within": (0.5, 0.5)}, "empty or reversed"),
        ({"within": (1, 0)}, "empty or reversed"),
        ({"within": (math.nan, 1)}, "cannot be sampled"),
        ({"within": (0, 2)}, "not inside the domain"),
        ({"parameters": [0.2]}, "give values by name, as in {'m': 0.2}"),
        ({"parameters": {"m": math.nan}}, "outside its range"),
        ({"parameters": {"m": "0.2"}}, "a number is needed"),
        ({"reference": 3}, "no reference 3"),
    ],
    ids=str,
)
def test_bad_input_is_said_in_one_line(smith, options, fragment):
    with pytest.raises(rf.RatfitError) as refused:
        setting(smith, **{"parameters": {"m": 0.2}, **options})
    assert fragment in str(refused.value) and "\n" not in str(refused.value)


def test_a_part_of_the_domain(smith):
    at = setting(smith, {"m": sp.Rational(1, 5)}, within=[0, 0.5])
    assert (at.low, at.high, at.parameters) == (0, 0.5, {"m": 0.2})
