"""What accuracy costs: levels and models against a known limit, front, choice, stored jobs, documents."""

import csv
import json
import re

import pytest
from benchmarks.own_mesh_memory import half_box
from cost_fakes import LIMIT, Here, fake_levels, run

import fem_impact.run.simulate
from fem_impact.answers.cost.judge import advice, best_within, cheapest, front, worst
from fem_impact.answers.cost.measure import (
    STIFF,
    VARIANTS,
    conclude,
    jobs_of,
    judge_stored,
    measure,
    text_table,
    write_cost,
)
from fem_impact.answers.refine import level as level_module
from fem_impact.answers.refine.chain import LevelChain
from fem_impact.answers.refine.quantities import TARGETED, chosen
from fem_impact.answers.refine.work import LevelsJob
from fem_impact.case.case import Case
from fem_impact.errors import ResultError, RunError, UsageError
from fem_impact.jobs.job import Failure
from fem_impact.outcome.keys import known
from fem_impact.progress import NullMeter
from fem_impact.scene.shipped import load, replace

SCENE = load("t5b")


@pytest.fixture(scope="module")
def fake():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fem_impact.run.simulate, "simulate", run)
        patch.setattr(level_module, "simulate_recorded", fake_levels)
        yield


@pytest.fixture(scope="module")
def cost(fake, tmp_path_factory):
    return measure(SCENE, tmp_path_factory.mktemp("cost"), NullMeter(), executor=Here())


def by_name(cost, name):
    (found,) = [one for one in cost.settings if one.name == name]
    return found


def test_jobs_are_models_levels_and_without_a_budget_variants():
    jobs = {job.name.removeprefix("t5b: "): job for job in jobs_of(SCENE, 1, float("inf"))}
    assert [*jobs] == ["rigid", "modal", "levels", "two places", *VARIANTS, STIFF]
    assert [jobs[name].scene.accuracy.offsets for name in ("levels", "two places")] == [1, 2]
    assert "vibration" not in Case(jobs[STIFF].scene).active
    assert jobs["without savings"].scene.accuracy.mass_scaling == 1
    short = jobs_of(SCENE, 1, 30.0)
    assert [job.name for job in short] == [f"t5b: {name}" for name in [*jobs][:4]]
    assert short[2].budget_s == 30.0


def test_the_first_levels_are_those_of_a_default_run_and_one_more_follows(cost, fake):
    default = LevelChain(Case(SCENE))
    outcome = default.run()
    levels = cost.levels[1]
    assert levels.default == len(default.done) == len(levels.meshes) - 1
    (one,) = [one for one in cost.settings if one.default]
    assert one.value["e"] == known(outcome.validity.mesh_limit)["e_edge"]
    assert one.error["e"] >= known(outcome.validity.mesh_band)["e_edge"] / one.value["e"] - 1e-2


def test_the_error_of_levels_is_their_band_or_their_distance_from_the_limit_if_that_is_more(cost):
    for one in cost.settings:
        if one.kind in ("levels", "two places"):
            away = abs(one.value["e"] - cost.limits["e"].value) / cost.limits["e"].scale
            assert one.error["e"] >= away * (1 - 1e-9)
    finest = by_name(cost, max(o.name for o in cost.settings if o.kind == "two places"))
    assert finest.error["e"] == pytest.approx(cost.limits["e"].error)
    assert abs(cost.limits["e"].value - LIMIT["e_edge"]) < cost.limits["e"].band


def test_a_model_errs_by_its_distance_and_the_limits_own_band(cost):
    modal, limit = by_name(cost, "modal"), cost.limits["mu"]
    away = abs(1.1 * LIMIT["mu"] - limit.value)
    assert modal.error["mu"] == pytest.approx((away + limit.band) / limit.scale)
    assert by_name(cost, "rigid").error["E_vib"] is None


def test_times_are_those_of_all_levels_and_two_cores_share_the_places(cost):
    levels = cost.levels[2].meshes
    one = next(one for one in cost.settings if one.kind == "two places" and one.levels == len(levels))
    first, *others = (sum(run.cost.whole_cpu for run in level.runs) for level in levels)
    assert one.cpu_s == pytest.approx(first + sum(others))
    assert one.two_cores_s == pytest.approx(first + sum(others) / 2)


def test_a_variant_is_judged_beside_the_default_run_and_on_no_front(cost):
    half = by_name(cost, "default run with half the default step")
    assert half.error["mu"] == 0.0 and half.front == []
    assert by_name(cost, f"default run {STIFF}").error["E_vib"] is None


def test_front_and_choice(cost):
    best = front(cost.settings, TARGETED)
    assert [s.cpu_s for s in best] == sorted(s.cpu_s for s in best)
    errors = [worst(s, TARGETED) for s in best]
    assert errors == sorted(errors, reverse=True)
    for one in cost.settings:
        beaten = [b for b in best if b.cpu_s <= one.cpu_s and worst(b, TARGETED) <= worst(one, TARGETED)]
        assert beaten or one.kind == "variant" or one.error["E_vib"] is None
    assert cheapest(cost.settings, ["e"], 0.2).name == "rigid"
    assert cheapest(cost.settings, TARGETED, 0.2).name == "modal"
    assert cheapest(cost.settings, TARGETED, 1e-6) is None
    assert best_within(cost.settings, TARGETED, 1.0).name == "modal"
    assert best_within(cost.settings, TARGETED, 1e-9) is None


def test_advice_in_words(cost):
    good, quick = advice(cost.settings, TARGETED, 0.2, 1.0)
    assert good.startswith("Cheapest within 20 % of e and E_vib: modal, error ")
    assert quick.startswith("Best within 1 s on one core: modal")
    never, slow = advice(cost.settings, TARGETED, 1e-6, 1e-9)
    assert re.match(r"No setting brings e and E_vib within 0.0001 %; best: \d levels to", never)
    assert slow == "No setting takes only 1e-09 s on one core."


def test_what_is_stored_is_not_computed_again(fake, tmp_path):
    first, second = Here(), Here()
    measure(SCENE, tmp_path, NullMeter(), 0, first, 30.0)
    held = judge_stored(SCENE, tmp_path, NullMeter(), 0, 30.0)
    measure(SCENE, tmp_path, NullMeter(), 0, second, 30.0)
    assert len(first.names) == 4 and second.names == []
    assert held.limits["e"].value > 0


def test_a_stored_level_that_is_damaged_is_refused(fake):
    job = LevelsJob("x", SCENE)
    assert job.read(job.run()).default == 3
    for text in ("", "{}", '{"default": 1, "meshes": [{"size": 1}]}'):
        with pytest.raises(ResultError, match="x: its stored result is damaged"):
            job.read(text)


def test_what_never_ran_cannot_be_judged(tmp_path):
    with pytest.raises(RunError, match=r"holds no run of t5b .* Leave out stored=True"):
        judge_stored(SCENE, tmp_path, NullMeter())


def test_a_failed_job_is_told_and_without_levels_nothing_is_known(cost):
    names = {"t5b: modal": Failure("t5b: modal", "out of patience.")}
    found = conclude(SCENE, {**cost.runs, **names})
    assert found.failures == [{"setting": "modal", "reason": "out of patience."}]
    with pytest.raises(RunError, match=r"t5b: no two levels gave a result .* out of patience"):
        conclude(SCENE, names)


def test_documents(cost, tmp_path):
    write_cost(cost, tmp_path)
    held = json.loads((tmp_path / "cost.json").read_text())
    assert held["quantities"]["e"]["value"] == cost.limits["e"].value
    assert len(held["settings"]) == len(cost.settings)
    rows = list(csv.DictReader((tmp_path / "cost.csv").read_text().splitlines()))
    assert float(rows[0]["cpu_s"]) == cost.settings[0].cpu_s
    assert "e" in rows[0]["front"].split()
    text = text_table(cost)
    assert (tmp_path / "cost.txt").read_text() == text + "\n"
    assert "modal" in text and "Changes of the default run" in text
    levels = text.split("Each level:")[1].split("\n\n")[0].splitlines()[2:]
    assert len(levels) == sum(len(found.meshes) for found in cost.levels.values())


def test_unknown_quantities_are_refused():
    assert chosen(()) == TARGETED
    assert chosen(["mu"]) == ("mu",)
    with pytest.raises(UsageError, match="muu"):
        chosen(["muu"])


def test_the_table_holds_the_quantities_asked_for_in_columns(cost):
    head, unit, *_ = text_table(cost, ("e", "Omega")).split("\n\n")[0].splitlines()[1:]
    assert head.split()[-2:] == ["e", "Omega"] and unit.split() == ["unit", "-", "rad/s"]


def test_a_scene_that_asks_for_an_error_is_measured_without_it():
    (levels,) = [
        job for job in jobs_of(replace(SCENE, "accuracy", "5 %"), 1, 30.0) if job.name.endswith("levels")
    ]
    assert levels.scene.accuracy.target is None


def test_a_mesh_of_the_users_own_is_measured_by_the_same_settings(tmp_path):
    names = [job.name for job in jobs_of(half_box(tmp_path, 8, 4, 10), 1, 30.0)]
    assert names == ["box: rigid", "box: modal", "box: levels", "box: two places"]
