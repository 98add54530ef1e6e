"""Rows as a file of records holds them, with invented numbers, for the tests of pages."""

import functools
import math

import ratfit

MACHINE = {"processor": "an abacus", "cores": 2, "devices": [], "versions": {"python": "3.11", "ratfit": "0.0"}}
PUBLISHED = {
    "place": "Eq. 19", "expression": "v/(v - sqrt(2*m**2/pi)*v + sqrt(2*m**2/pi))", "equal": True, "epsilon": 0.018,
    "gamma": 28.7, "source": "schlick1994",
}  # fmt: skip
PEERS = ("aaa", "pade", "polynomial", "table-look-up")
HOSTILE = (
    '<script>document.title = "taken"</script>',
    '"><img src="http://evil.example/x.png" onerror="document.title = 1">',
    "a|b\\|c `d` ``e [f](g) **h** $i$ _j_ # k",
    "_underscored $x^$ </svg></style></pre>",
    "nul \x00 bell \x07 turned \u202e torn \ud800 end",
    "{{ 7*7 }} {% raw %} &lt; &amp;",
    "- a list\n# a heading\n```\n| a | table |",
    "x" * 300,
)
"""Texts that must come out as the letters that they are, whatever they say."""


@functools.cache
def smith_fit():
    """Eq. 19, as `derive --format json` prints it."""
    return ratfit.derive("eq19").to_json_object()


def curve(error=0.01, bins=16, **changes):
    """A line whose fit is off by a parabola."""
    edges = [k / bins for k in range(bins + 1)]
    middles = [(k + 0.5) / bins for k in range(bins)]
    bias = [error * 4 * x * (1 - x) for x in middles]
    fitted = [x + b for x, b in zip(middles, bias, strict=True)]
    own = {"variable": "v", "edges": edges, "exact": middles, "fit": fitted, "bias": bias, "absolute_max": bias}
    return own | changes


def row(name="smith", *, epsilon=0.0136, gamma=12.34, **changes):
    """One row; where `epsilon` is a number the definitions of eps are its multiples 1, 2, ..."""
    names = ("peak_mean", "peak_rms", "peak_max", "relative_mean", "relative_max", "absolute_max", "absolute_q50")
    multiples = epsilon if isinstance(epsilon, dict) else {each: k * epsilon for k, each in enumerate(names, 1)}
    own = {
        "name": name,
        "parameters": {"m": 0.25},
        "samples": 1_000_000,
        "seed": 0,
        "sampling": "uniform",
        "dtype": "float32",
        "backend": "jax-cpu",
        "regime": "jitted arrays",
        "flags": "",
        "epsilon": multiples,
        "nonfinite": 0,
        "worst": {"definition": "relative_max", "at": 0.125},
        "exact_s": 1e-2,
        "fit_s": 1e-2 / gamma if gamma else None,
        "floor_s": 5e-4,
        "gamma": gamma,
        "gamma_low": gamma and 0.966 * gamma,
        "gamma_high": gamma and 1.038 * gamma,
        "note": "",
        "machine": MACHINE,
        "protocol": 2,
        "formula": "formula 0123456789",
        "fit": smith_fit(),
        "command": "ratfit bench smith",
        "finished": "2025-11-22T05:00:00+00:00",
        "counts": {},
        "curve": None,
        "published": PUBLISHED,
    }
    return own | changes


def full_rows():
    """A problem at several settings, on two backends, with peers and a reference; and a second problem."""
    rows = []
    for k, m in enumerate((0.01, 0.05, 0.1, 0.25, 0.5), 1):
        given = {"parameters": {"m": m}}
        note = {1: "fit at the copy floor: gamma is a lower bound", 5: "pole of the fit at v = 0.42"}.get(k, "")
        rows.append(row(epsilon=0.001 * k, gamma=3.0 * k, note=note, curve=curve(0.01 * k), **given))
        rows.append(row(epsilon=0.001 * k, gamma=20.0 * k, backend="c-scalar", **given))
        rows.append(row("smith:walter-2007", epsilon=0.3, gamma=4.0, **given))
        rows += [
            row(
                f"smith~{peer}",
                note=f"{n} entries, linear",
                epsilon=0.002 * k / 3**n,
                gamma=math.sqrt(2 + n * k),
                **given,
            )
            for n, peer in enumerate(PEERS)
        ]
    rows.append(row("smith~aaa", gamma=7.0, curve=curve()))
    other = smith_fit() | {"name": "other"}
    return [*rows, row("other", epsilon=2e-5, gamma=None, fit=other, parameters={}, published=None)]
