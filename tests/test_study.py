"""study(): facts known from mathematics are found, none is claimed that is false, and what it prints derives."""

import json
import math
import shlex
from functools import cache

import mpmath
import pytest
import sympy as sp

import ratfit
from ratfit._condition import Integral, Limit
from ratfit._inline import Words, target_of_words
from ratfit._study import Study, study
from ratfit._study.clock import Clock
from ratfit._study.curve import Curve, differentiated
from ratfit._study.ends import end_facts
from ratfit.cli import main
from ratfit.gallery import find_problem
from ratfit.report.study import command_of, condition_option, decimal_text, study_json, study_text, study_toml

X = sp.Symbol("x", real=True)


@cache
def studied(expression, low, high, *parameters):
    return study(target_of_words(expression, Words(on=(low, high), parameter=parameters)), timeout=20)


# (expression, low, high, parameters), facts that must be there word for word
KNOWN = {
    ("sin(x)", "0", "pi/2"): [
        *("f(0) = 0", "f'(0) = 1", "f''(0) = 0", "f(pi/2) = 1", "f'(pi/2) = 0", "f''(pi/2) = -1"),
        *("odd: f(-x) = -f(x)", "increasing on [0, pi/2]", "concave on [0, pi/2]", "y + y'' = 0 on the domain"),
        *("integral of f = 1", "integral of f*x = 1", "integral of f*x**2 = -2 + pi"),
    ],
    ("tanh(x)", "0", "oo"): [
        *("f -> 1 as x -> oo", "f'(0) = 1", "f - 1 vanishes faster than any power as x -> oo"),
        *("y**2 + y' - 1 = 0 on the domain", "integral of f diverges: it behaves like 1 at oo"),
    ],
    ("atan(x)", "0", "1"): ["f -> pi/2 as x -> oo, beyond the domain", "odd: f(-x) = -f(x)"],
    ("exp(-x)", "0", "oo"): [
        *("f(0) = 1", "f -> 0 as x -> oo", "decreasing on [0, oo]", "convex on [0, oo]", "y + y' = 0 on the domain"),
        *("integral of f = 1", "integral of f*x = 1", "integral of f*x**2 = 2"),
    ],
    ("1/(1+x**2)", "-oo", "oo"): [
        *("maximum f(0) = 1", "f'(0) = 0", "inflection f(sqrt(3)/3) = 3/4", "f''(-sqrt(3)/3) = 0"),
        *("even: f(-x) = f(x)", "f*x**2 -> 1 as x -> -oo", "integral of f = pi"),
    ],
    ("x/(1+x)", "0", "oo"): ["f -> 1 as x -> oo", "(f - 1)*x -> -1 as x -> oo", "concave on [0, oo]"],
    ("x+1/(1+x)", "0", "oo"): ["f/x -> 1 as x -> oo", "f - x -> 0 as x -> oo: the asymptote is x"],
    ("sqrt(x)", "0", "1"): ["f(0) = 0", "f'(0+) = oo, f - f(0) behaves like sqrt(x)", "f(0) = 0, of order 1/2"],
    ("1/x", "0", "1"): ["pole of order 1 at 0: f*x -> 1", "integral of f*x = 1", "x*y' + y = 0 on the domain"],
    ("tan(x)", "0", "3"): ["pole of order 1 at pi/2: f*(x - pi/2) -> -1"],
    ("1/(x-1/2)**2", "0", "1"): [
        *("pole of order 2 at 1/2: f*(x - 1/2)**2 -> 1", "symmetric about x = 1/2: f(1 - x) = f(x)"),
        "convex on [0, 0.5], convex on [0.5, 1]",
    ],
    ("x**3*(1-x)**2", "-1", "2"): ["f(0) = 0, of order 3", "f(1) = 0, of order 2", "f'(1) = 0, of order 2"],
    ("Abs(x-1/3)", "0", "1"): ["minimum f(1/3) = 0 in a kink", "f'(0) = -1", "integral of f = 5/18"],
    ("x**2*(3-2*x)", "0", "1"): ["symmetric about the point (1/2, 1/2): f(1 - x) = 1 - f(x)"],
    ("7/2", "0", "1"): ["constant on [0, 1]", "f(0) = 7/2"],
    ("cos(x)-x", "0", "2"): ["f(0.739085133215) = 0", "inflection f(pi/2) = -pi/2"],
    ("x**5-x-1", "0", "2"): ["f(1.16730397826) = 0", "minimum f(5**(3/4)/5) = -1 - 4*5**(3/4)/25"],
    ("log(x)", "1/2", "oo"): ["f(1) = 0", "f -> oo as x -> oo, slower than any power"],
    ("exp(-k*x)", "0", "oo", "k=1/2:3"): ["f'(0) = -k", "integral of f = 1/k", "k*y + y' = 0 on the domain"],
    ("sin(w*x)", "0", "pi/w", "w=1:3"): ["maximum f(pi/(2*w)) = 1", "integral of f = 2/w", "f'(pi/w) = -w"],
    ("t**n", "0", "1", "n=1:1000"): ["f(0) = 0", "f(1) = 1", "f'(1) = n", "integral of f = 1/(n + 1)"],
}


def but_long(cases):
    """The cases, those that take seconds left to CI."""
    return [pytest.param(c, marks=pytest.mark.thorough) if c[0] in ("tan(x)", "cos(x)-x") else c for c in cases]


@pytest.mark.parametrize("case", but_long(KNOWN), ids=lambda c: f"{c[0]} on [{c[1]}, {c[2]}]")
def test_facts_known_from_mathematics(case):
    texts = [fact.text for fact in studied(*case).facts]
    for known in KNOWN[case]:
        assert known in texts, "\n".join(texts)


@pytest.mark.parametrize("case", [c for c in KNOWN if len(c) == 3], ids=lambda c: f"{c[0]} on [{c[1]}, {c[2]}]")
def test_every_condition_holds_for_the_target_by_other_numbers(case):
    """Limits and derivatives from inside, at 30 digits, with mpmath's own differentiation."""
    found = studied(*case)
    x, low, high = found.target.variable, *found.target.domain
    function = sp.lambdify(x, found.target.expression, "mpmath")
    for fact in found.facts:
        condition = fact.condition
        if condition is None or fact.value is None or isinstance(condition, (Integral, Limit)):
            continue
        side = 1 if condition.at == low else -1 if condition.at == high else 0 if "kink" not in fact.text else 1
        with mpmath.workdps(60):
            at, value = (mpmath.mpf(str(sp.N(e, 60))) for e in (condition.at, fact.value))
            number = mpmath.diff(function, at, condition.order, direction=side) if condition.order else function(at)
            assert mpmath.almosteq(number, value, 1e-15, 1e-15), fact


@pytest.mark.parametrize("case", KNOWN, ids=lambda c: f"{c[0]} on [{c[1]}, {c[2]}]")
def test_text_json_and_toml_are_whole(case):
    found = studied(*case)
    text, data, toml = study_text(found), json.loads(study_json(found)), study_toml(found)
    assert data["target"] in text and data["target"] in toml
    assert list(data) == ["target", "variable", "domain", "parameters", "facts", "notes", "derive"]
    assert all(list(fact) == ["kind", "text", "found", "option", "toml"] for fact in data["facts"])
    assert len(data["facts"]) == len(found.facts) > 3


DERIVED = [
    *(("sin(x)", "0", "pi/2"), ("tanh(x)", "0", "oo"), ("1/(x-1/2)**2", "0", "1"), ("x+1/(1+x)", "0", "oo")),
    *(("1/(1+x**2)", "-oo", "oo"), ("sin(w*x)", "0", "pi/w", "w=1:3"), ("cos(x)-x", "0", "2")),
]


@pytest.mark.parametrize("case", DERIVED, ids=lambda c: c[0])
def test_the_suggested_command_and_the_file_derive(case, tmp_path, capsys):
    found = studied(*case)
    words = shlex.split(command_of(found))
    assert words[:2] == ["ratfit", "derive"]
    assert status(words[1:]) == 0
    file = tmp_path / "study.toml"
    file.write_text(study_toml(found))
    assert status(["check", str(file)]) == 0
    assert status(["derive", str(file)]) == 0
    capsys.readouterr()


@pytest.mark.parametrize("case", but_long([c for c in KNOWN if c[0] not in ("7/2",)][::3]), ids=lambda c: c[0])
def test_every_option_is_read_back_as_the_same_condition(case):
    found = studied(*case)
    for fact in found.facts:
        if fact.condition is not None:
            option, text = shlex.split(condition_option(fact.condition))
            words = Words(
                on=case[1:3],
                parameter=case[3:],
                variable=str(found.target.variable),
                form="1/1",
                **{option.removeprefix("--"): (text,)},
            )
            again = ratfit._inline.problem_of_words(case[0], words).conditions[0]
            assert type(again) is type(fact.condition)
            assert str(again) == str(fact.condition)


def test_smith_is_known_at_its_ends():
    curve = Curve(find_problem("eq19").target)
    texts = {fact.text for fact in end_facts(curve, Clock(15.0))}
    assert {"f(0) = 0", "f(1) = 1", "f'(0) = sqrt(2)*sqrt(pi)/(2*m)"} <= texts


def test_what_only_numbers_tell_of_parameters_is_labelled_and_no_condition():
    found = studied("x*exp(-x)-m*x**3-m", "0", "2", "m=1/10:1/5")
    numeric = [fact for fact in found.of("zero", "maximum", "inflection") if fact.found.startswith("numeric")]
    assert numeric
    for fact in numeric:
        assert fact.condition is None and fact.text.endswith(" at m = 3/20"), fact


@pytest.mark.parametrize(
    ("expression", "low", "high", "never"),
    [
        ("Max(0, x-1/2)", "0", "1", ("parity", "odd")),  # even on [-1/2, 1/2] and no farther
        ("1/(x-1/2)", "0", "1", ("text", "decreasing on [0, 1]")),
        ("Abs(x-1/3)+3*x", "0", "1", ("text", "straight on [0, 1]")),
        ("log(x)", "1/2", "oo", ("kind", "integral of f = ")),
        ("sin(x)", "0", "oo", ("text", "f -> 0 as x -> oo")),
        ("t**n", "0", "1", ("text", "f'(0) = 0")),
    ],
)
def test_what_is_not_true_is_not_claimed(expression, low, high, never):
    parameters = ("n=1:1000",) if "n" in expression and "sin" not in expression else ()
    found = studied(expression, low, high, *parameters)
    texts = [fact.text for fact in found.facts]
    kind, text = never
    if kind == "parity":
        assert not found.of("parity")
    elif kind == "kind":
        assert not any(t.startswith(text) for t in texts)
    else:
        assert not any(t == text and f.condition for t, f in zip(texts, found.facts, strict=True))
        assert text not in texts


def test_rounding_far_out_is_no_change_of_sign():
    """The slope is (1 + 2*x**2)*exp(-x**2) over a square: positive, but a difference that is noise from x = 11 on."""
    found = studied("x/(x+exp(-x**2))", "0", "oo")
    assert [fact.text for fact in found.of("monotonicity")] == ["increasing on [0, oo]"]
    assert not any("again and again" in fact.text for fact in found.facts)
    assert not any(fact.text.startswith("inflection f(1") for fact in found.facts)


def test_time_is_kept():
    import time

    start = time.monotonic()
    found = study("beckmann", timeout=1.0)
    assert time.monotonic() - start < 3.0
    assert isinstance(found, Study)


def test_derivatives_leave_no_delta():
    expression = sp.sign(X - 1) * X + sp.Abs(X) + sp.Max(0, X) * sp.floor(X)
    assert not differentiated(expression, X, 2).has(sp.DiracDelta, sp.Derivative)


def test_a_decimal_is_written_as_one():
    assert decimal_text(sp.Rational("0.000001234567890123456789")) == "0.000001234567890123456789"
    assert decimal_text(sp.Rational(-3, 2)) == "-3/2"
    assert decimal_text(sp.Rational(1, 3)) == "1/3"


def status(words):
    with pytest.raises(SystemExit) as stop:
        main(list(words))
    return stop.value.code


BAD = [
    (["study"], "which problem?"),
    (["study", "sin(x)"], "--on"),
    (["study", "sin(x)", "--on", "1", "0"], "reversed"),
    (["study", "smoth"], "smith"),
    (["study", "eq19", "--on", "0", "1"], "completes an expression"),
    (["study", "fresnel"], "has no target"),
    (["study", "sin(k*x)", "--on", "0", "1"], "k"),
    (["study", "sin(x)", "--on", "0", "1", "--plot", "picture.bmp"], ".svg"),
    (["study", "sin(x)", "--on", "0", "1", "--plot", "picture"], ".svg"),
    (["study", "sin(x)", "--on", "0", "1", "--timeout", "0"], "--timeout"),
    (["study", "sin(x)", "--on", "0", "1", "--format", "yaml"], "json"),
    (["study", "sin(x)", "--on", "0", "1", "--onn", "0"], "--on"),
    (["study", "eq12", "eq19"], "one problem at a time"),
    (["study", "__import__('os')", "--on", "0", "1"], "ratfit"),
    (["study", "missing.toml"], "no such file"),
]


@pytest.mark.parametrize(("words", "fragment"), BAD, ids=lambda w: " ".join(w) if isinstance(w, list) else "")
def test_bad_input_is_one_line(words, fragment, capsys):
    assert status(words) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1 and fragment in err


@pytest.mark.parametrize("suffix", ["svg", "pdf", "png"])
def test_pictures_are_written(suffix, tmp_path, capsys):
    file = tmp_path / f"picture.{suffix}"
    out = tmp_path / "study.json"
    words = ["study", "1/(x+1)", "--on", "0", "1", "--plot", str(file), "--format", "json", "--out", str(out)]
    assert status(words) == 0
    assert capsys.readouterr().err == f"wrote {file}\n"
    assert file.stat().st_size > 2000
    assert json.loads(out.read_text())["target"] == "1/(x + 1)"


def test_plot_draws_on_the_axes_given_and_shows_nothing():
    from matplotlib.figure import Figure

    from ratfit.plot import plot_study

    axes = Figure().subplots()
    assert plot_study(studied("tan(x)", "0", "3"), axes) is axes
    curve = axes.lines[0].get_ydata()
    assert any(map(math.isnan, curve)), "the branches on both sides of a pole are not joined"
    assert axes.get_ylim()[1] < 20
    cut = plot_study(studied("tanh(x)", "0", "oo"))
    assert "cut" in cut.get_xlabel()


def test_a_picture_says_facts_as_mathematics():
    from ratfit.plot import plot_study

    def entries(*case):
        axes = plot_study(studied(*case))
        return {handle.get_label() for handle in axes.get_legend_handles_labels()[0]}, axes

    found, axes = entries("sin(x)", "0", "pi/2")
    assert r"value: $f(0) = 0$, $f(\pi/2) = 1$" in found and r"slope: $f'(0) = 1$, $f'(\pi/2) = 0$" in found
    assert axes.get_title() == r"$\sin{\left(x \right)}$"
    found, axes = entries("x+1/(x-1/2)", "0", "1")
    assert r"pole: $f \cdot (x - 1/2) \to 1$ as $x \to 1/2$" in found and "asymptote: $x$" in found
    found, axes = entries("tanh(x)", "0", "oo")
    assert r"limit: $f \to 1$ as $x \to \infty$" in found and "[0, ∞]" in axes.get_xlabel()
    found, axes = entries("cos(x)-x", "0", "2")
    assert "zero: $f(0.7391) = 0$" in found, found


@pytest.mark.parametrize(
    "case, constant",
    [
        (("1/(x-1/2)+x", "0", "1"), "1/2"),
        # 1/x - x/3 and 2/x - 1 + x/6
        pytest.param(("1/tan(x)+2/(exp(x)-1)", "0", "1"), "-1", marks=pytest.mark.thorough),
        (("(1+k*x)/x", "0", "1", "k=1:2"), "k"),
    ],
)
def test_what_is_left_behind_a_simple_pole(case, constant):
    (fact,) = studied(*case).of("remainder")
    assert str(fact.value) == constant and fact.condition.equals == fact.value
    data = json.loads(study_json(studied(*case)))
    assert any("minus=" in (each["option"] or "") for each in data["facts"] if each["kind"] == "remainder")
    assert "minus" in study_toml(studied(*case))


@pytest.mark.thorough
def test_nested_time_limits_neither_hang_nor_stay_behind():
    """An outer limit that strikes while an inner one starts once struck the inner's newborn thread."""
    import threading

    from ratfit._deadline import TimeLimit

    for _ in range(150):
        with TimeLimit(0.003) as limit:
            while True:
                with TimeLimit(10):
                    pass
        assert limit.passed
    for thread in threading.enumerate():
        if "_watch" in thread.name:
            thread.join(2.0)
            assert not thread.is_alive()
