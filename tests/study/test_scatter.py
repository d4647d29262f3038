"""The scatter study: seeded samples within stated ranges, indices of a known function, failures as rows."""

import json
from dataclasses import replace

import numpy as np
import pytest
from study_fakes import outcome

from fem_impact.jobs.job import Failure
from fem_impact.physics.contact import projectile
from fem_impact.progress import NullMeter
from fem_impact.scene.shipped import load
from fem_impact.study import scatter as scatter_module
from fem_impact.study.document import Request
from fem_impact.study.inputs import CONTACT, LEVELS, UNCERTAIN_INPUTS, sample_values
from fem_impact.study.scatter import conclude, design, plan
from rigid.experiments import measured_set

SCENE, SET = load("t5b"), measured_set("t5b")


def fake(job):
    """A model whose Omega is twice the friction plus a tenth of the speed, whose vibration is constant."""
    scene = job.scene
    speed = np.hypot(scene.impact.v_n, scene.impact.v_t)
    motion = {"v_n_m_per_s": -1.5, "v_t_m_per_s": -1.5, "V_n_m_per_s": 0.4}
    motion |= {"V_t_m_per_s": -1.0 + scene.surface.friction}
    spin = {"Omega_rad_per_s": 2 * scene.surface.friction + 0.1 * speed, "E_vib_over_E_0": 0.01 * speed}
    return outcome(k_squared_m2=5.5e-4, **motion, **spin)


def results_of(request, broken=()):
    jobs = plan(request, {})
    return {job.name: Failure(job.name, "folded") if job.name in broken else fake(job) for job in jobs}


def test_samples_are_seeded_and_stay_within_their_ranges():
    first, again = design(16), design(16)
    assert all((first[part] == again[part]).all() for part in first)
    values = sample_values(SCENE, SET, first["A"], tests=False)
    low, high = np.array([i.span(SCENE, SET) for i in UNCERTAIN_INPUTS]).T
    assert ((values >= low) & (values <= high)).all()
    assert (values.std(axis=0) > 0.1 * (high - low)).all()
    tests = sample_values(SCENE, SET, first["A"], tests=True)
    same = (tests == values).all(axis=0)
    assert [i.name for i, is_same in zip(UNCERTAIN_INPUTS, same, strict=True) if not is_same] == [
        "yield",
        "plate clamping",
    ]
    assert (tests[:, ~same] == 1.0).all()
    assert len(np.unique(values[:, 3])) == LEVELS


def test_the_contact_point_moves_by_what_is_stated():
    rods = [replace(SCENE.projectile, tip_radius=r) for r in UNCERTAIN_INPUTS[3].span(SCENE, SET)]
    at = [projectile(replace(SCENE, projectile=rod)).contact_point(np.pi / 4) for rod in rods]
    assert np.hypot(*np.subtract(*at)) == pytest.approx(2 * CONTACT, rel=1e-6)


def test_a_scene_with_nominal_inputs_is_the_set(tmp_path):
    (job, *_), half = plan(Request(tmp_path, ("t5b",), quick=True), {}), 0.5
    assert job.fidelity == "modal"
    assert job.scene.projectile.length == SCENE.projectile.length
    centre = sample_values(SCENE, SET, np.full((1, len(UNCERTAIN_INPUTS)), half), tests=True)[0]
    changed = scatter_module.replace_all(SCENE, scatter_module.changes(SCENE, centre))
    assert changed.impact == SCENE.impact
    assert changed.projectile.tip_radius == pytest.approx(SCENE.projectile.tip_radius)


def test_indices_of_a_known_function(tmp_path, monkeypatch):
    monkeypatch.setattr(scatter_module, "SIZES", {"modal": 128})
    request = Request(tmp_path, ("t5b",))
    monkeypatch.setattr(scatter_module, "publish", lambda paper, *_: paper)
    paper = conclude(request, results_of(request), NullMeter())
    total = {
        (q, i): t for _, q, i, _, _, t, _ in next(s for s in paper.sheets if s.name == "sobol").table.rows
    }
    spans = [i.span(SCENE, SET) for i in UNCERTAIN_INPUTS]
    mean_speed = np.hypot(SCENE.impact.v_n, SCENE.impact.v_t)
    friction, speed = 2 * np.ptp(spans[0]), 0.1 * mean_speed * np.ptp(spans[4])
    share = friction**2 / (friction**2 + speed**2)
    assert total["Omega", "friction"] == pytest.approx(share, abs=0.02)
    assert total["Omega", "speed"] == pytest.approx(1 - share, abs=0.02)
    assert total["E_vib/E_0", "speed"] == pytest.approx(1.0, abs=0.02)
    assert total["Omega", "yield"] == 0.0


def test_the_study_tells_spread_and_correlation_beside_the_tests(tmp_path):
    request = Request(tmp_path, ("t5b",), quick=True)
    found = conclude(request, results_of(request, broken=("t5b-AB1-3",)), NullMeter())
    written = json.loads((tmp_path / "study.json").read_text())
    assert written["failures"] == [{"scene_id": "t5b-AB1-3", "error": "folded"}]
    spread = {row[1]: row for row in written["sheets"][0]["rows"]}
    assert spread["e"][-1] == pytest.approx(SET.statistics()["e"].sd)
    assert "against 4.1 measured" in found.text
    for name in ("cloud-t5b.svg", "cloud-t5b-narrow.svg", "cloud-t5b.png", "cloud-t5b.csv"):
        assert (tmp_path / "figures" / name).stat().st_size > 500
    assert len((tmp_path / "runs.csv").read_text().splitlines()) == 10 * 8
    assert written["command"] == "fem-impact study scatter t5b --quick"


def test_solid_runs_are_few_and_coarse(tmp_path):
    jobs = plan(Request(tmp_path, ("t5b",), fidelity="solid"), {})
    assert len(jobs) == 8 * (len(UNCERTAIN_INPUTS) + 4)
    assert {(job.fidelity, job.scene.accuracy.tip_size) for job in jobs} == {("solid", 0.8e-3)}
