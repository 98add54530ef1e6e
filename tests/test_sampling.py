"""Sampling: SplitMix64 to the bit, distributions against their densities, and what must be refused."""

import numpy as np
import pytest

from ratfit._parse import RatfitError
from ratfit._sampling import draw, sample


def test_sample_is_a_function_of_seed_and_counter_alone():
    many, few = (np.asarray(sample("uniform", 0.0, 1.0, samples, 7)) for samples in (100_000, 1000))
    assert many.dtype == np.float64
    assert (many[:1000] == few).all()
    assert (np.asarray(draw("uniform", 0.0, 1.0, 7, 500, 500)) == few[500:]).all()
    assert not (np.asarray(sample("uniform", 0.0, 1.0, 1000, 8)) == few).any()


def test_sample_is_splitmix64_to_the_bit():
    def mixed(bits):
        bits = ((bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9) % 2**64
        bits = ((bits ^ (bits >> 27)) * 0x94D049BB133111EB) % 2**64
        return bits ^ (bits >> 31)

    golden = 0x9E3779B97F4A7C15
    assert mixed(golden) == 0xE220A8397B1DCDAF  # the first output of SplitMix64 from state 0, as published
    states = [mixed((2**64 - 1 + golden) % 2**64) + count * golden for count in (1, 2, 3)]
    expected = [((mixed(state % 2**64) >> 12) + 0.5) / 2**52 for state in states]
    assert np.asarray(sample("uniform", 0.0, 1.0, 3, 2**64 - 1)).tolist() == expected


def test_sample_is_uniform():
    points = np.asarray(sample("uniform", 2.0, 5.0, 1_000_000, 0))
    counts, _ = np.histogram(points, 100, (2, 5))
    assert counts.sum() == 1_000_000
    assert 60 < ((counts - 10_000) ** 2 / 10_000).sum() < 150  # chi-squared with 99 degrees of freedom
    assert abs(np.corrcoef(points[:-1], points[1:])[0, 1]) < 0.005


def test_samples_stay_inside_the_open_interval_after_rounding():
    low, high = np.float64(1), np.nextafter(np.nextafter(np.float64(1), 2), 2)
    assert set(np.asarray(sample("uniform", low, high, 100, 0)).tolist()) == {float(np.nextafter(low, high))}
    rounded = np.asarray(draw("uniform", 1.0, 1 + 2.0**-22, 0, 0, 1000, "float32"))
    assert rounded.dtype == np.float32
    assert set(rounded.tolist()) == {1 + 2.0**-23}
    with pytest.raises(RatfitError, match="float32 number"):
        draw("uniform", 1.0, 1 + 2.0**-23, 0, 0, 10, "float32")


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("uniforn", 0, 1, 10, 0), "did you mean 'uniform'"),
        (("uniform", 0, 1, 0, 0), "samples = 0"),
        (("uniform", 0, 1, 1.5, 0), "samples = 1.5"),
        (("uniform", 0, 1, 10, -1), "seed = -1"),
        (("uniform", 0, 1, 10, 2**64), "seed"),
    ],
)
def test_sample_refuses(arguments, named):
    with pytest.raises(RatfitError, match=named):
        sample(*arguments)
