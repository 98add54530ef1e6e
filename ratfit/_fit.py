"""Fit: the approximation with everything known about it; Candidate and Reason. Read this first after the README."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import sympy as sp

from ratfit._condition import AbstractCondition, describe
from ratfit._parse import RatfitError, nearest
from ratfit._problem import Problem
from ratfit._problem_text import form_table
from ratfit._solver import Table

Reason = str
"""One sentence that says why something was rejected or not found, in words a person can act on."""

STATUSES = ("unique", "family", "several", "inconsistent", "rejected", "timeout")

MARKS = {True: ("✓", "ok"), False: ("✗", "NO"), None: ("?", "??")}
"""How a condition is ticked off, and without Unicode."""


@dataclass(frozen=True)
class Checked:
    """A kernel condition and how a candidate keeps it.

    `demand` is the number asked for. `holds` is True, False, or None when algebra and numerics could not agree;
    `residual` is the largest |found - demanded| at 50 digits over sampled parameters, None where there is no number.
    """

    condition: AbstractCondition
    demand: sp.Expr
    holds: bool | None
    residual: float | None

    @property
    def stated(self) -> str:
        """The condition with the number it asks for, in words: "value at 0 = 1"."""
        return f"{describe(self.condition)} = {self.demand}"

    def line(self, *, unicode: bool = True, width: int = 0) -> str:
        """The same ticked off; `width` is what its words are filled up to, for lines below each other."""
        mark = MARKS[self.holds][0 if unicode else 1]
        return f"{mark} {describe(self.condition):<{width}} = {self.demand}"

    def __str__(self) -> str:
        return self.line()


@dataclass(frozen=True)
class Candidate:
    """A solution of the equations with all common factors cancelled: factor * numerator/denominator.

    `free` holds what the conditions leave open, with its range; `reason` is empty for an accepted candidate.
    `certificate` is empty for closed forms; for coefficients found as numbers it says what is proved of them, and
    `table` holds those that were found at nodes of the parameters.
    """

    expression: sp.Expr
    free: Mapping[sp.Symbol, tuple[sp.Expr, sp.Expr]] = field(default_factory=dict)
    conditions: tuple[Checked, ...] = ()
    reason: Reason = ""
    certificate: str = ""
    table: Table | None = None


@dataclass(frozen=True, repr=False)
class Fit:
    """What `derive` found, or an honest no.

    `status` is one of STATUSES; with "unique", "family" and "several" there is an `expression` (with several
    accepted candidates the first of `candidates`), written in the variable, the parameters and the free names, valid
    on the form's support. `rejected` keeps what satisfied the equations and failed as an answer; `reasons` says why
    there is no answer. `equations` are those of the route taken, as text in the unknowns, for a person to read;
    `advice` says what else is worth knowing. A timeout has no answer, and keeps the `candidates` found before it.
    Call it to evaluate it: `fit(0.3, m=0.2)` takes floats, NumPy and JAX arrays.
    """

    problem: Problem
    status: str
    route: str
    candidates: tuple[Candidate, ...] = ()
    rejected: tuple[Candidate, ...] = ()
    reasons: tuple[Reason, ...] = ()
    equations: tuple[str, ...] = ()
    advice: tuple[str, ...] = ()

    @property
    def expression(self) -> sp.Expr | None:
        return self.candidates[0].expression if self.candidates and self.status != "timeout" else None

    @property
    def free(self) -> Mapping[sp.Symbol, tuple[sp.Expr, sp.Expr]]:
        return self.candidates[0].free if self.candidates else {}

    @property
    def conditions(self) -> tuple[Checked, ...]:
        return self.candidates[0].conditions if self.candidates else ()

    @property
    def choice(self) -> Mapping[sp.Symbol, sp.Expr]:
        """The recorded values of free coefficients."""
        return {s: self.problem.choice[s.name] for s in self.free if s.name in self.problem.choice}

    @property
    def chosen(self) -> sp.Expr:
        """The expression with the recorded choices put in, on the support. Raises RatfitError when there is none."""
        return self._found().subs(self.choice)

    def _found(self) -> sp.Expr:
        if self.expression is None:
            raise RatfitError(f"{self.problem.name}: there is no fit ({self.status}): {'; '.join(self.reasons)}")
        return self.expression

    @property
    def formula(self) -> sp.Expr:
        """The approximant on the whole domain: `chosen` on the support, the form's value outside of it elsewhere."""
        return self._on_the_domain(self.chosen)

    def _on_the_domain(self, expression: sp.Expr) -> sp.Expr:
        if self.problem.form.support is None:
            return expression
        low, high = self.problem.form.support
        x, (left, right) = self.problem.variable, self.problem.domain
        outside = [side for side, needed in ((x < low, low != left), (x > high, high != right)) if needed]
        if not outside:
            return expression
        return sp.Piecewise((self.problem.form.outside, sp.Or(*outside)), (expression, True), evaluate=False)

    @cached_property
    def cost(self):
        """Operations a sample of the best schedule found; work on parameters alone and clamps are not counted."""
        from ratfit._schedule import schedule

        ranges = {self.problem.variable: self.problem.support(), **self.problem.parameters}
        return schedule(self.chosen, self.problem.variable, ranges).cost

    def __call__(self, at: Any, **values: float) -> Any:
        """The fit's value; `values` give the parameters, and free coefficients (over a recorded choice), by name.

        A float gives a float, a NumPy or JAX array an array of the same shape and dtype. Values of parameters are not
        held to their ranges, but where coefficients are interpolated in them. Raises RatfitError for a missing or
        unknown name.
        """
        self._check_interpolated(values)
        from ratfit._lower import lower

        kept = {s: v for s, v in self.choice.items() if s.name not in values}
        formula = self._on_the_domain(self._found().subs(kept))
        symbols = sorted(formula.free_symbols - {self.problem.variable}, key=lambda s: s.name)
        known = list(dict.fromkeys(s.name for s in (*self.free, *symbols, *self.problem.parameters)))
        for name in values:
            if name not in known:
                has = ", ".join(known) or "none"
                raise RatfitError(f"{self.problem.name} has no parameter {name}{nearest(name, known)}; it has: {has}")
        missing = [s.name for s in symbols if s.name not in values]
        if missing:
            raise RatfitError(f"{self.problem.name}: give {', '.join(missing)} by name, as in fit(x, {missing[0]}=...)")
        jax = sys.modules.get("jax")  # a JAX array cannot come from a program that never imported JAX
        backend = "jax" if jax is not None and isinstance(at, jax.Array) else "numpy"
        function = lower(formula, [self.problem.variable, *symbols], backend)
        return function(at, *(values[s.name] for s in symbols))

    def plot(
        self,
        axes: Any = None,
        *,
        parameters: Mapping[str, Any] | None = None,
        reference: str | None = None,
        error: str = "peak",
    ) -> Any:
        """Draws the exact function, the fit, its conditions and its error; see `ratfit.plot.plot_fit`.

        Returns the axes `curves, strip`, a picture as the last line of a notebook's cell.
        """
        from ratfit.plot import plot_fit

        return plot_fit(self, axes, parameters=parameters, reference=reference, error=error)

    def _check_interpolated(self, values: Mapping[str, float]) -> None:
        table = self.candidates[0].table if self.candidates else None
        for parameter in table.parameters if table is not None else ():
            low, high = self.problem.parameters[parameter]
            if parameter.name in values and not float(low) <= values[parameter.name] <= float(high):
                given = f"{parameter.name} = {values[parameter.name]}"
                raise RatfitError(
                    f"{self.problem.name}: {given} is outside [{low}, {high}], where coefficients are interpolated; "
                    "widen that range and derive again"
                )

    def __repr__(self) -> str:
        found = "; ".join(self.reasons) if self.expression is None else self.expression
        return f"<Fit {self.problem.name}, {self.status}: {found}>"

    def _repr_latex_(self) -> str | None:
        """Mathematics in a notebook: the target's symbol, and the fit."""
        if self.expression is None:
            return None
        return f"$\\displaystyle {sp.latex(self.formula)}$"

    def to_json_object(self) -> dict[str, Any]:
        """The object of `derive --format json`; expressions are text in ratfit's own grammar."""
        problem = self.problem
        return {
            "name": problem.name,
            "status": self.status,
            "target": None if problem.target is None else str(problem.target.expression),
            "variable": str(problem.variable),
            "domain": [str(end) for end in problem.domain],
            "parameters": {p.name: [str(p.low), str(p.high)] for p in problem.parameters},
            "form": form_table(problem.form),
            "expression": None if self.expression is None else str(self.expression),
            "candidates": [str(c.expression) for c in self.candidates],
            "free": [{"name": str(s), "range": [str(low), str(high)]} for s, (low, high) in self.free.items()],
            "choice": {str(s): str(v) for s, v in self.choice.items()},
            "route": self.route,
            "conditions": [
                {
                    "kind": c.condition.kind,
                    "at": c.condition.place,
                    "equals": str(c.demand),
                    "holds": c.holds,
                    "residual": c.residual,
                }
                for c in self.conditions
            ],
            "rejected": [
                *({"expression": str(c.expression), "reason": c.reason} for c in self.rejected),
                *({"expression": None, "reason": reason} for reason in self.reasons),
            ],
            "cost": None if self.expression is None else self.cost.as_dict(),
        }
