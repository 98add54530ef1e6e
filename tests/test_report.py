"""The page of a record: nothing is lost, nothing is markup that should be text, nothing is asked of a network."""

import base64
import functools
import hashlib
import html
import json
import os
import re
import subprocess
import sys
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest
from report_rows import HOSTILE, MACHINE, PUBLISHED, curve, full_rows, row, smith_fit

import ratfit
from ratfit._parse import RatfitError
from ratfit.report import document as nouns
from ratfit.report.cost_figure import Point, cost_figure
from ratfit.report.document import Cell, Code, Column, Details, Document, Facts, Link, Paragraph, Section, Table
from ratfit.report.error_figure import MOST, ErrorCurve, error_figure
from ratfit.report.formula import formula
from ratfit.report.html import to_html
from ratfit.report.markdown import to_markdown
from ratfit.report.measured import (
    about_peer,
    epsilon_range,
    error_remarks,
    gamma,
    gamma_range,
    name_of,
    number,
    speed_remarks,
)
from ratfit.report.records import document_of, run_report, write_report
from ratfit.report.text import recorded
from ratfit.report.write import write_document

VOID = {"meta", "img", "br", "hr", "input", "link"}


class Page(HTMLParser):
    """The elements of a page in order, and its text; an element left open is an error."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.words, self.open = [], [], []
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, text):
        self.words.append((self.open[-1] if self.open else "", text))

    def texts(self, tag):
        return [text for inside, text in self.words if inside == tag]


@pytest.fixture(scope="module")
def full():
    return document_of(full_rows())


@pytest.fixture(scope="module")
def page(full):
    return to_html(full)


@pytest.mark.parametrize(
    ("row_name", "fit_name", "expected"),
    [
        ("smith", "smith", ("smith", "", "")),
        ("smith:walter-2007", "smith", ("smith", "walter-2007", "")),
        ("smith~aaa", "smith", ("smith", "", "aaa")),
        ("smith:walter-2007~pade", "smith", ("smith", "walter-2007", "pade")),
        ("a:b~c", "a:b", ("a:b", "", "c")),  # the problem's own name holds a colon
        ("a~b", "something else", ("a", "", "b")),
        ("smithy", "smith", ("smithy", "", "")),
    ],
)
def test_a_rows_name_says_problem_reference_and_peer(row_name, fit_name, expected):
    found = name_of(row(row_name, fit=smith_fit() | {"name": fit_name}))
    assert (found.problem, found.reference, found.peer) == expected
    if fit_name == "smith":
        without = name_of(row(row_name, fit=None))
        assert (without.problem, without.reference, without.peer) == expected


@pytest.mark.parametrize(
    ("value", "digits", "expected"),
    [
        (0.0136, 3, "0.0136"),
        (1 / 3, 3, "0.333"),
        (3180, 3, "3180"),
        (31842, 3, "31800"),
        (1.234e-5, 3, "1.23e-05"),
        (5.678e9, 3, "5.68e+09"),
        (-0.5, 3, "-0.5"),
        (0.0, 3, "0"),
        (None, 3, "–"),
    ],
)
def test_numbers_have_three_digits(value, digits, expected):
    assert number(value, digits) == expected


@pytest.mark.parametrize(
    ("value", "low", "high", "note", "expected"),
    [
        (12.34, 11.92, 12.81, "", "12.3 [11.9, 12.8]"),
        (31.8, 24, 45, "", "32 [24, 45]"),
        (318.4, 240, 451, "", "320 [240, 450]"),
        (3180, 2900, 3400, "", "3200 [2900, 3400]"),
        (2.5, 2.4, 2.6, "exact function at the copy floor: gamma is an upper bound", "≤ 2.50 [2.40, 2.60]"),
        (1.0021, 0.9981, 1.0041, "", "1.002 [0.998, 1.004]"),
        (1.00213, 1.00205, 1.00219, "", "1.002 [1.002, 1.002]"),
        (2.0, None, None, "", "2"),
        (2.0, 2.0, 2.0, "", "2 [2, 2]"),
        (None, None, None, "", "–"),
        (2.5, 2.4, 2.6, "fit at the copy floor: gamma is a lower bound", "≥ 2.50 [2.40, 2.60]"),
    ],
)
def test_gamma_has_the_digits_that_its_interval_leaves(value, low, high, note, expected):
    assert gamma(row(gamma=value) | {"gamma_low": low, "gamma_high": high, "note": note}) == expected


def test_ranges_go_from_the_least_to_the_greatest():
    rows = [row(epsilon=e, gamma=g) for e, g in ((0.02, 10.0), (0.001, 30.0), (0.3, 20.0))]
    assert epsilon_range(rows, "peak_mean") == "0.001 to 0.3"
    assert gamma_range(rows) == "10.0 to 30.0"
    assert (epsilon_range([], "peak_mean"), gamma_range([])) == ("not measured", "not measured")


def test_a_remark_stands_with_the_number_that_it_qualifies():
    floor, noise = "fit at the copy floor: gamma is a lower bound", "noisy: the load average was 5.3 on 2 cores"
    pole = "pole of the fit at v = 0.42: no mean or maximum has a meaning"
    noted = row(note="; ".join((pole, floor, noise)))
    assert (error_remarks(noted), speed_remarks(noted)) == ((pole,), (floor, noise))
    document = document_of([noted, row(note=noise, parameters={"m": 0.5})])
    table = next(_blocks(document, Table, "gamma"))
    column = [column.label for column in table.head].index("gamma")
    assert [r[column].remarks for r in table.rows] == [(floor, noise), (noise,)]
    assert table.notes == {floor: "a", noise: "b", pole: "c"}
    text = to_markdown(document, "report")
    assert "| ≥ 12.3 \\[11.9, 12.8\\] (a, b) |" in text and "| 12.3 \\[11.9, 12.8\\] (b) |" in text
    assert f"(a) {floor}  \n(b) {noise}  \n(c) {pole}" in text
    page = Page(to_html(document))
    assert {"a", "b", "c"} <= set(page.texts("sup"))


def test_what_a_peer_is_and_what_was_counted_explain_and_do_not_warn():
    about, counted = (
        "[2/2] from values at 1024 Chebyshev nodes, 4 add, 2 mul, 1 div",
        "exact function 80 additions, fit 12",
    )
    pole = "infinite inside the domain, at 0.3"
    peer = row("smith~aaa", backend="cost-model", note=f"{about}; {pole}; {counted}")
    assert (about_peer(peer), error_remarks(peer), speed_remarks(peer)) == (about, (pole,), ())
    table = list(_blocks(document_of([row(backend="cost-model"), peer]), Table, "gamma"))[1]
    assert {cell.aside for cell in table.rows[1]} == {"", about, counted}


def test_a_gamma_that_a_wrong_output_took_away_says_so_at_the_top():
    wrong = "the timed output of the fit is wrong at 5 of 100 samples"
    speed = document_of([row(gamma=None, note=wrong)]).sections[0].blocks[0].items[1]
    assert (speed.value, speed.remark) == ("not measured", wrong)


def _blocks(of, kind, label=""):
    for block in (*of.lead, *of.sections, *of.about) if isinstance(of, Document) else of.blocks:
        if isinstance(block, (Section, Details)):
            yield from _blocks(block, kind, label)
        elif isinstance(block, kind) and (not label or label in [column.label for column in block.head]):
            yield block


def test_the_page_goes_in_the_order_in_which_a_reader_asks(full, page):
    section = full.sections[0]
    assert section.blocks[0].kind == "headlines"
    assert [part.title for part in section.blocks[1:]] == [
        "Specification", "Error over the domain", "Accuracy and cost", "The fit", "Alternatives", "Published",
        "To reproduce",
    ]  # fmt: skip
    folded = [block for block in section.blocks[4].blocks if isinstance(block, Details)]
    assert [block.summary for block in folded] == ["How it was derived"]
    assert page.index(">smith</h2>") < page.index(">other</h2>") < page.index("What the numbers mean")


def test_every_row_and_every_definition_is_on_the_page(full, page):
    rows = full_rows()
    tables = list(_blocks(full.sections[0], Table, "gamma"))
    gammas = sorted(
        cell.key for r in tables[1].rows for c, cell in zip(tables[1].head, r, strict=True) if c.label == "gamma"
    )
    assert gammas == sorted(r["gamma"] for r in rows[:-1])
    for definition in rows[0]["epsilon"]:
        assert f"<code>{definition}</code>" in page
    keys = re.findall(r'data-key="([^"]*)"', page)
    assert {repr(r["epsilon"]["peak_mean"]) for r in rows} <= set(keys)


def test_the_headlines_are_of_the_fit_and_not_of_peers_references_or_other_backends(full):
    epsilon, speed, scalar, cost, kept = full.sections[0].blocks[0].items
    assert (epsilon.value, speed.value) == ("0.001 to 0.005", "≥ 3.00 to 15.0")
    assert speed.remark == "fit at the copy floor: gamma is a lower bound (1 of 5)"
    assert epsilon.remark == "pole of the fit at v = 0.42 (1 of 5)"
    assert (scalar.value, scalar.label) == ("20.0 to 100", "gamma on c-scalar, float32, over 5 settings")
    assert (cost.value, kept.value) == ("1 add, 1 mul, 1 div", "3 of 3")


def test_what_all_rows_share_is_said_once_above_the_table():
    table = next(_blocks(document_of([row(), row(parameters={"m": 0.5})]), Table, "gamma"))
    assert [column.label for column in table.head][:2] == ["m", "gamma"]
    assert table.caption == (
        "All rows: method fit, against the target, backend jax-cpu, dtype float32, sampling uniform, "
        "samples 1\u202f000\u202f000, seed 0."
    )


def test_parameters_drawn_at_random_show_their_range():
    document = document_of([row(parameters={"m": [0.01, 0.5]}), row()])
    table = next(_blocks(document, Table, "gamma"))
    assert [r[0] for r in table.rows] == [Cell("random in [0.01, 0.5]", 0.01), Cell("0.25", 0.25)]


def test_formulas_of_one_problem_are_kept_apart_and_their_peers_with_them():
    other = smith_fit() | {"expression": "v"}
    rows = [row(), row("smith~aaa", fit=None), row(fit=other), row("smith~aaa", fit=None, epsilon=0.5)]
    document = document_of(rows)
    assert [section.title for section in document.sections] == ["smith", "smith (2)"]
    assert all("Alternatives" in [part.title for part in s.blocks[1:]] for s in document.sections)
    assert "0.5" in to_markdown(Document("", (), document.sections[1:]), "x")


def test_a_problem_without_a_name_is_titled_by_its_target():
    targets = ("sin(x)", "sin(x)", "x" * 50)
    rows = [row("expression", fit=smith_fit() | {"name": "expression", "target": target, "expression": str(place)})
            for place, target in enumerate(targets)]  # fmt: skip
    assert [section.title for section in document_of(rows).sections] == ["sin(x)", "sin(x) (2)", "x" * 36 + " ..."]


def test_conditions_are_put_in_words():
    words = [condition["words"] for condition in recorded(ratfit.derive("sin-ode"))["conditions"]]
    assert any(text.startswith("equation ") and " to order " in text for text in words), words
    page = to_html(document_of([row(fit=recorded(ratfit.derive("sin-ode")))]))
    assert all(html.escape(text, quote=True).replace("&#x27;", "&#39;") in page for text in words)


def test_a_row_that_is_there_twice_counts_once():
    assert document_of([row(), row()]).sections == document_of([row()]).sections


POOREST = {
    "epsilon": {"peak_mean": None}, "worst": {}, "nonfinite": None, "exact_s": None, "fit_s": None, "floor_s": None,
    "gamma": None, "gamma_low": None, "gamma_high": None, "fit": None, "curve": None, "published": None,
    "parameters": {}, "command": "", "finished": "", "machine": {"versions": {}},
}  # fmt: skip
NO_ANSWER = {
    "status": "inconsistent", "expression": None, "candidates": [], "cost": None, "target": None,
    "rejected": [{"expression": None, "reason": "two conditions contradict each other"}],
}  # fmt: skip


@pytest.mark.parametrize(
    "changes",
    [
        POOREST,
        {"epsilon": {}, "samples": 0},
        {"gamma": 0.0, "gamma_low": 0.0, "gamma_high": 0.0},
        {"gamma": 1e300, "gamma_low": 1e-300, "gamma_high": 1e308, "epsilon": {"peak_mean": 1e305}},
        {"epsilon": {"peak_mean": 0.0}},
        {"epsilon": {"absolute_bias": -0.5}},
        {"curve": curve(fit=[1e300] * 16, bias=[1e300] * 16)},
        {"curve": curve(exact=[None] * 16, fit=[None] * 16, bias=[None] * 16, absolute_max=[None] * 16)},
        {"curve": curve(exact=[0.0] * 16, fit=[0.0] * 16, bias=[0.0] * 16, absolute_max=[0.0] * 16)},
        {"curve": curve(bins=1)},
        {"worst": {"definition": "ulp_max", "at": {"v": 0.5, "m": 0.1}}},
        {"counts": {"nan_fit": 3, "inf_exact": 0}, "nonfinite": 3},
        {"fit": smith_fit() | NO_ANSWER},
        {"fit": smith_fit() | {"expression": "not (of the grammar", "target": "x" * 5000}},
        {"published": PUBLISHED | {"equal": None, "epsilon": None, "gamma": None}},
    ],
)
@pytest.mark.filterwarnings("error")
def test_a_poor_or_extreme_row_still_makes_a_page(changes):
    document = document_of([row(**{"gamma": None} | changes)])
    Page(to_html(document))
    to_markdown(document, "report")


def test_an_honest_no_shows_its_reasons_unfolded():
    text = to_markdown(document_of([row(fit=smith_fit() | NO_ANSWER)]), "report")
    assert "No formula: no answer: the conditions clash." in text
    assert "two conditions contradict each other" in text and "How it was derived" not in text


def test_samples_that_are_not_finite_are_counted_by_kind():
    counted = row(nonfinite=3, counts={"nan_fit": 2, "inf_exact": 1})
    text = to_markdown(document_of([counted]), "report")
    assert "3 (2 nan in fit, 1 inf in exact)" in text and "**3** samples not finite" in text


@functools.cache
def hostile(text):
    """The page of rows that hold a text in every place that a user or a file can fill."""
    fit = smith_fit() | {
        "name": text, "variable": text, "status": text, "route": text, "target": text, "expression": text,
        "domain": [text, text], "parameters": {text: [text, text]}, "form": {text: [text], "numerator": 1},
        "candidates": [text, text], "free": [{"name": text, "range": [text, text]}], "choice": {text: text},
        "conditions": [{"kind": text, "at": text, "equals": text, "holds": None, "residual": None}],
        "rejected": [{"expression": text, "reason": text}], "cost": {text: 1},
    }  # fmt: skip
    given = {
        "fit": fit, "parameters": {text: 0.5}, "sampling": text, "dtype": text, "backend": text, "regime": text,
        "flags": text, "note": f"{text}; gamma {text}", "command": text, "finished": text,
        "machine": MACHINE | {text: text, "versions": {text: text}}, "counts": {text: 1}, "nonfinite": 1,
        "published": dict.fromkeys(("place", "expression", "source"), text) | {"equal": True, "epsilon": 1, "gamma": 1},
        "curve": curve(variable=text), "worst": {"definition": text, "at": text},
    }  # fmt: skip
    names = {text: 10.0, f"{text}~{text}": None, f"{text}:{text}": None}
    rows = [row(name, gamma=speed, epsilon={"peak_mean": 0.1, text: 0.5}, **given) for name, speed in names.items()]
    return document_of([rows[0], *(r | {"curve": None} for r in rows[1:]), row(gamma=None)])


@pytest.mark.parametrize("text", HOSTILE)
@pytest.mark.filterwarnings("error")
def test_no_text_of_a_user_becomes_markup(text, page):
    document = hostile(text)
    found = Page(to_html(document))
    assert {tag for tag, _ in found.elements} <= {tag for tag, _ in Page(page).elements} | {"li", "ul"}
    assert [tag for tag, _ in found.elements].count("script") == 1
    for _, attributes in found.elements:
        assert not [key for key in attributes if key.startswith("on")]
        assert all(attributes.get(key, "#").startswith("#") for key in ("href", "src", "action"))
    shown = nouns.printable(text).split("\n")[0].strip()
    assert shown in "".join(found.texts("h2"))


@pytest.mark.parametrize("text", HOSTILE)
def test_no_text_of_a_user_becomes_markdown(text):
    written = to_markdown(hostile(text), "report")
    tags = set(re.findall(r"</?([a-z]+)", _without_code(written)))
    assert tags <= {"details", "summary"}
    heads = [line for line in _without_code(written).split("\n") if line.startswith("#")]
    assert len(heads) == 1 + sum(1 for s in _sections(hostile(text)))
    for table in re.findall(r"(?:^\|.*\n)+", _without_fences(written), re.MULTILINE):
        assert len({len(re.findall(r"(?<!\\)\|", line)) for line in table.splitlines()}) == 1


def _sections(of):
    blocks = (*of.lead, *of.sections, *of.about) if isinstance(of, Document) else of.blocks
    for block in blocks:
        if isinstance(block, Section):
            yield block
        if isinstance(block, (Section, Details)):
            yield from _sections(block)


def _without_fences(text):
    return re.sub(r"^(`{3,})\n.*?\n\1$", "", text, flags=re.MULTILINE | re.DOTALL)


def _without_code(text):
    """Markdown without what stands in fences and between backticks, by CommonMark's rule of equal runs."""
    return re.sub(r"(?<![`\\])(`+)(?!`)(.*?)(?<!`)\1(?!`)", "", _without_fences(text))


def test_the_page_asks_nothing_of_a_network(page):
    assert "http:" not in page and "https:" not in page and "@import" not in page and "src=" not in page
    assert all(reference.startswith("#") for reference in re.findall(r"url\(([^)]*)\)", page))
    tags = {tag for tag, _ in Page(page).elements}
    assert not tags & {"link", "img", "iframe", "object", "embed", "base", "form", "audio", "video", "image"}


def test_the_page_lets_only_its_own_script_run(page):
    script = re.search(r"<script>(.*?)</script>", page, re.DOTALL)[1]
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    policy = html.unescape(re.search(r'Content-Security-Policy" content="([^"]*)"', page)[1])
    assert f"script-src 'sha256-{digest}'" in policy and policy.startswith("default-src 'none'")


def test_names_within_the_page_are_unique_and_every_reference_is_met(page):
    elements = Page(page).elements
    names = [attributes["id"] for _, attributes in elements if "id" in attributes]
    assert len(names) == len(set(names))
    referred = {a["href"][1:] for _, a in elements if "href" in a} | set(re.findall(r"url\(#([^)]*)\)", page))
    assert referred <= set(names)


AGAIN = """
import sys
from report_rows import curve, row
from ratfit.report.records import write_report
write_report([row(curve=curve())], sys.argv[1])
"""


def test_equal_rows_make_equal_bytes(tmp_path):
    """In another process too, where sets have another order."""
    here, there = tmp_path / "here", tmp_path / "there"
    for folder in (here, there):
        folder.mkdir()
    write_report([row(curve=curve())], here)
    paths = os.pathsep.join([str(Path(__file__).parent), *filter(None, sys.path)])
    environment = os.environ | {"PYTHONHASHSEED": "12345", "PYTHONPATH": paths}
    subprocess.run([sys.executable, "-c", AGAIN, str(there)], check=True, env=environment, cwd=tmp_path)
    assert {p.name: p.read_bytes() for p in here.iterdir()} == {p.name: p.read_bytes() for p in there.iterdir()}


def test_a_report_is_two_pages_and_figures_that_stand_alone(full, tmp_path):
    paths = write_document(full, tmp_path, "smith")
    assert [path.name for path in paths[:2]] == ["smith.html", "smith.md"]
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(path.name for path in paths)
    named = re.findall(r"!\[.*\]\((.*)\)", paths[1].read_text())
    assert sorted(named) == sorted(path.name for path in paths[2:]) and named
    for path in paths[2:]:
        root = ElementTree.parse(path).getroot()
        assert root.tag == "{http://www.w3.org/2000/svg}svg"
        assert "prefers-color-scheme" in path.read_text()


def test_figures_have_no_colour_of_their_own(full):
    """What is painted is a variable of the page, so that it can be read on light and on dark."""
    for figure in full.figures:
        painted = re.findall(r"(?:fill|stroke): ([^;\"]*)", figure.svg)
        assert painted and all(p == "none" or p.startswith("var(--") for p in painted), set(painted)
        assert not re.search(r"\s(?:fill|stroke)=", figure.svg)


def test_many_settings_are_thinned_out_and_the_caption_says_so():
    curves = [ErrorCurve(f"m = {k}", **curve()) for k in range(12)]
    figure = error_figure("f", curves, "the target")
    assert f"{MOST} of 12 settings are drawn." in figure.caption
    assert [f"m = {k}" for k in range(12) if f">m = {k}<" in figure.svg] == [
        "m = 0",
        "m = 3",
        "m = 6",
        "m = 8",
        "m = 11",
    ]


def test_a_fit_that_leaves_the_picture_is_told_of():
    far = [1e6 if k == 3 else 0.5 for k in range(16)]
    caption = error_figure("f", [ErrorCurve("", **curve(fit=far))], "the target").caption
    assert "The fit leaves the picture: a bin of it is 1e+06." in caption
    assert "leaves" not in error_figure("f", [ErrorCurve("", **curve())], "the target").caption


def test_an_exact_fit_is_drawn_hollow_and_what_has_no_place_is_counted():
    points = [
        Point("fit", "", 2.0, 1.9, 2.1, 0.0),
        Point("aaa", "", 2.0, None, None, 0.1),
        Point("b", "", 0.0, 0, 0, 1.0),
    ]
    figure = cost_figure("c", points, "peak_mean", "jax-cpu")
    assert "Hollow marks have an eps of 0." in figure.caption
    assert "1 of 3 rows have no place on these axes." in figure.caption
    assert cost_figure("c", points[2:], "peak_mean", "jax-cpu") is None


def test_a_point_tells_its_row_when_pointed_at():
    figure = cost_figure("c", [Point("fit", "m = 1 <b>", 2.0, None, None, 0.1)], "peak_mean", "jax-cpu")
    assert "<title>m = 1 &lt;b&gt;</title>" in figure.svg


def test_formulas_are_drawn_where_they_can_be_read():
    drawn = formula("sqrt(m**2)*v/2", smith_fit())
    assert "<mfrac>" in drawn.mathml and "|" not in drawn.mathml  # m is positive
    assert formula("v)(", smith_fit()).mathml is None
    assert formula("+".join(["v"] * 400), smith_fit()).mathml is None


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("fit", {"name": "smith"}),
        ("fit", smith_fit() | {"conditions": [{}]}),
        ("fit", smith_fit() | {"free": [{"name": "n", "range": ["0"]}]}),
        ("curve", {"variable": "v"}),
        ("curve", curve(edges=[0.0, 1.0])),
        ("curve", curve(edges=[0.0] * 17)),
        ("curve", curve(edges=[])),
        ("published", {"place": "Eq. 1"}),
    ],
)
def test_rows_that_no_ratfit_has_written_are_refused(key, value):
    with pytest.raises(RatfitError, match="measure it again"):
        document_of([row(**{key: value})])


def _file(path, rows):
    path.write_text("".join(json.dumps(r) + "\n" for r in rows))
    return str(path)


def test_the_command_reads_files_and_says_what_it_wrote(tmp_path, capsys):
    paths = [_file(tmp_path / "a.jsonl", [row()]), _file(tmp_path / "b.jsonl", [row(), row(gamma=50.0)])]
    assert run_report(paths, str(tmp_path / "out")) == 0
    assert capsys.readouterr().out == f"wrote {tmp_path}/out/report.html and {tmp_path}/out/report.md\n"
    assert "2 measured rows" in (tmp_path / "out" / "report.md").read_text()


def test_bad_files_and_folders_have_a_remedy(tmp_path):
    good = _file(tmp_path / "a.jsonl", [row()])
    empty, file = tmp_path / "empty.jsonl", tmp_path / "file"
    empty.touch()
    file.touch()
    for paths, out, remedy in (
        ([str(tmp_path / "none.jsonl")], tmp_path, "bench --out"),
        ([str(empty)], tmp_path, "bench --out"),
        ([good], file, "--out"),
        ([good], tmp_path / "a" / "b", "--out"),
    ):
        with pytest.raises(RatfitError, match=remedy):
            run_report(paths, str(out))


def test_a_table_has_as_many_cells_as_heads():
    with pytest.raises(ValueError, match="2 cells under a head of 1"):
        Table((Column("a"),), ((Cell("1"), Cell("2")),))


def test_other_documents_are_made_of_the_same_nouns(tmp_path):
    table = Table(
        (Column("a"), Column("b", numeric=True)), ((Cell(("x ", Code("y"))), Cell("2", 2.0, ("remark",), "aside")),)
    )
    own = Document(
        "1. A title",
        (Paragraph(("See ", Link("there", "Part"), ".")),),
        (Section("Part", (table, Facts((("word", "meaning"),)), nouns.Items(("1. one", Code("`"))))),),
    )
    assert [path.name for path in write_document(own, tmp_path, "paper")] == ["paper.html", "paper.md"]
    assert (tmp_path / "paper.md").read_text() == (
        "# 1\\. A title\n\nSee there.\n\n## Part\n\n"
        "| a | b |\n| --- | ---: |\n| x `y` | 2 (a) (aside) |\n\n(a) remark\n\n"
        "- word: meaning\n\n- 1\\. one\n- `` ` ``\n"
    )
    assert '<a href="#section-1">there</a>' in (tmp_path / "paper.html").read_text()
    assert replace(own, title="other") != own
