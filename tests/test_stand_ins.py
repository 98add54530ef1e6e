"""Models in the place of others: measured over pairs of directions, against formulas of vectors."""

import json

import numpy as np
import pytest

import ratfit as rf
from ratfit._sampling import bounds, drawn, resolve
from ratfit._setting import PAIR, setting
from ratfit.models import named
from ratfit.models.stand_ins import STAND_INS, stand_ins

SAMPLES = 20_000
ALPHA = {"alpha": 0.25}


@pytest.fixture(scope="module")
def pairs():
    """Cosines of pairs as the instrument draws them, in float64, and directions that have them."""
    each = STAND_INS["cook-torrance-optimised"]
    place = setting(each, each.settings(ALPHA))
    sampling = resolve("hemisphere", place.variable.name, 0, 1, "float64", place.drawn)
    counters = np.arange(SAMPLES, dtype=np.uint64)
    found = dict(
        zip(PAIR, map(np.asarray, drawn(sampling, 0, counters, bounds(place, "float64"), "float64")), strict=True)
    )
    return sampling, found


def directions(found):
    """The view in the plane of the tangent and the normal, and the light: from their heights and the angle between."""
    u, v, v_prime = (found[name] for name in ("u", "v", "v_prime"))
    sine, other = np.sqrt(1 - v**2), np.sqrt(1 - v_prime**2)
    across = np.clip((2 * u**2 - 1 - v * v_prime) / (sine * other), -1, 1)
    nothing = np.zeros_like(v)
    light = np.stack([other * across, other * np.sqrt(1 - across**2), v_prime], axis=-1)
    return np.stack([sine, nothing, v], axis=-1), light


def test_the_cosines_are_those_of_one_pair(pairs):
    sampling, found = pairs
    assert sampling == "hemisphere:pair"
    assert found["t"] == pytest.approx((found["v"] + found["v_prime"]) / (2 * found["u"]), abs=1e-12)
    view, light = directions(found)
    half = view + light
    half /= np.linalg.norm(half, axis=-1, keepdims=True)
    assert half[:, 2] == pytest.approx(found["t"], abs=1e-7)
    assert np.sum(half * view, axis=-1) == pytest.approx(found["u"], abs=1e-7)


def test_pairs_are_uniform_over_the_hemisphere_and_independent(pairs):
    _, found = pairs
    for name in ("v", "v_prime"):  # equal solid angles have equal heights
        counts, _ = np.histogram(found[name], 10, (0, 1))
        assert np.sum((counts - SAMPLES / 10) ** 2 / (SAMPLES / 10)) < 27.9  # chi-square, 9 degrees, 0.1 %
    assert abs(np.corrcoef(found["v"], found["v_prime"])[0, 1]) < 4 / np.sqrt(SAMPLES)
    assert np.mean(np.arccos(found["w"])) == pytest.approx(np.pi / 4, abs=4 * np.pi / 4 / np.sqrt(3 * SAMPLES))


@pytest.mark.thorough
@pytest.mark.parametrize("name", STAND_INS)
def test_errors_are_those_of_the_models_on_directions(name, pairs):
    """The models called on directions, not their formulas in cosines: an independent way to the same numbers."""
    each, (_, found) = STAND_INS[name], pairs
    values = each.settings(ALPHA)
    view, light = directions(found)
    own = {p.name: values[p.name] for p in each.exact.parameters}
    exact = each.exact(view, light, **own)
    normal = ((own["eta"] - 1) ** 2 + own["kappa"] ** 2) / ((own["eta"] + 1) ** 2 + own["kappa"] ** 2)
    stood = {p.name: {**own, "f": normal}[p.name] for p in each.model.parameters}
    error = each.model(view, light, **stood) - exact
    measured = rf.measure_error(each, parameters=values, sampling="hemisphere", samples=SAMPLES, dtype="float64")
    assert measured.epsilon["mean_mean"] == pytest.approx(np.mean(np.abs(error)) / np.mean(exact), rel=1e-5)
    assert measured.epsilon["peak_max"] == pytest.approx(np.max(np.abs(error)) / np.max(exact), rel=1e-5)
    assert measured.parameters == own
    assert (measured.curve, measured.poles) == (None, ())


@pytest.mark.thorough
def test_a_model_in_its_own_place_has_no_error():
    each = STAND_INS["cook-torrance-optimised"]
    same = type(each)(each.exact, each.exact)
    found = rf.measure_error(
        same, parameters=same.settings(ALPHA), sampling="hemisphere", samples=2000, dtype="float64"
    )
    assert found.epsilon["mean_mean"] < 1e-14


def test_names():
    assert {each.model.name for each in stand_ins("cook-torrance-as-printed")} == {
        "cook-torrance-optimised-as-printed", "cook-torrance-grooves",
    }  # fmt: skip
    assert [each.exact for each in stand_ins("cook-torrance-optimised")] == [named("cook-torrance")]


def test_bench_of_a_model(run, tmp_path):
    rows, words = tmp_path / "rows.jsonl", ("--set", "alpha=0.25", "--samples", "2000", "--backend", "cost-model")
    code, out, err = run("bench", "--model", "cook-torrance", *words, "--format", "json", "--out", str(rows))
    assert code == 0, err
    (row,) = json.loads(out)["rows"]
    assert row["name"] == "cook-torrance~cook-torrance-optimised"
    assert (row["sampling"], row["parameters"]["alpha"]) == ("hemisphere:pair", 0.25)
    assert row["gamma"] > 3
    assert set(row["worst"]) == {"definition", "at", "u", "v", "v_prime", "w"}
    assert run("bench", "--model", "cook-torrance", *words, "--out", str(rows), "--resume")[0] == 0
    assert len(rows.read_text().splitlines()) == 1
    assert run("report", str(rows), "--out", str(tmp_path / "pages"))[0] == 0


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--model", "cook-torance"], "did you mean 'cook-torrance'"),
        (["--model", "lambert"], "nothing stands for"),
        (["--model", "cook-torrance", "eq12"], "leave eq12 out"),
        (["--model", "cook-torrance", "--form", "2/1"], "leave --form out"),
        (["--model", "cook-torrance", "--exhaustive"], "leave --exhaustive out"),
        (["--model", "cook-torrance", "--sampling", "uniform"], "say hemisphere"),
        (["--model", "cook-torrance", "--sampling", "hemisphere:u"], "say hemisphere"),
        (["--model", "cook-torrance", "--set", "alfa=1"], "did you mean 'alpha'"),
        (["--model", "cook-torrance", "--set", "alpha=7"], "outside its range"),
        (["eq15", "--sampling", "hemisphere:pair"], "for a whole model"),
    ],
)
def test_what_is_no_model_or_no_measurement_of_one_is_refused(words, says, run):
    code, _, err = run("bench", *words, "--samples", "100", "--backend", "none")
    assert code == 2
    assert says in err
    assert len(err.strip().splitlines()) == 1


def test_the_line_of_progress_has_room_for_the_bar():
    """What is measured is cut, and says no letter that is drawn at random."""
    from ratfit._bench import model_jobs
    from ratfit.cli.measure import TITLE, _title

    for job in model_jobs("cook-torrance", {"alpha": 0.1}):
        assert job.name[:20] in _title(job) and len(_title(job)) <= TITLE and "random" not in _title(job)
