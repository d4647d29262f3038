"""Sentences on e, mu and E_r out of the range of a plain impact, and on a rod that still comes down."""

from dataclasses import replace

import numpy as np
import pytest

from fem_impact.case.case import Case
from fem_impact.case.record import BodyRecord, ContactRecord
from fem_impact.outcome.groups import texts
from fem_impact.outcome.keys import Unknown
from fem_impact.run.common import open_end, strikes_again
from fem_impact.run.simulate import simulate
from fem_impact.run.solid import _trapped
from fem_impact.run.unusual import pierced, unusual
from fem_impact.scene.shipped import load, replace_all


@pytest.fixture(scope="module")
def outcome():
    """An impact that nothing is unusual of: f = .57, e = .31, E_r below 1."""
    return simulate(load("t5b"), "rigid")


def told_of(outcome, *, effects=("vibration", "friction"), fidelity="solid", **changes):
    """Return what is unusual of an outcome with other numbers of e, mu, f, rigid and gravity shares."""
    o = outcome
    e, mu = changes.get("e", o.restitution.edge.e), changes.get("mu", o.restitution.mu)
    sentences = unusual(
        replace(o.provenance, effects=effects, fidelity=fidelity),
        replace(o.motion, friction=changes.get("f", 0.57)),
        replace(o.restitution, mu=mu, edge=replace(o.restitution.edge, e=e)),
        replace(o.energy, rigid=changes.get("rigid", 0.5), gravity=changes.get("gravity", Unknown("off"))),
        Case.of(load("t5b"), "rigid").contact,
    )
    return [sentence for sentence in sentences if sentence]


def test_nothing_is_unusual_of_a_plain_impact(outcome):
    assert told_of(outcome) == []
    assert told_of(outcome, e=1.0, mu=-0.63, rigid=1.00009) == []
    assert told_of(outcome, e=Unknown("0 / 0"), mu=Unknown("0 / 0"), rigid=Unknown("not resolved")) == []


@pytest.mark.parametrize(
    ("effects", "f", "causes"),
    [
        (("vibration", "friction", "gravity"), 0.57, "friction or bending or gravity or turning gave"),
        (("vibration",), 0.0, "bending or turning gave"),
    ],
)
def test_a_restitution_above_one_names_what_can_cause_it(outcome, effects, f, causes):
    (told,) = told_of(outcome, e=1.01, mu=0.0, f=f, effects=effects)
    assert told.startswith("e = 1.01 is above 1: ") and causes in told and "or the mesh did" in told


def test_rigid_theory_gives_a_restitution_above_one_by_friction_alone(outcome):
    (told,) = told_of(outcome, e=1.3, fidelity="rigid", effects=("friction",))
    assert told == (
        "e = 1.3 is above 1: friction gave the contact point speed along the normal beside its approach at "
        "1.5 m/s (it slides at 1.5 m/s), so that e does not measure what the contact loses."
    )
    (told,) = told_of(outcome, e=1.3, mu=0.0, f=0.0, fidelity="rigid", effects=())
    assert "do not use" in told


def test_a_negative_restitution_names_what_lifts_the_tip(outcome):
    (told,) = told_of(outcome, e=-0.2, fidelity="modal")
    assert "e = -0.2 is below 0: the tip lifts off by friction or bending or turning" in told
    assert "tip_size" not in told


def test_a_ratio_beyond_friction_is_told_of(outcome):
    assert "mu = -0.7 is beyond f = 0.57" in told_of(outcome, mu=-0.7)[0]
    assert "mu = 0.02 is beyond f = 0" in told_of(outcome, mu=0.02, f=0.0)[0]
    assert told_of(outcome, mu=-0.7)[0].endswith(
        "or by the mesh. Confirm it with cells of half the size (accuracy.tip_size, or one level more)."
    )
    assert told_of(outcome, mu=-0.7, fidelity="modal")[0].endswith("held by the form of its crater.")


def test_energy_that_the_rod_did_not_bring_is_doubted_or_gravitys(outcome):
    assert "distrust every share" in told_of(outcome, rigid=1.01)[0]
    assert "distrust every share" in told_of(outcome, rigid=1.05, gravity=0.02)[0]
    assert "gravity gave the rod 0.02 of it" in told_of(outcome, rigid=1.015, gravity=0.02)[0]


@pytest.mark.parametrize(("gap", "is_open"), [(0.6, False), (0.7, True), (1.4, True), (1.6, False)])
def test_contacts_about_as_far_apart_as_two_impacts_leave_open_where_this_one_ends(gap, is_open):
    case = Case.of(load("t5b"), "modal")
    second = 1e-4 + gap * case.one_impact
    contacts = np.array([[0.0, 1e-4], [second, second + 1e-5]])
    told = open_end(case, contacts, 1.0, 0.0)
    assert bool(told) == is_open and ("touches again after" in told) == is_open
    assert not open_end(case, contacts[:1], 1.0, 0.0) and not open_end(case, None, 1.0, 0.0)


def test_a_disc_whose_other_rim_comes_down_about_then_has_the_widest_half_widths():
    """A disc at 3 degrees: -1.55 +- 0.10 m/s by the reduced model, by finite elements +1.11 +- 0.08."""
    disc = {"length": "6 mm", "diameter": "30 mm", "tip": "plain", "material": "pe-hd"}
    text = {
        "id": "disc",
        "projectile": disc,
        "barrier": {"material": "aluminium-6061-t6"},
        "surface": {"state": "custom", "friction": 0.2, "source": "assumed"},
        "impact": {"angle": "3 deg", "slope": "0 deg", "height": "0.3 m"},
    }
    near, far = (
        simulate(replace_all(load(text), {"impact.angle": f"{angle} deg"}), "modal") for angle in (3, 6)
    )
    assert "touches again after" in near.contact.strikes_again.reason and far.contact.strikes_again is True
    assert near.estimate("V_n_m_per_s")[1] > 5 * far.estimate("V_n_m_per_s")[1]


def test_every_fidelity_says_that_a_rod_strikes_again():
    case = Case.of(load("t5b"), "rigid")
    assert strikes_again(case, 0.1, 0.0) == "" == strikes_again(case, 1.0, 20.0)
    # the mass centre is 31 mm above the barrier, the tail 42 mm from it: about 1.6 rad to turn
    weightless = Case.of(replace_all(load("t5b"), {"effects": ["auto", "-gravity"]}), "rigid")
    assert "strikes again about 27.7 ms later" in strikes_again(weightless, 0.1, 60.0)
    assert "strikes again about 25.7 ms later" in strikes_again(case, 0.1, 60.0)
    assert "at once" in strikes_again(case, 0.4, -60.0)
    # the rim of a disc reaches further than it is long
    disc = {"projectile.length": "2 mm", "projectile.diameter": "24 mm", "projectile.tip_radius": "0.2 mm"}
    flat = Case.of(
        replace_all(load("t5b"), disc | {"impact.angle": "10 deg", "impact.v_t": "0 m/s"}), "rigid"
    )
    assert "strikes again about" in strikes_again(flat, 1.0, -300.0)
    turned = replace_all(load("t2"), {"impact.angle": "59 deg"})
    outcome = simulate(turned, "rigid")
    assert outcome.motion.V_n < 0
    assert (
        "still comes nearer to the barrier, so that" in outcome.validity.stopped_because
        and outcome.motion.V_n < 0
    )
    assert "still comes nearer" in texts(outcome.validity.limitations, "result")[-1]
    assert not texts(simulate(load("t5b"), "rigid").validity.limitations, "result")


def test_a_rod_that_stops_sliding_explains_its_restitution():
    """Friction holds the tip back while it comes down, turns its way, and pushes it off."""
    scene = replace_all(load("t2"), {"impact.angle": "33 deg"})
    rough = replace(scene.surface, state="custom", friction=1.9, friction_low=1.9, friction_high=1.9)
    outcome = simulate(replace(scene, surface=rough, effects=("friction", "barrier-rigid")), "rigid")
    assert outcome.restitution.edge.e > 1.05
    assert any(
        "friction gave the contact point speed" in words for words in texts(outcome.validity.limitations)
    )


def test_a_dent_deep_beside_its_plate_is_told_with_how_far_it_flows():
    flowed = np.array([[0.0, 0.0, -0.002], [0.0, 0.0, -0.006]])
    body = BodyRecord(flowed[:0], flowed, np.array([0.3, 0.1]), 1e-3, 1e-3, 1e-3)
    case, record = Case(load("plate-10mm")), ContactRecord(body, body)
    told = pierced(case, record, 0.0013)
    assert told.startswith("The dent that stays is 1.3 mm deep, 0.13 of the plate's 10 mm; ")
    assert "down to 0.6 of its thickness, by up to 0.3 of plastic strain" in told
    assert pierced(case, record, 0.0009) == pierced(Case(load("t5b")), record, 0.0013) == ""


@pytest.mark.parametrize(
    ("effects", "held", "told"),
    [
        (["friction", "barrier-elastic"], 0.65, True),
        (["friction", "barrier-elastic"], 0.01, False),
        (["friction", "barrier-elastic", "radiation"], 0.65, False),
        (["friction", "rod-plasticity", "barrier-elastoplastic"], 0.65, False),
    ],
)
def test_waves_that_an_elastic_block_keeps_are_told(outcome, effects, held, told):
    """A round edge of 120 mm had e .55 +- .19, and 65 % of E_0 as elastic energy left in the barrier."""
    case = Case.of(replace_all(load("t5b"), {"effects": effects}), "solid")
    sentence = _trapped(case, replace(outcome.energy, locked_barrier=held))
    assert bool(sentence) == told
    assert not told or ("0.65 of E_0" in sentence and '["auto", "radiation"]' in sentence)
