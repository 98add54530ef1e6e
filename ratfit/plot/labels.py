"""What a picture of a fit is called, and what its exact function and its axis are."""

from __future__ import annotations

from collections.abc import Sequence

from ratfit._fit import Fit
from ratfit._problem import Problem
from ratfit.plot.curves import FitCurves, Parameters, middle
from ratfit.plot.text import mathematics, on_a_line, plain, significant, text_width

LONGEST = 210
"""Points that a formula may take in the legend."""


def exact_text(problem: Problem, reference: str | None) -> str:
    """The exact function in the legend, or that there is none."""
    if reference is not None:
        source = next((r.source for r in problem.references if r.name == reference), "")
        return plain(f"exact: {reference}" + (f" ({source})" if source else ""))
    if problem.target is None:
        names = ", ".join(r.name for r in problem.references)
        return plain("no target to compare with" + (f" (references: {names})" if names else ""))
    written = on_a_line(problem.target.expression)
    text = f"exact: ${written}$"
    return text if written is not None and text_width(text, 9) < LONGEST else "exact"


def title_of(fit: Fit, room: float) -> str:
    """The name and the formula where both fit into `room` points and the formula is exact, else the name."""
    name = plain(fit.problem.name)
    if any(len(str(number.round(8))) > 6 for number in fit.chosen.atoms() if number.is_Float):
        return name
    written = mathematics(fit.chosen)
    title = f"{name}:  ${written}$"
    return title if written is not None and text_width(title, 11) < room else name


def x_label(fit: Fit, curves: Sequence[FitCurves], parameters: Parameters | None, room: float) -> str:
    """The variable, where an infinite domain is cut, and the parameters that all curves share.

    In lines of at most `room` points.
    """
    problem = fit.problem
    label = str(problem.variable)
    if any(end.is_infinite for end in problem.domain):
        low, high = (str(end).replace("oo", "∞").replace("-", "−") for end in problem.domain)
        label += f"   (cut: the domain is [{low}, {high}])"
    settings = [curve.setting.parameters for curve in curves]
    shared = {name: value for name, value in settings[0].items() if len({s[name] for s in settings}) == 1}
    middles = {p.name: middle(p) for p in problem.parameters if p.name not in (parameters or {})}
    is_middle = [middles.get(name) == value for name, value in shared.items()]
    are_all = len(is_middle) > 1 and all(is_middle)
    values = [
        f"{name} = {significant(value, 4)}" + (" (mid-range)" if middle_here and not are_all else "")
        for (name, value), middle_here in zip(shared.items(), is_middle, strict=True)
    ]
    pieces = [f"{label}   at {values[0]}", *values[1:], *(["all mid-range"] if are_all else [])] if values else [label]
    return plain(_in_lines(pieces, room))


def _in_lines(pieces: Sequence[str], room: float) -> str:
    """The pieces with commas between them, in lines of at most `room` points."""
    lines = [pieces[0]]
    for piece in pieces[1:]:
        longer = f"{lines[-1]}, {piece}"
        if text_width(plain(longer), 10) <= room:
            lines[-1] = longer
        else:
            lines[-1] += ","
            lines.append(piece)
    return "\n".join(lines)
