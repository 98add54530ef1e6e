"""Killed at any moment, and gone on: the rows are those of a run that nobody disturbed.

`RATFIT_KILLS=50 pytest -m thorough tests/test_kill.py` says how often, as CI does.
"""

import json
import os
import random
import signal
import subprocess
import sys

import pytest

KILLS = int(os.environ.get("RATFIT_KILLS", "2"))

# The state is kept after every part of a row, so that there is always one to go on from.
BENCH = """
import sys
from ratfit._error import stream
from ratfit.cli import main
stream.SAVED, stream.CHUNKS = 0.0, 1
main(["bench", "eq19", "--samples", "1e7", "--set", "m=random", "--backend", "cost-model", *sys.argv[1:]])
"""

OF_THE_MOMENT = {"finished"}
"""What may differ: nothing is timed on the cost model, so only when a row was finished."""


def begin(rows):
    return subprocess.Popen(
        [sys.executable, "-c", BENCH, "--out", str(rows), "--resume"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    )


def finish(rows):
    process = begin(rows)
    _, told = process.communicate()
    assert process.returncode == 0, told.decode()
    return [
        {key: value for key, value in json.loads(line).items() if key not in OF_THE_MOMENT}
        for line in rows.read_text().splitlines()
    ]


@pytest.mark.thorough
@pytest.mark.skipif(sys.platform == "win32", reason="there is no SIGKILL on Windows")
def test_a_run_killed_at_random_moments_ends_with_the_same_rows(tmp_path):
    undisturbed = finish(tmp_path / "undisturbed.jsonl")
    assert len(undisturbed) == 3
    moments = random.Random(1994)
    rows, killed, resumed = tmp_path / "0.jsonl", 0, 0
    while killed < KILLS:
        process = begin(rows)
        try:
            process.wait(timeout=moments.uniform(2.0, 7.0))
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            killed += 1
        process.communicate()
        resumed += (tmp_path / f"{rows.name}.part").exists()
        if process.returncode == 0:
            assert finish(rows) == undisturbed
            rows = tmp_path / f"{killed}.jsonl"
    assert finish(rows) == undisturbed
    assert sorted(path.name for path in tmp_path.iterdir() if path.suffix not in (".jsonl", ".part")) == []
    assert resumed or KILLS < 10  # so many kills meet a row half done
