"""The ledger of claims: its shape, what it decides, that it could decide otherwise, its command and its page."""

import functools
import importlib
import json
import math
import re
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import mpmath
import pytest
import sympy as sp

import ratfit.claims
from ratfit._parse import RatfitError
from ratfit.brdf import distribution, fresnel, masking
from ratfit.claims import (
    DOCUMENTS,
    VERDICTS,
    Claim,
    Reading,
    claims,
    course,
    decide,
    method,
    sampling,
    schlick_factors,
    schlick_model,
    selected,
    smith,
    smoothie,
    whole_models,
)
from ratfit.claims import fresnel as fresnel_claims
from ratfit.claims._agreement import (
    Above,
    AtLeast,
    AtMost,
    Below,
    Between,
    Near,
    Rounded,
    agrees,
    same,
    shown,
    unguarded,
)
from ratfit.claims._directions import albedo
from ratfit.claims._models import LETTERS, V_PRIME, T, U, V, named
from ratfit.claims.distributions import ALPHA, farthest_total, is_gaussian
from ratfit.claims.masking import M, off_from_area, slope_jump, turned_by
from ratfit.models import directions
from ratfit.report.claims import claims_markdown, claims_text, summary

PAGE = Path(__file__).parent.parent / "docs" / "claims.md"
LEDGER = {claim.id: claim for claim in claims()}
ANEW = "make it anew: ratfit claims --format markdown --out docs/claims.md"


@cache
def decided(name):
    return decide(LEDGER[name])


def rows(page):
    return {line.split(" | ")[0].removeprefix("| "): line for line in page.splitlines() if re.match(r"\| \w+-", line)}


def test_ids_are_document_place_what_and_there_is_one_of_each():
    assert len(LEDGER) == len(claims()) >= 240
    for name, claim in LEDGER.items():
        assert re.fullmatch(r"(S|DP|PM|SM)(-[A-Za-z0-9.]+)+", name), name
        assert claim.document in DOCUMENTS and name.startswith(f"{claim.document}-")
        assert claim.claim and claim.place and claim.claimed is not None
        assert claim.found or claim.readings or claim.open, name


def test_every_theme_is_in_the_ledger():
    folder = Path(ratfit.claims.__file__).parent
    for path in folder.glob("[!_]*.py"):
        theme = importlib.import_module(f"ratfit.claims.{path.stem}")
        assert theme.CLAIMS and all(LEDGER[claim.id] is claim for claim in theme.CLAIMS), path.stem


def test_every_document_has_claims():
    assert {claim.document for claim in claims()} == set(DOCUMENTS)


# What each of these must come out as, known from outside of this code: the found number by hand, by mpmath or by the
# sources' own formulas, where there is one.
P = mpmath.mpf(1) / 5
KNOWN = {
    "S-4.1-one-solution": ("reading", 1),
    "S-12": ("reproduced", None),
    "S-4.1-eps": ("reading", 0.01362),
    "S-4.2-F1": ("reproduced", 0),
    "S-4.2-F2": ("wrong", None),
    "S-15-exponent": ("wrong", "(2, oo)"),
    "S-15-operations": ("reproduced", {"add": 2, "mul": 4}),
    "S-16-rotation": ("reading", None),
    "S-18-smith": ("wrong", 0.14352001),
    "S-18-m": ("wrong", sp.sqrt(2)),
    "S-20-normalised": ("reproduced", 1),
    "S-6": ("reproduced", (sp.pi,) * 4),
    "S-8-origin": ("wrong", "4"),
    "S-12-fraction": ("wrong", None),
    "S-13-ratio": ("reading", None),
    "S-14-mirror": ("wrong", None),
    "S-16-horizon": ("wrong", 1.0),
    "S-22-layers": ("wrong", None),
    "S-25-mirror": ("wrong", 1 / (1 + 1e4)),
    "S-32-B": ("wrong", 1 / (4 * sp.pi * V * V_PRIME)),
    "S-10-normalised": ("wrong", None),
    "S-28-Z": ("reproduced", 1),
    "S-28-A": ("wrong", float(2 / mpmath.pi * mpmath.sqrt(P) * mpmath.ellipk(1 - P**2))),
    "S-28-ellipse-A": ("reproduced", 0),
    "S-28-ellipse-Z": ("wrong", None),
    "S-29-zenith": ("reproduced", 0),
    "S-29-azimuth": ("wrong", 0.68995),
    "S-30-energy": ("wrong", 1 / (2 * 0.02)),
    "S-4-taylor": ("reading", None),
    "S-19-similar": ("wrong", None),
    "PM-D-ggx-cost": ("wrong", None),
    "PM-G-ggx": ("reading", True),
    "DP-G1-below": ("wrong", None),
    "SM-sine": ("wrong", 1 - 2 / sp.pi),
    "SM-ggx": ("reading", True),
    "S-33-ends": ("reproduced", (0, 0, 1, 1, 0, 0)),
    "S-5-six": ("reading", 6),
    "S-fn3": ("undecided", None),
    "DP-D-one": ("reading", (1, 1, 1)),
    "DP-F-exact": ("reading", True),
    "DP-G1-share": ("wrong", None),
    "DP-roughness-range": ("wrong", 0),
    "PM-ward-3": ("wrong", False),
    "PM-ward-cost": ("wrong", 15 / 19),
    "PM-phong-words": ("wrong", False),
    "PM-phong-notation": ("reading", True),
    "PM-oren-normalize": ("wrong", 0),
    "PM-lights": ("reproduced", math.sqrt(3)),
    "DP-model": ("reproduced", None),
    "PM-D-slope": ("wrong", math.sqrt(math.pi) / 2),
    "PM-ct-energy": ("wrong", math.pi),
    "PM-lambert-uniform": ("wrong", 0.5),
    "PM-blinn-angle": ("wrong", 0.5),
    "SM-code": ("wrong", None),
    "SM-normalization": ("wrong", None),
    "SM-F-schlick": ("wrong", 1 + (1 - fresnel_claims.F) * (1 - U) ** 5),
    "SM-D": ("reading", None),
    "SM-project": ("wrong", 2 * math.sin(math.pi / 4) - 1),
    "SM-F-fit": ("reading", None),
    "SM-perceptual": ("undecided", None),
}


LONG = {
    "S-4.1-one-solution", "S-4.2-F2", "S-4.4-whole-error", "S-14-mirror", "S-18-smith", "S-22-layers", "S-25-mirror",
    "S-29-azimuth", "S-30-energy", "S-fn3", "DP-G1-share", "SM-F-fit",
}  # fmt: skip
"""Claims that take a second or so: every day one of a kind is enough."""


def names_of(table):
    return [pytest.param(name, marks=pytest.mark.thorough) if name in LONG else name for name in table]


@pytest.mark.parametrize("name", names_of(KNOWN))
def test_known_verdicts_and_their_rows_of_the_page(name):
    verdict, found = KNOWN[name]
    decision = decided(name)
    assert decision.verdict == verdict
    assert rows(claims_markdown([decision]))[name] == rows(PAGE.read_text())[name], ANEW
    if isinstance(found, float):
        assert decision.found == pytest.approx(found, rel=5e-3)
    elif found is not None:
        assert agrees(decision.found, found)


# Claims with other numbers in them, and with other formulas under them: the verdict follows.
OTHERWISE = {
    "S-4.1-eps": (Rounded(0.02, 0.001), "undecided"),
    "S-15-operations": ({"add": 2, "mul": 3}, "wrong"),
    "S-18-m": (sp.sqrt(2), "reproduced"),
    "S-28-Z": (2, "wrong"),
    "S-28-A": (Rounded(0.8587, 1e-4), "reproduced"),
    "S-15-exponent": ("(2, oo)", "reproduced"),
    "S-33-ends": ((1, 0, 0, 1, 0, 0), "wrong"),
    "S-22-layers": (AtMost(2.0), "reproduced"),
    "S-13-range": ((False, True), "wrong"),
    "S-25-lambert": (1, "wrong"),
    "S-26": ((2 * sp.pi,) * 2, "wrong"),
    "S-4.4-whole-error": (AtMost(0.01), "undecided"),
    "DP-D-one": ((1, 1, 2), "wrong"),
    "SM-too-wide": ((AtLeast(1.01), AtLeast(2.0)), "wrong"),
    "S-20-peak": (2 / M**2, "wrong"),
    "S-30-energy": (AtMost(30.0), "reproduced"),
    "S-15-eps": (Rounded(0.013, 0.001), "reading"),
    "S-fn3": (Rounded(0.27, 0.01), "reading"),
    "DP-roughness-range": (0, "reproduced"),
    "DP-D-ggx": (distribution.ggx(T, ALPHA) * 2, "wrong"),
    "PM-D-slope": (Rounded(0.886, 0.001), "reproduced"),
    "PM-hdr": (8, "undecided"),
    "PM-ct-parameters": ("F0, k, rho", "reproduced"),
    "SM-F-fit": ((Near(-1.7, 1e-4), Near(-5.4, 1e-4)), "wrong"),
    "SM-energy-masked": (AtMost(1.0), "wrong"),
}


@pytest.mark.parametrize("name", names_of(OTHERWISE))
def test_with_another_number_the_verdict_is_another(name):
    claimed, verdict = OTHERWISE[name]
    assert decide(replace(LEDGER[name], claimed=claimed)).verdict == verdict


def test_what_decides_can_tell_a_right_formula_from_a_wrong_one():
    right, wrong = schlick_model.A, schlick_model.A_PRINTED
    assert schlick_model.mean_azimuth(right, 0.2) == pytest.approx(1) and schlick_model.is_share_of_ward(right)
    assert schlick_model.mean_azimuth(wrong, 0.2) < 0.9 and not schlick_model.is_share_of_ward(wrong)
    assert is_gaussian(distribution.beckmann(T, ALPHA)) and not is_gaussian(distribution.ggx(T, ALPHA))
    assert farthest_total(T * distribution.ggx(T, ALPHA) / 2, ALPHA, (0.5,)) == pytest.approx(0.5)
    assert slope_jump(masking.kelemen(U, V, V_PRIME)) < 0.01 < slope_jump(sp.Min(V, V_PRIME))
    assert turned_by(V * V_PRIME, both=False) == 0 < turned_by(U, both=False)
    assert (
        off_from_area(masking.ggx, distribution.ggx, 0.5) < 1e-5 < off_from_area(masking.schlick, distribution.ggx, 0.5)
    )
    assert course.is_mirror(course.by_steps) and not course.is_mirror(lambda light, normal: light)
    assert smoothie.off_energy(distribution.smoothie_energy(smoothie.ALPHA)) < 1e-9
    assert smoothie.off_energy(sp.pi / (4 + smoothie.ALPHA**2)) > 0.1
    assert method.independent(method.A * method.X + method.B * method.X, (method.A, method.B)) == 1
    assert smith.off_smith(masking.smith) < 1e-12 and smith.off_smith(masking.beckmann) > 0.01
    assert schlick_factors.total_of_product(2 * T**2, sp.S.One) == sp.pi
    assert schlick_factors.total_of_product(T**2, sp.S.One) is None
    glass = fresnel_claims.DIELECTRICS[1:]
    assert fresnel_claims.is_fresnel(lambda u, each: fresnel.conductor(u, *each), glass)
    assert not fresnel_claims.is_fresnel(lambda u, each: fresnel.schlick(u, fresnel.normal(*each)), glass)


@pytest.mark.thorough
def test_whole_models_against_what_is_known_of_them():
    assert whole_models.changed(named("lambert")) == 0 < whole_models.changed(named("phong-as-printed"))
    assert whole_models.brightest("schlick-23-25", [{"C": 0.0}]) == 0
    assert whole_models.of_layers("schlick-double", 0.0) == pytest.approx(1, abs=0.05)  # the mirror at the horizon


def test_samples_are_told_from_those_of_another_distribution():
    from ratfit.brdf import sampling as samples

    p = sp.Rational(1, 5)
    assert sampling.off_uniform(samples.azimuth, samples.azimuth_distribution, p) < 1e-12
    assert sampling.off_uniform(samples.azimuth, samples.azimuth_distribution, p) < 0.1
    assert sampling.off_uniform(lambda b, p: sp.pi * b / 2, samples.azimuth_distribution, p) > 0.1


def test_albedo_against_integrals_by_hand():
    assert albedo(sp.S.One / sp.pi, 0.3) == pytest.approx(1, abs=1e-9)
    assert albedo(V / (2 * sp.pi), 0.3) == pytest.approx(0.15, abs=1e-9)
    assert albedo(U**2 / sp.pi, 1.0) == pytest.approx(5 / 6, abs=1e-6)  # u^2 = (1 + v')/2: 2 int v'(1 + v')/2 dv'


@pytest.mark.parametrize(
    ("found", "claimed", "verdict"),
    [
        (0.01362, Rounded(0.014, 0.001), True),
        (0.0146, Rounded(0.014, 0.001), False),
        (-5.44673, Near(-5.43926, 0.006), True),
        (1.0001, AtMost(1.0), False),
        (1.0001, AtLeast(1.0), True),
        (1.0005, AtMost(1.0, 1e-3), True),
        (1.0001, Above(1.0), False),
        (1.02, Above(1.0), True),
        (0.98, Below(1.0), True),
        (0.9999, Below(1.0), False),
        (0.381, Between(0.8, 1.25), False),
        (1.2, Between(0.8, 1.25), True),
        (1.3, Between(0.8, 1.25), False),
        ((1.0, 0.5), (1, sp.Rational(1, 2)), True),
        ((1.0,), (1, 1), False),
        (True, 1, True),
        (None, 0, False),
        (1 + 1e-6, 1, False),
        (sp.sin(U) ** 2 + sp.cos(U) ** 2, sp.S.One, True),
        (sp.sin(U), U, False),
        ({"add": 1}, {"add": 1, "mul": 1}, False),
    ],
)
def test_agreement(found, claimed, verdict):
    assert agrees(found, claimed) is verdict


def test_the_letters_are_those_of_the_models():
    assert LETTERS == directions.LETTERS


def test_formulas_without_a_real_value_are_not_the_same():
    assert not same(sp.sqrt(-1 - U), sp.sqrt(-1 - U))
    assert not same(sp.log(U - 2), U)


def test_guards_are_not_shown():
    assert unguarded(sp.Piecewise((0, U <= 0), (sp.Max(U, 0) ** 2, True))) == U**2
    assert shown(masking.schlick_roughness(V, M)) == "v/(m*(1 - v) + v)"


def test_numbers_are_shown_as_json_has_them():
    assert shown(float("nan")) is None and shown(1e-14) == 0 and shown(Rounded(0.014, 0.001)) == 0.014
    assert shown((True, 0.5, AtMost(1.0))) == "True, 0.5, at most 1"


def toy(**changes):
    return Claim(**{"id": "S-1-toy", "place": "nowhere", "claim": "one is one", "claimed": 1, "found": None, **changes})


def test_the_order_of_the_decision():
    assert decide(toy(found=lambda: 1)).verdict == "reproduced"
    assert decide(toy(found=lambda: 2, readings=(Reading("half of it", lambda: 1),))).reading == "half of it"
    assert decide(toy(found=lambda: 2, instead=Reading("two", lambda: True))).reading == "two"
    assert decide(toy(found=lambda: 2, instead=Reading("two", lambda: False))).reading == "not confirmed here: two"
    assert decide(toy(open="no number")).verdict == "undecided"
    assert decide(toy(open="no", readings=(Reading("so", lambda: 3), Reading("or so", lambda: 4)))).found == 3


def test_a_word_that_means_no_number_is_a_reading_of_its_bound_or_fails_under_it():
    much = toy(claimed=AtLeast(2.0), word="much", found=lambda: 3)
    assert decide(much).verdict == "reading" and much.stated == 'at least 2 for "much"'
    assert decide(replace(much, found=lambda: 1)).verdict == "wrong"


def test_readings_that_measure_wait_until_they_are_asked_for():
    timed = toy(open="no machine", measured=(Reading("timed here", lambda: 1.1, Near(1, 0.2)),))
    assert decide(timed).verdict == "undecided" and decide(timed).found is None
    assert decide(timed, measure=True).verdict == "reading"


def test_speeds_are_undecided_until_measured():
    for claim in claims():
        if claim.measured:
            assert decided(claim.id).verdict == "undecided" and "--measure" in claim.open


def test_words_select():
    assert [claim.id for claim in selected(["s-28-a"])] == ["S-28-A"]
    assert {claim.document for claim in selected(["PM"])} == {"PM"}
    assert [claim.id for claim in selected(["S-4.2-F1", "S-4.2-F0"])] == ["S-4.2-F0", "S-4.2-F1"]
    assert all(claim.id.startswith("S-4.2-") for claim in selected(["S-4.2"]))
    assert selected([]) == claims()


@pytest.mark.parametrize(
    ("name", "letters"),
    [("schlick1994", "S"), ("Schlick", "S"), ("microfacet", "DP"), ("polimi2024", "PM"), ("POLIMI", "PM"),
     ("smoothie", "SM")],
)  # fmt: skip
def test_documents_answer_to_their_names(name, letters):
    assert selected([name]) == selected([letters]) != ()


@pytest.mark.parametrize(("word", "near"), [("shlick", "'schlick'"), ("polimi2023", "'polimi2024'"), ("", "`ratfit")])
def test_words_that_name_nothing_are_offered_the_nearest(word, near):
    with pytest.raises(RatfitError, match=near):
        selected([word])


@pytest.fixture
def run(run):
    return functools.partial(run, "claims")


def test_json_is_what_the_contract_says(run):
    status, out, _ = run("S-28-A", "PM-ward", "--format", "json")
    found = json.loads(out)
    assert status == 0 and [each["id"] for each in found] == ["S-28-A", "PM-ward-2", "PM-ward-3", "PM-ward-cost"]
    for each in found:
        assert list(each) == ["id", "document", "place", "claim", "verdict", "claimed", "found", "reading"]
        assert each["verdict"] in VERDICTS and each["document"] in DOCUMENTS


def test_text_says_claim_verdict_and_what_is_right(run):
    status, out, _ = run("S-28-A")
    assert status == 0 and "S-28-A (Eqs. 27, 28): wrong" in out
    assert "0.8587" in out and "right is" in out and out.rstrip().endswith("1 claim: 1 wrong")


def test_out_is_written_and_nothing_printed(run, tmp_path):
    status, out, _ = run("S-fn2", "--format", "markdown", "--out", str(tmp_path / "claims.md"))
    assert status == 0 and out == "" and "S-fn2" in (tmp_path / "claims.md").read_text()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [(["S-28-B"], "did you mean"), (["S-28-A", "nonsense"], "nonsense"), (["S-28-A", "--format", "xml"], "xml")],
)
def test_what_names_no_claim_is_one_line_with_the_remedy(run, arguments, words):
    status, out, err = run(*arguments)
    assert status == 2 and out == "" and words in err and err.count("\n") == 1


def test_one_claim_needs_no_jax():
    code = "import sys\nfrom ratfit.claims import decide, selected\nprint(decide(selected(['S-28-A'])[0]).verdict)\n"
    code += "print([m for m in ('jax', 'matplotlib') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n")[:2] == ["wrong", "[]"]


def test_the_page_has_every_claim():
    assert list(rows(PAGE.read_text())) == list(LEDGER), ANEW


def test_no_statement_in_place_of_a_wrong_one_is_unconfirmed_and_every_wrong_one_has_one():
    page = PAGE.read_text()
    assert "not confirmed here" not in page
    for name, row in rows(page).items():
        assert "**wrong**" not in row or LEDGER[name].instead, name


@pytest.mark.thorough
def test_the_whole_page_is_what_the_command_gives():
    whole = [decided(name) for name in LEDGER]
    assert f"{summary(whole)}." in PAGE.read_text() and PAGE.read_text() == claims_markdown(whole) + "\n", ANEW
    assert all(name in claims_text(whole) for name in LEDGER)


@pytest.mark.thorough
@pytest.mark.parametrize("name", LEDGER)
def test_what_was_found_would_be_reproduced_and_what_was_not_would_not(name):
    """Every verdict follows the number: claims of what was found hold, claims of something else do not."""
    claim, decision = LEDGER[name], decided(name)
    if decision.verdict == "wrong" and decision.found is not None:
        assert decide(replace(claim, claimed=decision.found, word="")).verdict == "reproduced"
    if decision.verdict == "reproduced":
        assert decide(replace(claim, claimed=something_else(claim.value, decision.found))).verdict != "reproduced"


def something_else(claimed, found):
    match claimed:
        case bool():
            return not claimed
        case AtMost() | AtLeast():
            return type(claimed)(float(found) - 1 if isinstance(claimed, AtMost) else float(found) + 1)
        case Above() | Below():
            return type(claimed)(float(found) - 1 if isinstance(claimed, Below) else float(found) + 1)
        case Rounded():
            return replace(claimed, value=claimed.value + 3 * claimed.unit)
        case str():
            return f"not {claimed}"
        case tuple():
            return (something_else(claimed[0], found[0]), *claimed[1:])
        case dict():
            return {**claimed, "add": claimed["add"] + 1}
    return claimed + 1
