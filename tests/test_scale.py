"""Many samples: the same to the last bit on all devices, in all processes, resumed or not; and sums that are exact."""

import json
import math
import os
import socket
import subprocess
import sys
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from ratfit._error import stream as streaming
from ratfit._error.chunk import BINS, CHUNK, COUNTS, EXTREMES, GROUP, SUMS, WORST
from ratfit._error.stream import Watch, pass_of, stream
from ratfit._error.totals import BINNED, NOTHING, Totals, of_chunks
from ratfit._sampling import draw
from ratfit._setting import setting

x = sp.Symbol("x")
R = sp.Rational


@dataclass(frozen=True)
class Fit:
    problem: SimpleNamespace
    formula: sp.Expr


def place_of(exact, formula, domain):
    target = SimpleNamespace(expression=sp.sympify(exact))
    problem = SimpleNamespace(variable=x, domain=domain, target=target, parameters=(), references=())
    return setting(Fit(problem, sp.sympify(formula)))


# --- Devices and processes ---

WORKER = Path(__file__).with_name("scale_worker.py")
PATIENCE = 300


def begin(devices, *arguments):
    """A process with so many devices, each of them a thread of the processor."""
    flags = f"--xla_force_host_platform_device_count={devices}"
    command = [sys.executable, str(WORKER), *map(str, arguments)]
    return subprocess.Popen(command, env={**os.environ, "XLA_FLAGS": flags}, stdout=subprocess.PIPE, text=True)


@pytest.fixture(scope="module")
def machines():
    """What one device finds, and by the devices of each process what others find: all run at once."""
    with socket.socket() as free:
        free.bind(("localhost", 0))
        coordinator = f"localhost:{free.getsockname()[1]}"
    begun = {(devices,): begin(devices) for devices in (1, 2, 8)}
    begun[1, 1] = begin(1, coordinator, 2, 0)
    second = begin(1, coordinator, 2, 1)
    try:
        found = {devices: process.communicate(timeout=PATIENCE)[0] for devices, process in begun.items()}
        second.communicate(timeout=PATIENCE)
    finally:
        for process in (*begun.values(), second):
            process.kill()
            process.wait()
    assert all(process.returncode == 0 for process in (*begun.values(), second))
    # The line before is Gloo's, when several processes meet.
    return {devices: json.loads(text.splitlines()[-1]) for devices, text in found.items()}


@pytest.mark.thorough
@pytest.mark.parametrize("devices", [(2,), (8,), (1, 1)], ids=["2 devices", "8 devices", "2 processes"])
@pytest.mark.parametrize("name", ["eq12", "eq19"])
def test_the_result_is_the_same_to_the_last_bit_wherever_it_is_computed(machines, name, devices):
    one, other = machines[1,], machines[devices]
    assert (one["devices"], one["processes"]) == (1, 1)
    assert (other["devices"], other["processes"]) == (sum(devices), len(devices))
    assert other["found"][name] == one["found"][name]
    assert one["found"][name]["epsilon"]["absolute_mean"] > 0
    assert one["found"][name]["samples"] == 3_000_000


@pytest.mark.thorough
def test_every_protocol_draws_the_same_points_on_two_devices(machines):
    one, two = (machines[devices]["found"] for devices in ((1,), (2,)))
    drawn = [name for name in one if not name.startswith("eq")]
    assert len(drawn) == len({one[name] for name in drawn}) >= 12
    assert {name: two[name] for name in drawn} == {name: one[name] for name in drawn}


# --- Going on from a saved state ---

SQUARE = place_of(x, x**2, (sp.Integer(0), sp.Integer(1)))
MANY = 5 * CHUNK + 1000
SQUARE_PASS = pass_of(SQUARE, "uniform", "float32", True)


@pytest.fixture
def chunkwise(monkeypatch):
    """One chunk at a time, and the state kept after each."""
    monkeypatch.setattr(streaming, "CHUNKS", 1)
    monkeypatch.setattr(streaming, "SAVED", 0.0)


def test_going_on_from_any_saved_state_is_as_if_nothing_had_happened(chunkwise):
    states, seen = [], []
    keep = lambda state: states.append(json.dumps(state))  # noqa: E731  # what a file would hold
    whole = stream(SQUARE_PASS, SQUARE, MANY, 7, Watch(progress=lambda *at: seen.append(at), save=keep))
    assert [json.loads(state)["chunks"] for state in states] == [1, 2, 3, 4, 5, 6]
    assert seen == [*((done * CHUNK, MANY) for done in range(1, 6)), (MANY, MANY)]
    for state in states:
        assert stream(SQUARE_PASS, SQUARE, MANY, 7, Watch(state=json.loads(state))) == whole


@pytest.mark.parametrize("chunk", [1, 4])
def test_an_interruption_keeps_all_that_was_told_of(chunkwise, monkeypatch, chunk):
    whole = stream(SQUARE_PASS, SQUARE, MANY, 7, Watch())
    monkeypatch.setattr(streaming, "SAVED", math.inf)
    states = []

    def interrupt(done, samples):
        if done == chunk * CHUNK:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stream(SQUARE_PASS, SQUARE, MANY, 7, Watch(progress=interrupt, save=states.append))
    (state,) = states
    assert state["chunks"] == chunk
    assert stream(SQUARE_PASS, SQUARE, MANY, 7, Watch(state=json.loads(json.dumps(state)))) == whole


def test_fewer_samples_are_the_first_of_many(chunkwise):
    few, points = CHUNK + 5, np.asarray(draw("uniform", 0.0, 1.0, 7, 0, CHUNK + 5, "float32"))
    total = stream(SQUARE_PASS, SQUARE, few, 7, Watch())
    assert total.counts["finite"] == few
    assert total.extremes["highest"] == points.max()
    assert total.worst["relative"][1] == points.argmin()


# --- Sums ---


def test_the_sums_of_a_chunk_are_those_of_fsum(chunkwise):
    total = stream(SQUARE_PASS, SQUARE, CHUNK, 7, Watch())
    points = np.asarray(draw("uniform", 0.0, 1.0, 7, 0, CHUNK, "float32"))
    exact = points.astype(float)
    error = (points * points).astype(float) - exact
    ulp = np.spacing(points).astype(float)
    terms = {
        "error": error, "absolute": abs(error), "square": error**2, "relative_signed": error / exact,
        "relative": abs(error) / exact, "relative_square": (error / exact) ** 2, "size": exact, "ulp": abs(error) / ulp,
    }  # fmt: skip
    assert set(terms) == set(SUMS)
    for name, each in terms.items():
        # A group is added up plainly before its sum is compensated: so many roundings, each 2**-53 at most.
        assert abs(total.mean(name, 1) - math.fsum(each)) <= GROUP * 2.0**-53 * math.fsum(abs(each)), name
    assert total.counts["finite"] == total.counts["nonzero"] == total.counts["known"] == CHUNK
    assert sum(total.bins["absolute"].values()) == sum(total.bins["relative"].values()) == CHUNK


def test_nothing_is_lost_beside_great_errors_or_where_they_cancel(chunkwise):
    """Two chunks in the order of their numbers: the first group is 2**60 in one, -2**60 in the other, the rest 1."""
    step = R(1, 2**23)  # from one number between 1 and 2 to the next
    great, whole = sp.Integer(2) ** 60, 1 + CHUNK * step
    pieces = ((great, x < 1 + GROUP * step), (1, x < whole), (-great, x < whole + GROUP * step), (1, True))
    place = place_of(0, sp.Piecewise(*pieces), (sp.Integer(1), whole + (CHUNK - 1) * step))
    what, ones = pass_of(place, "exhaustive", "float32", True), CHUNK - GROUP
    first, both = (stream(what, place, chunks * CHUNK, 0, Watch()) for chunks in (1, 2))
    assert first.sums["error"] == first.sums["absolute"] == (GROUP * 2**60 + ones) << 1074
    assert both.sums["error"] == (2 * ones) << 1074
    assert both.mean("error", both.counts["finite"]) == ones / CHUNK


# --- Totals ---

FINITE = st.floats(allow_nan=False, allow_infinity=False)
COUNT = st.integers(0, 2**40)
ERROR = st.one_of(st.just(-1.0), st.floats(0, allow_nan=False))


@st.composite
def totals(draw):
    return Totals(
        {name: draw(COUNT) for name in COUNTS},
        {name: draw(st.one_of(st.none(), st.integers(-(2**2100), 2**2100))) for name in SUMS},
        {name: draw(FINITE) for name in EXTREMES},
        {name: (draw(ERROR), draw(COUNT)) for name in WORST},
        {name: draw(st.dictionaries(st.integers(0, BINS - 1), st.integers(1, 2**40), max_size=3)) for name in BINNED},
    )


@settings(max_examples=50, deadline=None)
@given(totals(), totals(), totals())
def test_totals_add_up_in_any_order_and_come_back_from_json(one, two, three):
    assert one + two == two + one
    assert (one + two) + three == one + (two + three)
    assert Totals.from_state(json.loads(json.dumps((one + two).to_state()))) == one + two


@settings(max_examples=50, deadline=None)
@given(totals())
def test_no_samples_add_nothing(one):
    peak = {**one.extremes, "peak": abs(one.extremes["peak"])}
    worst = {name: (value, counter if value >= 0 else 0) for name, (value, counter) in one.worst.items()}
    sensible = replace(one, extremes=peak, worst=worst)
    assert NOTHING + sensible == sensible + NOTHING == sensible


@settings(max_examples=50, deadline=None)
@given(st.lists(st.tuples(FINITE, FINITE), min_size=1, max_size=20))
def test_the_sums_of_chunks_are_those_of_fractions(pairs):
    found = chunks([high for high, _ in pairs], [low for _, low in pairs])
    exact = sum((Fraction(high) + Fraction(low) for high, low in pairs), Fraction(0))
    assert all(Fraction(value, 2**1074) == exact for value in found.sums.values())
    if abs(exact / 7) < Fraction(2) ** 1023:
        assert found.mean("error", 7) == float(exact / 7)


@pytest.mark.parametrize("beyond", [math.inf, -math.inf, math.nan])
def test_a_sum_beyond_float64_is_none_for_good(beyond):
    found = chunks([1.0, beyond, 2.0], [0.0, 0.0, 0.0])
    assert set(found.sums.values()) == {None}
    assert (found + NOTHING).mean("error", 3) is None


def test_of_equal_errors_the_first_counts():
    found = [replace(NOTHING, worst=dict.fromkeys(WORST, (2.0, counter))) for counter in (9, 4, 7)]
    assert set((found[0] + found[1] + found[2]).worst.values()) == {(2.0, 4)}


def chunks(highs, lows):
    """Totals from the arrays of a device, every sum of a chunk being the pair of a high and a low part."""
    sums = np.array([[[high, low]] * len(SUMS) for high, low in zip(highs, lows, strict=True)])
    count = len(highs)
    arrays = {name: np.zeros(count, np.int64) for name in COUNTS} | {"sums": sums, "extremes": np.zeros((count, 3))}
    for name in WORST:
        arrays |= {f"worst_{name}": np.full(count, -1.0), f"counter_{name}": np.zeros(count, np.uint64)}
    return of_chunks(arrays)
