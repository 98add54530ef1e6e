"""Errors: closed forms worked out by hand, an independent NumPy computation, traps, and what must be refused.

One pair of functions serves most tests, since a pass over it is compiled once for each protocol and dtype: its
coefficients are parameters, which enter at run time.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import jax
import mpmath
import numpy as np
import pytest
import sympy as sp

from ratfit._error import DEFINITIONS, measure_error
from ratfit._error.chunk import GROUP
from ratfit._error.definitions import QUANTILES, quantile
from ratfit._error.poles import poles_of
from ratfit._parse import RatfitError
from ratfit._problem import Reference
from ratfit._sampling import count, draw
from ratfit._setting import setting
from ratfit._target import Target, parameter

x = sp.Symbol("x")
a, b = parameter("a", 0, 2), parameter("b", "1/10", 1)
HALF = sp.Rational(1, 2)
DTYPES = ["float16", "float32", "float64"]


@dataclass(frozen=True)
class Problem:
    variable: sp.Symbol
    domain: tuple[sp.Expr, sp.Expr]
    target: Target | None
    parameters: tuple[sp.Symbol, ...] = ()
    references: tuple[Reference, ...] = ()


@dataclass(frozen=True)
class Fit:
    problem: Problem
    formula: sp.Expr
    free: Mapping[sp.Symbol, tuple[sp.Expr, sp.Expr]] = field(default_factory=dict)
    conditions: tuple[object, ...] = ()


def fit(exact, formula, domain=(0, 1), parameters=()):
    target = Target(sp.sympify(exact), x, domain)
    return Fit(Problem(x, target.domain, target, parameters), sp.sympify(formula))


# --- The pair: c0 + c1 x + c2 x^2 + c3 sin(x) + c4 exp(c5 x) + residue/(x - pole), nan beyond `end` ---

NAMES = ("c0", "c1", "c2", "c3", "c4", "c5", "zero", "end", "residue", "pole")
HUGE = 17 * sp.Integer(10) ** 307


def written(prefix):
    symbols = [parameter(prefix + name, -HUGE, HUGE) for name in NAMES]
    c0, c1, c2, c3, c4, c5, zero, end, residue, pole = symbols
    smooth = c0 + c1 * x + c2 * x**2 + c3 * sp.sin(x) + c4 * sp.exp(c5 * x)
    return smooth + zero * sp.sqrt(end - x) + residue / (x - pole), symbols


(EXACT, _EXACT), (FIT, _FIT) = written("exact_"), written("fit_")
ENDS = parameter("low", -HUGE, HUGE), parameter("high", -HUGE, HUGE)
PAIR = Fit(Problem(x, ENDS, SimpleNamespace(expression=EXACT), (*_EXACT, *_FIT, *ENDS)), FIT)


def values(exact, approximation, domain):
    """The parameters of the pair, from its coefficients: those by name, or (c0, c1, ...) that are 0 where they end."""
    found = dict(zip(("low", "high"), domain, strict=True))
    for prefix, given in (("exact_", exact), ("fit_", approximation)):
        known = given if isinstance(given, dict) else {f"c{place}": value for place, value in enumerate(given)}
        found |= {prefix + name: known.get(name, 1e4 if name in ("end", "pole") else 0.0) for name in NAMES}
    return found


def measure(exact, approximation, domain=(0, 1), **options):
    return measure_error(PAIR, parameters=values(exact, approximation, domain), **options)


# --- Errors in closed form ---


def statistics(mean, rms, most, bias, peak, extent, size):
    """The errors' own statistics, and over the peak, the range and the mean size of the exact function."""
    found = {"mean": mean, "rms": rms, "max": most, "bias": bias}
    norms = {"absolute": 1, "peak": peak, "range": extent, "mean": size}
    return {f"{norm}_{name}": value / over for norm, over in norms.items() for name, value in found.items()}


def closed(errors, relative, ulp, absolute_quantile, relative_quantile):
    """All definitions; `ulp` is (mean, max) in units of the exact function's least binade, 1 <= size < 2."""
    names = ("mean", "rms", "max", "bias")
    found = statistics(*errors) | {f"relative_{n}": value for n, value in zip(names, relative, strict=True)}
    found |= {f"ulp_{name}": value for name, value in zip(("mean", "max"), ulp, strict=True)}
    for name, function in (("absolute", absolute_quantile), ("relative", relative_quantile)):
        found |= {f"{name}_{suffix}": function(share) for suffix, share in QUANTILES.items()}
    return found


def sine_over_ulp():
    """mean(sin(x) / ulp(2 x)) on [0, pi] in units of 2**-bits: 2 x is in [2**j, 2**(j + 1)) for x in half of that."""
    binades = ((2.0**j, min(2.0**j, math.pi), 2.0 ** (j - 1)) for j in range(2, -60, -1))
    return sum((math.cos(low) - math.cos(high)) / ulp for ulp, high, low in binades) / math.pi


CLOSED = {
    "x + 1/8": (
        ((0, 1), (1 / 8, 1), (1, 3)),
        closed(
            (1 / 8, 1 / 8, 1 / 8, 1 / 8, 3, 2, 2),
            (math.log(3) / 16, math.sqrt(1 / 192), 1 / 8, math.log(3) / 16),
            (3 / 32, 1 / 8),
            lambda share: 1 / 8,
            lambda share: 1 / (8 * (3 - 2 * share)),
        ),
        1.0,
    ),
    "x^2 for x": (
        ((0, 1), (0, 0, 1), (0, 1)),
        closed(
            (1 / 6, math.sqrt(1 / 30), 1 / 4, -1 / 6, 1, 1, 1 / 2),
            (1 / 2, math.sqrt(1 / 3), 1, -1 / 2),
            # Between a = 2**-k and 2 a the mean over a is 3 a / 2 - 7 a^2 / 3; the sums of a and a^2 are 1 and 1/3.
            (13 / 18, 2),
            lambda share: (1 - (1 - share) ** 2) / 4,
            lambda share: share,
        ),
        0.0,
    ),
    "-2 x - sin(x)": (
        ((0, -2), (0, -2, 0, -1), (0, math.pi)),
        closed(
            (2 / math.pi, math.sqrt(1 / 2), 1, -2 / math.pi, 2 * math.pi, 2 * math.pi, math.pi),
            (
                float(mpmath.si(mpmath.pi) / (2 * mpmath.pi)),
                float(mpmath.sqrt(mpmath.si(2 * mpmath.pi) / (4 * mpmath.pi))),
                1 / 2,
                float(mpmath.si(mpmath.pi) / (2 * mpmath.pi)),
            ),
            (sine_over_ulp(), 1),
            lambda share: math.sin(math.pi * share / 2),
            lambda share: math.sin(math.pi * share) / (2 * math.pi * (1 - share)),
        ),
        0.0,
    ),
    "x / 2 for x": (
        ((0, 1), (0, 1 / 2), (-1, 1)),
        closed(
            (1 / 4, math.sqrt(1 / 12), 1 / 2, 0, 1, 2, 1 / 2),
            (1 / 2, 1 / 2, 1 / 2, -1 / 2),
            (3 / 4, 1),
            lambda share: share / 2,
            lambda share: 1 / 2,
        ),
        None,
    ),
}


@pytest.mark.parametrize("dtype", DTYPES)
@pytest.mark.parametrize("case", CLOSED)
def test_every_definition_in_closed_form(case, dtype):
    (exact, approximation, domain), expected, worst = CLOSED[case]
    found = measure(exact, approximation, domain, dtype=dtype, samples=2**18)
    assert list(found.epsilon) == list(DEFINITIONS)
    assert found.epsilon.keys() == expected.keys()
    bits = 2.0 ** np.finfo(dtype).nmant
    # A mean of a chunk of points is known to some 1e-3, a quantile to 0.8 %, a value in float16 to 1e-3 of the exact.
    for name, value in expected.items():
        close = 0.03 if dtype == "float16" else 0.011 if "_q" in name else 0.005
        value *= bits if name.startswith("ulp") else 1
        assert found.epsilon[name] == pytest.approx(value, rel=close, abs=2e-3), name
    assert (found.worst["definition"], found.nonfinite, found.poles) == ("relative_max", 0, ())
    if worst is not None:
        assert found.worst["at"] == pytest.approx(worst, abs=0.02)


@pytest.mark.parametrize("dtype", DTYPES)
def test_the_definitions_agree_with_an_independent_computation(dtype):
    found = measure((-0.25, 0, 0.75), (0.25, 0.5), (-1, 2), samples=12_345, seed=3, dtype=dtype)
    points = np.asarray(draw("uniform", -1.0, 2.0, 3, 0, 12_345, dtype))
    approximation = (points / 2 + points.dtype.type(0.25)).astype(float)  # half a number is exact: one rounding
    exact = 0.75 * points.astype(float) ** 2 - 0.25
    error = approximation - exact
    least = np.finfo(dtype).smallest_normal
    ulp = np.exp2(np.floor(np.log2(np.maximum(abs(exact), float(least)))) - np.finfo(dtype).nmant)
    mean = lambda terms: math.fsum(terms) / len(terms)  # noqa: E731  # a name for one division
    expected = statistics(
        mean(abs(error)), math.sqrt(mean(error**2)), abs(error).max(), mean(error), abs(exact).max(),
        exact.max() - exact.min(), mean(abs(exact)),
    )  # fmt: skip
    relative = error[exact != 0] / exact[exact != 0]
    expected |= {
        "relative_mean": mean(abs(relative)), "relative_rms": math.sqrt(mean(relative**2)),
        "relative_max": abs(relative).max(), "relative_bias": mean(relative),
        "ulp_mean": mean(abs(error) / ulp), "ulp_max": (abs(error) / ulp).max(),
    }  # fmt: skip
    assert {name: found.epsilon[name] for name in expected} == pytest.approx(expected, rel=1e-10)
    for name, errors in (("absolute", abs(error)), ("relative", abs(relative))):
        for suffix, share in QUANTILES.items():
            true = np.quantile(errors, share, method="inverted_cdf")
            assert found.epsilon[f"{name}_{suffix}"] == pytest.approx(true, rel=1 / 128)
    # Of a worst point that was drawn twice, float16's, the first counts; it has no other place all the same.
    assert found.places["absolute_max"]["at"] == points[abs(error).argmax()]
    assert found.places["ulp_max"]["at"] == points[(abs(error) / ulp).argmax()]
    assert found.worst == {"definition": "relative_max", "at": points[exact != 0][abs(relative).argmax()]}
    assert (found.samples, found.sampling, found.seed, found.dtype) == (12_345, "uniform", 3, dtype)


@pytest.mark.parametrize("dtype", DTYPES)
def test_an_ulp_is_the_spacing_of_the_dtype_at_the_exact_value(dtype):
    about = np.finfo(dtype)
    normal, least = about.smallest_normal, about.smallest_subnormal
    kind = normal.dtype.type
    below = np.nextafter(kind(2), kind(0))
    sizes = [kind(0), kind(1), kind(1.5), kind(2), below, kind(-2), about.max / kind(2), normal, 2 * normal, least]
    for size in sizes:
        away = float(max(abs(size), normal)) * (1 if size < 0 else -1)
        found = measure((float(size),), (away,), samples=10, dtype=dtype)
        # XLA takes what is below float64's normal numbers for 0; the spacing there is that at 0.
        error = abs(float(size) - away)
        assert found.epsilon["ulp_mean"] == pytest.approx(found.epsilon["ulp_max"], rel=GROUP * 2.0**-53, abs=0)
        assert found.epsilon["ulp_max"] == pytest.approx(error / float(np.spacing(abs(size))), rel=1e-15), size


@pytest.mark.parametrize("error", [1e-50, 0.3, 1.0, 1.999, 2.0, 3e18])
def test_a_quantile_is_within_its_resolution(error):
    place = (math.frexp(error)[1] - 1 + 192) * 64 + int((math.frexp(error)[0] * 2 - 1) * 64)
    assert quantile({place: 1}, 0.5) == pytest.approx(error, rel=0.0079)
    assert quantile({0: 1, place: 9}, 0.1) == 0
    assert quantile({0: 1, place: 9}, 0.11) == pytest.approx(error, rel=0.0079)
    assert quantile({}, 0.5) is None


# --- What the measurement rests on ---


def test_a_fit_that_is_the_exact_function_has_no_error():
    # Arranged for speed, the sum is rounded otherwise than as it is written.
    same = x + x**2 / 3 + x**3 / 7 + sp.sqrt(x) * x**2
    found = measure_error(fit(same, same), samples=10_000, dtype="float64")
    assert set(found.epsilon.values()) == {0}
    assert set(found.curve["absolute_max"]) == {0}


@pytest.mark.parametrize("dtype", DTYPES)
@pytest.mark.parametrize("coefficients", [(0, 1), (0, -0.5), (0,), (3,)])
def test_where_the_arithmetic_is_exact_there_is_no_error(coefficients, dtype):
    found = measure(coefficients, coefficients, (-1, 1), samples=10_000, dtype=dtype)
    zero_everywhere = coefficients == (0,)
    assert {name for name, value in found.epsilon.items() if value != 0} == (
        {n for n in DEFINITIONS if n.split("_")[0] in ("peak", "range", "mean", "relative")} if zero_everywhere
        else {n for n in DEFINITIONS if n.startswith("range")} if coefficients == (3,) else set()
    )  # fmt: skip
    assert found.nonfinite == 0


def test_the_exact_function_is_float64_whatever_the_dtype():
    found = measure((0, 0.1), (0, 0.1), samples=10_000)
    assert 1e-9 < found.epsilon["relative_bias"] < 2.0**-23  # of 0.1 in float32, which is 1.5e-8 too great
    assert measure((0, 0.1), (0, 0.1), samples=10_000, dtype="float64").epsilon["relative_max"] == 0


def test_the_seed_decides():
    first, again, other = (measure((0, 1), (0, 0, 1), samples=1000, seed=seed) for seed in (1, 1, 2))
    assert first == again
    assert first.epsilon["peak_mean"] != other.epsilon["peak_mean"]


@pytest.mark.parametrize("wide", [False, True])
def test_the_precision_of_the_user_is_neither_changed_nor_used(wide):
    before = jax.config.jax_enable_x64
    expected = measure((0, 0.1), (0, 0, 1), samples=1000)
    with jax.enable_x64(wide):
        assert measure((0, 0.1), (0, 0, 1), samples=1000) == expected
        assert jax.config.jax_enable_x64 is wide
    assert jax.config.jax_enable_x64 is before


def test_the_curve_shows_the_error_over_the_domain():
    curve = measure((0, 1), (1 / 8, 1), (1, 3), samples=10).curve
    assert (curve["edges"][0], curve["edges"][-1], len(curve["edges"])) == (1, 3, 257)
    assert set(curve["bias"]) == set(curve["absolute_max"]) == {1 / 8}
    holed = measure((0, 1), {"c1": 1, "end": 2}, (1, 3), samples=10).curve
    assert [value is None for value in holed["absolute_max"]] == [False] * 128 + [True] * 128


# --- Non-finite values, zeros, what is beyond the numbers ---


@pytest.mark.parametrize("hole", ["exact", "fit"])
def test_nonfinite_values_are_counted_by_kind_and_left_out(hole):
    whole, holed = {"c0": 0.0, "c1": 1.0}, {"c1": 1.0, "c4": 1e-300, "c5": 5e3, "end": 0.75}
    pair = (holed, {**whole, "c0": 1.0}) if hole == "exact" else (whole, {**holed, "c0": 1.0})
    found = measure(*pair, samples=10_000, dtype="float64")
    points = np.asarray(draw("uniform", 0.0, 1.0, 0, 0, 10_000))
    # The square root of a negative number is nan; 1e-300 exp(5000 x) is beyond the numbers somewhere before that.
    beyond = math.log(np.finfo(float).max) / 5e3
    nan, inf = int((points > 0.75).sum()), int(((points > beyond) & (points <= 0.75)).sum())
    sound = {f"{kind}_{'fit' if hole == 'exact' else 'exact'}": 0 for kind in ("nan", "inf")}
    assert found.counts == {f"nan_{hole}": nan, f"inf_{hole}": inf, **sound}
    assert found.nonfinite == nan + inf
    assert f"left out: {nan} nan of the {hole}, {inf} inf of the {hole}" in found.note


def test_where_both_are_nan_the_exact_function_is_no_part_of_the_mean():
    holed = {"c0": 2.0, "end": 0.5}
    found = measure(holed, {"c0": 3.0, "end": 0.5}, samples=10_000, dtype="float64")
    assert found.counts["nan_fit"] == found.counts["nan_exact"] == found.nonfinite > 4000
    assert (found.epsilon["mean_mean"], found.epsilon["mean_max"], found.epsilon["peak_mean"]) == (0.5, 0.5, 0.5)


def test_the_norms_know_the_exact_function_where_the_fit_is_not_finite():
    found = measure({"c1": 1.0}, {"c0": 1.0, "c1": 1.0, "end": 0.5}, samples=10_000, dtype="float64")
    assert found.epsilon["peak_max"] == pytest.approx(1, rel=1e-3)
    assert found.epsilon["mean_mean"] == pytest.approx(2, rel=2e-2)


def test_nothing_finite_is_none_everywhere():
    found = measure((0, 1), {"c1": 1.0, "end": -1.0}, samples=1000)
    assert (found.nonfinite, set(found.epsilon.values())) == (1000, {None})
    assert found.worst == {"definition": "absolute_max", "at": None}
    assert "no sample is finite in float32" in found.note


def test_constants_beyond_the_dtype_are_said_to_be():
    found = measure((1e200,), (1e200,), samples=1000)
    assert found.counts["inf_fit"] == found.nonfinite == 1000
    assert "its constants or values leave that type's range" in found.note
    assert measure((1e200,), (1e200,), samples=1000, dtype="float64").epsilon["absolute_max"] == 0


def test_where_the_exact_function_is_zero_there_is_no_relative_error():
    zero = measure((0,), (0, 1), samples=1000)
    named = {name for name, value in zero.epsilon.items() if value is not None}
    assert named == {name for name in DEFINITIONS if name.startswith(("absolute", "ulp"))}
    assert zero.worst == {"definition": "absolute_max", "at": zero.epsilon["absolute_max"]}


@pytest.mark.parametrize("size", [1e200, 1e-200])
def test_a_sum_or_square_beyond_float64_is_none_and_the_rest_stands(size):
    found = measure((0,), (size,), samples=1000, dtype="float64").epsilon
    assert found["absolute_rms"] is None
    assert found["absolute_max"] == size
    assert (found["absolute_mean"], found["absolute_bias"]) == pytest.approx((size, size), rel=GROUP * 2.0**-53, abs=0)
    # The bins end at 2**-192, where 0 is near enough, and at 2**64, beyond which nothing is known.
    assert found["absolute_q50"] == (None if size > 1 else 0)


def test_a_difference_beyond_float64_is_none_and_no_nan():
    found = measure((1.5e308,), (-1.5e308,), samples=1000, dtype="float64")
    assert {value for name, value in found.epsilon.items() if name.startswith("absolute")} == {None}
    assert found.nonfinite == 0


# --- Every number of a dtype ---


def test_every_float16_of_the_domain_is_visited():
    condition = SimpleNamespace(kind="value", at=sp.Integer(0))
    kept = SimpleNamespace(condition=condition, demand=sp.Integer(0))
    lost = SimpleNamespace(condition=SimpleNamespace(kind="value", at=HALF), demand=sp.Rational(1, 3))
    irrational = SimpleNamespace(condition=SimpleNamespace(kind="value", at=sp.pi / 4), demand=sp.Integer(0))
    known = Fit(PAIR.problem, FIT, conditions=(kept, lost, irrational))
    options = {"sampling": "exhaustive", "samples": None, "dtype": "float16"}
    found = measure_error(known, parameters=values((0, 1), (0, 0, 1), (-1, 1)), **options)
    numbers = np.arange(0, 0x3C01, dtype=np.uint16).view(np.float16)
    numbers = np.concatenate([-numbers[::-1], numbers])  # from -1 to 1 with -0.0 and 0.0
    exact, squares = numbers.astype(float), (numbers * numbers).astype(float)
    assert found.samples == len(numbers) == count(-1, 1, "float16")
    assert found.epsilon["absolute_max"] == 2
    assert found.epsilon["absolute_mean"] == pytest.approx(math.fsum(abs(squares - exact)) / len(numbers), rel=1e-14)
    assert found.epsilon["ulp_max"] == (abs(squares - exact) / np.spacing(abs(numbers)).astype(float)).max()
    assert [each.holds for each in found.kept] == [True, False]  # at pi/4 there is no number
    assert "f(0) == 0 bit for bit" in found.note
    assert "f(0.5) is 0.25, not 0.333" in found.note


@pytest.mark.parametrize("dtype", ["float16", "float32"])
def test_both_zeros_and_subnormal_numbers_have_no_error_under_the_identity(dtype):
    least, normal = (float(getattr(np.finfo(dtype), name)) for name in ("smallest_subnormal", "smallest_normal"))
    options = {"sampling": "exhaustive", "samples": None, "dtype": dtype}
    around = (normal - 500 * least, normal + 500 * least)
    found = measure((0, 1), (0, 1), around, **options)
    assert (found.samples, found.nonfinite) == (1001, 0)
    assert {found.epsilon[name] for name in ("absolute_max", "relative_max", "ulp_max", "absolute_q999")} == {0}
    flushes = dtype == "float32" and float(jax.jit(lambda n: n + n)(np.float32(1e-40))) == 0
    assert ("500 samples are subnormal" in found.note) is flushes


def test_a_domain_of_subnormal_numbers_is_refused():
    with pytest.raises(RatfitError, match="subnormal numbers are not drawn"):
        measure((0, 1), (0, 1), (0, 1e-40), sampling="exhaustive", samples=None)


# --- Poles ---

POLES = {
    "inside": (x, 1 / (x - HALF), [0.5]),
    "double": (x, 1 / (x - HALF) ** 2, [0.5]),
    "double, not factored": (x, 1 / (x**2 - x + HALF**2), [0.5]),
    "of a third order root": (x, (x - HALF) ** -sp.Rational(1, 3), [0.5]),
    "at the lower end": (x, 1 / x, [0]),
    "at the upper end": (x, 1 / (1 - x), [1]),
    "two": (x, 1 / (x * (x - HALF)), [0, 0.5]),
    "outside": (x, 1 / (x + HALF), []),
    "just outside": (x, 1 / (x + sp.Rational(1, 10**9)), []),
    "of a tangent": (x, sp.tan(sp.pi * x), [0.5]),
    "essential": (x, sp.exp(1 / x), [0]),
    "of an absolute value": (x, 1 / sp.Abs(x - HALF), [0.5]),
    "of a logarithm of a sort": (x, 1 / sp.log(x + HALF), [0.5]),
    "in the denominator's denominator": (x, 1 / (1 + 1 / (x - HALF)), []),
    "removable": (x, (x**2 - HALF**2) / (x - HALF), []),
    "tiny residue": (x, sp.Rational(1, 10**30) / (x - HALF), [0.5]),
    "shared with the target": (1 / (x - HALF) + x, 1 / (x - HALF), []),
    "of the target alone": (1 / (x - HALF), x, []),
    "of the target at an end": (1 / x, (1 + x) / x, []),
}


@pytest.mark.parametrize("case", POLES)
def test_poles_of_the_fit_alone_are_found(case):
    exact, formula, expected = POLES[case]
    assert poles_of(setting(fit(exact, formula))) == pytest.approx(tuple(expected), abs=1e-12)


def test_a_pole_at_an_end_that_is_no_float():
    assert poles_of(setting(fit(x, 1 / sp.cos(x), (0, sp.pi / 2)))) == (math.pi / 2,)
    end = float(1000 * sp.pi)
    assert poles_of(setting(fit(x, 1 / (x - 1000 * sp.pi), (0, 1000 * sp.pi)))) == (end,)


def test_a_pole_at_some_values_of_a_parameter_that_is_drawn():
    moving = fit(x, 1 / (x + 1 - a), (0, HALF), (a,))
    assert poles_of(setting(moving, {"a": 0.5})) == ()
    assert poles_of(setting(moving, {"a": 1.25})) == (0.25,)
    assert all(0 <= at <= 0.5 for at in poles_of(setting(moving, {"a": "random"})))
    assert poles_of(setting(moving, {"a": "random"}))
    assert poles_of(setting(fit(x, b / (x - HALF), parameters=(b,)), {"b": "random"})) == (0.5,)


def test_a_pole_is_reported_and_not_averaged():
    found = measure((0, 1), {"residue": 1, "pole": 1 / 3}, samples=1000)
    assert found.poles == (1 / 3,)
    assert {name for name, value in found.epsilon.items() if value is not None} == {n for n in DEFINITIONS if "_q" in n}
    assert "pole of the fit at x = 0.333333: no mean or maximum has a meaning" in found.note


# --- Parameters, references, refusals ---


def test_parameters_reach_the_fit_the_target_and_the_domain():
    scaled = fit(a * x, a * x + b, (0, b), (a, b))
    place = setting(scaled, {"b": 0.5, "a": 2})
    assert (place.low, place.high, list(place.parameters.items())) == (0, 0.5, [("a", 2.0), ("b", 0.5)])
    assert measure((0, 1), (0, 1), (1, 3), samples=10).parameters == values((0, 1), (0, 1), (1, 3))


def test_a_measurement_in_a_notebook_is_one_line():
    found = measure_error(fit(x, x + a, parameters=(a,)), samples=1000, parameters={"a": "random"}, dtype="float64")
    exact = measure_error(fit(x, x + a, parameters=(a,)), samples=1000, parameters={"a": 0.0}, dtype="float64")
    assert repr(exact).startswith("<eps peak_mean 0, peak_max 0, relative_mean 0, relative_max 0, ulp_max 0; uniform, ")
    assert repr(found).startswith("<eps peak_mean ") and "1,000 samples, a random in [0, 2]" in repr(found)
    assert repr(replace(found, epsilon={}, reference="other")).endswith(", against other>")


@pytest.mark.parametrize(
    ("parameters", "named"),
    [
        ({"a": 2.5, "b": 0.5}, r"a = 2\.5 is outside its range \[0\.0, 2\.0\]"),
        ({"a": 1, "b": math.nan}, "outside its range"),
        ({"a": 1}, "parameter b has no value"),
        ({"a": 1, "b": 0.5, "c": 1}, "no parameter 'c'"),
        ({"a": "1", "b": 0.5}, "a = '1': a number is needed, or 'random'"),
        ({"a": "rnd", "b": 0.5}, "a = 'rnd': .*did you mean 'random'"),
        ({"a": 1, "b": "random"}, "the domain depends on b, which cannot be random"),
        ({"a": 1, "b": 0.5, "c": "random"}, "no parameter 'c' to draw"),
    ],
)
def test_parameters_that_cannot_be_are_refused(parameters, named):
    with pytest.raises(RatfitError, match=named):
        measure_error(fit(a * x, a * x + b, (0, b), (a, b)), parameters=parameters)


def test_parameters_are_drawn_at_random_with_every_sample():
    found = measure_error(fit(x, x + a, parameters=(a,)), samples=100_000, parameters={"a": "random"}, dtype="float64")
    assert found.parameters == {"a": (0.0, 2.0)}
    assert found.epsilon["absolute_mean"] == pytest.approx(1, rel=5e-3)  # a is uniform on [0, 2]
    assert found.epsilon["absolute_rms"] == pytest.approx(math.sqrt(4 / 3), rel=5e-3)
    assert found.places["absolute_max"]["a"] == pytest.approx(found.epsilon["absolute_max"], rel=1e-12)
    curve = found.curve["parameters"]["a"]
    assert curve["absolute_max"] == pytest.approx(curve["values"])
    with pytest.raises(RatfitError, match="exhaustive draws no parameter at random"):
        measure_error(fit(x, x + a, parameters=(a,)), samples=None, sampling="exhaustive", parameters={"a": "random"})


def test_a_reference_takes_the_place_of_the_target_and_gives_values():
    n = sp.Symbol("n")
    dielectric = Reference("dielectric", a + n * x, "", {n: sp.Rational(3, 2)})
    derived = Reference("derived", a * x, "", {a: n / 2, n: sp.Rational(3, 2)})
    known = Fit(Problem(x, (sp.Integer(0), sp.Integer(1)), None, (a,), (dielectric, derived)), a + x)
    place = setting(known, {"a": 1}, "dielectric")
    assert (place.parameters, place.exact) == ({"a": 1.0, "n": 1.5}, a + n * x)
    assert setting(known, reference="derived").parameters == {"a": 0.75, "n": 1.5}
    with pytest.raises(RatfitError, match=r"no target.*dielectric, derived"):
        measure_error(known, parameters={"a": 1})
    with pytest.raises(RatfitError, match="did you mean 'dielectric'"):
        measure_error(known, reference="dialectric", parameters={"a": 1})
    with pytest.raises(RatfitError, match=r"the reference says n = 1\.5"):
        measure_error(known, reference="dielectric", parameters={"a": 1, "n": 2})


@pytest.mark.parametrize(
    ("measured", "options", "named"),
    [
        (fit(x, x), {"samples": 0}, "samples = 0"),
        (fit(x, x), {"samples": None}, "samples = None"),
        (fit(x, x), {"sampling": "exhaustive"}, "leave samples out"),
        (fit(x, x), {"sampling": "exhaustive", "samples": None, "dtype": "float64"}, "float64 has too many numbers"),
        (fit(x, x), {"dtype": "float8"}, "float8.*float16, float32 or float64"),
        (fit(x, x), {"sampling": "sobel"}, "sobol"),
        (fit(x, x), {"reference": "sine"}, "there is: none"),
        (fit(x, x ** sp.Symbol("n")), {}, r"still free: n.*--set n="),
        (fit(x, x, (0, sp.oo)), {}, "finite ends"),
        (fit(x, x, (1, 1 + sp.Rational(1, 10**9))), {}, "no float32 number lies between"),
        (fit(sp.Function("f")(x), x), {}, "no f"),
    ],
    ids=str,
)
def test_what_cannot_be_measured_is_refused(measured, options, named):
    with pytest.raises(RatfitError, match=named):
        measure_error(measured, **options)
