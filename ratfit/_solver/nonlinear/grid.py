"""Grid: the roots of residuals with parameters, followed along a grid of the parameters' values."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ratfit._parse import RatfitError
from ratfit._solver.nonlinear.arrays import Prepared, System
from ratfit._solver.nonlinear.newton import full_step, newton
from ratfit._solver.nonlinear.quadrature import Rule
from ratfit._solver.nonlinear.residuals import Residuals
from ratfit._solver.nonlinear.search import Settled, is_same, search_system, settle
from ratfit._target import Parameter

NODES = {1: 17, 2: 9}
"""Grid nodes of each parameter, by how many parameters there are."""

SHORTEST = 2.0**-14
"""Of the way between two nodes: where a root cannot be followed by steps of this size, its branch ends."""

CONTRACTION = 0.25
"""Newton's second step over its first, above which a predictor was too far off to be sure of its branch."""

NUDGE = 1e-6
"""The share of the way over which a residual's change with the parameters is taken."""

CERTAIN = 1e-9
"""A first step this short, relative to the root, is all rounding: it need not contract."""


@dataclass(frozen=True)
class Branch:
    """One root followed over the grid.

    - `parameters` (nodes, parameters): the values of the parameters, the last parameter running fastest.
    - `coefficients` (nodes, unknowns): the root there, nan where the branch does not reach. It varies continuously;
      homogeneous unknowns have length 1 and keep their sign from node to node.
    - `failed` (nodes,): where the branch does not reach, or an integral does not settle.
    """

    parameters: np.ndarray
    coefficients: np.ndarray
    failed: np.ndarray


def roots_on_grid(
    residuals: Residuals, parameters: Sequence[Parameter], nodes: int | None = None, *, starts: int = 512, seed: int = 0
) -> list[Branch]:
    """All branches of roots over a tensor grid of Chebyshev points of the first kind in the parameters' ranges.

    Many starts find the roots at the middle node, and at two more for branches that do not reach the middle. Each
    is followed from node to node: along its tangent; a step in the parameters is halved where
    Newton's steps do not contract, so that a root does not jump to another branch.

    **Arguments:**

    - `residuals`: in the unknowns and these parameters.
    - `parameters`: one or two, with finite ranges.
    - `nodes`: how many of each parameter; 17 for one and 9 for two if left out.
    - `starts`, `seed`: of the searches, as for `search`.

    **Returns:** the branches, first those whose roots most starts led to. Empty where nothing was found.

    **Fails** with `RatfitError` for an infinite range, or other than one or two parameters.
    """
    values = grid(parameters, nodes)
    system = System.of(residuals, tuple(parameters))
    shape = (round(len(values) ** (1 / len(parameters))),) * len(parameters)
    found: list[_Track] = []
    for node in _seeds(shape):
        *_, roots = search_system(system, values[[node]], starts=starts, seed=seed)
        new = [root for root in roots if not any(track.holds(node, root.root, system.homogeneous) for track in found)]
        found += _followed(system, values, shape, node, new)
    return [Branch(values, track.coefficients, ~track.done) for track in _distinct(found, system.homogeneous)]


def grid(parameters: Sequence[Parameter], nodes: int | None = None) -> np.ndarray:
    """The values of the parameters at all nodes, (nodes, parameters), the last parameter running fastest."""
    if len(parameters) not in NODES:
        raise RatfitError(f"{len(parameters)} parameters: a grid has one or two; give the others values with --set")
    for parameter in parameters:
        if not (parameter.low.is_finite and parameter.high.is_finite):
            raise RatfitError(
                f"the parameter {parameter} in [{parameter.low}, {parameter.high}] has no grid: give it a finite range"
            )
    count = nodes or NODES[len(parameters)]
    shares = (1 - np.cos(math.pi * (2 * np.arange(count) + 1) / (2 * count))) / 2
    axes = [float(p.low) + (float(p.high) - float(p.low)) * shares for p in parameters]
    return np.stack([axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")], axis=1)


def _seeds(shape: tuple[int, ...]) -> list[int]:
    """The middle node, then two on either side of it."""
    return list(dict.fromkeys(int(np.ravel_multi_index([share * n // 8 for n in shape], shape)) for share in (4, 1, 6)))


@dataclass
class _Track:
    """A branch that is being followed."""

    coefficients: np.ndarray  # (nodes, unknowns)
    done: np.ndarray  # (nodes,)

    def holds(self, node: int, root: np.ndarray, homogeneous: bool) -> bool:
        return bool(self.done[node]) and is_same(self.coefficients[node], root, homogeneous)


def _followed(
    system: System, values: np.ndarray, shape: tuple[int, ...], node: int, roots: Sequence[Settled]
) -> list[_Track]:
    """The branches through roots at one node: a flood over the grid, all branches at once."""
    tracks = []
    for root in roots:
        track = _Track(np.full((len(values), len(system.unknowns)), np.nan), np.zeros(len(values), bool))
        track.coefficients[node], track.done[node] = root.root, True
        tracks.append(track)
    # tanh-sinh serves every root, where one of them needs it.
    rules = [
        max(each, key=lambda rule: (rule.name, rule.count)) for each in zip(*(r.rules for r in roots), strict=True)
    ]
    tried: set[tuple[int, int, int]] = set()
    while pairs := [pair for pair in _frontier(tracks, shape) if pair not in tried]:
        tried.update(pairs)
        _advance(system, values, rules, tracks, pairs)
    for track in tracks:
        _confirm(system, values, rules, track)
    return tracks


def _frontier(tracks: Sequence[_Track], shape: tuple[int, ...]) -> Iterator[tuple[int, int, int]]:
    """Each (branch, node reached, neighbour not reached)."""
    for place, track in enumerate(tracks):
        for node in np.flatnonzero(track.done):
            for neighbour in _neighbours(int(node), shape):
                if not track.done[neighbour]:
                    yield place, int(node), neighbour


def _neighbours(node: int, shape: tuple[int, ...]) -> Iterator[int]:
    index = np.unravel_index(node, shape)
    for axis, way in itertools.product(range(len(shape)), (-1, 1)):
        moved = [int(i) + way * (axis == place) for place, i in enumerate(index)]
        if 0 <= moved[axis] < shape[axis]:
            yield int(np.ravel_multi_index(moved, shape))


def _advance(
    system: System,
    values: np.ndarray,
    rules: Sequence[Rule],
    tracks: Sequence[_Track],
    pairs: Sequence[tuple[int, int, int]],
) -> None:
    """Follows roots to neighbours along their tangents, with steps that are halved where they are too long."""
    first, last = (values[[pair[place] for pair in pairs]] for place in (1, 2))
    here = np.stack([tracks[branch].coefficients[node] for branch, node, _ in pairs])
    way, length = np.zeros(len(pairs)), np.ones(len(pairs))

    def prepared(active: np.ndarray, further: np.ndarray | float) -> Prepared:
        share = (way[active] + further)[:, None]
        return system.prepare(first[active] + share * (last - first)[active], rules)

    while (active := np.flatnonzero((way < 1) & (length >= SHORTEST))).size:
        length[active] = np.minimum(length[active], 1 - way[active])
        tangent = _tangent(system, here[active], prepared(active, 0.0), prepared(active, NUDGE))
        predicted = here[active] + length[active, None] * tangent
        there, good = _corrected(system, predicted, prepared(active, length[active]))
        here[active[good]] = there[good]
        way[active[good]] += length[active[good]]
        length[active] *= np.where(good, 2.0, 0.5)
    for (branch, _, neighbour), end, arrived in zip(pairs, here, way >= 1, strict=True):
        if arrived:
            tracks[branch].coefficients[neighbour], tracks[branch].done[neighbour] = end, True


def _tangent(system: System, roots: np.ndarray, here: Prepared, nudged: Prepared) -> np.ndarray:
    """The change of roots (places, unknowns) over the whole way to the neighbour, were it straight."""
    values, moved = system.at(roots, here), system.at(roots, nudged)
    return full_step(dataclasses.replace(values, value=(moved.value - values.value) / NUDGE))


def _corrected(system: System, starts: np.ndarray, prepared: Prepared) -> tuple[np.ndarray, np.ndarray]:
    """Newton's method from predicted roots (places, unknowns), and where it contracted at once."""
    first = full_step(system.at(starts, prepared))
    second = full_step(system.at(starts + first, prepared))
    ends, good = newton(system, starts + first, prepared)
    lengths, shorter = (np.linalg.norm(step, axis=1) for step in (first, second))
    near = lengths <= CERTAIN * np.linalg.norm(ends, axis=1)
    good &= (shorter <= CONTRACTION * lengths) | near
    return ends, good & ~system.at(ends, prepared).broken & np.isfinite(ends).all(1)


def _confirm(system: System, values: np.ndarray, rules: Sequence[Rule], track: _Track) -> None:
    """Gives up the nodes at which an integral does not settle, and solves again where it takes more nodes."""
    for node in np.flatnonzero(track.done):
        settled = settle(system, values[[node]], rules, track.coefficients[node])
        track.done[node] = settled is not None
        track.coefficients[node] = settled.root if settled else np.nan


def _distinct(tracks: Sequence[_Track], homogeneous: bool) -> list[_Track]:
    """Without those that run along an earlier one: two branches may meet at a node, not at half of them."""
    kept: list[_Track] = []
    for track in tracks:
        nodes = np.flatnonzero(track.done)
        shared = [sum(other.holds(int(n), track.coefficients[n], homogeneous) for n in nodes) for other in kept]
        if 2 * max(shared, default=0) < len(nodes):
            kept.append(track)
    return kept
