"""Time limits: which time they count, that they nest, and that they end compiled code that calls back."""

import sys
import threading
import time

import pytest

from ratfit._deadline import PATIENCE, OutOfTime, TimeLimit


def spin():
    while True:
        pass


def sleep_for_ever():
    while True:
        time.sleep(0.005)


@pytest.mark.parametrize(
    "seconds, wall, work",
    [(0.05, False, spin), (0.05, True, spin), (0.05, True, sleep_for_ever), (0.02, False, sleep_for_ever)],
)
def test_a_limit_ends_what_has_no_end(seconds, wall, work):
    with TimeLimit(seconds, wall=wall) as limit:
        work()
    assert limit.passed


def test_waiting_uses_no_processor_time():
    with TimeLimit(0.2) as limit:
        time.sleep(0.4)
    assert not limit.passed and PATIENCE * 0.2 > 0.4
    with TimeLimit(0.2, wall=True) as limit:
        time.sleep(0.4)
    assert limit.passed


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the processor time is that of the whole process")
def test_what_other_threads_do_does_not_count():
    done = threading.Event()

    def busy():
        while not done.is_set():
            sum(range(1000))

    others = [threading.Thread(target=busy) for _ in range(2)]
    for thread in others:
        thread.start()
    before = time.thread_time()
    with TimeLimit(0.1) as limit:
        spin()
    used = time.thread_time() - before
    done.set()
    for thread in others:
        thread.join()
    assert limit.passed and used >= 0.1


def test_none_is_no_limit():
    with TimeLimit(None) as limit:
        pass
    assert not limit.passed


def test_an_outer_limit_passes_through_an_inner_one():
    with TimeLimit(0.05) as outer, TimeLimit(60) as inner:
        spin()
    assert outer.passed and not inner.passed


def test_an_error_of_the_block_is_no_limit():
    with pytest.raises(SystemError), TimeLimit(60):
        raise SystemError from ValueError("of its own")
    with pytest.raises(OutOfTime), TimeLimit(60):
        raise OutOfTime


@pytest.mark.parametrize("seconds", [0.03, 0.05, 0.08])
def test_a_limit_ends_an_integral_that_calls_back(seconds):
    """An exception in a callback leaves this compiled integral as a SystemError."""
    import flint

    def integrand(place, analytic):
        return ((place * place + 1) ** 7).exp().cos()

    with TimeLimit(seconds) as limit:
        while True:
            flint.acb.integral(integrand, flint.acb(0), flint.acb(1), eval_limit=10**5)
    assert limit.passed
