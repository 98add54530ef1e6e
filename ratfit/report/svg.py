"""A matplotlib figure as an SVG that lives inside a page: its colours follow the page's, its names are its own."""

from __future__ import annotations

import re
import warnings
from collections.abc import Mapping
from io import StringIO
from typing import TYPE_CHECKING
from xml.etree import ElementTree

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

INK, GRID = "#1b1f23", "#e3e7ea"
SERIES = ("#0072b2", "#c65102", "#00805c", "#a8437f", "#8a7300", "#5b4bb5")
"""Colours on white paper that the colour-blind tell apart; `page/style.css` has their counterparts on dark."""

SETTINGS = {
    "svg.fonttype": "none",  # text stays text: it can be read aloud, searched for, and takes the page's own font
    "svg.hashsalt": "ratfit",
    "text.parse_math": False,  # a name may hold a dollar
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 11,
    "text.color": INK,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.facecolor": "none",
    "figure.facecolor": "none",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": GRID,
    "grid.linewidth": 0.8,
    "legend.frameon": False,
}
"""matplotlib's settings for every figure of a page; the caller draws inside `matplotlib.rc_context(SETTINGS)`."""

_VARIABLES = {INK: "--ink", GRID: "--grid", **{colour: f"--series-{n}" for n, colour in enumerate(SERIES, 1)}}
_COLOUR = re.compile("|".join(_VARIABLES))
_FONT = re.compile(r"(font: [^;]*?px) [^;]*")
_DECIMALS = re.compile(r"-?\d+\.\d{3,}")
_HEAD = re.compile(r"<svg [^>]*>")
_DARK = (
    "@media (prefers-color-scheme: dark) { svg { --ink: #e6e8ea; --grid: #343a41; --series-1: #6cb6ff; "
    "--series-2: #ff9d57; --series-3: #4fd6a5; --series-4: #e99cc7; --series-5: #e8d34a; --series-6: #b3a4ff; } }"
)


def svg_of(drawing: Drawing, name: str, alt: str, titles: Mapping[str, str]) -> str:
    """The figure as one `<svg>` element without namespaces.

    Arguments: `drawing`; `name`, which its inner names begin with, for a page holds many figures; `alt`, what is to be
    seen; `titles`, for an artist's gid the text that appears when one points at it. Equal figures give equal text.
    """
    buffer = StringIO()
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")  # the reader's browser has others
        drawing.savefig(buffer, format="svg", metadata=dict.fromkeys(("Creator", "Date", "Format", "Type")))
    root = ElementTree.fromstring(_without_namespaces(buffer.getvalue()))
    _drop_styles(root)
    width, height = root.attrib["viewBox"].split()[2:]
    root.attrib.clear()
    root.attrib.update(
        {
            "viewBox": f"0 0 {width} {height}",
            "role": "img",
            "aria-label": alt,
            "style": "stroke-linejoin: round; stroke-linecap: butt",
        }
    )
    _add_titles(root, titles)
    _rename(root, name)
    _repaint(root)
    _shorten(root)
    return ElementTree.tostring(root, encoding="unicode")


def standalone(svg: str) -> str:
    """An element of `svg_of` as a file of its own, with the colours of dark pages in it."""
    head = '<svg xmlns="http://www.w3.org/2000/svg" '
    return svg.replace("<svg ", head, 1).replace(">", f"><style>{_DARK}</style>", 1) + "\n"


def _without_namespaces(text: str) -> str:
    """The `<svg>` element alone; HTML needs no namespaces, and SVG 2 no `xlink`."""
    text = text[text.index("<svg ") :]
    head = _HEAD.search(text)
    assert head is not None
    bare = re.sub(r' xmlns(:xlink)?="[^"]*"', "", head[0])
    return (bare + text[head.end() :]).replace("xlink:href=", "href=")


def _drop_styles(root: ElementTree.Element) -> None:
    """Takes away style sheets, which would hold for the whole page, and comments on glyphs."""
    for parent in list(root.iter()):
        for child in list(parent):
            if child.tag in ("style", "metadata"):
                parent.remove(child)


def _add_titles(root: ElementTree.Element, titles: Mapping[str, str]) -> None:
    for element in root.iter():
        if element.get("id") in titles:
            title = ElementTree.Element("title")
            title.text = titles[element.attrib["id"]]
            element.insert(0, title)


def _rename(root: ElementTree.Element, name: str) -> None:
    """Keeps the ids that something refers to, each with the figure's name before it."""
    used = set(re.findall(r'href="#([^"]+)"|url\(#([^)]+)\)', ElementTree.tostring(root, encoding="unicode")))
    referred = {one or other for one, other in used}
    for element in root.iter():
        own = element.attrib.pop("id", None)
        if own in referred:
            element.set("id", f"{name}-{own}")
        for key, value in element.attrib.items():
            if key == "href" or value.startswith("url(#"):
                element.set(key, value.replace("#", f"#{name}-", 1))


def _repaint(root: ElementTree.Element) -> None:
    for element in root.iter():
        style = element.get("style")
        if style:
            painted = _COLOUR.sub(lambda colour: f"var({_VARIABLES[colour[0]]}, {colour[0]})", style)
            element.set("style", _FONT.sub(r"\1 system-ui, 'DejaVu Sans', sans-serif", painted))


def _shorten(root: ElementTree.Element) -> None:
    """Coordinates to a hundredth of a point: the rest is half of a file, and nothing that an eye sees."""
    for element in root.iter():
        for key in element.attrib.keys() & {"d", "x", "y", "width", "height", "transform"}:
            shorter = _DECIMALS.sub(lambda number: f"{float(number[0]):.2f}", element.attrib[key])
            element.set(key, " ".join(shorter.split()))
