"""A scene that states the error it allows: reading, choosing from stored costs, refusing, achieving."""

import pytest
from cost_fakes import Here, run

import fem_impact.run.simulate
from fem_impact.answers import wanted_error as to_target
from fem_impact.answers.cost import stored
from fem_impact.answers.cost.judge import Judged
from fem_impact.answers.cost.measure import measure
from fem_impact.answers.cost.stored import NEARNESS, SUMMARY, choose_setting, nearest, summarise
from fem_impact.answers.refine.extrapolate import pair_limit
from fem_impact.answers.refine.levels import FEW_OFFSETS, at_offsets
from fem_impact.answers.wanted_error import RefinementPlan
from fem_impact.case.case import Case
from fem_impact.case.measured import summary
from fem_impact.errors import SceneError
from fem_impact.options import RunOptions
from fem_impact.outcome.keys import Unknown
from fem_impact.progress import NullMeter
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace
from fem_impact.scene.types import MEASURED_SETS, Accuracy
from fem_impact.scene.write import digest, to_dict


@pytest.fixture
def costs(monkeypatch, tmp_path):
    """Stored costs of t5b whose limit, order and times are known, measured on half as quick a machine."""
    monkeypatch.setattr(fem_impact.run.simulate, "simulate", run)
    held = summarise({"t5b": measure(load("t5b"), tmp_path, NullMeter(), executor=Here())})
    held["machine"] = {"csr_ns_per_element_step": 2 * stored.yardsticks()["csr_ns_per_element_step"]}
    monkeypatch.setattr(stored, "summary", lambda: held)


def asking(target, scene="t5b", **changes):
    scene = replace(load(scene), "accuracy", f"{100 * target:g} %")
    for key, value in changes.items():
        scene = replace(scene, key.replace("__", "."), value)
    return scene


def test_a_target_is_written_and_read_back():
    scene = asking(0.02)
    assert scene.accuracy.target == 0.02
    assert read_dict(to_dict(scene)) == scene
    assert to_dict(scene)["accuracy"]["target"] == "2 %"
    assert digest(scene) != digest(load("t5b"))


def test_a_mesh_replaces_a_target_and_the_other_way_round():
    scene = replace(asking(0.02), "accuracy.tip_size", "0.5 mm")
    assert (scene.accuracy.target, scene.accuracy.tip_size) == (None, 0.5e-3)
    scene = replace(scene, "accuracy.target", "3 %")
    assert scene.accuracy.target == 0.03
    assert replace(asking(0.02), "accuracy.max_time", "1 ms").accuracy.target == 0.02


@pytest.mark.parametrize(
    "text", ["2", "0 %", "-1 %", "101 %", "2 mm", "", "%", 0.02, 2, "1e9999 %", "2 %" + 70 * " "]
)
def test_what_is_no_share_is_refused(text):
    data = to_dict(load("t5b"))
    with pytest.raises(SceneError, match="accuracy"):
        read_dict(data | {"accuracy": text})


@pytest.mark.parametrize("target", [-3.0, 50.0, 0.0, "2 %"])
def test_a_target_made_in_python_is_checked_too(target):
    with pytest.raises(SceneError, match="share above 0 and at most 1"):
        Accuracy(target=target)


def test_a_mesh_beside_a_target_is_refused():
    data = to_dict(load("t5b"))
    with pytest.raises(SceneError, match=r"accuracy.tip_size: stands beside a target"):
        read_dict(data | {"accuracy": {"target": "2 %", "tip_size": "0.4 mm"}})


def test_the_cheapest_stored_setting_is_chosen_and_its_time_scaled(costs):
    chosen = choose_setting(asking(0.2))
    assert (chosen.setting.name, chosen.like) == ("modal", "t5b")
    assert chosen.expected_wall_s == pytest.approx(0.5 * 0.01)
    assert chosen.expected_error <= 0.2
    solid = choose_setting(asking(0.2), "solid")
    assert solid.setting.fidelity == "solid"
    assert choose_setting(asking(0.09)).expected_wall_s > chosen.expected_wall_s
    assert "expected error" in solid.sentence and "measured on t5b" in solid.sentence


def test_a_target_that_no_setting_meets_is_refused_with_the_best(costs):
    words = r'accuracy = "0.01 %": cannot be met: on t5b, the best .* Or allow "\d+ %"'
    with pytest.raises(SceneError, match=words):
        choose_setting(asking(1e-4))


def test_a_fidelity_that_does_not_know_what_is_asked_for_is_refused(costs):
    with pytest.raises(SceneError, match=r"the rigid fidelity does not know .*Leave out --fidelity"):
        choose_setting(asking(0.2), "rigid")


@pytest.mark.parametrize(
    ("changes", "differs"),
    [
        ({"impact__angle": "60 deg"}, "angle|slope"),
        ({"impact__v_n": "-1.1 m/s", "impact__v_t": "-1.085 m/s"}, "approach"),
        ({"impact__omega": "30 rad/s"}, "spin|approach"),
        ({"barrier__material__E": "180 GPa"}, "E of the barrier"),
        ({"barrier__material__ultimate_stress": "1500 MPa"}, "ultimate over yield of the barrier"),
        ({"accuracy__max_time": "1 ms"}, "max_time"),
        ({"accuracy__block_margin": "3 mm"}, "block_margin"),
        ({"projectile__length": "120 mm"}, "length over diameter"),
        ({"surface__friction": 0.3}, "friction"),
        ({"effects": ["vibration", "barrier-elastic"]}, "effects"),
        ({"barrier__material__yield_stress": "400 MPa"}, "yield"),
        ({"accuracy__element": "full"}, "element"),
        ({"accuracy__step": 0.5}, "step"),
        ({"accuracy__mass_scaling": 1.0}, "mass_scaling"),
        ({"accuracy__fine_zone": "even"}, "fine_zone"),
    ],
)
def test_a_scene_far_from_every_stored_one_is_refused(costs, changes, differs):
    scene = load("t5b")
    for key, value in changes.items():
        scene = replace(scene, key.replace("__", "."), value)
    words = f"nearest scene with a measured cost, t5b, differs .*({differs}).*\\. Leave out"
    with pytest.raises(SceneError, match=words) as refused:
        choose_setting(replace(scene, "accuracy.target", "20 %"))
    assert len(str(refused.value)) < 330


def test_a_stored_setting_that_takes_longer_than_the_budget_gives_way_to_a_ladder_of_its_own(costs):
    scene = asking(0.06)
    enough = choose_setting(scene).expected_wall_s
    assert to_target.settle(scene, budget_s=enough) == choose_setting(scene) == to_target.settle(scene)
    chosen = to_target.settle(scene, budget_s=0.99 * enough)
    assert isinstance(chosen, RefinementPlan) and chosen.budget_s == 0.99 * enough
    assert "mm extrapolated, 2 places, measured on t5b, takes about" in chosen.sentence


def test_a_scene_near_a_stored_one_is_taken(costs):
    near = asking(0.2, impact__angle="46 deg", projectile__length="82 mm")
    name, distance, _ = nearest(near)
    assert name == "t5b"
    assert 0 < distance < 1
    assert choose_setting(near).setting.name == "modal"


def test_two_meshes_state_what_they_achieved(costs, tmp_path):
    scene = asking(0.06)
    chosen = choose_setting(scene)
    outcome = to_target.simulate(scene, options=RunOptions(out=tmp_path))
    assert chosen.setting.kind == "extrapolated"
    assert outcome.validity.accuracy_target == 0.06
    assert outcome.validity.accuracy_setting == chosen.setting.name
    assert outcome.validity.expected_error == chosen.expected_error
    assert outcome.validity.achieved_wall == pytest.approx(chosen.setting.wall_s)
    assert 0 < outcome.validity.achieved_error < 1
    scale = stored.summary()["scenes"]["t5b"]["quantities"]["e"]["scale"]
    assert outcome.validity.mesh_band["e_edge"] == pytest.approx(chosen.setting.band["e"] * scale)
    assert outcome.validity.mesh_limit["e_edge"] == pytest.approx(chosen.setting.value["e"])
    assert (tmp_path / "outcome.json").exists()


def test_two_workers_run_two_meshes_side_by_side(costs, tmp_path):
    scene = asking(0.06)
    one, two = (to_target.simulate(scene, workers=workers) for workers in (1, 2))
    assert choose_setting(scene, workers=2).expected_wall_s < choose_setting(scene).expected_wall_s
    assert two.validity.achieved_wall < one.validity.achieved_wall
    assert two.validity.mesh_limit == one.validity.mesh_limit
    assert two.validity.achieved_error == one.validity.achieved_error


def test_a_reduced_run_does_not_claim_an_achieved_error(costs):
    outcome = to_target.simulate(asking(0.2))
    assert (outcome.provenance.fidelity, outcome.validity.accuracy_setting) == ("modal", "modal")
    assert isinstance(outcome.validity.achieved_error, Unknown)
    assert "alone" in outcome.validity.achieved_error.reason


def test_a_run_on_one_mesh_refuses_a_target():
    with pytest.raises(SceneError, match="is an error, not a mesh"):
        fem_impact.run.simulate.simulate(asking(0.2))


def test_the_shipped_summary_is_dated_and_about_shipped_scenes():
    held = summary()
    assert held["schema"] == SUMMARY
    assert held["created_utc"] and held["versions"]["numpy"]
    assert held["machine"]["triad_GB_per_s"] > 0
    assert held["scenes"]
    for name, cost in held["scenes"].items():
        scene = read_dict(cost["scene"])
        assert name in MEASURED_SETS
        assert nearest(load(name))[:2] == (name, 0.0)
        assert scene.impact == load(name).impact
        kinds = {setting["kind"] for setting in cost["settings"]}
        assert {"rigid", "modal", "mesh"} <= kinds
        assert ("extrapolated" in kinds) == (not cost["failures"])
    assert set(NEARNESS) == set(stored._features(Case(load("t2"))))


def test_a_target_chooses_the_place_of_the_grid_too():
    scene = replace(load("t5b"), "accuracy.grid_shift", 0.5)
    asked = replace(scene, "accuracy", "5 %")
    assert "grid_shift" not in to_dict(asked)["accuracy"]
    assert replace(asked, "accuracy.grid_shift", 0.25).accuracy.target is None


def test_every_run_of_the_setting_is_kept_and_counts(costs, tmp_path, monkeypatch):
    folders = []

    def kept(scene, fidelity, options):
        folders.append(options.out)
        return run(scene, fidelity)

    monkeypatch.setattr(fem_impact.run.simulate, "simulate", kept)
    outcome = to_target.simulate(asking(0.06), options=RunOptions(out=tmp_path))
    assert folders == [tmp_path, *(tmp_path / f"run-{at}" for at in range(1, 4))]
    fine, coarse = (
        at_offsets(load("t5b"), mesh, FEW_OFFSETS) for mesh in choose_setting(asking(0.06)).meshes
    )
    assert outcome.provenance.scene_digest == digest(fine[0])
    every = [[run(scene).restitution.edge.e for scene in scenes] for scenes in (fine, coarse)]
    means = [sum(values) / len(values) for values in every]
    ratio = coarse[0].accuracy.tip_size / fine[0].accuracy.tip_size
    assert outcome.validity.mesh_limit["e_edge"] == pytest.approx(pair_limit(*means, ratio)[0])


@pytest.mark.parametrize("fidelity", [None, "solid"])
@pytest.mark.parametrize("target", [0.4, 0.2, 0.1, 0.06])
def test_the_expected_time_is_that_of_the_runs_that_are_done(costs, monkeypatch, fidelity, target):
    done = []

    def kept(*scene):
        done.append(run(*scene).cost.whole_cpu)
        return run(*scene)

    monkeypatch.setattr(fem_impact.run.simulate, "simulate", kept)
    scene = asking(target)
    chosen = choose_setting(scene, fidelity)
    outcome = to_target.simulate(scene, fidelity)
    assert outcome.validity.expected_wall == chosen.expected_wall_s == pytest.approx(0.5 * sum(done))


def test_one_mesh_states_its_mean_and_no_error(costs, monkeypatch):
    settings = stored.summary()["scenes"]["t5b"]["settings"]
    single = next(setting for setting in settings if setting["name"] == "solid 0.297 mm")
    chosen = stored.ChosenSetting(0.2, Judged(**single), "t5b", 0.15, 1.0)
    monkeypatch.setattr(to_target, "choose_setting", lambda *_: chosen)
    outcome = to_target.simulate(asking(0.2))
    assert isinstance(outcome.validity.achieved_error, Unknown)
    assert outcome.validity.mesh_limit["e_edge"] == pytest.approx(single["value"]["e"])
    assert outcome.validity.mesh_limit["e_edge"] != outcome.restitution.edge.e
    assert isinstance(outcome.validity.mesh_band, Unknown)
