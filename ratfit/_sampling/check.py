"""What can be sampled and what cannot: the one place where the names of protocols are read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ratfit._parse import RatfitError, nearest
from ratfit._sampling.exhaustive import check_exhaustive
from ratfit._sampling.protocols import CARRIERS, PROTOCOLS
from ratfit._sampling.sobol import DIGITS
from ratfit._setting import PAIR, Setting

DTYPES = ("float16", "float32", "float64")

WHOLE = "pair"
"""In place of the letter of one cosine: all of them."""

_DOMAINS: Mapping[str, tuple[float, float]] = {
    "angle": (-1, 1),
    "cosine": (0, 1),
    "in-plane": (0, 1),
    "hemisphere": (0, 1),
}


def resolve(sampling: str, variable: str, low: float, high: float, dtype: str, drawn: Sequence[str] = ()) -> str:
    """The canonical name of a protocol, as records have it: `in-plane` of a variable `u` is `in-plane:u`.

    **Arguments:** the protocol as the user says it; the name of the problem's variable and its domain; the dtype; the
    names of what is drawn at random beside the variable. A formula of all cosines of a pair (`PAIR`) is sampled on
    pairs alone: cosines that belong to no pair of directions mean nothing.

    **Fails** with `RatfitError` for an unknown protocol, a pair of directions without a cosine that the variable is, a
    domain that the protocol does not draw from, and a dtype that `exhaustive` cannot visit.
    """
    family, letter = _family(sampling)
    _check_dtype(dtype)
    _check_domain(family, low, high)
    if family == "exhaustive":
        check_exhaustive(dtype)
    letters = _letters(family)
    if (variable, *drawn)[: len(PAIR)] == PAIR:
        if family != "hemisphere" or letter not in ("", WHOLE):
            raise RatfitError(f"a whole model is sampled on pairs of directions: say hemisphere, not {sampling}")
        return f"{family}:{WHOLE}"
    if letter == WHOLE:
        raise RatfitError(f"{sampling} draws every cosine of a pair, for a whole model: say which one, as {family}:u")
    letters = [known for known in _letters(family) if known != WHOLE]
    if not letters:
        return family
    letter = letter or (variable if variable in letters else "")
    if not letter:
        ways = " or ".join(f"{family}:{known}" for known in letters)
        raise RatfitError(f"{family} does not know which cosine {variable or 'the variable'} is: say {ways}")
    return f"{family}:{letter}"


def protocol_at(place: Setting, sampling: str, dtype: str) -> str:
    """The canonical name of the protocol that a setting is sampled by. **Fails** as `resolve` does."""
    return resolve(sampling, place.variable.name, place.low, place.high, dtype, place.drawn)


def check_protocol(sampling: str, samples: int | None, seed: int, dtype: str = "float64") -> None:
    """Fails with `RatfitError` for what no measurement can be made of; `exhaustive` takes `samples=None` alone."""
    family, _ = _family(sampling)
    if family == "exhaustive":
        if samples is not None:
            raise RatfitError(f"samples = {samples}: exhaustive measures at every number, leave samples out")
    elif not isinstance(samples, int) or samples < 1:
        raise RatfitError(f"samples = {samples}: a whole number from 1 upwards is needed")
    elif family == "sobol" and samples > 2**DIGITS:
        raise RatfitError(f"samples = {samples}: sobol has 2**{DIGITS} points, take fewer or sample uniform")
    if not isinstance(seed, int) or not 0 <= seed < 2**64:
        raise RatfitError(f"seed = {seed}: a whole number from 0 to 2**64 - 1 is needed")
    _check_dtype(dtype)


def _family(sampling: str) -> tuple[str, str]:
    """The protocol and the letter after the colon, both known, the letter empty where none is said."""
    family, colon, letter = sampling.partition(":")
    if family not in PROTOCOLS:
        raise RatfitError(f"no sampling {sampling!r}, there is: {', '.join(PROTOCOLS)}{nearest(family, PROTOCOLS)}")
    letters = _letters(family)
    if colon and not letters:
        raise RatfitError(f"no sampling {sampling!r}: {family} takes no cosine, say {family}")
    if colon and letter not in letters:
        others = " (in a plane H has no azimuth: say hemisphere:w)" if sampling == "in-plane:w" else ""
        ways = ", ".join(f"{family}:{known}" for known in letters)
        raise RatfitError(f"no sampling {sampling!r}, there is: {ways}{others}")
    return family, letter


def _letters(family: str) -> list[str]:
    """The cosines of a pair of directions that a protocol can draw; none for the others."""
    return [letter for known, _, letter in (name.partition(":") for name in CARRIERS) if known == family and letter]


def _check_domain(family: str, low: float, high: float) -> None:
    least, greatest = _DOMAINS.get(family, (low, high))
    if letters := _letters(family):
        if (low, high) != (least, greatest):
            raise RatfitError(
                f"{family} draws {', '.join(letters)} on [0, 1], not on [{low}, {high}]: sample uniform or sobol, "
                "or state the problem in such a cosine"
            )
    elif not least <= low <= high <= greatest:
        raise RatfitError(
            f"{family} draws a cosine inside [{least}, {greatest}], not on [{low}, {high}]: sample uniform or sobol, "
            "or state the problem in the cosine"
        )


def _check_dtype(dtype: str) -> None:
    if dtype not in DTYPES:
        raise RatfitError(f"no dtype {dtype!r}: measure in {', '.join(DTYPES[:-1])} or {DTYPES[-1]}")
