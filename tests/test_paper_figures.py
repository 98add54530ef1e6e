"""The figures of the paper: the data behind them against independent values, what is drawn of it, and the command."""

import cmath
import math
import sys
from functools import cache
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import matplotlib
import mpmath
import numpy as np
import pytest

from paper_figures import style
from paper_figures.__main__ import main
from paper_figures.figures import FIGURES, named
from ratfit._parse import RatfitError

ROOT = Path(__file__).parent.parent
SLOPES = (0.01, 0.05, 0.1, 0.25, 0.5)
ROUGHNESS = (0.01, 0.05, 0.2, 0.5, 1.0)
MATERIALS = {"diamond": 2.417, "glass": 1.5, "copper": 0.70 + 2.704j, "gold": 0.29 + 2.863j}


@cache
def data(name):
    return FIGURES[name].data()


@cache
def figure(name, width=style.PAGE):
    return FIGURES[name].draw(data(name), width)


def axes_with(name, title):
    (found,) = [a for a in figure(name).axes if title in (a.get_title(), a.get_title(loc="left"))]
    return found


def curves_in(axes):
    """The curves that a legend names; grid, zero line and marks have no names."""
    return [line for line in axes.lines if not line.get_label().startswith("_")]


def at_some(places):
    """Indices of a few places, both ends among them."""
    return np.unique(np.linspace(0, len(places) - 1, 9).astype(int))


def check(curve, exact, fit):
    for n in at_some(curve.places):
        x = float(curve.places[n])
        assert curve.exact[n] == pytest.approx(float(exact(x)), rel=1e-7, abs=1e-12)
        assert curve.fit[n] == pytest.approx(float(fit(x)), rel=1e-7, abs=1e-12)
    at = int(np.argmax(abs(curve.fit - curve.exact)))
    assert curve.worst == (curve.places[at], (curve.fit[at] - curve.exact[at]) / curve.peak)


def test_sine():
    turn = math.pi / 2

    def fraction(x):  # schlick1994, Eq. 12
        u = -(math.pi**2) / 4
        return x * (u + x) / (u + (math.pi + u) * x)

    def cubic(x):  # Hermite's, from value 0 and slope 1 to value 1 and slope 0
        s = x / turn
        return s**2 * (3 - 2 * s) + turn * s * (1 - s) ** 2

    check(data("figure4_sine").fraction, math.sin, fraction)
    check(data("figure4_sine").cubic, math.sin, cubic)


def fresnel(u, index):
    """Unpolarised reflectance from Snell's law with a complex index."""
    below = cmath.sqrt(index**2 - 1 + u**2)  # index times the cosine below the surface
    s = (u - below) / (u + below)
    p = (index**2 * u - below) / (index**2 * u + below)
    return (abs(s) ** 2 + abs(p) ** 2) / 2


@pytest.mark.parametrize(("place", "material"), list(enumerate(MATERIALS)))
def test_fresnel(place, material):
    curve, index = data("figure5_fresnel")[place], MATERIALS[material]
    f = abs((index - 1) / (index + 1)) ** 2
    assert curve.label == material
    check(curve, lambda u: fresnel(u, index), lambda u: f + (1 - f) * (1 - u) ** 5)


def smith(v, m, kind):
    """Eq. 18, Smith's own function and today's, at 30 digits; a = cot(theta)/(sqrt(2) m)."""
    with mpmath.workdps(30):
        v = mpmath.mpf(v)
        a = v / mpmath.sqrt(1 - v**2) / (mpmath.sqrt(2) * mpmath.mpf(str(m)))
        g, falling = a * mpmath.sqrt(mpmath.pi) * (1 + mpmath.erf(a)), mpmath.exp(-(a**2))
        known = {"printed": g / (g + 1), "smith": g / (g + falling)}
        return known[kind] if kind in known else 2 * a * mpmath.sqrt(mpmath.pi) / (g + falling)


@pytest.mark.parametrize("kind", ["printed", "smith", "walter"])
@pytest.mark.parametrize(("place", "m"), list(enumerate(SLOPES)))
def test_smith(place, m, kind):
    k = math.sqrt(2 * m**2 / math.pi)
    curve = getattr(data("figure6_smith"), kind)[place]
    assert curve.label == f"m = {m:g}"
    check(curve, lambda v: smith(v, m, kind), lambda v: v / (v - k * v + k))


@pytest.mark.parametrize(("place", "m"), list(enumerate(SLOPES)))
def test_beckmann(place, m):
    lobe = data("figure7_beckmann")[place]

    def fit(t):  # schlick1994, Eq. 21, on its support
        x = t + m - 1
        return m**3 * x / (t * (m * x**2 - x**2 + m**2) ** 2) if x > 0 else 0.0

    check(lobe.curve, lambda t: math.exp((t**2 - 1) / (m * t) ** 2) / (m**2 * t**4), fit)
    assert lobe.m == m
    assert lobe.curve.peak == pytest.approx(1 / m**2)
    assert lobe.angle == pytest.approx(np.arctan(m * lobe.slope))


@pytest.mark.parametrize(("place", "r"), list(enumerate(ROUGHNESS)))
def test_zenith_is_ggx_in_place_of_beckmann(place, r):
    curve = data("figure8_zenith_and_azimuth")[0].curves[place]

    def ggx(t):  # walter2007, Eq. 33, with alpha^2 = r
        return r / (math.pi * t**4 * (r + (1 - t**2) / t**2) ** 2)

    def beckmann(t):
        return math.exp((t**2 - 1) / (r * t**2)) / (r * t**4)

    check(curve, beckmann, lambda t: math.pi * ggx(t))


def test_azimuth():
    found = data("figure8_zenith_and_azimuth")[1]
    for p, printed, right in zip(ROUGHNESS, found.printed, found.right, strict=True):
        ellipse = p / (p**2 * np.sin(found.angle) ** 2 + np.cos(found.angle) ** 2)
        assert right == pytest.approx(ellipse, rel=1e-12)
        assert printed == pytest.approx(np.sqrt(ellipse), rel=1e-12)
    for p, printed, right in zip(found.isotropy, found.printed_mean, found.right_mean, strict=True):
        assert printed == pytest.approx(math.sqrt(p) * float(mpmath.ellipk(1 - p**2)) * 2 / math.pi, rel=1e-10)
        assert right == pytest.approx(1, rel=1e-10)


def test_what_the_captions_say():
    found = data("figure6_smith")
    rises = [curves[-1].exact[1] / curves[-1].places[1] for curves in (found.printed, found.smith, found.walter)]
    assert rises == pytest.approx(np.array([1, 1, 2]) * math.sqrt(math.pi / 2) / 0.5, rel=1e-3)
    for lobe in data("figure7_beckmann"):
        assert (lobe.curve.errors[(lobe.slope > 0) & (lobe.slope < 1.3)] < 0).all()
        assert (lobe.curve.errors[(lobe.slope > 1.7) & (lobe.slope < 2.8)] > 0).all()
    zenith, azimuth = data("figure8_zenith_and_azimuth")
    for curve, r in zip(zenith.curves, ROUGHNESS, strict=True):
        slope = np.tan(zenith.angle) / math.sqrt(r)
        assert (curve.errors[(slope > 0) & (slope < 1)] < 0).all()
        assert (curve.errors[slope > 1.7] > 0).all()
    assert (azimuth.printed_mean[:-1] < 1).all()


# figure, title of the axes, the curves behind them, which array
PANELS = [
    ("figure5_fresnel", "True function: Eq. 13", lambda d: d, "exact"),
    ("figure5_fresnel", "Rational approximation: Eq. 15", lambda d: d, "fit"),
    ("figure5_fresnel", "Eq. 15 − Eq. 13, at worst:", lambda d: d, "errors"),
    ("figure6_smith", "True function as printed: Eq. 18", lambda d: d.printed, "exact"),
    ("figure6_smith", "Rational approximation: Eq. 19", lambda d: d.printed, "fit"),
    ("figure6_smith", "Smith's own: Smith 1967", lambda d: d.smith, "exact"),
    ("figure6_smith", "Used today: Walter 2007", lambda d: d.walter, "exact"),
    ("figure6_smith", "Eq. 19 − Eq. 18, at worst:", lambda d: d.printed, "errors"),
    ("figure6_smith", "Eq. 19 − Smith 1967, at worst:", lambda d: d.smith, "errors"),
    ("figure6_smith", "Eq. 19 − Walter 2007, at worst:", lambda d: d.walter, "errors"),
    ("readme_picture", "Exact (wide), fit (thin):", lambda d: d.curves, "fit"),
    ("readme_picture", "Fit − exact, at worst:", lambda d: d.curves, "errors"),
]


@pytest.mark.parametrize(("name", "title", "of", "array"), PANELS, ids=[f"{p[0]}: {p[1]}" for p in PANELS])
def test_axes_hold_the_curves(name, title, of, array):
    lines, curves = curves_in(axes_with(name, title)), of(data(name))
    assert len(lines) == len(curves)
    for line, curve in zip(lines, curves, strict=True):
        assert np.array_equal(line.get_xdata(), curve.places)
        assert np.array_equal(line.get_ydata(), getattr(curve, array))


def test_the_sine_is_drawn():
    found = data("figure4_sine")
    for title, heights in (
        (r"True function: $\sin x$", found.fraction.exact),
        ("Rational approximation: Eq. 12", found.fraction.fit),
    ):
        assert np.array_equal(axes_with("figure4_sine", title).lines[0].get_ydata(), heights)
    strip = axes_with("figure4_sine", "Error, approximation − true:")
    assert [line.get_label() for line in curves_in(strip)] == ["fraction, Eq. 12", "cubic, the same conditions"]
    assert "worst −2.6 %" in " ".join(text.get_text() for text in strip.texts)


@pytest.mark.parametrize("title", ["True function: Eq. 20", "Rational approximation: Eq. 21"])
def test_lobes_are_mirrored_and_in_parts_of_the_peak(title):
    lines = curves_in(axes_with("figure7_beckmann", title))
    for line, lobe in zip(lines, data("figure7_beckmann"), strict=True):
        x, y = line.get_data()
        height = lobe.curve.exact if "20" in title else lobe.curve.fit
        assert np.hypot(x, y)[len(x) // 2 :] == pytest.approx(height * lobe.m**2, abs=1e-12)
        assert x == pytest.approx(-x[::-1], abs=1e-15)
        assert y == pytest.approx(y[::-1], abs=1e-15)


def test_discs_are_logarithmic():
    found = data("figure8_zenith_and_azimuth")[1]
    lines = curves_in(axes_with("figure8_zenith_and_azimuth", "$A(w)$ as printed: Eq. 28"))
    for line, p in zip(lines, ROUGHNESS, strict=True):
        x, y = line.get_data()
        radius = np.hypot(x, y)
        top, side = radius[np.argmax(y)], radius[np.argmax(x)]
        assert top == pytest.approx(3 + math.log10(1 / math.sqrt(p)))  # w = 0, phi = 90 degrees
        if p < 1:
            assert side == pytest.approx(3 + math.log10(math.sqrt(p)))  # w = 1, phi = 0
    assert len(found.printed) == len(lines)


def written(drawn):
    """Every text that is seen: of axes that are switched off no ticks, of the others those within their limits."""
    for axes in drawn.axes:
        yield from (axes.title, axes._left_title, *axes.texts)
        yield from axes.get_legend().get_texts() if axes.get_legend() else ()
        for axis in (axes.xaxis, axes.yaxis) if axes.axison else ():
            low, high = sorted(axis.get_view_interval())
            yield axis.label
            yield from (tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high)
    for legend in drawn.legends:
        yield from legend.get_texts()


@pytest.mark.parametrize("name", FIGURES)
@pytest.mark.parametrize("width", [style.PAGE, pytest.param(style.COLUMN, marks=pytest.mark.thorough)])
def test_no_text_stands_on_another_or_is_cut_or_tiny(name, width):
    drawn = figure(name, width)
    texts = [text for text in written(drawn) if text.get_text() and text.get_visible()]
    boxes = [(text.get_text(), text.get_window_extent()) for text in texts]
    page, touch = drawn.bbox, 1.0  # a hundredth of an inch: boxes are a little larger than what is in them
    for text, box in boxes:
        assert page.x0 - touch <= box.x0 and box.x1 <= page.x1 + touch, text
        assert page.y0 - touch <= box.y0 and box.y1 <= page.y1 + touch, text
    for (one, first), (other, second) in combinations(boxes, 2):
        across = min(first.x1, second.x1) - max(first.x0, second.x0)
        up = min(first.y1, second.y1) - max(first.y0, second.y0)
        assert min(across, up) <= touch, (one, other)
    assert min(text.get_fontsize() for text in texts) >= 6.4


@pytest.mark.parametrize("name", ["figure4_sine", "figure7_beckmann"])
def test_drawing_leaves_no_trace(name):
    before = dict(matplotlib.rcParams)
    FIGURES[name].draw(data(name), style.COLUMN)
    assert dict(matplotlib.rcParams) == before
    pyplot = sys.modules.get("matplotlib.pyplot")
    assert pyplot is None or not pyplot.get_fignums()


@pytest.mark.parametrize("name", FIGURES)
def test_what_is_committed_has_todays_numbers(name):
    """The caption, with the numbers found, is in the file; so a change of them makes it old."""
    file = ROOT / "docs" / "figures" / f"{name}.svg"
    description = "{http://purl.org/dc/elements/1.1/}description"
    (found,) = ElementTree.parse(file).iter(description)
    caption = FIGURES[name].caption(data(name))
    assert found.text == caption, f"make it anew: python -m paper_figures {name} --out docs/figures --format svg"
    if name != "readme_picture":
        page = " ".join((ROOT / "docs" / "figures.md").read_text("utf-8").split())
        assert caption in page, f"docs/figures.md holds another caption than: {caption}"


def run(capsys, *arguments):
    """The exit code, and what was printed on both streams."""
    with pytest.raises(SystemExit) as left:
        main(list(arguments))
        sys.exit(0)
    return left.value.code, *capsys.readouterr()


@pytest.mark.thorough
def test_command_writes_whole_files_that_are_the_same_again(tmp_path, capsys):
    code, out, err = run(capsys, "figure4", "--out", str(tmp_path / "new" / "folder"))
    assert code == 0
    assert out.strip() == f"figure4_sine: {FIGURES['figure4_sine'].caption(data('figure4_sine'))}"
    assert "figure4_sine (1 of 1)" in err
    found = {path.name: path.read_bytes() for path in (tmp_path / "new" / "folder").iterdir()}
    assert sorted(found) == ["figure4_sine.pdf", "figure4_sine.png", "figure4_sine.svg"]
    assert found["figure4_sine.svg"].startswith(b"<?xml")
    assert found["figure4_sine.pdf"].startswith(b"%PDF")
    assert found["figure4_sine.png"].startswith(b"\x89PNG")
    run(capsys, "figure4", "--out", str(tmp_path), "--format", "svg", "--format", "pdf")
    assert sorted(path.name for path in tmp_path.glob("*.*")) == ["figure4_sine.pdf", "figure4_sine.svg"]
    assert all(path.read_bytes() == found[path.name] for path in tmp_path.glob("*.*"))


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["figure9"], "no figure 'figure9'"),
        (["fig"], "'fig' is the beginning of several; there are: figure4_sine, "),
        ([""], "no figure ''"),
        (["--format", "gif"], "'gif' is not one of 'svg', 'pdf', 'png'"),
        (["--width", "10"], "10 is not in the range 80<=x<=300"),
        (["--width", "nan"], "'nan' is not a valid integer"),
        (["figure4", "--out", "/dev/null/folder"], "name a folder that can be written to"),
        (["--nonsense"], "--nonsense"),
    ],
)
def test_bad_input_is_one_line_and_exit_2(capsys, arguments, says):
    code, out, err = run(capsys, *arguments)
    assert (code, out) == (2, "")
    assert says in err
    assert len(err.strip().splitlines()) == 1


def test_help_has_examples(capsys):
    code, out, _ = run(capsys, "--help")
    assert code == 0
    assert "python -m paper_figures figure6 --width 85" in out


def test_a_figure_is_known_by_its_beginning():
    assert named("figure7") == named("figure7_beckmann") == "figure7_beckmann"
    with pytest.raises(RatfitError, match="there are: figure4_sine"):
        named("figure")
