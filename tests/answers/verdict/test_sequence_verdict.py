"""The verdict on a sequence of strikes."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from fem_impact.answers.verdict import assess
from fem_impact.answers.verdict.assess import sequence_verdict
from fem_impact.outcome.keys import Unknown
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
    surely = apart - modal.half_width(number, "E_after_J") / theirs.before
    tolerances = 0.9 * surely, 0.5 * (surely + apart), 0.5
    strict, between, loose = (sequence_verdict(scene, tolerance) for tolerance in tolerances)
    assert strict[0].startswith("NO") and strict[1].startswith("NO")
    assert between[0].startswith("UNDECIDED")
    assert loose[0].startswith("YES") and loose[1].startswith("YES")
    assert f"{theirs.approach:.3g} m/s" in loose[0]


def test_what_a_stated_restitution_takes_is_part_of_what_is_lost():
    """A rigid plane takes none of it as plastic work: 0.2 J had gone from the sum."""
    elastic = {"restitution": 0.6, "effects": ["vibration", "friction", "barrier-rigid"]}
    scene = replace_all(load("quick"), FLOOR | elastic)
    strikes = simulate(scene, "rigid").strikes
    assert strikes.other > 0.1 * strikes.each[0].before
    lost = strikes.each[0].before - strikes.left
    assert f"{lost:.3g} J," in sequence_verdict(scene, 0.05)[1]


@pytest.mark.parametrize("angle, ends", [("60 deg", "1."), ("0 deg", "not known")])
def test_the_speed_of_the_other_end_is_told_beside_the_first(angle, ends):
    scene = replace_all(load("quick"), FLOOR | {"impact.angle": angle, "impact.v_t": "0 m/s"})
    if ends == "not known":
        scene = replace_all(scene, {"restitution": 0.5})
        assert "does not strike by itself" in sequence_verdict(scene, 0.05)[-1]
        return
    modal = simulate(scene, "modal").strikes
    assert f"strikes {modal.other_end:.3g} times as fast" in sequence_verdict(scene, 0.05)[-1]


def test_a_sequence_that_a_model_refuses_does_not_refuse_the_verdict_on_the_first_strike():
    flank = {"impact.angle": "60 deg", "projectile.tip": "A", "projectile.tip_radius": "10 mm"}
    flank["projectile.diameter"] = "20 mm"
    (told,) = sequence_verdict(replace_all(load("quick"), FLOOR | flank), 0.05)
    assert told.startswith("The sequence is not known: impact.angle") and "straight side" in told


def struck(lost, approach=1.0, half=0.0, half_approach=0.0, rubbed=0.0, half_rubbed=0.0):
    """One certain strike of 1 J, which loses some of it, with half-widths as of the reduced model."""
    halves = {"E_after_J": half, "approach_m_per_s": half_approach}
    return SimpleNamespace(
        each=(SimpleNamespace(part="tip", approach=approach, lost=lost, before=1.0),),
        hardest_energy=1,
        certain=1,
        hardest_agree=64,
        friction=rubbed,
        friction_half=half_rubbed,
        plastic=lost - rubbed,
        damping=0.0,
        settled=0.0,
        other=0.0,
        other_end=1.0,
        half_width=lambda number, name: halves[name],
    )


def answers(monkeypatch, modal, tolerance=0.1):
    """The answers on the hardest strike and the whole sequence, where rigid theory loses half the energy."""
    strikes = {"rigid": struck(0.5), "modal": modal}
    monkeypatch.setattr(assess, "simulate", lambda _, fidelity: SimpleNamespace(strikes=strikes[fidelity]))
    return [told.partition(":")[0] for told in sequence_verdict(load("quick"), tolerance)[:2]]


@pytest.mark.parametrize(
    ("apart", "half", "answer"),
    [
        (0.04, 0.05, "YES"),
        (0.08, 0.05, "UNDECIDED"),
        (0.12, 0.05, "UNDECIDED"),
        (0.2, 0.05, "NO"),
        (0.2, 0.15, "UNDECIDED"),
        (0.0, 0.15, "UNDECIDED"),
    ],
)
def test_a_difference_decides_where_its_half_width_lies_on_one_side_of_the_tolerance(
    monkeypatch, apart, half, answer
):
    assert answers(monkeypatch, struck(0.5 + apart, half=half)) == [answer, answer]
    assert answers(monkeypatch, struck(0.5 - apart, half=half)) == [answer, answer]


def test_the_speed_of_a_strike_and_the_work_of_friction_have_half_widths_of_their_own(monkeypatch):
    fast = struck(0.5, approach=1.05, half_approach=0.1)
    assert answers(monkeypatch, fast) == ["UNDECIDED", "UNDECIDED"]
    assert answers(monkeypatch, struck(0.5, approach=1.5, half_approach=0.1)) == ["NO", "NO"]
    rubs = struck(0.5, rubbed=0.05, half_rubbed=0.06)
    assert answers(monkeypatch, rubs) == ["YES", "UNDECIDED"]


def test_a_half_width_that_is_not_known_decides_nothing(monkeypatch):
    unknown = struck(0.5)
    unknown.half_width = lambda number, name: Unknown("not told")
    assert answers(monkeypatch, unknown) == ["UNDECIDED", "UNDECIDED"]
