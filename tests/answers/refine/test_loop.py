"""A target error for a scene whose like was not measured, and a cost study within a time."""

import dataclasses
import re
from pathlib import Path

import cost_fakes
import pytest
from cost_fakes import Here, run
from wide_contact import WIDE

import fem_impact.run.simulate
from fem_impact.answers import wanted_error as to_target
from fem_impact.answers.cost.measure import affordable, measure
from fem_impact.answers.cost.settings import settings_of
from fem_impact.answers.refine import budget as budgets
from fem_impact.answers.refine import levels as levels_module
from fem_impact.answers.refine.budget import LONGER
from fem_impact.answers.refine.extrapolate import ALONE, MeshRuns
from fem_impact.answers.refine.levels import (
    FAMILY,
    FEW_OFFSETS,
    MESH_LEVELS,
    at_offsets,
    family,
    mesh_levels,
    on_mesh,
)
from fem_impact.answers.wanted_error import RefinementPlan, achieved_error, settle
from fem_impact.case.case import Case
from fem_impact.cli.run import print_outcome
from fem_impact.errors import RunError, SceneError, UsageError
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import Unknown
from fem_impact.outcome.limitation import texts
from fem_impact.progress import NullMeter
from fem_impact.scene.shipped import load, replace, replace_all

FAR = replace_all(load("t5b"), {"impact.omega": "30 rad/s", "accuracy": "20 %"})


@pytest.fixture
def summary(capsys):
    """Return a function that gives what the command prints of an outcome."""

    def printed(outcome):
        print_outcome(outcome, Path("out"))
        return capsys.readouterr().out

    return printed


@pytest.fixture
def fake(monkeypatch):
    monkeypatch.setattr(fem_impact.run.simulate, "simulate", run)


def test_a_scene_far_from_every_measured_one_gets_a_ladder_of_its_own():
    chosen = settle(FAR, budget_s=30.0)
    assert isinstance(chosen, RefinementPlan)
    assert "nearest scene with a measured cost" in chosen.sentence and "30 s" in chosen.sentence
    with pytest.raises(SceneError, match="cannot be judged"):
        settle(FAR, "rigid")


def test_the_ladder_ends_where_the_band_is_narrow_enough(fake, tmp_path):
    outcome = to_target.simulate(FAR, options=RunOptions(out=tmp_path), budget_s=1e9)
    stated = outcome.validity
    assert 0 < stated.achieved_error <= 0.2
    assert stated.accuracy_setting.startswith("2 meshes of its own")
    assert isinstance(stated.expected_error, Unknown)
    assert stated.mesh_band["e_edge"] > 0
    assert (tmp_path / "outcome.json").exists()
    finer = to_target.simulate(replace(FAR, "accuracy", "0.001 %"), budget_s=1e9)
    assert finer.validity.accuracy_setting.startswith(f"{len(MESH_LEVELS)} meshes")
    assert finer.validity.achieved_error > 1e-5  # not reached, and said


def test_a_rod_that_cannot_vibrate_is_judged_by_e_alone(fake, summary):
    rigid = replace(FAR, "effects", ["auto", "-vibration"])
    outcome = to_target.simulate(rigid, budget_s=1e9)
    vibrating = to_target.simulate(replace(FAR, "accuracy", "50 %"), budget_s=1e9)
    assert 0 < outcome.validity.achieved_error <= 0.2
    told = summary(outcome)
    assert "achieved error of e " in told and "all runs together: e (tip's arms) 0.3" in told
    assert "E_vib" not in told.split("asked for")[1]
    assert "achieved error of e and E_vib" in summary(vibrating)


def test_a_run_that_knows_no_e_ends_the_ladder(monkeypatch):
    def restless(scene, *rest):
        made = run(scene, *rest)
        arms = dataclasses.replace(made.restitution.edge, e=Unknown("gravity made it no impact"))
        return dataclasses.replace(made, restitution=dataclasses.replace(made.restitution, edge=arms))

    monkeypatch.setattr(fem_impact.run.simulate, "simulate", restless)
    with pytest.raises(RunError, match="e is not known: gravity made it no impact"):
        to_target.simulate(FAR, budget_s=1e9)


def test_the_ladder_stops_before_its_time_is_over(fake, monkeypatch):
    seconds = iter(range(0, 10000, 40))
    monkeypatch.setattr(budgets, "perf_counter", lambda: float(next(seconds)))
    outcome = to_target.simulate(replace(FAR, "accuracy", "0.001 %"), budget_s=60.0)
    stated = outcome.validity
    assert stated.accuracy_setting.startswith("1 mesh of its own")
    assert stated.achieved_error == stated.mesh_limit == stated.mesh_band == ALONE  # a mean is no limit


def asked(monkeypatch, budget_s, workers=1):
    """Return the plan for `FAR` in a budget, the mesh and place of each of its runs, and its outcome."""
    places = []

    def noted(scene, *rest):
        places.append((scene.accuracy.tip_size, scene.accuracy.grid_shift))
        return run(scene, *rest)

    monkeypatch.setattr(fem_impact.run.simulate, "simulate", noted)
    chosen = settle(FAR, workers=workers, budget_s=budget_s)
    return chosen, places, to_target.simulate(FAR, workers=1, chosen=chosen)


@pytest.fixture
def on_plan(monkeypatch):
    """Let runs take what they are planned to take, and the clock stand still."""
    monkeypatch.setattr(budgets, "calibration_factor", lambda *_: 1.0)
    monkeypatch.setattr(budgets, "perf_counter", lambda: 0.0)


def test_a_budget_below_two_meshes_is_told_before_the_coarsest_runs_once(on_plan, monkeypatch):
    sizes = [mesh.sizes(FAR)[0] for mesh in FAMILY]
    one, both = (sum(Case.of(on_mesh(FAR, mesh)).size.time for mesh in FAMILY[:n]) for n in (1, 2))
    chosen, places, outcome = asked(monkeypatch, 0.5 * one)
    assert places == [(pytest.approx(sizes[0]), 0.0)]
    assert (chosen.least_s, chosen.pair_s) == pytest.approx((one, both))
    assert outcome.validity.expected_wall == chosen.least_s
    assert f"about {float(f'{one:.2g}'):.0f} s, which exceeds the budget" in chosen.sentence
    assert "error stays unknown" in chosen.sentence and '--budget "' in chosen.sentence
    chosen, places, outcome = asked(monkeypatch, 0.9 * (both - one))
    assert len(places) == 1 and "exceeds" not in chosen.sentence
    assert texts(outcome.validity.limitations)[-1] == (
        "The wanted 20 % is not reached: one mesh alone cannot estimate its own error. One mesh finer takes "
        f'about {both - one:.0f} s more: for that give --budget "{LONGER * (both - one):.0f} s".'
    )
    assert len(asked(monkeypatch, LONGER * (both - one))[1]) > 1


def test_a_budget_below_two_places_of_two_meshes_takes_one_place_each(on_plan, monkeypatch):
    both = sum(Case.of(on_mesh(FAR, mesh)).size.time for mesh in FAMILY[:2])
    chosen, places, outcome = asked(monkeypatch, 1.5 * both)
    assert {place for _, place in places} == {0.0} and len(places) >= 2
    assert outcome.validity.achieved_error > 0
    assert f"planned to take {float(f'{both:.2g}'):.0f} s" in chosen.sentence
    assert not [text for text in texts(outcome.validity.limitations) if "more than the budget" in text]
    two_places = [(size, place) for size, _ in places[:2] for place in (0.0, 0.5)]
    assert asked(monkeypatch, 10 * both)[1] == two_places


def test_what_the_first_run_took_decides_how_far_the_ladder_climbs(on_plan, monkeypatch):
    """A rod that leaves earlier than planned leaves time for a second place, or for a finer mesh."""
    whole = sum(Case.of(one).size.time for mesh in FAMILY[:2] for one in at_offsets(FAR, mesh, FEW_OFFSETS))
    assert {place for _, place in asked(monkeypatch, 0.5 * whole)[1]} == {0.0}
    monkeypatch.setattr(budgets, "calibration_factor", lambda *_: 0.4)
    _, places, outcome = asked(monkeypatch, 0.5 * whole)
    assert [place for _, place in places] == [0.0, 0.5, 0.0, 0.5]
    assert outcome.validity.achieved_error <= FAR.accuracy.target
    assert not [text for text in texts(outcome.validity.limitations) if "not reached" in text]


@pytest.fixture
def scattered(monkeypatch):
    """Let e scatter, and return the error of the coarsest two meshes at two places each."""
    monkeypatch.setattr(cost_fakes, "WIGGLE", 0.01)
    return achieved_error(
        [MeshRuns.of(run(one) for one in at_offsets(FAR, mesh, FEW_OFFSETS)) for mesh in FAMILY[:2]]
    )


def test_other_places_run_where_only_the_scatter_is_in_the_way(on_plan, scattered, monkeypatch):
    monkeypatch.setitem(globals(), "FAR", replace(FAR, "accuracy.target", f"{99 * scattered} %"))
    _, places, outcome = asked(monkeypatch, 1e9)
    sizes = sorted({size for size, _ in places}, reverse=True)
    assert places == [(size, at) for half in ((0.0, 0.5), (0.25, 0.75)) for size in sizes for at in half]
    assert outcome.validity.achieved_error < 0.8 * scattered
    assert outcome.validity.accuracy_setting.startswith("2 meshes")
    assert not [text for text in texts(outcome.validity.limitations) if "not reached" in text]
    monkeypatch.setitem(globals(), "FAR", replace(FAR, "accuracy.target", f"{10 * scattered} %"))
    assert len({size for size, _ in asked(monkeypatch, 1e9)[1]}) > 2  # no number of places would do


def test_the_files_kept_are_those_of_the_finest_mesh_at_its_first_place(scattered, monkeypatch, tmp_path):
    def stored(scene, fidelity, options):
        options.out.mkdir(parents=True)
        (options.out / "ran.txt").write_text(f"{scene.accuracy.tip_size} {scene.accuracy.grid_shift}")
        return run(scene)

    monkeypatch.setattr(fem_impact.run.simulate, "simulate", stored)
    target = replace(FAR, "accuracy.target", f"{99 * scattered} %")
    to_target.simulate(target, options=RunOptions(out=tmp_path), budget_s=1e9)
    assert (tmp_path / "ran.txt").read_text() == f"{FAMILY[1].sizes(FAR)[0]} 0.0"
    assert len([*tmp_path.glob("run-*/ran.txt")]) == 7


def test_an_error_that_is_not_reached_tells_what_more_would_cost(on_plan, monkeypatch):
    """The budget that is advised lets the next mesh run."""
    monkeypatch.setitem(globals(), "FAR", replace(FAR, "accuracy", "0.001 %"))
    two, three = (
        sum(Case.of(one).size.time for mesh in FAMILY[:n] for one in at_offsets(FAR, mesh, FEW_OFFSETS))
        for n in (2, 3)
    )
    outcome = asked(monkeypatch, 1.01 * two)[2]
    (told,) = [text for text in texts(outcome.validity.limitations) if "not reached" in text]
    assert re.search(r"e is known to [\d.]+ % and E_vib is known to [\d.]+ %", told)
    assert f"One mesh finer takes about {float(f'{three - two:.2g}'):.0f} s more" in told
    single = asked(monkeypatch, 0.9 * two)[2].validity
    (told,) = [text for text in texts(single.limitations) if "not reached" in text]
    assert f"These meshes and one finer at two places take about {float(f'{three:.2g}'):.0f} s" in told
    assert f'give --budget "{float(f"{LONGER * three:.2g}"):.0f} s"' in told
    assert single.accuracy_setting.startswith("2 meshes")
    whole = asked(monkeypatch, 1e9)[2].validity
    assert texts(whole.limitations)[-1].endswith("No finer mesh of this family can be made.")


def test_a_finer_mesh_that_fails_leaves_what_the_coarser_ones_say(on_plan, monkeypatch):
    finest = FAMILY[1].sizes(FAR)[0]

    def cut(scene, *rest):
        made = run(scene, *rest)
        failed = dataclasses.replace(made.validity, finished=False, stopped_because="the tail.")
        return made if scene.accuracy.tip_size > 1.1 * finest else dataclasses.replace(made, validity=failed)

    monkeypatch.setattr(fem_impact.run.simulate, "simulate", cut)
    stated = to_target.simulate(FAR, budget_s=1e9).validity
    assert stated.accuracy_setting.startswith("1 mesh of its own")
    assert "Further runs gave no result: t5b: the tail." in texts(stated.limitations)[-1]


def test_runs_that_exceed_the_budget_say_so(fake, monkeypatch):
    seconds = iter(range(0, 10000, 40))
    monkeypatch.setattr(budgets, "perf_counter", lambda: float(next(seconds)))
    over, _ = texts(to_target.simulate(FAR, budget_s=1.0).validity.limitations)[-2:]
    assert over == "The runs for the wanted error took 40 s, more than the budget of 1 s."


def test_a_mesh_that_cannot_be_made_gives_way_to_a_finer_one(fake):
    """Cells twice as large as its own leave the tip of a soft rod as coarse as the rod."""
    assert family(FAR) == FAMILY
    with pytest.raises(SceneError, match="leaves the tip as coarse as the rod"):
        Case.of(on_mesh(WIDE, FAMILY[0]))
    assert family(WIDE) == MESH_LEVELS[1:]
    outcome = to_target.simulate(replace(WIDE, "accuracy", "0.001 %"), budget_s=1e9)
    assert outcome.validity.accuracy_setting.startswith("3 meshes of its own")
    assert outcome.cost.tip_size == pytest.approx(family(WIDE)[-1].sizes(WIDE)[0])
    assert [len(at_offsets(WIDE, mesh)) for mesh in family(WIDE)] == [4, 4, 2]


def test_a_mesh_whose_sizes_no_scene_may_state_is_left_out(monkeypatch):
    """Those of a contact so narrow that its finest cells would be under 0.01 mm."""
    monkeypatch.setattr(levels_module, "_sizes", lambda scene, finer: (2e-5 / 2**finer,) * 2)
    monkeypatch.setattr(levels_module, "can_be_made", lambda scene: True)
    assert mesh_levels.__wrapped__(FAR) == MESH_LEVELS[:3]


@pytest.mark.parametrize(("stated", "taken"), [(6, 8), (8, 8), (12, 12)])
def test_meshes_have_the_cells_across_that_a_scene_states_and_eight_at_least(stated, taken):
    scene = replace(load("t5b"), "accuracy.across", stated)
    assert {on_mesh(scene, mesh).accuracy.across for mesh in MESH_LEVELS} == {taken}
    assert MESH_LEVELS[1].sizes(scene)[0] == pytest.approx(
        8 / taken * MESH_LEVELS[1].sizes(load("t5b"))[0], rel=0.35
    )


def test_a_cost_study_has_no_setting_that_cannot_be_made(fake, tmp_path):
    study = measure(WIDE, tmp_path, NullMeter(), executor=Here())
    assert not study.failures
    assert sum(one.kind == "mesh" for one in study.settings) == len(FAMILY)
    assert {one.kind for one in study.settings} >= {"numerics", "effect", "extrapolated"}
    for setting in settings_of(WIDE):
        for job in (one for runs in setting.runs for one in runs if one.fidelity == "solid"):
            assert Case.of(job.scene).size.time > 0


def test_a_cost_study_runs_what_its_budget_holds(fake, tmp_path):
    scene = load("t5b")
    whole = settings_of(scene)
    two = sum(Case.of(one).size.time for mesh in FAMILY[:2] for one in at_offsets(scene, mesh))
    kept = affordable(whole, 1.01 * two)
    assert [one.name for one in kept if one.kind == "mesh"] == [
        one.name for one in whole if one.kind == "mesh"
    ][:2]
    with pytest.raises(UsageError, match=r"--budget = \"0.1 s\": is too short for two meshes. Give some"):
        affordable(whole, 0.1)
    study = measure(scene, tmp_path, NullMeter(), executor=Here(), budget_s=1.01 * two)
    assert {one.name for one in study.settings} == {one.name for one in kept}
