"""`ratfit paper`: Eq. 16's geometry, the search for the closest, and the verb from derivation to page."""

import dataclasses
import json
import math

import mpmath
import numpy as np
import pytest
import sympy as sp

from ratfit._error import DEFINITIONS, measure_error
from ratfit._parse import RatfitError
from ratfit._record import Record, read_rows
from ratfit._setting import RANDOM
from ratfit.gallery import card
from ratfit.report import rows as report_rows
from ratfit.report.paper import Asked, run, run_paper
from ratfit.report.paper.closest import Finding, closest, common, distance, rounds_to
from ratfit.report.paper.closest_part import closest_sentence
from ratfit.report.paper.common_part import common_sentence
from ratfit.report.paper.footnote import in_plane, on_hemisphere
from ratfit.report.paper.measurements import Derived, error_tasks, footnote_tasks, speed_task

# Directions: a view and a light, by angles in the plane, or by heights and the angle between their azimuths.
ANGLES = [(0.3, -0.7), (1.2, 1.5), (-1.4, 1.3), (0.01, 0.9), (1.55, -1.5)]
HEIGHTS = [(0.3, 0.7, 2.0), (0.9, 0.1, 0.5), (0.05, 0.02, 3.0), (0.5, 0.5, 0.0)]


def cosines(view, light):
    """t, u, v, v' of two explicit unit vectors; N is the third axis."""
    half = (view + light) / np.linalg.norm(view + light)
    return half[2], view @ half, view[2], light[2]


def in_the_plane(angle):
    return np.array([math.sin(angle), 0, math.cos(angle)])


def at_height(height, azimuth):
    across = math.sqrt(1 - height**2)
    return np.array([across * math.cos(azimuth), across * math.sin(azimuth), height])


def pairs():
    for s, a in ANGLES:
        yield in_plane(), {"s": s, "a": a}, cosines(in_the_plane(s), in_the_plane(a))
    for v, w, phi in HEIGHTS:
        yield on_hemisphere(), {"v": v, "w": w, "phi": phi}, cosines(at_height(v, 0.4), at_height(w, 0.4 + phi))


def smith(v, m, name):
    """One factor of Eq. 17, written anew: Eq. 18, and what it should have been."""
    a = v / mpmath.sqrt(2 * m**2 * (1 - v**2))
    g = a * mpmath.sqrt(mpmath.pi) * (1 + mpmath.erf(a))
    return {
        None: g / (g + 1),
        "smith-1967": g / (g + mpmath.exp(-(a**2))),
        "walter-2007": 2 * a * mpmath.sqrt(mpmath.pi) / (g + mpmath.exp(-(a**2))),
    }[name]


def value(expression, values):
    return float(expression.subs({s: sp.Float(values[s.name], 30) for s in expression.free_symbols}).evalf(20))


@pytest.mark.parametrize(("stated", "values", "expected"), list(pairs()))
def test_eq16_is_that_of_explicit_vectors(stated, values, expected):
    t, u, v, w = expected
    assert value(stated.formula, values) == pytest.approx(min(1, 2 * t * v / u, 2 * t * w / u), abs=1e-12)
    assert {symbol.name for symbol in stated.problem.parameters} == {*values, "m"} - {stated.problem.variable.name}


@pytest.mark.parametrize("name", [None, "smith-1967", "walter-2007"])
@pytest.mark.parametrize(("stated", "values", "expected"), list(pairs()))
def test_eq16_stands_for_the_product_of_two_smiths(stated, values, expected, name):
    _, _, v, w = expected
    exact = {None: stated.problem.target, **{r.name: r for r in stated.problem.references}}[name].expression
    for m in (0.05, 0.5):
        product = smith(mpmath.mpf(v), m, name) * smith(mpmath.mpf(w), m, name)
        assert value(exact, values | {"m": m}) == pytest.approx(float(product), rel=1e-9)


@pytest.mark.thorough
def test_eq16_is_measured_as_an_integral_over_the_angles_says():
    angles = (np.arange(1000) + 0.5) / 1000 * math.pi - math.pi / 2
    s, a = np.meshgrid(angles, angles)
    eq16 = np.minimum(1, 2 * np.cos((s + a) / 2) / np.cos((s - a) / 2) * np.minimum(np.cos(s), np.cos(a)))
    one = np.array([float(smith(mpmath.cos(angle), 0.25, None)) for angle in angles])
    grid = np.mean(np.abs(eq16 - one[:, None] * one))
    found = measure_error(in_plane(), samples=20_000, parameters={"a": RANDOM, "m": 0.25})
    assert found.poles == () and found.nonfinite == 0
    assert found.epsilon["absolute_mean"] == pytest.approx(grid, rel=0.03)


@pytest.mark.parametrize(
    ("found", "printed", "factor", "rounds"),
    [
        (0.0136, 0.014, 0.014 / 0.0136, True),
        (0.01449, 0.014, 0.01449 / 0.014, True),
        (0.01451, 0.014, 0.01451 / 0.014, False),
        (0.5251, 0.53, 0.53 / 0.5251, True),
        (0.5249, 0.53, 0.53 / 0.5249, False),
        (0.006, 0.006, 1, True),
        (1e80, 0.027, 1e80 / 0.027, False),
        (0.0, 0.014, math.inf, False),
        (-0.014, 0.014, math.inf, False),
    ],
)
def test_distance_is_a_factor_and_rounding_is_to_the_printed_digits(found, printed, factor, rounds):
    assert distance(found, printed) == pytest.approx(factor, rel=1e-12)
    assert rounds_to(found, printed) is rounds
    assert distance(None, printed) == math.inf


def a_finding(place="Eq. 19", protocol="uniform", setting="m = 0.1", is_random=False, against="", **epsilon):
    return Finding(place, protocol, setting, is_random, against, epsilon)


def test_the_closest_of_a_table_by_hand():
    table = [
        a_finding(peak_mean=0.5, relative_mean=0.017, relative_bias=-0.018, ulp_mean=0.018),
        a_finding(protocol="angle", peak_mean=0.0182, relative_mean=None, relative_bias=0.0),
    ]
    found = closest(table, 0.018)
    assert (found.match.value, found.match.definition, found.match.finding) == (0.0182, "peak_mean", table[1])
    assert found.match.distance == pytest.approx(0.0182 / 0.018)
    assert (found.tried, len(found.rounding)) == (
        5,
        1,
    )  # None is no number, ulps are no fraction; -0.018 and 0 were tried
    assert closest_sentence(table, 0.018) == (
        "Closest to the printed 0.018 (1.8 %): 0.0182, peak_mean, angle, m = 0.1. "
        "Of 5 combinations of definition, protocol and setting 1 rounds to what was printed."
    )


def test_of_what_rounds_to_the_figure_a_mean_error_is_named_first():
    table = [
        a_finding("Eq. 12", "uniform", "", absolute_q50=0.014, absolute_mean=0.0136, peak_mean=0.0136, peak_rms=0.0163)
    ]
    found = closest(table, 0.014)
    assert [match.definition for match in found.rounding] == ["peak_mean", "absolute_mean", "absolute_q50"]
    assert found.match == found.rounding[0]
    assert closest_sentence(table, 0.014).endswith(
        "3 round to what was printed: peak_mean, uniform; absolute_mean, uniform; absolute_q50, uniform."
    )
    far = closest([a_finding(absolute_q50=0.02, peak_mean=0.03)], 0.01)
    assert (far.match.definition, far.rounding) == ("absolute_q50", ())  # what does not round to it, by its distance
    assert (
        "off by a factor of 2. Of 2 combinations of definition, protocol and setting none rounds"
        in closest_sentence([a_finding(absolute_q50=0.02, peak_mean=0.03)], 0.01)
    )


def test_nothing_is_closest_where_nothing_was_measured():
    assert closest([], 0.014) is None
    assert closest([a_finding(peak_mean=None, relative_bias=-1.0)], 0.014) is None
    assert "Nothing" in closest_sentence([], 0.014)


def test_the_common_measure_of_a_table_by_hand():
    """Two equations, one with m: pooled by the mean 0.02 or at random 0.04, and a sine that is uniform throughout."""
    table = [
        a_finding("Eq. 12", "uniform", "", peak_mean=0.01, peak_max=0.08),
        a_finding("Eq. 19", "cosine", "m = 0.1", peak_mean=0.01, peak_max=None),
        a_finding("Eq. 19", "cosine", "m = 0.5", peak_mean=0.03, peak_max=0.5),
        a_finding("Eq. 19", "cosine", "m random", is_random=True, peak_mean=0.04, peak_max=0.02),
        a_finding("Eq. 19", "cosine", "m = 0.1", against="walter-2007", peak_mean=9.0, peak_max=9.0),
    ]
    printed = {"Eq. 12": 0.01, "Eq. 19": 0.02}
    ways = common(table, printed, ("uniform", "cosine"))
    assert [(w.definition, w.protocol, w.is_random, w.distance) for w in ways] == [
        ("peak_mean", "cosine", False, 1.0),
        ("peak_mean", "cosine", True, 2.0),
        ("peak_max", "cosine", True, pytest.approx(8.0)),
    ]
    assert ways[0].values == {"Eq. 12": 0.01, "Eq. 19": 0.02}
    assert common_sentence(ways, printed).endswith("To the printed digits it gives Eq. 12 and Eq. 19.")
    assert common_sentence(ways[1:], printed).endswith("gives Eq. 12; it is off, by these factors, for Eq. 19 (2).")
    assert common(table, {**printed, "Eq. 21": 0.027}, ("cosine",)) == []


def test_cosines_that_are_drawn_alike_stand_for_one_another():
    """In a plane the angle of v is uniform; over the hemisphere v itself is, and so are v and v' of Eq. 16."""
    table = [
        a_finding("Eq. 19", "angle", peak_mean=1.0),
        a_finding("Eq. 19", "uniform", peak_mean=2.0),
        a_finding("Eq. 16", "in-plane", peak_mean=3.0),
        a_finding("Eq. 16", "hemisphere", peak_mean=4.0),
    ]
    ways = common(table, {"Eq. 19": 1.0, "Eq. 16": 1.0}, ("uniform", "angle", "cosine", "in-plane", "hemisphere"))
    plain = {way.protocol: tuple(way.values.values()) for way in ways if not way.is_random}
    assert plain == {"angle": (1, 3), "in-plane": (1, 3), "uniform": (2, 4), "hemisphere": (2, 4)}


@pytest.mark.parametrize(
    ("name", "expected"),
    [("eq12", 2), ("eq15", 5 * 4), ("eq19", 3 * 6 + 2 * 5), ("eq21", 5 * 6)],
)
def test_every_equation_is_measured_under_every_protocol_at_every_setting(name, expected):
    derived = Derived(card(name), run.derive(card(name).problem))
    tasks = error_tasks(derived, 1000, 0)
    assert len({(t.protocol, t.against, t.setting) for t in tasks}) == len(tasks) == expected
    (timed,) = speed_task(derived, ("numpy",), 1000, 0)
    assert timed.setting == {"eq12": "", "eq15": "copper", "eq19": "m = 0.25", "eq21": "m = 0.25"}[name]
    unknown = Derived(card(name), dataclasses.replace(derived.fit, candidates=()))
    assert error_tasks(unknown, 1000, 0) == [] == speed_task(unknown, ("numpy",), 1000, 0)


def test_the_footnote_is_measured_in_the_plane_and_over_the_hemisphere():
    found = [(t.protocol, t.against, t.setting) for t in footnote_tasks(1000, 0)]
    assert len(set(found)) == len(found) == 2 * (5 + 1 + 2)
    assert ("in-plane", "walter-2007", "m random") in found


# The verb, with numbers of our own in place of measured ones: 0.0136 for every definition, and gamma 20.


@pytest.fixture
def measured(monkeypatch):
    """Every measurement that was made, in order; the one numbered `stops_at` is interrupted."""
    made = []
    made_up = type("", (), {"stops_at": None, "made": made})()

    def measure(job, how, backends, *, about, watch, say):
        if len(made) == made_up.stops_at:
            raise KeyboardInterrupt
        made.append((job.name, how.sampling, dict(job.parameters), tuple(backends)))
        key = report_rows.asked(job, how, "")
        epsilon = dict.fromkeys(DEFINITIONS, 0.0136)
        for backend in backends or ("",):
            gammas = (20.0, 19.0, 21.0) if backend else (None, None, None)
            yield Record(
                **{k: v for k, v in key.items() if k not in ("backend", "parameters")}, parameters=key["parameters"],
                backend=backend, regime="", flags="", epsilon=epsilon, nonfinite=0, worst={"definition": "", "at": 0.0},
                exact_s=1.0, fit_s=0.05, floor_s=0.04, gamma=gammas[0], gamma_low=gammas[1], gamma_high=gammas[2],
                note="noisy: the load average was 9 on 2 cores" if backend else "", **about,
            )  # fmt: skip

    monkeypatch.setattr(report_rows, "measure", measure)
    monkeypatch.setattr(run, "use_all_cores", lambda: None)  # JAX computes already, in this process
    monkeypatch.setattr(run, "EQUATIONS", ("eq12", "eq19"))
    monkeypatch.setattr(run, "footnote_tasks", lambda samples, seed: footnote_tasks(samples, seed)[:2])
    return made_up


@pytest.fixture
def sine_alone(monkeypatch):
    """A short run, without a page."""
    monkeypatch.setattr(run, "EQUATIONS", ("eq12",))
    monkeypatch.setattr(run, "footnote_tasks", lambda samples, seed: [])
    monkeypatch.setattr(run, "write_document", lambda document, folder, name: (folder,))


def asked(tmp_path, **changes):
    return Asked(
        **{"samples": 1000, "seed": 0, "out": tmp_path / "paper", "format": "text", "backends": ("numpy",)} | changes
    )


def test_the_verb_says_and_writes_all(measured, tmp_path, capsys):
    assert run_paper(asked(tmp_path)) == 0
    out = capsys.readouterr().out
    titles = ["Eq. 12: sine on a quarter turn", "Eq. 19: Smith's shadowing factor, one direction"]
    titles += ["Footnote 3: Eq. 16 in place of Smith's function", "What comes closest", "One measure for all", "gamma"]
    titles += ["Smith three ways", "Optical constants"]
    assert [line for line in out.splitlines() if line in titles] == titles
    assert out.count("symbolically equal") == 2 and "20.0 [19.0, 21.0] (a)" in out and "(a) noisy" in out
    assert "Eq. 12: 20 (numpy) to 20 (numpy); the printed 2.3 lies outside." in out
    folder = tmp_path / "paper"
    page, markdown = (folder / "paper.html").read_text(), (folder / "paper.md").read_text()
    assert all(f"## {title}" in markdown for title in titles)
    assert page.count("<details>") > 4 and all(name in page for name in DEFINITIONS)
    record = json.loads((folder / "paper.json").read_text())
    assert [e["place"] for e in record["equations"]] == ["Eq. 12", "Eq. 19"] and all(
        e["equal"] for e in record["equations"]
    )
    assert record["equations"][0]["paper"] == {"epsilon": 0.014, "gamma": 2.3, "operations": None}
    assert record["equations"][0]["closest"]["epsilon"] == 0.0136
    assert record["equations"][0]["closest"]["tried"] == len(DEFINITIONS) - 2  # uniform alone, without ulps
    rows = read_rows(folder / "rows.jsonl")
    assert len(rows) == len(record["rows"]) == len(measured.made) == 2 + 28 + 2 + 2
    assert rows[0]["fit"]["name"] == "sin" and rows[0]["command"] == "ratfit paper --samples 1000 --seed 0"


def test_json_alone_is_on_standard_output(measured, sine_alone, tmp_path, capsys):
    assert run_paper(asked(tmp_path, format="json")) == 0
    found = json.loads(capsys.readouterr().out)
    assert list(found) == ["machine", "samples", "seed", "equations", "footnote", "rows"]
    assert found["footnote"]["paper"] == {"epsilon": 0.53}


def test_an_interrupted_run_goes_on_where_it_stopped(measured, sine_alone, tmp_path):
    measured.stops_at = 1
    with pytest.raises(KeyboardInterrupt):
        run_paper(asked(tmp_path))
    assert len(read_rows(tmp_path / "paper" / "rows.jsonl")) == 1
    measured.stops_at = None
    assert run_paper(asked(tmp_path, resume=True)) == 0
    assert len(measured.made) == 3  # under two protocols, and the time: each once
    rows = read_rows(tmp_path / "paper" / "rows.jsonl")
    assert [(row["sampling"], row["backend"]) for row in rows] == [("uniform", ""), ("sobol", ""), ("uniform", "numpy")]
    with pytest.raises(RatfitError, match="samples 1000"):
        run_paper(asked(tmp_path, resume=True, samples=2000))
    assert run_paper(asked(tmp_path, samples=2000)) == 0  # without resume the rows are begun anew
    assert {row["samples"] for row in read_rows(tmp_path / "paper" / "rows.jsonl")} == {2000}


def test_rows_of_something_else_stay_as_they_are(measured, tmp_path):
    folder = tmp_path / "paper"
    folder.mkdir()
    (folder / "rows.jsonl").write_text("my notes\n")
    with pytest.raises(RatfitError, match="no measured row"):
        run_paper(asked(tmp_path))
    assert (folder / "rows.jsonl").read_text() == "my notes\n" and measured.made == []


def test_a_derivation_that_does_not_give_the_printed_formula_is_exit_status_1(
    measured, sine_alone, tmp_path, capsys, monkeypatch
):
    wrong = dataclasses.replace(card("eq12"), published=2 * card("eq12").published)
    monkeypatch.setattr(run, "card", lambda name: wrong if name == "eq12" else card(name))
    assert run_paper(asked(tmp_path, backends=())) == 1
    assert "NOT equal" in capsys.readouterr().out
    assert json.loads((tmp_path / "paper" / "paper.json").read_text())["equations"][0]["equal"] is False


@pytest.mark.parametrize(
    ("changes", "fragment"), [({"samples": 0}, "samples"), ({"seed": -1}, "seed"), ({"samples": 2**60}, "sobol has")]
)
def test_what_cannot_be_measured_is_said_before_anything_is_made(tmp_path, changes, fragment):
    with pytest.raises(RatfitError, match=fragment):
        run_paper(asked(tmp_path, **changes))
    assert not (tmp_path / "paper").exists()


def test_a_folder_of_which_nothing_came_is_taken_away_again(measured, tmp_path):
    measured.stops_at = 0
    with pytest.raises(KeyboardInterrupt):
        run_paper(asked(tmp_path))
    assert not (tmp_path / "paper").exists()
