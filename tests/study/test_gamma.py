"""The gamma study: its grid, its second round for drops that touch twice, and what it says of them."""

import json

import pytest
from study_fakes import outcome

from fem_impact.jobs.job import Failure
from fem_impact.progress import NullMeter
from fem_impact.study import document
from fem_impact.study.document import Request
from fem_impact.study.gamma import SLACK, anchors, conclude, grid, line, plan
from fem_impact.study.gamma_report import Maps
from fem_impact.study.rods import PAPER_RODS, STATES, Drop, length_of
from rigid import slenderness

TOUCH = {"start_s": 0.0, "end_s": 1e-4, "impulse_n_Ns": 0.1, "impulse_t_Ns": 0.0}


def fake(job):
    """Vibration grows with length; elastic frictionless drops touch twice and then hold half of it."""
    share = 0.1 * job.scene.projectile.length
    twice = "friction" not in job.scene.effects and not job.name.startswith("first-")
    touches = [TOUCH, {**TOUCH, "start_s": 3e-4, "end_s": 4e-4}] if twice else [TOUCH]
    vibration = 0.5 * share if twice else share
    shift = 0.01 if job.fidelity == "solid" else 0.0
    return outcome(E_vib_over_E_0=vibration + shift, contacts=touches, fidelity=job.fidelity)


def both_rounds(request):
    results = {job.name: fake(job) for job in plan(request, {})}
    more = [job for job in plan(request, results) if job.name not in results]
    return results | {job.name: fake(job) for job in more}, more


@pytest.fixture
def drawn(monkeypatch):
    """The pictures by name, not drawn: drawing is tested with other studies."""
    pictures = {}
    monkeypatch.setattr(document, "_draw", lambda picture, _: pictures.update({picture.name: picture}))
    return pictures


def test_a_drop_says_what_it_is():
    drop = Drop(length_of(57.3, 0.03), 20.0, 0.57, True, 0.03, speed=4.2)
    scene = drop.scene()
    assert slenderness(scene.projectile.length, scene.projectile.diameter) == pytest.approx(57.3)
    assert scene.impact.v_t / scene.impact.v_n == pytest.approx(0.36397, rel=1e-4)
    assert scene.projectile.tip_radius == pytest.approx(0.003 / 0.019 * 0.03)
    assert "rod-plasticity" in scene.effects
    assert scene.id == drop.name
    rigid_rod = Drop(0.08, vibrates=False).scene()
    assert not {"vibration", "friction", "rod-plasticity"} & set(rigid_rod.effects)


def test_the_full_study_covers_what_it_promises():
    assert len(anchors(False)) >= 12
    gammas = sorted({round(d.gamma, 6) for d in line(False)})
    assert (gammas[0], gammas[-1]) == (10.0, 120.0)
    whole = grid(False)
    assert {d.friction for d in whole} == set(STATES.values())
    assert len({d.diameter for d in whole}) == len({d.speed for d in whole}) == 3
    assert {(d.diameter, d.speed) for d in whole} >= {(0.019, 2.1), (0.01, 2.1), (0.019, 4.2)}
    assert len({d.name for d in (*line(False), *whole, *anchors(False))}) > 3000


def test_drops_that_touch_again_are_cut_off_after_the_first(tmp_path):
    request = Request(tmp_path, quick=True)
    _, more = both_rounds(request)
    frictionless = [d for d in line(True) if not d.friction]
    assert len(more) == len(frictionless)
    assert {job.scene.accuracy.max_time for job in more} == {TOUCH["end_s"] + SLACK}


def test_the_study_says_what_later_contacts_give_back(tmp_path, drawn):
    request = Request(tmp_path, quick=True)
    results, more = both_rounds(request)
    found = conclude(request, results, NullMeter())
    longest = 0.5 * 0.1 * length_of(120.0)
    assert f"{len(more)} touch again; in {len(more)} of these" in found.text
    assert f"at most {100 * longest:.2g} % of E_0 (gamma 120" in found.text
    assert "largest at gamma 120 with" in found.text and "% at gamma 120" not in found.text
    anchor = found.document["sheets"][0]["rows"][0]
    assert anchor[0] == pytest.approx(float(slenderness(PAPER_RODS["0.08 m"], 0.019)))
    assert "vibration/E_0: modes less finite elements over 1 anchors: mean -0.010" in found.text
    assert json.loads((tmp_path / "study.json").read_text())["runs"] == len(results)
    before, end = drawn["second-contacts"].panels[0].series
    assert before.y == pytest.approx([2 * share for share in end.y])
    assert {"line-elastic", "line-yielding", "worst-angle", "by-diameter", "by-speed"} < drawn.keys()


def test_a_failed_run_leaves_a_hole_only(tmp_path, drawn):
    request = Request(tmp_path, quick=True)
    results, _ = both_rounds(request)
    lost = line(True)[0].name
    results[lost] = Failure(lost, "folded")
    found = conclude(request, results, NullMeter())
    assert found.document["failures"] == [{"scene_id": lost, "error": "folded"}]


def test_the_worst_angle_is_that_of_most_vibration():
    drops = [Drop(0.24, angle) for angle in (20.0, 45.0, 63.0)]
    runs = {d.name: outcome(E_vib_over_E_0=share) for d, share in zip(drops, (0.1, 0.05, 0.02), strict=True)}
    assert Maps([], drops, [], runs).worst() == [drops[0]]
