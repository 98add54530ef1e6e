"""Rows measured one by one: which are measured, which are taken from a file, and what other processes have of them."""

import pytest
from test_record import RECORD

from ratfit._bench import Job, Measuring
from ratfit._derive import derive
from ratfit._record import read_rows
from ratfit.report import rows as report_rows
from ratfit.report.rows import Book, Measurement, plan, rows

HOW = Measuring(1000, 0, "uniform", "float32")


@pytest.fixture(scope="module")
def sine():
    return Job(derive("eq12"), {}, None)


def measurement(job, *backends):
    return Measurement(job, HOW, backends, "1/1 sin", {"command": "by hand"})


def test_a_process_that_is_not_the_first_has_the_errors_of_a_measurement_with_many_backends(sine, monkeypatch):
    monkeypatch.setattr(report_rows, "is_first", lambda: False)
    monkeypatch.setattr(report_rows, "measure", lambda *args, **named: iter([RECORD]))
    (planned,) = plan([measurement(sine, "numpy", "cost-model", "c-fast")], Book())
    assert planned.missing == ["numpy", "cost-model", "c-fast"]
    assert list(rows(planned, Book())) == [RECORD.to_line()]


def test_what_a_file_holds_is_not_measured_again(sine, tmp_path):
    out = tmp_path / "rows.jsonl"
    (first,) = plan([measurement(sine, "cost-model")], Book(out))
    (made,) = rows(first, Book(out))
    assert made["command"] == "by hand" and read_rows(out) == [made]
    (again,) = plan([measurement(sine, "cost-model", "")], Book(out, resume=True))
    assert again.missing == [""] and again.known[0] == made
    assert [row["backend"] for row in rows(again, Book(out, resume=True))] == ["cost-model", ""]
    assert len(read_rows(out)) == 2


def test_a_measurement_goes_on_from_its_state(sine, tmp_path, monkeypatch):
    out, states = tmp_path / "rows.jsonl", []

    def measure(job, how, backends, *, about, watch, say):
        states.append(watch.state)
        if watch.state is None:
            watch.save({"chunks": 3})
            raise KeyboardInterrupt
        return iter([RECORD])

    monkeypatch.setattr(report_rows, "measure", measure)
    (planned,) = plan([measurement(sine)], Book(out))
    with pytest.raises(KeyboardInterrupt):
        list(rows(planned, Book(out)))
    assert list(rows(planned, Book(out, resume=True))) == [RECORD.to_line()]
    assert states == [None, {"chunks": 3}] and [path.name for path in tmp_path.iterdir()] == ["rows.jsonl"]
