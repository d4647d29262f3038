"""A case is compiled once: what a run asks of it again is not worked out again."""

from collections import Counter

import pytest

from fem_impact.case import case as module
from fem_impact.case.case import Case
from fem_impact.errors import SceneError
from fem_impact.physics.contact import ContactPair
from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all
from fem_impact.solid.build import build


@pytest.fixture
def made(monkeypatch):
    """How often cases, decisions on effects, zones and estimates of a contact are made."""
    counts = Counter()

    def counted(name, function):
        def call(*arguments, **keywords):
            counts[name] += 1
            return function(*arguments, **keywords)

        return call

    for name in ("decide", "zones_of", "run_size"):
        monkeypatch.setattr(module, name, counted(name, getattr(module, name)))
    monkeypatch.setattr(Case, "__init__", counted("case", Case.__init__))
    estimate = ContactPair.__dict__["estimate"]
    monkeypatch.setattr(estimate, "func", counted("estimate", estimate.func))
    return counts


def test_a_run_compiles_its_scene_once(made):
    simulate(load("t5b"), "rigid")
    assert made["case"] == made["decide"] == 1
    # the contact with the effects in force, the same without yielding, and that of all effects
    assert made["estimate"] <= 3


def test_a_model_is_built_on_one_case_with_one_plan_of_its_mesh(made):
    case = Case.of(replace_all(load("quick"), {"accuracy.tip_size": "1.6 mm", "accuracy.across": 6}))
    build(case)
    assert case.size.rod > 0 and case.limitations is not None
    assert made["case"] == made["decide"] == made["zones_of"] == 1
    assert made["estimate"] <= 3


def test_a_case_of_the_same_effects_has_one_set_of_bodies():
    """Where all effects are in force that the scene does not force off, both are one object."""
    stated = replace_all(load("t5b"), {"effects": ["vibration", "friction", "barrier-elastic"]})
    case = Case(stated)
    assert case.bodies is case._whole
    assert Case(load("t5b")).bodies is not Case(load("t5b"))._whole


@pytest.mark.parametrize(
    ("scene", "told"),
    [
        (replace_all(load("t5b"), {"impact.height": "9000 m"}), 'impact.height = "9000 m"'),
        (
            replace_all(load("t5b"), {"impact.v_n": "-300 m/s", "impact.v_t": "0 m/s"}),
            'impact.v_n = "-300 m/s"',
        ),
    ],
)
def test_a_speed_that_is_too_high_is_refused_by_the_key_that_states_it(scene, told):
    with pytest.raises(SceneError, match="would press the tip") as refused:
        Case.of(scene, "solid")
    assert str(refused.value).startswith(told)
