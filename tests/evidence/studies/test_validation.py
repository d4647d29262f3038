"""The validation study: seeded samples in stated ranges, surfaces of known functions, calibration."""

import json
import runpy
from dataclasses import replace
from math import hypot, sqrt
from pathlib import Path

import numpy as np
import pandas
import pytest
from study_fakes import outcome, published

from fem_impact.answers.report import Request
from fem_impact.answers.v_and_v import Comparison
from fem_impact.case.case import Case
from fem_impact.case.effects.plasticity import hardening_of
from fem_impact.errors import RunError
from fem_impact.evidence.studies import validation as study
from fem_impact.evidence.studies.inputs import (
    CONTACT,
    LEVELS,
    UNCERTAIN_INPUTS,
    changes,
    hardened,
    interval_ends,
    one_mesh,
    rates,
    sample_values,
)
from fem_impact.evidence.studies.validated import (
    KEYS,
    NAMES,
    fit,
    nominal_place,
    reach,
    reach_sentences,
    unit_sample,
)
from fem_impact.evidence.studies.validation import conclude, plan
from fem_impact.jobs.job import Failure
from fem_impact.outcome.record import KEY_TABLE
from fem_impact.physics.hardening import rate_gain
from fem_impact.scene.shipped import load, replace_all
from rigid.experiments import measured_set

SCENE, SET = load("t5b"), measured_set("t5b")
PAGE = Path(__file__).parents[3] / "docs" / "notebooks" / "calibration.py"


def _input(name):
    return next(i for i in UNCERTAIN_INPUTS if i.name == name)


def fake(job):
    """A model whose Omega is 20 f plus the speed, whose vibration is .01 of the speed."""
    scene = job.scene
    speed = hypot(scene.impact.v_n, scene.impact.v_t)
    motion = {"v_n_m_per_s": -1.5, "v_t_m_per_s": -1.5, "V_n_m_per_s": 0.4}
    motion |= {"V_t_m_per_s": -1.0 + scene.surface.friction, "k_squared_m2": 5.5e-4}
    spin = {"Omega_rad_per_s": 20 * scene.surface.friction + speed, "E_vib_over_E_0": 0.01 * speed}
    run = outcome(**motion, **spin)
    limits = {name: value for name in KEYS if (value := KEY_TABLE[name].of(run)) is not None}
    validity = replace(run.validity, mesh_limit=limits, mesh_band=dict.fromkeys(limits, 0.0))
    return replace(run, validity=validity)


def results_of(request, broken=()):
    return {j.name: Failure(j.name, "folded") if j.name in broken else fake(j) for j in plan(request, {})}


def test_samples_are_seeded_and_stay_within_their_ranges():
    assert (unit_sample(16) == unit_sample(16)).all()
    values = sample_values(SCENE, SET, unit_sample(16), tests=False)
    low, high = interval_ends(SCENE, SET)
    assert ((values >= low) & (values <= high)).all()
    assert (values.std(axis=0) > 0.1 * (high - low)).all()
    tests = sample_values(SCENE, SET, unit_sample(16), tests=True)
    same = (tests == values).all(axis=0)
    assert [i.varies for i in UNCERTAIN_INPUTS] == same.tolist()
    assert (tests[:, ~same] == [i.nominal for i in UNCERTAIN_INPUTS if not i.varies]).all()
    at = [i.name for i in UNCERTAIN_INPUTS].index("contact point")
    assert len(np.unique(values[:, at])) == LEVELS


def test_the_contact_point_moves_by_what_is_stated():
    rods = [replace(SCENE.projectile, tip_radius=r) for r in _input("contact point").span(SCENE, SET)]
    points = [replace(SCENE, projectile=rod).projectile.rigid_body.contact_point(np.pi / 4) for rod in rods]
    assert np.hypot(*np.subtract(*points)) == pytest.approx(2 * CONTACT, rel=1e-6)


def test_a_scene_with_nominal_inputs_is_the_set():
    centre = sample_values(SCENE, SET, np.full((1, len(UNCERTAIN_INPUTS)), 0.5), tests=True)[0]
    changed = replace_all(SCENE, changes(SCENE, centre))
    assert changed.impact.v_n == pytest.approx(SCENE.impact.v_n, rel=1e-8)
    assert changed.projectile.tip_radius == pytest.approx(SCENE.projectile.tip_radius)
    for body in ("projectile", "barrier"):
        metal, stated = getattr(changed, body).material, getattr(SCENE, body).material
        assert rate_gain(metal, 1e3) == pytest.approx(rate_gain(stated, 1e3), rel=1e-9)
        by_test = hardening_of(stated)
        assert hardening_of(metal).exponent == pytest.approx(by_test.exponent, rel=1e-9)


def test_the_ends_of_flow_stress_and_rate_are_those_of_the_stated_intervals():
    ends = replace_all(SCENE, hardened(SCENE, 1.0) | rates(SCENE, 1.0))
    assert rate_gain(ends.barrier.material, 1e3) == pytest.approx(0.6)
    assert rate_gain(ends.projectile.material, 1e3) == pytest.approx(0.8)
    assert hardening_of(ends.barrier.material).flow_stress(0.08) == pytest.approx(575e6, rel=1e-3)
    assert rate_gain(replace_all(SCENE, rates(SCENE, 0.0)).barrier.material, 1e3) == pytest.approx(0.1)


def test_inputs_vary_on_one_mesh_that_stays():
    """Of another strength the contact is of another width, and its mesh would be another."""
    plain = one_mesh(SCENE)
    alone = Case.of(replace_all(SCENE, {"accuracy.levels": 1}))
    assert Case.of(plain).zones.tip_size == pytest.approx(2 * alone.zones.tip_size)
    assert (plain.accuracy.levels, plain.save.frames) == (1, 0)
    changed = replace_all(plain, hardened(plain, 1.0)).accuracy
    assert (changed.tip_size, changed.barrier_size) == (plain.accuracy.tip_size, plain.accuracy.barrier_size)


def test_a_surface_of_second_order_is_exact_for_a_quadratic_and_knows_its_error_elsewhere():
    rng = np.random.default_rng(1)
    unit = rng.random((40, 3))
    quadratic = 1 + unit[:, 0] - 2 * unit[:, 1] * unit[:, 2] + unit[:, 2] ** 2
    surface = fit(unit, np.column_stack([quadratic, np.exp(4 * unit[:, 0])]))
    new = rng.random((500, 3))
    off = surface(new) - np.column_stack(
        [1 + new[:, 0] - 2 * new[:, 1] * new[:, 2] + new[:, 2] ** 2, np.exp(4 * new[:, 0])]
    )
    assert surface.order == 2
    assert np.abs(off[:, 0]).max() < 1e-12
    assert surface.error[1] == pytest.approx(np.sqrt(np.mean(off[:, 1] ** 2)), rel=0.35)
    assert fit(unit[:11], quadratic[:11, None]).order == 1
    with pytest.raises(RunError, match="too few for 3 uncertain inputs"):
        fit(unit[:4], quadratic[:4, None])


def test_the_error_of_the_model_and_its_interval():
    shown = Comparison("t5b", "e", 0.40, 0.30, 0.01, 0.02, 0.02)
    assert shown.u_val == pytest.approx(0.03)
    assert shown.interval == pytest.approx((0.04, 0.16))
    assert shown.verdict == "model too high by at least 0.04"
    assert replace(shown, S=0.25).verdict == "no error shown"
    assert replace(shown, S=0.20).verdict == "model too low by at least 0.04"


def test_uncertainties_of_a_known_model(tmp_path):
    request = Request(tmp_path, ("t5b",))
    (found,) = study.validated_sets(request, results_of(request))
    omega = found.comparisons[NAMES.index("Omega")]
    spans = {i.name: np.ptp(i.span(SCENE, SET)) for i in UNCERTAIN_INPUTS}
    speed = hypot(SCENE.impact.v_n, SCENE.impact.v_t)
    sd = hypot(20 * spans["friction"], speed * spans["speed"]) / sqrt(12)
    assert omega.u_input == pytest.approx(sd, rel=0.02)
    assert found.surface.error[NAMES.index("Omega")] < 1e-7
    statistics = SET.statistics()["Omega"]
    tracking = 0.02 / sqrt(3) * abs(statistics.mean)
    assert omega.u_D == pytest.approx(hypot(statistics.sd / sqrt(statistics.n), tracking))
    assert omega.u_num == pytest.approx(0.0, abs=1e-12)


@pytest.fixture
def calibrated(monkeypatch):
    """Return what the page of the calibration computes in a directory with surfaces.csv."""

    def page(folder):
        monkeypatch.chdir(folder)
        return runpy.run_path(str(PAGE))

    return page


@pytest.mark.long
def test_calibration_finds_the_friction_that_the_measurement_was_made_with(tmp_path, calibrated):
    request = Request(tmp_path, ("t5b",))
    published(conclude, request, results_of(request))
    speed, f = hypot(SCENE.impact.v_n, SCENE.impact.v_t), 0.63
    table = pandas.read_csv(tmp_path / "surfaces.csv")
    spin = table["quantity"] == "Omega"
    table.loc[spin, ["D", "u_num", "u_D"]] = 20 * f + speed, 0.0, 0.05
    table.loc[~spin, "u_D"] = 1e3
    table.to_csv(tmp_path / "surfaces.csv", index=False)
    page = calibrated(tmp_path)
    at = page["constants"].index("friction, machined")
    low, high = _input("friction").span(SCENE, SET)
    width = hypot(0.05, speed * np.ptp(_input("speed").span(SCENE, SET)) / sqrt(12)) / 20
    mean, sd = page["draws"].mean(axis=0), page["draws"].std(axis=0)
    assert low + (high - low) * mean[at] == pytest.approx(f, abs=0.1 * width + 1e-3)
    assert (high - low) * sd[at] == pytest.approx(width, rel=0.1)
    assert page["left"]["met"].all()


def test_the_study_tells_errors_causes_and_failures(tmp_path):
    request = Request(tmp_path, ("t5b",), quick=True)
    found = published(conclude, request, results_of(request, broken=("t5b-3",)))
    written = json.loads((tmp_path / "study.json").read_text())
    assert written["failures"] == [{"scene_id": "t5b-3", "error": "folded"}]
    sheets = {sheet["name"]: sheet for sheet in written["sheets"]}
    causes = {
        row[1]: dict(zip(sheets["causes"]["columns"], row, strict=True)) for row in sheets["causes"]["rows"]
    }
    assert causes["E_vib/E_0"]["speed"] == pytest.approx(1.0, abs=0.03)
    assert causes["Omega"]["friction"] > 0.9 and causes["Omega"]["flow stress"] < 0.01
    spread = {row[1]: row for row in sheets["spread"]["rows"]}
    assert spread["e"][-2] == pytest.approx(SET.statistics()["e"].sd)
    assert "show no error of the model beyond" in found.text
    for name in ("errors.svg", "distribution-e.json", "distribution-Omega.csv"):
        assert (tmp_path / "figures" / name).stat().st_size > 500
    assert written["command"] == "fem-impact study validation t5b --quick"


def test_a_set_whose_run_failed_is_left_out_and_said(tmp_path):
    request = Request(tmp_path, ("t5b",), quick=True)
    found = published(conclude, request, results_of(request, broken=("t5b",)))
    assert "No set could be compared" in found.text
    assert "failed: t5b: folded" in found.text


def test_an_input_whose_nominal_value_ends_its_interval_counts_from_there(tmp_path):
    """From .5 to 1, nominal 1: the root mean square distance is .5 / sqrt(3), half of it from the middle."""
    request = Request(tmp_path, ("t5b",))

    def clamped(job):
        E = job.scene.barrier.material.E / SCENE.barrier.material.E
        run = fake(job)
        return replace(run, motion=replace(run.motion, Omega=10 * E))

    found = study.validated_sets(request, {j.name: clamped(j) for j in plan(request, {})})[0]
    omega = found.comparisons[NAMES.index("Omega")]
    assert omega.u_input == pytest.approx(10 * 0.5 / sqrt(3), rel=0.01)


def test_places_of_the_nominal_inputs():
    names = [i.name for i in UNCERTAIN_INPUTS]
    places = dict(zip(names, nominal_place("t5b")[0], strict=True))
    low, high = SCENE.surface.friction_low, SCENE.surface.friction_high
    assert places["friction"] == pytest.approx((SCENE.surface.friction - low) / (high - low))
    assert [places[n] for n in ("flow stress", "rate", "plate clamping")] == [0.0, 0.5, 1.0]


def test_what_a_miss_would_take_is_read_off_the_response_surface(tmp_path):
    request = Request(tmp_path, ("t5b",))
    found = study.validated_sets(request, results_of(request))[0]
    omega = found.comparisons[NAMES.index("Omega")]
    _, high = _input("friction").span(SCENE, SET)
    up = 20 * (high - SCENE.surface.friction)  # of Omega, by friction at its upper end
    far = reach(found, replace(omega, D=omega.S + 100, u_D=0.1))
    assert (far.name, far.place) == ("friction", 1.0)
    assert far.change == pytest.approx(up, rel=0.01)
    assert far.left == pytest.approx(far.high - 100, rel=1e-9)
    assert "friction at its upper end alone changes it by" in far.sentence and "which leaves" in far.sentence
    near = reach(found, replace(omega, D=omega.S + 0.5 * up, u_D=0.01))
    assert near.left == 0 and "which leaves" not in near.sentence
    quiet = replace(found, comparisons=tuple(replace(c, D=c.S, scatter="inside") for c in found.comparisons))
    assert reach_sentences(quiet) == []


def test_draws_find_a_narrow_posterior_in_a_corner(calibrated):
    """Normal: .002 wide at .3 in one direction, and half of one .01 wide at the face of another."""
    draws = calibrated(PAGE.parent)["posterior"](
        lambda x: ((x[:, 0] - 0.3) / 0.002) ** 2 + ((x[:, 1] - 1) / 0.01) ** 2, 4
    )
    assert draws.min() >= 0 and draws.max() <= 1
    assert draws[:, 0].mean() == pytest.approx(0.3, abs=3e-4)
    assert draws[:, 0].std() == pytest.approx(0.002, rel=0.1)
    assert 1 - draws[:, 1].mean() == pytest.approx(0.01 * sqrt(2 / np.pi), rel=0.1)
    assert draws[:, 2:].mean(axis=0) == pytest.approx(0.5, abs=0.04)
    assert draws[:, 2:].std(axis=0) == pytest.approx(1 / sqrt(12), rel=0.06)


def test_distributions_stand_on_the_limit_wherever_the_sample_of_the_mesh_stands(tmp_path):
    """The levels lie off; the sample, on one mesh, does not follow."""
    request = Request(tmp_path, ("t5b",))
    runs = results_of(request)
    nominal = runs["t5b"]
    limits = {**nominal.validity.mesh_limit, "Omega_rad_per_s": 0.0}
    runs["t5b"] = replace(nominal, validity=replace(nominal.validity, mesh_limit=limits))
    found = study.validated_sets(request, runs)[0]
    at = NAMES.index("Omega")
    nominal = found.surface(nominal_place("t5b"))[0, at] + found.shift[at]
    assert nominal == pytest.approx(0.0, abs=1e-9) == found.comparisons[at].S
    for drawn, values in zip(found.drawn(at), (found.all_inputs, found.tests), strict=True):
        assert drawn == pytest.approx(values[:, at] - found.surface(nominal_place("t5b"))[0, at])
