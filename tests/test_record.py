"""Records: the contract of a row, and files that survive interruption."""

import json
import math
import os
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ratfit
from ratfit._parse import RatfitError
from ratfit._record import (
    KEYS,
    PROTOCOL,
    Record,
    append_row,
    check_resumable,
    contract,
    drop_checkpoint,
    machine,
    merge,
    no_checkpoint,
    read_checkpoint,
    read_rows,
    same_measurement,
    write_checkpoint,
    write_text,
)

RECORD = Record(
    name="smith",
    parameters={"m": 0.2},
    samples=1_000_000,
    seed=0,
    sampling="uniform",
    dtype="float32",
    backend="jax-cpu",
    regime="throughput",
    flags="",
    epsilon={"peak_mean": 0.018, "relative_max": None},
    nonfinite=0,
    worst={"definition": "relative_max", "at": 0.5},
    exact_s=3e-3,
    fit_s=1e-3,
    floor_s=1e-3,
    gamma=3.0,
    gamma_low=2.9,
    gamma_high=3.1,
    note="",
)
SETTING = {
    "name": "smith", "parameters": {"m": 0.2}, "samples": 1_000_000, "seed": 0, "sampling": "uniform",
    "dtype": "float32", "backend": "jax-cpu",
}  # fmt: skip
LINE = (json.dumps(RECORD.to_line()) + "\n").encode()


def names(folder):
    return [path.name for path in folder.iterdir()]


def test_a_row_has_the_keys_of_the_contract_in_their_order():
    assert ", ".join(RECORD.to_json_object()) == (
        "name, parameters, samples, seed, sampling, dtype, backend, regime, flags, epsilon, nonfinite, worst, "
        "exact_s, fit_s, floor_s, gamma, gamma_low, gamma_high, note"
    )
    assert ", ".join(RECORD.to_line()) == (
        ", ".join(KEYS) + ", machine, protocol, formula, fit, command, finished, counts, curve, published"
    )
    assert contract(RECORD.to_line()) == RECORD.to_json_object()


def test_a_line_says_by_itself_where_when_and_by_which_rules_it_was_measured():
    line = RECORD.to_line()
    loaded_meanwhile = {"devices": line["machine"]["devices"]}  # by tests before this one, where JAX is now known
    assert line["machine"] == machine() | loaded_meanwhile
    assert line["machine"]["versions"]["ratfit"] == ratfit.__version__
    assert line["protocol"] == PROTOCOL
    finished = datetime.fromisoformat(line["finished"])
    assert finished.utcoffset().total_seconds() == 0 and finished.microsecond == 0
    assert 0 <= (datetime.now(UTC) - finished).total_seconds() < 3600
    further = ("formula", "fit", "command", "counts", "curve", "published")
    assert [line[key] for key in further] == ["", None, "", {}, None, None]


def test_json_holds_neither_nan_nor_infinity_nor_numpy():
    odd = replace(
        RECORD,
        parameters={"m": np.float32(0.25)},
        samples=np.int64(5),
        gamma=math.inf,
        epsilon={"peak_mean": math.nan},
        worst={"definition": "relative_max", "at": -math.inf},
    )
    row = json.loads(json.dumps(odd.to_json_object(), allow_nan=False))
    assert (row["gamma"], row["epsilon"], row["worst"]["at"]) == (None, {"peak_mean": None}, None)
    assert (row["parameters"], row["samples"]) == ({"m": 0.25}, 5)


def test_what_a_line_holds_further_is_made_plain_too():
    odd = replace(
        RECORD,
        parameters={"m": (0.01, np.float64(0.5))},
        fit={"candidates": ["x"], "cost": {"add": np.int32(1)}, "unique": True},
        curve={"at": [0.0, 1.0], "error": (np.float32(0.5), math.nan)},
        counts={"nan_fit": np.int64(3)},
    )
    row = json.loads(json.dumps(odd.to_line(), allow_nan=False))
    assert row["parameters"] == {"m": [0.01, 0.5]}
    assert row["fit"] == {"candidates": ["x"], "cost": {"add": 1}, "unique": True}
    assert (row["curve"]["error"], row["counts"]) == ([0.5, None], {"nan_fit": 3})


def test_the_machine_is_described():
    described = machine()
    assert list(described) == ["processor", "cores", "devices", "versions"]
    assert list(described["versions"]) == ["python", "numpy", "jax", "sympy", "ratfit"]
    assert described["processor"]
    assert described["cores"] >= 1
    json.dumps(described, allow_nan=False)


# --- Whole files ---


def test_write_text_replaces_whole_and_leaves_nothing_beside(tmp_path):
    path = tmp_path / "page.md"
    write_text(path, "first\n")
    write_text(str(path), "µ\n")
    assert path.read_text(encoding="utf-8") == "µ\n"
    assert names(tmp_path) == ["page.md"]


def test_an_interruption_leaves_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "page.md"
    write_text(path, "old")

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_text(path, "new")
    assert path.read_text() == "old"
    assert names(tmp_path) == ["page.md"]


def test_a_link_keeps_pointing_and_a_device_stays_a_device(tmp_path):
    link = tmp_path / "link"
    link.symlink_to(tmp_path / "real")
    write_text(link, "text")
    assert link.is_symlink()
    assert (tmp_path / "real").read_text() == "text"
    write_text("/dev/null", "text")
    assert Path("/dev/null").is_char_device()


WRITERS = [lambda path: write_text(path, "text"), lambda path: append_row(path, RECORD)]


@pytest.mark.parametrize("write", WRITERS)
@pytest.mark.parametrize(
    ("name", "fragment"),
    [
        ("missing/page.md", "there is no folder .*missing; make it first"),
        (".", "is a folder; name a file in it"),
        ("file/page.md", "file is a file and no folder"),
        ("file/deeper/page.md", "file is a file and no folder"),
        ("n" * 300, "name too long; choose another place"),
        ("astray", "there is no folder .*gone; make it first"),
        ("circle", "Too many levels of symbolic links; choose another place"),
    ],
    ids=lambda text: text[:20],
)
def test_places_that_cannot_be_written_are_refused(write, name, fragment, tmp_path):
    (tmp_path / "file").write_text("")
    (tmp_path / "astray").symlink_to(tmp_path / "gone" / "page.md")
    (tmp_path / "circle").symlink_to(tmp_path / "round")
    (tmp_path / "round").symlink_to(tmp_path / "circle")
    before = names(tmp_path)
    with pytest.raises(RatfitError, match=fragment):
        write(tmp_path / name)
    assert names(tmp_path) == before


@pytest.mark.skipif(sys.platform != "linux", reason="/proc and /dev/full")
@pytest.mark.parametrize(
    ("write", "place", "fragment"),
    [
        (WRITERS[0], "/proc/page.md", "the folder /proc takes no files"),
        (WRITERS[1], "/proc/rows.jsonl", "the folder /proc takes no files"),
        (WRITERS[0], "/dev/full", "No space left on device; choose another place"),
    ],
)
def test_a_folder_that_is_there_is_not_said_to_be_missing(write, place, fragment):
    with pytest.raises(RatfitError, match=fragment):
        write(place)


def test_a_refusal_by_the_system_is_explained(tmp_path, monkeypatch):
    def refused(*_):
        raise PermissionError

    monkeypatch.setattr(Path, "replace", refused)
    with pytest.raises(RatfitError, match=r"page\.md: no permission to do that there; choose another place"):
        write_text(tmp_path / "page.md", "text")
    assert names(tmp_path) == []


def test_a_file_that_may_not_be_read_is_not_said_to_be_unwritable(tmp_path, monkeypatch):
    (tmp_path / "rows.jsonl").write_bytes(LINE)

    def refused(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", refused)
    with pytest.raises(RatfitError) as told:
        read_rows(tmp_path / "rows.jsonl")
    assert "no permission" in str(told.value) and "write" not in str(told.value)


# --- Files of rows ---


def test_rows_come_back_as_they_were_written(tmp_path):
    path = tmp_path / "rows.jsonl"
    assert read_rows(path) == []
    append_row(path, RECORD)
    append_row(path, replace(RECORD, name="sine"))
    assert path.read_bytes().count(b"\n") == 2
    assert [row["name"] for row in read_rows(path)] == ["smith", "sine"]
    assert read_rows(path)[0] == RECORD.to_line()


def test_a_row_torn_at_any_byte_is_dropped_and_the_rest_kept(tmp_path):
    path = tmp_path / "rows.jsonl"
    for cut in range(len(LINE)):
        path.write_bytes(LINE + LINE[:cut])
        whole = cut >= len(LINE) - 1  # only the end of the line is missing: nothing of the row is lost
        assert len(read_rows(path)) == 1 + whole
        append_row(path, replace(RECORD, seed=1))
        assert path.read_bytes().startswith(LINE * (1 + whole))
        assert [row["seed"] for row in read_rows(path)] == [0] * (1 + whole) + [1]


def test_a_first_row_torn_is_dropped(tmp_path):
    path = tmp_path / "rows.jsonl"
    path.write_bytes(LINE[:50])
    assert read_rows(path) == []
    append_row(path, RECORD)
    assert path.read_bytes() == LINE


@pytest.mark.parametrize(
    "content",
    [b"a note", b"a note\n", b"\n", b"[1, 2]\n", b"{}\n", b'{"name": "smith"}\n', b"\xff\xfe\n", b"[" * 5000 + b"\n",
     LINE + b"\n", LINE + b"a note", LINE.replace(b"3.0", b"NaN"), LINE.replace(b"3.0", b"1e999"),
     LINE.replace(b'"seed"', b'"sead"'), LINE.replace(b'"samples": 1000000', b'"samples": "many"'),
     LINE.replace(b'"epsilon": {', b'"epsilon": {"own": {}, '), LINE.replace(b'"m": 0.2', b'"m": [0.1, 0.2, 0.3]')],
)  # fmt: skip
def test_a_file_of_something_else_is_refused_and_stays(content, tmp_path):
    path = tmp_path / "notes.txt"
    path.write_bytes(content)
    with pytest.raises(RatfitError, match=r"notes\.txt"):
        read_rows(path)
    with pytest.raises(RatfitError, match=r"notes\.txt"):
        append_row(path, RECORD)
    assert path.read_bytes() == content


@pytest.mark.parametrize("tail", [1, len(LINE) - 1, len(LINE), 2 * len(LINE)])
def test_a_long_file_is_mended_at_its_end_alone(tail, tmp_path, monkeypatch):
    monkeypatch.setattr("ratfit._record.rows._TAIL", tail)
    path = tmp_path / "rows.jsonl"
    path.write_bytes(LINE * 10 + LINE[:30])
    append_row(path, RECORD)
    assert path.read_bytes() == LINE * 11


def test_rows_longer_than_what_is_read_at_once_are_rows(tmp_path):
    path = tmp_path / "rows.jsonl"
    long = replace(RECORD, curve={"error": [1 / 3] * 20_000})
    for _ in range(3):
        append_row(path, long)
    assert read_rows(path) == [long.to_line()] * 3


def test_a_row_of_an_older_ratfit_is_called_that(tmp_path):
    path = tmp_path / "rows.jsonl"
    path.write_text(json.dumps(RECORD.to_json_object()) + "\n")
    for refused in (lambda: read_rows(path), lambda: append_row(path, RECORD)):
        with pytest.raises(RatfitError, match="another ratfit"):
            refused()


def test_a_record_that_could_not_be_read_again_is_not_written(tmp_path):
    with pytest.raises(TypeError):
        append_row(tmp_path / "rows.jsonl", replace(RECORD, seed=None))
    assert names(tmp_path) == []


def test_a_bad_line_is_named_by_its_number(tmp_path):
    path = tmp_path / "rows.jsonl"
    path.write_bytes(LINE + b"a note\n" + LINE)
    with pytest.raises(RatfitError, match="line 2"):
        read_rows(path)


# --- Several processes ---

WRITER = """
import sys
from dataclasses import replace
sys.path.insert(0, sys.argv[1])
from test_record import RECORD, append_row, write_checkpoint
for seed in range(int(sys.argv[3]), 10**9):
    if seed % 1000 >= int(sys.argv[4]):
        break
    append_row(sys.argv[2], replace(RECORD, seed=seed, note="n" * (seed % 7) * 1000))
    write_checkpoint(sys.argv[2] + str(seed // 1000), {}, {"done": seed})
"""


def writer(path, first, rows):
    here = str(Path(__file__).parent)
    return subprocess.Popen([sys.executable, "-c", WRITER, here, str(path), str(first), str(rows)])


def test_processes_that_append_at_once_and_one_that_is_killed_tear_nothing(tmp_path):
    path = tmp_path / "rows.jsonl"
    writers = [writer(path, 0, 40), writer(path, 1000, 40), writer(path, 2000, 999)]
    end = time.monotonic() + 60
    while sum(row["seed"] >= 2000 for row in read_rows(path)) < 5:
        assert time.monotonic() < end
        time.sleep(0.01)
    writers[2].send_signal(signal.SIGKILL)
    assert [process.wait() for process in writers] == [0, 0, -signal.SIGKILL]
    append_row(path, replace(RECORD, seed=5000))
    seeds = [row["seed"] for row in read_rows(path)]
    assert [seed for seed in seeds if seed < 1000] == list(range(40))
    assert [seed for seed in seeds if 1000 <= seed < 2000] == list(range(1000, 1040))
    killed = [seed for seed in seeds if 2000 <= seed < 5000]
    assert killed == list(range(2000, 2000 + len(killed)))
    assert path.read_bytes().count(b"\n") == len(seeds)


@pytest.mark.skipif(sys.platform == "win32", reason="it has no flock")
def test_a_file_that_another_process_does_not_let_go_of_is_explained(tmp_path, monkeypatch):
    import fcntl

    monkeypatch.setattr("ratfit._record.rows._PATIENCE", 0.05)
    path = tmp_path / "rows.jsonl"
    append_row(path, RECORD)
    with path.open("ab") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        with pytest.raises(RatfitError, match="another process"):
            append_row(path, RECORD)
    append_row(path, RECORD)
    assert len(read_rows(path)) == 2


@pytest.mark.skipif(sys.platform == "win32", reason="it has no flock")
def test_a_line_that_another_process_is_writing_is_not_taken_for_a_torn_one(tmp_path):
    import fcntl

    path = tmp_path / "rows.jsonl"
    other = threading.Thread(target=append_row, args=(path, replace(RECORD, seed=1)))
    with path.open("ab", buffering=0) as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        file.write(LINE[:100])
        other.start()
        time.sleep(0.1)
        file.write(LINE[100:])
    other.join()
    assert [row["seed"] for row in read_rows(path)] == [0, 1]


def test_what_a_killed_process_left_beside_a_file_is_swept_away(tmp_path):
    path = tmp_path / "page.md"
    kin = _kin_of(path)
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    for process in (gone.pid, os.getpid()):
        (tmp_path / f"{kin}-{process}-00000000.tmp").write_text("half")
    write_text(path, "text")
    assert sorted(names(tmp_path)) == [f"{kin}-{os.getpid()}-00000000.tmp", "page.md"]


def _kin_of(path):
    """How the names of temporary files begin, seen from a write that is caught in the middle."""
    seen = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda _: seen.extend(names(path.parent)))
        write_text(path, "")
    return next(name for name in seen if name.endswith(".tmp")).split("-")[0]


# --- Going on ---


def test_the_same_measurement_is_recognised_and_any_other_is_not(tmp_path):
    append_row(tmp_path / "rows.jsonl", RECORD)
    (row,) = read_rows(tmp_path / "rows.jsonl")
    assert same_measurement(row, **SETTING)
    others = {"name": "sine", "parameters": {"m": 0.3}, "samples": 10, "seed": 1, "sampling": "cosine",
              "dtype": "float64", "backend": "jax-gpu", "formula": "exp"}  # fmt: skip
    for key, value in others.items():
        assert not same_measurement(row, **{**SETTING, key: value})
    assert not same_measurement({**row, "protocol": PROTOCOL - 1}, **SETTING)
    assert not same_measurement(of_version(row, "0.0.1"), **SETTING)


def of_version(row, version):
    return {**row, "machine": {**row["machine"], "versions": {**row["machine"]["versions"], "ratfit": version}}}


def test_a_parameter_that_is_drawn_over_its_range_is_recognised():
    row = replace(RECORD, parameters={"m": (0.01, 0.5)}).to_line()
    assert same_measurement(row, **{**SETTING, "parameters": {"m": (0.01, 0.5)}})
    assert not same_measurement(row, **SETTING)


ROW = RECORD.to_line()


@pytest.mark.parametrize(
    "rows",
    [[], [ROW], [ROW, ROW], [{**ROW, "formula": "older"}], [{**ROW, "name": "sine", "samples": 7}],
     [{**ROW, "parameters": {"m": 0.3}, "seed": 7}], [{**ROW, "backend": "c", "dtype": "float64"}]],
)  # fmt: skip
def test_files_that_can_be_gone_on_from(rows):
    check_resumable(rows, [SETTING])


@pytest.mark.parametrize(
    ("row", "text"),
    [
        ({**ROW, "protocol": 1}, rf"rows\.jsonl .* measuring protocol 1, and now it is {PROTOCOL}.*another --out"),
        (of_version(ROW, "0.0.1"), rf"of ratfit 0\.0\.1, and this is {ratfit.__version__}: .*another --out"),
        ({**ROW, "samples": 7}, "smith measured with samples 7, and samples 1000000 is asked.*ask for samples 7 again"),
        ({**ROW, "seed": 7}, "seed 7, and seed 0 is asked"),
        ({**ROW, "sampling": "cosine"}, "sampling cosine, and sampling uniform is asked"),
        ({**ROW, "dtype": "float64", "seed": 7}, "seed 7, dtype float64, and seed 0, dtype float32 is asked"),
    ],
)
def test_files_that_cannot_be_gone_on_from_say_what_differs_and_what_to_do(row, text):
    with pytest.raises(RatfitError, match=text) as refused:
        check_resumable([ROW, row], [SETTING], "rows.jsonl")
    assert "\n" not in str(refused.value)


def test_a_run_of_several_types_goes_on_from_its_own_rows():
    double = {**ROW, "dtype": "float64"}
    check_resumable([ROW, double], [SETTING, {**SETTING, "dtype": "float64"}])
    with pytest.raises(RatfitError, match="dtype float64"):
        check_resumable([ROW, double], [SETTING, {**SETTING, "dtype": "float16"}])


# --- Checkpoints ---

KEY = {"name": "smith", "parameters": {"m": (0.01, 0.5)}, "samples": 10**10}
VALUES = st.recursive(
    st.integers() | st.floats() | st.text() | st.booleans() | st.none(),
    lambda parts: st.lists(parts, max_size=4) | st.dictionaries(st.text(), parts, max_size=4),
    max_leaves=12,
)


def bits(value):
    """A value as text that tells -0.0 from 0.0, 1 from 1.0, and has nan equal to nan."""
    return repr(value)


@settings(max_examples=60, deadline=None)
@given(state=st.dictionaries(st.text(), VALUES, max_size=5))
def test_a_state_comes_back_to_the_last_bit(state, tmp_path_factory):
    out = tmp_path_factory.getbasetemp() / "rows.jsonl"
    write_checkpoint(out, KEY, state)
    assert bits(read_checkpoint(out, KEY)) == bits(state)


@pytest.mark.parametrize("value", [math.inf, -math.inf, math.nan, -0.0, 5e-324, 0.1, 2**200, 1 / 3])
def test_numbers_that_other_formats_lose_come_back(value, tmp_path):
    write_checkpoint(tmp_path / "rows.jsonl", KEY, {"value": [value]})
    assert bits(read_checkpoint(tmp_path / "rows.jsonl", KEY)) == bits({"value": [value]})


def test_a_checkpoint_lies_beside_the_rows_and_goes_when_it_is_dropped(tmp_path):
    out = tmp_path / "rows.jsonl"
    assert read_checkpoint(out, KEY) is None
    drop_checkpoint(out)
    write_checkpoint(out, KEY, {"done": 1})
    write_checkpoint(str(out), KEY, {"done": 2})
    assert names(tmp_path) == ["rows.jsonl.part"]
    assert read_checkpoint(str(out), KEY) == {"done": 2}
    drop_checkpoint(str(out))
    assert names(tmp_path) == []


def test_the_checkpoint_of_another_measurement_is_none(tmp_path):
    out = tmp_path / "rows.jsonl"
    write_checkpoint(out, KEY, {"done": 1})
    assert read_checkpoint(out, {**KEY, "samples": 10**9}) is None
    assert read_checkpoint(out, KEY) == {"done": 1}


def test_a_checkpoint_torn_at_any_byte_is_none_and_can_be_written_again(tmp_path):
    out, place = tmp_path / "rows.jsonl", tmp_path / "rows.jsonl.part"
    write_checkpoint(out, KEY, {"done": 1})
    whole = place.read_bytes()
    for cut in range(len(whole)):
        place.write_bytes(whole[:cut])
        assert read_checkpoint(out, KEY) is None
    for cut in (0, 3, len(whole) // 2):
        place.write_bytes(whole[:cut])
        write_checkpoint(out, KEY, {"done": 2})
        assert read_checkpoint(out, KEY) == {"done": 2}


@pytest.mark.parametrize("content", [b"a note", b"{}", b"\xff", b"[" * 5000, b'{"key": 1, "state": 2}', b'{"key": {}}'])
def test_a_file_that_is_no_checkpoint_holds_no_state(content, tmp_path):
    (tmp_path / "rows.jsonl.part").write_bytes(content)
    assert read_checkpoint(tmp_path / "rows.jsonl", KEY) is None
    assert "is a file of something else" in no_checkpoint(tmp_path / "rows.jsonl") or content.startswith(b'{"key": ')


def test_what_is_no_state_is_told_and_a_state_is_not(tmp_path):
    out, place = tmp_path / "rows.jsonl", tmp_path / "rows.jsonl.part"
    assert no_checkpoint(out) == ""
    write_checkpoint(out, KEY, {"done": 1})
    assert no_checkpoint(out) == ""
    place.write_bytes(place.read_bytes()[:-3])
    assert "rows.jsonl.part is torn" in no_checkpoint(out)


def test_somebody_elses_file_in_the_place_of_a_checkpoint_stays(tmp_path):
    place = tmp_path / "rows.jsonl.part"
    place.write_text("a film, half downloaded")
    with pytest.raises(RatfitError, match=r"rows\.jsonl\.part is in the way.*another --out"):
        write_checkpoint(tmp_path / "rows.jsonl", KEY, {"done": 1})
    drop_checkpoint(tmp_path / "rows.jsonl")
    assert place.read_text() == "a film, half downloaded"


# --- Files of several machines ---


def test_files_are_merged_in_order_and_what_is_there_twice_comes_once(tmp_path):
    first, second = tmp_path / "a.jsonl", tmp_path / "b.jsonl"
    later = replace(RECORD, finished="2001-01-01T00:00:00+00:00")
    for path, records in (
        (first, [RECORD, replace(RECORD, seed=1)]),
        (second, [later, RECORD, replace(RECORD, seed=2)]),
    ):
        for record in records:
            append_row(path, record)
    merged = merge([first, second])
    assert [row["seed"] for row in merged] == [0, 1, 0, 2]
    assert [row["finished"] == later.finished for row in merged] == [False, False, True, False]
    assert merge([second, str(second)]) == read_rows(second)
    assert merge([]) == []


def test_files_of_different_protocols_are_not_merged(tmp_path):
    append_row(tmp_path / "new.jsonl", RECORD)
    append_row(tmp_path / "old.jsonl", replace(RECORD, protocol=1))
    with pytest.raises(RatfitError, match=rf"old\.jsonl holds rows of protocol 1, .* of {PROTOCOL}.*leave out"):
        merge([tmp_path / "new.jsonl", tmp_path / "old.jsonl"])


def test_a_file_that_is_missing_is_not_taken_for_an_empty_one(tmp_path):
    with pytest.raises(RatfitError, match=r"there is no file .*gone\.jsonl"):
        merge([tmp_path / "gone.jsonl"])
