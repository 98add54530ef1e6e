"""Sampling: streams to the bit, distributions against their densities, every number of a dtype, what is refused."""

import contextlib
import itertools
import math

import jax
import mpmath
import numpy as np
import pytest
import scipy.stats

from ratfit._parse import RatfitError
from ratfit._sampling import PROTOCOLS, bounds, check_protocol, count, draw, drawing, resolve, sample
from ratfit._sampling.counter import direction_fractions
from ratfit._sampling.ends import ends
from ratfit._sampling.portable import quarter_sine
from ratfit._sampling.protocols import CARRIERS
from ratfit._sampling.sobol import COORDINATES, DIGITS, directions, sobol_fractions

MILLION = 1_000_000


def drawn(sampling, ranges, counters, seed=0, dtype="float64", jit=True):
    """What a kernel gets: an array for each of the ranges."""
    with jax.enable_x64(True), contextlib.nullcontext() if jit else jax.disable_jit():
        traced = jax.jit(drawing(sampling, dtype))
        found = traced(np.uint64(seed), np.asarray(counters, np.uint64), [ends(*each, dtype) for each in ranges])
    return [np.asarray(each) for each in found]


# --- Streams ---


def mixed(bits):
    bits = ((bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9) % 2**64
    bits = ((bits ^ (bits >> 27)) * 0x94D049BB133111EB) % 2**64
    return bits ^ (bits >> 31)


GOLDEN = 0x9E3779B97F4A7C15
ROOT_TWO = math.isqrt(2 << 128) % 2**64 | 1


def fraction(seed, counter, coordinate=0, step=GOLDEN):
    """SplitMix64 in Python's integers: the fraction as a multiple of 2^-53."""
    stream = mixed((seed + GOLDEN) % 2**64)
    for _ in range(coordinate):
        stream = mixed((stream + step) % 2**64)
    return ((mixed((stream + (counter + 1) * GOLDEN) % 2**64) >> 12) + 0.5) / 2**52


def test_sample_is_a_function_of_seed_and_counter_alone():
    many, few = (np.asarray(sample("uniform", 0.0, 1.0, samples, 7)) for samples in (100_000, 1000))
    assert many.dtype == np.float64
    assert (many[:1000] == few).all()
    assert (np.asarray(draw("uniform", 0.0, 1.0, 7, 500, 500)) == few[500:]).all()
    assert not (np.asarray(sample("uniform", 0.0, 1.0, 1000, 8)) == few).any()


def settled(number):
    """The number with its last bit cleared."""
    return np.float64((np.float64(number).view(np.uint64) & np.uint64(2**64 - 2)).view(np.float64)).item()


def test_sample_is_splitmix64_to_the_bit():
    assert mixed(GOLDEN) == 0xE220A8397B1DCDAF  # the first output of SplitMix64 from state 0, as published
    found = np.asarray(sample("uniform", 0.0, 1.0, 3, 2**64 - 1)).tolist()
    assert found == [settled(fraction(2**64 - 1, counter)) for counter in range(3)]


def test_the_parameters_and_the_directions_have_streams_of_their_own():
    counters = [0, 1, 2**40 - 1]
    parameters = drawn("hemisphere:t", [(0, 1)] * 4, counters, seed=3)[1:]
    assert [each.tolist() for each in parameters] == [
        [settled(fraction(3, counter, coordinate)) for counter in counters] for coordinate in (1, 2, 3)
    ]
    with jax.enable_x64(True):
        found = [direction_fractions(np.uint64(3), np.array(counters, np.uint64), each).tolist() for each in range(4)]
    assert found == [[fraction(3, counter, each, ROOT_TWO) for counter in counters] for each in range(4)]
    assert not {settled(each) for each in itertools.chain(*found)} & set(np.ravel(parameters).tolist())


@pytest.mark.thorough
def test_points_depend_on_neither_shape_nor_chunk_nor_kernel():
    """Nor on what a compiler makes of them: without jit every operation is rounded by itself."""
    counters, seed = np.arange(774, dtype=np.uint64), np.uint64(5)

    def points(counters):
        ranges = {name: [row, row] if name == "sobol" else [row] for name in CARRIERS}
        return [each for name in CARRIERS for each in drawing(name, "float64")(seed, counters, ranges[name])]

    with jax.enable_x64(True):
        row = ends(0, 1, "float64")
        square = counters[:129].reshape(3, 43)  # so that vectors of a processor do not divide it
        compiled = jax.jit(lambda: jax.lax.map(lambda start: points(start + square), counters[::129]))()
        with jax.disable_jit():
            alone = points(jax.numpy.asarray(counters))
    for place, (expected, found) in enumerate(zip(alone, compiled, strict=True)):
        assert (np.ravel(found) == np.asarray(expected)).all(), [*CARRIERS, "parameter"][place]


def test_uniform_points_are_the_same_on_every_processor():
    """With a fused multiply-add or without: the product is settled before the sum, which is rounded once."""
    low, high, counters = 1.1, 3.3, np.arange(63, dtype=np.uint64)
    expected = [low + settled((high - low) * fraction(2, counter)) for counter in range(63)]
    for parts in ((counters,), (counters[:1], counters[1:])):
        assert np.concatenate([drawn("uniform", [(low, high)], each, 2)[0] for each in parts]).tolist() == expected


def test_the_sine_of_a_quarter_turn_is_right_to_a_few_units_in_the_last_place():
    turns = np.concatenate([np.linspace(-1, 1, 2001), 2.0 ** -np.arange(1, 300, 7), 1 - 2.0 ** -np.arange(1, 53)])
    with jax.enable_x64(True):
        found = np.asarray(jax.jit(quarter_sine)(turns))
    exact = [mpmath.sinpi(mpmath.mpf(turn) / 2) for turn in turns.tolist()]
    assert all(abs(value - true) <= 4 * math.ulp(true) for value, true in zip(found.tolist(), exact, strict=True))


# --- Points against textbook formulas in Python's floats ---


def on_sphere(height, azimuth):
    radius = math.sqrt(1 - height * height)
    return np.array([radius * math.cos(azimuth), radius * math.sin(azimuth), height])


def half_vector(view, light):
    together = view + light
    return together / math.sqrt(together @ together)


def in_plane(quantity, a, b):
    view, light = (
        np.array([math.sin(angle), 0, math.cos(angle)]) for angle in (math.pi * (a - 0.5), math.pi * (b - 0.5))
    )
    half = half_vector(view, light)
    return {"t": half[2], "u": view @ half, "v": view[2]}[quantity]


def on_hemisphere(quantity, a, b, c):
    view, light = on_sphere(a, 0.0), on_sphere(b, math.pi * c)
    half = half_vector(view, light)
    return {"t": half[2], "u": view @ half, "v": view[2]}[quantity]


TEXTBOOK = [
    ("uniform", (-3, 5), lambda a, *_: -3 + 8 * a),
    ("angle", (-1, 1), lambda a, *_: math.cos(math.pi * (1 - a))),
    ("angle", (0.25, 0.75), lambda a, *_: math.cos(math.acos(0.25) + (math.acos(0.75) - math.acos(0.25)) * a)),
    ("cosine", (0, 1), lambda a, *_: math.sqrt(a)),
    ("cosine", (0.25, 0.75), lambda a, *_: math.sqrt(1 / 16 + a / 2)),
    *((f"in-plane:{each}", (0, 1), lambda a, b, *_, q=each: in_plane(q, a, b)) for each in "tuv"),
    *((f"hemisphere:{each}", (0, 1), lambda a, b, c, _, q=each: on_hemisphere(q, a, b, c)) for each in "tuv"),
    ("hemisphere:w", (0, 1), lambda a, b, c, d: math.cos(math.pi / 2 * d)),
]


@pytest.mark.parametrize(("sampling", "domain", "formula"), TEXTBOOK, ids=lambda value: str(value)[:12])
def test_points_are_those_of_the_formula(sampling, domain, formula):
    counters = [0, 1, 2, 999, 2**33]
    expected = [formula(*(fraction(11, counter, each, ROOT_TWO) for each in range(4))) for counter in counters]
    assert drawn(sampling, [domain], counters, 11, jit=False)[0].tolist() == pytest.approx(expected, rel=1e-12)


# --- Distributions: the cumulative distribution of each, derived by hand, makes the points uniform ---


def turn(x):
    return 2 / np.pi * np.arcsin(x)


CUMULATIVE = [
    ("uniform", (2, 5), lambda x: (x - 2) / 3),
    ("angle", (-1, 1), lambda x: (1 + turn(x)) / 2),
    ("angle", (0.5, 1), lambda x: (turn(x) - 1 / 3) * 1.5),
    ("cosine", (0, 1), lambda x: x**2),
    ("cosine", (0.5, 1), lambda x: (4 * x**2 - 1) / 3),
    ("in-plane:t", (0, 1), lambda x: turn(x) ** 2),
    ("in-plane:u", (0, 1), lambda x: turn(x) ** 2),
    ("in-plane:v", (0, 1), turn),
    # The angle between the directions has the density sin(g)*(1 - g/pi): a lune of solid angle is above the horizon.
    ("hemisphere:u", (0, 1), lambda x: (2 * x**2 - 1) * turn(x) + 2 / np.pi * x * np.sqrt(1 - x**2)),
    ("hemisphere:t", (0, 1), lambda x: x**2),  # H is cosine-weighted
    ("hemisphere:v", (0, 1), lambda x: x),
    ("hemisphere:w", (0, 1), turn),
]


@pytest.mark.parametrize(("sampling", "domain", "cumulative"), CUMULATIVE, ids=lambda value: str(value)[:12])
def test_points_have_the_density_of_their_protocol(sampling, domain, cumulative):
    points, parameter = drawn(sampling, [domain, (0, 1)], np.arange(MILLION), 1, jit=False)
    counts, _ = np.histogram(cumulative(points), 100, (-1e-12, 1 + 1e-12))
    assert counts.sum() == MILLION
    assert 60 < ((counts - MILLION / 100) ** 2 / (MILLION / 100)).sum() < 150  # chi-squared, 99 degrees of freedom
    assert abs(np.corrcoef(points[:-1], points[1:])[0, 1]) < 0.005
    parts = np.minimum(cumulative(points[:100_000]) * 10, 9).astype(int) * 10 + (parameter[:100_000] * 10).astype(int)
    assert 60 < ((np.bincount(parts) - 1000) ** 2 / 1000).sum() < 150  # the parameter is independent of the point


def test_sobol_has_the_digits_of_joe_and_kuo():
    counters = np.arange(4096, dtype=np.uint64)
    points = drawn("sobol", [(0, 1)] * COORDINATES, counters ^ (counters >> 1), 9, jit=False)  # scipy's order is Gray's
    published = scipy.stats.qmc.Sobol(COORDINATES, scramble=False, bits=40).random(4096)
    for ours, theirs in zip(points, published.T, strict=True):
        digits = np.floor(ours * 2.0**40).astype(np.uint64)
        assert ((digits ^ digits[0]) == (theirs * 2.0**40).astype(np.uint64)).all()  # the first point is the shift
    assert len({float(each[0]) for each in points}) == COORDINATES


@pytest.mark.parametrize("coordinate", range(1, COORDINATES))
def test_the_digits_of_sobol_are_independent_up_to_the_last(coordinate):
    """Each direction number ends at the digit of its own place, so that 2^40 points have 2^40 different digits."""
    found = directions(coordinate)
    assert len(found) == DIGITS
    assert all(number & -number == 1 << (63 - place) for place, number in enumerate(found))


@pytest.mark.parametrize("start", [0, 2**40 - 2**20])
def test_sobol_puts_one_point_into_each_of_equal_parts(start):
    first, second, *others = drawn("sobol", [(0, 1)] * 5, np.arange(start, start + 1024), 4, jit=False)
    for each in (first, second, *others):
        assert sorted(np.floor(each * 1024)) == list(range(1024))
    for power in range(11):  # and of equal boxes, whatever their shape
        boxes = np.floor(first * 2**power) * 2 ** (10 - power) + np.floor(second * 2 ** (10 - power))
        assert sorted(boxes) == list(range(1024))


def test_sobol_integrates_better_than_chance():
    points = np.asarray(sample("sobol", 0.0, 1.0, 2**14, 2))
    assert abs((points**2).mean() - 1 / 3) < 2.0**-14  # the width of a part; a random mean is off by some 2e-3


# --- The ends of the domain ---

OPEN = [
    *itertools.product(CARRIERS, [(0.0, 1.0)]),
    *itertools.product(["uniform", "sobol"], [(-1e-30, 1e-30), (0.0, 1e-37), (0.0, math.pi / 2), (1.0, 1 + 2.0**-22)]),
    *itertools.product(["angle"], [(-1.0, 1.0), (-1.0, -1 + 2.0**-22), (1 - 2.0**-22, 1.0), (0.0, 1e-30), (-1e-40, 1)]),
    *itertools.product(["cosine"], [(1 - 2.0**-22, 1.0), (0.0, 1e-37), (0.999, 1.0), (1e-40, 0.5)]),
]


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize(("sampling", "domain"), OPEN)
def test_points_stay_inside_the_open_domain_after_rounding(sampling, domain, dtype):
    points = np.asarray(draw(sampling, *domain, 0, 0, 20_000, dtype))
    assert points.dtype == dtype
    assert domain[0] < points.min().item() <= points.max().item() < domain[1]
    assert domain[1] - domain[0] < 1e-6 or len(set(points.tolist())) > 10_000


def test_few_numbers_between_the_ends_are_all_drawn():
    low, high = np.float64(1), np.nextafter(np.nextafter(np.float64(1), 2), 2)
    assert set(np.asarray(sample("uniform", low, high, 100, 0)).tolist()) == {float(np.nextafter(low, high))}
    for sampling in ("uniform", "sobol"):
        rounded = np.asarray(draw(sampling, 1.0, 1 + 2.0**-21, 0, 0, 1000, "float32"))
        assert set(rounded.tolist()) == {1 + each * 2.0**-23 for each in (1, 2, 3)}
        half = np.asarray(draw(sampling, 1.0, 1 + 2.0**-8, 0, 0, 1000, "float16"))
        assert (half.dtype, set(half.tolist())) == (np.float16, {1 + each * 2.0**-10 for each in (1, 2, 3)})


def test_subnormal_numbers_are_not_drawn():
    assert set(np.asarray(draw("uniform", -1e-40, 1e-40, 0, 0, 100, "float32")).tolist()) == {0}
    small = np.asarray(draw("uniform", 0.0, 2.0**-125, 0, 0, 1000, "float32"))
    assert small.min() == 2.0**-126
    for domain in ((0.0, 1e-40), (-1e-40, 0.0), (1e-42, 1e-40)):
        with pytest.raises(RatfitError, match=r"no float32 number.*subnormal.*float64 or widen"):
            draw("uniform", *domain, 0, 0, 10, "float32")


@pytest.mark.parametrize(
    ("domain", "dtype", "named"),
    [
        ((1.0, 1 + 2.0**-23), "float32", "no float32 number lies between"),
        ((1e6, 1e7), "float16", "no float16 number lies between"),
        ((1.0, 1 + 2.0**-52), "float64", "no float64 number.*: widen the domain"),
        ((-1e308, 1e308), "float64", "wider than the greatest number"),
    ],
)
def test_a_domain_without_numbers_is_refused(domain, dtype, named):
    with pytest.raises(RatfitError, match=named):
        draw("uniform", *domain, 0, 0, 10, dtype)


def test_bounds_are_those_of_the_variable_and_of_what_is_drawn_with_it():
    class Place:
        low, high, ranges = 0.0, 1.0, {"m": (0.25, 0.5), "n": (2.0, 3.0)}

    found = bounds(Place(), "float32")
    assert [each[:2].tolist() for each in found] == [[0, 1], [0.25, 0.5], [2, 3]]
    points = [np.asarray(each) for each in draw_all(found)]
    assert all(
        low < each.min() <= each.max() < high
        for each, (low, high) in zip(points, [(0, 1), (0.25, 0.5), (2, 3)], strict=True)
    )


def draw_all(found):
    with jax.enable_x64(True):
        return drawing("uniform", "float32")(np.uint64(0), np.arange(100, dtype=np.uint64), found)


# --- Every number of a dtype ---

EVERY_HALF = np.arange(2**16, dtype=np.uint16).view(np.float16)
EVERY_VALUE = EVERY_HALF.astype(float)


def halves(low, high):
    """The float16 numbers of a closed interval in order, -0.0 before 0.0, by sorting all of them."""
    inside = EVERY_HALF[(low <= EVERY_VALUE) & (high >= EVERY_VALUE) & np.isfinite(EVERY_VALUE)]
    return inside[np.lexsort((~np.signbit(inside), inside))]


@pytest.mark.parametrize(
    "domain", [(0.0, 1.0), (-1.0, 1.0), (-3.0, -0.1), (0.1, 0.3), (-1e9, 1e9), (-1.0, 0.0), (-1e-5, 1e-7), (0.5, 0.5)]
)
def test_exhaustive_is_every_half_in_order(domain):
    expected = halves(*domain)
    assert count(*domain, "float16") == len(expected)
    if domain[0] < domain[1]:
        found = np.asarray(draw("exhaustive", *domain, 0, 0, len(expected) + 3, "float16"))
        assert (found[: len(expected)].view(np.uint16) == expected.view(np.uint16)).all()
        assert (found[len(expected) :] == expected[-1]).all()  # beyond the end the last number again


def test_exhaustive_goes_through_zero_one_number_at_a_time():
    before = count(-1.0, 0.0, "float32") - 2  # of the numbers less than 0
    bits = np.asarray(draw("exhaustive", -1.0, 1.0, 0, before - 2, 6, "float32")).view(np.uint32).tolist()
    assert bits == [0x80000002, 0x80000001, 0x80000000, 0, 1, 2]


@pytest.mark.parametrize(
    ("domain", "expected"),
    [
        ((0.0, math.pi / 2), 0x3FC90FDA + 2),  # float32(pi/2) = 0x3fc90fdb lies beyond pi/2; both zeros belong
        ((1.0, 2.0), 2**23 + 1),
        ((1.0, 1.0), 1),
        ((-1.0, 1.0), 2 * (0x3F800000 + 1)),
        ((1 + 2.0**-25, 1 + 2.0**-23), 1),
        ((0.0, 1.5e-45), 3),  # the least subnormal number is 1.4e-45
        ((-1e300, 1e300), 2 * 0x7F800000),
        ((0.1, 0.1000000015), 1),  # float32(0.1) = 0.10000000149,
    ],
)
def test_count_of_float32(domain, expected):
    assert count(*domain, "float32") == expected


def test_exhaustive_is_the_same_whatever_the_seed_and_the_chunk():
    whole = np.asarray(draw("exhaustive", 0.0, 1.0, 0, 1000, 1000, "float32"))
    assert (np.asarray(draw("exhaustive", 0.0, 1.0, 9, 1500, 500, "float32")) == whole[500:]).all()
    assert (np.diff(whole.view(np.uint32)) == 1).all()
    last = np.asarray(draw("exhaustive", 0.0, 1.0, 0, count(0, 1, "float32") - 2, 4, "float32")).tolist()
    assert last == [1 - 2.0**-24, 1, 1, 1]


# --- Names and refusals ---


@pytest.mark.parametrize(
    ("said", "variable", "canonical"),
    [
        *((name, "x", name) for name in ("uniform", "angle", "cosine", "sobol", "exhaustive")),
        ("in-plane", "u", "in-plane:u"),
        ("in-plane:t", "u", "in-plane:t"),
        ("hemisphere", "w", "hemisphere:w"),
        ("hemisphere:v", "x", "hemisphere:v"),
    ],
)
def test_resolve_says_the_name_that_records_have(said, variable, canonical):
    assert resolve(said, variable, 0.0, 1.0, "float32") == canonical
    assert resolve(canonical, "", 0.0, 1.0, "float32") == canonical


def test_every_protocol_is_described_and_every_description_can_be_drawn():
    assert {name.partition(":")[0] for name in CARRIERS} | {"exhaustive"} == set(PROTOCOLS)


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("uniforn", "x", 0, 1, "float32"), "did you mean 'uniform'"),
        (("hemisfere:u", "x", 0, 1, "float32"), "did you mean 'hemisphere'"),
        (("", "x", 0, 1, "float32"), "there is: uniform, angle"),
        (("uniform:u", "x", 0, 1, "float32"), "uniform takes no cosine, say uniform"),
        (("uniform:", "x", 0, 1, "float32"), "say uniform"),
        (("in-plane", "x", 0, 1, "float32"), "which cosine x is: say in-plane:t or in-plane:u or in-plane:v"),
        (("in-plane", "w", 0, 1, "float32"), "which cosine w is"),
        (("in-plane:w", "x", 0, 1, "float32"), "say hemisphere:w"),
        (("hemisphere:x", "u", 0, 1, "float32"), "hemisphere:t, hemisphere:u"),
        (("hemisphere:u", "u", 0, 0.5, "float32"), r"on \[0, 1\], not on \[0, 0\.5\]"),
        (("in-plane:u", "u", -1, 1, "float32"), r"on \[0, 1\]"),
        (("angle", "x", 0, 1.5, "float32"), r"inside \[-1, 1\].*uniform or sobol"),
        (("cosine", "x", -0.5, 1, "float32"), r"inside \[0, 1\]"),
        (("exhaustive", "x", 0, 1, "float64"), "float64 has too many numbers.*take float32 or float16"),
        (("uniform", "x", 0, 1, "float8"), "no dtype 'float8': measure in float16, float32 or float64"),
    ],
)
def test_resolve_refuses(arguments, named):
    with pytest.raises(RatfitError, match=named) as refused:
        resolve(*arguments)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("uniforn", 10, 0), "did you mean 'uniform'"),
        (("uniform", 0, 0), "samples = 0"),
        (("uniform", 1.5, 0), "samples = 1.5"),
        (("uniform", None, 0), "samples = None"),
        (("sobol", 2**40 + 1, 0), r"sobol has 2\*\*40 points"),
        (("exhaustive", 10, 0, "float32"), "leave samples out"),
        (("uniform", 10, -1), "seed = -1"),
        (("uniform", 10, 2**64), "seed"),
        (("uniform", 10, 0, "int8"), "no dtype 'int8'"),
    ],
)
def test_check_protocol_refuses(arguments, named):
    with pytest.raises(RatfitError, match=named):
        check_protocol(*arguments)


def test_check_protocol_lets_pass_what_can_be_measured():
    check_protocol("exhaustive", None, 0, "float16")
    check_protocol("sobol", 2**40, 2**64 - 1, "float32")
    check_protocol("hemisphere", 1, 0, "float64")


@pytest.mark.parametrize(
    ("call", "named"),
    [
        (lambda: sample("hemisphere", 0, 1, 10, 0), "which cosine the variable is"),
        (lambda: sample("exhaustive", 0, 1, 10, 0), "float64 has too many"),
        (lambda: drawing("exhaustive", "float64"), "float64 has too many"),
        (lambda: drawn("exhaustive", [(0, 1), (0, 1)], [0], dtype="float32"), "give the parameters values"),
        (lambda: sobol_fractions(0, 0, COORDINATES), "15 parameters at most"),
        (lambda: count(0, 1, "float64"), "float64 has too many"),
        (lambda: count(0, math.inf, "float32"), "finite ends"),
        (lambda: count(1, 0, "float32"), "low <= high"),
        (lambda: count(1 + 2.0**-25, 1 + 3 * 2.0**-25, "float32"), "no float32 number lies in"),
    ],
)
def test_what_cannot_be_drawn_is_refused(call, named):
    with pytest.raises(RatfitError, match=named):
        call()
