"""The family of meshes of a scene, and a cost study within a time."""

import pytest
from cost_fakes import Here, run
from wide_contact import WIDE

import fem_impact.run.simulate
from fem_impact.answers.cost.measure import affordable, measure
from fem_impact.answers.cost.settings import settings_of
from fem_impact.answers.refine import levels as levels_module
from fem_impact.answers.refine.levels import FAMILY, MESH_LEVELS, at_offsets, family, mesh_levels, on_mesh
from fem_impact.case.case import Case
from fem_impact.errors import SceneError, UsageError
from fem_impact.progress import NullMeter
from fem_impact.scene.shipped import load, replace, replace_all

FAR = replace_all(load("t5b"), {"impact.omega": "30 rad/s"})


@pytest.fixture
def fake(monkeypatch):
    monkeypatch.setattr(fem_impact.run.simulate, "simulate", run)


def test_a_mesh_that_cannot_be_made_gives_way_to_a_finer_one():
    """Cells twice as large as its own leave the tip of a soft rod as coarse as the rod."""
    assert family(FAR) == FAMILY
    with pytest.raises(SceneError, match="leaves the tip as coarse as the rod"):
        Case.of(on_mesh(WIDE, FAMILY[0]))
    assert family(WIDE) == MESH_LEVELS[1:]
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
