"""Numbers that README and the explanations take from the evidence are those that its pages state today."""

import re
from statistics import median

import pytest
from page_blocks import ROOT

LEVELS = r".* 5% beyond gamma ([\d.]+) .* 10% beyond gamma ([\d.]+) \(([\d.]+ to [\d.]+)"

FOUND = {
    "inside": ("sets", r"(\d+) of (\d+) computed quantities lie inside the 95 % interval"),
    "others": ("sets", r"others (\d+) are undecided .* (\d+) lie within the scatter .* (\d+) do not agree"),
    "checks": ("verification", r"(\d+) of (\d+) checks passed"),
    "hard": ("hard-cases", r"(\d+) of (\d+) scenes that are hard on the solver end as they must"),
    "free": ("validation", r"(\d+) of (\d+) measured numbers show no error .* (\d+) do:"),
    "largest": ("validation", r"the mesh in (\d+), the inputs in (\d+), the measurement in"),
    "calibrated": ("validation", r"meets (\d+ of \d+) values of e, mu and Omega"),
    "t2": ("sets", r"\| t2 \| 0\.\d+ ± 0\.\d+ \| ([\d.]+) \|"),
    "t5b": ("sets", r"\| t5b \| 0\.\d+ ± 0\.\d+ \| ([\d.]+) \|"),
    "cost": ("cost", r"median of ([\d.]+) % of e \(([\d.]+ to [\d.]+) %\)"),
    "effects": ("effects", r"(\d+) of (\d+) scenes give .* within (\d+)% of e and (\d+)% of E_vib"),
    "reduced": ("reduced", r"hypercube: .* in (\d+ of \d+) scenes, vibration .* in (\d+), both in (\d+);"),
    "reduced-sets": ("reduced", r"measured: .* of (\d+) scenes, .* both in (\d+);"),
    "limit": (
        "gamma",
        r"machined: [^;]* takes ([\d.]+) ± ([\d.]+) % of E_0 and e is ([\d.]+) [^;]* has ([\d.]+);",
    ),
    "elastic": ("gamma", r"frictionless: [^;]* takes ([\d.]+) ± [^;]* and e is ([\d.]+) [^;]* has ([\d.]+);"),
    "points": ("gamma", r"vibration of (\d+) of (\d+) points within 5% .*; in (\d+) of the others"),
    "runs": ("gamma", r"\nMade by .*: (\d+) runs, 0 failed"),
    "machined": ("gamma", rf"machined, by {LEVELS}"),
    "contaminated": ("gamma", rf"contaminated, by {LEVELS}"),
    "scatter": (
        "gamma",
        r"by ([\d.]+) about one curve of T1/tau, .* by ([\d.]+) about one curve of gamma",
    ),
    "force": ("gamma", r"mu\* = ([\d.]+);[^$]* mu\* = ([\d.]+);[^$]* mu\* = ([\d.]+);"),
}
"""Where a number is stated: page of docs/evidence, and what its sentence looks like."""

README, EXPLAINED = "README.md", "docs/explanation/"
TOLD = (
    (README, "checks", "{0} of {1} checks passed"),
    (README, "hard", "{1} hard cases: all balanced"),
    (README, "inside", "of {1} compared numbers {0} agree"),
    (README, "others", "{0} are undecided, {1} lie within the scatter of single tests, {2} do not agree"),
    (README, "free", "{0} of {1} show no error of the model"),
    (f"{EXPLAINED}accuracy.md", "cost", "of a default run is {1} % of e, median {0} %"),
    (f"{EXPLAINED}accuracy.md", "t2", "24 s on two free cores; {0} %)"),
    (f"{EXPLAINED}accuracy.md", "t5b", "the third level at two places tells {0} %"),
    (README, "limit", "takes {0} % of the energy with a yielding tip"),
    (README, "elastic", "and {0} % on an elastic contact"),
    (README, "limit", "and e is {2} and"),
    (README, "elastic", "and {1}, where a rod that cannot vibrate has"),
    (README, "limit", "has {3} and"),
    (f"{EXPLAINED}measured-sets.md", "inside", "Of {1} compared numbers"),
    (f"{EXPLAINED}measured-sets.md", "inside", "{0} lie inside the 95 % interval"),
    (f"{EXPLAINED}measured-sets.md", "others", "{0} are undecided by the mesh, {1} lie outside it"),
    (f"{EXPLAINED}measured-sets.md", "free", "{0} of the {1} show no error of the model and {2} do"),
    (f"{EXPLAINED}measured-sets.md", "largest", "largest uncertainty in {1} of them"),
    (f"{EXPLAINED}measured-sets.md", "calibrated", "meet {0} values of e, mu and Omega"),
    (f"{EXPLAINED}effects.md", "effects", "for {1} scenes: {0} agree within {2} % of e and {3} % of E_vib"),
    (
        f"{EXPLAINED}fidelities.md",
        "reduced",
        "in {0}, vibration within 25 % or .003 of E_0 in {1}, both in {2}",
    ),
    (f"{EXPLAINED}fidelities.md", "reduced-sets", "Of the {0} sets both hold in {1}"),
    (f"{EXPLAINED}gamma.md", "limit", "takes {0} ± {1} % with a yielding machined tip, and e is {2} where"),
    (f"{EXPLAINED}gamma.md", "points", "{0} of the {1} points have a band"),
    (f"{EXPLAINED}gamma.md", "points", "In {2} of the others the two values"),
    (f"{EXPLAINED}gamma.md", "runs", "{0} runs, 0 failed"),
    (f"{EXPLAINED}gamma.md", "machined", "finite elements | {0} ("),
    (f"{EXPLAINED}gamma.md", "contaminated", "finite elements | {0} ("),
    (f"{EXPLAINED}gamma.md", "machined", "at gamma {1} ({2}, machined)"),
    (f"{EXPLAINED}gamma.md", "contaminated", "{1} ({2}, contaminated)"),
    (f"{EXPLAINED}gamma.md", "scatter", "scatter by {0} about one curve of it, by {1} about one of gamma"),
    (f"{EXPLAINED}gamma.md", "force", "mu* = {0}, {1}, {2}"),
)
"""A page, what it tells, and the words around the numbers."""


def _text(page):
    return re.sub(r"\s+", " ", (ROOT / page).read_text(encoding="utf-8").replace("**", ""))


@pytest.mark.parametrize(("page", "what", "words"), TOLD)
def test_a_number_in_prose_is_that_of_the_evidence(page, what, words):
    evidence, sentence = FOUND[what]
    stated = re.search(sentence, (ROOT / f"docs/evidence/{evidence}.md").read_text(encoding="utf-8"))
    assert stated, f"docs/evidence/{evidence}.md no longer says what {page} tells of it"
    assert words.format(*stated.groups()) in _text(page)


def test_all_that_is_found_is_told():
    assert {what for _, what, _ in TOLD} == set(FOUND)


def _table(page, first):
    """Return the rows of the table of an evidence page whose head begins with some columns."""
    lines = (ROOT / f"docs/evidence/{page}.md").read_text(encoding="utf-8").splitlines()
    start = next(at for at, line in enumerate(lines) if line.startswith(first))
    rows = []
    for line in lines[start + 2 :]:
        if not line.startswith("|"):
            break
        rows.append([cell.strip() for cell in line.strip("|").split("|")])
    return rows


def test_tests_of_other_people_are_counted_from_their_table():
    rows = _table("others", "| series | numbers | in error |")
    numbers, wrong = (sum(int(row[at]) for row in rows) for at in (1, 2))
    assert f"{numbers - wrong} of {numbers} numbers show no error of the model" in _text(README)
    assert len(rows) == 5 and "four of the five series as a whole are rejected" in _text(README)
    assert sum(row[-1] == "rejected" for row in rows) == 4


def test_distances_and_shares_of_the_sets_are_those_of_their_tables():
    page = _text(f"{EXPLAINED}measured-sets.md")
    pairs = re.compile(r"(-?[\d.]+) ± [\d.]+ / (-?[\d.]+) ± ([\d.]+)")
    rows = _table("sets", "| set | e | mu | Omega |")
    for at, name in enumerate(("e", "mu", "Omega", "E_ln/E_0", "E_lt/E_0", "E_r/E_0"), start=1):
        read = [map(float, pairs.search(row[at].replace("*", "")).groups()) for row in rows]
        rms = (sum(((S - D) / sd) ** 2 for S, D, sd in read) / len(rows)) ** 0.5
        told = float(re.search(rf"([\d.]+) for {re.escape(name)}\b", page)[1])
        assert told == pytest.approx(rms, rel=0.04), name
    shares = _table("sets", "| set | rigid motion, % | vibration, %")
    vibration = {row[0]: float(row[2].split()[0]) for row in shares}
    for value, name in re.findall(r"([\d.]+) % \((t[\w-]+)\)", page):
        assert float(value) == pytest.approx(vibration[name], abs=0.06), name
    assert f"at most {max(vibration.values()):.1f} % in any set" in _text(README)
    plate = sorted(float(row[5].split()[0]) for row in shares)[-10:]
    assert f"{plate[0]:.0f} to {plate[-1]:.0f} %" in _text(README)


def test_what_two_places_of_the_grid_make_of_a_band_is_that_of_the_table():
    told = _text(f"{EXPLAINED}accuracy.md").split("over the thirteen sets ")[1].split("[cost]")[0]
    pairs = []
    for row in _table("cost", "| set | e, limit | E_vib, limit |"):
        one = next(at for at, cell in enumerate(row) if "(default)" in cell)
        pairs.append(
            [[float(number) for number in row[at].split(",")[0].split(" / ")] for at in (one, one + 1)]
        )
    for number in range(2):
        ratios = [two[number] / one[number] for one, two in pairs]
        for stated in (min(ratios), max(ratios), median(ratios)):
            assert f"{stated:.2f}" in told


def test_confirmed_verdicts_are_the_sum_of_their_seeds_and_stand_on_their_page():
    told, page = _text(f"{EXPLAINED}how-sure.md"), _text("docs/evidence/verdicts.md")
    seeds = re.findall(r"(\d+) of (\d+) of (202\d+)", told)
    right, checked = (sum(int(seed[at]) for seed in seeds) for at in range(2))
    assert f"{right} of {checked} are confirmed" in told
    for right, checked, seed in seeds:
        stated = f"{right} of {checked}" in page
        assert seed in page and (stated or f"{checked}: {right} confirm" in page), seed
