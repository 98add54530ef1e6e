"""A checked model as text for a terminal and as JSON; the list of models."""

from __future__ import annotations

import json
import math
import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from ratfit.models import Model
from ratfit.models.albedo import Albedo
from ratfit.models.check import Check
from ratfit.models.laws import FAILS, HOLDS, NOT_APPLICABLE, UNDECIDED, Law
from ratfit.models.laws.law import degrees
from ratfit.report.text import aligned

WIDTH = 110
ANGLES_SHOWN = 8

UNBROKEN = "\N{NO-BREAK SPACE}"

MARKS = {HOLDS: "ok", FAILS: "FAILS", UNDECIDED: "open", NOT_APPLICABLE: "-"}
ANGLES = ("view", "light", "view's azimuth", "azimuth between")
"""Entries of a place that are angles in degrees; the others are parameters."""


def check_text(check: Check) -> str:
    """The model, a line for each law with its verdict, the place of every failure, and the albedo."""
    model = check.model
    lines = [f"{model.name}: {model.title}", ""]
    lines += _wrapped("source", model.source) + (_wrapped("note", model.note) if model.note else [])
    ranges = [
        f"{p} = {check.fixed[p.name]:g}" if p.name in check.fixed else f"{p} in [{p.low}, {p.high}]"
        for p in model.parameters
    ]
    lines += _wrapped("parameters", _listed(ranges)) if ranges else []
    head = ["law", "verdict", "found", "bound", "what was measured"]
    table = [head, *([law.name, MARKS[law.verdict], *_numbers(law), _measured(law)] for law in check.laws)]
    lines += ["", *(f"  {line}" for line in aligned(table))]
    about = [line for law in check.laws for line in _about(law)]
    lines += ["", *about] if about else []
    lines += ["", *(f"  {line}" for line in _albedo_lines(check))]
    azimuth = {"view's azimuth": math.degrees(check.brightest.azimuth)} if check.brightest.azimuth else {}
    brightest = {**azimuth, **check.brightest.setting}
    shown, bright = (_place(each) or "no parameters" for each in (check.setting, brightest))
    lines += ["", *_wrapped("albedo", f"at {shown}", 22), *_wrapped("brightest setting", f"at {bright}", 22)]
    return "\n".join(lines)


def check_json(check: Check) -> str:
    """The same as one JSON object; angles in degrees, infinite and missing numbers null."""
    model, bright = check.model, check.brightest
    found = {
        "model": model.name,
        "title": model.title,
        "source": model.source,
        "note": model.note,
        "fixed": dict(check.fixed),
        "holds": check.holds,
        "laws": [_law_object(law) for law in check.laws],
        "setting": dict(check.setting),
        "albedo": _albedo_object(check.albedo),
        "albedo_by_samples": _albedo_object(check.samples),
        "brightest": {
            "setting": dict(bright.setting),
            "azimuth": math.degrees(bright.azimuth),
            "settings_tried": bright.tried,
            "albedo": _albedo_object(bright.albedo),
        },
    }
    return json.dumps(found, indent=2, ensure_ascii=False, allow_nan=False)


def models_text(models: Mapping[str, Model]) -> str:
    """Every model with its title; how one of them is checked."""
    rows = aligned([[name, model.title] for name, model in models.items()])
    return "\n".join([*rows, "", "ratfit check-model NAME measures one; --help says more"])


def models_json(models: Mapping[str, Model]) -> str:
    """Every model with its parameters and their ranges."""
    found = [
        {
            "model": name,
            "title": model.title,
            "source": model.source,
            "parameters": {p.name: [float(p.low), float(p.high)] for p in model.parameters},
            "defaults": {key: float(value) for key, value in model.defaults.items()},
        }
        for name, model in models.items()
    ]
    return json.dumps(found, indent=2, ensure_ascii=False)


def _numbers(law: Law) -> list[str]:
    """The number found and its bound, in as many digits as it takes to tell them apart where the law does not hold."""
    for digits in (4, 7, 10, 16):
        texts = ["" if number is None else f"{number:.{digits}g}" for number in (law.found, law.bound)]
        if law.verdict not in (FAILS, UNDECIDED) or len(set(texts)) == 2:
            break
    return texts


def _measured(law: Law) -> str:
    return law.remark if law.verdict == NOT_APPLICABLE else law.measure


def _about(law: Law) -> list[str]:
    """Where a law fails, and what else is to be said of it."""
    if law.verdict not in (FAILS, UNDECIDED):
        return []
    said = [f"at {_place(law.place)}"] * bool(law.place) + [law.remark] * bool(law.remark)
    return _wrapped(law.name, "; ".join(said), 22) if said else []


def _place(place: Mapping[str, float]) -> str:
    angles = [f"{name} {place[name]:.4g} degrees" for name in ANGLES if name in place]
    return _listed([*angles, *(f"{name} = {value:.4g}" for name, value in place.items() if name not in ANGLES)])


def _listed(words: Sequence[str]) -> str:
    """The words with commas, each to stay on one line."""
    return ", ".join(each.replace(" ", UNBROKEN) for each in words)


def _albedo_lines(check: Check) -> list[str]:
    """The albedo at a few angles, beside that by samples, and at the brightest setting found."""
    bright = dict(zip(check.brightest.albedo.cosines.tolist(), check.brightest.albedo.values.tolist(), strict=True))
    exact = dict(zip(check.albedo.cosines.tolist(), check.albedo.values.tolist(), strict=True))
    step = max(1, len(check.samples.cosines) // ANGLES_SHOWN)
    rows = [
        [f"{degrees(c):.1f}", f"{exact[c]:.4f}", f"{m:.4f} +- {e:.4f}", f"{bright[c]:.4f}"]
        for c, m, e in list(zip(*(each.tolist() for each in _parts(check.samples)), strict=True))[::step]
    ]
    head = ["view", "albedo", "by samples", "brightest setting"]
    return aligned([head, *rows])


def _parts(albedo: Albedo) -> tuple[Any, Any, Any]:
    return albedo.cosines, albedo.values, albedo.errors


def _wrapped(label: str, text: str, indent: int = 14) -> list[str]:
    lines = [line.replace(UNBROKEN, " ") for line in textwrap.wrap(text, WIDTH - indent)] or [""]
    return [f"  {label:<{indent - 2}}{lines[0]}", *(" " * indent + line for line in lines[1:])]


def _law_object(law: Law) -> dict[str, Any]:
    return {
        "law": law.name,
        "verdict": law.verdict,
        "measure": law.measure,
        "found": _finite(law.found),
        "bound": _finite(law.bound),
        "place": dict(law.place),
        "remark": law.remark,
    }


def _albedo_object(albedo: Albedo) -> dict[str, list[float | None]]:
    return {
        "view": [degrees(c) for c in albedo.cosines],
        "value": [_finite(float(value)) for value in albedo.values],
        "error": [_finite(float(error)) for error in albedo.errors],
    }


def _finite(number: float | None) -> float | None:
    return number if number is not None and math.isfinite(number) else None
