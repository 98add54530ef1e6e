"""Speed: what is timed, in which order, what is checked and what the record says; no test depends on a clock."""

import os
import re
import statistics
from collections import Counter
from dataclasses import FrozenInstanceError, dataclass, replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import sympy as sp

from ratfit._kernel import Program, kernel, precision
from ratfit._lower import Entries, Lookup, tape
from ratfit._parse import RatfitError
from ratfit._setting import setting
from ratfit._speed import (
    BACKENDS,
    available,
    backends,
    compiler,
    jax_arrays,
    measure_speed,
    notes,
    ratio_interval,
    rounds,
)
from ratfit._speed.check import verdict
from ratfit._speed.contest import Runs, contest
from ratfit._speed.cost_model import weight
from ratfit._target import Target, parameter

x = sp.Symbol("x")
k = parameter("k", 0, 1)
HALF = {"k": 0.5}
TIMED = [name for name in available() if name != "cost-model"]


@dataclass(frozen=True)
class Problem:
    target: Target
    variable: sp.Symbol = x
    domain: tuple[sp.Expr, sp.Expr] = (sp.Integer(0), sp.Integer(1))
    parameters: tuple[sp.Symbol, ...] = (k,)
    references: tuple = ()


@dataclass(frozen=True)
class Fit:
    problem: Problem
    formula: sp.Expr


def fit_of(exact, formula, low=0, high=1):
    ends = (sp.sympify(low), sp.sympify(high))
    return Fit(Problem(Target(exact, x, ends), domain=ends, parameters=tuple(exact.free_symbols - {x})), formula)


SMITH = Fit(
    Problem(Target(sp.erf(x) / (sp.exp(-(x**2)) + k), x, (0, 1))), x / (x - k * x + k)
)  # S Eq. 19 and a stand-in


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("backend", TIMED)
def test_a_measurement_says_what_was_timed_and_how(backend, dtype):
    found = measure_speed(SMITH, backend=backend, samples=3000, seed=3, dtype=dtype, parameters=HALF, repeats=15)
    assert (found.backend, found.regime, found.samples, found.seed) == (backend, BACKENDS[backend], 3000, 3)
    assert (found.dtype, found.parameters, found.reference, found.checked) == (dtype, HALF, None, True)
    for median, times in (
        (found.exact_s, found.exact_times),
        (found.fit_s, found.fit_times),
        (found.floor_s, found.floor_times),
    ):
        assert (len(times), statistics.median(times)) == (15, median)
        assert min(times) > 0
    assert found.gamma == found.exact_s / found.fit_s
    assert 0 < found.gamma_low <= found.gamma <= found.gamma_high
    assert ("-O" in found.flags) == backend.startswith("c-")
    with pytest.raises(FrozenInstanceError):
        found.gamma = 1.0


def test_the_number_of_rounds_follows_from_the_time_one_takes(monkeypatch):
    monkeypatch.setattr(rounds, "SECONDS", 0.0)
    assert len(measure_speed(SMITH, samples=10, parameters=HALF).fit_times) == rounds.ROUNDS[0]
    monkeypatch.setattr(rounds, "SECONDS", 1e6)
    monkeypatch.setattr(rounds, "ROUNDS", (1, 20))
    assert len(measure_speed(SMITH, samples=10, parameters=HALF).fit_times) == 20


def test_a_call_is_timed_after_one_of_its_own_and_every_order_comes_equally_often():
    calls = []

    def run(name):
        return lambda: calls.append(name) or len(calls)

    raced = rounds.race(Runs((run(0), run(1), run(2)), ""), 12)
    assert [len(each) for each in raced.times] == [12, 12, 12]
    assert calls[::2] == calls[1::2]
    timed = calls[1::2][3:]  # after the three by which the number of rounds is reckoned
    orders = [tuple(timed[start : start + 3]) for start in range(0, len(timed), 3)]
    assert set(Counter(orders).values()) == {2}
    assert len(set(orders)) == 6
    assert [calls[place - 1] for place in raced.outputs] == [0, 1, 2]
    assert max(raced.outputs) == len(calls)  # what is checked is what the last timed calls gave


def test_the_kernels_hold_no_number_wider_than_the_dtype():
    for dtype in ("float32", "float64"):
        for expression in (SMITH.problem.target.expression, SMITH.formula, x + 1):
            run = kernel(Program(expression), (x,)).at({k: 0.5}, dtype)
            with precision(dtype):
                jaxpr = str(jax.make_jaxpr(run)(jnp.zeros(4, dtype)))
            assert ("f64" in jaxpr, "f32" in jaxpr) == (dtype == "float64", dtype == "float32")


def test_a_power_costs_multiplications_and_a_fraction_one_division():
    fraction = Program((1 - x) ** 5 / ((x + 2) ** 2 * (3 - x)))
    text = str(jax.make_jaxpr(kernel(fraction, (x,)).jitted)(jnp.zeros(4)))
    assert "pow[" not in text.replace("integer_pow[", "")
    assert text.count(" div ") == 1


def test_the_precision_of_the_user_stays():
    measure_speed(SMITH, samples=10, dtype="float64", parameters=HALF, repeats=1)
    assert jax.config.jax_enable_x64 is False


def test_the_interval_is_that_of_the_ratio_of_rounds():
    drifting = [1.0 + 0.1 * number for number in range(20)]
    assert ratio_interval([2 * each for each in drifting], drifting) == (2.0, 2.0)  # a common drift cancels
    low, high = ratio_interval([3.0, 3.5, 4.0] * 10, [1.0] * 30)
    assert 3.0 <= low < 3.5 < high <= 4.0
    assert ratio_interval([3.0, 3.5, 4.0] * 10, [1.0] * 30) == (low, high)
    assert ratio_interval([3.0], [2.0]) == (1.5, 1.5)


@pytest.mark.parametrize(
    ("exact", "fit", "note"),
    [
        (2.0, 2.0, ""),
        (2.0, 1.1, "fit at the copy floor: gamma is a lower bound"),
        (2.0, 0.9, "fit at the copy floor: gamma is a lower bound"),
        (1.1, 2.0, "exact function at the copy floor: gamma is an upper bound"),
        (1.0, 1.0, "exact function and fit at the copy floor: gamma says nothing about their arithmetic"),
    ],
)
def test_the_floor_says_how_to_read_gamma(exact, fit, note):
    assert notes.floor_note(exact, fit, 1.0) == note


@pytest.mark.parametrize(
    ("low", "high", "halves", "waiting", "note"),
    [
        (5.0, 5.1, (1.0, 1.1), 1.0, ""),
        (4.0, 6.0, (1.0, 1.0), 1.0, "the interval of gamma is wide"),
        (5.0, 5.1, (1.0, 1.3), 1.0, "changed its pace midway"),
        (5.0, 5.1, (1.3, 1.0), 1.0, "changed its pace midway"),
        (5.0, 5.1, (1.0, 1.0), 9.0, "the load average was 9.0 on 2 cores"),
    ],
)
def test_what_disturbed_a_measurement_is_noted(low, high, halves, waiting, note, monkeypatch):
    monkeypatch.setattr(notes, "cores", lambda: 2)
    times = [halves[0]] * 6 + [halves[1]] * 6
    found = notes.noise_note(low, high, [times, [1.0] * 12], waiting)
    assert found.startswith("noisy: ") == bool(note)
    assert note in found


def test_few_samples_and_few_rounds():
    assert notes.size_note(99_999).startswith("fewer than 100000 samples")
    assert notes.size_note(100_000) == ""
    assert notes.noise_note(1.0, 1.0, [[1.0, 9.0]], 0.0) == ""  # two rounds show no drift


# What a broken kernel might give, from what a right one gives.
BROKEN = {
    "one half is left out": lambda good: np.where(np.arange(good.size) < good.size // 2, good, np.nan),
    "the arguments of another call": lambda good: np.roll(good, 1),
    "a constant": lambda good: np.full_like(good, good.mean()),
    "half the digits": lambda good: good.astype("float16").astype(good.dtype),
    "nan": lambda good: np.full_like(good, np.nan),
    "infinite": lambda good: np.full_like(good, np.inf),
    "the sign": np.negative,
    "a part of the domain": lambda good: np.where(good < np.quantile(good, 0.99), good, good * 1.001),
    "a sample in a hundred": lambda good: np.where(np.arange(good.size) % 100, good, 0),
    "fewer samples": lambda good: good[:-1],
}


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("broken", BROKEN.values(), ids=BROKEN)
def test_what_is_fast_because_broken_has_no_gamma(broken, dtype, monkeypatch):
    right = backends.backend_named("numpy")

    def prepare(contest):
        runs = right.prepare(contest)
        return replace(runs, calls=(runs.calls[0], lambda: broken(runs.calls[1]()), runs.calls[2]))

    monkeypatch.setitem(backends._TABLE, "numpy", replace(right, prepare=prepare))
    found = measure_speed(SMITH, backend="numpy", samples=4000, dtype=dtype, parameters=HALF, repeats=1)
    assert (found.gamma, found.gamma_low, found.gamma_high, found.checked) == (None, None, None, False)
    assert found.note.startswith("the timed output of the fit is wrong")
    assert found.fit_s > 0


EXP, TINY = sp.exp(-1 / x**2), sp.Rational(1, 10**39)
DIFFICULT = {
    "cancels": ((1 - sp.cos(x)) / x**2, 0, 1),
    "has a pole inside": (1 / (x - sp.Rational(1, 3)), 0, 1),
    "has a zero inside": (sp.log(x + sp.Rational(2, 3)), 0, 1),
    "is infinite": (sp.exp(1 / x**2), 0, 1),
    "is 0 times infinity": (EXP / EXP, 0, 1),
    "is no real number in places": (sp.sqrt(x - sp.Rational(1, 3)), 0, 1),
    "has infinite steps": (1 / (1 + sp.exp(1000 * x)), -1, 1),
    "underflows on its way": (EXP / x**6, 0, 1),
    "is of denormal numbers": (x * TINY, 0, 1),
    "jumps": (sp.sign(x - sp.Rational(1, 3)) + sp.Heaviside(x**2 - 2 * x / 3), 0, 1),
    "is a table": (Lookup(10 * x - 2, Entries([1.0, 4.0, 2.0, 8.0])), 0, 1),
    "is a constant": (sp.Integer(7) / 3, 0, 1),
    "is its variable": (x, -1, 1),
    "spans the numbers": (sp.exp(85 * x), -1, 1),
    "magnifies, beyond float32": (sp.exp(sp.gamma(x)), 0, 2),
    "oscillates": (sp.sin(1000 * x), 0, 1),
}


@pytest.mark.parametrize(
    ("backend", "dtype"),
    [pair for pair in (("jax-cpu", "float32"), ("c-scalar", "float32"), ("c-scalar", "float64")) if pair[0] in TIMED],
)
@pytest.mark.parametrize(("exact", "low", "high"), DIFFICULT.values(), ids=DIFFICULT)
def test_what_is_difficult_is_not_taken_for_broken(exact, low, high, backend, dtype):
    place = setting(fit_of(exact, exact, low, high))
    three = contest(place, 5000, 0, dtype)
    runs = backends.backend_named(backend).prepare(three)
    with runs.scope():
        outputs = [call() for call in runs.calls]
    assert [verdict(*each).wrong for each in zip(three.entrants, [three] * 3, outputs, strict=True)] == [""] * 3


@pytest.mark.skipif("c-fast" not in TIMED, reason="this machine has no C compiler")
def test_fast_arithmetic_is_judged_by_what_it_gives():
    """-ffast-math may do what it likes with nan and infinity; the note says so, beside gamma or in its place."""
    found = measure_speed(fit_of(sp.exp(1 / x**2), x), backend="c-fast", samples=3000, repeats=1)
    assert "-ffast-math honours neither nan nor infinity" in found.note
    assert (found.gamma is None) == (not found.checked)
    flushed = np.float32(1e-40) * np.ones(1, "float32")
    assert flushed[0] > 0  # the process itself keeps denormal numbers


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("backend", TIMED)
def test_parameters_may_be_drawn_with_the_samples(backend, dtype):
    found = measure_speed(SMITH, backend=backend, samples=2000, dtype=dtype, parameters={"k": "random"}, repeats=1)
    assert found.checked
    assert found.parameters == {"k": (0.0, 1.0)}


def test_a_random_parameter_is_a_further_array_of_all_three():
    three = contest(setting(SMITH, {"k": "random"}), 1000, 0, "float32")
    assert [array.dtype for array in three.samples] == ["float32", "float32"]
    assert all(0 < array.min() < 0.01 and 0.99 < array.max() < 1 for array in three.samples)
    assert not np.array_equal(*three.samples)
    assert all(not entrant.constants for entrant in three.entrants)
    assert three.entrants[2].program.result == x + k + 1


def test_float16_is_for_arrays():
    fit = fit_of(sp.sin(x), x)
    assert measure_speed(fit, backend="numpy", dtype="float16", samples=1000, repeats=1).checked
    if "c-scalar" in TIMED:
        found = measure_speed(fit, backend="c-scalar", dtype="float16", samples=10, repeats=1)
        assert found.gamma is None and not found.exact_times
        assert found.note == "not timed: C computes in float32 or float64: time float16 with a backend of arrays"


def test_a_measurement_in_a_notebook_is_one_line():
    told = repr(measure_speed(SMITH, backend="numpy", samples=1000, parameters=HALF, repeats=3))
    assert re.match(r"<gamma [\d.]+ \[[\d.]+, [\d.]+\]; numpy, float32, 1,000 samples, k = 0.5; ", told)
    counted = measure_speed(SMITH, backend="cost-model", samples=1000, parameters={"k": "random"})
    assert re.match(r"<gamma [\d.]+ \(counted\); cost-model, .*, k random in \[0, 1\]; exact function", repr(counted))
    assert repr(replace(counted, gamma=None)).startswith("<no gamma; cost-model")


def test_a_fit_equal_to_the_exact_function_has_gamma_1_in_the_cost_model():
    found = measure_speed(fit_of(sp.sin(x), sp.sin(x)), backend="cost-model")
    assert (found.gamma, found.gamma_low, found.exact_s, found.fit_times) == (1.0, None, None, ())
    assert (found.checked, found.regime, found.note) == (None, "operation costs", "exact function 80 additions, fit 80")
    assert measure_speed(fit_of(sp.sin(x), sp.Integer(1)), backend="cost-model").gamma is None


@pytest.mark.parametrize(
    ("expression", "single", "double"),
    [
        (x, 0, 0),
        (x + 1, 1, 1),
        (x**2, 1, 1),
        (x**7, 4, 4),  # x2 = x x, x4 = x2 x2, x x2, x3 x4
        (x**8, 3, 3),
        ((x + 1) / (x + 1) ** 2, 7, 9),
        (sp.sqrt(x) + 1 / sp.sqrt(x), 13, 19),  # one root, one division, one addition
        (sp.exp(x) / (1 + sp.exp(x)), 27, 39),  # one exponential
        (sp.Piecewise((x, x < 1), (x**2, True)), 3, 3),  # both branches
        (sp.Max(x, 0), 1, 1),
        (Lookup(x, Entries([1.0, 2.0])), 12, 12),
    ],
)
def test_operations_are_weighed_each_once(expression, single, double):
    steps = tape(expression, (x,))
    assert (weight(steps, "float32"), weight(steps, "float64")) == (single, double)


def test_what_nothing_needs_costs_nothing():
    steps = tape(x + 2, (x,), ((sp.Symbol("unused"), sp.exp(x)),))
    assert weight(steps, "float32") == 1


def test_refusals_say_the_remedy():
    with pytest.raises(RatfitError, match="did you mean 'jax-cpu'"):
        measure_speed(SMITH, backend="jax_cpu", parameters=HALF)
    with pytest.raises(RatfitError, match="samples = 0"):
        measure_speed(SMITH, samples=0, parameters=HALF)
    with pytest.raises(RatfitError, match="repeats = 0"):
        measure_speed(SMITH, repeats=0, parameters=HALF)
    with pytest.raises(RatfitError, match="k has no value"):
        measure_speed(SMITH)


@pytest.mark.skipif(bool(jax_arrays.devices("gpu")), reason="this machine has a GPU")
def test_a_backend_that_this_machine_lacks_names_those_it_has():
    with pytest.raises(RatfitError, match=r"no jax-gpu on this machine \(JAX finds no gpu\); it has: jax-cpu, numpy"):
        measure_speed(SMITH, backend="jax-gpu", parameters=HALF)


def test_without_a_compiler_there_is_no_compiled_c(monkeypatch):
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("CC", raising=False)
    assert set(available()) >= {"jax-cpu", "numpy", "cost-model"}
    assert not {"c-scalar", "c-fast"} & set(available())
    with pytest.raises(RatfitError, match=r"no c-fast on this machine \(no C compiler here .* in the variable CC\)"):
        measure_speed(SMITH, backend="c-fast", parameters=HALF)


@pytest.mark.parametrize("named", ["no-such-compiler", "no-such-compiler -m64", "'unbalanced", '""'])
def test_a_compiler_that_is_not_there(named, monkeypatch):
    monkeypatch.setenv("CC", named)
    assert "names no program here" in compiler.lacking()


@pytest.mark.parametrize(
    ("script", "seconds", "said"),
    [
        (
            "echo kernels.c:3: warning: odd >&2; echo kernels.c:7: error: broken >&2; exit 1",
            60,
            "kernels.c:7: error: b",
        ),
        ("echo licence expired >&2; exit 3", 60, "failed: licence expired"),
        ("exit 1", 60, "failed: it said nothing"),
        ("sleep 60", 0.1, "took longer than 0.1 s"),
        ("exit 0", 60, "compiled, but not loaded"),
    ],
)
def test_a_compiler_that_fails_is_quoted(script, seconds, said, tmp_path, monkeypatch):
    program = tmp_path / "compile"
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    monkeypatch.setenv("CC", os.fspath(program))
    monkeypatch.setattr(compiler, "SECONDS", seconds)
    with pytest.raises(RatfitError, match=said):
        measure_speed(SMITH, backend="c-scalar", samples=10, parameters=HALF)
