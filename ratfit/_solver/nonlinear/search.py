"""Search: all real roots of residuals that many starts find, in float64."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from ratfit._solver.nonlinear.arrays import System
from ratfit._solver.nonlinear.newton import FLOOR, damped, misfit, newton
from ratfit._solver.nonlinear.quadrature import NAMES, Rule, choose, confirmed
from ratfit._solver.nonlinear.residuals import Residuals

CHUNK = 128
"""Starts that are followed together; between two chunks a caller learns what was found."""

MOST_ROOTS = 64
SAME = 1e-6
"""Two roots this close, relative to their length, are one."""

SETTLED = 1e-6
"""An integral whose two rules differ by more, relative to its size, has a pole on its range, or diverges."""

HOPELESS = 0.2
"""The misfit under twice as many nodes at which a root is not looked at again."""

UNSEEN, FARTHEST = 1e5, 1e12
"""From where on an unknown has run away: if no residual changes with it any more, and in any case."""

SCALES = (0.3, 1.0, 3.0, 10.0, 30.0)
"""Of the unknowns at the starts: nobody knows the units of a problem beforehand."""

SCAN = 4001
"""Places of a scan of one unknown."""

WIDEST = 1e6
"""The largest unknown that a scan looks at."""


def search(
    residuals: Residuals,
    *,
    starts: int = 512,
    seed: int = 0,
    progress: Callable[[list[np.ndarray]], None] | None = None,
) -> list[np.ndarray]:
    """All distinct roots that the starts lead to.

    **Arguments:**

    - `residuals`: without parameters; at least one unknown.
    - `starts`: how many places Newton's method starts from. One unknown, or one angle, is scanned instead.
    - `seed`: moves the starts; equal seeds give equal roots.
    - `progress`: is told the roots so far after every 128 starts, so that an interrupted search is not lost.

    **Returns:** at most 64 roots, each of shape (unknowns,): first those that most starts led to, then those with the
    smallest residuals. Empty where nothing was found, which proves nothing. Each integral was confirmed by a rule of
    twice as many nodes; a root at which one has a pole on its range, or diverges, is left out. `homogeneous` unknowns
    have length 1 and their largest component positive.

    **Fails** with `RatfitError` for a symbol without a value, and for a function that arrays do not have.
    """
    found: list[np.ndarray] = []
    for found in search_chunks(residuals, starts=starts, seed=seed):
        if progress:
            progress(found)
    return found


def search_chunks(residuals: Residuals, *, starts: int = 512, seed: int = 0) -> Iterator[list[np.ndarray]]:
    """The roots found so far, after each chunk of starts; `search` gives the last of these lists."""
    for found in search_system(System.of(residuals), np.zeros((1, 0)), starts=starts, seed=seed):
        yield [each.root for each in found]


def search_system(
    system: System, parameters: np.ndarray, *, starts: int = 512, seed: int = 0
) -> Iterator[list[Settled]]:
    """The same for a system at one row of values of its parameters, (1, parameters)."""
    one_dimensional = len(system.unknowns) == 1 + system.homogeneous
    places = _scanned(system, parameters) if one_dimensional else _scattered(system, parameters, starts, seed)
    finds = _Finds(system, parameters, starting_rules(system, parameters, places[:16]))
    for first in range(0, max(len(places), 1), CHUNK):
        finds.add(places[first : first + CHUNK])
        yield finds.best()


def _scattered(system: System, parameters: np.ndarray, starts: int, seed: int) -> np.ndarray:
    """Starts (starts, unknowns) over all scales or over the sphere; those without poles on a range come first."""
    candidates = _spread(4 * starts, len(system.unknowns), seed, system.homogeneous)
    prepared = system.prepare(parameters, [Rule()] * len(system.moments))
    broken = system.at(candidates, prepared).broken
    return candidates[np.argsort(broken, kind="stable")[:starts]]


def _spread(count: int, width: int, seed: int, homogeneous: bool) -> np.ndarray:
    """Evenly spread places, (count, width), heavy-tailed around 0 or on the unit sphere."""
    if homogeneous:
        from scipy.special import ndtri

        return _unit(ndtri(np.clip(_additive(count, width, seed), 1e-12, 1 - 1e-12)))
    # Each unknown has a scale of its own at each start: one may be 30 where another is a tenth.
    fractions, choices = np.split(_additive(count, 2 * width, seed), 2, axis=1)
    scales = np.array(SCALES)[(len(SCALES) * choices).astype(int)]
    return np.tan(math.pi * (fractions - 0.5)) * scales


def _additive(count: int, width: int, seed: int) -> np.ndarray:
    """Evenly spread points of the unit cube, (count, width): the additive recurrence of roberts2018.

    The seed shifts them. They serve as well as a Sobol sequence here, without the 0.7 s of importing `scipy.stats`.
    """
    ratio = 2.0
    for _ in range(64):
        ratio = (1 + ratio) ** (1 / (width + 1))
    shift = np.random.default_rng(seed).random(width)
    return (shift + np.outer(np.arange(1, count + 1), ratio ** -np.arange(1.0, width + 1))) % 1.0


def _unit(places: np.ndarray) -> np.ndarray:
    """Each at length 1, with its largest component positive."""
    largest = np.take_along_axis(places, np.abs(places).argmax(1)[:, None], axis=1)
    with np.errstate(all="ignore"):
        return places * np.sign(largest) / np.linalg.norm(places, axis=1, keepdims=True)


def _scanned(system: System, parameters: np.ndarray) -> np.ndarray:
    """Starts next to every change of sign and every local minimum of a scan: it misses no simple root but in pairs."""
    share = np.linspace(-1.0, 1.0, SCAN)
    if system.homogeneous:
        angles = math.pi / 2 * share[:, None]
        places = np.concatenate([np.cos(angles), np.sin(angles)], axis=1)
    else:
        places = (np.sinh(share * math.asinh(WIDEST)))[:, None]
    values = system.at(places, system.prepare(parameters, [Rule()] * len(system.moments)))
    with np.errstate(all="ignore"):
        norms = np.abs(values.value / np.maximum(values.size, 1e-300)).max(1)
    norms = np.where(np.isfinite(norms), norms, np.inf)
    lowest = np.r_[False, (norms[1:-1] <= norms[:-2]) & (norms[1:-1] <= norms[2:]), False]
    changes = (np.sign(values.value[1:]) != np.sign(values.value[:-1])).any(1)
    chosen = lowest | np.r_[changes, False] | np.r_[False, changes]
    return places[chosen & ~values.broken]


def starting_rules(system: System, parameters: np.ndarray, places: np.ndarray) -> list[Rule]:
    """For each moment 48 nodes: of Gauss-Legendre if that serves one of the places, else of tanh-sinh if that does.

    A weight that is singular at an end spoils every place alike.
    """
    rules = []
    for moment in range(len(system.moments)):
        values = [system.weighted(moment, place, parameters) for place in places]
        gauss, double = (min((confirmed(v, Rule(name=name)).error for v in values), default=0.0) for name in NAMES)
        rules.append(Rule(name="tanh-sinh" if gauss > SETTLED > double else "gauss"))
    return rules


def settle(system: System, parameters: np.ndarray, rules: Sequence[Rule], root: np.ndarray) -> Settled | None:
    """The root under rules that reach their tolerance at it; None where an integral does not settle.

    **Arguments:** `root` (unknowns,), found under `rules`, one for each moment; `parameters` (1, parameters).
    """
    for _ in range(4):
        choices = [choose(system.weighted(m, root, parameters)) for m in range(len(rules))]
        if any(choice.error > SETTLED for choice in choices):
            return None
        used, rules = rules, [choice.rule for choice in choices]
        prepared = system.prepare(parameters, rules)
        (root, *_), (good, *_) = newton(system, root[None], prepared)
        if not good:
            return None
        if rules == used:
            break
    return Settled(root, tuple(rules), float(misfit(system.at(root[None], prepared), root[None])[0]))


@dataclass(frozen=True)
class Settled:
    """A root (unknowns,), the rules for its integrals, and its largest residual relative to its scale."""

    root: np.ndarray
    rules: tuple[Rule, ...]
    misfit: float


@dataclass
class _Find:
    raw: np.ndarray  # as found with few nodes
    settled: Settled | None
    times: int


@dataclass
class _Finds:
    """The roots so far."""

    system: System
    parameters: np.ndarray
    rules: list[Rule]
    finds: list[_Find] = field(default_factory=list)

    def add(self, starts: np.ndarray) -> None:
        """Follows starts (starts, unknowns) and counts where they end."""
        prepared = self.system.prepare(self.parameters, self.rules)
        ends, good = newton(self.system, damped(self.system, starts, prepared), prepared)
        doubled = self.system.at(ends, self.system.prepare(self.parameters, [rule.doubled for rule in self.rules]))
        # exp(-1e8*x) is a peak between the nodes: no equation sees such an unknown any more.
        unseen = ((doubled.jacobian == 0).all(1) & (np.abs(ends) > UNSEEN)) | (np.abs(ends) > FARTHEST)
        good &= (misfit(doubled, ends) < HOPELESS) & ~doubled.broken & ~unseen.any(1)
        ends = _unit(ends[good]) if self.system.homogeneous else ends[good]
        for members in clusters(ends):
            self._count(ends[members[0]], len(members))

    def _count(self, raw: np.ndarray, times: int) -> None:
        for find in self.finds:
            if is_same(find.raw, raw, self.system.homogeneous):
                find.times += times
                return
        self.finds.append(_Find(raw, settle(self.system, self.parameters, self.rules, raw), times))

    def best(self) -> list[Settled]:
        """Distinct settled roots, those found most often first, then those with the smallest residuals."""
        kept: list[Settled] = []
        for find in sorted(self.finds, key=lambda each: (-each.times, each.settled.misfit if each.settled else 0.0)):
            settled = find.settled
            if settled and not any(is_same(settled.root, k.root, self.system.homogeneous) for k in kept):
                kept.append(settled)
        return kept[:MOST_ROOTS]


def is_same(first: np.ndarray, second: np.ndarray, homogeneous: bool) -> bool:
    """Whether two roots (unknowns,) are one; homogeneous ones may differ in sign."""
    near = SAME * (FLOOR + max(np.linalg.norm(first), np.linalg.norm(second)))
    return bool(np.linalg.norm(first - second) <= near or (homogeneous and np.linalg.norm(first + second) <= near))


def clusters(places: np.ndarray) -> list[np.ndarray]:
    """The indices of places (places, unknowns) that hang together by distances within the tolerance."""
    lengths = FLOOR + np.linalg.norm(places, axis=1)
    apart = np.linalg.norm(places[:, None] - places, axis=2)
    near = apart <= SAME * np.maximum(lengths[:, None], lengths)
    labels = np.arange(len(places))
    while len(labels):
        lowest = np.where(near, labels, len(labels)).min(1)
        if (lowest == labels).all():
            break
        labels = lowest
    return [np.flatnonzero(labels == label) for label in np.unique(labels)]
