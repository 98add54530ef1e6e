"""Where commands write: what is said of a place that takes no file, before any work is done."""

import sys
import tempfile

import pytest

from ratfit._parse import RatfitError
from ratfit.cli.place import check_place

WRITERS = [
    ("derive", "eq19", "--out"),
    ("derive", "eq19", "--plot"),
    ("study", "eq19", "--out"),
    ("study", "eq19", "--plot"),
    ("bench", "eq12", "--out"),
    ("check-model", "lambert", "--out"),
    ("check-model", "lambert", "--plot"),
    ("claims", "S-28-A", "--out"),
    ("init",),
]
"""Commands with the option that names a file, or the file alone."""


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.svg").mkdir()
    (tmp_path / "file").write_text("")
    (tmp_path / "link.svg").symlink_to(tmp_path / "gone" / "a.svg")
    (tmp_path / "circle.svg").symlink_to(tmp_path / "circle.svg")
    return tmp_path


@pytest.mark.parametrize("words", WRITERS, ids=" ".join)
@pytest.mark.parametrize(
    ("file", "fragment"),
    [
        ("folder.svg", "that is a folder; name a file in it"),
        ("missing/a.svg", "there is no folder missing; make it first"),
        ("file/a.svg", "file is a file and no folder"),
        ("file/b/a.svg", "file is a file and no folder"),
        ("a" * 300 + ".svg", "too long"),
        ("link.svg", "there is no folder"),
        ("circle.svg", "Too many levels of symbolic links"),
    ],
    ids=lambda text: text[:12],
)
def test_a_place_that_takes_no_file_is_told_truly(run, place, words, file, fragment):
    before = sorted(place.rglob("*"))
    status, out, err = run(*words, file)
    assert (status, out, err.count("\n")) == (2, "", 1) and fragment in err
    assert sorted(place.rglob("*")) == before


@pytest.mark.parametrize("words", WRITERS, ids=" ".join)
def test_a_name_that_is_none(run, place, words):
    status, out, err = run(*words, "")
    assert (status, out, err.count("\n")) == (2, "", 1) and "name" in err
    assert run(*words, "a/")[0] == 2


@pytest.mark.skipif(sys.platform != "linux", reason="/proc")
def test_a_folder_that_is_there_is_not_said_to_be_missing(run):
    status, _, err = run("derive", "eq19", "--out", "/proc/a.json")
    assert status == 2 and "the folder /proc takes no files" in err and "no folder" not in err


@pytest.mark.parametrize(
    ("refusal", "fragment"),
    [(PermissionError(13, "Permission denied"), "no permission to write in the folder"),
     (OSError(30, "Read-only file system"), "Read-only file system"),
     (OSError(28, "No space left on device"), "No space left on device")],
    ids=str,
)  # fmt: skip
def test_what_the_system_refuses_is_said(place, monkeypatch, refusal, fragment):
    def refuse(**_):
        raise refusal

    monkeypatch.setattr(tempfile, "TemporaryFile", refuse)
    with pytest.raises(RatfitError, match=fragment) as told:
        check_place("--out", "new.json")
    assert str(told.value).startswith("--out new.json: ") and "another place" in str(told.value)


def test_a_folder_that_was_removed_under_the_command(tmp_path, monkeypatch):
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    (tmp_path / "here").rmdir()
    with pytest.raises(RatfitError, match="takes no files"):
        check_place("--out", "new.json")


def test_places_that_take_a_file(place):
    (place / "there.svg").symlink_to(place / "new.svg")
    for file in ("new.json", str(place / "new.json"), "file", "folder.svg/a.svg", "/dev/null", "there.svg", None):
        check_place("--out", file)
    assert not (place / "new.json").exists()
