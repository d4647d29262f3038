"""The ablation study: which jobs it plans, and how it judges a pair."""

from dataclasses import replace
from math import isclose

import pytest
from outcome_maker import altered, outcome

from fem_impact.answers.report import Request
from fem_impact.case.case import Case
from fem_impact.case.effects.registry import BARRIERS, EFFECTS
from fem_impact.case.effects.slots import ModelSpec
from fem_impact.evidence.studies.effects import COSTED, DESIGNED, cost_row, plan, row
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import replace_all
from fem_impact.scene.types import MEASURED_SETS

pytestmark = pytest.mark.usefixtures("unrendered")

RUN = outcome(e_edge=0.4, E_vib_over_E_0=2e-3, cpu_s=3.0, steps=100, effects=["vibration", "friction"])


def test_no_job_has_an_effect_that_its_scene_cannot_have(tmp_path):
    """Each effect fills the model of every job that has it, or its run would fail."""
    for job in plan(Request(tmp_path), {}):
        case = Case(job.scene)
        assert not {"machined-skin", "plate-bending"} & set(case.active), job.name
        for name in case.active:
            EFFECTS[name].fill(case.bodies, ModelSpec())


def test_every_scene_runs_with_auto_and_with_everything(tmp_path):
    jobs = {job.name: job.scene for job in plan(Request(tmp_path), {})}
    for name in (*MEASURED_SETS, *DESIGNED):
        assert jobs[f"{name}-auto"].effects == ("auto",)
        assert set(Case(jobs[f"{name}-auto"]).active) - set(BARRIERS) <= set(
            Case(jobs[f"{name}-everything"]).active
        )
    assert all(f"{name}-without-friction" in jobs for name in COSTED)
    assert "friction" not in Case(jobs["t5b-without-friction"]).active
    assert "gravity" in Case(jobs["t5b-with-gravity"]).active


def test_the_designed_scenes_switch_every_effect(tmp_path):
    """Each effect that a scene can lack is off in one of them, and on in another where steel can need it."""
    planned = [
        set(Case(job.scene).active) for job in plan(Request(tmp_path), {}) if job.name.endswith("-auto")
    ]
    for name in ("vibration", "friction", "rod-plasticity", "rate-hardening", "radiation", "gravity"):
        assert {name in effects for effects in planned} == {True, False}, name
    assert {next(b for b in BARRIERS if b in effects) for effects in planned} == set(BARRIERS)


@pytest.mark.parametrize(
    ("change", "verdict"),
    [
        ({}, "within"),
        ({"e_edge": 0.4085}, "beyond"),
        ({"e_edge": 0.4079}, "within"),
        ({"E_vib_over_E_0": 2.3e-3}, "beyond"),
        ({"E_vib_over_E_0": 2.15e-3}, "within"),
        ({"E_vib_over_E_0": None}, "beyond"),
    ],
)
def test_a_pair_is_judged_by_e_and_vibration(change, verdict):
    found = row("x", altered(RUN, **{"effects": ["vibration"], "cpu_s": 1.5} | change), RUN)
    assert found[-1] == verdict
    assert found[1] == "friction"
    assert found[6] == 0.5


def test_no_vibration_agrees_with_hardly_any():
    assert row("x", altered(RUN, E_vib_over_E_0=None), altered(RUN, E_vib_over_E_0=9e-5))[-1] == "within"


def test_costs_are_ratios():
    found = cost_row("x", altered(RUN, cpu_s=6.0, steps=400, e_edge=0.45), RUN)
    assert found[1:] == [2.0, 0.5, pytest.approx(0.05), 0.0]


def test_auto_agrees_with_everything_on_a_stiff_barrier(tmp_path):
    """A fast case of the study, on a coarser tip; only gravity and damping are left out."""
    (auto, _, *_) = plan(Request(tmp_path, ids=("stiff-barrier",)), {})
    coarse = {"accuracy.tip_size": "1.2 mm", "accuracy.max_time": "1 ms", "accuracy.unresolved": "report"}
    scene = replace_all(auto.scene, coarse)
    whole = replace(scene, effects=(*Case(scene).active, "gravity", "material-damping"))
    found = row("x", simulate(scene), simulate(whole))
    assert found[-1] == "within", found
    assert not isclose(found[3], 0.0, abs_tol=1e-12)


def test_a_contact_that_the_coarse_mesh_does_not_resolve_still_has_its_numbers(tmp_path):
    for quick in (False, True):
        jobs = plan(Request(tmp_path, quick=quick), {})
        assert {job.scene.accuracy.unresolved for job in jobs} == {"report"}
