"""The gamma study: what it plans, what it asks for once it has results, and what it says of them."""

import json
from dataclasses import replace

import pytest
from outcome_maker import altered
from study_fakes import outcome, published

from fem_impact.answers import report as document
from fem_impact.answers.report import Request
from fem_impact.case.case import Case
from fem_impact.evidence.studies.gamma import (
    ANGLES,
    FULL,
    MOST,
    SETS,
    conclude,
    line,
    members,
    others,
    plan,
    reduced,
)
from fem_impact.evidence.studies.gamma_findings import Curves, how_sure, other_inputs, share
from fem_impact.evidence.studies.gamma_points import (
    FIRST,
    SLACK,
    Member,
    Point,
    first_jobs,
    more_jobs,
    point_of,
)
from fem_impact.evidence.studies.pairs import with_limits
from fem_impact.evidence.studies.rods import PAPER_RODS, STATES, Drop, length_of
from fem_impact.evidence.studies.sets import HALF_CELL, jobs_of
from fem_impact.jobs.job import Failure
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
    drop = Drop(length_of(57.3, 0.03), 20.0, STATES["machined"], True, 0.03, speed=4.2)
    scene = drop.scene()
    assert slenderness(scene.projectile.length, scene.projectile.diameter) == pytest.approx(57.3)
    assert scene.impact.v_t / scene.impact.v_n == pytest.approx(0.36397, rel=1e-4)
    assert scene.projectile.tip_radius == pytest.approx(0.003 / 0.019 * 0.03)
    assert scene.id == drop.name and scene.measured is None
    assert scene.surface == surfaces()["machined"]
    assert scene.projectile.material == load("t5b").projectile.material


def test_a_drop_has_the_effects_of_a_measured_set_but_for_what_it_states():
    drop = Drop(0.24, friction=STATES["machined"], yields=True)
    watched = {"contact-heating"}
    assert set(Case.of(drop.scene()).active) == set(Case.of(load("t3-machined")).active) - watched
    assert "vibration" not in Case.of(replace(drop, vibrates=False).scene()).active
    elastic = Case.of(replace(drop, yields=False).scene()).active
    assert "barrier-elastic" in elastic and "rod-plasticity" not in elastic


def test_a_drop_takes_the_strength_of_both_steels_from_hardness():
    drop = Drop(0.24, yields=True, law="hardness")
    scene = drop.scene()
    assert scene.projectile.material.law == scene.barrier.material.law == "hardness"
    assert drop.name != replace(drop, law="tensile").name


def test_the_full_study_covers_what_it_promises():
    curve = line(False)
    gammas = sorted({round(d.gamma, 6) for d in curve})
    assert len(gammas) >= 10 and (gammas[0], gammas[-1]) == (10.0, 120.0) and LIMIT in gammas
    assert {d.length for d in curve} >= set(PAPER_RODS.values())
    assert {(d.friction, d.yields) for d in curve} == {(f, y) for f in STATES.values() for y in (False, True)}
    more = others(False)
    assert len({d.diameter for d in more}) == len({d.speed for d in more}) == 3
    assert {d.angle for d in more} == {45.0, *ANGLES}
    assert {d.law for d in more if d.yields} == {"tensile", "hardness"}
    assert {(d.friction, d.yields) for d in reduced(False)} == {(d.friction, d.yields) for d in curve}
    assert {one.name for one in members(False)} >= set(SETS)


@pytest.mark.slow
def test_the_whole_study_fits_its_time_and_begins_with_the_longest(tmp_path):
    """Even if every second point but the measured sets asks for a finer mesh, and every fifth for another."""
    times = [job.planned_s for job in plan(Request(tmp_path), {})]
    assert times == sorted(times, reverse=True)
    drawn = [one for one in members(False) if one.name not in SETS]
    finer, finest = (
        sum(job.planned_s for one in drawn for job in one.jobs(factor) if job.planned_s <= MOST)
        for factor in FULL.finer
    )
    assert sum(times) + finer / 2 + finest / 5 < HOURS * 3600 * CORES


def test_the_quick_study_fits_a_minute_and_begins_with_the_longest(tmp_path):
    times = [job.planned_s for job in plan(Request(tmp_path, quick=True), {})]
    assert times == sorted(times, reverse=True)
    assert sum(times) < 60 * CORES


@pytest.mark.parametrize("name", SETS)
def test_measured_sets_run_on_the_meshes_of_their_own_study(tmp_path, name):
    one = next(member for member in members(False) if member.name == name)
    mine, theirs = (one.jobs(FULL.own), one.jobs(FULL.second)), jobs_of(name, False, tmp_path)
    for jobs, mesh in zip(mine, ("fine", "coarse"), strict=True):
        for job, kind in zip(jobs, (mesh, f"{mesh}-{HALF_CELL}"), strict=True):
            other = theirs[kind].scene
            apart = {"accuracy": Accuracy(), "save": Save()}
            assert replace(job.scene, **apart) == replace(other, **apart)
            assert Case.of(job.scene).zones == Case.of(other).zones
            assert job.scene.accuracy.grid_shift == other.accuracy.grid_shift


def test_a_wide_band_asks_for_a_finer_mesh_and_a_second_contact_for_a_cut_run():
    one = Member("long", Drop(0.24).scene(), Drop(0.24))
    (own,), (second,) = (one.jobs(factor) for factor in (FULL.own, FULL.second))
    same = {
        job.name: outcome(E_vib_over_E_0=0.05, contacts=[TOUCH, AGAIN], tip_size_m=size)
        for job, size in ((own, 1e-4), (second, 2e-4))
    }
    (cut,) = more_jobs(one, FULL, same)
    assert cut.name == f"{FIRST}long"
    assert cut.scene.accuracy.max_time == TOUCH["end_s"] + SLACK
    apart = same | {second.name: outcome(E_vib_over_E_0=0.04, contacts=[TOUCH], tip_size_m=2e-4)}
    assert [job.name for job in more_jobs(one, FULL, apart)] == ["long-x0.5", cut.name]
    still = apart | {"long-x0.5": outcome(E_vib_over_E_0=0.06, contacts=[TOUCH], tip_size_m=5e-5)}
    assert [job.name for job in more_jobs(one, FULL, still)] == ["long-x0.5", "long-x0.25", cut.name]
    settled = still | {"long-x0.5": outcome(E_vib_over_E_0=0.05, contacts=[TOUCH], tip_size_m=5e-5)}
    assert [job.name for job in more_jobs(one, FULL, settled)] == ["long-x0.5", cut.name]


def test_the_band_of_a_point_is_that_of_its_two_finest_meshes():
    one = Member("long", Drop(0.24).scene(), Drop(0.24))
    runs = {
        factor: outcome(E_vib_over_E_0=0.05 - 0.01 * factor, contacts=[TOUCH], tip_size_m=factor * 1e-4)
        for factor in (0.25, 0.5, 1.0, 2.0)
    }
    results = {f"long-x{factor:g}": run for factor, run in runs.items()}
    point = point_of(one, FULL, results)
    assert point.run == with_limits([runs[0.25]], [runs[0.5]])
    assert (point.own, point.gap) == (0.04, "")
    lost = results | {"long-x0.25": Failure("x", "folded")}
    assert point_of(one, FULL, lost).run == with_limits([runs[0.5]], [runs[1.0]])
    lost = results | {"long-x0.5": Failure("x", "folded")}
    assert point_of(one, FULL, lost).run == with_limits([runs[1.0]], [runs[2.0]])
    lost = results | {"long-x1": Failure("x", "folded")}
    assert point_of(one, FULL, lost).gap == "folded"


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
    assert [one.look for one in over_gamma] == ["joined", "thin"]
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
        return altered(run, E_vib_over_E_0=1e-3) if fallen in name else run

    said = published(conclude, request, computed(request, alone)).text
    assert "mostly because the first contact itself leaves less" in said and "no later one follows" in said

    def given_back(name, run):
        if fallen not in name or name.startswith(FIRST) or "-x" not in name:
            return run
        return altered(run, E_vib_over_E_0=1e-3, contacts=[TOUCH, AGAIN])

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
    lost = f"{line(True)[0].name}-x2"
    results[lost] = Failure(lost, "folded")
    found = published(conclude, request, results)
    assert found.document["failures"] == [{"scene_id": lost, "error": "folded"}]
    gaps = next(sheet for sheet in found.document["sheets"] if sheet["name"] == "gaps")
    assert gaps["rows"][0][-1] == "folded"
    points = (tmp_path / "points.csv").read_text().splitlines()
    assert len(points) == 1 + len(members(True))


def test_a_point_by_finite_elements(tmp_path):
    """The smallest drop on two coarse meshes: a value with a band, a closed ledger, a contact time."""
    drop = Drop(length_of(10.0), friction=STATES["machined"], yields=True)
    meshes = replace(FULL, own=2.0, second=4.0, finer=())
    one = Member("short", drop.scene(), drop)
    results = {job.name: simulate(job.scene, "solid") for job in first_jobs(one, meshes)}
    point = point_of(one, meshes, results)
    assert point.gap == "" and point.band("E_vib_over_E_0") > 0
    assert abs(point.run.energy.residual) < 1e-4
    assert 0.1 < point.ratio < 0.5
    assert point.value("e_edge") == pytest.approx(point.e_rigid, abs=0.05)


def test_other_inputs_are_told_beside_the_point_of_the_curve(monkeypatch):
    monkeypatch.setattr(Point, "value", lambda self, name: 0.1 * self.drop.speed)
    monkeypatch.setattr(Point, "band", lambda self, name: 0.01)
    usual = Drop(0.24, friction=STATES["machined"], yields=True)
    drops = [
        usual,
        replace(usual, speed=4.2),
        replace(usual, angle=15.0),
        replace(usual, law="hardness"),
        replace(usual, length=length_of(57.3, 0.03), diameter=0.03),
        replace(usual, length=length_of(90.0), speed=1.3),
    ]
    points = [Point(d.name, d, Failure(d.name, "none"), None, None, None, None) for d in drops]
    assert other_inputs(Curves(points[:1], points[1:], [], []), yields=True) == (
        "Other inputs at gamma 57, yielding, machined: vibration is 21.00 ± 1.00 % of E_0 on the curve "
        "(19 mm, 2.1 m/s, 45 degrees), and with 4.2 m/s 42.00 ± 1.00 %, 15 degrees 21.00 ± 1.00 %, "
        "strength from hardness 21.00 ± 1.00 %, 30 mm 21.00 ± 1.00 %."
    )
    assert other_inputs(Curves(points[:1], points[1:], [], []), yields=False) == ""


def test_points_whose_two_counts_of_vibration_differ_are_counted():
    counts = {"E_vib_over_E_0": 0.05, "E_vib_floor_over_E_0": 1e-6, "contacts": [TOUCH], "tip_size_m": 1e-4}
    meshes = replace(FULL, finer=())
    points = []
    for name, check in (("sure", 0.0501), ("apart", 0.0526)):
        one = Member(name, Drop(0.24).scene(), Drop(0.24))
        (own,), (second,) = (one.jobs(factor) for factor in (meshes.own, meshes.second))
        runs = {own.name: outcome(**counts, E_vib_check_over_E_0=check), second.name: outcome(**counts)}
        runs[second.name] = altered(runs[second.name], tip_size_m=2e-4)
        points.append(point_of(one, meshes, runs))
    assert [point.doubted for point in points] == [False, True]
    assert "of 2 of 2 points within 5% of itself or 0.0002 of E_0; in 1 of them its two counts" in how_sure(
        points
    )


def test_vibration_below_zero_is_told_as_a_bound(monkeypatch):
    point = Point("rod", Drop(0.08), Failure("rod", "none"), None, None, None, None)
    cases = (
        (-8e-4, 6.1e-3, "less than 0.53 %"),
        (2.4e-3, 3e-4, "0.24 ± 0.03 %"),
        (2.4e-3, 3.4e-6, "0.24 ± 0.01 %"),
    )
    for value, band, told in cases:
        monkeypatch.setattr(Point, "value", lambda self, name, v=value: v)
        monkeypatch.setattr(Point, "band", lambda self, name, b=band: b)
        assert share(point) == told
