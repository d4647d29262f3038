"""A viscous contact: when it is on, what the two closed forms make of it, and where it is refused."""

import pytest

from fem_impact.case.case import Case
from fem_impact.case.choose import neglected
from fem_impact.case.elastic_only import DAMPED, NOT_STATED, NOT_TAKEN, TAKEN
from fem_impact.case.metals import unknowns
from fem_impact.errors import SceneError
from fem_impact.physics.viscous import viscous_restitution
from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_dict
from fem_impact.scene.shipped import load, replace
from fem_impact.scene.types import to_dict

STEEL = {"name": "elastic steel", "E": "210 GPa", "nu": 0.3, "rho": "7850 kg/m3"}
CLOSED = ("rigid", "modal")


def ball(eta=None, angle="0 deg", barrier="plate-steel", effects=("auto", "-gravity"), **impact):
    """A ball of rubber that falls on a plate."""
    rubber = {"name": "rubber", "E": "4.485 MPa", "nu": 0.49, "rho": "1150 kg/m3"}
    return read_dict(
        {
            "id": "rubber-ball",
            "effects": list(effects),
            "projectile": {
                "shape": "ball",
                "diameter": "60 mm",
                "material": rubber | ({} if eta is None else {"loss_factor": eta}),
            },
            "barrier": {"material": barrier},
            "surface": {"state": "custom", "friction": 0.6, "source": "a test"},
            "impact": {"angle": angle, "speed": "3 m/s"} | impact,
        }
    )


@pytest.mark.parametrize(("eta", "on"), [(None, False), (0.005, False), (0.02, True), (0.3, True)])
def test_it_is_on_where_it_takes_two_percent_of_e(eta, on):
    assert ("contact-loss" in Case.of(ball(eta), "modal").active) is on


def test_a_scene_that_states_none_loses_nothing():
    choice = next(one for one in Case.of(load("t5b"), "rigid").choices if one.name == "contact-loss")
    assert choice.number == 0.0 and "contact-loss" not in Case(load("t5b")).active


@pytest.mark.parametrize("eta", [0.02, 0.1, 0.3])
def test_both_closed_forms_give_back_the_same(eta):
    rigid, modal = (simulate(ball(eta), fidelity) for fidelity in CLOSED)
    assert rigid.restitution.edge.e == pytest.approx(viscous_restitution(eta), rel=1e-6)
    assert modal.restitution.edge.e == pytest.approx(viscous_restitution(eta), rel=1e-3)
    for outcome in (rigid, modal):
        assert abs(outcome.energy.residual) < 1e-5
        assert outcome.energy.damping == pytest.approx(1 - viscous_restitution(eta) ** 2, rel=2e-3)
        assert outcome.energy.plastic_rod == 0.0


def test_an_oblique_ball_keeps_its_ledger():
    for fidelity in CLOSED:
        energy = simulate(ball(0.2, angle="30 deg"), fidelity).energy
        assert energy.damping > 0.1 and energy.friction > 0.05
        assert abs(energy.residual) < 1e-4


def test_the_loss_factor_is_weighted_by_what_gives_way():
    """Both bodies of the rubber: its loss factor; on a stiff plate the plate's hardly counts."""
    stiff = STEEL | {"loss_factor": 1.0}
    pair = Case.of(ball(0.1, barrier=stiff, effects=("auto", "barrier-elastic")), "rigid").contact
    assert pair.loss_factor == pytest.approx(0.1, rel=3e-4)
    same = {"name": "rubber", "E": "4.485 MPa", "nu": 0.49, "rho": "1150 kg/m3", "loss_factor": 0.3}
    both = Case.of(ball(0.1, barrier=same, effects=("auto", "barrier-elastic")), "rigid").contact
    assert both.loss_factor == pytest.approx(0.2)


def test_a_body_that_flows_loses_by_both_in_the_rigid_theory():
    soft = {"name": "plastic", "E": "3 GPa", "nu": 0.35, "rho": "1200 kg/m3", "loss_factor": 0.05}
    scene = replace(ball(angle="20 deg"), "projectile.material", soft)
    flows = replace(scene, "projectile.material", soft | {"yield_stress": "20 MPa", "hardening": "0 MPa"})
    loss, flow, both = (
        simulate(one, "rigid")
        for one in (scene, replace(flows, "projectile.material.loss_factor", 0.0), flows)
    )
    e = [one.restitution.edge.e for one in (loss, flow, both)]
    assert e[2] < min(e[:2])
    assert both.energy.damping > 0 and both.energy.plastic_rod > 0
    assert abs(both.energy.residual) < 1e-9


@pytest.mark.parametrize(
    ("key", "value", "reason"),
    [
        ("barrier.material", "soft", "a barrier of finite elements"),
        ("projectile.segments", "two", "a body of several materials"),
        ("projectile.material", "yields", "a ball of finite elements that yields"),
    ],
)
def test_finite_elements_say_what_they_do_not_hold_and_each_remedy_works(key, value, reason):
    rubber = {"name": "a rubber", "E": "4 MPa", "nu": 0.4, "rho": "1150 kg/m3", "loss_factor": 0.1}
    values = {
        "two": [{"to": "30 mm", "material": rubber}, {"material": rubber | {"name": "b rubber"}}],
        "soft": rubber,
        "yields": rubber | {"E": "3 GPa", "yield_stress": "5 MPa", "hardening": "0 MPa"},
    }
    tree = to_dict(ball(0.1))
    if key == "projectile.segments":
        tree["projectile"].pop("material")
    section, name = key.split(".")
    tree[section][name] = values[value]
    with pytest.raises(SceneError, match=rf"contact-loss, which {reason}.* does not have.*fidelity rigid"):
        Case.of(read_dict(tree))
    with pytest.raises(SceneError, match=r'loss_factor = "0.1(, 0.1)?": of .*rubber calls for'):
        Case.of(read_dict(tree))
    assert Case.of(read_dict(tree), "rigid")
    assert Case.of(read_dict(tree | {"effects": ["auto", "-contact-loss"]}))


def test_what_the_scene_leaves_out_is_told():
    off = ball(0.1, effects=("auto", "-gravity", "-contact-loss"))
    case = Case.of(off)
    assert any("contact-loss" in words for words in neglected(case.choices))
    for fidelity in CLOSED:
        assert simulate(ball(0.1), fidelity).validity.finished
        assert simulate(off, fidelity).restitution.edge.e == pytest.approx(1.0, abs=2e-3)


def test_a_body_that_flows_is_refused_in_the_reduced_model():
    flows = {
        "name": "plastic",
        "E": "3 GPa",
        "nu": 0.35,
        "rho": "1200 kg/m3",
        "loss_factor": 0.1,
        "yield_stress": "5 MPa",
        "hardening": "0 MPa",
    }
    scene = replace(ball(), "projectile.material", flows)
    with pytest.raises(
        SceneError, match=r"yields in the reduced model does not have.*fidelity rigid, or add"
    ):
        Case.of(scene, "modal")
    assert Case.of(scene, "rigid") and Case.of(replace(scene, "effects", ["auto", "-contact-loss"]), "modal")
    assert Case.of(replace(scene, "effects", ["auto", "-rod-plasticity"]), "modal")


@pytest.mark.parametrize(
    ("eta", "effects", "words"),
    [
        (None, ("auto",), NOT_STATED),
        (0.1, ("auto",), TAKEN),
        (0.1, ("auto", "-contact-loss"), DAMPED),
        (0.1, ("auto", "-contact-loss", "-material-damping"), NOT_TAKEN),
    ],
)
def test_what_is_left_out_says_whether_the_loss_is_taken(eta, effects, words):
    told = unknowns(Case.of(ball(eta, effects=effects), "rigid").bodies)
    assert any(one.endswith("strain and rate." + words) for one in told)


def test_a_rod_vibrates_with_the_loss_of_its_material():
    rod = replace(load("t5b"), "projectile.material.loss_factor", 0.01)
    assert Case.of(rod, "rigid").slots.loss_factor == 0.01
    assert Case.of(load("t5b"), "rigid").slots.loss_factor in (None, 6e-4)


def test_the_effect_is_refused_where_no_material_states_a_loss_factor():
    with pytest.raises(SceneError, match=r'names "contact-loss", but no material.*loss_factor of a material'):
        Case.of(ball(effects=("auto", "contact-loss")), "rigid")
