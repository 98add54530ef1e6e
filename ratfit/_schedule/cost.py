"""What a program costs on each sample."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from ratfit._schedule.program import Program, Select

_CLAMPS = (sp.Min, sp.Max, sp.Abs)


@dataclass(frozen=True)
class Cost:
    """Operations for each sample; subtractions are additions, and what depends on parameters alone is free.

    `other` counts functions: roots, powers with an exponent that is no integer, exponentials and the like.
    """

    add: int = 0
    mul: int = 0
    div: int = 0
    other: int = 0

    @property
    def weight(self) -> int:
        """One number to compare by: a division is worth about 4 multiplications, a function about 20."""
        return self.add + self.mul + 4 * self.div + 20 * self.other

    def as_dict(self) -> dict[str, int]:
        return {"add": self.add, "mul": self.mul, "div": self.div, "other": self.other}


def cost(program: Program) -> Cost:
    steps = program.operations.values()
    kinds = [step.kind for step in steps]
    clamps = sum(step.head in _CLAMPS or isinstance(step.head, Select) for step in steps)
    other = kinds.count("call") - clamps
    return Cost(kinds.count("add") + kinds.count("sub"), kinds.count("mul"), kinds.count("div"), other)
