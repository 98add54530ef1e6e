"""The operations of ball tapes: sympy's functions on arb and acb, with their branch cuts."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from typing import Any

import sympy as sp
from flint import acb, arb

from ratfit._lower import repeated_product

Operation = Callable[..., Any]

UNDEFINED = acb(arb.nan(), arb.nan())

# Analytic wherever they are finite: no branch cut, and at a pole the ball is not finite by itself.
MEROMORPHIC: Mapping[Any, Operation] = {
    function: operator.methodcaller(name)
    for function, name in {
        sp.exp: "exp", sp.sin: "sin", sp.cos: "cos", sp.tan: "tan", sp.sec: "sec", sp.csc: "csc", sp.cot: "cot",
        sp.sinh: "sinh", sp.cosh: "cosh", sp.tanh: "tanh", sp.sech: "sech", sp.csch: "csch", sp.coth: "coth",
        sp.erf: "erf", sp.erfc: "erfc", sp.gamma: "gamma", sp.sinc: "sinc",
    }.items()
}  # fmt: skip


def _off_unit_rays(z: acb) -> bool:
    """Clear of the real numbers of modulus 1 and more: the cuts of asin, acos and atanh."""
    return not z.imag.contains(0) or bool(abs(z.real) < 1)


def _off_imaginary_rays(z: acb) -> bool:
    return not z.real.contains(0) or bool(abs(z.imag) < 1)


_CLEAR: Mapping[Any, tuple[str, Callable[[acb], bool]]] = {
    sp.asin: ("asin", _off_unit_rays), sp.acos: ("acos", _off_unit_rays), sp.atanh: ("atanh", _off_unit_rays),
    sp.atan: ("atan", _off_imaginary_rays), sp.asinh: ("asinh", _off_imaginary_rays),
    sp.acosh: ("acosh", lambda z: not z.imag.contains(0) or bool(z.real > 1)),
    sp.loggamma: ("lgamma", lambda z: not z.imag.contains(0) or bool(z.real > 0)),
}  # fmt: skip


def _cut(name: str, clear: Callable[[acb], bool]) -> Operation:
    """A function of whose cut python-flint does not keep clear by itself."""
    method = operator.methodcaller(name)
    return lambda analytic, z: UNDEFINED if analytic and not clear(z) else method(z)


def square_root(analytic: bool, z: Any) -> Any:
    return z.sqrt(analytic) if isinstance(z, acb) else z.sqrt()


def _logarithm(analytic: bool, z: Any) -> Any:
    return z.log(analytic) if isinstance(z, acb) else z.log()


def _absolute(analytic: bool, z: Any) -> Any:
    return z.real_abs(analytic) if isinstance(z, acb) else abs(z)


def power(analytic: bool, base: Any, exponent: Any) -> Any:
    """The principal power; of a negative real number to a power that is no integer it is complex, hence undefined."""
    if isinstance(base, arb) and isinstance(exponent, arb):
        return base**exponent
    return acb(base).pow(acb(exponent), analytic)


# Analytic off a cut: these take first whether the ball must lie clear of it.
BRANCHED: Mapping[Any, Operation] = {
    sp.log: _logarithm, sp.Abs: _absolute, **{function: _cut(*cut) for function, cut in _CLEAR.items()},
}  # fmt: skip


def root(degree: int) -> Operation:
    def apply(analytic: bool, z: Any) -> Any:
        return z.pow(acb(arb(1) / degree), analytic) if isinstance(z, acb) else z.root(degree)

    return apply


def integer_power(exponent: int) -> Operation:
    """A positive power by squarings: flint's own gives no ball where the base contains 0."""
    return lambda base: repeated_product(base, exponent)
