"""Runs notebooks in a fresh kernel and saves what they print; with --check, compares that with what is saved.

    python notebooks/execute.py [--check] [NOTEBOOK ...]

Without names, all notebooks of this folder. What is saved is the same whoever runs it: no hours, no names of a machine,
no metadata but a cell's tags. A cell tagged `timing` shows times: those are saved as they are and not compared.
Exit 0: done; 1: a cell failed, or (--check) what is saved is not what comes out.
"""

from __future__ import annotations

import argparse
import base64
import difflib
import io
import os
import re
import sys
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from nbformat import NotebookNode
from PIL import Image

FOLDER = Path(__file__).parent
SECONDS_A_CELL = 300
QUIET = ["--IPKernelApp.log_level=ERROR", "--InteractiveShell.colors=nocolor"]
KERNEL = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
LANGUAGE = {"language_info": {"name": "python"}}

PICTURES = ("image/jpeg", "image/png", "image/svg+xml")

PRIVATE = re.compile(r"/(?:home|root|tmp|usr|opt|work|Users)/|site-packages|[A-Z]:\\|\bWarning\b|0x[0-9a-f]{6,}")
"""What has no place in a saved output: paths of a machine, warnings, addresses of objects."""


def main() -> int:
    """Executes or checks the notebooks that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("notebooks", nargs="*", type=Path)
    parser.add_argument("--check", action="store_true", help="write nothing, compare with the saved outputs")
    asked = parser.parse_args()
    # The kernel is not to see what the terminal prefers: other pictures, or a GPU, which rounds otherwise.
    os.environ.pop("MPLBACKEND", None)
    os.environ["JAX_PLATFORMS"] = "cpu"
    faults = [fault for path in asked.notebooks or sorted(FOLDER.glob("*.ipynb")) for fault in run(path, asked.check)]
    print("\n".join(faults), file=sys.stderr, end="\n" if faults else "")
    return 1 if faults else 0


def run(path: Path, check: bool) -> list[str]:
    """Executes one notebook; saves it, or compares it with what is saved. Returns what is wrong, one line each."""
    saved = nbformat.read(path, as_version=4)
    fresh = bare(saved)
    try:
        NotebookClient(
            fresh, timeout=SECONDS_A_CELL, kernel_name="python3", record_timing=False, extra_arguments=QUIET
        ).execute()
    except CellExecutionError as failure:
        return [f"{path.name}: {failure}"]
    fresh = tidied(fresh)
    faults = [f"{path.name}: {fault}" for fault in unfit(fresh)]
    if check:
        return faults + [f"{path.name}: {difference}" for difference in differences(saved, fresh)]
    if not faults:
        nbformat.write(fresh, path)
        print(f"{path.name}: executed")
    return faults


def bare(notebook: NotebookNode) -> NotebookNode:
    """The notebook without outputs, as one would type it."""
    cells = [nbformat.from_dict({**cell, "metadata": {}, **_unrun(cell)}) for cell in notebook.cells]
    for cell, source in zip(cells, notebook.cells, strict=True):
        if tags := source.metadata.get("tags"):
            cell.metadata["tags"] = tags
    return nbformat.from_dict({**notebook, "cells": cells, "metadata": {**KERNEL, **LANGUAGE}})


def _unrun(cell: NotebookNode) -> dict[str, object]:
    return {"outputs": [], "execution_count": None} if cell.cell_type == "code" else {}


def tidied(notebook: NotebookNode) -> NotebookNode:
    """What is saved of an executed notebook: the kernel's own metadata (a version, a mode of an editor) is left out.

    Of a picture its words stay, under the key of IPython's own images, for those who do not see it.

    What a cell prints in pieces becomes one piece: where it was cut depends on the kernel's clock.
    """
    notebook.metadata = nbformat.from_dict({**KERNEL, **LANGUAGE})
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs = _joined(cell.outputs)
            for output in cell.outputs:
                if "metadata" in output:
                    output.metadata = nbformat.from_dict(_words_alone(output.metadata))
                if "image/png" in output.get("data", {}):
                    output.data["image/png"] = _in_few_colours(output.data["image/png"])
    return notebook


def _words_alone(metadata: NotebookNode) -> dict[str, dict[str, str]]:
    return {kind: {"alt": about["alt"]} for kind, about in metadata.items() if kind in PICTURES and "alt" in about}


def _in_few_colours(png: str) -> str:
    """The picture with a palette of 256 colours: a drawing has hardly more, and the file is a third as long."""
    buffer = io.BytesIO()
    with Image.open(io.BytesIO(base64.b64decode(png))) as picture:
        picture.convert("RGB").quantize(256, dither=Image.Dither.NONE).save(buffer, "PNG", optimize=True)
    return base64.b64encode(buffer.getvalue()).decode()


def _joined(outputs: list[NotebookNode]) -> list[NotebookNode]:
    found: list[NotebookNode] = []
    for output in outputs:
        if found and output.output_type == found[-1].output_type == "stream" and output.name == found[-1].name:
            found[-1].text += output.text
        else:
            found.append(output)
    return found


def unfit(notebook: NotebookNode) -> list[str]:
    """What must not be published: anything on standard error, paths, warnings."""
    faults = []
    for number, cell in enumerate(notebook.cells, 1):
        for kind, text in shown(cell):
            if kind == "stderr" or PRIVATE.search(text):
                faults.append(f"cell {number} prints what has no place in a saved notebook ({kind}): {text[:300]}")
    return faults


def differences(saved: NotebookNode, fresh: NotebookNode) -> list[str]:
    """Where the saved outputs are not those that come out; of pictures and timings, whether there are any."""
    faults = []
    for number, (before, after) in enumerate(zip(saved.cells, fresh.cells, strict=True), 1):
        timing = "timing" in after.metadata.get("tags", ())
        kept, found = (_compared(cell, timing) for cell in (before, after))
        if kept != found:
            lines = difflib.unified_diff(kept, found, "saved", "fresh", lineterm="", n=1)
            faults.append("\n".join([f"cell {number} prints something else: run notebooks/execute.py", *lines]))
    return faults


def _compared(cell: NotebookNode, timing: bool) -> list[str]:
    if timing:
        return ["some output"] if shown(cell) else []
    return [line for kind, text in shown(cell) for line in (f"[{kind}]", *text.splitlines())]


def shown(cell: NotebookNode) -> list[tuple[str, str]]:
    """The outputs of a cell as (kind, text); of a picture its words, not its size in dots."""
    found = []
    for output in cell.get("outputs", ()):
        if output.output_type == "stream":
            found.append((output.name, output.text))
        else:
            data = output.get("data", {})
            pictures = [(kind, output.metadata.get(kind, {}).get("alt", "")) for kind in PICTURES if kind in data]
            found += pictures or [(kind, str(data[kind])) for kind in sorted(data)]
    return found


if __name__ == "__main__":
    sys.exit(main())
