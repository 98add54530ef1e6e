"""Pictures that are saved in notebooks are said in words too, and a page made of a notebook shows the words."""

import importlib.util
import json
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent.parent / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


def words(path):
    """The words of every saved picture."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    outputs = [output for cell in cells for output in cell.get("outputs", ())]
    pictures = [output for output in outputs if "image/png" in output.get("data", {})]
    return [output["metadata"].get("image/png", {}).get("alt", "") for output in pictures]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_every_picture_has_words(path):
    assert words(path) and all(" over " in each and "error / " in each for each in words(path))


@pytest.mark.skipif(importlib.util.find_spec("nbconvert") is None, reason="nbconvert is not installed")
def test_a_page_shows_the_words():
    from html import unescape

    from nbconvert import HTMLExporter

    page, _ = HTMLExporter().from_filename(str(NOTEBOOKS[0]))
    assert all(f'alt="{each}"' in unescape(page) for each in words(NOTEBOOKS[0]))
    assert "No description has been provided" not in page
