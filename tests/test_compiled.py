"""The tape as C: what every operation gives, against NumPy on the same tape and against arbitrary precision."""

import ctypes

import mpmath
import numpy as np
import pytest
import sympy as sp

from ratfit._kernel import Program, hoist
from ratfit._lower import Entries, Lookup, Step, lower, tape
from ratfit._parse import RatfitError
from ratfit._speed import available
from ratfit._speed.c_source import c_source
from ratfit._speed.compiled import FAST, SCALAR
from ratfit._speed.compiler import compiler, load, version
from ratfit.gallery import cards

pytestmark = pytest.mark.skipif("c-scalar" not in available(), reason="this machine has no C compiler")

x, y = sp.symbols("x y", real=True)
THIRD = sp.Rational(1, 3)

# What IEEE 754 rounds correctly, and what only selects: equal to NumPy bit for bit, nan included.
EXACT = [
    x, x + y, x - y, x * y, x / y, -x, 1 / x, x**2, x**7, x**-3, sp.sqrt(x), x ** sp.Rational(5, 2), x + THIRD,
    sp.pi * x, -x - 1, sp.Abs(x), sp.sign(x), sp.floor(x), sp.ceiling(x), sp.Heaviside(x), sp.Heaviside(x, y),
    sp.Min(x, y), sp.Max(x, y), sp.Min(x, y, 1), sp.Max(x, -1),
    sp.Piecewise((x, x < y), (y, x > y)),  # nan where neither holds
    sp.Piecewise((1, x <= y), (2, True)), sp.Piecewise((1, x >= y), (2, True)),
    sp.Piecewise((1, sp.Eq(x, y)), (2, True)), sp.Piecewise((1, sp.Ne(x, y)), (2, True)),
    sp.Piecewise((1, (x < 0) & (y < 0)), (2, (x < 0) | (y < 0)), (3, True)),
    sp.Piecewise((1, sp.Not(sp.Eq(x, y)) & (x < 1)), (2, True)),
    Lookup(x, Entries([1.0, 4.0, 2.0, 8.0])), Lookup(2 * x + y, Entries([THIRD, 1.0])),
    sp.Integer(7) / 3, sp.S.NaN, x + sp.Float("1e300"), x * sp.Float("1e-300"),
]  # fmt: skip
CALLS = [
    sp.exp(x), sp.log(x), sp.sin(x), sp.cos(x), sp.tan(x), sp.asin(x), sp.acos(x), sp.atan(x), sp.atan2(x, y),
    sp.sinh(x), sp.cosh(x), sp.tanh(x), sp.asinh(x), sp.acosh(x), sp.atanh(x), sp.erf(x), sp.erfc(x), sp.gamma(x),
    sp.loggamma(x), sp.cbrt(x), x ** sp.Rational(17, 10), x**y, 2**x, sp.sec(x), sp.coth(x),
]  # fmt: skip
ULPS = 10  # glibc promises 1 to 9 for what is here, by function and dtype; NumPy has functions of its own


def special(dtype):
    """Pairs of all special values, and ordinary ones."""
    kind = np.finfo(dtype)
    tiny = [kind.smallest_subnormal, kind.tiny, kind.tiny / 4, kind.max]
    positive = [0.0, 1.0, 0.5, 2.0, 1.5, 3.25, 20.5, float(np.dtype(dtype).type(THIRD)), np.inf, *map(float, tiny)]
    values = np.array([*positive, *(-each for each in positive), np.nan], dtype)
    return tuple(each.ravel() for each in np.meshgrid(values, values))


def ordinary(dtype):
    generator = np.random.default_rng(0)
    return generator.uniform(-4, 4, 2000).astype(dtype), generator.uniform(-4, 4, 2000).astype(dtype)


def compiled(expressions, dtype, flags, arguments=(x, y)):
    """The values of expressions of arrays, from one shared object."""
    tapes = {f"run_{place}": tape(expression, arguments) for place, expression in enumerate(expressions)}
    library = load(c_source(tapes, len(arguments), dtype), flags, compiler())
    return [runner(library[name]) for name in tapes]


def runner(function, constants=()):
    def run(*arrays):
        out, fixed = np.full_like(arrays[0], 12345), np.array(constants, arrays[0].dtype)
        columns = (ctypes.c_void_p * len(arrays))(*(array.ctypes.data for array in arrays))
        function(*map(ctypes.c_void_p, (out.size, ctypes.addressof(columns), fixed.ctypes.data, out.ctypes.data)))
        return out

    return run


def same_bits(found, expected):
    """Equal, nan to nan and zeros with their sign."""
    return (found == expected) & (np.signbit(found) == np.signbit(expected)) | (np.isnan(found) & np.isnan(expected))


def ulps(found, expected):
    """How many units in the last place lie between; 0 between equal infinities and between nans."""
    with np.errstate(invalid="ignore", over="ignore"):
        apart = np.abs(found.astype(float) - expected) / np.spacing(
            np.maximum(np.abs(expected), np.finfo(found.dtype).tiny)
        )
    return np.where((found == expected) | (np.isnan(found) & np.isnan(expected)), 0, apart)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_arithmetic_is_numpys_to_the_bit(dtype):
    for points in (special(dtype), ordinary(dtype)):
        for expression, run in zip(EXACT, compiled(EXACT, dtype, SCALAR), strict=True):
            found, expected = run(*points), lower(expression, (x, y))(*points)
            right = same_bits(found, expected)
            if expression.has(sp.Min, sp.Max, sp.sign, sp.Heaviside):
                right |= (found == 0) & (expected == 0)  # the sign of a zero that was selected is left open
            wrong = np.flatnonzero(~right)[:3]
            assert not wrong.size, (expression, [(a[wrong], found[wrong], expected[wrong]) for a in points])


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_functions_are_numpys_within_a_few_units_in_the_last_place(dtype):
    for points in (special(dtype), ordinary(dtype)):
        for expression, run in zip(CALLS, compiled(CALLS, dtype, SCALAR), strict=True):
            found, expected = run(*points), lower(expression, (x, y))(*points)
            apart = ulps(found, expected)
            if expression.func == sp.loggamma:  # it has zeros at 1 and 2; SciPy's is infinite at denormal numbers
                normal = np.abs(points[0]) >= np.finfo(dtype).tiny
                apart = np.where(normal & (np.abs(points[0] - 1.5) > 0.75), apart, 0)
            wrong = np.flatnonzero(~(apart <= ULPS))[:3]
            assert not wrong.size, (expression, [each[wrong] for each in (*points, found, expected)])


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_fast_functions_are_near_at_ordinary_numbers(dtype):
    points = ordinary(dtype)
    expressions = [sp.sin(x) + 2, sp.exp(x) / (1 + y**2), sp.erfc(x), sp.sqrt(1 + x**2), 1 / (5 + x + y), sp.tanh(x)]
    for expression, run in zip(expressions, compiled(expressions, dtype, FAST), strict=True):
        assert np.max(ulps(run(*points), lower(expression, (x, y))(*points))) <= ULPS, expression


def test_c_gives_the_true_values():
    """Against mpmath, so that NumPy and C are not wrong alike."""
    expressions = [sp.exp(x), sp.erfc(x), sp.gamma(x), sp.cbrt(x), x ** sp.Rational(17, 10), sp.atan(x), sp.coth(x)]
    true = [
        mpmath.exp,
        mpmath.erfc,
        mpmath.gamma,
        mpmath.cbrt,
        lambda v: v ** mpmath.mpf("1.7"),
        mpmath.atan,
        mpmath.coth,
    ]
    points = np.array([0.1875, 0.5, 1.75, 3.0])
    for run, function in zip(compiled(expressions, "float64", SCALAR, (x,)), true, strict=True):
        assert run(points) == pytest.approx([float(function(mpmath.mpf(v))) for v in points], rel=1e-14)


@pytest.mark.parametrize(("dtype", "flags"), [("float32", SCALAR), ("float64", SCALAR), ("float32", FAST)])
def test_every_card_of_the_gallery(dtype, flags):
    """Targets and published formulas at the middle of the parameters' ranges, inside the domain."""
    cases = list(gallery_cases())
    tapes = {f"run_{place}": each[0] for place, each in enumerate(cases)}
    library = load(c_source(tapes, 1, dtype), flags, compiler())
    assert len(cases) >= 20
    for name, (_, function, constants, points) in zip(tapes, cases, strict=True):
        column, fixed = points.astype(dtype), [np.asarray(value).astype(dtype) for value in constants]
        found, expected = runner(library[name], constants)(column), function(column, *fixed)
        single, double = (function(points.astype(kind), *np.array(constants, kind)) for kind in ("float32", "float64"))
        with np.errstate(invalid="ignore"):
            lost = np.nanmax(np.abs(single - double), initial=0, where=np.isfinite(double))
        # What the formula itself loses in float32, and by the same factor in float64.
        allowed = ULPS * np.spacing(np.abs(expected)) + 8 * lost * np.finfo(dtype).eps / np.finfo("float32").eps
        assert np.all((np.abs(found - expected) <= allowed) | same_bits(found, expected)), name


def gallery_cases():
    """Of every expression: its tape, its function on NumPy, the values of its constants, and points of its domain."""
    for card in cards():
        problem = card.problem
        values = {p: float((p.low + p.high) / 2) for p in problem.parameters}
        low, high = (float(sp.sympify(end).subs(values).evalf()) for end in problem.domain)
        points = np.linspace(max(low, -8.0), min(high, 8.0), 403)[1:-1]
        targets = [problem.target.expression] if problem.target is not None else []
        for expression in (*targets, card.published):
            if expression is None or expression.free_symbols - {problem.variable, *values}:
                continue
            hoisted = hoist(Program(expression), (problem.variable,))
            symbols = (problem.variable, *(symbol for symbol, _ in hoisted.constants))
            yield tape(hoisted.result, symbols), lower(hoisted.result, symbols), hoisted.values(values), points


@pytest.mark.parametrize("flags", [SCALAR, FAST])
@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_no_position_leaves_a_table(dtype, flags):
    """A nan or a huge number must not become a place in memory, whatever the compiler assumes of numbers."""
    huge = np.finfo(dtype).max
    points = np.array([np.nan, -np.nan, np.inf, -np.inf, huge, -huge, 3e9, -3e9, 0.5, 1.5, -0.0], dtype)
    tables = [
        Lookup(x, Entries([1.0, 3.0, 2.0])),
        Lookup(x**2, Entries([1.0, 3.0, 2.0])),
        Lookup(1 / x, Entries([1, 2])),
    ]
    for _ in range(20):
        first, *_ = (run(points) for run in compiled(tables, dtype, flags, (x,)))
    assert list(first[4:]) == [2, 1, 2, 1, 2, 2.5, 1]


def test_names_of_a_user_do_not_enter_the_text():
    odd = sp.Symbol('x; } int system(const char *); /* "')
    text = c_source({"run_0": tape(sp.sin(odd) + odd**2, (odd,))}, 1, "float32")
    assert "system" not in text
    assert "sinf(v0)" in text


def test_constants_are_arguments():
    text = c_source({"run_0": tape(x * y + 1, (x, y))}, 1, "float64")
    assert "constants[0]" in text
    assert "samples[1]" not in text


def test_powers_are_multiplied_out_in_the_least_multiplications():
    text = c_source({"run_0": tape(x**7, (x,))}, 1, "float32")
    assert "pow" not in text.partition("void run_0")[2]
    (run,) = compiled([x**7], "float64", SCALAR, (x,))
    assert list(run(np.array([2.0, -3.0]))) == [128, -2187]


def test_what_c_does_not_have():
    with pytest.raises(RatfitError, match="C has no bessel: measure this function with a backend of arrays"):
        c_source({"run_0": (Step("argument", number=0), Step("bessel", (0,)))}, 1, "float32")


def test_the_same_text_is_compiled_once_and_the_compiler_says_its_version():
    text = c_source({"run_0": tape(x, (x,))}, 1, "float32")
    assert load(text, SCALAR, compiler()) is load(text, SCALAR, compiler())
    assert version(compiler())
