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
from fem_impact.case.case import Case
from fem_impact.evidence.studies.gamma import (
    ANGLES,
    SETS,
    SIZES,
    conclude,
    families,
    how_sure,
    other_inputs,
    plan,
    share,
)
from fem_impact.evidence.studies.pairs import with_limits
from fem_impact.evidence.studies.rod_runs import (
    FIRST,
    MOST,
    SLACK,
    mesh_runs,
    more_jobs,
    points_of,
    run_table,
)
from fem_impact.evidence.studies.rods import PAPER_RODS, STATES, DroppedRod, length_of
from fem_impact.evidence.studies.sets import HALF_CELL, jobs_of
from fem_impact.jobs.job import Failure
from fem_impact.outcome.record import KEY_TABLE
from fem_impact.run.simulate import simulate
from fem_impact.scene.library import surfaces
from fem_impact.scene.shipped import load
from fem_impact.scene.types import Accuracy, Save
from rigid import LIMIT, slenderness

TOUCH = {"start_s": 0.0, "end_s": 1e-4, "impulse_n_Ns": 0.1, "impulse_t_Ns": 0.0}
AGAIN = {**TOUCH, "start_s": 3e-4, "end_s": 4e-4}
HOURS, CORES = 2.5, 2  # that the whole study may take


def fake(job):
    """Vibration grows with length; elastic drops touch twice and then hold half; coarser meshes see less."""
    elastic, cut = "barrier-elastic" in job.scene.effects, job.name.startswith(FIRST)
    size = job.scene.accuracy.tip_size or 0.0
    share = 0.1 * job.scene.projectile.length * (1 - 50 * size)
    held = 0.5 * share if elastic and not cut else share
    touches = [TOUCH, AGAIN] if elastic and not cut and job.fidelity == "solid" else [TOUCH]
    return outcome(
        E_vib_over_E_0=held,
        contacts=touches,
        fidelity=job.fidelity,
        tip_size_m=size or 4e-4,
        residual_over_E_0=1e-6,
    )


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


@pytest.mark.slow
def test_the_whole_study_fits_its_time_and_begins_with_the_longest(tmp_path):
    """Even if every second point but the measured sets asks for a finer mesh, and every fifth for another."""
    times = [job.planned_s for job in plan(Request(tmp_path), {})]
    assert times == sorted(times, reverse=True)
    drawn = [run for name in ("curve", "other inputs") for run in families(False)[name]]
    finer, finest = (
        sum(s for run in drawn if run.size == size and (s := run.job().planned_s) <= MOST)
        for size in SIZES[2:]
    )
    assert sum(times) + finer / 2 + finest / 5 < HOURS * 3600 * CORES


def test_the_quick_study_fits_a_minute_and_begins_with_the_longest(tmp_path):
    times = [job.planned_s for job in plan(Request(tmp_path, quick=True), {})]
    assert times == sorted(times, reverse=True)
    assert sum(times) < 60 * CORES


@pytest.mark.parametrize("name", SETS)
def test_measured_sets_run_on_the_meshes_of_their_own_study(tmp_path, name):
    mine = [run for run in families(False)["measured sets"] if run.point == name]
    theirs = jobs_of(name, False, tmp_path)
    kinds = [kind for mesh in ("coarse", "fine") for kind in (mesh, f"{mesh}-{HALF_CELL}")]
    for run, kind in zip(mine, kinds, strict=True):
        scene, other = run.job().scene, theirs[kind].scene
        apart = {"accuracy": Accuracy(), "save": Save()}
        assert replace(scene, **apart) == replace(other, **apart)
        assert Case.of(scene).zones == Case.of(other).zones
        assert scene.accuracy.grid_shift == other.accuracy.grid_shift


LONG = mesh_runs(DroppedRod(0.24), SIZES, (0.0,))
NAME = LONG[0].point


def more_names(results):
    return [job.name for job in more_jobs(run_table({"curve": LONG}, results), results)]


def point_of(runs, results):
    return points_of(run_table({"curve": runs}, results), results).iloc[0]


def test_a_wide_band_asks_for_a_finer_mesh_and_a_second_contact_for_a_cut_run():
    same = {
        f"{NAME}-x{at:g}": outcome(E_vib_over_E_0=0.05, contacts=[TOUCH, AGAIN], tip_size_m=at * 1e-4)
        for at in (1, 2)
    }
    (cut,) = more_jobs(run_table({"curve": LONG}, same), same)
    assert cut.name == f"{FIRST}{NAME}"
    assert cut.scene.accuracy.max_time == TOUCH["end_s"] + SLACK
    apart = same | {f"{NAME}-x2": outcome(E_vib_over_E_0=0.04, contacts=[TOUCH], tip_size_m=2e-4)}
    assert more_names(apart) == [f"{NAME}-x0.5", cut.name]
    still = apart | {f"{NAME}-x0.5": outcome(E_vib_over_E_0=0.06, contacts=[TOUCH], tip_size_m=5e-5)}
    assert more_names(still) == [f"{NAME}-x0.5", f"{NAME}-x0.25", cut.name]
    settled = still | {f"{NAME}-x0.5": outcome(E_vib_over_E_0=0.05, contacts=[TOUCH], tip_size_m=5e-5)}
    assert more_names(settled) == [f"{NAME}-x0.5", cut.name]


def test_the_band_of_a_point_is_that_of_its_two_finest_meshes():
    runs = {
        size: outcome(E_vib_over_E_0=0.05 - 0.01 * size, contacts=[TOUCH], tip_size_m=size * 1e-4)
        for size in SIZES
    }
    results = {f"{NAME}-x{size:g}": run for size, run in runs.items()}

    def estimates(failed=None):
        lost = {f"{NAME}-x{failed:g}": Failure("x", "folded")} if failed else {}
        point = point_of(LONG, results | lost)
        return point.E_vib_over_E_0, point.E_vib_over_E_0_band

    def of_pair(fine, coarse):
        return with_limits([runs[fine]], [runs[coarse]]).estimate(KEY_TABLE["E_vib_over_E_0"])

    point = point_of(LONG, results)
    assert (point.E_vib_over_E_0_own_mesh, point.reason) == (0.04, "")
    assert estimates() == of_pair(0.25, 0.5)
    assert estimates(failed=0.25) == of_pair(0.5, 1.0)
    assert estimates(failed=0.5) == of_pair(1.0, 2.0)
    assert point_of(LONG, results | {f"{NAME}-x1": Failure("x", "folded")}).reason == "folded"


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
        return altered(run, E_vib_over_E_0=1e-3, E_vib_check_over_E_0=1e-3) if fallen in name else run

    said = published(conclude, request, computed(request, alone)).text
    assert "mostly because the first contact itself leaves less" in said and "no later one follows" in said

    def given_back(name, run):
        if fallen not in name or name.startswith(FIRST) or "-x" not in name:
            return run
        return altered(run, E_vib_over_E_0=1e-3, E_vib_check_over_E_0=1e-3, contacts=[TOUCH, AGAIN])

    said = published(conclude, request, computed(request, given_back)).text
    assert "mostly because later contacts give energy back" in said

    def hardly(name, run):
        shares = {"x2": 0.0205, "x4": 0.0165}
        return altered(run, E_vib_over_E_0=shares[name[-2:]]) if fallen in name and "-x" in name else run

    said = published(conclude, request, computed(request, hardly)).text
    assert "largest at gamma 57" in said and "beyond it stays within the bands" in said


def test_a_failed_run_leaves_a_gap_with_its_reason(tmp_path, drawn):
    request = Request(tmp_path, quick=True)
    results = computed(request)
    lost = next(run.name for run in families(True)["curve"] if run.size == 2.0)
    results[lost] = Failure(lost, "folded")
    found = published(conclude, request, results)
    assert found.document["failures"] == [{"scene_id": lost, "error": "folded"}]
    gaps = next(sheet for sheet in found.document["sheets"] if sheet["name"] == "gaps")
    assert gaps["rows"][0][-1] == "folded"
    points = (tmp_path / "points.csv").read_text().splitlines()
    every = {run.point for runs in families(True).values() for run in runs if run.fidelity == "solid"}
    assert len(points) == 1 + len(every)


def test_a_point_by_finite_elements(tmp_path):
    """The smallest rod on two coarse meshes: a value with a band, a closed ledger, a contact time."""
    runs = mesh_runs(
        DroppedRod(length_of(10.0), friction=STATES["machined"], yields=True), (4.0, 2.0), (0.0,)
    )
    results = {run.name: simulate(run.job().scene, "solid") for run in (*runs, runs[0].twin)}
    point = point_of(runs, results)
    assert point.reason == "" and point.E_vib_over_E_0_band > 0
    assert abs(point.residual_over_E_0) < 1e-4
    assert 0.1 < point.T1_over_tau < 0.5
    assert point.e_edge == pytest.approx(point.e_edge_rigid, abs=0.05)


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
    counts = {"E_vib_over_E_0": 0.05, "E_vib_floor_over_E_0": 1e-6, "contacts": [TOUCH], "tip_size_m": 1e-4}
    runs, results = [], {}
    for length, check in ((0.24, 0.0501), (0.12, 0.0526)):
        coarse, fine = pair = mesh_runs(DroppedRod(length), SIZES[:2], (0.0,))
        results[fine.name] = outcome(**counts, E_vib_check_over_E_0=check)
        results[coarse.name] = altered(outcome(**counts), tip_size_m=2e-4)
        runs += pair
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
