"""Rows of then against rows of now: verdicts on cases whose answer is known, and chance that is no change."""

from dataclasses import replace

import numpy as np
import pytest

from ratfit._record import PROTOCOL, Record, compare
from ratfit.report.against import against_text, got_worse

MACHINE = {
    "processor": "A 1", "cores": 2, "devices": ["cpu: cpu"],
    "versions": {"python": "3.11", "numpy": "2.0", "jax": "0.9", "sympy": "1.14", "ratfit": "0.1.0"},
}  # fmt: skip
RECORD = Record(
    name="smith",
    parameters={"m": 0.2},
    samples=10_000,
    seed=0,
    sampling="uniform",
    dtype="float32",
    backend="jax-cpu",
    regime="arrays",
    flags="",
    epsilon={"peak_mean": 0.01, "peak_max": 0.02, "absolute_mean": 0.02, "absolute_max": 0.04},
    nonfinite=0,
    worst={"definition": "absolute_max", "at": 0.5},
    exact_s=4e-3,
    fit_s=1e-3,
    floor_s=1e-3,
    gamma=4.0,
    gamma_low=3.9,
    gamma_high=4.1,
    note="",
    machine=MACHINE,
    finished="2030-01-01T00:00:00+00:00",
)


def verdicts(new, old=RECORD):
    return {change.quantity: change.verdict for change in compare([old.to_line()], [new.to_line()])}


def of_epsilon(record=RECORD, **values):
    return replace(record, epsilon={**record.epsilon, **values})


def of_machine(record=RECORD, **values):
    return replace(record, machine={**MACHINE, **values})


def change_of(quantity, new, old=RECORD):
    (found,) = (c for c in compare([old.to_line()], [new.to_line()]) if c.quantity == quantity)
    return found


def test_a_row_is_the_same_as_itself():
    assert verdicts(RECORD) == dict.fromkeys(
        ["eps peak_mean", "eps peak_max", "eps absolute_mean", "eps absolute_max", "nonfinite", "gamma"], "same"
    )


def test_a_change_says_of_what_and_by_how_much():
    found = change_of("eps peak_mean", of_epsilon(peak_mean=0.0125))
    assert (found.old, found.new, found.verdict) == (0.01, 0.0125, "worse")
    assert found.by == pytest.approx(0.25)
    assert found.row == {
        "name": "smith", "parameters": {"m": 0.2}, "samples": 10_000, "sampling": "uniform", "dtype": "float32",
        "backend": "jax-cpu", "seed": 0,
    }  # fmt: skip


# --- eps of the same sample ---


@pytest.mark.parametrize(
    ("old", "new", "verdict"),
    [
        (0.01, 0.01 * (1 + 1e-8), "worse"), (0.01, 0.01 * (1 - 1e-8), "better"), (0.01, 0.01 * (1 + 1e-10), "same"),
        (0.0, 0.0, "same"), (0.0, 1e-300, "worse"), (1e-300, 0.0, "better"),
        (0.01, None, "worse"), (None, 0.01, "better"), (None, None, "same"),
    ],
)  # fmt: skip
def test_on_the_same_machine_any_change_of_eps_is_one(old, new, verdict):
    assert verdicts(of_epsilon(peak_mean=new), of_epsilon(peak_mean=old))["eps peak_mean"] == verdict


@pytest.mark.parametrize(
    ("old", "new", "verdict"),
    [(-0.01, 0.01, "same"), (-0.01, -0.02, "worse"), (-0.01, 0.005, "better"), (0.01, -0.02, "worse")],
)
def test_a_bias_is_the_better_the_nearer_to_zero(old, new, verdict):
    assert verdicts(of_epsilon(absolute_bias=new), of_epsilon(absolute_bias=old))["eps absolute_bias"] == verdict


def test_definitions_that_one_row_alone_has_are_gone_and_added():
    found = verdicts(of_epsilon(ulp_max=3.0), of_epsilon(relative_max=0.1))
    assert (found["eps relative_max"], found["eps ulp_max"]) == ("gone", "added")


def test_another_formula_is_compared_and_told():
    found = change_of("eps peak_mean", of_epsilon(replace(RECORD, formula="new"), peak_mean=0.02))
    assert found.verdict == "worse" and "another formula" in found.why


# --- eps elsewhere: float32 rounds by 2**-23, 8 of them and 1/1000 of eps are let pass ---


@pytest.mark.parametrize(
    "elsewhere",
    [of_machine(processor="B 2"), of_machine(versions={**MACHINE["versions"], "jax": "0.10"})],
)
@pytest.mark.parametrize(
    ("definition", "old", "new", "verdict"),
    [
        ("absolute_q99", 0.01, 0.01 * 1.015, "same"), ("absolute_q99", 0.01, 0.0103, "worse"),
        ("peak_mean", 0.01, 0.01 * 1.0005, "same"), ("peak_mean", 0.01, 0.0102, "worse"),
        ("peak_mean", 0.0102, 0.01, "better"), ("peak_mean", 0.0, 7 * 2**-23, "same"),
        ("peak_mean", 0.0, 9 * 2**-23, "worse"), ("ulp_max", 1.0, 8.5, "same"), ("ulp_max", 1.0, 10.0, "worse"),
        # the peak is 2 here, as absolute_max / peak_max says: a rounding of an absolute error is twice as large
        ("absolute_rms", 0.0, 15 * 2**-23, "same"), ("absolute_rms", 0.0, 17 * 2**-23, "worse"),
    ],
)  # fmt: skip
def test_elsewhere_rounding_is_no_change(elsewhere, definition, old, new, verdict):
    found = verdicts(of_epsilon(elsewhere, **{definition: new}), of_epsilon(**{definition: old}))
    assert found[f"eps {definition}"] == verdict


def test_the_graphics_card_is_the_processor_of_what_ran_on_it():
    old, new = (
        replace(of_machine(devices=[device]), backend="jax-gpu") for device in ("gpu: NVIDIA 1", "gpu: NVIDIA 2")
    )
    found = change_of("gamma", new, old)
    assert found.verdict == "incomparable" and "NVIDIA 2" in found.why
    assert verdicts(of_machine(devices=["gpu: NVIDIA 1"]))["gamma"] == "same"  # a card that had no part in it


# --- eps of other samples ---


def row_of_errors(errors, peak, seed):
    values = np.abs(errors)
    mean, rms, most = (float(v) for v in (values.mean(), np.sqrt((values**2).mean()), values.max()))
    epsilon = {"absolute_mean": mean, "absolute_rms": rms, "absolute_max": most}
    epsilon |= {"peak_mean": mean / peak, "peak_rms": rms / peak, "peak_max": most / peak}
    return replace(RECORD, seed=seed, samples=len(values), epsilon=epsilon)


DRAWN = {
    "even": lambda draw, n: draw.uniform(0, 1, n),
    "a thousandth of the samples carries the error": lambda draw, n: (draw.uniform(0, 1, n) < 1e-3).astype(float),
    "a heavy tail": lambda draw, n: draw.uniform(0, 1, n) ** -0.45,
    "normal": lambda draw, n: draw.standard_normal(n),
}


@pytest.mark.parametrize("kind", DRAWN)
def test_chance_is_not_taken_for_change(kind):
    """500 pairs of samples of one and the same error: none may be called worse or better."""
    draw = np.random.default_rng(7)
    found = set()
    for seed in range(1, 501):
        sizes = draw.choice([1000, 5000, 20_000], 2)
        old, new = (row_of_errors(DRAWN[kind](draw, size), 2.0, s) for size, s in zip(sizes, (0, seed), strict=True))
        found |= {c.verdict for c in compare([old.to_line()], [new.to_line()]) if c.quantity.startswith("eps")}
    assert found <= {"same", "incomparable"}


@pytest.mark.parametrize("kind", ["even", "normal"])
@pytest.mark.parametrize(("factor", "verdict"), [(1.2, "worse"), (0.8, "better"), (1.0, "same")])
def test_a_change_beyond_chance_is_seen_in_means_and_never_in_maxima(kind, factor, verdict):
    draw = np.random.default_rng(3)
    old, new = (row_of_errors(DRAWN[kind](draw, 100_000), 2.0, seed) for seed in (0, 1))
    new = replace(new, epsilon={name: factor * value for name, value in new.epsilon.items()})
    assert verdicts(new, old) == {
        "eps absolute_mean": verdict, "eps absolute_rms": verdict, "eps absolute_max": "incomparable",
        "eps peak_mean": verdict, "eps peak_rms": verdict, "eps peak_max": "incomparable",
        "nonfinite": "same", "gamma": "same",
    }  # fmt: skip


def test_a_divisor_that_was_sampled_too_is_let_pass():
    """The peak of this row came out 30 % higher by chance, so its mean over the peak came out lower: no news."""
    draw = np.random.default_rng(3)
    old, new = (row_of_errors(draw.uniform(0, 1, 10**5), peak, seed) for peak, seed in ((2.0, 0), (2.6, 1)))
    assert verdicts(new, old)["eps peak_mean"] == "same"


@pytest.mark.parametrize(
    ("new", "quantity", "text"),
    [
        (replace(RECORD, seed=1), "eps peak_median", "only means"),
        (replace(RECORD, seed=1), "eps relative_mean", "do not hold"),
        (replace(RECORD, seed=1, samples=20), "eps peak_mean", "too few samples"),
    ],
)
def test_what_another_sample_cannot_tell_is_not_compared(new, quantity, text):
    old, new = (of_epsilon(each, peak_median=m, relative_mean=m) for each, m in ((RECORD, 0.01), (new, 0.02)))
    found = change_of(quantity, of_epsilon(new, peak_mean=0.011), old)
    assert found.verdict == "incomparable" and text in found.why


def test_an_exact_fit_stays_exact_with_another_sample():
    exact = replace(RECORD, epsilon=dict.fromkeys(RECORD.epsilon, 0.0))
    assert set(verdicts(replace(exact, seed=1), exact).values()) == {"same"}


# --- What is not finite ---


@pytest.mark.parametrize(
    ("old", "new", "verdict"), [(0, 0, "same"), (0, 1, "worse"), (7, 3, "better"), (None, 3, None), (0, None, None)]
)
def test_every_sample_that_is_not_finite_counts(old, new, verdict):
    assert verdicts(replace(RECORD, nonfinite=new), replace(RECORD, nonfinite=old)).get("nonfinite") == verdict


@pytest.mark.parametrize(
    ("old", "new", "verdict"),
    # by hand: 5 standard deviations of k samples against none, of 10**4 each, are exceeded by more than 25
    [((0, 10**4), (25, 10**4), "same"), ((0, 10**4), (26, 10**4), "worse"), ((26, 10**4), (0, 10**4), "better"),
     ((1000, 10**4), (10**5, 10**6), "same"), ((1000, 10**4), (2 * 10**5, 10**6), "worse"),
     ((0, 0), (0, 10**4), "same")],
)  # fmt: skip
def test_counts_of_other_samples_are_compared_beyond_chance(old, new, verdict):
    rows = [replace(RECORD, nonfinite=k, samples=n, seed=seed) for seed, (k, n) in enumerate((old, new))]
    assert verdicts(rows[1], rows[0])["nonfinite"] == verdict


def test_counts_are_compared_one_by_one_where_both_rows_have_them():
    old = replace(RECORD, nonfinite=5, counts={"nan_fit": 0, "inf_fit": 5})
    new = replace(RECORD, nonfinite=5, counts={"nan_fit": 5, "inf_fit": 0})
    found = verdicts(new, old)
    assert (found["counts nan_fit"], found["counts inf_fit"]) == ("worse", "better")
    assert "nonfinite" not in found
    assert verdicts(new, RECORD)["nonfinite"] == "worse"


# --- gamma ---


@pytest.mark.parametrize(
    ("low", "gamma", "high", "verdict"),
    [
        (2.9, 3.0, 3.1, "worse"), (4.9, 5.0, 5.1, "better"),
        (2.0, 3.0, 3.9, "same"),  # its interval touches the old one, [3.9, 4.1]
        (3.84, 3.85, 3.86, "same"), (4.14, 4.15, 4.16, "same"),  # apart from the old one, but within 5 %
        (3.7, 3.75, 3.8, "worse"), (None, 3.0, None, "incomparable"),
    ],
)  # fmt: skip
def test_gamma_changes_where_its_intervals_lie_apart(low, gamma, high, verdict):
    new = replace(RECORD, gamma=gamma, gamma_low=low, gamma_high=high)
    assert verdicts(new)["gamma"] == verdict


@pytest.mark.parametrize(
    ("new", "verdict", "text"),
    [
        (of_machine(processor="B 2"), "incomparable", "different processors: A 1, now B 2"),
        (of_machine(cores=16), "incomparable", "2 cores, now on 16"),
        (replace(RECORD, samples=10**6), "incomparable", "10000 samples, now on 1000000"),
        (replace(RECORD, seed=1), "worse", ""),
        (replace(RECORD, flags="--xla_cpu_enable_fast_math=true"), "worse", "flags differ"),
        (replace(RECORD, exact_s=2e-3), "worse", "exact 0.004 s -> 0.002 s, fit 0.001 s -> 0.001 s"),
    ],
)
def test_gamma_says_what_it_was_compared_on(new, verdict, text):
    found = change_of("gamma", replace(new, gamma=2.0, gamma_low=1.9, gamma_high=2.1))
    assert found.verdict == verdict and text in found.why


@pytest.mark.parametrize(
    ("floor", "gamma", "verdict"),
    [
        (1.4e-3, 3.0, "incomparable"),  # the floor took 40 % more, gamma lost 33 %
        (0.7e-3, 3.0, "incomparable"), (1.2e-3, 3.0, "worse"), (0.9e-3, 5.0, "better"), (None, 3.0, "worse"),
    ],
)  # fmt: skip
def test_a_machine_that_was_not_itself_changes_no_gamma(floor, gamma, verdict):
    new = replace(RECORD, gamma=gamma, gamma_low=gamma - 0.01, gamma_high=gamma + 0.01, floor_s=floor)
    assert verdicts(new)["gamma"] == verdict


def test_a_row_without_speed_has_no_gamma_to_compare():
    untimed = replace(RECORD, **UNTIMED, gamma=None)
    assert "gamma" not in verdicts(untimed, untimed)
    assert (verdicts(RECORD, untimed)["gamma"], verdicts(untimed)["gamma"]) == ("added", "gone")


def test_a_fit_that_was_timed_and_found_wrong_is_worse():
    wrong = replace(RECORD, gamma=None, gamma_low=None, gamma_high=None, note="the timed output is not the fit")
    found = change_of("gamma", wrong)
    assert found.verdict == "worse" and "the timed output is not the fit" in found.why
    assert verdicts(RECORD, wrong)["gamma"] == "better"


UNTIMED = {"exact_s": None, "fit_s": None, "floor_s": None, "gamma_low": None, "gamma_high": None}


@pytest.mark.parametrize(("gamma", "verdict"), [(4.0, "same"), (3.99, "worse"), (4.01, "better")])
def test_operations_that_are_counted_are_the_same_on_every_machine(gamma, verdict):
    old = replace(RECORD, **UNTIMED, backend="cost-model")
    for new in (old, of_machine(old, processor="B 2", cores=64)):
        assert verdicts(replace(new, gamma=gamma), old)["gamma"] == verdict


# --- Pairs of rows ---


def rows(*records):
    return [record.to_line() for record in records]


@pytest.mark.parametrize(
    "other",
    [{"name": "sine"}, {"parameters": {"m": 0.3}}, {"parameters": {"m": (0.1, 0.5)}}, {"sampling": "cosine"},
     {"dtype": "float64"}, {"backend": "c"}],
)  # fmt: skip
def test_rows_of_different_measurements_are_no_pair(other):
    found = compare(rows(RECORD), rows(replace(RECORD, **other)))
    assert [(c.quantity, c.verdict) for c in found] == [("row", "gone"), ("row", "added")]
    assert not got_worse(found)


def test_of_a_measurement_made_twice_the_last_row_stands():
    again = of_epsilon(peak_mean=0.02)
    assert change_of("eps peak_mean", again).verdict == "worse"
    found = compare(rows(RECORD, again), rows(again, RECORD))
    assert [(c.verdict, c.old, c.new) for c in found if c.quantity == "eps peak_mean"] == [("better", 0.02, 0.01)]


def test_rows_of_the_same_processor_are_paired_first():
    here, there = of_epsilon(peak_mean=0.5), of_epsilon(of_machine(processor="B 2"), peak_mean=0.7)
    for old in ([here, there], [there, here]):
        found = compare(rows(*old), rows(here, there))
        assert {c.verdict for c in found} == {"same"} and len(found) == 12
        assert [c.verdict for c in compare(rows(*old), rows(here)) if c.quantity == "row"] == ["gone"]


def test_a_pair_of_the_same_sample_comes_before_any_other():
    more = replace(RECORD, samples=10**6)
    found = compare(rows(RECORD, more), rows(replace(RECORD, seed=1), more))
    assert {c.verdict for c in found if c.row["samples"] == 10**6} == {"same"}
    assert len(found) == 12 and not any(c.quantity == "row" for c in found)


def test_the_same_sample_on_another_processor_comes_before_another_sample():
    there = of_machine(processor="B 2")
    found = compare(rows(there, replace(there, samples=10**6)), rows(RECORD))
    assert [c.verdict for c in found if c.quantity.startswith("eps")] == ["same"] * 4
    assert [c.row["samples"] for c in found if c.quantity == "row"] == [10**6]


def test_whole_numbers_and_floats_are_the_same_values_of_parameters():
    assert "row" not in verdicts(replace(RECORD, parameters={"m": 1}), replace(RECORD, parameters={"m": 1.0}))


def test_numbers_of_another_protocol_are_not_compared():
    (found,) = compare(rows(replace(RECORD, protocol=1)), rows(of_epsilon(peak_mean=1.0)))
    assert (found.quantity, found.verdict) == ("row", "incomparable")
    assert f"protocol 1, now {PROTOCOL}" in found.why


# --- The text ---


def test_the_text_has_a_headline_and_the_worst_first():
    old = rows(RECORD, replace(RECORD, name="sine"), replace(RECORD, name="old"))
    new = rows(
        of_epsilon(peak_mean=0.011, absolute_mean=0.03, peak_max=None),
        of_epsilon(replace(RECORD, name="sine"), peak_max=0.019999999),
        replace(RECORD, name="new"),
    )
    found = compare(old, new)
    headline, _, head, *lines = against_text(found).split("\n")
    assert headline == "3 worse, 1 better, 8 the same within noise; 1 gone, 1 added"
    assert " ".join(head.split()) == "problem parameters samples protocol dtype backend quantity old new change why"
    assert [" ".join(line.split()) for line in lines[:4]] == [
        "worse smith m=0.2 10,000 uniform float32 jax-cpu eps peak_max 0.02 - - it has no value any more",
        "worse smith m=0.2 10,000 uniform float32 jax-cpu eps absolute_mean 0.02 0.03 +50 %",
        "worse smith m=0.2 10,000 uniform float32 jax-cpu eps peak_mean 0.01 0.011 +10 %",
        "better sine m=0.2 10,000 uniform float32 jax-cpu eps peak_max 0.02 0.019999999 -5e-06 %",
    ]
    assert lines[4:] == [
        "", "gone", "  in the old rows alone: old m=0.2 (float32, jax-cpu, 10,000 samples)",
        "", "added", "  in the new rows alone: new m=0.2 (float32, jax-cpu, 10,000 samples)",
    ]  # fmt: skip
    assert got_worse(found)


def test_a_row_without_a_backend_is_told_without_a_gap():
    untimed = replace(RECORD, **UNTIMED, backend="", gamma=None)
    found = compare(rows(untimed, replace(untimed, name="old")), rows(of_epsilon(untimed, peak_mean=0.011)))
    *_, line, _, _, gone = against_text(found).split("\n")
    assert " ".join(line.split()) == "worse smith m=0.2 10,000 uniform float32 - eps peak_mean 0.01 0.011 +10 %"
    assert gone == "  in the old rows alone: old m=0.2 (float32, 10,000 samples)"


def test_what_could_not_be_compared_is_gathered_by_its_reason():
    settings = [replace(RECORD, parameters={"m": m}) for m in (0.1, 0.2, 0.3)]
    found = compare(rows(*settings), rows(*(replace(each, machine={**MACHINE, "cores": 4}) for each in settings)))
    assert against_text(found) == (
        "0 worse, 0 better, 15 the same within noise; 3 not compared\n\n"
        "not compared\n  timed on 2 cores, now on 4: gamma (3 rows)"
    )
    assert not got_worse(found)


def test_long_lists_are_cut_and_say_by_how_much():
    text = against_text(compare([], rows(*(replace(RECORD, parameters={"m": m / 10}) for m in range(9)))))
    assert text.startswith("nothing could be compared: 9 added") and text.endswith(" and 3 more")


def test_nothing_against_nothing():
    assert against_text(compare([], [])) == "nothing could be compared"
