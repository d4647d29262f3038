"""The study of slenderness: what it plans, what it asks for once it has results, and what it says of them."""

import json
import re
from dataclasses import replace
from math import pi, sqrt
from types import SimpleNamespace

import numpy as np
import pandas
import pytest
from outcome_maker import altered
from study_fakes import outcome, published

from fem_impact.answers import report as document
from fem_impact.answers.refine.extrapolate import MeshRuns
from fem_impact.answers.refine.work import Levels, LevelsJob
from fem_impact.answers.report import Request
from fem_impact.answers.simulate import simulate
from fem_impact.case.case import Case
from fem_impact.evidence.studies.gamma import OTHER_ANGLES, SETS, conclude, families, others_table, plan
from fem_impact.evidence.studies.gamma_findings import LEVELS, how_sure, meshed_onsets, share
from fem_impact.evidence.studies.gamma_table import (
    ANGLED,
    BY_MESHES,
    CURVE,
    ENDS,
    FIRST,
    HERTZ,
    OTHERS,
    SLACK,
    RodRun,
    crossing,
    exponent,
    rods_of,
    table_of,
)
from fem_impact.evidence.studies.rods import PAPER_RODS, STATES, DroppedRod, length_of
from fem_impact.jobs.job import Failure, Job
from fem_impact.scene.library import surfaces
from fem_impact.scene.shipped import load
from rigid import LIMIT, slenderness

pytestmark = pytest.mark.usefixtures("unrendered")

TOUCH = {"start_s": 0.0, "end_s": 1e-4, "impulse_n_Ns": 0.1, "impulse_t_Ns": 0.0}
AGAIN = {**TOUCH, "start_s": 3e-4, "end_s": 4e-4}


def fake(job):
    """Vibration grows with length; elastic drops touch twice and then hold half; its band is a fifth.

    By modes it depends on friction. e falls with length and angle where the rod can vibrate.
    """
    if isinstance(job, LevelsJob):
        e, rigid = (fake(Job("", scene)).restitution.edge.e for scene in (job.scene, job.twin))
        return levels_of((e, e), (rigid, rigid))
    elastic, cut = "barrier-elastic" in job.scene.effects, job.name.startswith(FIRST)
    length, vibrates = job.scene.projectile.length, "-vibration" not in job.scene.effects
    e = 1.0 - 8 * length**2 * np.sin(job.scene.impact.angle) * vibrates
    if job.fidelity == "modal":
        held = (job.scene.surface.friction - 0.5) ** 2
        return outcome(e_edge=e, contacts=[TOUCH], E_vib_over_E_0=held, fidelity="modal")
    held = 0.05 * length if elastic and not cut else 0.1 * length
    touches = [TOUCH, AGAIN] if elastic and not cut else [TOUCH]
    return banded(held, 0.2 * held, contacts=touches, residual_over_E_0=1e-6)


def levels_of(e, e_rigid):
    """Two levels of a rod and its twin."""
    pairs = [
        [outcome(e_edge=one, contacts=[TOUCH], E_vib_over_E_0=0.01) for one in pair]
        for pair in zip(e, e_rigid, strict=True)
    ]
    return Levels(tuple(MeshRuns(0.5**n, pair) for n, pair in enumerate(pairs)), 2)


def banded(vibration, band, **changed):
    """An outcome whose vibration has a limit with a band."""
    name = "E_vib_over_E_0"
    numbers = {name: vibration, "mesh_limit": {name: vibration}, "mesh_band": {name: band}}
    return outcome(**numbers | changed)


def computed(request, change=lambda name, run: run):
    """All rounds of the study with made-up results."""
    results = {}
    while new := [job for job in plan(request, results) if job.name not in results]:
        results |= {job.name: change(job.name, fake(job)) for job in new}
    return results


@pytest.fixture
def drawn(monkeypatch):
    """The pictures by name, not drawn: drawing is tested with other studies."""
    pictures = {}
    monkeypatch.setattr(document, "_draw", lambda picture, _: pictures.update({picture.name: picture}))
    return pictures


def test_a_drop_says_what_it_is():
    drop = DroppedRod(length_of(57.3, 0.03), 20.0, STATES["machined"], True, 0.03, speed=4.2)
    scene = drop.scene()
    assert slenderness(scene.projectile.length, scene.projectile.diameter) == pytest.approx(57.3)
    assert scene.impact.v_t / scene.impact.v_n == pytest.approx(0.36397, rel=1e-4)
    assert scene.projectile.tip_radius == pytest.approx(0.003 / 0.019 * 0.03)
    assert scene.id == drop.name and scene.measured is None
    assert scene.surface == surfaces()["machined"]
    assert scene.projectile.material == load("t5b").projectile.material


def test_a_drop_has_the_effects_of_a_measured_set_but_for_what_it_states():
    drop = DroppedRod(0.24, friction=STATES["machined"], yields=True)
    watched = {"contact-heating"}
    assert set(Case.of(drop.scene()).active) == set(Case.of(load("t3-machined")).active) - watched
    assert "vibration" not in Case.of(replace(drop, vibrates=False).scene()).active
    elastic = Case.of(replace(drop, yields=False).scene()).active
    assert "barrier-elastic" in elastic and "rod-plasticity" not in elastic


def test_a_drop_takes_the_strength_of_both_steels_from_hardness():
    drop = DroppedRod(0.24, yields=True, law="hardness")
    scene = drop.scene()
    assert scene.projectile.material.law == scene.barrier.material.law == "hardness"
    assert drop.name != replace(drop, law="tensile").name


def dropped(family):
    return {run.rod for run in families(False)[family]}


def test_the_full_study_covers_what_it_promises():
    curve = dropped("curve")
    gammas = sorted({round(d.gamma, 6) for d in curve})
    assert len(gammas) >= 10 and (gammas[0], gammas[-1]) == (10.0, 120.0) and LIMIT in gammas
    assert {d.length for d in curve} >= set(PAPER_RODS.values())
    assert {(d.friction, d.yields) for d in curve} == {(f, y) for f in STATES.values() for y in (False, True)}
    more = dropped("other inputs")
    assert len({d.diameter for d in more}) == len({d.speed for d in more}) == 3
    assert {d.angle for d in more} == {45.0, *OTHER_ANGLES}
    assert {d.law for d in more if d.yields} == {"tensile", "hardness"}
    assert {(d.friction, d.yields) for d in dropped("modes")} == {(d.friction, d.yields) for d in curve}
    assert {run.point for run in families(False)["measured sets"]} == set(SETS)


def test_the_longest_runs_begin(tmp_path):
    times = [job.planned_s for job in plan(Request(tmp_path, quick=True), {})]
    assert times == sorted(times, reverse=True)


def test_rods_run_on_levels_at_two_places_and_their_twins_at_one():
    (run,) = (one for one in families(False)["measured sets"] if one.point == "t5b")
    job, twin = run.job(), run.twin.job()
    assert (job.scene.accuracy.offsets, twin.scene.accuracy.offsets) == (2, 1)
    assert job.way == twin.way == simulate
    assert job.scene.impact == load("t5b").impact != twin.scene.impact


LONG = RodRun(DroppedRod(0.24), "solid")


def point_of(run, results):
    return table_of({CURVE: [run]}, results).iloc[0]


def test_a_second_contact_asks_for_a_cut_run():
    cut = LONG.cut_job({LONG.name: outcome(contacts=[TOUCH, AGAIN])})
    assert cut.name == f"{FIRST}{LONG.point}"
    assert cut.scene.accuracy.max_time == TOUCH["end_s"] + SLACK
    assert LONG.cut_job({LONG.name: outcome(contacts=[TOUCH])}) is None


def test_a_point_has_the_limit_and_the_band_of_its_levels():
    result = banded(0.05, 0.001, contacts=[TOUCH])
    point = point_of(LONG, {LONG.name: altered(result, E_vib_over_E_0=0.04)})
    assert (point.E_vib_over_E_0, point.E_vib_over_E_0_band) == (0.05, 0.001)
    assert (point.E_vib_over_E_0_own_mesh, point.as_wanted, point.reason) == (0.04, True, "")
    assert point_of(LONG, {LONG.name: Failure("x", "folded")}).reason == "folded"


@pytest.mark.long
def test_the_study_says_how_much_where_and_why(tmp_path, drawn):
    request = Request(tmp_path, quick=True)
    results = computed(request)
    found = published(conclude, request, results)
    assert found.text.startswith("# Vibration against slenderness, and when a rod may be called rigid (quick")
    assert "| 0.24 m | yielding | machined | 2.40 ± 0.48 |" in found.text
    assert "| t4 | yielding | 28.65 | 19 | 4.175 | 45 | tensile | 1.20 ± 0.24 |" in found.text
    assert "largest at gamma 70" in found.text and "the longest rod" in found.text
    assert f"gamma <= {LIMIT} calls the 0.08 m rod rigid" in found.text
    assert "0 points have no value or no band" in found.text
    assert json.loads((tmp_path / "study.json").read_text())["runs"] == len(results)
    of_rigid_rods = {"angles", "onset", "static-give", "master", "blind-direction"}
    assert {"vibration", "later-contacts", *of_rigid_rods} == drawn.keys()
    over_gamma = drawn["vibration"].panels[0].series
    assert [series.look for series in over_gamma] == ["joined", "thin"]
    assert all(over_gamma[0].band > 0)
    first, last = drawn["later-contacts"].panels[0].series
    assert first.y == pytest.approx(2 * last.y)
    shares = drawn["vibration"].panels[5].series
    assert {one.look for one in shares} == {"area"}


@pytest.mark.long
def test_vibration_that_falls_is_explained_by_its_later_contacts(tmp_path, drawn):
    """Yielding vibration falls to nothing at gamma 70, with and without a second contact that takes it."""
    request = Request(tmp_path, quick=True)
    fallen = f"yv-{round(length_of(70.0) * 1e6)}"

    def alone(name, run):
        return banded(1e-3, 1e-4) if fallen in name else run

    said = published(conclude, request, computed(request, alone)).text
    assert "mostly because the first contact itself leaves less" in said and "no later one follows" in said

    def given_back(name, run):
        if fallen not in name or name.startswith(FIRST) or "-levels" not in name:
            return run
        return banded(1e-3, 1e-4, contacts=[TOUCH, AGAIN])

    said = published(conclude, request, computed(request, given_back)).text
    assert "mostly because later contacts give energy back" in said

    def hardly(name, run):
        return banded(0.0205, 0.004) if fallen in name and "-levels" in name else run

    said = published(conclude, request, computed(request, hardly)).text
    assert "largest at gamma 57" in said and "beyond it stays within the bands" in said


@pytest.mark.long
def test_a_failed_run_leaves_a_gap_with_its_reason(tmp_path, drawn):
    request = Request(tmp_path, quick=True)
    results = computed(request)
    lost = families(True)["curve"][0].name
    results[lost] = Failure(lost, "folded")
    found = published(conclude, request, results)
    assert found.document["failures"] == [{"scene_id": lost, "error": "folded"}]
    gaps = next(sheet for sheet in found.document["sheets"] if sheet["name"] == "gaps")
    assert gaps["rows"][0][-1] == "folded"
    points = (tmp_path / "points.csv").read_text().splitlines()
    assert len(points) == 1 + sum(map(len, families(True).values()))


def test_other_inputs_are_listed_beside_the_point_of_the_curve():
    usual = DroppedRod(0.24, friction=STATES["machined"], yields=True)
    rods = [
        usual,
        replace(usual, speed=4.2),
        replace(usual, angle=15.0),
        replace(usual, law="hardness"),
        replace(usual, length=length_of(57.3, 0.03), diameter=0.03),
        replace(usual, length=length_of(90.0), speed=1.3),
    ]
    points = pandas.DataFrame([rod.inputs for rod in rods]).assign(
        point="x", family=[CURVE, *[OTHERS] * 5], E_vib_over_E_0=[0.1 * rod.speed for rod in rods]
    )
    shown = [row[3:] for row in others_table(points.assign(E_vib_over_E_0_band=0.01)).rows]
    assert shown == [
        (19.0, 4.2, 45.0, "tensile", "42.00 ± 1.00"),
        (19.0, 2.1, 15.0, "tensile", "21.00 ± 1.00"),
        (19.0, 2.1, 45.0, "hardness", "21.00 ± 1.00"),
        (30.0, 2.1, 45.0, "tensile", "21.00 ± 1.00"),
    ]


def test_points_whose_two_counts_of_vibration_differ_are_counted():
    runs, results = [], {}
    for length, check in ((0.24, 0.0501), (0.12, 0.0526)):
        run = RodRun(DroppedRod(length), "solid")
        counts = {"E_vib_floor_over_E_0": 1e-6, "E_vib_check_over_E_0": check}
        results[run.name] = banded(0.05, abs(check - 0.05), contacts=[TOUCH], **counts)
        runs.append(run)
    points = table_of({CURVE: runs}, results)
    assert points.doubted.tolist() == [False, True]
    assert (
        "of 1 of 2 points within 5% of itself or 0.0002 of E_0; in 1 of the others its two counts"
        in how_sure(points)
    )


@pytest.mark.parametrize(
    ("value", "band", "text"),
    [(-8e-4, 6.1e-3, "less than 0.53 %"), (2.4e-3, 3e-4, "0.24 ± 0.03 %"), (2.4e-3, 3.4e-6, "0.24 ± 0.01 %")],
)
def test_vibration_below_zero_is_a_bound(value, band, text):
    assert share(SimpleNamespace(E_vib_over_E_0=value, E_vib_over_E_0_band=band)) == text


def angles_of(gamma, diameter, error, band=0.0):
    """Rows of a rod that loses ``error`` of e at the second of three angles."""
    columns = {"family": "any", "diameter_m": diameter, "length_m": length_of(gamma, diameter)}
    columns |= {"gamma": gamma, "e_edge_rigid": 1.0, "T1_over_tau_whole": 0.4}
    return [
        columns | {"angle_deg": angle, "e_edge": e, "band_of_change": half, "T1_over_tau": group}
        for angle, e, half, group in zip(
            (1.0, 40.0, 80.0), (1.0, 1.0 - error, 1.0), (0.0, band, 0.0), (0.5, 0.7, 0.6), strict=True
        )
    ]


def rods(*rows):
    return rods_of(pandas.DataFrame([row for rod in rows for row in rod]))


def test_onsets_and_exponents_of_known_curves():
    def error(length, d):
        return 0.05 * (length / (7.0 * d**1.2)) ** 2

    sizes = [(g, d) for d in (0.01, 0.02, 0.04) for g in np.linspace(5.0, 60.0, 400)]
    angles = pandas.DataFrame([row for g, d in sizes for row in angles_of(g, d, error(length_of(g, d), d))])
    every = rods_of(angles)
    some = every[every.diameter_m == 0.02]
    assert exponent(every, 0.05) == pytest.approx(1.2, abs=1e-3)
    assert length_of(crossing(some, 0.05), 0.02) == pytest.approx(7.0 * 0.02**1.2, rel=1e-3)
    assert crossing(some, 5.0) is None
    assert exponent(every, 5.0) is None
    (worst,) = rods(angles_of(20.0, 0.02, 0.3)).itertuples()
    assert (worst.error_of_e, worst.spread_of_e, worst.T1_over_tau) == pytest.approx((0.3, 0.3, 0.7))
    # as rigid as rods come: no error, but e still changes with the angle
    tilted = rods_of(angles[angles.diameter_m == 0.02].assign(e_edge_rigid=angles.e_edge))
    assert crossing(tilted, 0.05) is None
    assert crossing(tilted, 0.05, "spread_of_e") == crossing(some, 0.05)


def test_a_rod_is_measured_against_its_rigid_twin(tmp_path):
    every = table_of({HERTZ[1]: families(True)[HERTZ[1]]}, computed(Request(tmp_path, quick=True)))
    (rod,) = rods_of(every[every.length_m == 0.24]).itertuples()
    assert rod.error_of_e == pytest.approx(8 * 0.24**2 * np.sin(np.radians(70.0)))
    steel = DroppedRod(0.24).scene().projectile.material
    slowest = 22.3733 / 0.24**2 * sqrt(steel.E * 0.019**2 / 16 / steel.rho)  # Euler and Bernoulli, rad/s
    assert rod.T1_over_tau == pytest.approx(2 * pi / slowest / 1e-4, rel=0.03)


def test_the_study_judges_the_limit_of_rigid_behaviour(tmp_path, drawn):
    request = Request(tmp_path, quick=True)
    found = published(conclude, request, computed(request))
    assert "yielding, machined, by finite elements: vibration changes e by" in found.text
    assert "Elastic, frictionless, 45 degrees: vibration changes e by finite elements by" in found.text
    assert "vibrate least at f = 0.50" in found.text
    answer = next(line for line in found.text.splitlines() if "does not keep the error of e below 5%" in line)
    onsets = [float(number) for number in re.findall(r"([\d.]+) \(", answer)]
    assert 10 < onsets[0] <= onsets[1] < 100
    assert "without a loss to vibration" in found.text
    levels = (tmp_path / "levels.csv").read_text().splitlines()
    assert len(levels) == 1 + 2 * len(LEVELS) * sum(name in ANGLED for name in families(True))


def test_every_rod_has_a_rigid_twin_on_the_same_contact(tmp_path):
    jobs = {job.name for job in plan(Request(tmp_path, quick=True), {})}
    modal = {name: [r for r in of if r.way == "modal"] for name, of in families(True).items()}
    assert {run.name for of in modal.values() for run in of} <= jobs
    assert {run.twin.name for name in ANGLED for run in modal.get(name, ())} <= jobs
    assert max(run.rod.angle for name in ANGLED[:4] for run in families(False)[name]) == 80.0


def test_the_yielding_rods_are_those_that_were_promised():
    every = families(False)
    for state, family in BY_MESHES.items():
        rods = [run.rod for run in every[family]]
        assert {round(d.gamma, 9) for d in rods} == {10.0, 15.0, 20.0, LIMIT, 35.0, 50.0, 80.0}
        assert len({d.angle for d in rods}) == 6 and len(set(rods)) == 42
        assert {d.friction for d in rods} == {STATES[state]}
    for quick in (False, True):
        modal = {run.rod for run in families(quick)[HERTZ[1]]}
        assert {run.rod for run in families(quick)[ENDS]} <= modal
    job = BESIDE.job()
    assert set(job.scene.effects) ^ set(job.twin.effects) == {"vibration", "-vibration"}


BESIDE = RodRun(DroppedRod(length_of(10.0), 5.0, STATES["machined"], yields=True), "pair")


def test_levels_that_shift_both_rods_alike_leave_a_tenth_of_the_band_of_e():
    def row_of(**levels):
        table = table_of({BY_MESHES["machined"]: [BESIDE]}, {BESIDE.name: levels_of(**levels)})
        return (*rods_of(table).itertuples(), table.iloc[0])

    rod, row = row_of(e=(0.38, 0.40), e_rigid=(0.28, 0.30))
    half = 0.5 * 0.02 / (2**0.75 - 1)  # three times as wide, as each level runs once, and widened
    assert rod.error_of_e == pytest.approx(0.10) and 0.6 * half < rod.error_high - rod.error_low < 0.8 * half
    assert row.e_edge == 0.40 and rod.T1_over_tau == pytest.approx(BESIDE.rod.first_period / 1e-4)
    rod, _ = row_of(e=(0.38, 0.40), e_rigid=(0.30, 0.30))
    assert (rod.error_of_e, rod.error_high) == pytest.approx((0.10 + half, 0.10 + 4 * half))


def test_a_rod_whose_levels_failed_is_in_the_table_without_numbers():
    row = table_of({"any": [BESIDE, LONG]}, {BESIDE.name: Failure(BESIDE.name, "folded")}).iloc[0]
    assert (row.point, np.isnan(row.e_edge)) == (BESIDE.point, True)


def test_the_onset_has_the_ends_of_its_band():
    some = rods(*(angles_of(gamma, 0.019, 0.01 * (gamma - 10.0), 0.02) for gamma in (10.0, 20.0, 30.0)))
    onsets = [crossing(some, 0.1, measure) for measure in ("error_high", "error_of_e", "error_low")]
    assert onsets == pytest.approx([18.0, 20.0, 22.0])
    (sentence,) = meshed_onsets({BY_MESHES["machined"]: some})
    assert "10% beyond gamma 20.0 (18 to 22)" in sentence
