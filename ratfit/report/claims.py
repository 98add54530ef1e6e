"""Decided claims as text for a terminal, as JSON, and as the page of the documents."""

from __future__ import annotations

import json
import textwrap
from collections import Counter
from collections.abc import Sequence
from typing import Any

from ratfit.claims import DOCUMENTS, VERDICTS, Decision

WIDTH = 100


def claims_json(decisions: Sequence[Decision]) -> str:
    """A list of objects, one for each claim."""
    found = [each.to_json_object() for each in decisions]
    return json.dumps(found, indent=2, ensure_ascii=False, allow_nan=False)


def claims_text(decisions: Sequence[Decision]) -> str:
    """Verdict, claim, and what was claimed and found: a few lines for each, and how many there are of each verdict."""
    blocks = [_text(each.to_json_object()) for each in decisions]
    return "\n\n".join([*blocks, summary(decisions)])


def summary(decisions: Sequence[Decision]) -> str:
    """How many claims have which verdict."""
    counts = Counter(each.verdict for each in decisions)
    parts = [f"{counts[verdict]} {verdict}" for verdict in VERDICTS if counts[verdict]]
    return f"{len(decisions)} claim{'s' * (len(decisions) != 1)}: {', '.join(parts)}"


def _text(decided: dict[str, Any]) -> str:
    lines = [f"{decided['id']} ({decided['place']}): {decided['verdict']}", _wrapped(decided["claim"])]
    lines.append(_wrapped(f"claimed: {in_words(decided['claimed'])}"))
    if decided["verdict"] != "reproduced" or decided["found"] != decided["claimed"]:
        lines.append(_wrapped(f"found:   {in_words(decided['found'])}"))
    if decided["reading"]:
        label = {"reproduced": "by", "reading": "read as", "wrong": "right is", "undecided": "because"}
        lines.append(_wrapped(f"{label[decided['verdict']]}: {decided['reading']}"))
    return "\n".join(lines)


def _wrapped(text: str) -> str:
    return textwrap.fill(text, WIDTH, initial_indent="  ", subsequent_indent="           ")


def in_words(value: Any) -> str:
    """A value as a reader has it: a law holds or does not."""
    if isinstance(value, bool):
        return "holds" if value else "does not hold"
    if value is None:
        return "no value"
    text = f"{value:.4g}" if isinstance(value, float) else str(value)
    laws = set(text.split(", "))
    if laws in ({"True"}, {"False"}):  # several laws of one kind
        return in_words(laws == {"True"})
    return text.replace("True", "holds").replace("False", "does not hold")


INTRODUCTION = """# What the sources claim, decided

The library grew out of four documents. This page lists what they state that can be decided, and the verdict of a
computation on each; `ratfit claims` makes it (`ratfit claims --format markdown --out docs/claims.md`), and
`ratfit claims S-28-A` decides one claim anew. No verdict is written by hand: a function computes what the formulas
give, and compares it with what is claimed.

"""


def claims_markdown(decisions: Sequence[Decision]) -> str:
    """The page of the documents: a table for each source."""
    verdicts = "\n".join(f"- **{verdict}**: {meaning}" for verdict, meaning in VERDICTS.items())
    about = f"{INTRODUCTION}{verdicts}\n\n{summary(decisions)}.\n\n{_EQUAL}"
    return "\n".join([about, *(_section(document, decisions) for document in DOCUMENTS)]).rstrip("\n")


_EQUAL = """Formulas are taken for equal when they agree to 30 digits at seven places of all their symbols; a number
agrees when it rounds to what is printed, or to nine digits where a formula or an integer is claimed.
"""


def _section(document: str, decisions: Sequence[Decision]) -> str:
    own = [each.to_json_object() for each in decisions if each.claim.document == document]
    if not own:
        return ""
    rows = [_row(each) for each in own]
    head = (
        "| id | place | claim | claimed | found | verdict | reading, or what is right |\n|---|---|---|---|---|---|---|"
    )
    return "\n".join([f"## {document}: {DOCUMENTS[document]}", "", head, *rows, ""])


def _row(decided: dict[str, Any]) -> str:
    cells = [decided["id"], decided["place"], decided["claim"]]
    cells += [_code(decided["claimed"]), _code(decided["found"]), f"**{decided['verdict']}**", decided["reading"]]
    return f"| {' | '.join(_cell(each) for each in cells)} |"


def _code(value: Any) -> str:
    words = in_words(value)
    return f"`{words}`" if any(mark in words for mark in "*/(") else words


def _cell(text: str) -> str:
    """Text in a table: no bar, and no star outside of code, would be mistaken for markup."""
    text = text.replace("|", "\\|")
    return text if "`" in text or "**" in text else text.replace("*", "\\*").replace("_", "\\_")
