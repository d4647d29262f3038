"""May rigid theory be used: a rod beside one that cannot vibrate, at its angle and at the worst one."""

import math

import pytest

from fem_impact.assess import rigid_enough as module
from fem_impact.assess.drop import DroppedRod
from fem_impact.assess.rigid_enough import rigid_enough
from rigid import Projectile


def case(length, degrees=45.0):
    rod = Projectile(length, 0.019, "B", 0.003, 7850.0)
    return DroppedRod(rod, 0.26, math.radians(degrees), "machined")


@pytest.fixture(scope="module")
def answers():
    return {length: rigid_enough(case(length)) for length in (0.08, 0.24)}


def test_the_short_rod_may_be_called_rigid_at_45_degrees_and_the_long_one_not(answers):
    assert answers[0.08]["answer"] == "yes"
    assert answers[0.24]["answer"] == answers[0.24]["answer_any_angle"] == "no"
    assert answers[0.24]["T1_over_tau"] > 3 * answers[0.08]["T1_over_tau"]


def test_the_error_is_the_change_of_e_and_the_worst_is_no_smaller(answers):
    for found in answers.values():
        assert found["error_of_e"] == abs(found["with_vibration"]["e"] - found["rigid"]["e"])
        assert found["worst_error_of_e"] >= found["error_of_e"]
        assert 0 < found["worst_angle_rad"] < math.pi / 2


def test_solid_runs_two_drops_and_leaves_other_angles_to_modes(monkeypatch):
    asked = []
    real = module.simulate

    def coarse(scene, fidelity):
        asked.append((fidelity, "vibration" in scene.effects))
        return real(scene, "modal")

    monkeypatch.setattr(module, "simulate", coarse)
    found = rigid_enough(case(0.08), "solid")
    assert asked[:2] == [("solid", True), ("solid", False)]
    assert {fidelity for fidelity, _ in asked[2:]} == {"modal"}
    assert found["worst_error_of_e"] > found["error_of_e"]  # not from the stated angle alone
    assert (found["fidelity"], found["worst_fidelity"]) == ("solid", "modal")


@pytest.mark.parametrize(("error", "says"), [(0.01, "yes"), (0.03, "yes, if"), (0.2, "no")])
def test_answers(error, says):
    assert module._answer(error).startswith(says)
