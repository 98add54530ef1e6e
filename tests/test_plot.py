"""Pictures of fits: the data behind them, their labels and errors; never their pixels."""

import math
import struct

import mpmath
import numpy as np
import pytest
import sympy as sp

import ratfit as rf
from ratfit._fit import Candidate, Checked
from ratfit.cli import main
from ratfit.plot import Picture, plot_fit
from ratfit.plot.curves import curves_of
from ratfit.plot.entries import WIDEST, rejection
from ratfit.plot.error import PLAIN, draw_error, draw_error_curve, worst_of, worst_text
from ratfit.plot.text import mathematics, on_a_line, significant, text_width
from ratfit.plot.view import broken, cut, is_pole
from ratfit.plot.write import write_picture

X = sp.Symbol("x")


@pytest.fixture(scope="module")
def smith():
    return rf.derive("eq19")


@pytest.fixture(scope="module")
def sine():
    return rf.derive("eq12")


@pytest.fixture(scope="module")
def drawn_sine(sine):
    return plot_fit(sine)


def curves(axes):
    """The long lines: fits and exact functions, by their labels."""
    found = {}
    for line in axes.lines:
        if len(line.get_xdata()) > 500:
            found.setdefault(line.get_label(), []).append(line)
    return found


def entries(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


def at(line, place):
    return float(np.interp(place, line.get_xdata(), line.get_ydata()))


def problem(expression, domain, conditions, form, **more):
    return rf.Problem(target=rf.Target(expression, X, domain), conditions=conditions, form=form, **more)


def line_through(expression, low, high):
    """The straight line through a function's ends."""
    return rf.derive(problem(expression, (low, high), [rf.Value(low), rf.Value(high)], rf.Rational(1, 0)))


@pytest.mark.parametrize("place", ["0.1", "0.5", "1.0", "1.4"])
def test_the_curves_are_the_functions(drawn_sine, place):
    above, below = drawn_sine
    x = mpmath.mpf(place)
    printed = x * (x - mpmath.pi**2 / 4) / (-(mpmath.pi**2) / 4 + (mpmath.pi - mpmath.pi**2 / 4) * x)  # schlick1994, 12
    ((exact,), (fit,)) = curves(above)["_exact"], curves(above)["fit"]
    assert at(exact, float(x)) == pytest.approx(float(mpmath.sin(x)), abs=1e-6)
    assert at(fit, float(x)) == pytest.approx(float(printed), abs=1e-6)
    (error,) = curves(below)["_error"]
    assert at(error, float(x)) == pytest.approx(float(printed - mpmath.sin(x)), abs=1e-6), "the peak of the sine is 1"


def test_the_worst_error_is_marked_and_written(drawn_sine):
    _, below = drawn_sine
    (note,) = below.texts
    place, error = note.xy
    # printed - sin has a single extremum inside, where the derivatives agree
    c = mpmath.pi**2 / 4
    off = lambda x: x * (x - c) / (-c + (mpmath.pi - c) * x) - mpmath.sin(x)  # noqa: E731
    expected = mpmath.findroot(lambda x: mpmath.diff(off, x), 0.83)
    assert place == pytest.approx(float(expected), abs=2e-3)
    assert error == pytest.approx(float(off(expected)), rel=1e-5)
    assert note.get_text() == "worst −2.6 % at x = 0.83"
    low, high = below.get_ylim()
    assert low < error < high


def test_a_family_has_a_curve_each_and_says_what_is_worst(smith):
    values = [0.05, 0.25, 0.5]
    above, below = smith.plot(parameters={"m": values})
    found = curves(above)
    assert len(found["_exact"]) == len(curves(below)["_error"]) == 3
    fits = [line for label, lines in found.items() for line in lines if label.startswith("m = ")]
    assert len({(line.get_color(), line.get_linestyle()) for line in fits}) == 3
    for m, fit, exact in zip(values, fits, found["_exact"], strict=True):
        s = math.sqrt(2 * m * m / math.pi)
        assert at(fit, 0.3) == pytest.approx(0.3 / (0.3 - s * 0.3 + s), rel=1e-5)  # schlick1994, Eq. 19
        h = 0.09 / (2 * m * m * 0.91)
        g = math.sqrt(math.pi * h) * (2 - math.erfc(math.sqrt(h)))
        assert at(exact, 0.3) == pytest.approx(g / (g + 1), rel=1e-5)  # Eq. 18
        assert fit.get_label().startswith(f"m = {m}: worst ")
    assert "slope" in entries(below)[-1] and "value" in entries(below)[-2]


def test_a_gallery_problem_has_its_settings_and_others_the_middle(smith):
    above, _ = plot_fit(smith)
    assert [label.split(":")[0] for label in curves(above) if label != "_exact"] == [
        f"m = {m}" for m in ("0.01", "0.05", "0.1", "0.25", "0.5")
    ]
    k = rf.parameter("k", 1, 4)
    other = rf.derive(problem(sp.exp(-k * X), (0, 1), [rf.Value(0), rf.Value(1)], rf.Rational(1, 0), name="smith"))
    above, below = other.plot()
    assert "k = 2.5 (mid-range)" in below.get_xlabel()
    assert at(curves(above)["_exact"][0], 0.5) == pytest.approx(math.exp(-1.25), rel=1e-5)


def test_a_reference_takes_the_place_of_the_target():
    fit = rf.derive("eq15")
    above, below = fit.plot(reference="glass")
    n, u = 1.5, 0.5
    cosine = math.sqrt(1 - (1 - u * u) / n**2)
    rs, rp = (u - n * cosine) / (u + n * cosine), (n * u - cosine) / (n * u + cosine)
    assert at(curves(above)["_exact"][0], u) == pytest.approx((rs**2 + rp**2) / 2, rel=1e-5)
    assert at(curves(above)["fit"][0], u) == pytest.approx(0.04 + 0.96 / 32, rel=1e-5)
    assert "exact: glass (schlick1994)" in entries(below)
    assert "f = 0.04" in below.get_xlabel() and "mid-range" not in below.get_xlabel()
    assert above.get_ylabel() == "F(u)", "f is a parameter"


def test_without_an_exact_function_the_fit_stands_alone_and_says_so():
    from matplotlib.figure import Figure

    above, below = rf.derive("eq15").plot()
    assert below is None and "_exact" not in curves(above)
    assert "no target to compare with (references: diamond, glass, copper, gold)" in entries(above)
    pair = Figure().subplots(2)
    assert rf.derive("eq15").plot(pair) == (pair[0], None)


@pytest.mark.parametrize(
    ("error", "expected"),
    # exp on [0, 1] and the line through its ends, at 1/2; its peak is e
    [("absolute", (1 + math.e) / 2 - math.exp(0.5)), ("peak", ((1 + math.e) / 2 - math.exp(0.5)) / math.e),
     ("relative", (1 + math.e) / 2 / math.exp(0.5) - 1)],
)  # fmt: skip
def test_definitions_of_the_error(error, expected):
    _, below = line_through(sp.exp(X), 0, 1).plot(error=error)
    assert at(curves(below)["_error"][0], 0.5) == pytest.approx(expected, rel=1e-5)
    assert ("%" in below.texts[0].get_text()) == (error != "absolute")


def test_conditions_are_marked():
    fit = rf.derive("tanh")
    above, below = fit.plot()
    dots = [line for line in above.lines if line.get_marker() == "o"]
    assert [(line.get_xdata()[0], line.get_ydata()[0]) for line in dots] == [(0, 0)]
    (asymptote,) = (line for line in above.lines if line.get_linestyle() == "--")
    assert set(asymptote.get_ydata()) == {1.0}
    assert entries(below) == [
        "exact: $\\tanh{\\left(x \\right)}$",
        "fit",
        "value: $f(0) = 0$",
        "limit: $f  \\to 1$ as $x \\to \\infty$",
        "equation: $y^{2} + y' - 1 = 0$ at $x = 0$, with 2 derivatives",
    ]
    assert "cut: the domain is [0, ∞]" in below.get_xlabel()
    places = curves(above)["fit"][0].get_xdata()
    assert places[0] == 0 and 5 <= places[-1] <= 20, "the largest error, at 4, is in the picture"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("pade-exp", "derivative: $f''(0) = 1$, $f'''(0) = 1$, $f^{(4)}(0) = 1$"),
        ("sin-ode", "equation: $y + y'' = 0$ at $x = 0$, with 3 derivatives"),
        ("langevin", "limit: $\\left(f - 1\\right) x \\to -1$ as $x \\to \\infty$"),
    ],
)
def test_what_cannot_be_drawn_is_said(name, text):
    above, below = rf.derive(name).plot()
    assert text in entries(below or above)


def test_the_weight_of_an_integral_is_written_with_the_function():
    conditions = [rf.Value(0, equals=1), rf.Integral(weight=3 / (X + 1), equals=sp.pi / 2)]
    above, _ = rf.derive(rf.Problem(variable=X, domain=(0, 1), conditions=conditions, form=rf.Rational(1, 0))).plot()
    assert r"integral: $\int_{0}^{1} 3\,f/\left(x + 1\right)\,dx = \pi/2$" in entries(above)


def test_tangents_have_the_slope_of_the_condition(drawn_sine):
    above, _ = drawn_sine
    slopes = set()
    for line in above.lines:
        if len(line.get_xdata()) == 2:
            (left, right), (low, high) = line.get_xdata(), line.get_ydata()
            slopes.add(round((high - low) / (right - left), 12))
    assert slopes == {0.0, 1.0}


def test_a_hidden_root_is_drawn_dotted():
    above, below = rf.derive("eq12", route="polynomial").plot()
    dotted = [line for line in above.lines if line.get_linestyle() == ":"]
    heights = sorted(at(line, 0.5) for line in dotted)
    assert heights == [pytest.approx(0.5), pytest.approx(1.0)], "the fractions that cancel to x and to 1"
    rejected = [entry for entry in entries(below) if entry.startswith("rejected: ")]
    assert rejected == [
        r"rejected: x, breaks $f(\pi/2) = 1$, $f'(\pi/2) = 0$",
        "rejected: 1, breaks $f(0) = 0$, $f'(0) = 1$",
    ]


def test_a_rejected_candidate_is_told_with_what_it_breaks_or_why_else():
    ends = [rf.Value(0, 0), rf.Value(1, 1), rf.Derivative(0, equals=0), rf.Derivative(1, equals=0)]
    step = rf.derive(rf.Problem(variable=X, domain=(0, 1), conditions=ends, form=rf.Rational(2, 1)))
    assert [rejection(c, step.problem) for c in step.rejected] == ["rejected: x**2/(2*x - 1), it has a pole at x = 0.5"]
    weight = 1 / (1 + sp.exp(-X) + sp.sin(X) + sp.log(2 + X))
    broken = Checked(rf.Integral(weight=weight, equals=sp.pi / 2), sp.pi / 2, holds=False, residual=1.0)
    long = rejection(Candidate(sp.exp(sum(k * X**k for k in range(1, 9))), conditions=(broken,)), step.problem)
    assert long.startswith("rejected, breaks ") and text_width(long, 9) <= WIDEST


def test_poles_are_gaps_and_leave_the_error_relative():
    conditions = [rf.Value(0), rf.Derivative(0), rf.Limit(sp.pi / 2, scale=X - sp.pi / 2)]
    above, below = rf.derive(problem(sp.tan(X), (0, 3), conditions, rf.Rational(2, 1))).plot()
    for line in (curves(above)["_exact"][0], curves(above)["fit"][0]):
        places, heights = line.get_xdata(), line.get_ydata()
        assert abs(places[np.isnan(heights)] - math.pi / 2).max() < 0.01
    assert above.get_ylim()[1] < 20
    assert below.get_ylabel() == "error / |exact|"


def test_the_support_ends_where_it_does():
    above, below = rf.derive("eq21").plot(parameters={"m": 0.3})
    assert "integral: $\\int_{0}^{1} 2 t\\,f\\,dt = 1$" in entries(below)
    (fit,) = curves(above)["fit"]
    places, heights = fit.get_xdata(), fit.get_ydata()
    assert not heights[places < 0.7].any() and (heights[places > 0.701] > 0).all()
    assert at(fit, 1.0) == pytest.approx(1 / 0.09)


def test_axes_that_are_given_are_drawn_on():
    from matplotlib.figure import Figure

    fit = line_through(sp.exp(X), 0, 1)
    pair = Figure().subplots(2)
    assert fit.plot(pair) == tuple(pair)
    assert pair[0].get_xlim() == pair[1].get_xlim(), "places stand below each other, whether axes are shared or not"
    one = Figure().subplots()
    assert fit.plot(one) == (one, None) and "fit" in curves(one)


@pytest.mark.parametrize(
    ("axes", "fragment"),
    [(3, "not 3; or leave them out"), ("a.png", "fit.plot().curves.figure.savefig('a.png')"), ([1, 2], "2 of them"),
     ((), "0 of them"), (np.zeros(3), "3 of them")],
    ids=str,
)  # fmt: skip
def test_what_is_no_axes_is_refused(axes, fragment, sine):
    with pytest.raises(rf.RatfitError, match="axes: ") as refused:
        sine.plot(axes)
    assert fragment in str(refused.value) and "\n" not in str(refused.value)


@pytest.mark.parametrize(("name", "reference"), [("conductor-ends", None), ("conductor-ends", "gold"), ("eq15", None)])
def test_the_label_of_the_axis_is_inside_the_picture(name, reference):
    above, below = rf.derive(name).plot(reference=reference)
    axes = below or above
    axes.figure.draw_without_rendering()
    label, legend = axes.xaxis.label.get_window_extent(), axes.get_legend().get_window_extent()
    assert label.x0 >= 0 and label.x1 <= axes.figure.bbox.width
    assert legend.y1 <= label.y0, "the legend stands below all of its lines"
    for parameter in rf.derive(name).problem.parameters:
        assert f"{parameter} = " in axes.get_xlabel()


@pytest.mark.parametrize("error", ["peak", "absolute"])
def test_rounding_is_said_and_not_drawn(error):
    conditions = [rf.Value(0), rf.Value(1), rf.Derivative(0), rf.Derivative(1), rf.Derivative(0, 2)]
    quartic = rf.derive(problem((1 - X / 3) ** 4, (0, 1), conditions, rf.Rational(4, 0)))
    curve = curves_of(quartic, None, None)[0]
    assert 0 < np.nanmax(abs(curve.errors(error))) < 1e-15, "what would be drawn is noise"
    _, below = quartic.plot(error=error)
    (line,) = curves(below)["_error"]
    assert not line.get_ydata().any()
    assert [text.get_text() for text in below.texts] == ["no error beyond float64's rounding"]
    assert list(below.get_yticks()) == [0]


def test_rounding_beside_an_error_is_a_flat_line():
    k = rf.parameter("k", 0, 4)
    fit = rf.derive(problem(X + k * X**2, (0, 1), [rf.Value(0), rf.Value(1)], rf.Rational(1, 0)))
    _, below = fit.plot(parameters={"k": [0, 4]})
    assert [line.get_ydata().any() for line in curves(below)["_error"]] == [False, True]
    assert not below.texts and len(below.get_yticks()) > 2
    assert "k = 0: no error" in entries(below)
    _, below = fit.plot(parameters={"k": [0, 0]})
    assert [text.get_text() for text in below.texts] == ["no error"]


BAD = [
    ("eq19", {"parameters": {"q": 1.0}}, "no parameter 'q'"),
    ("eq19", {"parameters": {"m": [0.1, 7.0]}}, "outside its range"),
    ("eq19", {"parameters": {"m": []}}, "0 values"),
    ("eq19", {"parameters": {"m": [0.1] * 13}}, "13 values"),
    ("eq19", {"parameters": {"m": "random"}}, "drawn at numbers"),
    ("eq19", {"parameters": {"m": None}}, "a number is needed"),
    ("eq19", {"parameters": [0.1, 0.2]}, "give values by name, as in {'m': 0.2}"),
    ("eq19", {"parameters": 3}, "give values by name"),
    ("eq19", {"reference": 3}, "no reference 3"),
    ("eq19", {"reference": "walter"}, "walter-2007"),
    ("eq19", {"error": "ulp"}, "peak, relative, absolute"),
    ("azimuth-as-printed", {}, "there is no fit"),
]


@pytest.mark.parametrize(("name", "options", "fragment"), BAD, ids=lambda value: str(value)[:30])
def test_bad_input_is_refused_in_one_line(name, options, fragment):
    fit = rf.derive(name)
    with pytest.raises(rf.RatfitError) as refused:
        fit.plot(**options)
    assert fragment in str(refused.value) and "\n" not in str(refused.value)


def test_one_family_at_a_time_and_no_free_coefficient():
    a, b = rf.parameter("a", 1, 2), rf.parameter("b", 1, 2)
    fit = rf.derive(problem(a * X + b * X**2, (0, 1), [rf.Value(0), rf.Value(1)], rf.Rational(1, 0)))
    with pytest.raises(rf.RatfitError, match="one family"):
        fit.plot(parameters={"a": [1, 2], "b": [1, 2]})
    free = rf.derive(problem(sp.exp(X), (0, 1), [rf.Value(0)], rf.Rational(1, 0)))
    with pytest.raises(rf.RatfitError, match="--set"):
        free.plot()
    stated = rf.Problem(variable=X, domain=(0, 1), conditions=[rf.Value(0, equals=1)], form=rf.Rational(1, 0))
    with pytest.raises(rf.RatfitError, match="--set"):
        rf.derive(stated).plot()


def png_size(png):
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">2I", png[16:24])


def test_a_picture_shows_itself_in_a_notebook(sine):
    picture = sine.plot()
    assert isinstance(picture, Picture) and tuple(picture) == (picture.curves, picture.strip)
    width, height = picture.curves.figure.get_size_inches() * picture.curves.figure.dpi
    assert png_size(picture._repr_png_()[0]) == (round(width), round(height))
    assert png_size(rf.derive("eq15").plot()._repr_png_()[0])[0] == 660, "curves alone"


@pytest.mark.parametrize(
    ("name", "options", "words"),
    [
        ("eq12", {}, ["f(x) over x", "exact: \\sin{\\left(x \\right)}", "value: f(0) = 0"]),
        ("eq12", {}, ["beneath, error / peak, worst −2.6 % at x = 0.83"]),
        ("eq15", {}, ["F(u) over u at f = 0.5 (mid-range)", "no target to compare with"]),
        ("eq19", {"parameters": {"m": [0.1, 0.5]}}, ["smith", "m = 0.1: worst −9.8 %", "m = 0.5: worst 4.6 %"]),
    ],
)  # fmt: skip
def test_a_picture_in_words_for_those_who_do_not_see_it(name, options, words):
    picture = rf.derive(name).plot(**options)
    _, about = picture._repr_png_()
    assert all(each in about["alt"] for each in words), about["alt"]
    assert "$" not in about["alt"] and "\n" not in about["alt"]


def test_a_picture_of_pyplots_is_left_to_pyplot(sine):
    from matplotlib import pyplot
    from matplotlib.figure import Figure

    parts = Figure(figsize=(8, 4), dpi=100).subfigures(1, 2)
    assert png_size(sine.plot(parts[0].subplots(2))._repr_png_()[0]) == (800, 400), "the whole of a divided figure"
    backend = pyplot.get_backend()
    pyplot.switch_backend("agg")
    try:
        figure, pair = pyplot.subplots(2)
        assert sine.plot(pair)._repr_png_() is None
        pyplot.close(figure)
    finally:
        pyplot.switch_backend(backend)


def test_nothing_of_matplotlib_is_left_changed(smith):
    import matplotlib
    from matplotlib import pyplot

    before, figures = dict(matplotlib.rcParams), pyplot.get_fignums()
    smith.plot()
    assert dict(matplotlib.rcParams) == before
    assert pyplot.get_fignums() == figures, "no figure that a program would show"


@pytest.mark.parametrize("suffix", ["svg", "pdf", "png"])
def test_a_picture_is_the_same_to_the_last_byte_and_written_in_silence(suffix, tmp_path, caplog):
    from matplotlib.figure import Figure

    fit = line_through(sp.exp(X), 0, 1)
    files = [tmp_path / f"{name}.{suffix}" for name in "ab"]
    for file in files:
        write_picture(fit.plot(Figure(figsize=(3, 2)).subplots())[0].figure, file)
    first, second = (file.read_bytes() for file in files)
    assert first == second and len(first) > 2000
    assert not caplog.records
    if suffix == "svg":
        assert b"<text" not in first, "letters are shapes: no font is needed"


def status(words):
    with pytest.raises(SystemExit) as stop:
        main(list(words))
    return stop.value.code


def test_derive_writes_the_picture_beside_its_text(tmp_path, capsys):
    file = tmp_path / "fit.svg"
    assert status(["derive", "eq15", "--set", "n=3", "--plot", str(file), "--reference", "gold"]) == 0
    out, err = capsys.readouterr()
    assert "choice      n = 3" in out and err == f"wrote {file}\n"
    assert file.read_bytes().startswith(b"<?xml")


def test_an_honest_no_has_no_picture(tmp_path, capsys):
    file = tmp_path / "no.svg"
    words = ["derive", "x", "--on", "0", "1", "--form", "0/0", "--value", "0", "--value", "1", "--plot", str(file)]
    assert status(words) == 1
    out, err = capsys.readouterr()
    assert "no answer" in out and "no picture" in err and not file.exists()


def test_a_family_is_an_answer_without_a_picture(tmp_path, capsys):
    file = tmp_path / "family.svg"
    words = ["derive", "exp(x)", "--on", "0", "1", "--form", "1/0", "--value", "0", "--plot", str(file)]
    assert status(words) == 0
    out, err = capsys.readouterr()
    assert "family" in out and "no picture" in err and "--set" in err and not file.exists()


@pytest.mark.parametrize(
    ("words", "fragment"),
    [
        (["derive", "eq19", "--plot", "f.bmp"], "something.svg, something.pdf or something.png"),
        (["derive", "eq19", "--plot", "missing/f.svg"], "no folder"),
        (["derive", "eq19", "--reference", "walter-2007"], "--plot"),
        (["derive", "eq15", "--plot", "f.svg", "--reference", "golt"], "gold"),
        (["derive", "eq15", "--plot", "f.svg", "--reference", "gold", "--set", "f=0.9"], "leave --set f out"),
        (["derive", "eq19", "--plot", ""], "something.svg"),
    ],
    ids=lambda words: " ".join(words)[:40] if isinstance(words, list) else "",
)
def test_bad_input_of_the_command_is_one_line(words, fragment, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert status(words) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1 and fragment in err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("places", "errors", "text"),
    [
        ([0, 0.5, 1], [0, 0.0192, 0.001], "worst 1.9 % at v = 0.5"),
        ([0, 0.31, 1], [0, -0.0192, 0.001], "worst −1.9 % at v = 0.31"),
        ([0, 0.9991, 1], [0, 1.234, 0], "worst 120 % at v = 0.999"),
        ([0, 0.99999, 1], [0, 0.5, 0], "worst 50 % near v = 1"),
        ([0, 1], [math.nan, math.inf], "no finite error"),
        ([0, 1], [0, 2e-16], "no error beyond float64's rounding"),
        ([0, 1], [0, 0], "no error"),
    ],
)
def test_the_worst_in_words(places, errors, text):
    assert worst_text(worst_of(places, errors), variable="v") == text


def test_the_strip_alone():
    from matplotlib.figure import Figure

    axes = Figure().subplots()
    assert draw_error(axes, [0, 0.5, 1], [0, 2.5, 0], unit=PLAIN, colour="#000000", label="exp") is None
    assert [text.get_text() for text in axes.texts] == ["worst 2.5 at 0.5"]
    assert "exp" in axes.get_legend_handles_labels()[1]
    assert draw_error_curve(axes, [0, 1], [0, math.nan], unit=PLAIN).error == 0
    (_, top), (_, worst) = axes.transData.transform([(0, axes.get_ylim()[1]), (0, 2.5)])
    assert 72 * (top - worst) / axes.figure.dpi >= 20, "the text has room above the point, in points"


@pytest.mark.parametrize(
    ("number", "digits", "text"),
    [(1.94, 2, "1.9"), (123.4, 2, "120"), (-0.0312, 2, "−0.031"), (3.14e-7, 2, "3.1e−7"), (0, 2, "0"), (1e9, 3, "1e9")],
)
def test_numbers_have_no_more_digits_than_asked(number, digits, text):
    assert significant(number, digits) == text


def test_mathematics_that_matplotlib_sets():
    m = sp.Symbol("m", positive=True)
    assert on_a_line(sp.sqrt(sp.pi) / (2 * m)) == r"\sqrt{\pi}/\left(2 m\right)"
    assert on_a_line(sp.Rational(1, 3)) == "1/3"
    assert on_a_line(sp.exp(X / (2 * m))) == r"e^{x/\left(2 m\right)}"
    assert mathematics(X / 2) == r"\dfrac{x}{2}"
    assert mathematics(sp.Piecewise((0, X < 0), (1, True))) is None


@pytest.mark.parametrize(
    ("function", "has_pole"),
    [(lambda x: 1 / (x - 0.4), True), (lambda x: math.tanh(1e3 * (x - 0.4)), False), (lambda x: x - 0.4, False)],
)
def test_poles_show_themselves(function, has_pole):
    places = [(k + 0.5) / 999 for k in range(999)]
    heights = [function(x) for x in places]
    assert any(is_pole(heights, k) for k in range(2, 998)) == has_pole
    assert any(map(math.isnan, broken(places, heights))) == has_pole


def test_where_infinite_domains_are_cut():
    assert cut(math.tanh, 0, 1, 1.0, 0) == 3.0
    assert cut(lambda x: -math.exp(x), 0, -1, 0.0, 0) == 5.0
    assert cut(math.tanh, 0, 1, 1.0, 7.0) == 10.0, "what is marked is seen"
    assert cut(math.sin, 0, 1, None, 0) == 10.0
