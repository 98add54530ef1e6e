"""Polynomials and their ratios multiplied and added, refused where they grow too large."""

from __future__ import annotations

import functools
import math
from typing import Any

from ratfit._schedule.context import Refused

_MOST_TERMS = 100  # of a polynomial
_MOST_DEGREE = 64
MOST_VOLUME = 300  # monomials up to a polynomial's degrees: the time of gcd and factorisation grows with them


def volume(polynomial: Any) -> int:
    return math.prod(max(degree, 0) + 1 for degree in polynomial.degrees())


def _short(polynomial: Any) -> Any:
    if len(polynomial) > _MOST_TERMS:
        raise Refused
    return polynomial


def _times(a: Any, b: Any) -> Any:
    if len(a) * len(b) > 4 * _MOST_TERMS:
        raise Refused
    return _short(a * b)


def raised(a: Any, exponent: int) -> Any:
    if exponent * max(map(sum, a.monoms()), default=0) > _MOST_DEGREE:
        raise Refused
    return functools.reduce(_times, [a] * exponent, a.ring(1))


def added(a: tuple[Any, Any], b: tuple[Any, Any]) -> tuple[Any, Any]:
    if a[1] == b[1]:
        return _short(a[0] + b[0]), a[1]
    if max(volume(a[1]), volume(b[1])) > MOST_VOLUME:
        raise Refused
    _, left, right = a[1].cofactors(b[1])
    return _short(_times(a[0], right) + _times(b[0], left)), _times(a[1], right)


def multiplied(a: tuple[Any, Any], b: tuple[Any, Any]) -> tuple[Any, Any]:
    return _times(a[0], b[0]), _times(a[1], b[1])
