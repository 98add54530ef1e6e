"""Whether what the timed calls gave is right: fast because broken is not fast.

The very arrays that the last timed calls returned are compared with an evaluation of their own by NumPy in float64,
at the same points. How far they may be off depends on the formula, not on its value alone: where it loses digits, every
arithmetic loses them. So NumPy evaluates it in the dtype under test too, and its greatest error in a part of the
domain, times `MARGIN`, is what the output may be off there. For float64, in which the reference itself rounds, that
error is inferred from float32's and from neighbouring samples.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ratfit._speed.contest import Contest, Entrant

MARGIN = (
    64  # other orders of a sum, a rounding less or more, functions of another library: JAX's gamma is off by 40 units
)
PARTS = (256, 1000)  # at most so many parts of the domain, of at least so many samples each on the average
STRAY = 10_000  # one sample in so many may fall to the other side of a threshold or of an overflow
CHUNK = 2**18


@dataclass(frozen=True)
class Verdict:
    """What is wrong with an output, in words, or nothing; and how many samples are not finite, rightly."""

    wrong: str
    nonfinite: int


@dataclass(frozen=True)
class _Expected:
    """What a formula gives at each sample."""

    exact: Any  # in float64
    own: Any  # what NumPy makes of it in the dtype under test, as float64
    allowed: Any  # how far from the one or the other an output may be


def verdict(entrant: Entrant, contest: Contest, output: Any) -> Verdict:
    """Compare what a timed call gave with what the formula of the entrant means."""
    import numpy as np

    found = np.asarray(output).astype(float)
    if found.shape != contest.samples[0].shape:
        wrong = f"the timed output of the {entrant.name} is wrong: {found.shape} in place of its samples"
        return Verdict(wrong, 0)
    expected = _expected(entrant, contest)
    right = _near(found, expected.exact, expected.allowed) | _near(found, expected.own, expected.allowed)
    wrong = "" if np.sum(~right) <= found.size // STRAY else _words(entrant, contest, found, expected, right)
    return Verdict(wrong, int(np.sum(~np.isfinite(found))))


def _near(found: Any, expected: Any, allowed: Any) -> Any:
    """Within what is allowed of a finite number, or the same infinity, or nan where nan is expected."""
    import numpy as np

    with np.errstate(invalid="ignore"):
        near = np.abs(found - expected) <= allowed
    return np.where(np.isfinite(expected), near, (found == expected) | (np.isnan(found) & np.isnan(expected)))


def _words(entrant: Entrant, contest: Contest, found: Any, expected: _Expected, right: Any) -> str:
    import numpy as np

    first = int(np.argmin(right))
    return (
        f"the timed output of the {entrant.name} is wrong at {np.sum(~right)} of {found.size} samples: "
        f"{found[first]:.9g} in place of {expected.exact[first]:.9g} at {contest.samples[0][first]:.9g}"
    )


def _expected(entrant: Entrant, contest: Contest) -> _Expected:
    import numpy as np

    exact = _evaluated(entrant, contest.samples, "float64")
    own = exact if contest.dtype == "float64" else _evaluated(entrant, contest.samples, contest.dtype)
    parts, count = _parts(contest)
    if contest.dtype == "float64":
        lost = _inferred(entrant, contest, exact, parts, count)
    else:
        lost = _greatest(own, exact, parts, count)
    kind = np.finfo(contest.dtype)
    # A step below the least normal number may have been flushed to 0; a later step may have magnified what it lost.
    allowed = MARGIN * (lost[parts] + kind.eps * np.abs(exact)) + kind.tiny / kind.eps
    return _Expected(exact, own, np.where(np.isfinite(allowed), allowed, MARGIN * lost[parts]))


def _inferred(entrant: Entrant, contest: Contest, exact: Any, parts: Any, count: int) -> Any:
    """What float64 loses in each part: what the next sample changes, and what float32 loses, by as many digits less."""
    import numpy as np

    single, double = np.finfo("float32").eps, np.finfo("float64").eps
    lost = _greatest(_evaluated(entrant, contest.samples, "float32"), exact, parts, count)
    size = _greatest(exact, np.zeros_like(exact), parts, count)
    # Where float32 has lost its digits it bounds nothing: half the digits of float64 are asked for there.
    inferred = np.where(lost > 2.0**-8 * size, np.sqrt(double) * size, lost * (double / single))
    next_samples = tuple(np.nextafter(array, np.inf) for array in contest.samples)
    return np.maximum(inferred, _greatest(_evaluated(entrant, next_samples, "float64"), exact, parts, count))


def _evaluated(entrant: Entrant, samples: tuple[Any, ...], dtype: str) -> Any:
    """The formula on NumPy in a dtype, in chunks: its tape holds an array for each step."""
    import numpy as np

    function = entrant.hoisted.on_arrays(entrant.constants, dtype)
    starts = range(0, samples[0].size, CHUNK)
    chunks = (tuple(array[start : start + CHUNK].astype(dtype) for array in samples) for start in starts)
    return np.concatenate([np.asarray(function(*chunk), float) for chunk in chunks])


def _parts(contest: Contest) -> tuple[Any, int]:
    """The part of the domain in which every sample lies, and how many parts there are."""
    import numpy as np

    points = contest.samples[0].astype(float)
    most, samples = PARTS
    count = int(np.clip(points.size // samples, 1, most))
    low, high = contest.place.low, contest.place.high
    return np.clip((points - low) * (count / (high - low)), 0, count - 1).astype(int), count


def _greatest(first: Any, second: Any, parts: Any, count: int) -> Any:
    """The greatest finite distance of two evaluations in each part; 0 where there is none."""
    import numpy as np

    greatest = np.zeros(count)
    with np.errstate(invalid="ignore", over="ignore"):
        apart = np.abs(first - second)
    np.maximum.at(greatest, parts, np.where(np.isfinite(apart), apart, 0))
    return greatest
