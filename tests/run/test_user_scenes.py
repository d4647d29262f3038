"""The scenes of other metals, barriers and motions that are shipped as examples, run on coarse meshes."""

import pytest

from fem_impact.run.simulate import simulate
from fem_impact.scene.shipped import load, replace_all

COARSE = {
    "plate-10mm": {},
    "free-barrier-5kg": {"barrier.mass": "0.3 kg"},  # so light that it moves away under the contact
    "moving-barrier": {},
    "spinning-rod": {},
    "aluminium-rod": {"accuracy.tip_size": "1.25 mm"},
    "tungsten-rod": {"accuracy.tip_size": "1.5 mm", "accuracy.across": 6},
}
SLOW = ("tungsten-rod", "plate-10mm", "aluminium-rod")


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.slow if n in SLOW else ()) for n in COARSE]
)
def test_a_shipped_scene_runs_on_finite_elements(name):
    scene = replace_all(load(name), {**COARSE[name], "save.frames": 0, "accuracy.unresolved": "report"})
    outcome = simulate(scene, "solid")
    assert outcome.validity.finished
    assert abs(outcome.energy.residual) < 1e-5
    assert outcome.energy.vibration == pytest.approx(outcome.energy.vibration_check, rel=0.05, abs=2e-4)
    stays, deepest = outcome.to_dict()["dent_depth_m"], max(site.depth for site in outcome.contact.sites)
    springs_back = (
        3.0 if name == "aluminium-rod" else 0.3
    )  # of the dent that stays: the rod is the softer one
    assert stays < deepest < (1.0 + springs_back) * stays  # both under the surface around it


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.long) if n == "tungsten-rod" else n for n in COARSE]
)
def test_a_shipped_scene_runs_by_its_modes(name):
    outcome = simulate(load(name), "modal")
    assert outcome.validity.finished and abs(outcome.energy.residual) < 1e-4


@pytest.mark.long
def test_the_metals_differ_in_what_yields():
    """Soft aluminium takes the plastic work itself; a tungsten alloy leaves nearly all of it to the plate."""
    soft, hard = (simulate(load(name), "modal").energy for name in ("aluminium-rod", "tungsten-rod"))
    assert soft.plastic_rod > 0.2
    assert hard.plastic_barrier > 0.18 > 0.02 > hard.plastic_rod
