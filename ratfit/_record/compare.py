"""Rows of then and of now: what got worse, what got better, beyond noise."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ratfit._record.gamma import gamma_verdict
from ratfit._record.noise import PRECISION, SIGMAS, elsewhere, sampling
from ratfit._record.pairs import identity, remarks, take_pairs, where
from ratfit._record.row import Row


@dataclass(frozen=True)
class Change:
    """What became of one quantity of one measurement.

    `row` holds the measurement's `IDENTITY`, as the new row has it, or the old one's where there is no new. `quantity`
    is `eps` with a definition, `gamma`, `nonfinite`, one of `counts`, or `row` for all of a measurement. `verdict` is
    `worse`, `better` or `same`; `gone` or `added` for what is in one of the two alone; `incomparable` for what no
    verdict can be given on. `why` says by which rule.
    """

    row: Mapping[str, Any]
    quantity: str
    old: float | None
    new: float | None
    verdict: str
    why: str

    @property
    def by(self) -> float:
        """The change as a share of the old value: 0.1 is 10 % more; infinite from 0."""
        if self.old is None or self.new is None or self.old == self.new:
            return 0.0
        return (self.new - self.old) / abs(self.old) if self.old else float("inf")


def compare(old: Sequence[Row], new: Sequence[Row]) -> list[Change]:
    """Every quantity of every measurement, then and now; of a measurement that was made twice the last row stands.

    Rows are paired by `IDENTITY`, those of the same processor first; what is left over once more without samples and
    seed, and is then compared as far as another sample allows. eps is the same for the same sample on the same kind of
    machine, so there any change counts; elsewhere, and for other samples, only what rounding or chance cannot explain
    (`_record/noise.py`). gamma is worse or better only where its two intervals lie apart and it changed by more than
    5 % and by more than the copy floor, which is the same work in every run: what the floor does not keep is the
    machine's. It is not compared between different processors.
    """
    pairs, before, after = take_pairs(old, new)
    changes = [change for then, now in pairs for change in _pair(then, now)]
    changes += [_whole(row, "gone", "in the old rows alone") for row in before]
    return changes + [_whole(row, "added", "in the new rows alone") for row in after]


def _whole(row: Row, verdict: str, why: str) -> Change:
    return Change(identity(row), "row", None, None, verdict, why)


def _pair(old: Row, new: Row) -> Iterator[Change]:
    if old["protocol"] != new["protocol"]:
        why = f"its numbers mean something else: protocol {old['protocol']}, now {new['protocol']}"
        yield _whole(new, "incomparable", why)
        return
    yield from _epsilon(old, new)
    yield from _nonfinite(old, new)
    yield from _gamma(old, new)


def _same_sample(old: Row, new: Row) -> bool:
    return (old["samples"], old["seed"]) == (new["samples"], new["seed"])


# --- eps ---


def _epsilon(old: Row, new: Row) -> Iterator[Change]:
    before, after = old["epsilon"], new["epsilon"]
    for name in [*before, *(name for name in after if name not in before)]:
        verdict, why = _epsilon_verdict(name, old, new)
        yield Change(identity(new), f"eps {name}", before.get(name), after.get(name), verdict, why)


def _epsilon_verdict(name: str, old: Row, new: Row) -> tuple[str, str]:
    before, after = old["epsilon"], new["epsilon"]
    if name not in after or name not in before:
        return _one_sided(was=name in before)
    if before[name] == after[name]:
        return "same", ""
    if before[name] is None or after[name] is None:
        if not _same_sample(old, new):
            return "incomparable", "another sample: it has a value in one of them alone"
        return ("worse", "it has no value any more") if after[name] is None else ("better", "it had no value")
    limit, why = _limit(name, old, new)
    if limit is None:
        return "incomparable", why
    then, now = abs(before[name]), abs(after[name])  # a bias has a sign
    if abs(now - then) <= limit:
        return "same", why
    return ("worse" if now > then else "better"), "; ".join([*([why] if why else []), *remarks(old, new)])


def _one_sided(*, was: bool) -> tuple[str, str]:
    return ("gone", "only the old row has it") if was else ("added", "only the new row has it")


def _limit(name: str, old: Row, new: Row) -> tuple[float | None, str]:
    """How much a change must exceed to be one, and by which rule; None where no limit is known."""
    if not _same_sample(old, new):
        return sampling(name, old, new)
    if not _same_kind(old, new):
        return elsewhere(name, old, new)
    largest = max(abs(old["epsilon"][name]), abs(new["epsilon"][name]))
    return PRECISION * largest, ""


def _same_kind(old: Row, new: Row) -> bool:
    """Whether two rows were measured where arithmetic is the same to the bit."""
    return where(old) == where(new) and all(
        old["machine"]["versions"].get(name) == new["machine"]["versions"].get(name) for name in ("jax", "numpy")
    )


# --- What is not finite ---


def _nonfinite(old: Row, new: Row) -> Iterator[Change]:
    """The counts one by one where both rows have them, or else their sum."""
    counts = [
        (f"counts {name}", old["counts"][name], new["counts"][name]) for name in old["counts"] if name in new["counts"]
    ]
    for quantity, before, after in counts or [("nonfinite", old["nonfinite"], new["nonfinite"])]:
        if before is not None and after is not None:
            verdict, why = _count_verdict(before, after, old, new)
            yield Change(identity(new), quantity, before, after, verdict, why)


def _count_verdict(before: int, after: int, old: Row, new: Row) -> tuple[str, str]:
    """Counts of different samples differ where their shares are `SIGMAS` standard deviations of chance apart."""
    if _same_sample(old, new):
        return ("same" if before == after else "worse" if after > before else "better"), ""
    of_old, of_new = max(old["samples"], 1), max(new["samples"], 1)
    share = (before + after) / (of_old + of_new)
    chance = SIGMAS * (share * (1 / of_old + 1 / of_new)) ** 0.5
    change = after / of_new - before / of_old
    why = f"another sample: shares of the samples, compared beyond {SIGMAS:g} standard deviations"
    return ("same" if abs(change) <= chance else "worse" if change > 0 else "better"), why


# --- gamma ---


def _gamma(old: Row, new: Row) -> Iterator[Change]:
    before, after = old["gamma"], new["gamma"]
    if before is None and after is None:
        return
    verdict, why = gamma_verdict(old, new)
    yield Change(identity(new), "gamma", before, after, verdict, why)
