"""Speed: what is timed, in which order, and what the record says; no test depends on how fast this machine is."""

import statistics
from collections import Counter
from dataclasses import FrozenInstanceError, dataclass

import jax
import jax.numpy as jnp
import pytest
import sympy as sp

from ratfit import _speed
from ratfit._parse import RatfitError
from ratfit._speed import measure_speed, ratio_interval
from ratfit._target import Target, parameter

x = sp.Symbol("x")
k = parameter("k", 0, 1)


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


SMITH = Fit(
    Problem(Target(sp.erf(x) / (sp.exp(-(x**2)) + k), x, (0, 1))), x / (x - k * x + k)
)  # S Eq. 19 and a stand-in


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_a_measurement_says_what_was_timed_and_how(dtype):
    found = measure_speed(SMITH, samples=10_000, seed=3, dtype=dtype, parameters={"k": 0.5}, repeats=15)
    assert (found.backend, found.samples, found.seed, found.dtype) == ("jax-cpu", 10_000, 3, dtype)
    assert (found.parameters, found.reference) == ({"k": 0.5}, None)
    for median, times in (
        (found.exact_s, found.exact_times),
        (found.fit_s, found.fit_times),
        (found.floor_s, found.floor_times),
    ):
        assert (len(times), statistics.median(times)) == (15, median)
        assert min(times) > 0
    assert found.gamma == found.exact_s / found.fit_s
    assert 0 < found.gamma_low <= found.gamma <= found.gamma_high
    with pytest.raises(FrozenInstanceError):
        found.gamma = 1.0


def test_the_number_of_rounds_follows_from_the_time_one_takes(monkeypatch):
    monkeypatch.setattr(_speed, "SECONDS", 0.0)
    assert len(measure_speed(SMITH, samples=10, parameters={"k": 0.5}).fit_times) == _speed.ROUNDS[0]
    monkeypatch.setattr(_speed, "SECONDS", 1e6)
    monkeypatch.setattr(_speed, "ROUNDS", (1, 20))
    assert len(measure_speed(SMITH, samples=10, parameters={"k": 0.5}).fit_times) == 20


def test_a_call_is_timed_after_one_of_its_own_and_every_order_comes_equally_often():
    calls = []

    def run(name):
        return lambda points: calls.append(name) or points

    times = _speed._times([run(0), run(1), run(2)], jnp.zeros(1), "float32", 12)
    assert [len(each) for each in times] == [12, 12, 12]
    assert calls[::2] == calls[1::2]
    timed = calls[1::2][3:]  # after the three by which the number of rounds is reckoned
    rounds = [tuple(timed[start : start + 3]) for start in range(0, len(timed), 3)]
    assert set(Counter(rounds).values()) == {2}
    assert len(set(rounds)) == 6


def test_the_kernels_hold_no_number_wider_than_the_dtype():
    for dtype in ("float32", "float64"):
        for expression in (SMITH.problem.target.expression, SMITH.formula, x + 1):
            run = _speed.kernel(_speed.Program(expression), (x,)).at({k: 0.5}, dtype)
            with _speed.precision(dtype):
                jaxpr = str(jax.make_jaxpr(run)(jnp.zeros(4, dtype)))
            assert ("f64" in jaxpr, "f32" in jaxpr) == (dtype == "float64", dtype == "float32")


def test_a_power_costs_multiplications_and_a_fraction_one_division():
    text = str(
        jax.make_jaxpr(_speed.kernel(_speed.Program((1 - x) ** 5 / ((x + 2) ** 2 * (3 - x))), (x,)).jitted)(
            jnp.zeros(4)
        )
    )
    assert "pow[" not in text.replace("integer_pow[", "")
    assert text.count(" div ") == 1


def test_the_precision_of_the_user_stays():
    measure_speed(SMITH, samples=10, dtype="float64", parameters={"k": 0.5}, repeats=1)
    assert jax.config.jax_enable_x64 is False


def test_the_interval_is_that_of_the_ratio_of_rounds():
    drifting = [1.0 + 0.1 * number for number in range(20)]
    assert ratio_interval([2 * each for each in drifting], drifting) == (2.0, 2.0)  # a common drift cancels
    low, high = ratio_interval([3.0, 3.5, 4.0] * 10, [1.0] * 30)
    assert 3.0 <= low < 3.5 < high <= 4.0
    assert ratio_interval([3.0, 3.5, 4.0] * 10, [1.0] * 30) == (low, high)
    assert ratio_interval([3.0], [2.0]) == (1.5, 1.5)


@pytest.mark.parametrize(
    ("times", "note"),
    [
        ((2.0, 1.0, 5.0, 5.1), ""),
        ((1.1, 1.0, 5.0, 5.1), "fit at the copy floor: gamma is a lower bound"),
        ((0.9, 1.0, 5.0, 5.1), "fit at the copy floor: gamma is a lower bound"),
        ((2.0, 1.0, 4.0, 6.0), "noisy: the interval of gamma is wide, time it again on a quiet machine"),
    ],
)
def test_the_note_says_how_to_read_gamma(times, note):
    assert _speed._note(*times) == note


def test_refusals_say_the_remedy():
    with pytest.raises(RatfitError, match="did you mean 'jax-cpu'"):
        measure_speed(SMITH, backend="jax_cpu", parameters={"k": 0.5})
    with pytest.raises(RatfitError, match="samples = 0"):
        measure_speed(SMITH, samples=0, parameters={"k": 0.5})
    with pytest.raises(RatfitError, match="repeats = 0"):
        measure_speed(SMITH, repeats=0, parameters={"k": 0.5})
    with pytest.raises(RatfitError, match="k has no value"):
        measure_speed(SMITH)


@pytest.mark.skipif(bool(_speed._devices("gpu")), reason="this machine has a GPU")
def test_a_backend_without_a_device_names_those_with_one():
    with pytest.raises(RatfitError, match=r"no device for jax-gpu .* there is one for: jax-cpu"):
        measure_speed(SMITH, backend="jax-gpu", parameters={"k": 0.5})
