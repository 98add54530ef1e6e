"""The rows of one problem, and which of them its headline numbers are of."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ratfit._record import Row
from ratfit.report.measured import circumstances, leading, name_of


@dataclass(frozen=True)
class ProblemRows:
    """The rows of one problem, `number` its place on the page and `title` its name there."""

    number: int
    title: str
    rows: tuple[Row, ...]

    @property
    def fit(self) -> dict[str, Any] | None:
        """The fit as `derive --format json` prints it; None where no row has one."""
        own = (row for row in self.rows if row.get("fit") and not name_of(row).peer)
        return next((row["fit"] for row in own), None)

    @property
    def main(self) -> tuple[Row, ...]:
        """The rows that the problem is about: the fit's, against the target where it was measured against it."""
        own = tuple(row for row in self.rows if not name_of(row).peer) or self.rows
        return tuple(row for row in own if not name_of(row).reference) or own

    @property
    def has_target(self) -> bool:
        """Whether some row is against the target, so that rows against references tell of something else."""
        return any(not name_of(row).reference for row in self.rows)

    @property
    def compared(self) -> tuple[Row, ...]:
        """The main rows, and those of the peers against the same exact functions."""
        return tuple(row for row in self.rows if not (self.has_target and name_of(row).reference))

    @property
    def leading(self) -> str:
        """The definition of eps that stands at the top."""
        return leading(self.main)

    def with_errors(self) -> tuple[Row, ...]:
        """The main rows under the circumstances of the first that has an eps."""
        return _like_first(self.main, lambda row: row["epsilon"].get(self.leading))

    def with_times(self) -> tuple[Row, ...]:
        """The main rows under the circumstances of the first that has a gamma."""
        return _like_first(self.main, lambda row: row["gamma"])

    def by_backend(self) -> tuple[tuple[Row, ...], ...]:
        """The main rows that were timed, or could not be, under the dtype and sampling of the first, by backend."""
        timed = [row for row in self.main if row["backend"]]
        alike = [row for row in timed if circumstances(row)[1:] == circumstances(timed[0])[1:]]
        backends = dict.fromkeys(row["backend"] for row in alike)
        return tuple(tuple(row for row in alike if row["backend"] == backend) for backend in backends)


def _like_first(rows: Sequence[Row], value: Callable[[Row], Any]) -> tuple[Row, ...]:
    known = [row for row in rows if value(row) is not None]
    return tuple(row for row in known if circumstances(row) == circumstances(known[0]))
