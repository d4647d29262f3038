"""Bodies shorter than wide on finite elements."""

import pytest

from fem_impact.answers.refine.chain import LevelChain
from fem_impact.case.case import Case
from fem_impact.outcome.keys import known
from fem_impact.run.simulate import simulate_recorded
from fem_impact.scene.read import read_dict


def test_a_pin_that_lands_flat_leaves_when_its_wave_is_back_and_the_record_holds_all_of_its_face():
    """After 2 l / c, a few steps of a coarse mesh; with all of its momentum handed over."""
    scene = read_dict(
        {
            "id": "pin",
            "projectile": {"shape": "flat", "length": "4 mm", "diameter": "10 mm", "material": "rod-steel"},
            "barrier": {"material": "plate-steel"},
            "surface": {"state": "machined"},
            "impact": {"angle": "0 deg", "v_n": "-1 m/s", "v_t": "0 m/s"},
            "effects": ["vibration", "barrier-rigid"],
        }
    )
    case = LevelChain(Case.of(scene)).meshes.pilot
    outcome, record = simulate_recorded(case.scene, "solid", case=case)
    site = record.sites[0]
    assert site.end - site.start == pytest.approx(case.bodies.stretching_period, rel=0.25)
    gained = outcome.motion.mass * (outcome.motion.V_n + 1)
    assert sum(each.impulse_n for each in record.sites) == pytest.approx(gained, rel=0.1)
    assert record.rod.touched[:, 0].max() == pytest.approx(5e-3, rel=0.05)


def test_a_body_is_meshed_for_its_modes_however_it_would_touch_upright():
    """A rounding drawn as facets: the first is 12 degrees from the face, and pressed in upright."""
    rounding = [["0 mm", "4.5 mm"], ["0.04 mm", "4.69 mm"], ["0.15 mm", "4.85 mm"], ["0.31 mm", "4.96 mm"]]
    bolt = read_dict(
        {
            "id": "bolt",
            "projectile": {"profile": [*rounding, ["90 mm", "5 mm"]], "material": "titanium-6al-4v"},
            "barrier": {"material": "plate-steel"},
            "surface": {"state": "custom", "friction": 0.2, "source": "assumed"},
            "impact": {"angle": "25 deg", "height": "3 m"},
        }
    )
    assert 0.0 < known(simulate_recorded(bolt, "modal")[0].restitution.edge.e) < 1.0
