"""The ablation study: which jobs it plans, and how it judges a pair."""

from dataclasses import replace
from math import isclose

import pytest
from outcome_maker import altered, outcome

from fem_impact.answers.report import Request
from fem_impact.case.choose import active, choices, everything, resolved
from fem_impact.case.effects.registry import BARRIERS, EFFECTS
from fem_impact.case.effects.slots import Harm, ModelSpec, quick_impact
from fem_impact.evidence.studies.effects import (
    COSTED,
    DESIGNED,
    cost_row,
    expected_change,
    expected_row,
    plan,
    row,
)
from fem_impact.physics.beam_impact import BeamImpact
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.scene.types import MEASURED_SETS

RUN = outcome(e_edge=0.4, E_vib_over_E_0=2e-3, cpu_s=3.0, steps=100, effects=["vibration", "friction"])


def test_no_job_has_an_effect_that_its_scene_cannot_have(tmp_path):
    """Each effect fills the model of every job that has it, or its run would fail."""
    for job in plan(Request(tmp_path), {}):
        whole = active(job.scene)
        assert not {"machined-skin", "plate-bending"} & set(whole), job.name
        for name in whole:
            EFFECTS[name].fill(job.scene, ModelSpec())


def test_every_scene_runs_with_auto_and_with_everything(tmp_path):
    jobs = {job.name: job.scene for job in plan(Request(tmp_path), {})}
    for name in (*MEASURED_SETS, *DESIGNED):
        assert jobs[f"{name}-auto"].effects == ("auto",)
        assert set(active(jobs[f"{name}-auto"])) - set(BARRIERS) <= set(active(jobs[f"{name}-everything"]))
    assert all(f"{name}-without-friction" in jobs for name in COSTED)
    assert "friction" not in active(jobs["t5b-without-friction"])
    assert "gravity" in active(jobs["t5b-with-gravity"])


def test_the_designed_scenes_switch_every_effect(tmp_path):
    """Each effect that a scene can lack is off in one of them, and on in another where steel can need it."""
    planned = [set(active(job.scene)) for job in plan(Request(tmp_path), {}) if job.name.endswith("-auto")]
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
    found = cost_row("x", altered(RUN, cpu_s=6.0, steps=400, e_edge=0.45), RUN, Harm(0.1, 2e-3))
    assert found[1:] == [2.0, 0.5, pytest.approx(0.05), 0.1, 0.0, 2e-3]


def test_a_change_stands_beside_what_was_expected_of_it():
    scene = replace(load("t5b"), effects=("auto",))
    harm = {choice.name: choice.harm for choice in choices(scene)}
    slippery, plane = (replace(scene, effects=("auto", word)) for word in ("-friction", "barrier-rigid"))
    base = quick_impact(resolved(scene))
    assert expected_change(scene, slippery.effects).e == quick_impact(resolved(slippery)).e - base.e
    assert expected_change(scene, plane.effects).E_vib == quick_impact(resolved(plane)).E_vib - base.E_vib
    assert abs(expected_change(scene, slippery.effects).e) == pytest.approx(harm["friction"].e, rel=0.05)
    assert expected_change(scene, ("auto", "radiation")) == harm["radiation"]


def test_vibration_stands_beside_what_was_expected():
    assert expected_row("x", RUN, BeamImpact(0.5, 1e-3, 9.0)) == ["x", 0.4, 0.5, 2e-3, 1e-3, 2.0]
    assert expected_row("x", RUN, BeamImpact(0.5, 0.0, 9.0))[-1] is None


def test_auto_agrees_with_everything_on_a_stiff_barrier(tmp_path):
    """A fast case of the study, on a coarser tip; only gravity and damping are left out."""
    (auto, _, *_) = plan(Request(tmp_path, ids=("stiff-barrier",)), {})
    coarse = {"accuracy.tip_size": "1.2 mm", "accuracy.max_time": "1 ms", "accuracy.unresolved": "report"}
    scene = replace_all(auto.scene, coarse)
    whole = replace(everything(scene), effects=(*active(scene), "gravity", "material-damping"))
    found = row("x", simulate(scene), simulate(whole))
    assert found[-1] == "within", found
    assert not isclose(found[3], 0.0, abs_tol=1e-12)


def test_a_contact_that_the_coarse_mesh_does_not_resolve_still_has_its_numbers(tmp_path):
    for quick in (False, True):
        jobs = plan(Request(tmp_path, quick=quick), {})
        assert {job.scene.accuracy.unresolved for job in jobs} == {"report"}
