"""The gamma study: what it plans, what it asks for once it has results, and what it says of them."""

import json
from dataclasses import replace
from types import SimpleNamespace

import pandas
import pytest
from outcome_maker import altered
from study_fakes import outcome, published

from fem_impact.answers import report as document
from fem_impact.answers.report import Request
from fem_impact.answers.simulate import simulate
from fem_impact.case.case import Case
from fem_impact.evidence.studies.gamma import (
    ANGLES,
    SETS,
    conclude,
    families,
    how_sure,
    other_inputs,
    plan,
    share,
)
from fem_impact.evidence.studies.rods import (
    FIRST,
    PAPER_RODS,
    SLACK,
    STATES,
    DroppedRod,
    RodRun,
    cut_job,
    length_of,
    points_of,
    run_table,
)
from fem_impact.jobs.job import Failure
from fem_impact.scene.library import surfaces
from fem_impact.scene.shipped import load
from rigid import LIMIT, slenderness

pytestmark = pytest.mark.usefixtures("unrendered")

TOUCH = {"start_s": 0.0, "end_s": 1e-4, "impulse_n_Ns": 0.1, "impulse_t_Ns": 0.0}
AGAIN = {**TOUCH, "start_s": 3e-4, "end_s": 4e-4}


def fake(job):
    """Vibration grows with length; elastic drops touch twice and then hold half; its band is a fifth."""
    elastic, cut = "barrier-elastic" in job.scene.effects, job.name.startswith(FIRST)
    share = 0.1 * job.scene.projectile.length
    held = 0.5 * share if elastic and not cut else share
    touches = [TOUCH, AGAIN] if elastic and not cut and job.fidelity == "solid" else [TOUCH]
    return banded(held, 0.2 * held, contacts=touches, fidelity=job.fidelity, residual_over_E_0=1e-6)


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


def rods_of(family):
    return {run.rod for run in families(False)[family]}


def test_the_full_study_covers_what_it_promises():
    curve = rods_of("curve")
    gammas = sorted({round(d.gamma, 6) for d in curve})
    assert len(gammas) >= 10 and (gammas[0], gammas[-1]) == (10.0, 120.0) and LIMIT in gammas
    assert {d.length for d in curve} >= set(PAPER_RODS.values())
    assert {(d.friction, d.yields) for d in curve} == {(f, y) for f in STATES.values() for y in (False, True)}
    more = rods_of("other inputs")
    assert len({d.diameter for d in more}) == len({d.speed for d in more}) == 3
    assert {d.angle for d in more} == {45.0, *ANGLES}
    assert {d.law for d in more if d.yields} == {"tensile", "hardness"}
    assert {(d.friction, d.yields) for d in rods_of("modes")} == {(d.friction, d.yields) for d in curve}
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
    return points_of(run_table({"curve": [run]}, results), results).iloc[0]


def test_a_second_contact_asks_for_a_cut_run():
    cut = cut_job(LONG, outcome(contacts=[TOUCH, AGAIN]))
    assert cut.name == f"{FIRST}{LONG.point}"
    assert cut.scene.accuracy.max_time == TOUCH["end_s"] + SLACK
    assert cut_job(LONG, outcome(contacts=[TOUCH])) is None


def test_a_point_has_the_limit_and_the_band_of_its_levels():
    result = banded(0.05, 0.001, contacts=[TOUCH])
    point = point_of(LONG, {LONG.name: altered(result, E_vib_over_E_0=0.04)})
    assert (point.E_vib_over_E_0, point.E_vib_over_E_0_band) == (0.05, 0.001)
    assert (point.E_vib_over_E_0_own_mesh, point.band_as_wanted, point.reason) == (0.04, "yes", "")
    assert point_of(LONG, {LONG.name: Failure("x", "folded")}).reason == "folded"


def test_the_study_says_how_much_where_and_why(tmp_path, drawn):
    request = Request(tmp_path, quick=True)
    results = computed(request)
    found = published(conclude, request, results)
    assert "tip (machined, 45 degrees, 2.1 m/s) leaves as vibration" in found.text
    assert "(0.24 m rod)" in found.text
    assert "largest at gamma 70" in found.text and "the longest rod" in found.text
    assert f"gamma <= {LIMIT} calls the 0.08 m rod rigid" in found.text
    assert "0 points have no value or no band" in found.text
    assert json.loads((tmp_path / "study.json").read_text())["runs"] == len(results)
    assert {"vibration", "later-contacts"} == drawn.keys()
    over_gamma = drawn["vibration"].panels[0].series
    assert [series.look for series in over_gamma] == ["joined", "thin"]
    assert all(over_gamma[0].band > 0)
    first, last = drawn["later-contacts"].panels[0].series
    assert first.y == pytest.approx(2 * last.y)
    shares = drawn["vibration"].panels[5].series
    assert {one.look for one in shares} == {"area"}


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
    every = {run.point for runs in families(True).values() for run in runs if run.fidelity == "solid"}
    assert len(points) == 1 + len(every)


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
    families = ["curve", *["other inputs"] * 5]
    values = [
        {"family": family, "E_vib_over_E_0": 0.1 * rod.speed, "E_vib_over_E_0_band": 0.01}
        for family, rod in zip(families, rods, strict=True)
    ]
    points = pandas.DataFrame([rod.inputs | row for rod, row in zip(rods, values, strict=True)], dtype=object)
    assert other_inputs(points, "yielding") == (
        "Other inputs at gamma 57, yielding, machined: vibration is 21.00 ± 1.00 % of E_0 on the curve "
        "(19 mm, 2.1 m/s, 45 degrees), and with 4.2 m/s 42.00 ± 1.00 %, 15 degrees 21.00 ± 1.00 %, "
        "strength from hardness 21.00 ± 1.00 %, 30 mm 21.00 ± 1.00 %."
    )
    assert other_inputs(points, "elastic") == ""


def test_points_whose_two_counts_of_vibration_differ_are_counted():
    runs, results = [], {}
    for length, check in ((0.24, 0.0501), (0.12, 0.0526)):
        run = RodRun(DroppedRod(length), "solid")
        counts = {"E_vib_floor_over_E_0": 1e-6, "E_vib_check_over_E_0": check}
        results[run.name] = banded(0.05, abs(check - 0.05), contacts=[TOUCH], **counts)
        runs.append(run)
    points = points_of(run_table({"curve": runs}, results), results)
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
