"""Records: the contract of a row, and files that survive interruption."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ratfit import _record
from ratfit._parse import RatfitError
from ratfit._record import Record, append_row, machine, read_rows, same_measurement, write_text

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
LINE = (json.dumps(RECORD.to_json_object()) + "\n").encode()


def names(folder):
    return [path.name for path in folder.iterdir()]


def test_a_row_has_the_keys_of_the_contract_in_their_order():
    assert ", ".join(RECORD.to_json_object()) == (
        "name, parameters, samples, seed, sampling, dtype, backend, regime, flags, epsilon, nonfinite, worst, "
        "exact_s, fit_s, floor_s, gamma, gamma_low, gamma_high, note"
    )


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

    monkeypatch.setattr(_record.os, "fsync", interrupted)
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


@pytest.mark.parametrize("write", [lambda path: write_text(path, "text"), lambda path: append_row(path, RECORD)])
def test_places_that_cannot_be_written_are_refused(write, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(RatfitError, match=r"there is no folder .*missing"):
        write(tmp_path / "missing" / "page.md")
    with pytest.raises(RatfitError, match="is a folder"):
        write(tmp_path)
    with pytest.raises(RatfitError, match="Not a directory"):
        write(tmp_path / "file" / "page.md")
    with pytest.raises(RatfitError, match="name too long"):
        write(tmp_path / ("n" * 300))
    assert names(tmp_path) == ["file"]


def test_a_refusal_by_the_system_is_explained(tmp_path, monkeypatch):
    def refused(*_):
        raise PermissionError

    monkeypatch.setattr(_record.Path, "replace", refused)
    with pytest.raises(RatfitError, match="no permission"):
        write_text(tmp_path / "page.md", "text")
    assert names(tmp_path) == []


# --- Files of rows ---


def test_rows_come_back_as_they_were_written(tmp_path):
    path = tmp_path / "rows.jsonl"
    assert read_rows(path) == []
    append_row(path, RECORD)
    append_row(path, replace(RECORD, name="sine"))
    assert path.read_bytes().count(b"\n") == 2
    assert [row["name"] for row in read_rows(path)] == ["smith", "sine"]
    assert read_rows(path)[0] == RECORD.to_json_object()


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
     LINE + b"\n", LINE + b"a note", LINE.replace(b"3.0", b"NaN"), LINE.replace(b'"seed"', b'"sead"')],
)  # fmt: skip
def test_a_file_of_something_else_is_refused_and_stays(content, tmp_path):
    path = tmp_path / "notes.txt"
    path.write_bytes(content)
    with pytest.raises(RatfitError, match=r"notes\.txt"):
        read_rows(path)
    with pytest.raises(RatfitError, match=r"notes\.txt"):
        append_row(path, RECORD)
    assert path.read_bytes() == content


def test_a_long_file_is_mended_at_its_end_alone(tmp_path, monkeypatch):
    monkeypatch.setattr(_record, "_TAIL", 2 * len(LINE))
    path = tmp_path / "rows.jsonl"
    path.write_bytes(LINE * 10 + LINE[:30])
    append_row(path, RECORD)
    assert path.read_bytes() == LINE * 11


def test_a_bad_line_is_named_by_its_number(tmp_path):
    path = tmp_path / "rows.jsonl"
    path.write_bytes(LINE + b"a note\n" + LINE)
    with pytest.raises(RatfitError, match="line 2"):
        read_rows(path)


def test_the_same_measurement_is_recognised_and_any_other_is_not(tmp_path):
    append_row(tmp_path / "rows.jsonl", RECORD)
    (row,) = read_rows(tmp_path / "rows.jsonl")
    assert same_measurement(row, **SETTING)
    others = {"name": "sine", "parameters": {"m": 0.3}, "samples": 10, "seed": 1, "sampling": "cosine",
              "dtype": "float64", "backend": "jax-gpu"}  # fmt: skip
    for key, value in others.items():
        assert not same_measurement(row, **{**SETTING, key: value})
