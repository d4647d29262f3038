"""A soft ball that touches for a fiftieth of a second: what it gives back is at most what it brought."""

import pytest

from fem_impact.run.simulate import simulate
from fem_impact.scene.read import read_dict


def ball(fidelity, *effects, **material):
    """Return e of a ball of rubber that falls on a plate without friction."""
    rubber = {"name": "rubber", "E": "4.485 MPa", "nu": 0.49, "rho": "1150 kg/m3"} | material
    scene = {
        "id": "rubber-ball",
        "effects": list(effects),
        "projectile": {"shape": "ball", "diameter": "60 mm", "material": rubber},
        "barrier": {"material": "plate-steel"},
        "surface": {"state": "custom", "friction": 0.0, "source": "frictionless"},
        "impact": {"angle": "0 deg", "speed": "1.8254 m/s"},
        "save": {"frames": 0},
    }
    return simulate(read_dict(scene), fidelity).restitution.edge.e


@pytest.mark.parametrize("material", [{}, {"loss_factor": 0.1}])
def test_gravity_in_contact_takes_no_part_in_e(material):
    on, off = (ball("modal", "auto", gravity, **material) for gravity in ("gravity", "-gravity"))
    assert on == pytest.approx(off, abs=1.5e-3)
    assert on <= 1 + 2e-4


@pytest.mark.slow
def test_finite_elements_give_back_at_most_what_came():
    assert ball("solid", "auto") == pytest.approx(0.993, abs=7e-3)
