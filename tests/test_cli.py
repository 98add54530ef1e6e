"""The command line: its contract, and that bad input is one line and exit status 2."""

import json
import math
import re

import pytest

from ratfit._parse import parse_expression
from ratfit._problem_file import read_problem
from ratfit._problem_text import to_tables
from ratfit.gallery import card, cards

SINE = ["sin(x)", "--on", "0", "pi/2", "--form", "2/1", "--value", "0", "--derivative", "0"]
SINE += ["--value", "pi/2", "--derivative", "pi/2"]
EASY = ["--on", "0", "1", "--form", "1/1", "--value", "0"]


def problem_file(tmp_path, **changes):
    """A good problem file, with some of its lines replaced; a line of None is left out."""
    lines = {
        "name": 'name = "test"',
        "target": 'target = "exp(x)"',
        "variable": 'variable = "x"',
        "domain": 'domain = ["0", "1"]',
        "form": "[form]\nnumerator = 1\ndenominator = 1",
        "condition": '[[condition]]\nkind = "value"\nat = "0"',
    }
    path = tmp_path / "problem.toml"
    path.write_text("\n".join(line for line in (lines | changes).values() if line is not None) + "\n")
    return str(path)


# (arguments, a fragment of the one line that must be printed)
BAD = [
    (["derive", "smoth"], "smith"),
    (["derive", "eq18"], "eq19"),
    (["derive"], "which problem?"),
    (["derive", "eq12", "eq19"], "one problem at a time"),
    (["derive", "eq12", "--vlaue", "0"], "--value"),
    (["derive", "eq12", "--value", "0"], "completes an expression"),
    (["derive", "eq12", "--route", "straight"], "known: auto"),
    (["derive", "eq21", "--route", "linear"], "not linear"),
    (["derive", "eq19", "--route", "power"], "does not serve"),
    (["derive", "eq12", "--timeout", "0"], "--timeout"),
    (["derive", "eq12", "--timeout", "nan"], "--timeout"),
    (["derive", "eq12", "--timeout"], "requires an argument"),
    (["derive", "eq12", "--format", "yaml"], "json"),
    (["derive", "eq12", "--degree", "3"], "takes no degree"),
    (["derive", "pade-exp", "--degree", "0"], "from 1 to"),
    (["derive", "pade-exp", "--degree", "1000"], "from 1 to"),
    (["derive", "pade-exp", "--degree", "two"], "valid integer"),
    (["derive", "eq15", "--set", "n=2"], "2 < n"),
    (["derive", "eq15", "--set", "n"], "n=1/3"),
    (["derive", "eq15", "--set", "=3"], "write it as n=1/3"),
    (["derive", "eq15", "--set", "k=3"], "not free"),
    (["derive", "eq15", "--set", "n=__import__('os')"], "--set n=__import__('os'): a number is needed"),
    (["derive", "eq15", "--set", "n=k**2/2"], "as in n=1/3 or n=sqrt(2)/2; k is none"),
    (["derive", "eq15", "--set", "n=sin"], "write sin(...)"),
    (["derive", "eq19", "--set", "m", "0.2"], "--set m: write it as m=1/3"),
    (["derive", "sin(x)", "--on", "0,pi/2", "--form", "2/1", "--value", "0"], "--on takes two words, the ends"),
    (["study", "sin(x)", "--on", "0,pi/2", "--plot", "a.svg"], "there is '0,pi/2' alone"),
    (["bench", "eq12", "--within", "0,1", "--peers"], "--within takes two words"),
    (["bench", "eq12", "--within", "1", "1"], "empty or reversed"),
    (["bench", "eq12", "--within", "1", "0"], "empty or reversed"),
    (["study"], "as in `ratfit study eq19`"),
    (["bench"], "as in `ratfit bench eq19`"),
    (["derive", "eq19", "--set", "m=oo"], "a number in [1/100, 1/2]"),
    (["bench", "eq19", "--set", "m=k**2/2"], "k is none"),
    (["bench", "eq19", "--set", "m=oo"], "--set m: oo is no finite number"),
    (["bench", "eq19", "--within", "0", "oo"], "--within: oo is no finite number"),
    (["bench", "--model", "cook-torrance", "--set", "alpha=oo"], "--set alpha: oo is no finite number"),
    (["check-model", "schlick", "--set", "r=k**2/2"], "as in r=1/3 or r=sqrt(2)/2; k is none"),
    (["check-model", "schlick", "--set", "r=oo"], "--set r: oo is no finite number"),
    (["check-model", "shlick"], "`ratfit check-model` lists the"),
    (["check-model", "ward", "--plot", ""], "something.svg"),
    (["claims", "smoothy"], "no claim 'smoothy'"),
    (["derive", "eq15", "--set", "n=foo"], "--set n=foo: a number is needed, as in n=1/3"),
    (["derive", "eq19", "--set", "M=1/3"], "did you mean 'm'?"),
    (["derive", "eq15", "--seed", "1.5"], "as 1000000 or 1e9 is"),
    (["bench", "eq15", "--set", "n=foo"], "(a parameter's value may also be random)"),
    (["bench", "eq15", "--set", "f=0.9"], "every reference says f itself"),
    (["bench", "eq15", "--set", "n=random"], "a parameter alone is drawn at random"),
    (["bench", "eq19", "--set", "m=rnd"], "did you mean 'random'?"),
    (["bench", "eq15", "--set", "q=1"], "no parameter (free: n; parameters: f); leave it out"),
    (["derive", "sin(x)", "--form", "2/1", "--value", "0"], "--on"),
    (["derive", "sin(x)", "--on", "1", "0", "--form", "1/1", "--value", "0"], "reversed"),
    (["derive", "sin(x)", "--on", "1", "1", "--form", "1/1", "--value", "1"], "empty"),
    (["derive", "sin(x)", "--on", "0", "1", "--form", "1/1"], "conditions are needed"),
    (["derive", "sin(x)", "--on", "0", "1", "--form", "1/x", "--value", "0"], "degrees"),
    (["derive", "sin(x)", "--on", "0", "1", "--form", "99/1", "--value", "0"], "degree"),
    (["derive", "sin(x)", "--on", "0", "1", "--value", "0"], "give the form"),
    (["derive", "sin(x)", "--on", "0", "1", "--form", "1/1", "--value", "2"], "outside the domain"),
    (["derive", "sin(x)", "--on", "0", "1", "--form", "1/1", "--value", "oo"], "finite"),
    (["derive", "sin(x)", "--on", "0", "1", "--form", "1/1", "--value", "0;equals=oo"], "finite"),
    (["derive", "sin(x)", "--on", "0", "1", "--form", "1/1", "--derivative", "0;order=-1"], "whole number"),
    (["derive", "sin(x)", "--on", "0", "1", "--form", "1/1", "--derivative", "0;order=1.5"], "whole number"),
    (["derive", "sin(x)", "--on", "0", "1", "--form", "1/1", "--derivative", "0;ordre=1"], "order="),
    (["derive", "sin(x)", "--on", "0", "1", "--form", "1/1", "--integral", "weight=0"], "weight of zero"),
    (["derive", "sin(k*x)", *EASY], "k"),
    (["derive", "sin(k*x)", "--variable", "x", *EASY], "k"),
    (["derive", "x.real", *EASY], "'.'"),
    (["derive", "__import__('os').system('true')", *EASY], "ratfit:"),
    (["derive", "9**9**9**9", *EASY], "ratfit:"),
    (["derive", "(lambda: 1)()", *EASY], "ratfit:"),
    (["derive", "x+" * 1500 + "x", *EASY], "2000"),
    (["derive", "(" * 300 + "x" + ")" * 300, *EASY], "nest"),
    (["derive", "-", *EASY], "ratfit:"),
    (["derive", "exp(x)", "--parameter", "m=1", *EASY], "range"),
    (["derive", "exp(m*x)", "--parameter", "m=1:0", *EASY], "low < high"),
    (["derive", "exp(x)", "--parameter", "sin=0:1", *EASY], "reserved"),
    (["derive", "exp(x)", "--let", "pi=3", *EASY], "reserved"),
    (["derive", "exp(x)", "--variable", "E", *EASY], "reserved"),
    (["derive", "exp(x)", "--parity", "strange", *EASY], "odd or even"),
    (["derive", "exp(x)", "--factor", "0", *EASY], "factor of zero"),
    (["derive", "no-such-file.toml"], "no such file"),
    (["derive", "/"], "directory"),
    (["derive", "eq19", "--out", "/nowhere/at/all.json"], "folder"),
    (["bench", "eq12", "--samples", "0"], "samples"),
    (["bench", "eq12", "--samples", "-5"], "samples"),
    (["bench", "eq12", "--samples", "many"], "1e9"),
    (["bench", "eq12", "--samples", "1.5"], "1e9"),
    (["bench", "eq12", "--samples", "1e-3"], "1e9"),
    (["bench", "eq12", "--samples", "1e99999999"], "1e9"),
    (["bench", "eq12", "--dtype", "float8"], "float32"),
    (["bench", "eq12", "--exhaustive", "--samples", "5"], "--samples"),
    (["bench", "eq12", "--exhaustive", "--sampling", "angle"], "--sampling"),
    (["bench", "eq12", "--exhaustive", "--dtype", "float64"], "float32"),
    (["bench", "eq19", "--exhaustive", "--set", "m=random"], "exhaustive"),
    (["bench", "eq12", "--sampling", "exhaustive"], "--exhaustive"),
    (["bench", "eq12", "--backend", "none", "--backend", "numpy"], "errors alone"),
    (["bench", "eq12", "--sampling", "hemisphere"], "[0, 1]"),
    (["bench", "eq19", "--set", "m=rondom"], "rondom"),
    (["bench", "eq12", "--against", "/no/such/rows.jsonl"], "no such file"),
    (["bench", "eq12", "--process", "1"], "--coordinator"),
    (["bench", "eq12", "--coordinator", "nowhere", "--processes", "2", "--process", "0"], "10.0.0.1"),
    (["bench", "eq12", "--coordinator", "localhost:1", "--processes", "2", "--process", "2"], "from 0 to 1"),
    (["report"], "which rows"),
    (["report", "/no/such/rows.jsonl"], "no file"),
    (["bench", "eq12", "--sampling", "unifrom"], "uniform"),
    (["bench", "eq12", "--backend", "abacus"], "jax-cpu"),
    (["bench", "eq19", "--set", "m=3"], "range"),
    (["bench", "eq12", "--resume"], "--out"),
    (["paper", "--samples", "0"], "samples"),
    (["paper", "--out", "/proc/nowhere"], "--out"),
    (["gallery", "smiht"], "smith"),
    (["gallery", "--format", "toml"], "name it"),
    (["init"], "Missing"),
    (["check", "nothing.toml"], "no such file"),
    (["polish"], "No such command"),
    (["--colour"], "No such option"),
]


@pytest.mark.parametrize("arguments, fragment", BAD, ids=lambda a: " ".join(a)[:60] if isinstance(a, list) else None)
def test_bad_input_is_one_line_and_exit_status_2(run, arguments, fragment):
    status, out, err = run(*arguments)
    assert (status, out) == (2, "")
    assert err.startswith("ratfit: ") and err.count("\n") == 1
    assert fragment.lower() in err.lower()
    assert len(err) < 500


BAD_FILES = [
    ({"domain": 'domian = ["0", "1"]'}, "domain"),
    ({"target": 'target = "exp(x"'}, "target"),
    ({"target": "target = exp(x)"}, "exp(x)"),  # malformed TOML: the line is shown
    ({"target": None}, "equals"),
    ({"variable": None}, "variable"),
    ({"form": None}, "form"),
    ({"form": "[form]\nnumerator = 1.5"}, "whole number"),
    ({"form": "[form]\nnumerator = -1"}, "whole number"),
    ({"form": '[form]\nnumerator = 1\nexpression = "a*x"'}, "one of"),
    ({"form": '[form]\nnumerator = 1\nunknowns = ["a"]'}, "does not go with"),
    ({"form": '[form]\nexpression = "a*x"'}, "a"),
    ({"form": '[form]\nexpression = "a*x"\nunknowns = ["a", "b"]'}, "does not occur"),
    ({"form": '[form]\nexpression = "x*x"\nunknowns = ["x"]'}, "rename"),
    ({"form": '[form]\npower = "1 - x**2"'}, "degree 1"),
    ({"form": '[form]\nnumerator = 1\nsupport = ["0"]'}, "two ends"),
    ({"condition": '[[condition]]\nkind = "valeu"\nat = "0"'}, "value"),
    ({"condition": '[[condition]]\nkind = "value"'}, "at"),
    ({"condition": '[[condition]]\nkind = "value"\nat = "0"\nwieght = "1"'}, "unknown key"),
    ({"condition": '[[condition]]\nkind = "derivative"\nat = "0"\norder = "2"'}, "whole number"),
    ({"condition": '[[condition]]\nkind = "derivative"\nat = "0"\norder = true'}, "whole number"),
    ({"condition": '[condition]\nkind = "value"\nat = "0"'}, "[[condition]]"),
    ({"condition": '[[condition]]\nkind = "value"\nat = ["0"]'}, "expression"),
    ({"domain": 'domain = ["1", "0"]'}, "reversed"),
    ({"domain": 'domain = "0 1"'}, "two ends"),
    ({"domain": 'domain = ["0", "k"]'}, "k"),
    ({"variable": 'variable = "sin"'}, "reserved"),
    ({"variable": 'variable = "x y"'}, "name"),
    ({"name": "name = 3"}, "quotes"),
    ({"form": '[parameters]\nx = ["0", "1"]\n[form]\nnumerator = 1'}, "two things"),
    ({"form": '[parameters]\nm = "0"\n[form]\nnumerator = 1'}, "range"),
    ({"condition": '[[condition]]\nkind = "value"\nat = "0"\n[[reference]]\nname = "r"\ntarget = "exp(q*x)"'}, "q"),
]


@pytest.mark.parametrize("changes, fragment", BAD_FILES)
def test_bad_problem_files(run, tmp_path, changes, fragment):
    status, out, err = run("derive", problem_file(tmp_path, **changes))
    assert (status, out) == (2, "")
    assert err.count("\n") == 1 and fragment.lower() in err.lower()


def test_a_good_problem_file(run, tmp_path):
    assert run("derive", problem_file(tmp_path))[0] == 0


def test_a_file_that_is_too_large(run, tmp_path):
    (tmp_path / "large.toml").write_text("#" * (1 << 20) + "\n")
    status, _, err = run("derive", str(tmp_path / "large.toml"))
    assert status == 2 and "1 MiB" in err


def test_a_file_that_is_no_text(run, tmp_path):
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    assert run("derive", str(tmp_path / "binary.toml"))[0] == 2


KEYS = ["name", "status", "target", "variable", "domain", "parameters", "form", "expression", "candidates", "free"]
KEYS += ["choice", "route", "conditions", "rejected", "cost"]

NO_ANSWER = {"azimuth-as-printed"}
"""Cards that end with an honest no, which is what they are there to show."""


SLOW = {"azimuth", "beckmann-general", "beckmann-quartic", "dielectric"}
"""Cards whose objects are like normal-density's or ggx-masking-ends' and take their seconds."""


@pytest.mark.parametrize("name", [c.name for c in cards() if c.name not in SLOW])
def test_json_keeps_the_contract(run, name):
    status, out, _ = run("derive", name, "--format", "json")
    found = json.loads(out)
    assert list(found) == KEYS
    if name in NO_ANSWER:
        assert (status, found["expression"], found["candidates"]) == (1, None, []) and found["rejected"][0]["reason"]
        return
    assert status == 0
    assert all(list(c) == ["kind", "at", "equals", "holds", "residual"] for c in found["conditions"])
    assert list(found["cost"]) == ["add", "mul", "div", "other"]
    names = {
        n: parse_expression("1", {})
        for n in [found["variable"], *found["parameters"], *(f["name"] for f in found["free"])]
    }
    for text in [found["expression"], *found["candidates"]]:
        parse_expression(text, names)  # text in ratfit's own grammar, of these names alone


def test_an_expression_with_options(run):
    status, out, _ = run("derive", *SINE, "--format", "json")
    assert status == 0
    assert json.loads(out)["expression"] == json.loads(run("derive", "eq12", "--format", "json")[1])["expression"]


def test_an_expression_may_begin_with_a_minus(run):
    status, out, _ = run(
        "derive",
        "-x**2",
        "--on",
        "-1",
        "1",
        "--form",
        "2",
        "--value",
        "-1",
        "--value",
        "0",
        "--value",
        "1",
        "--format",
        "json",
    )
    assert (status, json.loads(out)["expression"]) == (0, "-x**2")


def test_parameters_and_lets_on_the_command_line(run):
    arguments = [
        "h",
        "--let",
        "h=t**n",
        "--parameter",
        "n=1:1000",
        "--variable",
        "t",
        "--on",
        "0",
        "1",
        "--form",
        "1/1",
    ]
    status, out, _ = run("derive", *arguments, "--value", "0", "--value", "1", "--derivative", "1", "--format", "json")
    assert status == 0
    assert json.loads(out)["parameters"] == {"n": ["1", "1000"]}


def test_clashing_conditions_are_an_honest_no(run):
    arguments = [
        "derive",
        "exp(x)",
        "--on",
        "0",
        "1",
        "--form",
        "1",
        "--value",
        "0;equals=1",
        "--value",
        "0;equals=2",
        "--value",
        "1",
    ]
    status, out, _ = run(*arguments, "--format", "json")
    found = json.loads(out)
    assert (status, found["status"], found["expression"], list(found)) == (1, "inconsistent", None, KEYS)
    assert "value at 0" in run(*arguments)[1]


EXP = ["exp(x)", "--on", "0", "1", "--form", "1/1"]
OTHERWISE = "stated otherwise than the target has it, and kept as stated: value at 19/10 = 1; derivative at 19/10 = 0"
ONE_MORE = "b1 free: a further condition leaves one fit, such as --derivative 0; or choose: --set b1=..."
POLES = "poles are looked for once b1 has a value: --set b1=..."


@pytest.mark.parametrize(
    ("words", "advice"),
    [
        (["smith-1967"], [OTHERWISE]),
        (["eq19"], []),
        (["eq15"], []),
        ([*EXP, "--value", "0", "--value", "1"], [ONE_MORE, POLES]),
        ([*EXP, "--value", "0", "--set", "a1=1"], [POLES]),
        (
            [*EXP, "--equation", "y' - y;at=0", "--value", "1"],
            [
                "s0 is the derivative at 0, which no condition states",
                "poles are looked for once s0 has a value: --set s0=...",
            ],
        ),
    ],
    ids=lambda words: " ".join(words)[:40],
)
def test_advice_is_one_that_can_be_taken(run, words, advice):
    status, _, err = run("derive", *words)
    assert (status, err.splitlines()) == (0, [f"ratfit: {line}" for line in advice])


def test_a_family_is_a_no_only_when_unique_is_asked(run):
    assert run("derive", "eq15")[0] == 0
    status, out, _ = run("derive", "eq15", "--unique", "--format", "json")
    assert (status, json.loads(out)["expression"], json.loads(out)["status"]) == (1, None, "family")


def test_the_spurious_root_is_shown_with_its_reason(run):
    found = json.loads(run("derive", "eq12", "--route", "polynomial", "--format", "json")[1])
    assert found["route"] == "polynomial"
    assert any(r["expression"] == "x" and "cancels" in r["reason"] for r in found["rejected"])


def test_latex(run):
    assert run("derive", "eq19", "--format", "latex")[1].startswith("\\frac{")


def test_out_writes_whole_files(run, tmp_path):
    path = tmp_path / "fit.json"
    status, out, _ = run("derive", "eq19", "--format", "json", "--out", str(path))
    assert (status, out) == (0, "") and json.loads(path.read_text())["status"] == "unique"


def test_giving_up_in_time_says_what_is_known(run):
    status, out, _ = run("derive", "pade-exp", "--degree", "20", "--timeout", "0.05", "--format", "json")
    assert (status, json.loads(out)["status"]) == (1, "timeout")


def test_gallery_card_as_a_problem_file(run, tmp_path):
    for name in (c.name for c in cards()):
        path = tmp_path / f"{name}.toml"
        path.write_text(run("gallery", name, "--format", "toml")[1])
        assert run("check", str(path))[0] == 0
        assert to_tables(read_problem(path)) == to_tables(card(name).problem)
        if name in ("smith", "zenith", "tanh"):
            ours, theirs = (json.loads(run("derive", p, "--format", "json")[1]) for p in (str(path), name))
            assert ours["expression"] == theirs["expression"]


def test_a_parameter_can_be_set(run):
    status, out, _ = run("derive", "eq19", "--set", "m=0.3", "--format", "json")
    found = json.loads(out)
    assert status == 0 and found["parameters"] == {} and "m" not in found["expression"].replace("Max", "")
    assert run("derive", "eq19", "--set", "m=3")[0] == 2


def test_init_writes_a_file_that_works_and_overwrites_none(run, tmp_path):
    path = tmp_path / "my.toml"
    assert run("init", str(path))[0] == 0
    assert run("derive", str(path))[0] == 0
    text = path.read_text()
    assert run("init", str(path))[0] == 2 and path.read_text() == text


ROW = [
    "name",
    "parameters",
    "samples",
    "seed",
    "sampling",
    "dtype",
    "backend",
    "regime",
    "flags",
    "epsilon",
    "nonfinite",
]
ROW += ["worst", "exact_s", "fit_s", "floor_s", "gamma", "gamma_low", "gamma_high", "note"]


def test_bench_json_keeps_the_contract(run):
    status, out, _ = run("bench", "eq12", "--samples", "1000", "--format", "json", "--backend", "cost-model")
    found = json.loads(out)
    assert status == 0 and list(found) == ["machine", "rows"]
    (row,) = found["rows"]
    assert list(row) == ROW and list(row["worst"]) == ["definition", "at"]
    assert 0.01 < row["epsilon"]["peak_mean"] < 0.02
    assert (row["backend"], row["exact_s"], row["gamma"] > 1) == ("cost-model", None, True)


def test_bench_resumes_from_its_file(run, tmp_path):
    path = tmp_path / "rows.jsonl"
    arguments = ["bench", "eq19", "--samples", "1000", "--set", "m=0.2", "--out", str(path), "--format", "json"]
    arguments += ["--backend", "cost-model"]
    first = json.loads(run(*arguments)[1])["rows"]
    lines = path.read_text().splitlines()
    assert len(lines) == 3  # the target and two references
    path.write_text("\n".join(lines[:2]) + "\n" + lines[2][:40])  # interrupted while the third was written
    again = json.loads(run(*arguments, "--resume")[1])["rows"]
    assert again == first
    assert len(path.read_text().splitlines()) == 3
    for backend in ("cost-model", "none"):
        other = [*arguments[:-1], backend]
        assert run(*other, "--resume")[0] == 0
        status, _, told = run(*other, "--resume", "--seed", "1")
        assert status == 2 and "seed 0" in told and "another --out" in told


def test_bench_compares_with_older_rows(run, tmp_path):
    path = tmp_path / "rows.jsonl"
    arguments = ["bench", "eq12", "--samples", "1000", "--backend", "none"]
    assert run(*arguments, "--out", str(path))[0] == 0
    status, out, _ = run(*arguments, "--against", str(path))
    assert status == 0 and "0 worse" in out
    row = json.loads(path.read_text())
    row["epsilon"]["peak_mean"] /= 2
    path.write_text(json.dumps(row) + "\n")
    status, out, _ = run(*arguments, "--against", str(path))
    assert status == 1 and "peak_mean" in out and "+100 %" in out


@pytest.mark.thorough
def test_bench_says_where_a_target_is_infinite_and_keeps_its_remarks_with_the_errors(run):
    words = ["1/(2*x - 1)", "--on", "0", "1", "--form", "0/1", "--value", "0", "--value", "1"]
    status, out, _ = run("bench", *words, "--samples", "1000", "--backend", "none")
    assert status == 0 and "infinite at x = 0.5" in out
    words = ["Abs(x - 1/3)", "--on", "0", "1", "--form", "2/0", "--value", "0", "--value", "1", "--derivative", "0"]
    status, out, _ = run("bench", *words, "--samples", "100000", "--backend", "none")
    assert status == 0 and "all but vanishes" in out


def test_a_finished_row_leaves_no_state_and_nothing_to_compare_is_no_success(run, tmp_path):
    rows, others = tmp_path / "rows.jsonl", tmp_path / "others.jsonl"
    for name, path in (("eq12", rows), ("arctan", others)):
        assert run("bench", name, "--samples", "1000", "--backend", "none", "--out", str(path))[0] == 0
    assert not list(tmp_path.glob("*.part"))
    (tmp_path / "rows.jsonl.part").write_text("a film, half downloaded")
    _, _, told = run("bench", "eq12", "--samples", "1000", "--backend", "none", "--out", str(rows), "--resume")
    assert told.count("rows.jsonl.part is a file of something else") == 1
    status, out, _ = run("bench", "eq12", "--samples", "1000", "--backend", "none", "--against", str(others))
    assert status == 1 and "nothing could be compared" in out


@pytest.mark.thorough
def test_bench_draws_parameters_and_shows_peers(run):
    status, out, _ = run("bench", "eq19", "--samples", "1000", "--set", "m=random", "--backend", "none")
    assert status == 0 and "m=0.01..0.5" in out
    arguments = ["bench", "eq19", "--samples", "1000", "--set", "m=0.2", "--peers", "--backend", "cost-model"]
    status, out, _ = run(*arguments)
    assert status == 0 and all(f"smith~{peer}" in out for peer in ("table", "polynomial", "pade"))


def test_bench_measures_every_number_there_is(run):
    status, out, _ = run("bench", "eq12", "--exhaustive", "--dtype", "float16", "--backend", "none", "--format", "json")
    (row,) = json.loads(out)["rows"]
    assert status == 0 and row["samples"] == 2 + 15 * 1024 + math.floor((math.pi / 2 - 1) * 1024)  # two zeros; to pi/2
    assert "f(0) == 0 bit for bit" in row["note"]


def test_report_makes_pages_of_rows(run, tmp_path):
    rows, pages = tmp_path / "rows.jsonl", tmp_path / "pages"
    assert run("bench", "eq12", "--samples", "1000", "--backend", "cost-model", "--out", str(rows))[0] == 0
    status, out, _ = run("report", str(rows), "--out", str(pages))
    assert status == 0 and "report.html" in out
    assert {"report.html", "report.md"} <= {page.name for page in pages.iterdir()}


@pytest.mark.parametrize("command", ["derive", "bench", "report", "paper", "gallery", "init", "check"])
def test_help_has_examples(run, command):
    status, out, _ = run(command, "--help")
    assert status == 0 and re.search(rf"^ +ratfit {command}", out, re.MULTILINE)


def test_version(run):
    import ratfit

    assert run("--version")[1].strip().endswith(ratfit.__version__)
