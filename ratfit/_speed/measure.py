"""The verb of speed: exact function, fit and copy floor against one another, in a regime of one's choice."""

from __future__ import annotations

import statistics
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from ratfit._parse import RatfitError
from ratfit._sampling import check_protocol
from ratfit._setting import Setting, Value, in_words, setting
from ratfit._speed.backends import BACKENDS, backend_named
from ratfit._speed.check import verdict
from ratfit._speed.contest import Contest, Runs, Unsupported, contest, entrants
from ratfit._speed.cost_model import weight
from ratfit._speed.notes import floor_note, load, noise_note, size_note
from ratfit._speed.rounds import race, ratio_interval


@dataclass(frozen=True, repr=False)
class SpeedMeasurement:
    """The times of exact, fit and copy floor, and what follows from them.

    `gamma` is the exact function's median time over the fit's, the floor not subtracted; `gamma_low` and `gamma_high`
    are the ends of its 95 % interval. `exact_s`, `fit_s` and `floor_s` are the medians, in seconds for one call on all
    samples, of the raw `exact_times`, `fit_times` and `floor_times`, one a round. `note` says how to read gamma.

    gamma is None where the timed output is wrong, and where the backend has not this type or one of the operations,
    which the note then says. The cost model times nothing: its gamma is
    a ratio of weights without an interval, and it has no seconds.
    """

    backend: str
    regime: str
    samples: int
    seed: int
    dtype: str
    parameters: dict[str, Any]
    reference: str | None
    gamma: float | None = None
    gamma_low: float | None = None
    gamma_high: float | None = None
    note: str = ""
    exact_s: float | None = None
    fit_s: float | None = None
    floor_s: float | None = None
    exact_times: tuple[float, ...] = ()
    fit_times: tuple[float, ...] = ()
    floor_times: tuple[float, ...] = ()
    flags: str = ""  # XLA_FLAGS as they stood, or the compiler and its flags
    checked: bool | None = None  # whether the timed output is what the formulas mean; None where nothing ran

    def __repr__(self) -> str:
        """What a notebook shows: gamma with its interval, where it was measured, and the note; no raw times."""
        return f"<{self._gamma_in_words()}; {self.backend}, {in_words(self)}{f'; {self.note}' if self.note else ''}>"

    def _gamma_in_words(self) -> str:
        if self.gamma is None:
            return "no gamma"
        if self.gamma_low is None or self.gamma_high is None:
            return f"gamma {self.gamma:.3g} (counted)"
        return f"gamma {self.gamma:.3g} [{self.gamma_low:.3g}, {self.gamma_high:.3g}]"


def measure_speed(
    fit: Any,
    *,
    backend: str = "jax-cpu",
    samples: int = 1_000_000,
    seed: int = 0,
    dtype: str = "float32",
    parameters: Mapping[str, Value] | None = None,
    reference: str | None = None,
    within: tuple[float, float] | None = None,
    repeats: int | None = None,
) -> SpeedMeasurement:
    """Time the exact function, the fit and the copy floor against one another.

    **Arguments:**

    - `fit`, `parameters`, `reference`, `within`: as for `measure_error`.
    - `backend`: a name of `BACKENDS`; `available()` says which of them this machine has.
    - `samples`, `seed`: the size and seed of the uniform sample that all three run on; `dtype`: their arithmetic.
    - `repeats`: the number of rounds; left out, as many as fit into 1.5 s.

    **Fails** with `RatfitError` for a backend that this machine does not have, for a C compiler that fails, and as
    `measure_error` does.
    See also: `measure_error`.
    """
    check_protocol("uniform", samples, seed, dtype)
    if repeats is not None and repeats < 1:
        raise RatfitError(f"repeats = {repeats}: a whole number from 1 upwards is needed, or None")
    place, chosen = setting(fit, parameters, reference, within), backend_named(backend)
    asked = SpeedMeasurement(backend, BACKENDS[backend], samples, seed, dtype, place.parameters, reference)
    if chosen.prepare is None:
        return _modelled(asked, place)
    waiting, three = load(), contest(place, samples, seed, dtype)
    try:
        runs = chosen.prepare(three)
    except Unsupported as reason:
        return replace(asked, note=f"not timed: {reason}")
    return _timed(asked, three, runs, waiting, repeats)


def _modelled(asked: SpeedMeasurement, place: Setting) -> SpeedMeasurement:
    """What the cost model says: a fit that costs nothing has no gamma."""
    exact, fit, _ = (weight(entrant.steps, asked.dtype) for entrant in entrants(place))
    note = f"exact function {exact:g} additions, fit {fit:g}"
    if not fit:
        return replace(asked, note=f"{note}: a fit without operations has no gamma")
    return replace(asked, gamma=exact / fit, note=note)


def _timed(
    asked: SpeedMeasurement, three: Contest, runs: Runs, waiting: float, repeats: int | None
) -> SpeedMeasurement:
    """What the rounds say, after a look at what was computed in them."""
    raced = race(runs, repeats)
    exact_s, fit_s, floor_s = map(statistics.median, raced.times)
    low, high = ratio_interval(*raced.times[:2])
    wrong, remark = _checked(three, raced.outputs, runs.caution)
    noise = noise_note(low, high, raced.times, waiting)
    notes = (wrong, remark, floor_note(exact_s, fit_s, floor_s), noise, size_note(asked.samples))
    timed = replace(
        asked, exact_s=exact_s, fit_s=fit_s, floor_s=floor_s, exact_times=raced.times[0], fit_times=raced.times[1],
        floor_times=raced.times[2], note="; ".join(filter(None, notes)), flags=runs.flags, checked=not wrong,
    )  # fmt: skip
    return timed if wrong else replace(timed, gamma=exact_s / fit_s, gamma_low=low, gamma_high=high)


def _checked(three: Contest, outputs: tuple[Any, ...], caution: str) -> tuple[str, str]:
    """What is wrong with the outputs, and a remark on what is not finite in them, rightly."""
    found = [verdict(entrant, three, output) for entrant, output in zip(three.entrants, outputs, strict=True)]
    wrong = "; ".join(each.wrong for each in found if each.wrong)
    if wrong:
        return f"{wrong}; {caution}" if caution else wrong, ""
    some = max(each.nonfinite for each in found)
    return "", f"{some} samples are nan or infinite; {caution}" if some and caution else ""
