"""The verdict on a sequence of strikes."""

from dataclasses import replace

import pytest

from fem_impact.answers.verdict import assess
from fem_impact.answers.verdict.assess import sequence_verdict
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all

FLOOR = {"impact.slope": "0 deg", "impact.until": "2 strikes", "surface.friction": 0.57}


@pytest.mark.long
@pytest.mark.parametrize("open_friction, whole", [(0.0, "NO"), (1e6, "UNDECIDED")])
def test_a_strike_that_is_not_certain_decides_nothing(monkeypatch, open_friction, whole):
    scene = replace_all(load("quick"), FLOOR)
    outcomes = {fidelity: simulate(scene, fidelity) for fidelity in ("rigid", "modal")}
    modal = outcomes["modal"].strikes
    number = modal.hardest_energy
    assert sequence_verdict(scene, 0.5)[0].startswith("YES")
    unsure = replace(modal, certain=number - 1, hardest_agree=33, friction_half=open_friction)
    outcomes["modal"] = replace(outcomes["modal"], strikes=unsure)
    monkeypatch.setattr(assess, "simulate", lambda scene, fidelity: outcomes[fidelity])
    first, second, _ = sequence_verdict(scene, 1e-9)
    assert first.startswith("UNDECIDED") and "not certain, in 33 of 64 sequences" in first
    assert second.startswith(whole)
    assert sequence_verdict(scene, 0.5)[1].startswith("UNDECIDED")


@pytest.mark.long
def test_a_hardest_strike_in_which_both_models_agree_only_within_a_wide_tolerance():
    scene = replace_all(load("quick"), FLOOR)
    rigid, modal = (simulate(scene, fidelity).strikes for fidelity in ("rigid", "modal"))
    number = modal.hardest_energy
    ours, theirs = rigid.each[number - 1], modal.each[number - 1]
    apart = abs(ours.lost - theirs.lost) / theirs.before
    assert 1e-4 < apart < 0.4
    strict, loose = (sequence_verdict(scene, tolerance) for tolerance in (0.5 * apart, 0.5))
    assert strict[0].startswith("NO") and strict[1].startswith("NO")
    assert loose[0].startswith("YES") and loose[1].startswith("YES")
    assert f"{theirs.approach:.3g} m/s" in loose[0]


@pytest.mark.parametrize("angle, ends", [("60 deg", "1."), ("0 deg", "not known")])
def test_the_speed_of_the_other_end_is_told_beside_the_first(angle, ends):
    scene = replace_all(load("quick"), FLOOR | {"impact.angle": angle, "impact.v_t": "0 m/s"})
    if ends == "not known":
        scene = replace_all(scene, {"restitution": 0.5})
        assert "not by itself" in sequence_verdict(scene, 0.05)[-1]
        return
    modal = simulate(scene, "modal").strikes
    assert f"strikes {modal.other_end:.3g} times as fast" in sequence_verdict(scene, 0.05)[-1]


def test_a_sequence_that_a_model_refuses_does_not_refuse_the_verdict_on_the_first_strike():
    flank = {"impact.angle": "60 deg", "projectile.tip": "A", "projectile.tip_radius": "10 mm"}
    flank["projectile.diameter"] = "20 mm"
    (told,) = sequence_verdict(replace_all(load("quick"), FLOOR | flank), 0.05)
    assert told.startswith("The sequence is not known: impact.angle") and "straight side" in told
