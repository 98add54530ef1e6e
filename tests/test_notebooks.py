"""The notebooks run in a fresh kernel and print what is saved in them; they are short, and lead on to one another."""

import ast
import importlib.util
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent.parent / "notebooks"
EXECUTE = FOLDER / "execute.py"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
EVERYDAY = {"1_the_sine_in_ten_lines"}
"""The others take from 10 to 40 s each, and are left to CI."""

ABSENT = [name for name in ("nbclient", "nbformat", "ipykernel") if importlib.util.find_spec(name) is None]
needs_kernel = pytest.mark.skipif(bool(ABSENT), reason=f'{ABSENT} not installed: pip install -e ".[notebook]"')
has_compiler = any(map(shutil.which, ("cc", "gcc", "clang")))
every_notebook = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def marked(path):
    marks = [] if path.stem in EVERYDAY else [pytest.mark.thorough]
    if "c-scalar" in path.read_text() and not has_compiler:
        marks.append(pytest.mark.skip(reason="no C compiler: one regime of gamma cannot be timed"))
    return pytest.param(path, marks=marks, id=path.stem)


def executed(*arguments):
    return subprocess.run([sys.executable, EXECUTE, *arguments], capture_output=True, text=True, timeout=500)


def cells(path, kind=None):
    found = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return [cell for cell in found if kind in (None, cell["cell_type"])]


def source(cell):
    return "".join(cell["source"])


def test_there_are_notebooks_in_their_order():
    assert [path.name[0] for path in NOTEBOOKS] == ["1", "2", "3", "4", "5"]


@needs_kernel
@pytest.mark.parametrize("path", [marked(path) for path in NOTEBOOKS])
def test_what_is_saved_is_what_comes_out(path):
    found = executed("--check", path)
    assert found.returncode == 0, found.stderr


@every_notebook
def test_a_notebook_is_short(path):
    """A dozen cells with text and code together; a cell of code has 1 to 8 lines besides imports and magics."""
    assert len(cells(path)) <= 12
    for cell in cells(path, "code"):
        lines = [line for line in source(cell).splitlines() if line.strip()]
        counted = [line for line in lines if not re.match(r"%|import |from ", line)]
        assert 1 <= len(counted) <= 8, source(cell)
        assert max(map(len, lines)) <= 96, source(cell)
    assert path.stat().st_size < 150_000


@every_notebook
def test_a_notebook_uses_what_is_public_alone(path):
    text = "\n".join(line for cell in cells(path, "code") for line in source(cell).splitlines() if line[0:1] != "%")
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom):
            assert not node.module.startswith("ratfit"), node.module
        if isinstance(node, ast.Attribute):
            assert not node.attr.startswith("_"), node.attr


@every_notebook
def test_a_notebook_has_a_title_a_picture_and_a_next(path):
    first, last = source(cells(path)[0]), source(cells(path)[-1])
    assert first.startswith("# ") and "**Next:**" in last
    assert any("image/png" in output.get("data", {}) for cell in cells(path, "code") for output in cell["outputs"])
    for link in re.findall(r"\]\(([^)]+)\)", "\n".join(map(source, cells(path, "markdown")))):
        assert (FOLDER / link).is_file(), link


@every_notebook
def test_outputs_are_saved_in_order_and_nothing_else_is(path):
    code = cells(path, "code")
    assert [cell["execution_count"] for cell in code] == list(range(1, len(code) + 1))
    assert all(cell["metadata"] in ({}, {"tags": ["timing"]}) for cell in cells(path))
    assert [cell["id"] for cell in cells(path)] == [f"cell-{k}" for k in range(1, len(cells(path)) + 1)]
    metadata = json.loads(path.read_text(encoding="utf-8"))["metadata"]
    assert metadata["kernelspec"]["name"] == "python3" and metadata["language_info"] == {"name": "python"}


def notebook_of(path, *typed):
    """A notebook with these cells: source, saved output, tags."""
    written = []
    for number, (text, saved, tags) in enumerate(typed):
        output = [{"output_type": "stream", "name": "stdout", "text": saved}] if saved else []
        code = {"cell_type": "code", "id": f"c{number}", "execution_count": 1, "source": text, "outputs": output}
        written.append({**code, "metadata": {"tags": tags}})
    path.write_text(json.dumps({"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": written}))
    return path


@needs_kernel
def test_a_check_says_what_is_wrong_and_writes_nothing(tmp_path):
    path = notebook_of(
        tmp_path / "some.ipynb",
        ("print(1 + 1)", "2\n", []),
        ("print(1 + 2)", "4\n", []),
        ("print(1 + 3)", "5\n", ["timing"]),
        ("import sys; print('careful', file=sys.stderr)", "", []),
        ("print('/home/somebody/notes')", "/home/somebody/notes\n", []),
        ("print(1 + 4)", "", ["timing"]),
    )
    before = path.read_text()
    found = executed("--check", path)
    assert found.returncode == 1
    assert path.read_text() == before
    assert re.findall(r"cell (\d) prints what has no place", found.stderr) == ["4", "5"]
    assert re.findall(r"cell (\d) prints something else", found.stderr) == ["2", "4", "6"]
    assert "-4\n+3\n" in found.stderr


@needs_kernel
def test_a_cell_that_fails_is_told_of(tmp_path):
    found = executed(notebook_of(tmp_path / "some.ipynb", ("1 / 0", "2\n", [])))
    assert found.returncode == 1 and "some.ipynb" in found.stderr and "ZeroDivisionError" in found.stderr
